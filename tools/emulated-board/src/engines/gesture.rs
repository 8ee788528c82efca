//! The gesture engine with the image sensor at its port (docs/gesture.md): `glint_model::gesture` processes the pin levels in each period
//! of the sensor's clock.

mod port;

use glint_core::gesture::{Region, Window};
use glint_model::gesture::{Channel, Engine, Fault as ModelFault, Pins, Polarity, Settings};
use litex_pac::gesture::{
    BoxX, BoxY, Camera, Caps, Control, EvPending, Fault, Gesture, RegionX, RegionY, Seen, Size,
    Snapshot, SnapshotState, Status, WindowA, WindowB, offset,
};
use litex_pac::register::Value;
use virtual_image_sensor::ImageSensor;

use crate::engines::parameters::Parameters;
use crate::{Device, Events, MainMemory, nanoseconds};

use port::Port;

/// Divider of the system clock for the sensor's input clock.
const CLOCK_DIVIDER: u8 = 4;

/// Number of clock cycles without an edge of the sensor's clock after which this clock counts as stopped.
const QUIET: u64 = 4096;

/// The gesture engine.
pub struct GestureEngine {
    parameters: Parameters,
    control: Control,
    camera: Camera,
    events: Events,
    engine: Box<Engine>,
    /// Last written value of the register `snapshot`.
    snapshot: u32,
    /// Index of the next word of the small picture to read.
    place: u16,
    port: Port,
    /// Whether the sensor's clock is running.
    is_running: bool,
    sensor: Option<ImageSensor>,
    /// Levels of SCL and SDA.
    wires: [bool; 2],
}

impl Default for GestureEngine {
    fn default() -> Self {
        Self::new()
    }
}

impl GestureEngine {
    /// The engine after a reset, without a sensor.
    #[must_use]
    pub fn new() -> Self {
        let parameters = Parameters::new();
        let engine = Engine::new(Polarity::default(), settings(&parameters), Pins::default());
        let mut gesture = Self {
            parameters,
            control: Control::default(),
            // The state after a reset: the sensor is off, and the wires of its bus are released.
            camera: Camera::default()
                .with_reset(true)
                .with_power_down(true)
                .with_scl(true)
                .with_sda(true),
            events: Events::default(),
            engine: Box::new(engine),
            snapshot: 0,
            place: 0,
            port: Port::default(),
            is_running: false,
            sensor: None,
            wires: [true; 2],
        };
        gesture.engine.set_enabled(false);
        gesture
    }

    /// Resets the engine. The sensor stays connected; its inputs have their values after a reset.
    pub(crate) fn reset(&mut self) {
        let sensor = self.sensor.take();
        *self = Self {
            sensor,
            ..Self::new()
        };
    }

    /// Connects an image sensor; replaces the connected sensor, if any.
    pub fn plug(&mut self, sensor: ImageSensor) {
        self.port.clear();
        self.sensor = Some(sensor);
    }

    /// The image sensor.
    pub const fn sensor(&mut self) -> Option<&mut ImageSensor> {
        self.sensor.as_mut()
    }

    /// Passes the engine's outputs to the sensor, and reads the levels of the sensor's bus.
    fn update_wires(&mut self, now: u64) {
        let camera = self.camera;
        let (scl, sda) = (camera.scl(), camera.sda());
        let Some(sensor) = &mut self.sensor else {
            self.wires = [scl, sda];
            return;
        };
        let (scl, sda) = sensor.wires.update(nanoseconds(now), scl, sda);
        self.wires = [scl, sda];
        let is_awake = camera.clock() && !camera.power_down();
        if sensor.set_inputs(!camera.reset(), is_awake) {
            self.port.clear();
        }
    }

    /// Advances the sensor's clock to the cycle `now`. Returns the cycle of the next event: VSYNC changes, the frame ends, or a clock
    /// without edges counts as stopped.
    fn settle(&mut self, now: u64) -> u64 {
        self.update_wires(now);
        let Some(sensor) = &mut self.sensor else {
            return self.watch(now);
        };
        loop {
            self.port.fill(sensor, now);
            let Some((cycle, pins)) = self.port.next(now, self.control.falling()) else {
                if self.port.has_sent(now) {
                    continue;
                }
                break;
            };
            let quiet_from = self.port.last_tick + QUIET;
            if self.is_running && cycle > quiet_from {
                self.engine.stop();
            }
            self.is_running = true;
            self.port.last_tick = cycle;
            let frames = self.engine.counts.frames;
            self.engine.clock(pins);
            if self.engine.counts.frames != frames {
                self.events.raise(frame_event());
            }
        }
        self.watch(now).min(self.port.next_event())
    }

    /// Detects that the sensor's clock has stopped. Returns the cycle in which the clock counts as stopped.
    fn watch(&mut self, now: u64) -> u64 {
        let quiet = self.port.last_tick + QUIET;
        if self.is_running && quiet <= now {
            self.is_running = false;
            self.engine.stop();
        }
        if self.is_running { quiet } else { u64::MAX }
    }

    fn status(&self) -> Status {
        let levels = self.port.levels();
        Status::default()
            .with_running(self.is_running)
            .with_waiting(self.engine.is_waiting())
            .with_vsync(levels.vsync())
            .with_href(levels.href())
            .with_scl(self.wires[0])
            .with_sda(self.wires[1])
            .with_fault(match self.engine.fault {
                None => Fault::None,
                Some(ModelFault::Pixels) => Fault::Pixels,
                Some(ModelFault::Byte) => Fault::Byte,
                Some(ModelFault::Lines) => Fault::Lines,
                Some(ModelFault::Cut) => Fault::Cut,
                Some(ModelFault::Lost) => Fault::Lost,
                Some(ModelFault::Stopped) => Fault::Stopped,
            })
    }

    fn snapshot_state(&self) -> SnapshotState {
        self.engine
            .snapshot()
            .map_or(SnapshotState::default(), |snapshot| {
                SnapshotState::default()
                    .with_words(snapshot.words().len() as u16)
                    .with_ready(true)
                    .with_sequence(snapshot.frame() as u16)
            })
    }

    /// Returns the word of the small picture at the read index, and increments the index.
    fn snapshot_word(&mut self) -> u16 {
        let words = self.engine.snapshot().map(|snapshot| snapshot.words());
        let word = words.and_then(|words| words.get(usize::from(self.place)));
        let word = word.copied().unwrap_or(0);
        self.place = (self.place + 1) % Gesture::SNAPSHOT_WORDS as u16;
        word
    }
}

/// Bit of the event at the end of a complete frame.
fn frame_event() -> u32 {
    EvPending::default().with_frame(true).bits()
}

/// The settings of the next frame.
fn settings(parameters: &Parameters) -> Settings {
    let size = Size::from_bits(parameters.word(offset::SIZE));
    let a = WindowA::from_bits(parameters.word(offset::WINDOW_A));
    let b = WindowB::from_bits(parameters.word(offset::WINDOW_B));
    let x = RegionX::from_bits(parameters.word(offset::REGION_X));
    let y = RegionY::from_bits(parameters.word(offset::REGION_Y));
    let window = |channel: Option<litex_pac::gesture::Channel>, lower, upper| {
        let number = channel.map_or(0, |channel| channel as usize);
        let channel = Channel::ALL.get(number).copied();
        (channel.unwrap_or(Channel::Red), Window { lower, upper })
    };
    Settings {
        size: [size.width(), size.height()],
        windows: [
            window(a.channel(), a.lower(), a.upper()),
            window(b.channel(), b.lower(), b.upper()),
        ],
        region: Region {
            first: [x.first(), y.first()],
            last: [x.last(), y.last()],
        },
        least_run: parameters.unsigned(offset::LEAST_RUN, 4) as u8,
    }
}

impl Device for GestureEngine {
    fn read(&mut self, offset: u32, now: u64) -> u32 {
        self.settle(now);
        let engine = &self.engine;
        let results = &engine.results;
        let [[left, top], [right, bottom]] = [results.bounds.first, results.bounds.last];
        match offset {
            offset::IDENT => Gesture::IDENT,
            offset::CAPS => Caps::default()
                .with_width(Settings::MAX_SIZE[0])
                .with_height(Settings::MAX_SIZE[1])
                .with_clock_divider(CLOCK_DIVIDER)
                .bits(),
            offset::CONTROL => self.control.bits(),
            offset::CAMERA => self.camera.bits(),
            offset::STATUS => self.status().bits(),
            offset::SEEN => Seen::default()
                .with_pixels(engine.seen.pixels)
                .with_lines(engine.seen.lines)
                .bits(),
            offset::EV_STATUS => self.events.status(),
            offset::EV_PENDING => self.events.pending(),
            offset::EV_ENABLE => self.events.enabled(),
            // Number of complete frames, modulo 2^16.
            offset::SEQUENCE => engine.counts.frames & 0xFFFF,
            offset::COUNT => results.count,
            offset::SUM_X => results.sums[0],
            offset::SUM_Y => results.sums[1],
            offset::BOX_X => BoxX::default().with_first(left).with_last(right).bits(),
            offset::BOX_Y => BoxY::default().with_first(top).with_last(bottom).bits(),
            offset::SNAPSHOT => self.snapshot,
            offset::SNAPSHOT_STATE => self.snapshot_state().bits(),
            offset::SNAPSHOT_WORD => self.snapshot_word().into(),
            offset::FRAMES => engine.counts.frames,
            offset::FRAMES_DROPPED => engine.counts.frames_dropped,
            offset::LINES_MALFORMED => engine.counts.lines_malformed,
            _ => 0,
        }
    }

    fn write(&mut self, offset: u32, value: u32, now: u64, _: &mut MainMemory) {
        self.settle(now);
        match offset {
            offset::CONTROL => {
                self.control = Control::from_bits(value);
                self.engine.polarity = Polarity {
                    vsync_low: self.control.vsync_low(),
                    href_low: self.control.href_low(),
                    swap: self.control.swap(),
                };
                self.engine.set_enabled(self.control.enable());
            }
            offset::CAMERA => {
                self.camera = Camera::from_bits(value);
                self.update_wires(now);
            }
            offset::EV_PENDING => self.events.clear(value),
            offset::EV_ENABLE => self.events.enable(value & frame_event()),
            offset::SNAPSHOT => {
                let request = Snapshot::from_bits(value);
                let stored = Snapshot::default().with_step(request.step());
                let stored = stored.with_colour(request.colour());
                self.snapshot = stored.with_start(request.start()).bits();
                if request.start() {
                    // The engine masks at most five bits of a column number.
                    let step = request.step().min(5);
                    self.engine.request_snapshot(step, request.colour());
                }
            }
            offset::SNAPSHOT_PLACE => self.place = (value & (Gesture::SNAPSHOT_WORDS - 1)) as u16,
            _ => {
                self.parameters.set(offset, value);
                self.engine.settings = settings(&self.parameters);
            }
        }
    }

    fn advance(&mut self, now: u64, _: &mut MainMemory) -> u64 {
        self.settle(now)
    }

    fn interrupt(&self) -> bool {
        self.events.interrupt()
    }
}
