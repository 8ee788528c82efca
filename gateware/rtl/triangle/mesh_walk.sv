// Reads the triangles of a mesh in memory, chunk by chunk (docs/formats/mesh.md, "Mesh in memory").
//
// This module reads words of 16 bytes as a client of read_port: a chunk's header, then the chunk's triangles one after the other. The
// vertex stage reads the vertices of the chunk, from `vertex_base` on. Triangles in the following pipeline still need the vertices of their
// chunk, so the next chunk begins only when this pipeline is empty (`drained`). This wait takes some hundred clocks for each chunk of up to
// 65,535 vertices. Throughput within a chunk: one triangle per clock, unless memory is slower.
//
// `start` (one clock, not while `busy`) begins the walk at `first`, the address of the mesh's first chunk; `past` is the address
// of the first word after the mesh. A chunk that has no vertices or extends beyond `past` ends the walk with `error`, which holds
// until the next start.

`default_nettype none

module mesh_walk #(
    parameter int unsigned ADDRESS_BITS = 23
) (
    input  wire                     clk,
    input  wire                     rst,
    input  wire                     start,
    input  wire  [ADDRESS_BITS-1:0] first,
    input  wire  [ADDRESS_BITS:0]   past,
    input  wire                     drained,
    output logic                    busy,
    output logic                    error,
    // `vertex_base` is the address of the first vertex of the chunk whose triangles are sent. `chunk` is high for one clock
    // when the chunk changes.
    output logic                    chunk,
    output logic [ADDRESS_BITS-1:0] vertex_base,
    // Number in the mesh of the first vertex of this chunk.
    output logic [ADDRESS_BITS:0]   vertex_first,
    // Memory.
    output logic                    ask_valid,
    input  wire                     ask_ready,
    output logic [ADDRESS_BITS-1:0] ask_addr,
    input  wire                     data_valid,
    output logic                    data_ready,
    input  wire  [127:0]            data,
    // Triangles of the mesh, in the format in which they are stored in memory.
    output logic                    out_valid,
    input  wire                     out_ready,
    output logic [127:0]            out_triangle
);
    records_pkg::chunk_t read_header;

    assign read_header = data;

    // Numbers of bits: of a count, and of the sum of an address and two counts. Values from memory may be arbitrary: if a count has more
    // bits, `wild` is high; the sums of other counts do not wrap around.
    localparam int unsigned COUNT_BITS = ADDRESS_BITS + 1;
    localparam int unsigned SUM_BITS   = ADDRESS_BITS + 3;

    typedef enum logic [2:0] {IDLE, ASK, HEADER, LOCATE, SUM, CHECK, TRIANGLES, DRAIN} state_t;
    state_t state;

    logic [ADDRESS_BITS-1:0] header;
    logic [COUNT_BITS-1:0]   vertices, triangles;
    logic [SUM_BITS-1:0]     triangles_base, end_base;
    // The complements of the numbers of triangles that are still to be requested and to be sent: counting up takes fewer LUTs.
    logic [COUNT_BITS-1:0]   asks_left, gives_left;
    logic                    asked, more, wild, too_many;

    assign busy         = state != IDLE;
    assign ask_valid    = state == ASK || state == TRIANGLES && more;
    assign asked        = ask_valid && ask_ready;
    assign out_triangle = data;
    assign out_valid    = state == TRIANGLES && data_valid;
    assign data_ready   = state == HEADER || state == TRIANGLES && out_ready;
    assign wild         = too_many || vertices == '0 || end_base > SUM_BITS'(past);

    always_ff @(posedge clk) begin
        // `more` is high if an address remains to be requested in the next clock.
        more  <= asks_left < (asked ? COUNT_BITS'(-2) : '1);
        chunk <= 1'b0;

        case (state)
            IDLE: begin
                header       <= first;
                ask_addr     <= first;
                vertex_first <= '0;
                if (start) begin
                    error <= 1'b0;
                    state <= ASK;
                end
            end
            ASK: if (asked) state <= HEADER;
            HEADER: begin
                vertices  <= read_header.vertices[COUNT_BITS-1:0];
                triangles <= read_header.triangles[COUNT_BITS-1:0];
                too_many  <= (read_header.vertices | read_header.triangles) >> COUNT_BITS != '0;
                if (data_valid) state <= LOCATE;
            end
            LOCATE: begin
                vertex_base    <= header + 1'b1;
                triangles_base <= SUM_BITS'(header) + SUM_BITS'(vertices) + 1'b1;
                state          <= SUM;
            end
            SUM: begin
                end_base   <= triangles_base + SUM_BITS'(triangles);
                ask_addr   <= triangles_base[ADDRESS_BITS-1:0];
                asks_left  <= ~triangles;
                gives_left <= ~triangles;
                chunk      <= 1'b1;
                state      <= CHECK;
            end
            CHECK: begin
                error <= wild;
                state <= wild ? DRAIN : TRIANGLES;
            end
            TRIANGLES: begin
                if (asked) begin
                    asks_left <= asks_left + 1'b1;
                    ask_addr  <= ask_addr + 1'b1;
                end
                if (out_valid && out_ready) gives_left <= gives_left + 1'b1;
                if (gives_left == '1) state <= DRAIN;
            end
            default: begin
                header   <= end_base[ADDRESS_BITS-1:0];
                ask_addr <= end_base[ADDRESS_BITS-1:0];
                if (drained) vertex_first <= vertex_first + vertices;
                if (drained) state <= error || end_base >= SUM_BITS'(past) ? IDLE : ASK;
            end
        endcase

        if (rst) begin
            state <= IDLE;
            error <= 1'b0;
        end
    end

    wire _unused = &{1'b0, read_header};
endmodule

`default_nettype wire
