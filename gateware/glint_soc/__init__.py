"""The Glint SoC: one description, built for the virtual board, the RealDigital Urbana and the Radiona ULX3S."""
