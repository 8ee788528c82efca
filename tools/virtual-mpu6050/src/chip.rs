//! The virtual MPU-6050: its registers, its sample clock and its measurements.

use rand::RngExt;
use rand_pcg::Pcg64Mcg;
use virtual_i2c_device::Device;

/// I2C address with AD0 low.
pub const ADDRESS: u8 = 0x68;

/// Duration after a reset in which the chip does not answer, in ns.
pub const RESET_TIME: u64 = 50_000_000;

const SMPLRT_DIV: u8 = 0x19;
const CONFIG: u8 = 0x1a;
const GYRO_CONFIG: u8 = 0x1b;
const ACCEL_CONFIG: u8 = 0x1c;
const INT_ENABLE: u8 = 0x38;
const INT_STATUS: u8 = 0x3a;
const DATA: u8 = 0x3b;
const DATA_END: u8 = 0x48;
const PWR_MGMT_1: u8 = 0x6b;
const WHO_AM_I: u8 = 0x75;

const DATA_RDY: u8 = 0x01;
const DEVICE_RESET: u8 = 0x80;
const SLEEP: u8 = 0x40;

/// Delay in ms and bandwidth in Hz of the gyroscope's low-pass filter, for each value of DLPF_CFG; the reserved value 7 acts as 0.
const FILTERS: [(f64, f64); 8] = [
    (0.98, 256.0),
    (1.9, 188.0),
    (2.8, 98.0),
    (4.8, 42.0),
    (8.3, 20.0),
    (13.4, 10.0),
    (18.6, 5.0),
    (0.98, 256.0),
];

/// Counts of the gyroscope per °/s, for each value of FS_SEL.
const PER_DPS: [f64; 4] = [131.0, 65.5, 32.8, 16.4];
/// Counts of the accelerometer per g, for each value of AFS_SEL.
const PER_G: [f64; 4] = [16_384.0, 8_192.0, 4_096.0, 2_048.0];

/// Motion and temperature of the body that carries the sensor, at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// Rate about each axis in °/s.
    pub rate: [f64; 3],
    /// Specific force along each axis in g; at rest it opposes gravity.
    pub force: [f64; 3],
    /// Temperature of the chip in °C.
    pub temperature: f64,
}

impl Default for State {
    /// A body at rest, level, at 25 °C.
    fn default() -> Self {
        Self {
            rate: [0.0; 3],
            force: [0.0, 0.0, 1.0],
            temperature: 25.0,
        }
    }
}

/// Raw counts of the data registers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Counts of the accelerometer for each axis.
    pub accel: [i16; 3],
    /// Counts of the thermometer.
    pub temperature: i16,
    /// Counts of the gyroscope for each axis.
    pub gyro: [i16; 3],
}

impl Counts {
    fn bytes(self) -> [u8; 14] {
        let [ax, ay, az] = self.accel;
        let [gx, gy, gz] = self.gyro;
        let mut bytes = [0; 14];
        for (pair, count) in
            bytes
                .chunks_exact_mut(2)
                .zip([ax, ay, az, self.temperature, gx, gy, gz])
        {
            pair.copy_from_slice(&count.to_be_bytes());
        }
        bytes
    }
}

/// Source of the values that the chip measures.
pub enum Source {
    /// Function from the time in s to the motion at this time. The chip measures the motion with its imperfections.
    Motion(Box<dyn Fn(f64) -> State + Send>),
    /// Recorded counts, which the chip delivers unchanged, each with the time in ns from which it is delivered.
    Log(Vec<(u64, Counts)>),
}

/// Errors of the sensor's measurements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Imperfections {
    /// Bias of the gyroscope at 25 °C in °/s.
    pub bias: [f64; 3],
    /// Temperature coefficient of the gyroscope's bias, in °/s per °C.
    pub drift: [f64; 3],
    /// Scale factor of the gyroscope for each axis: measured rate per true rate, without bias.
    pub scale: [f64; 3],
    /// Noise density of the gyroscope in °/s per √Hz.
    pub noise: f64,
    /// Bias of the accelerometer in g.
    pub accel_bias: [f64; 3],
    /// Scale factor of the accelerometer for each axis: measured force per true force, without bias.
    pub accel_scale: [f64; 3],
    /// Noise density of the accelerometer in g per √Hz.
    pub accel_noise: f64,
    /// Relative error of the rate of the chip's clock: 0.01 is 1 % too fast.
    pub clock: f64,
}

impl Imperfections {
    /// An ideal sensor.
    pub const NONE: Self = Self {
        bias: [0.0; 3],
        drift: [0.0; 3],
        scale: [1.0; 3],
        noise: 0.0,
        accel_bias: [0.0; 3],
        accel_scale: [1.0; 3],
        accel_noise: 0.0,
        clock: 0.0,
    };
    /// Typical errors, within the limits of the data sheet.
    pub const TYPICAL: Self = Self {
        bias: [-4.5, 1.25, 2.0],
        drift: [0.16, -0.1, 0.05],
        scale: [1.01, 0.99, 1.005],
        noise: 0.005,
        accel_bias: [0.02, -0.03, 0.05],
        accel_scale: [1.01, 0.995, 0.99],
        accel_noise: 0.0004,
        clock: 0.004,
    };
}

/// A fault of the chip, for tests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// The chip is missing: no byte is acknowledged.
    Absent,
    /// The chip acknowledges its address, but no further byte.
    NoAcknowledge,
    /// The chip holds SDA low until the master has sent this number of clocks; with 0, forever.
    StuckData(u32),
    /// The chip stretches the clock for this time in ns after each byte; on its
    /// [`Wires`](crate::Wires), only after bytes from the master.
    Stretched(u64),
    /// The data registers do not change, but INT_STATUS still announces new data.
    Frozen,
    /// The chip makes no new measurements, and INT_STATUS announces none.
    Stalled,
    /// WHO_AM_I reads as this value.
    Identity(u8),
    /// The chip sends this number of bytes, and is then missing: the released bus reads as ones.
    Vanishing(u32),
}

/// A virtual MPU-6050, accessed by an I2C master.
pub struct Chip {
    registers: [u8; 128],
    /// Contents of the data registers.
    data: [u8; 14],
    /// The latest measurement, until it is moved to the data registers.
    newest: Option<[u8; 14]>,
    source: Source,
    imperfections: Imperfections,
    random: Pcg64Mcg,
    now: u64,
    /// Time of the next sample in ns; `None` in sleep mode.
    next: Option<u64>,
    /// Time from which the chip answers after a reset, in ns.
    answers: u64,
    /// Whether a transfer is between its start and its stop. The data registers do not change during a transfer.
    is_addressed: bool,
    /// I2C address: [`ADDRESS`], or [`ADDRESS`] + 1 with AD0 high.
    pub address: u8,
    /// Current fault.
    pub fault: Option<Fault>,
    /// Number of samples that the chip has taken so far.
    pub samples: u64,
    /// Number of samples that were overwritten before INT_STATUS was read.
    pub missed: u64,
}

impl Chip {
    /// Creates a chip in the state after power-up. `seed` determines the noise of its measurements.
    #[must_use]
    pub fn new(source: Source, imperfections: Imperfections, seed: u64) -> Self {
        let mut chip = Self {
            registers: [0; 128],
            data: [0; 14],
            newest: None,
            source,
            imperfections,
            random: Pcg64Mcg::new(u128::from(seed) << 1 | 1),
            now: 0,
            next: None,
            answers: 0,
            is_addressed: false,
            address: ADDRESS,
            fault: None,
            samples: 0,
            missed: 0,
        };
        chip.reset();
        chip.answers = 0;
        chip
    }

    /// Resets all registers, as a drop of the supply voltage does. The chip is then in sleep mode.
    pub fn reset(&mut self) {
        self.registers = [0; 128];
        self.registers[usize::from(PWR_MGMT_1)] = SLEEP;
        self.registers[usize::from(WHO_AM_I)] = 0x68;
        self.data = [0; 14];
        self.newest = None;
        self.next = None;
        self.answers = self.now + RESET_TIME;
    }

    /// Sample period in ns.
    #[must_use]
    pub fn period(&self) -> u64 {
        let internal = match self.registers[usize::from(CONFIG)] & 7 {
            0 | 7 => 125_000.0,
            _ => 1_000_000.0,
        };
        let divider = f64::from(self.registers[usize::from(SMPLRT_DIV)]) + 1.0;
        (internal * divider / (1.0 + self.imperfections.clock)) as u64
    }

    /// Reads a register. Reading INT_STATUS clears it. A missing chip reads as ones.
    pub fn read(&mut self, register: u8) -> u8 {
        match &mut self.fault {
            Some(Fault::Absent | Fault::Vanishing(0)) => {
                self.fault = Some(Fault::Absent);
                return 0xff;
            }
            Some(Fault::Vanishing(left)) => *left -= 1,
            _ => {}
        }
        match register & 0x7f {
            WHO_AM_I => match self.fault {
                Some(Fault::Identity(identity)) => identity,
                _ => self.registers[usize::from(WHO_AM_I)],
            },
            INT_STATUS => std::mem::take(&mut self.registers[usize::from(INT_STATUS)]),
            register @ DATA..=DATA_END => self.data[usize::from(register - DATA)],
            register => self.registers[usize::from(register)],
        }
    }

    /// Writes a register; read-only registers do not change.
    pub fn write(&mut self, register: u8, value: u8) {
        match register & 0x7f {
            WHO_AM_I | INT_STATUS | DATA..=DATA_END => {}
            PWR_MGMT_1 if value & DEVICE_RESET != 0 => self.reset(),
            PWR_MGMT_1 => {
                self.registers[usize::from(PWR_MGMT_1)] = value;
                self.next = match self.next {
                    _ if value & SLEEP != 0 => None,
                    None => Some(self.now + self.period()),
                    next => next,
                };
            }
            register => self.registers[usize::from(register)] = value,
        }
    }

    fn measure(&mut self, time: u64) {
        let counts = match &self.source {
            Source::Log(log) => {
                let after = log.partition_point(|(from, _)| *from <= time);
                log.get(after.saturating_sub(1))
                    .map_or(Counts::default(), |(_, counts)| *counts)
            }
            Source::Motion(_) => self.counts(time),
        };
        self.samples += 1;
        self.newest = Some(match self.fault {
            Some(Fault::Frozen) => self.newest.unwrap_or(self.data),
            _ => counts.bytes(),
        });
    }

    fn counts(&mut self, time: u64) -> Counts {
        let Source::Motion(motion) = &self.source else {
            return Counts::default();
        };
        let (delay, bandwidth) = FILTERS[usize::from(self.registers[usize::from(CONFIG)] & 7)];
        let state = motion((time as f64 * 1e-9 - delay * 1e-3).max(0.0));
        let range = |register: u8| usize::from(self.registers[usize::from(register)] >> 3 & 3);
        let per_dps = PER_DPS[range(GYRO_CONFIG)];
        let per_g = PER_G[range(ACCEL_CONFIG)];
        let Imperfections {
            bias,
            drift,
            scale,
            noise,
            accel_bias,
            accel_scale,
            accel_noise,
            ..
        } = self.imperfections;
        // A single-pole filter passes as much white noise as an ideal filter with π/2 times the bandwidth.
        let through = (bandwidth * std::f64::consts::FRAC_PI_2).sqrt();
        let warmth = state.temperature - 25.0;
        let gyro = [0, 1, 2].map(|i| {
            let rate = state.rate[i] * scale[i] + bias[i] + drift[i] * warmth;
            count((rate + noise * through * self.gauss()) * per_dps)
        });
        let accel = [0, 1, 2].map(|i| {
            let force = state.force[i] * accel_scale[i] + accel_bias[i];
            count((force + accel_noise * through * self.gauss()) * per_g)
        });
        let temperature = count((state.temperature - 36.53) * 340.0);
        Counts {
            accel,
            temperature,
            gyro,
        }
    }

    /// A random number of mean 0 and variance 1, approximately normally distributed.
    fn gauss(&mut self) -> f64 {
        let sum: f64 = (0..12).map(|_| self.random.random_range(0.0..1.0)).sum();
        sum - 6.0
    }

    /// Moves the latest measurement to the data registers and announces it in INT_STATUS, unless a transfer is in progress.
    fn refresh(&mut self) {
        if self.is_addressed {
            return;
        }
        if let Some(newest) = self.newest.take() {
            self.data = newest;
            if self.registers[usize::from(INT_ENABLE)] & DATA_RDY == 0 {
                return;
            }
            let status = &mut self.registers[usize::from(INT_STATUS)];
            self.missed += u64::from(*status & DATA_RDY);
            *status |= DATA_RDY;
        }
    }
}

impl Device for Chip {
    type Fault = Fault;

    fn number_bytes(&self) -> u8 {
        1
    }

    fn set_fault(&mut self, fault: Option<Fault>) {
        self.fault = fault;
    }

    fn advance(&mut self, now: u64) {
        while let Some(time) = self.next
            && time <= now
        {
            self.next = Some(time + self.period());
            if self.fault != Some(Fault::Stalled) {
                self.measure(time);
            }
        }
        self.now = self.now.max(now);
        self.refresh();
    }

    fn set_addressed(&mut self, is_addressed: bool) {
        self.is_addressed = is_addressed;
        self.refresh();
    }

    fn answers(&self, address: u8) -> bool {
        address == self.address && self.fault != Some(Fault::Absent) && self.now >= self.answers
    }

    fn acknowledges(&self) -> bool {
        self.fault != Some(Fault::NoAcknowledge)
    }

    fn stretch(&self) -> Option<u64> {
        match self.fault {
            Some(Fault::Stretched(time)) => Some(time),
            _ => None,
        }
    }

    fn is_stuck(&self, clocks: u32) -> bool {
        match self.fault {
            Some(Fault::StuckData(enough)) => enough == 0 || clocks < enough,
            _ => false,
        }
    }

    fn read(&mut self, register: u16) -> u8 {
        Self::read(self, register as u8)
    }

    fn write(&mut self, register: u16, value: u8) {
        Self::write(self, register as u8, value);
    }
}

/// Rounds to the nearest integer, and saturates to 16 bits.
fn count(value: f64) -> i16 {
    value.round() as i16
}
