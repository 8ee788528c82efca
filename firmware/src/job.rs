//! Replies of commands, and jobs: work that continues after a command.

use core::task::Poll;

use glint_core::fixed::Turns;
use glint_hal::timer::Deadline;
use glint_scene::{Scene, Sphere};

use crate::arena::Loan;
use crate::error::CommandError;
use crate::transfer::{Purpose, Transfer};

/// The result of a command.
pub type CommandResult<'l> = Result<Reply, CommandError<'l>>;

/// The result of a job; `Poll::Pending` until the job has ended.
pub type JobResult = Poll<CommandResult<'static>>;

/// The reply of a successful command.
#[expect(
    clippy::large_enum_variant,
    reason = "one reply exists at a time, and there is no heap"
)]
pub enum Reply {
    /// The command is complete.
    Done,
    /// The command is complete after this job has ended.
    After(Job),
}

/// Work that continues after a command has returned.
#[expect(
    clippy::large_enum_variant,
    reason = "one job exists at a time, and there is no heap"
)]
pub enum Job {
    /// Draws the scene.
    Draw,
    /// Draws the scene, then prints the frame's statistics.
    Render,
    /// Draws the scene, then sends the frame.
    Frame {
        /// Whether to send depth codes in place of colours.
        depth: bool,
    },
    /// Moves the camera in a full turn around the model.
    Orbit(Orbit),
    /// Calibrates the sensor, or prints samples.
    Sensor(SensorJob),
    /// Computes the attitude after each sample of an uploaded log, in this memory.
    Replay(Loan),
    /// Calibrates the hand's colour, or sends the hand's mask.
    Gesture(GestureJob),
    /// Receives or sends data.
    Transfer(Transfer),
}

impl Job {
    /// Whether the next line of input ends the job. During all other jobs, a line waits until the job has ended.
    pub const fn ends_by_line(&self) -> bool {
        match self {
            Self::Orbit(_) | Self::Sensor(_) | Self::Replay(_) => true,
            Self::Draw | Self::Render | Self::Frame { .. } => false,
            Self::Gesture(_) | Self::Transfer(_) => false,
        }
    }

    /// Whether the job waits for the next picture of the scene.
    pub const fn awaits_picture(&self) -> bool {
        match self {
            Self::Draw | Self::Render | Self::Frame { .. } => true,
            Self::Orbit(_) | Self::Sensor(_) | Self::Replay(_) => false,
            Self::Gesture(_) | Self::Transfer(_) => false,
        }
    }

    /// Whether the demo may show another scene during the job. The demo pauses during jobs that print, and during the upload of a log. The
    /// replay writes the attitudes to the staging memory, so no mesh of the flash may be copied there.
    pub const fn allows_demo(&self) -> bool {
        match self {
            Self::Transfer(transfer) => match transfer.purpose {
                Purpose::Upload(_) | Purpose::Program(_) | Purpose::Download => true,
                Purpose::Log => false,
            },
            Self::Draw | Self::Render | Self::Frame { .. } => false,
            Self::Orbit(_) | Self::Sensor(_) | Self::Replay(_) | Self::Gesture(_) => false,
        }
    }
}

/// A job that waits for a small picture of the image sensor.
pub struct GestureJob {
    /// Whether the picture has colours, for a calibration, or marks, for a download.
    pub is_colour: bool,
    /// Time at which the job fails if no picture has arrived.
    pub end: Deadline,
}

/// A job of the sensor.
pub enum SensorJob {
    /// Reports the progress of a calibration until the calibration ends.
    Calibrate {
        /// Number of samples at the last report.
        reported: u32,
    },
    /// Prints samples.
    Stream {
        /// Number of samples still to print; `None` for no limit.
        left: Option<u32>,
        /// Number of the last printed sample.
        last: u32,
    },
}

/// A full turn of the camera about the z axis, in steps of one frame.
pub struct Orbit {
    start: Sphere,
    frames: u32,
    frame: u32,
}

/// Default number of frames of a full turn: one frame for each 1.5°.
const ORBIT_FRAMES: u32 = 240;

impl Orbit {
    /// A turn that begins at `start`, and takes `frames` frames, or [`ORBIT_FRAMES`] for `None`.
    pub fn new(start: Sphere, frames: Option<u32>) -> Self {
        Self {
            start,
            frames: frames.unwrap_or(ORBIT_FRAMES),
            frame: 0,
        }
    }

    /// Moves the camera to its position for the next frame, until the turn is complete.
    pub fn poll(&mut self, scene: &mut Scene) -> JobResult {
        if self.frame == self.frames {
            return Poll::Ready(Ok(Reply::Done));
        }
        self.frame += 1;
        // The shifted frame number fits 64 bits. The quotient is at most one full turn, 2^32, which wraps to 0.
        let turned = Turns(((u64::from(self.frame) << 32) / u64::from(self.frames)) as u32);
        let sphere = Sphere {
            theta: self.start.theta.wrapping_add(turned),
            ..self.start
        };
        match scene.set_sphere(sphere) {
            Ok(()) => Poll::Pending,
            Err(error) => Poll::Ready(Err(CommandError::View(error))),
        }
    }
}
