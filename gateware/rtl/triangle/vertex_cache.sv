// A cache of vertices that the vertex stage has computed. Input: triangles, each as three vertex indices. Output: the triangles with their
// three vertices, in the same order.
//
//           ┌──────┐  miss: index   ┌───────────────────────────┐ fetch                 memory, vertex stage
//   in ────▶│ tags │───────────────▶│ 64 places                 │──────▶ … ─────────────┐
//    │      │      │  slot, miss    ├───────────────────────────┤                       │ projected
//    │      │      │───────────────▶│ 64 records                │──────▶ ┌──────────┐◀──┘
//    │      └──────┘                └───────────────────────────┘        │ vertices │──▶ 3 vertices ─▶ out
//    └─────────────────────────────────────────────────── side ─────────▶└──────────┘              ▲
//                                                              └───────────────────────────────────┘
// The cache is direct mapped. The first stage looks up and replaces tags in the order of the indices, and queues a record for
// each index: its slot, and whether it missed. The last stage takes the records in the same order. For a miss, the last stage stores the
// next vertex of `projected` in the slot; for a hit, it reads the slot. A hit therefore finds its vertex at any latency of the vertex
// stage, and there is no hazard between the stages. The memories have no hazard either: a tag is read and replaced by one access, which
// returns the old tag, and a record either reads its slot or writes it, through one port. `side` has the fields of a triangle that only
// pass through.
//
// `clear` (one clock) invalidates all vertices for the triangles that enter later, at the start of a chunk or a frame. A tag holds the
// number of its epoch, which is the time between two clears. All tags are therefore only reset after a reset and every 2^EPOCH_BITS − 1
// clears, one slot per clock. Latency 14 clocks without a miss. Throughput without misses one index per clock, one triangle per 3 clocks.
// Each stream is valid/ready.

`default_nettype none

module vertex_cache #(
    parameter int unsigned SLOTS       = 512,
    parameter int unsigned SIDE_BITS   = 96,
    parameter int unsigned EPOCH_BITS  = 6,
    parameter int unsigned VERTEX_BITS = 68 // a triangle_pkg::projected_t
) (
    input  wire                          clk,
    input  wire                          rst,
    input  wire                          clear,
    // High while no triangle is inside.
    output logic                         idle,
    input  wire                          in_valid,
    output logic                         in_ready,
    input  wire  [2:0][15:0]             in_indices,
    input  wire  [SIDE_BITS-1:0]         in_side,
    output logic                         fetch_valid,
    input  wire                          fetch_ready,
    output logic [15:0]                  fetch_index,
    input  wire                          projected_valid,
    output logic                         projected_ready,
    input  wire  [VERTEX_BITS-1:0]       projected_vertex,
    output logic                         out_valid,
    input  wire                          out_ready,
    output logic [2:0][VERTEX_BITS-1:0]  out_vertices,
    output logic [SIDE_BITS-1:0]         out_side
);
    localparam int unsigned SLOT_BITS  = $clog2(SLOTS);
    localparam int unsigned TAG_BITS   = 16 - SLOT_BITS;
    localparam int unsigned ENTRY_BITS = EPOCH_BITS + TAG_BITS;
    localparam int unsigned RECORDS    = 64;
    localparam int unsigned PLACES     = 16; // entries for vertices whose triangle is incomplete
    localparam int unsigned TRIANGLES  = 32; // more than 29, the maximum number of triangles inside

    // First stage: looks up the indices of a triangle one by one, while the FIFO can take their records.
    logic [2:0][15:0]        indices;
    logic [1:0]              to_look;
    logic [$clog2(RECORDS):0] records;
    logic                    look, taken, clearing, record_taken;

    assign look     = to_look != 2'd0 && !records[$clog2(RECORDS)];
    assign in_ready = (to_look == 2'd0 || to_look == 2'd1 && look) && !clearing;
    assign taken    = in_valid && in_ready;

    // Number of the current epoch. Epoch 0 is reserved for empty slots, which never hit.
    logic [EPOCH_BITS-1:0] epoch;
    logic                  sweeping;
    logic [SLOT_BITS-1:0]  sweep;

    always_ff @(posedge clk) begin
        if (look) begin
            indices <= {16'b0, indices[2:1]};
            to_look <= to_look - 2'd1;
        end
        if (taken) begin
            indices <= in_indices;
            to_look <= 2'd3;
        end
        records <= records + 7'(look) - 7'(record_taken);

        if (clearing && to_look == 2'd0) begin
            if (sweeping) begin
                sweep <= sweep + 1'b1;
                if (sweep == '1) begin
                    sweeping <= 1'b0;
                    clearing <= 1'b0;
                end
            end else begin
                epoch    <= epoch == '1 ? EPOCH_BITS'(1) : epoch + 1'b1;
                sweeping <= epoch == '1;
                clearing <= epoch == '1;
            end
        end
        if (clear) clearing <= 1'b1;

        if (rst) begin
            to_look  <= 2'd0;
            records  <= '0;
            epoch    <= '1;
            clearing <= 1'b1;
            sweeping <= 1'b0;
            sweep    <= '0;
        end
    end

    // Lookup of the tags: four clocks from an index to its record.
    (* ram_style = "block" *) logic [ENTRY_BITS-1:0] tags [0:SLOTS-1];
    logic                       replace;
    logic [SLOT_BITS-1:0]       slot;
    logic [ENTRY_BITS-1:0]      entry, entry_read, entry_old;
    logic [2:0]                 looked;   // bit k: an index that was looked up k + 1 clocks ago
    logic [1:0][15:0]           looked_index;
    logic [1:0][EPOCH_BITS-1:0] looked_epoch;
    logic                       found, missed;
    logic [15:0]                found_index;

    always_ff @(posedge clk) begin
        replace <= look || sweeping;
        slot    <= sweeping ? sweep : indices[0][SLOT_BITS-1:0];
        entry   <= sweeping ? '0 : {epoch, indices[0][15:SLOT_BITS]};
        if (replace) begin
            entry_read <= tags[slot];
            tags[slot] <= entry;
        end
        entry_old <= entry_read;

        looked       <= {looked[1:0], look};
        looked_index <= {looked_index[0], entry[TAG_BITS-1:0], slot};
        looked_epoch <= {looked_epoch[0], entry[ENTRY_BITS-1:TAG_BITS]};
        found        <= looked[2];
        found_index  <= looked_index[1];
        missed       <= entry_old != {looked_epoch[1], looked_index[1][15:SLOT_BITS]};
        if (rst) begin
            replace <= 1'b0;
            looked  <= '0;
            found   <= 1'b0;
        end
    end

    // Both FIFOs have RECORDS entries. Each index in `fetches` also has a record in `waiting`, so the limit of `records` prevents overflow
    // of both FIFOs.
    logic                 record_valid, record_missed, fetch_room, record_room;
    logic [SLOT_BITS-1:0] record_slot;

    fifo #(.WIDTH(16), .DEPTH(RECORDS)) fetches (
        .clk(clk), .rst(rst), .in_valid(found && missed), .in_ready(fetch_room), .in_data(found_index),
        .out_valid(fetch_valid), .out_ready(fetch_ready), .out_data(fetch_index));

    fifo #(.WIDTH(1 + SLOT_BITS), .DEPTH(RECORDS)) waiting (
        .clk(clk), .rst(rst), .in_valid(found), .in_ready(record_room), .in_data({missed, found_index[SLOT_BITS-1:0]}),
        .out_valid(record_valid), .out_ready(record_taken), .out_data({record_missed, record_slot}));

    // Last stage: three clocks from a record to its vertex.
    logic [$clog2(PLACES):0] held;
    logic                    room, vertex_taken;

    assign room            = !held[$clog2(PLACES)];
    assign projected_ready = record_valid && record_missed && room;
    assign record_taken    = record_valid && room && (!record_missed || projected_valid);

    (* ram_style = "block" *) logic [VERTEX_BITS-1:0] vertices [0:SLOTS-1];
    logic                        store, load;
    logic [SLOT_BITS-1:0]        place;
    logic [VERTEX_BITS-1:0]      vertex_read, vertex_old;
    logic [2:0]                  passing, passing_missed;
    logic [2:0][VERTEX_BITS-1:0] fresh;

    assign store = passing[0] && passing_missed[0];
    assign load  = passing[0] && !passing_missed[0];

    always_ff @(posedge clk) begin
        place          <= record_slot;
        passing        <= {passing[1:0], record_taken};
        passing_missed <= {passing_missed[1:0], record_missed};
        fresh          <= {fresh[1:0], projected_vertex};
        if (store) vertices[place] <= fresh[0];
        if (load)  vertex_read     <= vertices[place];
        vertex_old <= vertex_read;
        held       <= held + 5'(record_taken) - 5'(vertex_taken);
        if (rst) begin
            passing <= '0;
            held    <= '0;
        end
    end

    // Collects three vertices for each triangle and adds the fields of `side`.
    logic                   vertex_valid, vertex_room, side_room, side_valid;
    logic [VERTEX_BITS-1:0] vertex;
    logic [1:0]             filled;
    logic [5:0]             inside_count;

    fifo #(.WIDTH(VERTEX_BITS), .DEPTH(PLACES), .DIRECT(1'b1)) gathered (
        .clk(clk), .rst(rst), .in_valid(passing[2]), .in_ready(vertex_room),
        .in_data(passing_missed[2] ? fresh[2] : vertex_old),
        .out_valid(vertex_valid), .out_ready(vertex_taken), .out_data(vertex));

    fifo #(.WIDTH(SIDE_BITS), .DEPTH(TRIANGLES)) sides (
        .clk(clk), .rst(rst), .in_valid(taken), .in_ready(side_room), .in_data(in_side),
        .out_valid(side_valid), .out_ready(out_valid && out_ready), .out_data(out_side));

    assign vertex_taken = vertex_valid && (!out_valid || out_ready);
    assign idle         = inside_count == '0;

    always_ff @(posedge clk) begin
        if (out_ready) out_valid <= 1'b0;
        if (vertex_taken) begin
            for (int i = 0; i < 3; i++) if (filled == 2'(i)) out_vertices[i] <= vertex;
            filled    <= filled == 2'd2 ? 2'd0 : filled + 2'd1;
            out_valid <= filled == 2'd2;
        end
        inside_count <= inside_count + 6'(taken) - 6'(out_valid && out_ready);
        if (rst) begin
            out_valid    <= 1'b0;
            filled       <= 2'd0;
            inside_count <= '0;
        end
    end

    // The FIFOs are never full, and the triangle's other fields arrive long before its vertices, so these
    // signals need no check.
    logic unused;
    assign unused = fetch_room && record_room && vertex_room && side_room && side_valid;
endmodule

`default_nettype wire
