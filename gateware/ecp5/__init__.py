"""Bitstreams for ECP5 FPGAs by Yosys, nextpnr and Project Trellis, whose packages are on PyPI."""
