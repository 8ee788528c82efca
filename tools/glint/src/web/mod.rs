//! The live page: a board in a web browser.
//!
//! | module | purpose |
//! |---|---|
//! | [`message`] | messages between the page and the server |
//! | [`server`] | listens, checks the requests, serves the files of the page |
//! | [`viewer`] | one open page: its messages, and its queue |
//! | [`hub`] | passes pictures, texts and levels to all viewers; one of them has control |
//! | [`inputs`] | the levels and motions that the page sets |
//! | [`motion`] | the motion sensor that the page turns, and the hand that it moves |
//! | [`live`] | boards in real time, with their monitor and pins |
//! | [`session`] | runs the board, its console and its transfers |
//!
//! docs/live-page.md describes the page and the messages.

pub mod hub;
pub mod inputs;
pub mod live;
pub mod message;
pub mod motion;
pub mod server;
pub mod session;
pub mod viewer;

pub use live::{Live, LiveSerial, LiveSimulation};
pub use server::Server;
