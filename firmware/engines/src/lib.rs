//! What ties the drivers of the engines to frames: they take registers and numbers, and get them here from the model's frame constants
//! and from the control of the hand.

#![no_std]
#![forbid(unsafe_code)]

pub mod gesture;
pub mod raymarch;
pub mod triangle;
