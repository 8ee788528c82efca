"""Measurements of the gateware: cells by Yosys, clock rates by place and route, against `gateware/budget.toml`."""
