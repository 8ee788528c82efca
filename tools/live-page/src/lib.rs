//! The live page without its transport: a board in a web browser.
//!
//! | module | purpose |
//! |---|---|
//! | [`files`] | the files of the page |
//! | [`choices`] | the scenes, meshes and fields that the page offers |
//! | [`channels`] | the channel for messages between the pages and the session |
//! | [`message`] | messages between the page and the board's side |
//! | [`viewer`] | one open page: acts on its messages |
//! | [`beside`] | the files that come with a mesh |
//! | [`hub`] | passes pictures, texts and levels to all viewers; one of them has control |
//! | [`inputs`] | the levels that the page sets |
//! | [`motion`] | the motion sensor that the page turns, and the hand that it moves |
//! | [`live`] | boards that run in real time, with their monitor and pins |
//! | [`orbit`] | the camera that the page moves by dragging on the picture |
//! | [`scene`] | scene files that a page sends |
//! | [`session`] | runs the board, its console and its transfers |
//!
//! A program passes the messages over sockets (`glint board --web`), or the board runs in the browser itself (`cargo xtask web`).
//! docs/live-page.md describes the page and the messages.
#![forbid(unsafe_code)]

pub mod beside;
pub mod channels;
pub mod choices;
pub mod files;
pub mod hub;
pub mod inputs;
pub mod live;
pub mod message;
pub mod motion;
pub mod orbit;
pub mod scene;
pub mod session;
pub mod viewer;

pub use channels::Channels;
pub use glint_program_image::Places;
pub use hub::Hub;
pub use live::{Live, LiveSimulation};
pub use message::Message;
pub use session::Session;
pub use viewer::Viewer;
