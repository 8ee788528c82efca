"""Builds verilated designs as shared libraries: one module for the tests in `tools/testbench`, or the SoC of the virtual board.

Both kinds of libraries have the C interface of `tools/testbench/harness/interface.h`, which includes a description of the ports
and their types.

    PYTHONPATH=gateware python -m verilate FOLDER [--waveforms]
                                           builds the virtual board from LiteX's Verilog in FOLDER
"""
