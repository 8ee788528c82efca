//! The channel for messages between the pages and the session.

use crate::hub::{Hub, Id};
use crate::inputs::Inputs;
use crate::live::Live;
use crate::message::ToPage;
use crate::motion::Motion;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};

/// Maximum number of commands that wait for the board.
pub const MAX_REQUESTS: usize = 64;

/// A wish of a page.
#[derive(Debug)]
pub enum Request {
    /// Types a line on the console.
    Command(String),
    /// Ends the running command.
    Interrupt,
    /// Asks for the description of a command.
    Help(String),
    /// Fetches the picture over the console.
    Picture,
    /// Uploads a mesh, and shows it.
    Upload(Vec<u8>),
}

/// The channel for messages between the pages and the board.
pub struct Channels {
    /// The viewers.
    pub hub: Hub,
    /// The levels that the viewer with control sets.
    pub inputs: Inputs,
    /// The motion sensor and the hand, if the page moves them.
    pub motion: Option<Arc<Motion>>,
    /// The commands for the board.
    requests: SyncSender<Request>,
}

impl Channels {
    /// The channel to the board with this name, for one page or several, and the channel's end from which the session takes commands.
    pub fn new(board: &dyn Live, name: &str, is_shared: bool) -> (Self, Receiver<Request>) {
        let (channels, requests) = Self::to_board(board.motion());
        channels.hub.send(&ToPage::Board {
            name: name.to_owned(),
            has_pins: channels.motion.is_some(),
            is_shared,
        });
        (channels, requests)
    }

    /// The channel to a board with the motion sensor and the hand of `motion`.
    #[must_use]
    pub fn to_board(motion: Option<Arc<Motion>>) -> (Self, Receiver<Request>) {
        let (requests, queue) = sync_channel(MAX_REQUESTS);
        let channels = Self {
            hub: Hub::default(),
            inputs: Inputs::default(),
            motion,
            requests,
        };
        (channels, queue)
    }

    /// Passes a request of a viewer to the session; it is dropped, with a notice, if too many wait.
    pub fn request(&self, id: Id, request: Request) {
        // The session ends with the program.
        if let Err(TrySendError::Full(_)) = self.requests.try_send(request) {
            self.hub
                .notify_one(id, "the board is busy: a command was dropped");
        }
    }
}
