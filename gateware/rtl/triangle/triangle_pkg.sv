// Types of the values that the modules of the triangle engine exchange. docs/formats/triangle.md explains the number formats.

`default_nettype none

package triangle_pkg;
    // A vertex on the screen: x and y in pixels, s12.8; w is the depth code before its rounding, u18.6.
    typedef struct packed {
        logic [23:0] w;
        logic [20:0] y;
        logic [20:0] x;
    } screen_vertex_t;

    // A vertex after the vertex stage. `behind` marks a vertex behind the near plane, and its `place` is 0. `beyond` marks a vertex
    // outside of the guard band; its `place` is saturated, and only shows beyond which sides of the picture the vertex lies.
    typedef struct packed {
        logic           behind;
        logic           beyond;
        screen_vertex_t place;
    } projected_t;

    // Light of a vertex with smooth shading: whether it belongs to back faces, and the shaded colour L of each channel
    // (docs/formats/triangle.md, "Smooth shading"), u0.16. Builds without smooth shading replace this type and records_pkg::planes_t by
    // one bit, 0.
    typedef struct packed {
        logic        back;
        logic [15:0] red;
        logic [15:0] green;
        logic [15:0] blue;
    } light_t;

    // Number of bits of a light_t.
    localparam int unsigned LIGHT_BITS = 49;

    // The planes of a triangle other than its depth, from the lowest bits: the planes of light with SMOOTH, or of texture coordinates
    // with TEXTURE, then values that are constant on the triangle: whether it is smooth, and the other fields of
    // records_pkg::texture_planes_t. In a build with neither there is a single bit, 0.
    localparam int unsigned TEXTURE_BITS = 49;

    // Returns the number of planes.
    function automatic int unsigned channels(input bit smooth, input bit texture);
        channels = (smooth ? 3 : 0) + (texture ? 2 : 0);
    endfunction

    // Returns the number of bits of planes and constants.
    function automatic int unsigned planes_bits(input bit smooth, input bit texture);
        planes_bits = smooth || texture ? 96 * channels(smooth, texture) + (smooth ? 1 : 0) + (texture ? TEXTURE_BITS : 0) : 1;
    endfunction

    // Returns the number of bits of a vertex in addition to its position: from the lowest bits a light_t with SMOOTH, and the
    // texture coordinates with TEXTURE; a single bit, 0, in a build with neither.
    function automatic int unsigned vertex_bits(input bit smooth, input bit texture);
        vertex_bits = smooth || texture ? (smooth ? LIGHT_BITS : 0) + (texture ? 64 : 0) : 1;
    endfunction

    // Returns the number of 128-bit words of a descriptor in memory.
    function automatic int unsigned descriptor_words(input bit smooth, input bit texture);
        descriptor_words = 3 + (smooth ? 3 : 0) + (texture ? 2 : 0);
    endfunction
endpackage

`default_nettype wire
