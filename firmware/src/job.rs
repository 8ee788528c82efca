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
    /// The command is done.
    Done,
    /// The command is done when this job has ended.
    After(Job),
}

/// Work that continues after a command has returned.
#[expect(
    clippy::large_enum_variant,
    reason = "one job exists at a time, and there is no heap"
)]
pub enum Job {
    /// Draw the scene.
    Draw,
    /// Draw the scene, then print the frame's statistics.
    Render,
    /// Draw the scene, then send the frame.
    Frame {
        /// Send depth codes, not colour.
        depth: bool,
    },
    /// Turn the camera once around the model.
    Orbit(Orbit),
    /// Calibrate the sensor, or print its samples.
    Sensor(SensorJob),
    /// Compute the attitudes after the samples of an uploaded log, in this memory.
    Replay(Loan),
    /// Calibrate the hand's colour, or send its mask.
    Gesture(GestureJob),
    /// Receive or send data.
    Transfer(Transfer),
}

impl Job {
    /// Whether the next line ends the job. A line waits until any other job has ended.
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

    /// Whether the demo may show another scene during the job. It pauses during jobs that print, and during the upload of a log: the
    /// attitudes will be in the staging memory, so no mesh of the flash may be placed after the log.
    pub const fn allows_demo(&self) -> bool {
        match self {
            Self::Transfer(transfer) => match transfer.purpose {
                Purpose::Upload(_) | Purpose::Program | Purpose::Download => true,
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
    /// Time at which the job fails.
    pub end: Deadline,
}

/// A job of the sensor.
pub enum SensorJob {
    /// Report the calibration until it ends.
    Calibrate {
        /// Number of samples at the last report.
        reported: u32,
    },
    /// Print samples.
    Stream {
        /// Number of samples still to print; `None` for no limit.
        left: Option<u32>,
        /// Number of the last printed sample.
        last: u32,
    },
}

/// A full turn of the spherical camera about the z axis, one frame at a time.
pub struct Orbit {
    start: Sphere,
    frames: u32,
    frame: u32,
}

/// Default number of frames of a full turn: one frame for each 1.5°.
const ORBIT_FRAMES: u32 = 240;

impl Orbit {
    /// A turn that begins at `start` and takes `frames` frames, or the default number of frames.
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
        // The shifted number of the frame fits 64 bits. The quotient is at most one full turn, 2^32, which wraps to 0.
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
