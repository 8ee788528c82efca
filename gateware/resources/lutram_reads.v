// Models of the FPGA's LUT memories, from which size.py computes the longest path. They model only the read, as a lookup table
// with the address as its input. The write is not modelled, so a path ends where it writes a memory.

module RAM32M #(
    parameter INIT_A = 0, INIT_B = 0, INIT_C = 0, INIT_D = 0, IS_WCLK_INVERTED = 0
) (
    output [1:0] DOA, DOB, DOC, DOD, input [4:0] ADDRA, ADDRB, ADDRC, ADDRD, input [1:0] DIA, DIB, DIC, DID, input WCLK, WE
);
    genvar n;
    generate for (n = 0; n < 2; n = n + 1) begin
        \$lut #(.WIDTH(5), .LUT(32'd0)) a (.A(ADDRA), .Y(DOA[n]));
        \$lut #(.WIDTH(5), .LUT(32'd0)) b (.A(ADDRB), .Y(DOB[n]));
        \$lut #(.WIDTH(5), .LUT(32'd0)) c (.A(ADDRC), .Y(DOC[n]));
        \$lut #(.WIDTH(5), .LUT(32'd0)) d (.A(ADDRD), .Y(DOD[n]));
    end endgenerate
endmodule

module RAM64M #(
    parameter INIT_A = 0, INIT_B = 0, INIT_C = 0, INIT_D = 0, IS_WCLK_INVERTED = 0
) (
    output DOA, DOB, DOC, DOD, input [5:0] ADDRA, ADDRB, ADDRC, ADDRD, input DIA, DIB, DIC, DID, input WCLK, WE
);
    \$lut #(.WIDTH(6), .LUT(64'd0)) a (.A(ADDRA), .Y(DOA));
    \$lut #(.WIDTH(6), .LUT(64'd0)) b (.A(ADDRB), .Y(DOB));
    \$lut #(.WIDTH(6), .LUT(64'd0)) c (.A(ADDRC), .Y(DOC));
    \$lut #(.WIDTH(6), .LUT(64'd0)) d (.A(ADDRD), .Y(DOD));
endmodule

module RAM64X1S #(
    parameter INIT = 0, IS_WCLK_INVERTED = 0
) (
    output O, input A0, A1, A2, A3, A4, A5, D, WCLK, WE
);
    \$lut #(.WIDTH(6), .LUT(64'd0)) read (.A({A5, A4, A3, A2, A1, A0}), .Y(O));
endmodule

module RAM128X1S #(
    parameter INIT = 0, IS_WCLK_INVERTED = 0
) (
    output O, input A0, A1, A2, A3, A4, A5, A6, D, WCLK, WE
);
    \$lut #(.WIDTH(7), .LUT(128'd0)) read (.A({A6, A5, A4, A3, A2, A1, A0}), .Y(O));
endmodule

module RAM256X1S #(
    parameter INIT = 0, IS_WCLK_INVERTED = 0
) (
    output O, input [7:0] A, input D, WCLK, WE
);
    \$lut #(.WIDTH(8), .LUT(256'd0)) read (.A(A), .Y(O));
endmodule

module RAM64X1D #(
    parameter INIT = 0, IS_WCLK_INVERTED = 0
) (
    output DPO, SPO, input D, WCLK, WE, A0, A1, A2, A3, A4, A5, DPRA0, DPRA1, DPRA2, DPRA3, DPRA4, DPRA5
);
    \$lut #(.WIDTH(6), .LUT(64'd0)) single (.A({A5, A4, A3, A2, A1, A0}), .Y(SPO));
    \$lut #(.WIDTH(6), .LUT(64'd0)) dual (.A({DPRA5, DPRA4, DPRA3, DPRA2, DPRA1, DPRA0}), .Y(DPO));
endmodule

module RAM128X1D #(
    parameter INIT = 0, IS_WCLK_INVERTED = 0
) (
    output DPO, SPO, input D, WCLK, WE, input [6:0] A, DPRA
);
    \$lut #(.WIDTH(7), .LUT(128'd0)) single (.A(A), .Y(SPO));
    \$lut #(.WIDTH(7), .LUT(128'd0)) dual (.A(DPRA), .Y(DPO));
endmodule
