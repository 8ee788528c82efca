// Generated from gateware/glint_soc/raymarch.py by `cargo xtask pac`. Do not edit.
// Constants and types of the block's ports. docs/registers.md describes the registers.

`default_nettype none

package raymarch_registers_pkg;
    // The warning UNUSEDPARAM is off, because each module uses only some of the constants.
    /* verilator lint_off UNUSEDPARAM */
    // The solid of marching rays. `blend_width` is the width of the fillet, u5.12, and `blend_inverse` is 1 / (2 * width),
    // u1.16. `spheres_repeated` is high if the first sphere is repeated, by exits.
    typedef struct packed {
        logic [16:0] blend_width;
        logic [16:0] blend_inverse;
        logic spheres_repeated;
        logic [2:0] last_sphere;
        logic [5:0] levels;
        logic [2:0][21:0] half;
    } solid_t;

    // A sphere: its material, {blue, green, red}; the reciprocal of its radius and a shift (docs/formats/raymarch.md, "Light
    // on spheres"); its radius, and its centre.
    typedef struct packed {
        logic [23:0] material;
        logic [4:0] shift;
        logic [16:0] inverse;
        logic [20:0] radius;
        logic [2:0][22:0] centre;
    } sphere_t;

    // Light on spheres: whether colours depend on normals, whether there are lights and a highlight, the steepness, the colour
    // and the direction of the highlight, number of the last light, ambient light, colours of the lights, and directions to
    // the lights, s1.16. Whether the list has a solid cone, the exponent of the light on it, and components of the directions
    // of axes for it.
    typedef struct packed {
        logic cone;
        logic [3:0] lead;
        logic [17:0] across;
        logic [17:0] along;
        logic normals;
        logic lit;
        logic highlight;
        logic [12:0] steepness;
        logic [23:0] shine;
        logic [2:0][17:0] half;
        logic [1:0] last_light;
        logic [23:0] ambient;
        logic [3:0][23:0] colours;
        logic [3:0][2:0][17:0] directions;
    } lights_t;

    // Rays to the first light: reciprocals of half the components of the direction to it (exit_pkg), in the order x, y, z from
    // the lowest bits; this direction, s1.14; and whether there are shadows.
    typedef struct packed {
        logic [95:0] inverse;
        logic [47:0] direction;
        logic enable;
    } shadow_t;

    // Constants of marching rays: threshold, footprint, step limit.
    typedef struct packed {
        logic [15:0] threshold;
        logic [3:0] footprint;
        logic [9:0] cap;
    } tuning_t;

    // Colours, {blue, green, red}, of the zenith, of undecided rays, of the faces by surface, and of faces in the shadow by
    // axis.
    typedef struct packed {
        logic [23:0] zenith;
        logic [23:0] undecided;
        logic [7:0][23:0] faces;
        logic [2:0][23:0] shadows;
    } palette_t;

    // Increment of each counter in this clock.
    typedef struct packed {
        logic cycles_busy;
        logic cycles_stalled;
        logic items_in;
        logic items_out;
        logic [2:0] cycles_idle;
        logic [2:0] evaluations;
        logic hits;
        logic misses;
        logic undecided;
    } events_t;
    /* verilator lint_on UNUSEDPARAM */
endpackage

`default_nettype wire
