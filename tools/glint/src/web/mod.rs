//! Serves the live page: a board in a web browser.
//!
//! | module | purpose |
//! |---|---|
//! | [`server`] | listens, checks the requests, serves the files of the page |
//! | [`connection`] | the connection to one open page |
//! | `watch` | starts a program again whenever its file changes |
//! | `serial` | the page of a board on a serial port |
//!
//! `glint_live_page` contains the page, its messages and the session with the board. docs/live-page.md describes the page and the
//! messages.

pub mod connection;
mod serial;
pub mod server;
mod watch;

pub use server::Server;
pub use watch::{Watched, read_program};
