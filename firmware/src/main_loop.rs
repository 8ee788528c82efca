//! The main loop, which runs each task in turn. The CPU sleeps while all tasks wait.
//!
//! A turn of a task never blocks: interrupts fill queues, and each task processes the contents of its queues. A command whose reply needs a
//! frame, samples or a transfer starts a [`Job`], which is polled like a task. Input waits in the UART's queue until the job has ended.

use core::future::pending;
use core::pin::pin;
use core::task::Poll;
use core::time::Duration;

use glint_core::calibration::SAMPLES;
use glint_core::feature::{ANIMATE, DEMO, GESTURE, IMU, WIREFRAME};
use glint_core::fixed::U32_32;
use glint_core::gesture::Pose;
use glint_core::mpu6050::Stream;
use glint_core::tasks::{self, Turn};
use glint_hal::timer::{Clock, Deadline};
use glint_program::hardware::Devices;
use glint_program::interrupts;
use glint_program::sensor::{self, Imu, Inbox};
use glint_scene::{Scene, Sphere};

use crate::commands::{self, gesture as gesture_commands, imu, replay, statistics};
use crate::demo::Demo;
use crate::error::CommandError;
use crate::indicators::Indicators;
use crate::job::{Job, Reply};
use crate::machine::Machine;
use crate::panel::HOLD;
use crate::renderer;
use crate::terminal::Input;
use crate::wireframe::{self, Keypad};

/// Idle time after a reply before the scene is redrawn. This time is too short to be visible, but lets a series of commands cause only one
/// frame.
const QUIET: Duration = Duration::from_millis(2);

/// Bit of button 2, which calibrates the sensor.
const CALIBRATE: u8 = 1 << 2;
/// Bit of button 3, which recentres the camera.
const RECENTRE: u8 = 1 << 3;

/// The tasks in the order of their turns.
const TASKS: [fn(&mut MainLoop) -> Turn; 12] = [
    // Drawing comes first, because after an interrupt the gateware waits for the next pass of its frame.
    MainLoop::draw,
    MainLoop::poll_job,
    MainLoop::run_demo,
    MainLoop::indicate,
    MainLoop::poll_panel,
    // Drawing comes again, because an iteration of the loop is long compared with a pass of the gateware.
    MainLoop::draw,
    MainLoop::listen,
    |all| sensor::deliver(&mut all.machine.imu),
    MainLoop::follow_hand,
    MainLoop::answer,
    MainLoop::steer,
    MainLoop::step,
];

/// The machine and the state of its main loop.
pub struct MainLoop {
    machine: Machine,
    job: Option<Job>,
    indicators: Indicators,
    /// End of the idle time after a reply.
    quiet: Deadline,
}

impl MainLoop {
    /// Creates the main loop of `machine`.
    pub fn new(machine: Machine) -> Self {
        let clock = machine.clock;
        Self {
            machine,
            job: None,
            indicators: Indicators::new(clock),
            quiet: clock.after(QUIET),
        }
    }

    /// Runs the tasks in an endless loop.
    pub fn run(&mut self) -> ! {
        let terminal = &mut self.machine.terminal;
        terminal.print(format_args!("Type help for the commands.\n"));
        terminal.prompt();
        let devices = self.machine.devices.as_mut();
        let bus = devices.and_then(|devices| devices.i2c.take());
        let clock = self.machine.clock;
        let stream = pin!(async move {
            if let Some(bus) = bus {
                Stream::new(bus, clock, Inbox).run().await;
            }
            pending().await
        });
        // SAFETY: this function does not return.
        unsafe { sensor::start(stream) };
        self.power_up();
        loop {
            tasks::step(self, &TASKS, interrupts::count, interrupts::sleep);
        }
    }

    /// Starts the demo, if the flash has a list or damaged contents. The first picture then shows the list's first scene.
    fn power_up(&mut self) {
        let machine = &mut self.machine;
        if let Some((name, error)) = machine.demo.power_up(&machine.library) {
            let number = machine.demo.error().unwrap_or(0);
            let text = format_args!("demo: error {number}: {name}: {error}");
            machine.terminal.notify(text);
        }
        self.run_demo();
    }

    /// Continues the demo: shows the next scene when the scene is due, and moves the camera in scenes with an orbit.
    fn run_demo(&mut self) -> Turn {
        let machine = &mut self.machine;
        let is_allowed = self.job.as_ref().is_none_or(Job::allows_demo);
        if !machine.demo.is_on() || !is_allowed || machine.renderer.is_busy() {
            return Turn::Wait;
        }
        let mut turn = Turn::Wait;
        let is_outdated = machine.needs_picture();
        if let (Some(orbit), false) = (&mut machine.demo.orbit, is_outdated) {
            turn = Turn::Again;
            if orbit.poll(&mut machine.scene).is_ready() {
                machine.demo.orbit = None;
            }
        }
        if (machine.demo.turns)
            .poll(machine.clock.milliseconds())
            .is_none()
        {
            return turn;
        }
        machine.demo.orbit = None;
        let name = machine.demo.scene().unwrap_or_default();
        match commands::show_scene(machine, name) {
            Ok(Reply::After(Job::Orbit(orbit))) => machine.demo.orbit = Some(orbit),
            // If only a sensor is missing, the scene is shown without motion.
            Ok(_) => {}
            Err(error) if error.is_of_sensor() => {}
            Err(error) => {
                let number = error.number();
                if machine.demo.set_error(number) {
                    let text = format_args!("demo: error {number}: {error}");
                    machine.terminal.notify(text);
                }
            }
        }
        Turn::Again
    }

    /// Receives input from the serial line.
    fn listen(&mut self) -> Turn {
        let Machine {
            terminal, models, ..
        } = &mut self.machine;
        terminal.names.update(models);
        terminal.listen()
    }

    /// Executes the line that the terminal has received, if the line is complete, the gateware has drawn its frame, and the job has ended
    /// or is ended by the line.
    fn answer(&mut self) -> Turn {
        let is_free = self.job.as_ref().is_none_or(Job::ends_by_line);
        if !is_free || self.machine.renderer.is_busy() {
            return Turn::Wait;
        }
        let Some(input) = self.machine.terminal.input() else {
            return Turn::Wait;
        };
        if self.job.is_some() {
            // The prompt follows the reply; the line itself is already on the screen.
            self.end_job(Ok(()));
        }
        match input {
            Input::Line(line) => match commands::execute(&mut self.machine, &line) {
                Ok(None) => self.machine.terminal.prompt(),
                Ok(Some(Reply::Done)) => self.finish(Ok(())),
                Ok(Some(Reply::After(job))) => self.job = Some(job),
                Err(error) => self.finish(Err(error)),
            },
            Input::Overlong => self.finish(Err(CommandError::Overlong)),
            Input::Interrupt => self.machine.terminal.prompt(),
        }
        Turn::Again
    }

    /// Computes the camera's position from a new frame of the image sensor.
    fn follow_hand(&mut self) -> Turn {
        match &mut self.machine.gesture {
            Some(gesture) if GESTURE.is_built => gesture.poll(),
            _ => Turn::Wait,
        }
    }

    /// Turns the camera to the sensor's attitude, or moves the camera to the position that the hand sets, if a frame can be drawn.
    fn steer(&mut self) -> Turn {
        let machine = &mut self.machine;
        if machine.renderer.is_busy() || machine.renderer.display.back().is_none() {
            return Turn::Wait;
        }
        let (scene, picture) = (&mut machine.scene, &mut machine.picture);
        let mut turn = Turn::Wait;
        if GESTURE.is_built
            && let Some(gesture) = &mut machine.gesture
        {
            if let Some(Pose { r, theta, phi }) = gesture.move_to() {
                // Gesture control limits the distance, so the camera is in range.
                let _ = scene.set_sphere(Sphere { r, theta, phi });
                if !picture.is_outdated(scene, &machine.models) {
                    gesture.on_unchanged();
                }
                turn = Turn::Again;
            }
            if picture.marker != gesture.marker() {
                picture.marker = gesture.marker();
                turn = Turn::Again;
            }
        }
        let (eye, radius) = (scene.view.eye(), scene.sphere.r);
        if IMU.is_built
            && let Some(Ok(view)) = machine.imu.view(eye, radius)
        {
            scene.move_view(view);
            turn = Turn::Again;
        }
        turn
    }

    /// Moves the wireframe by one key request, or to its start, if a frame can be drawn, so that each frame has at most one step.
    fn step(&mut self) -> Turn {
        let machine = &mut self.machine;
        if !WIREFRAME.is_built
            || !machine.keypad.has_request()
            || machine.renderer.is_busy()
            || machine.renderer.display.back().is_none()
            || machine.needs_picture()
        {
            return Turn::Wait;
        }
        if machine.keypad.take_reset() {
            // Another scene may have been shown since the buttons were pressed.
            if machine.scene.wireframe().is_some() {
                machine.scene.show_wireframe();
            }
            return Turn::Again;
        }
        let (Some(devices), Some(key)) = (&machine.devices, machine.keypad.take()) else {
            return Turn::Wait;
        };
        let rotates = wireframe::rotates(devices.switches.read());
        machine.scene.move_wireframe(key.step(rotates));
        Turn::Again
    }

    /// Advances the scene's animation to the time of the frame that begins now. A command that waits for a picture gets the scene without
    /// this step. The azimuth is constant while sensor, hand or `orbit` move the camera.
    fn animate(&mut self) {
        let machine = &mut self.machine;
        let is_awaited = self.job.as_ref().is_some_and(Job::awaits_picture);
        if !ANIMATE.is_built || is_awaited || machine.renderer.display.back().is_none() {
            return;
        }
        let is_steered = machine.imu.follow().is_some()
            || (machine.gesture.as_ref()).is_some_and(|gesture| gesture.sensor().is_some())
            || matches!(self.job, Some(Job::Orbit(_)))
            || machine.demo.orbit.is_some();
        let clock = machine.clock;
        let now = || U32_32::from_bits(clock.frequency().seconds(clock.cycles()));
        (machine.animator).advance(&mut machine.scene, now, !is_steered);
    }

    /// Draws the scene if it has changed and a frame buffer is free.
    fn draw(&mut self) -> Turn {
        // The scene must not change while the gateware draws.
        let begins = !self.machine.renderer.is_busy();
        if begins {
            self.animate();
        }
        let Machine {
            terminal,
            scene,
            picture,
            models,
            renderer,
            imu,
            devices,
            keypad,
            clock,
            gesture,
            demo,
            heartbeat,
            ..
        } = &mut self.machine;
        let job = &mut self.job;
        if begins {
            if !picture.is_outdated(scene, models) {
                return Turn::Wait;
            }
            if job.as_ref().is_some_and(Job::awaits_picture) {
                renderer.drop_pending();
            }
            if job.is_none() && !self.quiet.passed() {
                // No interrupt signals the end of this short idle time, so the loop polls.
                return Turn::Again;
            }
        } else if !renderer.is_due() {
            return Turn::Wait;
        }
        // Runs other tasks while the CPU draws.
        let mut progress = || {
            if let Some(Job::Transfer(transfer)) = job {
                transfer.poll(terminal, *clock);
            }
            terminal.listen();
            sensor::deliver(imu);
            poll_buttons(devices, keypad, *clock, scene, imu, demo);
            self.indicators
                .poll(devices, demo, picture, imu, *heartbeat);
        };
        if begins {
            models.update(scene, &mut progress);
        }
        let Some(drawn) = renderer::draw(renderer, models, scene, picture, progress) else {
            return Turn::worked(renderer.is_ready());
        };
        picture.set_drawn(drawn, scene, models);
        // During a job the serial line carries the job's reply, which already contains the reason.
        if job.is_none()
            && let Some(note) = picture.take_note()
        {
            terminal.notify(format_args!("note: {note}"));
        }
        if GESTURE.is_built
            && let Some(gesture) = gesture
        {
            gesture.on_drawn();
        }
        Turn::Again
    }

    /// Continues the job of a command, if any, and ends the command's reply when the job has ended.
    fn poll_job(&mut self) -> Turn {
        let machine = &mut self.machine;
        let Some(job) = &mut self.job else {
            return Turn::Wait;
        };
        let mut turn = Turn::Wait;
        let result = match job {
            Job::Transfer(transfer) => {
                turn = transfer.poll(&mut machine.terminal, machine.clock);
                // An upload may overwrite a mesh that is being drawn.
                if transfer.is_over() && !machine.renderer.is_busy() {
                    Poll::Ready(commands::finish(machine, transfer))
                } else {
                    Poll::Pending
                }
            }
            Job::Sensor(job) => imu::poll(machine, job),
            Job::Replay(memory) => {
                turn = Turn::Again;
                replay::poll(machine, memory)
            }
            Job::Gesture(job) => gesture_commands::poll(machine, job),
            Job::Draw | Job::Render | Job::Frame { .. } | Job::Orbit(_)
                if machine.needs_picture() =>
            {
                Poll::Pending
            }
            Job::Draw => Poll::Ready(Ok(Reply::Done)),
            Job::Render => Poll::Ready(statistics::print(machine, false).map(|()| Reply::Done)),
            Job::Frame { depth } => Poll::Ready(commands::begin_download(machine, *depth)),
            Job::Orbit(orbit) => {
                turn = Turn::Again;
                orbit.poll(&mut machine.scene)
            }
        };
        match result {
            Poll::Pending => return turn,
            Poll::Ready(Ok(Reply::After(next))) => self.job = Some(next),
            Poll::Ready(Ok(Reply::Done)) => self.finish(Ok(())),
            Poll::Ready(Err(error)) => self.finish(Err(error)),
        }
        Turn::Again
    }

    /// Ends the reply of a command, and its job if it has one, and prints the prompt.
    fn finish(&mut self, result: Result<(), CommandError>) {
        self.end_job(result);
        self.machine.terminal.prompt();
    }

    /// Ends the reply of a command, and its job if it has one.
    fn end_job(&mut self, result: Result<(), CommandError>) {
        let machine = &mut self.machine;
        if let Some(Job::Replay(memory)) = self.job.take() {
            machine.give_back(memory);
        }
        machine.picture.wants_depth = false;
        self.quiet = machine.clock.after(QUIET);
        match result {
            Ok(()) => machine.terminal.print(format_args!("ok\n")),
            Err(error) => machine.terminal.print(format_args!("error: {error}\n")),
        }
    }

    /// Handles buttons and switches that have changed since the last turn.
    fn poll_panel(&mut self) -> Turn {
        let Machine {
            devices,
            keypad,
            switches,
            clock,
            scene,
            imu,
            demo,
            renderer,
            ..
        } = &mut self.machine;
        let mut turn = poll_buttons(devices, keypad, *clock, scene, imu, demo);
        // The scene must not change while the gateware draws.
        if let (Some(devices), true, false) = (devices, DEMO.is_built, renderer.is_busy())
            && switches.take(devices.switches.read(), demo, scene, clock.milliseconds())
        {
            turn = Turn::Again;
        }
        turn
    }

    /// Shows the state of the board on LEDs and digits.
    fn indicate(&mut self) -> Turn {
        let machine = &mut self.machine;
        let turn = self.indicators.poll(
            &mut machine.devices,
            &machine.demo,
            &machine.picture,
            &machine.imu,
            machine.heartbeat,
        );
        // The vertical blanking interrupt wakes tasks that wait until a certain time. A SoC without scan-out does not have this interrupt.
        if machine.renderer.display.is_visible() {
            turn
        } else {
            Turn::Again
        }
    }
}

/// Handles buttons that were pressed since the last poll. While a wireframe is shown, the buttons are the keys of the wireframe; if the
/// demo is also on, only with the switch [`HOLD`] on. Otherwise the buttons select scenes of the demo, if it is on, and control the sensor.
fn poll_buttons(
    devices: &Option<Devices>,
    keypad: &mut Keypad,
    clock: Clock,
    scene: &Scene,
    imu: &mut Imu,
    demo: &mut Demo,
) -> Turn {
    let Some(devices) = devices else {
        return Turn::Wait;
    };
    if !(IMU.is_built || WIREFRAME.is_built || DEMO.is_built) {
        return Turn::Wait;
    }
    let pressed = keypad.sample(devices.buttons.read(), clock);
    if pressed == 0 {
        // No interrupt signals that the level of a button has settled, so the loop polls.
        return Turn::worked(keypad.is_changing());
    }
    let switches = devices.switches.read();
    if scene.wireframe().is_some() && (!demo.is_on() || switches & HOLD != 0) {
        keypad.press(pressed, switches);
        return Turn::Again;
    }
    let steers = IMU.is_built && imu.follow().is_some();
    if demo.is_on() {
        demo.press(pressed, steers, clock.milliseconds());
    }
    if !IMU.is_built || demo.is_on() && !steers {
        return Turn::Again;
    }
    if pressed & CALIBRATE != 0 {
        imu.calibrate(SAMPLES);
    }
    if pressed & RECENTRE != 0 {
        imu.recentre();
    }
    Turn::Again
}
