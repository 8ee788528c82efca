//! Adapters from the model to the drivers of the engines: they convert frame constants and the settings of gesture control to register
//! values.

#![no_std]
#![forbid(unsafe_code)]

pub mod gesture;
pub mod raymarch;
pub mod triangle;
