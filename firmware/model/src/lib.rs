//! Bit-exact twins of Glint's accelerators.
#![no_std]
#![forbid(unsafe_code)]
