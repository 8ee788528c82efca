//! The loop of a program on the soft core.

use core::future::pending;
use core::pin::pin;
use core::time::Duration;

use embedded_io::Write as _;
use glint_core::digits::Display;
use glint_core::feature::IMU;
use glint_core::mpu6050::Stream;
use glint_hal::timer::Clock;

use crate::board::{Board, Levels, Motion, digits};
use crate::canvas::{Canvas, Pixels};
use crate::drawn::{Drawn, RenderedBy};
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

/// Longest time to wait for a serial line that accepts no text; then the text is dropped.
const SEND_TIMEOUT: Duration = Duration::from_millis(500);

/// Runs the program `P`. A program that cannot start, or whose picture cannot be drawn, ends with its error on the serial line, and restarts
/// on Enter.
pub fn run<P: Program>() -> ! {
    let hardware = match Hardware::start() {
        Ok(hardware) => hardware,
        Err(error) => panic::report(format_args!("cannot start: {error}")),
    };
    let Hardware {
        identity,
        clock,
        devices,
        mut renderer,
        spare,
        ..
    } = hardware;
    let Some(mut devices) = devices else {
        panic::report(format_args!(
            "cannot start: this program was built for gateware {:#010x}, found {:#010x}",
            identity.firmware, identity.gateware
        ))
    };
    let shapes = match Shapes::new(spare.shapes) {
        Ok(shapes) => shapes,
        Err(_) => panic::report(format_args!("cannot start: the built-in cube")),
    };
    let bus = devices.i2c.take();
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
    let mut imu = Imu::default();
    let mut board = Board::new(renderer.defaults(), shapes);
    let mut program = P::start(&mut board);
    let mut notes = Notes::default();
    let mut rate = 0;
    loop {
        supervision::on_picture();
        read(&mut board, &devices, &mut imu, clock);
        program.update(&mut board);
        let log = board.end();
        let mut uart = UART.writer(clock, SEND_TIMEOUT);
        // The text is lost if the serial line accepts no text.
        let _ = uart.write_all(log.as_bytes());
        show(&board, &mut devices, rate);
        let drawn = draw(
            &program,
            &mut board,
            &mut renderer,
            &devices,
            &mut imu,
            clock,
        );
        match drawn {
            Ok(drawn) => {
                rate = drawn.rate(clock.frequency());
                notes.take(&drawn, clock);
            }
            Err(error) => panic::report(format_args!("{error}")),
        }
    }
}

/// Reads the input for the next picture.
fn read(board: &mut Board, devices: &Devices, imu: &mut Imu, clock: Clock) {
    poll(board, devices, imu, clock);
    let received = board.received_mut();
    let mut byte = [0];
    while !received.is_full() && UART.receive(&mut byte) > 0 {
        // There is room for a byte.
        let _ = received.push(byte[0]);
    }
    board.begin(Levels {
        time: time(clock),
        buttons: devices.buttons.read(),
        switches: devices.switches.read(),
    });
}

/// Reads what must be read more often than once a picture: the buttons, and the samples of the sensor.
fn poll(board: &mut Board, devices: &Devices, imu: &mut Imu, clock: Clock) {
    // Drawing by the soft core, which calls this function, may take long.
    supervision::on_picture();
    board.sample_buttons(time(clock), devices.buttons.read());
    if IMU.is_built {
        sensor::deliver_each(imu, &mut |imu| {
            if let Some(sample) = imu.latest() {
                board.add_sample(Motion {
                    attitude: imu.attitude(),
                    sample: *sample,
                });
            }
        });
    }
}

fn time(clock: Clock) -> Duration {
    Duration::from_micros(clock.frequency().microseconds(clock.cycles()))
}

/// Shows the output of the program. `rate` is the number of pictures a second.
fn show(board: &Board, devices: &mut Devices, rate: u64) {
    devices.leds.set(board.leds);
    let rate = || digits([Display::number(rate), Display::default()]);
    devices.digits.show(board.digits.unwrap_or_else(rate));
}

/// Draws and shows a picture.
fn draw<P: Program>(
    program: &P,
    board: &mut Board,
    renderer: &mut Renderer,
    devices: &Devices,
    imu: &mut Imu,
    clock: Clock,
) -> Result<Drawn, Error> {
    let mut picture = Picture::new(board.defaults()).map_err(PictureError::from)?;
    program.draw(&mut picture)?;
    let frame = picture.frame()?;
    let drawn = loop {
        let before = interrupts::count();
        let drawn = renderer.draw(&frame, picture.backend, false, || {
            poll(board, devices, imu, clock);
        });
        match drawn {
            Some(drawn) => break drawn?,
            None => {
                poll(board, devices, imu, clock);
                interrupts::sleep(before);
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
    Draw(crate::drawn::DrawError),
}

impl From<PictureError> for Error {
    fn from(error: PictureError) -> Self {
        Self::Picture(error)
    }
}

impl From<crate::drawn::DrawError> for Error {
    fn from(error: crate::drawn::DrawError) -> Self {
        Self::Draw(error)
    }
}

impl core::fmt::Display for Error {
    fn fmt(&self, f: &mut core::fmt::Formatter) -> core::fmt::Result {
        match self {
            Self::Picture(error) => write!(f, "picture: {error}"),
            Self::Draw(error) => write!(f, "picture: {error}"),
        }
    }
}

/// Notes on pictures for the user.
#[derive(Default)]
struct Notes {
    /// Whether the soft core drew the last picture.
    by_soft_core: bool,
}

impl Notes {
    /// Prints a note on the first picture that the soft core draws in place of the gateware.
    fn take(&mut self, drawn: &Drawn, clock: Clock) {
        let fallback = drawn.fallback();
        let by_soft_core = matches!(drawn.by, RenderedBy::Cpu(_));
        if let (Some(reason), false) = (fallback, self.by_soft_core) {
            let mut uart = UART.writer(clock, SEND_TIMEOUT);
            let _ = write!(uart, "note: drawn by the soft core: {reason}\r\n");
        }
        self.by_soft_core = by_soft_core;
    }
}
