"""The Glint SoC: one description, built for the virtual board and for the RealDigital Urbana."""
