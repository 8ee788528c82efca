//! The machine and its main loop.
//!
//! Nothing in the loop waits: interrupts fill queues, and each turn takes what is there. A command whose answer has to
//! wait for a frame leaves a [`Job`]; what is typed meanwhile is kept.

use core::future::pending;
use core::pin::pin;
use core::time::Duration;

use embedded_hal::digital::StatefulOutputPin;
use glint_core::calibration::SAMPLES;
use glint_core::mpu6050::Stream;
use glint_hal::gpio::{InputPort, OutputPort};
use glint_hal::i2c::I2c;
use glint_hal::timer::{Clock, Deadline};
use litex_pac::cpu;
use litex_pac::ctrl::Ctrl;

use crate::commands::{self, Orbit, Refusal, Reply};
use crate::imu::{self, SensorJob};
use crate::interrupts::{self, UART};
use crate::models::Models;
use crate::renderer::Renderer;
use crate::replay::{self, Replay};
use crate::scene::Scene;
use crate::sensor::{self, Imu, Inbox};
use crate::terminal::{ConsoleUart, Input, Terminal};
use crate::transfer::Downloads;

/// Who this program and the gateware under it are.
#[derive(Clone, Copy)]
pub struct Identity {
    /// The id of the gateware that the program was built for.
    pub firmware: u32,
    /// The gateware's own id.
    pub gateware: u32,
    /// The gateware's blocks, a bit each.
    pub blocks: u32,
}

impl Identity {
    /// Whether registers lie where the program takes them to be.
    pub const fn matches(&self) -> bool {
        self.firmware == self.gateware
    }
}

/// What is touched only on the gateware that the program was built for.
pub struct Devices {
    /// The four buttons.
    pub buttons: InputPort<u8>,
    /// The sixteen switches.
    pub switches: InputPort<u16>,
    /// The sixteen LEDs.
    pub leds: OutputPort<u16>,
    /// The bus of the sensor, until its stream has it.
    pub i2c: Option<I2c>,
}

/// What the reply to a command waits for.
#[derive(Clone, Copy)]
pub enum Job {
    /// The frame of the scene as it is.
    Render,
    /// The frame of the scene as it is, to be sent.
    Frame {
        /// Its depth instead of its colours.
        depth: bool,
    },
    /// A turn around the model.
    Orbit(Orbit),
    /// What the sensor gives.
    Sensor(SensorJob),
    /// A log on its way to attitudes.
    Replay,
}

/// How long nothing is asked before a change is drawn. Who sends commands one by one gets one picture of them all, and
/// nobody sees the delay.
const QUIET: Duration = Duration::from_millis(2);

/// The button that calibrates the sensor: number 2.
const CALIBRATE: u8 = 1 << 2;
/// The button that makes where it points the middle: number 3.
const RECENTRE: u8 = 1 << 3;

/// Half a period of the light that shows life.
const HEARTBEAT: Duration = Duration::from_millis(500);

/// Everything.
pub struct Machine {
    /// Who we are.
    pub identity: Identity,
    /// Time.
    pub clock: Clock,
    /// The line, for transfers.
    pub uart: &'static ConsoleUart,
    /// The console on the line.
    pub terminal: Terminal,
    /// What is to be seen.
    pub scene: Scene,
    /// Its models.
    pub models: Models,
    /// Its renderers and frame buffers.
    pub renderer: Renderer,
    /// The sensor, and what follows it.
    pub imu: Imu,
    /// Devices, where they may be touched.
    pub devices: Option<Devices>,
    /// The SoC's reset.
    pub ctrl: Ctrl,
    /// Whether the LEDs show life; not since a command has set them.
    pub heartbeat: bool,
    /// What is sent.
    pub downloads: Downloads,
    /// The log in the staging memory, if there is one.
    pub replay: Option<Replay>,
    beat: Deadline,
    pressed: u8,
    quiet: Deadline,
    job: Option<Job>,
}

impl Machine {
    /// A machine about to run.
    pub fn new(
        identity: Identity,
        clock: Clock,
        scene: Scene,
        models: Models,
        renderer: Renderer,
        devices: Option<Devices>,
        ctrl: Ctrl,
    ) -> Self {
        Self {
            identity,
            clock,
            uart: &UART,
            terminal: Terminal::new(&UART, clock),
            scene,
            models,
            renderer,
            imu: Imu::default(),
            devices,
            ctrl,
            heartbeat: true,
            downloads: Downloads::new(&UART, clock),
            replay: None,
            beat: clock.after(Duration::ZERO),
            pressed: 0,
            quiet: clock.after(QUIET),
            job: None,
        }
    }

    /// Runs for ever.
    pub fn run(&mut self) -> ! {
        self.terminal
            .print(format_args!("Type help for the commands.\n"));
        self.terminal.prompt();
        let bus = self.devices.as_mut().and_then(|devices| devices.i2c.take());
        let clock = self.clock;
        let stream = pin!(async move {
            if let Some(bus) = bus {
                Stream::new(bus, clock, Inbox).run().await;
            }
            pending().await
        });
        // SAFETY: this function does not return.
        unsafe { sensor::start(stream) };
        loop {
            self.beat();
            self.heed_buttons();
            self.terminal.listen();
            sensor::deliver(&mut self.imu);
            self.answer();
            self.steer();
            self.draw();
            self.pursue();
            interrupts::sleep_unless(|| self.is_busy());
        }
    }

    /// Whether the next turn of the loop has something to do.
    fn is_busy(&mut self) -> bool {
        // Without video nothing would wake the machine for its heartbeat.
        self.answers_next()
            || self.renderer.is_ready(&self.scene)
            || sensor::has_news()
            || matches!(self.job, Some(Job::Replay))
            || !self.renderer.display.is_visible()
    }

    /// Whether the next turn of the loop has something to answer, or to hear.
    fn answers_next(&self) -> bool {
        if self.terminal.has_input() {
            self.takes_input()
        } else {
            self.uart.has_received()
        }
    }

    /// Whether a line is answered now; while an answer is owed it waits, and while the engine draws what a command may
    /// change. An orbit, what the sensor is asked for, and a replay end when something else is wanted.
    fn takes_input(&self) -> bool {
        matches!(
            self.job,
            None | Some(Job::Orbit(_) | Job::Sensor(_) | Job::Replay)
        ) && !self.renderer.is_busy()
    }

    /// Answers what was typed.
    fn answer(&mut self) {
        if !self.takes_input() {
            return;
        }
        let Some(input) = self.terminal.input() else {
            return;
        };
        if self.job.is_some() {
            self.finish(Ok(()));
        }
        match input {
            Input::Line(line) => match commands::execute(self, &line) {
                Reply::Nothing => self.terminal.prompt(),
                Reply::Now(result) => self.finish(result),
                Reply::After(job) => self.job = Some(job),
            },
            Input::Overlong => self.finish(Err(Refusal::Overlong)),
            Input::Interrupt => self.terminal.prompt(),
        }
    }

    /// Turns the camera as the sensor says, when there is a frame to draw on.
    fn steer(&mut self) {
        if self.renderer.is_busy() || self.renderer.display.back().is_none() {
            return;
        }
        let (eye, radius) = (self.scene.view().eye(), self.scene.sphere().r);
        if let Some(Ok(view)) = self.imu.view(eye, radius) {
            self.scene.move_view(view);
        }
    }

    /// Draws what has changed, if there is a frame to draw on.
    fn draw(&mut self) {
        if matches!(self.job, Some(Job::Render | Job::Frame { .. })) && self.scene.changed() {
            self.renderer.drop_pending();
        }
        let Self {
            terminal,
            scene,
            models,
            renderer,
            imu,
            ..
        } = self;
        let progress = || {
            terminal.listen();
            sensor::deliver(imu);
        };
        if (renderer.is_busy() || scene.changed() && (self.job.is_some() || self.quiet.passed()))
            && let Some(drawn) = renderer.draw(models.mesh(), scene, progress)
        {
            scene.set_drawn(drawn);
        }
    }

    /// Goes on with the job once its frame is drawn.
    fn pursue(&mut self) {
        if let Some(Job::Sensor(job)) = self.job {
            match imu::pursue(self, job) {
                Ok(job) => self.job = Some(Job::Sensor(job)),
                Err(result) => self.finish(result),
            }
            return;
        }
        if let Some(Job::Replay) = self.job {
            if let Some(result) = replay::pursue(self) {
                self.finish(result);
            }
            return;
        }
        if self.scene.changed() {
            return;
        }
        match self.job {
            None | Some(Job::Sensor(_) | Job::Replay) => {}
            Some(Job::Render) => {
                let result = commands::stats(self, false);
                self.finish(result);
            }
            Some(Job::Frame { depth }) => {
                let result = commands::send_frame(self, depth);
                self.finish(result);
            }
            Some(Job::Orbit(orbit)) => match orbit.step(&mut self.scene) {
                Some(orbit) => self.job = Some(Job::Orbit(orbit)),
                None => self.finish(Ok(())),
            },
        }
    }

    /// Ends a reply.
    fn finish(&mut self, result: Result<(), Refusal>) {
        self.job = None;
        self.scene.want_depth(false);
        self.quiet = self.clock.after(QUIET);
        match result {
            Ok(()) => self.terminal.print(format_args!("ok\n")),
            Err(error) => self.terminal.print(format_args!("error: {error}\n")),
        }
        self.terminal.prompt();
    }

    /// Does what the buttons are for, when one goes down.
    fn heed_buttons(&mut self) {
        let Some(devices) = &self.devices else {
            return;
        };
        let pressed = devices.buttons.read();
        let new = pressed & !self.pressed;
        self.pressed = pressed;
        if new & CALIBRATE != 0 {
            self.imu.calibrate(SAMPLES);
        }
        if new & RECENTRE != 0 {
            self.imu.recentre();
        }
    }

    /// Shows that the machine is alive.
    fn beat(&mut self) {
        if !self.beat.passed() {
            return;
        }
        self.beat = self.clock.after(HEARTBEAT);
        // A transfer whose end nobody tells is given up.
        sensor::advance(cpu::cycles_low());
        if let Some(devices) = self.devices.as_ref().filter(|_| self.heartbeat) {
            let Ok(()) = devices.leds.pin(0).toggle();
        }
    }
}
