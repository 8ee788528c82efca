//! The channel for messages between the pages and the session.

use crate::choices::{Choices, List};
use crate::hub::{Hub, Id};
use crate::inputs::Inputs;
use crate::live::Live;
use crate::message::ToPage;
use crate::motion::Motion;
use crate::orbit::Drag;
use crate::scene::Scene;
use glint_core::matrix::Axis;
use glint_program_image::Places;
use std::mem::{Discriminant, discriminant};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Maximum number of requests that are queued for the board.
pub const MAX_REQUESTS: usize = 64;

/// A request of a page to the session.
#[derive(Debug)]
pub enum Request {
    /// Enters a line on the console.
    Command(String),
    /// Shows the choice with this name in a list.
    Choose(List, String),
    /// Cancels the running command, or the transfer.
    Interrupt,
    /// Requests the description of a command.
    Help(String),
    /// Downloads the picture over the console.
    Picture,
    /// Uploads a mesh or a texture, and shows it.
    Upload(Upload),
    /// Uploads the files of a scene, and shows it.
    Scene(Scene),
    /// Starts a program in place of the running one.
    Start(Program),
}

/// A program for the soft core.
#[derive(Debug)]
pub struct Program {
    /// Name of its file.
    pub name: String,
    /// Its memory image.
    pub image: Vec<u8>,
    /// The source locations of its code.
    pub places: Places,
}

/// A mesh or a texture to upload.
#[derive(Debug)]
pub struct Upload {
    /// Its name on the board.
    pub name: String,
    /// The mesh or the texture in the board's memory layout.
    pub bytes: Vec<u8>,
    /// The axis of a mesh that points up; `None` for a texture.
    pub up: Option<Axis>,
    /// The remarks on the file.
    pub remarks: Vec<String>,
}

impl Request {
    /// The kind of the request and, for [`Request::Help`], its command. A later request replaces a
    /// waiting request with the same key.
    pub fn key(&self) -> (Discriminant<Self>, &str) {
        let command = match self {
            Self::Help(command) => command,
            Self::Command(_) | Self::Choose(..) | Self::Interrupt => "",
            Self::Picture | Self::Upload(_) | Self::Scene(_) | Self::Start(_) => "",
        };
        (discriminant(self), command)
    }
}

/// The channel for messages between the pages and the board.
pub struct Channels {
    /// The viewers and their message queues.
    pub hub: Hub,
    /// The levels of buttons and switches, which the viewer with control sets.
    pub inputs: Inputs,
    /// The motion sensor and the hand, if the page moves them.
    pub motion: Option<Arc<Motion>>,
    /// The choices of the firmware.
    choices: Mutex<Arc<Choices>>,
    /// The requested motion of the camera that the session has not executed yet.
    drag: Mutex<Option<Drag>>,
    /// Whether a page has cancelled the transfer or the wait that the session is in.
    is_cancelled: AtomicBool,
    /// The sender of requests to the session.
    requests: SyncSender<Request>,
}

impl Channels {
    /// Creates the channel to the board `name`, which several pages may use if `is_shared`, and the
    /// session's receiver of requests.
    pub fn new(board: &dyn Live, name: &str, is_shared: bool) -> (Self, Receiver<Request>) {
        let (channels, requests) = Self::to_board(board.motion());
        channels.hub.send(&ToPage::Board {
            name: name.to_owned(),
            has_pins: channels.motion.is_some(),
            is_shared,
        });
        (channels, requests)
    }

    /// Creates the channel to a board whose motion sensor and hand follow `motion`.
    #[must_use]
    pub fn to_board(motion: Option<Arc<Motion>>) -> (Self, Receiver<Request>) {
        let (requests, queue) = sync_channel(MAX_REQUESTS);
        let channels = Self {
            hub: Hub::default(),
            inputs: Inputs::default(),
            motion,
            choices: Mutex::default(),
            drag: Mutex::default(),
            is_cancelled: AtomicBool::new(false),
            requests,
        };
        (channels, queue)
    }

    fn lock_drag(&self) -> MutexGuard<'_, Option<Drag>> {
        self.drag.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Adds a motion to the requested motion of the camera.
    pub fn drag(&self, drag: Drag) {
        let mut waiting = self.lock_drag();
        *waiting = Some(waiting.unwrap_or(Drag::NONE).then(&drag));
    }

    /// Takes the motion of the camera that was requested since the last call.
    pub fn take_drag(&self) -> Option<Drag> {
        self.lock_drag().take()
    }

    fn lock_choices(&self) -> MutexGuard<'_, Arc<Choices>> {
        self.choices.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The choices of the firmware.
    pub fn choices(&self) -> Arc<Choices> {
        Arc::clone(&self.lock_choices())
    }

    /// Sets the choices of the firmware.
    pub fn set_choices(&self, choices: Choices) {
        *self.lock_choices() = Arc::new(choices);
    }

    /// Whether a page has cancelled a transfer or a wait since the last call: by [`Request::Interrupt`], or by [`Request::Start`] of
    /// another program.
    pub fn take_cancelled(&self) -> bool {
        self.is_cancelled.swap(false, Ordering::Relaxed)
    }

    /// Queues a request for the session. Returns whether the queue had room.
    fn queue(&self, request: Request) -> bool {
        if matches!(request, Request::Interrupt | Request::Start(_)) {
            self.is_cancelled.store(true, Ordering::Relaxed);
        }
        // Other errors mean that the session has ended, which happens only at the end of the
        // program.
        !matches!(self.requests.try_send(request), Err(TrySendError::Full(_)))
    }

    /// Requests the start of a program. If the queue is full, the request is dropped.
    pub fn start(&self, program: Program) {
        if !self.queue(Request::Start(program)) {
            self.hub
                .notify("the board is busy: a program was dropped", true);
        }
    }

    /// Passes a request of a viewer to the session. If the queue is full, the request is dropped
    /// and the viewer receives a notice.
    pub fn request(&self, id: Id, request: Request) {
        if !self.queue(request) {
            self.hub
                .notify_one(id, "the board is busy: a command was dropped");
        }
    }
}
