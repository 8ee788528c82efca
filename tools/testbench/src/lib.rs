//! Test benches for verilated designs: ports by name, and senders and receivers for streams.
//!
//! A [`Module`] is one instance of one module, with ports by name and a clock. A [`Source`] sends items to an input stream
//! of the module (valid/ready), a [`Sink`] takes items from an output stream; sources and sinks stall at random. A payload
//! must not change while it is valid and not taken: the source obeys this rule, and the sink checks it.
//!
//! `python gateware/tests/run.py --models` builds the modules; `cargo xtask test` builds them too.

mod bits;
mod counters;
mod layout;
mod library;
mod memory;
mod module;
pub mod raymarch;
mod record;
mod stream;

pub use bits::Bits;
pub use counters::Counters;
pub use layout::Layout;
pub use library::{Instance, LoadError};
pub use memory::{Memory, ReadPort, WritePort};
pub use module::{Module, Port};
pub use record::Record;
pub use stream::{Pipe, Sink, Source, Stalls, exchange, step};
