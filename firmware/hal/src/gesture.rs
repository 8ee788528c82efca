//! The gesture engine `gesture`, which counts the pixels of a hand in the frames of an image sensor, and the pins of the sensor.
//!
//! After each whole frame the engine raises an interrupt and has the [`Statistics`] of this frame; a frame with a fault leaves
//! them as they are. Windows, region and run take effect with the next frame.
//!
//! Software moves the sensor's bus (SCCB): the driver implements [`Wires`].

use embedded_hal::delay::DelayNs;
use glint_core::hand::{Region, Setting, Statistics, Window};
use glint_core::image_sensor::{
    Error, FrameSize, ImageSensor, Model, NoAcknowledge, TwoWires, Wires,
};
use litex_pac::gesture::{
    self, Camera, Channel, Control, EvEnable, EvPending, RegionX, RegionY, Size, Snapshot, WindowA,
    WindowB,
};
pub use litex_pac::gesture::{Counters, Fault};

use crate::Absent;
use crate::timer::{Clock, Waiting, block_on};

/// Reason why the image sensor cannot be set up.
pub type SetUpError = Error<NoAcknowledge>;

/// Time in ms after the end of a reset in which a chip may not answer: that of the OV5640, which is the longest.
const RESET_TIME: u32 = 20;

/// Largest coordinate of a region.
const LAST: u16 = 2047;

/// What the image sensor sends, for messages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Signal {
    /// Whether the sensor's clock PCLK runs.
    pub is_running: bool,
    /// Fault of the last frame.
    pub fault: Option<Fault>,
    /// Pixels of the last line, and lines of the last frame.
    pub seen: [u16; 2],
}

/// Driver of the gesture engine, whose presence has been checked.
pub struct GestureEngine {
    registers: gesture::Gesture,
    /// Levels of the sensor's pins, as they were written last.
    camera: Camera,
    size: [u16; 2],
}

impl GestureEngine {
    /// Takes the registers if the SoC has the engine. The image sensor is in reset and has no clock.
    ///
    /// # Errors
    /// The block is absent.
    pub fn probe(registers: gesture::Gesture) -> Result<Self, Absent> {
        Absent::check(registers.ident().read(), gesture::Gesture::IDENT)?;
        registers
            .ev_enable()
            .write(EvEnable::default().with_frame(true));
        let mut engine = Self {
            registers,
            camera: Camera::default().with_scl(true).with_sda(true),
            size: [0; 2],
        };
        engine.set_power(false);
        Ok(engine)
    }

    /// Resets the image sensor, sets it up for a size, and takes its frames from the next VSYNC on. This takes some 50 ms, in which
    /// the CPU does nothing else but interrupts.
    ///
    /// # Errors
    /// The chip is absent, unknown, or does not accept its set-up; it is then turned off.
    pub fn start(&mut self, size: FrameSize, clock: Clock) -> Result<Model, SetUpError> {
        self.set_power(false);
        // Longer than the shortest reset of all chips.
        { clock }.delay_ms(1);
        self.set_power(true);
        { clock }.delay_ms(RESET_TIME);
        let mut sensor = ImageSensor::new(TwoWires::new(&mut *self, Waiting(clock)));
        let started = block_on(sensor.start(size, &mut Waiting(clock)));
        match started {
            Ok(model) => self.receive(size.pixels(), model.is_vsync_low()),
            Err(_) => self.set_power(false),
        }
        started
    }

    /// Whether the image sensor that [`start`](Self::start) found still has its settings. This takes some 5 ms; without a sensor less
    /// than 1 ms.
    ///
    /// # Errors
    /// The chip does not answer.
    pub fn keeps(
        &mut self,
        model: Model,
        size: FrameSize,
        clock: Clock,
    ) -> Result<bool, SetUpError> {
        let mut sensor = ImageSensor::new(TwoWires::new(&mut *self, Waiting(clock)));
        block_on(sensor.keeps(model, size))
    }

    /// Finds an image sensor after another one was unplugged. This takes some 2 ms; without a sensor less than 1 ms.
    ///
    /// # Errors
    /// There is no known chip.
    pub fn find(&mut self, clock: Clock) -> Result<Model, SetUpError> {
        self.set_power(true);
        let mut sensor = ImageSensor::new(TwoWires::new(&mut *self, Waiting(clock)));
        block_on(sensor.find())
    }

    /// Gives the image sensor its clock and ends its reset, or stops the engine and turns the sensor off.
    pub fn set_power(&mut self, on: bool) {
        if !on {
            self.registers.control().write(Control::default());
        }
        self.camera = self
            .camera
            .with_clock(on)
            .with_reset(!on)
            .with_power_down(!on);
        self.registers.camera().write(self.camera);
    }

    /// Takes frames of this size from the next VSYNC on. `vsync_low` says that VSYNC is low between frames.
    fn receive(&mut self, size: [u16; 2], vsync_low: bool) {
        let registers = &self.registers;
        let control = Control::default().with_vsync_low(vsync_low);
        registers.control().write(control);
        let [width, height] = size;
        registers
            .size()
            .write(Size::default().with_width(width).with_height(height));
        registers.control().write(control.with_enable(true));
        self.size = size;
    }

    /// Sets the windows of the channels Cr and Cb.
    pub fn set_windows(&mut self, windows: [Window; 2]) {
        let [cr, cb] = windows;
        let first = WindowA::default().with_channel(Channel::Cr);
        self.registers
            .window_a()
            .write(first.with_lower(cr.lower).with_upper(cr.upper));
        let second = WindowB::default().with_channel(Channel::Cb);
        self.registers
            .window_b()
            .write(second.with_lower(cb.lower).with_upper(cb.upper));
    }

    /// Sets what the engine counts.
    pub fn set_gate(&mut self, setting: &Setting) {
        let Region {
            first: [left, top],
            last: [right, bottom],
        } = setting.region;
        let columns = RegionX::default().with_first(left);
        let rows = RegionY::default().with_first(top);
        let registers = &self.registers;
        registers
            .region_x()
            .write(columns.with_last(right.min(LAST)));
        registers.region_y().write(rows.with_last(bottom.min(LAST)));
        registers.least_run().write(setting.least_run);
    }

    /// The statistics of the last whole frame, with its number modulo 2^16; `None` if the engine replaced them meanwhile.
    #[must_use]
    pub fn statistics(&self) -> Option<(u16, Statistics)> {
        let registers = &self.registers;
        let sequence = registers.sequence().read();
        let (columns, rows) = (registers.box_x().read(), registers.box_y().read());
        let statistics = Statistics {
            size: self.size,
            count: registers.count().read(),
            sums: [registers.sum_x().read(), registers.sum_y().read()],
            bounds: Region {
                first: [columns.first(), rows.first()],
                last: [columns.last(), rows.last()],
            },
            is_whole: true,
        };
        (registers.sequence().read() == sequence).then_some((sequence, statistics))
    }

    /// What the image sensor sends.
    #[must_use]
    pub fn signal(&self) -> Signal {
        let status = self.registers.status().read();
        let seen = self.registers.seen().read();
        Signal {
            is_running: status.running(),
            fault: status.fault().filter(|fault| *fault != Fault::None),
            seen: [seen.pixels(), seen.lines()],
        }
    }

    /// Counters since reset.
    #[must_use]
    pub fn counters(&self) -> Counters {
        Counters::read(&self.registers)
    }

    /// Requests a small picture of the next whole frame: every 2^`step`-th pixel of every 2^`step`-th line, as colours or as marks of
    /// the hand's colour. `step` is at most 5.
    pub fn request_picture(&mut self, step: u8, is_colour: bool) {
        let request = Snapshot::default().with_step(step).with_colour(is_colour);
        self.registers.snapshot().write(request.with_start(true));
    }

    /// The words of the small picture: a colour each, or 16 marks each, the first in the highest bit; `None` before the frame has
    /// ended.
    #[must_use]
    pub fn picture(&self) -> Option<impl Iterator<Item = u16> + Clone> {
        let state = self.registers.snapshot_state().read();
        // A place for each word, because an iterator may be cloned and both may go on.
        let words = (0..state.words()).map(|place| {
            self.registers.snapshot_place().write(place);
            self.registers.snapshot_word().read()
        });
        state.ready().then_some(words)
    }
}

impl Wires for &mut GestureEngine {
    fn set(&mut self, scl: bool, sda: bool) {
        self.camera = self.camera.with_scl(scl).with_sda(sda);
        self.registers.camera().write(self.camera);
    }

    fn sda(&mut self) -> bool {
        self.registers.status().read().sda()
    }
}

/// Clears the engine's interrupt, for the interrupt handler.
pub fn acknowledge() {
    // SAFETY: only this function writes the pending register.
    let registers = unsafe { gesture::Gesture::steal() };
    registers
        .ev_pending()
        .write(EvPending::default().with_frame(true));
}

#[cfg(test)]
mod tests {
    use std::vec::Vec;

    use glint_core::hand::Setting;
    use litex_pac::gesture::Gesture;

    use super::*;
    use crate::recording::connect;

    /// Registers that exist in every build, at the addresses of docs/registers.md.
    fn engine() -> Gesture {
        // SAFETY: a model on the bus answers all accesses, so no device is affected.
        unsafe { Gesture::steal() }
    }

    #[test]
    fn without_the_block_there_is_no_driver() {
        connect([]);
        assert!(GestureEngine::probe(engine()).is_err());
    }

    #[test]
    fn the_sensor_is_off_at_first_and_its_wires_move_alone() {
        let block = connect([(Gesture::BASE, Gesture::IDENT)]);
        let camera = engine().camera().address();
        let mut driver = GestureEngine::probe(engine()).unwrap();
        (&mut driver).set(false, true);
        driver.set_power(true);
        (&mut driver).set(true, false);
        let block = block.borrow();
        let written = block.writes.iter();
        let written: Vec<u32> = written
            .filter(|(address, _)| *address == camera)
            .map(|(_, value)| *value)
            .collect();
        // Clock in bit 0, reset in bit 1, power-down in bit 2, SCL in bit 8, SDA in bit 9.
        assert_eq!(written, [0x306, 0x206, 0x201, 0x101]);
    }

    #[test]
    fn settings_and_statistics_have_their_places() {
        let registers = engine();
        let block = connect([
            (Gesture::BASE, Gesture::IDENT),
            (registers.count().address(), 500),
            (registers.sum_x().address(), 80_000),
            (registers.sum_y().address(), 60_000),
            (registers.box_x().address(), 190 << 16 | 130),
            (registers.box_y().address(), 150 << 16 | 90),
            (registers.sequence().address(), 7),
        ]);
        let mut driver = GestureEngine::probe(engine()).unwrap();
        driver.receive([320, 240], true);
        driver.set_gate(&Setting::SEARCHING);
        let (sequence, statistics) = driver.statistics().unwrap();
        assert_eq!((sequence, statistics.size), (7, [320, 240]));
        assert_eq!((statistics.count, statistics.sums), (500, [80_000, 60_000]));
        let Region { first, last } = statistics.bounds;
        assert_eq!((first, last), ([130, 90], [190, 150]));
        let value = |address| block.borrow().values.get(&address).copied();
        assert_eq!(value(registers.size().address()), Some(240 << 16 | 320));
        assert_eq!(value(registers.region_x().address()), Some(2047 << 16));
        assert_eq!(value(registers.control().address()), Some(0b11));
    }
}
