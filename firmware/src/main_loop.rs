//! The main loop.
//!
//! No step of the loop waits: interrupts fill queues, and each pass of the loop takes the contents of the queues. A command
//! whose reply needs a frame or samples leaves a [`Job`]; input waits in the UART's queue until this job has ended.

use core::future::pending;
use core::pin::pin;
use core::task::Poll;
use core::time::Duration;

use glint_core::calibration::SAMPLES;
use glint_core::feature::{DEMO, GESTURE, IMU, REPLAY, WIREFRAME};
use glint_core::hand::Pose;
use glint_core::mpu6050::Stream;
use glint_hal::timer::{Clock, Deadline};
use glint_scene::{Scene, Sphere};
use litex_pac::cpu;

use crate::commands::{self, gesture as gesture_commands, imu, replay, statistics};
use crate::demo::Demo;
use crate::error::CommandError;
use crate::gesture;
use crate::interrupts;
use crate::job::{Job, Reply};
use crate::machine::{Devices, Machine};
use crate::panel::{self, HOLD};
use crate::sensor::{self, Imu, Inbox};
use crate::terminal::Input;
use crate::wireframe::{self, Keypad};

/// Idle time after a reply before the scene is redrawn. It is too short to be visible, but a series of commands then
/// causes a single frame.
const QUIET: Duration = Duration::from_millis(2);

/// Bit of button 2, which calibrates the sensor.
const CALIBRATE: u8 = 1 << 2;
/// Bit of button 3, which recentres the camera.
const RECENTRE: u8 = 1 << 3;

/// Time between two changes of the blinking LED.
const HEARTBEAT: Duration = Duration::from_millis(500);

/// The machine and the state of its main loop.
pub struct MainLoop {
    machine: Machine,
    job: Option<Job>,
    /// Time of the next change of the blinking LED.
    beat: Deadline,
    /// The level of the blinking LED.
    blinks: bool,
    /// Time at which the idle time after a reply ends.
    quiet: Deadline,
}

impl MainLoop {
    /// The main loop of `machine`.
    pub fn new(machine: Machine) -> Self {
        let clock = machine.clock;
        Self {
            machine,
            job: None,
            beat: clock.after(Duration::ZERO),
            blinks: false,
            quiet: clock.after(QUIET),
        }
    }

    /// Runs until reset.
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
            // Comes first after an interrupt, because the gateware waits between the passes of a frame.
            self.draw();
            self.poll_job();
            self.run_demo();
            self.beat();
            self.poll_panel();
            self.machine.terminal.listen();
            sensor::deliver(&mut self.machine.imu);
            self.follow_hand();
            self.answer();
            self.steer();
            self.step();
            interrupts::sleep_unless(|| self.is_busy());
        }
    }

    /// Starts the demo, if the flash has a list, with its first scene as the first picture.
    fn power_up(&mut self) {
        let Machine {
            demo,
            library,
            terminal,
            ..
        } = &mut self.machine;
        if let Some((name, error)) = demo.power_up(library) {
            terminal.notify(format_args!(
                "demo: error {}: {name}: {error}",
                demo.error().unwrap_or(0)
            ));
        }
        self.run_demo();
    }

    /// Goes on with the demo: begins the next turn when it is time, and turns the camera where the scene does.
    fn run_demo(&mut self) {
        let Machine {
            demo,
            clock,
            renderer,
            scene,
            picture,
            models,
            ..
        } = &mut self.machine;
        if !demo.is_on() || self.job.is_some() || renderer.is_busy() {
            return;
        }
        if let Some(orbit) = &mut demo.orbit
            && !picture.is_outdated(scene, models)
            && orbit.poll(scene).is_ready()
        {
            demo.orbit = None;
        }
        if demo.turns.poll(clock.milliseconds()).is_none() {
            return;
        }
        demo.orbit = None;
        let name = demo.scene().unwrap_or_default();
        let shown = commands::show_scene(&mut self.machine, name);
        let Machine { demo, terminal, .. } = &mut self.machine;
        match shown {
            Ok(Reply::After(Job::Orbit(orbit))) => demo.orbit = Some(orbit),
            // Without a sensor the scene does not move.
            Ok(_) => {}
            Err(error) if error.is_of_sensor() => {}
            Err(error) => {
                let number = error.number();
                if demo.set_error(number) {
                    terminal.notify(format_args!("demo: error {number}: {error}"));
                }
            }
        }
    }

    /// Whether there is work for the next pass of the loop, so that the CPU must not sleep.
    fn is_busy(&mut self) -> bool {
        // The last condition is for SoCs without scan-out, where no interrupt would wake the loop for the blinking LED.
        let Machine {
            renderer,
            scene,
            models,
            picture,
            ..
        } = &mut self.machine;
        let is_ready = renderer.is_ready(|| picture.is_outdated(scene, models));
        is_ready
            || self.answers_next()
            || self.machine.keypad.is_changing()
            || self.may_step()
            || sensor::has_events()
            || gesture::has_frame()
            || matches!(self.job, Some(Job::Replay))
            || self.demo_goes_on()
            || !self.machine.renderer.display.is_visible()
    }

    /// Whether the demo has a scene to show now.
    fn demo_goes_on(&self) -> bool {
        let Machine { demo, clock, .. } = &self.machine;
        demo.is_on()
            && self.job.is_none()
            && !self.machine.renderer.is_busy()
            && demo.turns.is_ready(clock.milliseconds())
    }

    /// Whether the next pass of the loop will execute or receive input.
    fn answers_next(&self) -> bool {
        if self.machine.terminal.has_input() {
            self.takes_input()
        } else {
            self.machine.uart.has_received()
        }
    }

    /// Whether a line can be executed now. A line waits until the gateware has drawn its frame, and until most jobs have
    /// ended. It does not wait for an orbit, a job of the sensor or a replay: the line ends such a job.
    fn takes_input(&self) -> bool {
        matches!(
            self.job,
            None | Some(Job::Orbit(_) | Job::Sensor(_) | Job::Replay)
        ) && !self.machine.renderer.is_busy()
    }

    /// Executes the line that the terminal has received, if it is complete and can be executed now.
    fn answer(&mut self) {
        if !self.takes_input() {
            return;
        }
        let Some(input) = self.machine.terminal.input() else {
            return;
        };
        if self.job.is_some() {
            // The prompt follows the reply to the line, which is already on the screen.
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
    }

    /// Computes the camera's position from a frame of the image sensor.
    fn follow_hand(&mut self) {
        if GESTURE.is_built
            && let Some(gesture) = &mut self.machine.gesture
        {
            gesture.poll();
        }
    }

    /// Turns the camera to the sensor's attitude or moves it to the position that the hand sets, if a frame can be drawn.
    fn steer(&mut self) {
        let Machine {
            renderer,
            scene,
            picture,
            models,
            imu,
            gesture,
            ..
        } = &mut self.machine;
        if renderer.is_busy() || renderer.display.back().is_none() {
            return;
        }
        if GESTURE.is_built
            && let Some(gesture) = gesture
        {
            if let Some(Pose { r, theta, phi }) = gesture.move_to() {
                // The control keeps the distance in its range.
                let _ = scene.set_sphere(Sphere { r, theta, phi });
                if !picture.is_outdated(scene, models) {
                    gesture.on_unchanged();
                }
            }
            picture.mark = gesture.mark();
        }
        let (eye, radius) = (scene.view.eye(), scene.sphere.r);
        if IMU.is_built
            && let Some(Ok(view)) = imu.view(eye, radius)
        {
            scene.move_view(view);
        }
    }

    /// Whether a key has requested a step of the wireframe, and a frame can be drawn.
    fn may_step(&mut self) -> bool {
        let Machine {
            keypad,
            scene,
            picture,
            models,
            renderer,
            ..
        } = &mut self.machine;
        WIREFRAME.is_built
            && keypad.has_request()
            && !picture.is_outdated(scene, models)
            && !renderer.is_busy()
            && renderer.display.back().is_some()
    }

    /// Moves the wireframe by the request of one key, if a frame can be drawn: each frame has at most one step.
    fn step(&mut self) {
        if !self.may_step() {
            return;
        }
        let Machine {
            keypad,
            scene,
            devices,
            ..
        } = &mut self.machine;
        if let (Some(key), Some(devices)) = (keypad.take(), devices) {
            scene.move_wireframe(key.step(wireframe::rotates(devices.switches.read())));
        }
    }

    /// Draws the scene if it has changed and a frame buffer is free.
    fn draw(&mut self) {
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
            ..
        } = &mut self.machine;
        let is_outdated = !renderer.is_busy() && picture.is_outdated(scene, models);
        if matches!(self.job, Some(Job::Draw | Job::Render | Job::Frame { .. })) && is_outdated {
            renderer.drop_pending();
        }
        let mut progress = || {
            terminal.listen();
            sensor::deliver(imu);
            poll_buttons(devices, keypad, *clock, scene, imu, demo);
        };
        if !renderer.is_busy() {
            if !is_outdated || !(self.job.is_some() || self.quiet.passed()) {
                return;
            }
            models.update_objects(scene, &mut progress);
        }
        if let Some(drawn) = renderer.draw(models, scene, picture, progress) {
            picture.set_drawn(drawn, scene, models);
            if GESTURE.is_built
                && let Some(gesture) = gesture
            {
                gesture.on_drawn();
            }
        }
    }

    /// Continues the job that a command has left, if there is one, and ends the reply of this command when the job has ended.
    fn poll_job(&mut self) {
        let machine = &mut self.machine;
        let Some(job) = &mut self.job else { return };
        let is_outdated = |machine: &Machine| {
            let Machine {
                picture,
                scene,
                models,
                ..
            } = machine;
            picture.is_outdated(scene, models)
        };
        // No command of a build leaves a job of a part that it leaves out.
        let result = match job {
            Job::Sensor(job) if IMU.is_built => imu::poll(machine, job),
            Job::Replay if REPLAY.is_built => replay::poll(machine),
            Job::Gesture(job) if GESTURE.is_built => gesture_commands::poll(machine, job),
            Job::Sensor(_) | Job::Replay | Job::Gesture(_) => Poll::Ready(Ok(())),
            Job::Draw | Job::Render | Job::Frame { .. } | Job::Orbit(_) if is_outdated(machine) => {
                Poll::Pending
            }
            Job::Draw => Poll::Ready(Ok(())),
            Job::Render => Poll::Ready(statistics::print(machine, false)),
            Job::Frame { depth } => Poll::Ready(commands::send_frame(machine, *depth)),
            Job::Orbit(orbit) => orbit.poll(&mut machine.scene),
        };
        if let Poll::Ready(result) = result {
            self.finish(result);
        }
    }

    /// Ends the reply of a command, and its job if it has one, and prints the prompt.
    fn finish(&mut self, result: Result<(), CommandError>) {
        self.end_job(result);
        self.machine.terminal.prompt();
    }

    /// Ends the reply of a command, and its job if it has one.
    fn end_job(&mut self, result: Result<(), CommandError>) {
        self.job = None;
        let Machine {
            terminal,
            picture,
            clock,
            ..
        } = &mut self.machine;
        picture.wants_depth = false;
        self.quiet = clock.after(QUIET);
        match result {
            Ok(()) => terminal.print(format_args!("ok\n")),
            Err(error) => terminal.print(format_args!("error: {error}\n")),
        }
    }

    /// Acts on buttons and switches that have changed since the last poll.
    fn poll_panel(&mut self) {
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
        poll_buttons(devices, keypad, *clock, scene, imu, demo);
        // The scene must not change while the gateware draws.
        if let (Some(devices), true, false) = (devices, DEMO.is_built, renderer.is_busy()) {
            switches.take(devices.switches.read(), demo, scene, clock.milliseconds());
        }
    }

    /// Blinks the first LED, and shows the state of the board.
    fn beat(&mut self) {
        if !self.beat.passed() {
            return;
        }
        let Machine {
            clock,
            devices,
            heartbeat,
            demo,
            picture,
            ..
        } = &mut self.machine;
        self.beat = clock.after(HEARTBEAT);
        self.blinks = !self.blinks;
        // Polls the future that reads the sensor, so that a transfer whose interrupt is missing times out.
        sensor::advance(cpu::cycles_low());
        let Some(devices) = devices else { return };
        if *heartbeat {
            devices.leds.set(panel::leds(demo, self.blinks));
        }
        let drawn = picture.drawn().and_then(Result::ok);
        let rate = drawn.map(|drawn| drawn.rate(clock.frequency()));
        devices.digits.show(panel::digits(demo, rate, self.blinks));
    }
}

/// Acts on buttons that were pressed since the last poll. While the wireframe is shown they are its keys, but with the demo on only if
/// the switch [`HOLD`] is on. Otherwise they choose scenes of the demo, if it is on, and serve the sensor.
fn poll_buttons(
    devices: &Option<Devices>,
    keypad: &mut Keypad,
    clock: Clock,
    scene: &Scene,
    imu: &mut Imu,
    demo: &mut Demo,
) {
    let Some(devices) = devices else {
        return;
    };
    if !(IMU.is_built || WIREFRAME.is_built || DEMO.is_built) {
        return;
    }
    let pressed = keypad.sample(devices.buttons.read(), clock);
    if pressed == 0 {
        return;
    }
    let switches = devices.switches.read();
    if scene.wireframe().is_some() && (!demo.is_on() || switches & HOLD != 0) {
        keypad.press(pressed, switches);
        return;
    }
    let steers = IMU.is_built && imu.follow().is_some();
    if demo.is_on() {
        demo.press(pressed, steers, clock.milliseconds());
    }
    if !IMU.is_built || demo.is_on() && !steers {
        return;
    }
    if pressed & CALIBRATE != 0 {
        imu.calibrate(SAMPLES);
    }
    if pressed & RECENTRE != 0 {
        imu.recentre();
    }
}
