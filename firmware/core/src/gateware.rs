//! Numbers and layouts that the gateware defines.

pub mod bits;
pub mod block;
#[rustfmt::skip]
pub mod constants;
#[rustfmt::skip]
pub mod records;
