//! Test benches for verilated designs: access to ports by name, and sources and sinks for streams.
//!
//! A [`Module`] is an instance of a module, with a clock and access to ports by name. A [`Source`] sends items to an input stream
//! of the module (valid/ready), a [`Sink`] takes items from an output stream; sources and sinks stall at random. A valid payload
//! must not change until it is taken: the source obeys this rule, and the sink checks it.
//!
//! `pytest gateware/tests/test_modules.py` builds the modules; `cargo xtask test` builds them too.

mod bits;
mod counters;
mod fog;
mod layout;
mod library;
mod memory;
mod module;
mod rasterizer;
pub mod raymarch;
mod raymarcher;
mod record;
mod sky;
mod stream;

pub use bits::Bits;
pub use counters::Counters;
pub use fog::drive_fog;
pub use layout::Layout;
pub use library::{Instance, LoadError};
pub use memory::{Memory, ReadPort, WritePort};
pub use module::{Module, Port};
pub use rasterizer::Rasterizer;
pub use raymarcher::{FrameCost, Raymarcher};
pub use record::Record;
pub use sky::drive_sky;
pub use stream::{Pipe, Sink, Source, Stalls, exchange, step};
