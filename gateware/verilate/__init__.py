"""Verilated designs as shared libraries: one module for the tests in `tools/testbench`, or the SoC of the virtual board.

Both have the C interface of `tools/testbench/harness/interface.h`, with Verilator's own description of ports and types in it.

    PYTHONPATH=gateware python -m verilate FOLDER [--waveforms]
                                           builds the virtual board whose Verilog LiteX left in FOLDER
"""
