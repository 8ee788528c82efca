//! Boards that run in real time, with their monitor and pins.

use crate::inputs::{Hold, Levels};
use crate::message::Pins;
use crate::motion::Motion;
use glint_board_api::pace::{Clock, Pace};
use glint_board_api::{
    Board, BoardError, Frame, Memory, SimulatedBoard, Simulation, read_in_steps,
};
use glint_program_image::Places;
use std::sync::Arc;
use std::time::Duration;

/// Time for which the board runs without interruption, in ms of the board's time.
const SLICE_MS: u64 = 1;

/// A board for the live page. A simulated board runs during a read from its line, at most at real-time speed. The default functions are
/// those of a board on a serial port: the host has no access to its memory, pins and monitor.
pub trait Live: Board {
    /// The motion sensor and the hand that the page moves; `None` for a board without access to its pins.
    fn motion(&self) -> Option<Arc<Motion>> {
        None
    }

    /// Sets buttons and switches, and returns the levels of all pins; `None` for a board without access to its pins.
    fn pins(&mut self, _levels: Levels) -> Option<Pins> {
        None
    }

    /// The picture on the monitor, if it has changed since the last call.
    ///
    /// # Errors
    /// The monitor shows no frame.
    fn picture(&mut self) -> Result<Option<Frame>, BoardError> {
        Ok(None)
    }

    /// Replaces the program by a memory image, and starts it. A board without direct access to its memory is loaded by its BIOS instead.
    ///
    /// # Errors
    /// The image exceeds main memory, or this board has no direct access to its memory.
    fn boot(&mut self, _program: &[u8]) -> Result<(), BoardError> {
        let error = "expected a simulated board, found one with a serial line only";
        Err(BoardError::simulation(error))
    }

    /// Returns the source locations of the board's first program, once.
    fn take_places(&mut self) -> Places {
        Places::default()
    }

    /// Interval of the measurements on the console. A serial line is slow, so by default it is long.
    fn sample_period(&self) -> Duration {
        Duration::from_secs(2)
    }

    /// The time of the clock that limits the board to real time; by default the board's time.
    fn clock(&self) -> Duration {
        Duration::from_millis(self.now_ms())
    }

    /// Time by which the board is ahead of its clock. The caller waits for this time if the clock
    /// cannot wait.
    fn early(&mut self) -> Duration {
        Duration::ZERO
    }
}

/// A simulated board that runs in real time.
pub struct LiveSimulation<S: ?Sized, C> {
    board: SimulatedBoard<S>,
    sample_period: Duration,
    motion: Arc<Motion>,
    hold: Hold,
    pace: Pace<C>,
    places: Places,
    /// The number of the last polled vertical blanking, and the picture shown at that time.
    shown: (u64, Option<Frame>),
}

impl<S: Simulation + ?Sized, C: Clock> LiveSimulation<S, C> {
    /// Wraps a board whose firmware is running, and connects a motion sensor and a camera to it. `places` are the source locations of the
    /// firmware. `clock` limits the board to real time. `sample_period` is the interval of the measurements on the console.
    pub fn new(
        mut board: SimulatedBoard<S>,
        places: Places,
        sample_period: Duration,
        clock: C,
    ) -> Self {
        let motion = Arc::new(Motion::default());
        board.inner().plug(motion.sensor());
        board.inner().plug_image_sensor(motion.camera());
        let simulation = board.inner();
        let pace = Pace::new(clock, simulation.clock_hz(), simulation.cycles());
        Self {
            board,
            sample_period,
            motion,
            hold: Hold::default(),
            pace,
            places,
            shown: (0, None),
        }
    }

    /// Waits until real time has reached the board's cycle, and runs the board for a slice.
    fn step(&mut self) {
        let simulation = self.board.inner();
        self.pace.wait(simulation.cycles());
        let clock = u64::from(simulation.clock_hz());
        simulation.run(clock / 1000 * SLICE_MS);
    }
}

impl<S: Simulation + ?Sized, C: Clock> Board for LiveSimulation<S, C> {
    fn write(&mut self, bytes: &[u8]) -> Result<(), BoardError> {
        self.board.write(bytes)
    }

    fn read(&mut self, bytes: &mut Vec<u8>, wait_ms: u64) -> Result<(), BoardError> {
        read_in_steps(self, bytes, wait_ms, |live, bytes, left| {
            if left > 0 {
                live.step();
            }
            live.board.read(bytes, 0)
        })
    }

    fn now_ms(&self) -> u64 {
        self.board.now_ms()
    }

    fn memory(&mut self) -> Option<&mut dyn Memory> {
        self.board.memory()
    }
}

impl<S: Simulation + ?Sized, C: Clock> Live for LiveSimulation<S, C> {
    fn motion(&self) -> Option<Arc<Motion>> {
        Some(Arc::clone(&self.motion))
    }

    fn pins(&mut self, levels: Levels) -> Option<Pins> {
        let buttons = self.hold.held(levels.buttons, self.board.now_ms());
        let simulation = self.board.inner();
        simulation.set_buttons(buttons);
        simulation.set_switches(levels.switches);
        Some(Pins {
            leds: simulation.leds(),
            digits: simulation.digits(),
            buttons,
            switches: levels.switches,
        })
    }

    fn picture(&mut self) -> Result<Option<Frame>, BoardError> {
        let Some((number, frame)) = self.board.inner().new_frame(self.shown.0)? else {
            return Ok(None);
        };
        self.shown.0 = number;
        if self.shown.1.as_ref() == Some(&frame) {
            return Ok(None);
        }
        self.shown.1 = Some(frame.clone());
        Ok(Some(frame))
    }

    fn boot(&mut self, program: &[u8]) -> Result<(), BoardError> {
        self.board.inner().boot(program)
    }

    fn take_places(&mut self) -> Places {
        std::mem::take(&mut self.places)
    }

    fn sample_period(&self) -> Duration {
        self.sample_period
    }

    fn clock(&self) -> Duration {
        self.pace.clock().now()
    }

    fn early(&mut self) -> Duration {
        let cycles = self.board.inner().cycles();
        self.pace.early(cycles)
    }
}
