// Checks the protocol of a stream: an item that is valid and not taken stays valid and unchanged in the next clock.
//
// GIVEN = 1 assumes the protocol, for an input stream of the module under proof; GIVEN = 0 asserts the protocol, for an output stream.

`default_nettype none

module stream_checker #(
    parameter int unsigned WIDTH = 8,
    parameter bit          GIVEN = 0
) (
    input wire             clk,
    input wire             rst,
    input wire             valid,
    input wire             ready,
    input wire [WIDTH-1:0] data
);
    logic             waiting = 1'b0;
    logic [WIDTH-1:0] shown;

    always_ff @(posedge clk) begin
        waiting <= valid && !ready && !rst;
        shown   <= data;
    end

    always_ff @(posedge clk) if (!rst && waiting) begin
        if (GIVEN) begin
            assume (valid);
            assume (data == shown);
        end else begin
            valid_stays:    assert (valid);
            payload_stable: assert (data == shown);
        end
    end
endmodule

`default_nettype wire
