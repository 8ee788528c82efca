//! The main loop of a program on the soft core.

use core::future::pending;
use core::pin::pin;
use core::time::Duration;

use embedded_io::Write as _;
use glint_core::digits::Display;
use glint_core::feature::{CPU, GESTURE, IMU};
use glint_core::gesture::Presence;
use glint_core::image_sensor::FrameSize;
use glint_core::mpu6050::Stream;
use glint_hal::timer::Clock;

use crate::board::{Board, Hand, Levels, Motion, digits};
use crate::canvas::{Canvas, Pixels};
use crate::drawn::{DrawError, Drawn};
use crate::gesture::Gesture;
use crate::hardware::{Devices, Hardware};
use crate::interrupts;
use crate::panic;
use crate::picture::{Picture, PictureError};
use crate::program::Program;
use crate::renderer::Renderer;
use crate::sensor::{self, Imu, Inbox};
use crate::serial::UART;
use crate::shapes::Shapes;
use crate::supervision;

/// Longest time to wait for a serial line that accepts no text. After this time the text is dropped.
const SEND_TIMEOUT: Duration = Duration::from_millis(500);

/// Runs the program `P`. If the program cannot start, or a picture cannot be drawn, prints the error on the serial line, and restarts on
/// Enter.
pub fn run<P: Program>() -> ! {
    let hardware = match Hardware::start() {
        Ok(hardware) => hardware,
        Err(error) => panic::report(format_args!("cannot start: {error}")),
    };
    let Hardware {
        identity,
        clock,
        devices,
        gesture,
        mut renderer,
        spare,
        ..
    } = hardware;
    let Some(devices) = devices else {
        panic::report(format_args!(
            "cannot start: this program was built for gateware {:#010x}, found {:#010x}",
            identity.firmware, identity.gateware
        ))
    };
    let mut inputs = Inputs {
        devices,
        gesture,
        imu: IMU.is_built.then(Imu::default),
        clock,
        start: clock.cycles(),
    };
    let bus = inputs.devices.i2c.take();
    let stream = pin!(async move {
        if let Some(bus) = bus {
            Stream::new(bus, clock, Inbox).run().await;
        }
        pending().await
    });
    // SAFETY: this function does not return.
    #[allow(unsafe_code)]
    unsafe {
        sensor::start(stream);
    }
    let mut board = Board::new(renderer.defaults(), Shapes::new(spare.shapes));
    supervision::on_picture();
    let mut program = P::start(&mut board);
    let mut notes = Notes::default();
    let mut rate = 0;
    loop {
        supervision::on_picture();
        inputs.read(&mut board);
        program.update(&mut board);
        let log = board.end();
        let mut uart = UART.writer(clock, SEND_TIMEOUT);
        // The text is lost if the serial line accepts no text.
        let _ = uart.write_all(log.as_bytes());
        show(&board, &mut inputs.devices, rate);
        let drawn = draw(&program, &mut board, &mut renderer, &mut inputs);
        match drawn {
            Ok(drawn) => {
                rate = drawn.rate(clock.frequency());
                board.set_drawing(drawn.cycles);
                notes.take(&drawn, clock);
            }
            Err(error) => panic::report(format_args!("{error}")),
        }
    }
}

/// The sources of a program's input.
struct Inputs {
    devices: Devices,
    gesture: Option<Gesture>,
    /// The motion sensor; `None` in a build without it.
    imu: Option<Imu>,
    clock: Clock,
    /// Time of the program's start, in clock cycles since reset.
    start: u64,
}

impl Inputs {
    /// Time since the start of the program.
    fn time(&self) -> Duration {
        let cycles = self.clock.cycles().saturating_sub(self.start);
        Duration::from_micros(self.clock.frequency().microseconds(cycles))
    }

    /// Reads the input for the next picture.
    fn read(&mut self, board: &mut Board) {
        self.switch_image_sensor(board.watches_hand);
        self.poll(board);
        let received = board.received_mut();
        let mut byte = [0];
        while !received.is_full() && UART.receive(&mut byte) > 0 {
            // The list is not full, so the push does not fail.
            let _ = received.push(byte[0]);
        }
        board.begin(Levels {
            time: self.time(),
            buttons: self.devices.buttons.read(),
            switches: self.devices.switches.read(),
        });
    }

    /// Turns the image sensor on or off when the program requests a change. If no sensor answers when it is turned on, the next attempt is
    /// after the program has turned the sensor off. A sensor that is unplugged later is found again.
    fn switch_image_sensor(&mut self, is_on: bool) {
        let Some(gesture) = self.gesture.as_mut().filter(|_| GESTURE.is_built) else {
            return;
        };
        match (is_on, gesture.sensor()) {
            (true, None) => {
                // `hand` is `None` without a sensor.
                let _ = gesture.start(FrameSize::Qvga);
            }
            (false, Some(_)) => gesture.stop(),
            (true, Some(_)) | (false, None) => {}
        }
    }

    /// Reads the inputs that must be read more often than once per picture: the buttons, the samples of the motion sensor, and the hand.
    fn poll(&mut self, board: &mut Board) {
        // Drawing by the soft core, which calls this function, may take long.
        supervision::on_picture();
        board.sample_buttons(self.time(), self.devices.buttons.read());
        if let Some(imu) = &mut self.imu {
            sensor::deliver_each(imu, &mut |imu| {
                if let Some(sample) = imu.latest() {
                    board.add_sample(Motion {
                        attitude: imu.attitude(),
                        sample: *sample,
                    });
                }
            });
        }
        if GESTURE.is_built
            && let Some(gesture) = &mut self.gesture
        {
            gesture.poll();
            let has_sensor = matches!(gesture.sensor(), Some(Ok(_)));
            board.set_hand(has_sensor.then(|| Hand {
                pose: gesture.pose(),
                is_seen: gesture.presence() == Presence::Tracked,
            }));
        }
    }
}

/// Shows the output of the program. `rate` is the number of pictures per second.
fn show(board: &Board, devices: &mut Devices, rate: u64) {
    devices.leds.set(board.leds);
    let rate = || digits([Display::number(rate), Display::default()]);
    devices.digits.show(board.digits.unwrap_or_else(rate));
}

/// Draws the program's next picture, and shows it from the next vertical blanking on.
fn draw<P: Program>(
    program: &P,
    board: &mut Board,
    renderer: &mut Renderer,
    inputs: &mut Inputs,
) -> Result<Drawn, Error> {
    let mut picture = Picture::new(board.defaults()).map_err(PictureError::from)?;
    program.draw(&mut picture)?;
    let frame = picture.frame()?;
    let drawn = loop {
        let before = interrupts::count();
        let drawn = renderer.draw(&frame, picture.backend, false, || {
            inputs.poll(board);
        });
        match drawn {
            Some(drawn) => break drawn?,
            None => {
                inputs.poll(board);
                // While the CPU projects lines in several steps, the engine is idle and raises no interrupt.
                if !renderer.is_ready() {
                    interrupts::sleep(before);
                }
            }
        }
    };
    let size = frame.size;
    program.paint(&mut Canvas::new(renderer, size));
    renderer.show(size);
    Ok(drawn)
}

impl Pixels for Renderer {
    fn pixels(&mut self) -> &mut [u16] {
        self.drawn_frame().unwrap_or_default()
    }
}

/// Reason why a picture is not drawn.
enum Error {
    Picture(PictureError),
    Draw(DrawError),
}

impl From<PictureError> for Error {
    fn from(error: PictureError) -> Self {
        Self::Picture(error)
    }
}

impl From<DrawError> for Error {
    fn from(error: DrawError) -> Self {
        Self::Draw(error)
    }
}

impl core::fmt::Display for Error {
    fn fmt(&self, f: &mut core::fmt::Formatter) -> core::fmt::Result {
        f.write_str("picture: ")?;
        match self {
            Self::Picture(error) => error.fmt(f),
            // Texts of a firmware name its own commands.
            Self::Draw(DrawError::NoCpu(Some(fallback))) => {
                write!(f, "{fallback}; {}", PictureError::Lacks(fallback.part()))
            }
            Self::Draw(DrawError::NoCpu(None)) => PictureError::Lacks(CPU).fmt(f),
            Self::Draw(error @ DrawError::Render(_)) => error.fmt(f),
        }
    }
}

/// State of the note to the user about slow drawing.
#[derive(Default)]
struct Notes {
    /// Whether a note has been printed; only the first note is printed.
    is_noted: bool,
}

impl Notes {
    /// Prints a note on the first picture that the soft core draws in place of the gateware.
    fn take(&mut self, drawn: &Drawn, clock: Clock) {
        if let (Some(reason), false) = (drawn.fallback(), self.is_noted) {
            let mut uart = UART.writer(clock, SEND_TIMEOUT);
            let _ = write!(uart, "note: drawn by the soft core: {reason}\r\n");
            self.is_noted = true;
        }
    }
}
