//! The live page of an emulated board, in a real browser. Needs the build of `cargo xtask firmware` and Debian's `chromium`.

mod browser;
mod page;
mod refusals;
mod serial;
mod served;
