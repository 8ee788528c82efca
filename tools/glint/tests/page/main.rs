//! The live page of an emulated board, in a real browser. Requires the builds of `cargo xtask firmware`, `cargo xtask web`
//! and `cargo xtask gateware`, and Debian's `chromium`.

mod alone;
mod browser;
mod busy;
mod buttons;
mod connected;
mod controls;
mod page;
mod programs;
mod project;
mod rates;
mod refusals;
mod serial;
mod served;
mod upload;
