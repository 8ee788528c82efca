//! The virtual board: clock, pins, devices, and back-door access to DDR3.

use std::env;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use glint_board_api::{BoardError, Frame, Simulation, Timeout, Uart, built};
use litex_pac::memories::MAIN_RAM;
use litex_pac::scanout::Scanout;
use virtual_flash::{Flash, Pins};
use virtual_image_sensor::ImageSensor;
use virtual_mpu6050::Wires;

use crate::digits::Digits;
use crate::library::{Instruction, Soc};
use crate::memory::main_ram_offset;
use crate::{Error, Monitor, Picture, TimingError, boot};

/// Number of cycles between two reads of the SoC's serial output and video.
const SLICE: u64 = 1000;

/// Number of cycles after which a store of the CPU has reached memory, even if a line fill of the instruction cache and a refresh delay
/// it.
const SETTLE: u64 = 1000;

/// Levels of the undriven data lines of the flash.
const FLASH_RELEASED: u8 = 0xf;

/// Minimum number of PCLK periods that are queued for the image sensor's port: more than the
/// periods in a slice, so that no period is late.
const PORT_QUEUE: usize = 2 * SLICE as usize;

/// Number of cycles without a period of the image sensor's master clock after which the clock counts as stopped.
const CLOCK_LOST: u64 = 2 * SLICE;

/// Ticks of the pixel clock in two video frames.
const TICKS_OF_TWO_FRAMES: u64 = 2 * Scanout::FRAME_TICKS as u64;

/// How a board starts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Start<'a> {
    /// Like a real board: the BIOS in ROM tests the memory and waits for a serial boot.
    #[default]
    Full,
    /// Preloaded: `firmware` is in main RAM, and the ROM jumps to it.
    Fast {
        /// The firmware's image.
        firmware: &'a [u8],
    },
}

/// Options of a [`VirtualBoard`].
#[derive(Clone, Debug, Default)]
pub struct Builder<'a> {
    library: Option<PathBuf>,
    start: Start<'a>,
    trace: Option<PathBuf>,
}

impl<'a> Builder<'a> {
    /// Sets the library to load. By default this is the library in the folder of the environment variable `GLINT_VIRTUAL_BOARD`, or
    /// without this variable the library of `cargo xtask gateware`, found by [`built::find`].
    #[must_use]
    pub fn library(mut self, path: impl Into<PathBuf>) -> Self {
        self.library = Some(path.into());
        self
    }

    /// Sets how the board starts; the default is [`Start::Full`].
    #[must_use]
    pub fn start(mut self, start: Start<'a>) -> Self {
        self.start = start;
        self
    }

    /// Writes waveforms (VCD, about 1 kB per cycle) to `path`, from the first cycle on.
    #[must_use]
    pub fn trace(mut self, path: impl Into<PathBuf>) -> Self {
        self.trace = Some(path.into());
        self
    }

    /// Creates a board before its first clock edge.
    ///
    /// # Errors
    /// The library is missing or has another version, the firmware exceeds main RAM, or waveforms cannot be written.
    pub fn build(self) -> Result<VirtualBoard, Error> {
        let (name, command) = match self.trace {
            None => ("libglint_soc.so", "cargo xtask gateware"),
            Some(_) => ("libglint_soc_trace.so", "cargo xtask gateware --waveforms"),
        };
        let path = match (self.library, env::var_os("GLINT_VIRTUAL_BOARD")) {
            (Some(path), _) => path,
            (None, Some(folder)) => Path::new(&folder).join(name),
            (None, None) => built::find(&format!("gateware/virtual/{name}"), command)?,
        };
        if !path.is_file() {
            return Err(Error::LibraryMissing { path, command });
        }
        let mut soc = match self.start {
            Start::Full => Soc::load(&path)?,
            Start::Fast { firmware } => preloaded(&path, firmware)?,
        };
        if let Some(path) = self.trace
            && !soc.trace(&path)?
        {
            return Err(Error::Trace { path });
        }
        Ok(VirtualBoard {
            library: path,
            soc,
            before: 0,
            monitor: Monitor::default(),
            flash: None,
            sensor: None,
            image_sensor: None,
            camera_clock: (0, 0),
            digits: Digits::default(),
            uart: Vec::new(),
            running: Duration::ZERO,
        })
    }
}

/// A SoC before its first clock edge, with a program in main RAM, to which the ROM jumps.
fn preloaded(library: &Path, program: &[u8]) -> Result<Soc, Error> {
    let offset = main_ram_offset(MAIN_RAM.base, program.len())?;
    let mut soc = Soc::load(library)?;
    let found = soc.build_id();
    if found != litex_pac::BUILD_ID {
        return Err(Error::BuildId {
            expected: litex_pac::BUILD_ID,
            found,
        });
    }
    soc.rom_write(&boot::stub());
    soc.ddr_write(offset, program);
    Ok(soc)
}

/// A virtual board: the SoC, and the devices on its pins.
pub struct VirtualBoard {
    library: PathBuf,
    soc: Soc,
    /// Cycles of the SoCs that earlier programs had.
    before: u64,
    monitor: Monitor,
    flash: Option<Flash>,
    sensor: Option<Wires>,
    image_sensor: Option<ImageSensor>,
    /// Number of periods of the image sensor's master clock so far, and the cycle in which this
    /// number last changed.
    camera_clock: (u64, u64),
    digits: Digits,
    /// Serial output of the SoC that the user of the board has not read yet.
    uart: Vec<u8>,
    running: Duration,
}

impl VirtualBoard {
    /// Returns the default options of a board.
    #[must_use]
    pub fn builder<'a>() -> Builder<'a> {
        Builder::default()
    }

    /// Runs `cycles` cycles in a bare C++ loop around the model, whose speed is the reference for [`run`](Uart::run). The
    /// SoC's serial output and video of these cycles are lost, and its serial input waits.
    pub fn run_bare(&mut self, cycles: u64) {
        let start = Instant::now();
        self.soc.run_bare(cycles);
        self.running += start.elapsed();
    }

    /// Passes the SoC's outputs to the flash, and the flash's data to the SoC.
    fn update_flash(&mut self) {
        let Some(flash) = &mut self.flash else {
            return;
        };
        let (outputs, lines) = (self.soc.outputs(), self.soc.flash_lines());
        let sent = flash.update(Pins {
            cs_n: outputs.flash_cs_n,
            clk: outputs.flash_clk,
            lines,
        });
        self.soc.flash_drive(sent.unwrap_or(FLASH_RELEASED));
    }

    /// Passes the SoC's I2C outputs to the sensor, and the sensor's outputs to the SoC.
    fn update_wires(&mut self) {
        let now = self.nanoseconds();
        let [scl, sda] = self.soc.outputs().i2c;
        if let Some(sensor) = &mut self.sensor {
            let (scl, sda) = sensor.update(now, scl, sda);
            self.soc.i2c_drive(u8::from(scl) | u8::from(sda) << 1);
        }
    }

    /// Passes the SoC's outputs to the image sensor, and the sensor's SCCB wires and frames to the SoC.
    fn update_image_sensor(&mut self) {
        let now = self.nanoseconds();
        let outputs = self.soc.outputs();
        let Some(image_sensor) = &mut self.image_sensor else {
            return;
        };
        let [scl, sda] = outputs.camera;
        let (scl, sda) = image_sensor.wires.update(now, scl, sda);
        self.soc.camera_drive(u8::from(scl) | u8::from(sda) << 1);
        let (clocks, cycle) = (self.soc.camera_clocks(), self.soc.cycles());
        if clocks != self.camera_clock.0 {
            self.camera_clock = (clocks, cycle);
        }
        let has_clock = cycle < self.camera_clock.1 + CLOCK_LOST;
        let is_awake = has_clock && !outputs.camera_power_down;
        if image_sensor.set_inputs(outputs.camera_reset_n, is_awake) {
            self.soc.camera_clear();
        }
        let queued = self.soc.camera_queued();
        if queued < PORT_QUEUE {
            let clock = image_sensor.timing.clock;
            let begin = now as f64 * 1e-9 + queued as f64 / f64::from(clock);
            let levels = image_sensor.frame(begin);
            self.soc.camera_send(clock, &levels);
        }
    }

    /// Time since the start in ns.
    fn nanoseconds(&self) -> u64 {
        (u128::from(self.cycles()) * 1_000_000_000 / u128::from(self.clock_hz())) as u64
    }

    /// Reads new serial output, video and the state of the digits from the SoC.
    fn collect(&mut self) {
        self.soc.uart_read(&mut self.uart);
        self.digits.update(self.cycles(), self.soc.digits());
        if self.monitor.is_on() {
            let monitor = &mut self.monitor;
            self.soc.video_take(|samples| monitor.watch(samples));
        }
    }

    /// Turns the recording of executed instructions on or off; initially it is off.
    pub fn record_instructions(&mut self, on: bool) {
        self.soc.instructions_record(on);
    }

    /// Appends the instructions recorded since the last call to `list`, in their order.
    pub fn take_instructions(&mut self, list: &mut Vec<Instruction>) {
        self.soc.instructions_take(list);
    }

    /// Mean simulation speed since the start, in cycles per second of wall time.
    #[must_use]
    pub fn cycles_per_second(&self) -> f64 {
        self.cycles() as f64 / self.running.as_secs_f64().max(f64::MIN_POSITIVE)
    }

    /// Build id: CRC-32 of the gateware's register map.
    #[must_use]
    pub fn build_id(&self) -> u32 {
        self.soc.build_id()
    }

    /// The sensor on the I2C bus, if any.
    pub fn sensor(&mut self) -> Option<&mut Wires> {
        self.sensor.as_mut()
    }

    /// Disconnects the sensor from the I2C bus, and returns it.
    pub fn unplug(&mut self) -> Option<Wires> {
        self.soc.i2c_drive(0b11);
        self.sensor.take()
    }

    /// The image sensor, if any. Its faults take effect with its next frame.
    pub fn image_sensor(&mut self) -> Option<&mut ImageSensor> {
        self.image_sensor.as_mut()
    }

    /// Drives the I2C wires in the role of a device: SCL with bit 0, SDA with bit 1; 0 pulls a wire low, 1 releases it.
    pub fn i2c_drive(&mut self, released: u8) {
        self.soc.i2c_drive(released);
    }

    /// Levels of the I2C wires: SCL in bit 0, SDA in bit 1.
    #[must_use]
    pub fn i2c_wires(&self) -> u8 {
        self.soc.i2c_wires()
    }

    /// The monitor on the video output. It is off until [`Monitor::turn_on`].
    pub fn monitor(&mut self) -> &mut Monitor {
        &mut self.monitor
    }

    /// Captures a video frame: the current frame if the monitor is on, else the next whole frame. Runs the board for at most
    /// two frames, 2.7 million cycles.
    ///
    /// # Errors
    /// [`Error::Timeout`] if the SoC shows no video.
    pub fn capture(&mut self) -> Result<Picture, Error> {
        let was_on = self.monitor.is_on();
        self.monitor.turn_on();
        self.monitor.take_picture();
        let two_frames = TICKS_OF_TWO_FRAMES * u64::from(self.clock_hz())
            / u64::from(Scanout::PIXEL_CLOCK)
            + SLICE;
        let shown = self.run_until(two_frames, |board| board.monitor.has_picture());
        if !was_on {
            self.monitor.turn_off();
        }
        let picture = self.monitor.take_picture();
        picture.filter(|_| shown).ok_or_else(|| {
            let error = self.monitor.errors().first();
            Error::Timeout(Timeout {
                expected: "a frame on the monitor".to_owned(),
                cycles: two_frames,
                got: error.map_or("no sync".to_owned(), TimingError::to_string),
            })
        })
    }

    /// Reads DDR3 from `address` on, an address of the CPU. If the board has run before, it first runs a thousand cycles,
    /// so that pending stores of the CPU reach memory.
    ///
    /// # Errors
    /// [`Error::Address`] if the range is not within main RAM.
    pub fn ddr_read(&mut self, address: u32, bytes: &mut [u8]) -> Result<(), Error> {
        let offset = main_ram_offset(address, bytes.len())?;
        self.settle();
        self.soc.ddr_read(offset, bytes);
        Ok(())
    }

    /// Writes DDR3 from `address` on, an address of the CPU, and invalidates the CPU's caches. If the board has run
    /// before, it first runs a thousand cycles, so that pending stores of the CPU do not overwrite the new data.
    ///
    /// # Errors
    /// [`Error::Address`] if the range is not within main RAM.
    pub fn ddr_write(&mut self, address: u32, bytes: &[u8]) -> Result<(), Error> {
        let offset = main_ram_offset(address, bytes.len())?;
        self.settle();
        // A pending line fill would bring old data into the cache after the write.
        while self.soc.filling() {
            self.run(1);
        }
        self.soc.ddr_write(offset, bytes);
        Ok(())
    }

    /// Runs the SoC until all pending stores of the CPU have reached memory.
    fn settle(&mut self) {
        if self.soc.cycles() > 0 {
            self.run(SETTLE);
        }
    }
}

impl Uart for VirtualBoard {
    fn run(&mut self, cycles: u64) {
        let start = Instant::now();
        self.soc.video_record(self.monitor.is_on());
        let mut left = cycles;
        while left > 0 {
            let slice = left.min(SLICE);
            let has_devices =
                self.sensor.is_some() || self.image_sensor.is_some() || self.flash.is_some();
            left -= if has_devices {
                self.soc.run_to_edge(slice)
            } else {
                self.soc.run(slice);
                slice
            };
            self.update_flash();
            self.update_wires();
            self.update_image_sensor();
            self.collect();
        }
        self.running += start.elapsed();
    }

    fn cycles(&self) -> u64 {
        self.before + self.soc.cycles()
    }

    fn clock_hz(&self) -> u32 {
        self.soc.clock_hz()
    }

    fn uart_write(&mut self, bytes: &[u8]) {
        self.soc.uart_write(bytes);
    }

    fn uart_queued(&self) -> usize {
        self.soc.uart_queued()
    }

    fn uart_output(&mut self) -> &mut Vec<u8> {
        &mut self.uart
    }
}

impl Simulation for VirtualBoard {
    /// Continues with a new SoC. Waveforms and the recording of instructions end.
    fn boot(&mut self, program: &[u8]) -> Result<(), BoardError> {
        let mut soc = preloaded(&self.library, program).map_err(BoardError::simulation)?;
        self.collect();
        soc.take_levels(&self.soc);
        self.before = self.cycles();
        self.soc = soc;
        self.camera_clock = (0, 0);
        self.digits = Digits::default();
        let was_on = self.monitor.is_on();
        self.monitor = Monitor::default();
        if was_on {
            self.monitor.turn_on();
        }
        Ok(())
    }

    fn set_buttons(&mut self, pressed: u8) {
        self.soc.set_buttons(pressed);
    }

    fn set_switches(&mut self, on: u16) {
        self.soc.set_switches(on);
    }

    fn leds(&self) -> u16 {
        self.soc.leds()
    }

    fn digits(&self) -> [u8; 8] {
        self.digits.seen(self.cycles())
    }

    fn plug(&mut self, sensor: Wires) {
        self.sensor = Some(sensor);
    }

    fn plug_flash(&mut self, flash: Flash) {
        self.flash = Some(flash);
    }

    fn plug_image_sensor(&mut self, image_sensor: ImageSensor) {
        self.soc.camera_clear();
        self.image_sensor = Some(image_sensor);
    }

    fn read_memory(&mut self, address: u32, bytes: &mut [u8]) -> Result<(), BoardError> {
        self.ddr_read(address, bytes)
            .map_err(BoardError::simulation)
    }

    fn write_memory(&mut self, address: u32, bytes: &[u8]) -> Result<(), BoardError> {
        self.ddr_write(address, bytes)
            .map_err(BoardError::simulation)
    }

    fn new_frame(&mut self, last: u64) -> Result<Option<(u64, Frame)>, BoardError> {
        self.monitor().turn_on();
        let Some(picture) = self.monitor().take_picture() else {
            return Ok(None);
        };
        // If the pixels of each larger block are equal, scan-out has enlarged a smaller frame.
        let mut scales = [4, 2].into_iter();
        let smaller = scales.find_map(|scale| Some((scale, picture.scaled_back(scale).ok()?)));
        let (scale, pixels) = match smaller {
            Some(found) => found,
            None => (1, picture.scaled_back(1).map_err(BoardError::simulation)?),
        };
        let frame = Frame {
            width: picture.width() / scale,
            height: picture.height() / scale,
            pixels,
        };
        Ok(Some((last + 1, frame)))
    }

    fn monitor_frame(&mut self, scale: usize) -> Result<Vec<u16>, BoardError> {
        let picture = self.capture().map_err(BoardError::simulation)?;
        picture.scaled_back(scale).map_err(BoardError::simulation)
    }
}
