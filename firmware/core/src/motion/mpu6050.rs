//! The MPU-6050, and chips with the same registers: from power-on to samples with time stamps.
//!
//! [`Mpu6050`] configures the chip over any [`I2c`]; the caller provides the delays. [`Stream`] runs endlessly: it finds the
//! chip, wakes it, reads each sample once, and recovers from every error of the bus. The bus repeats one read periodically
//! ([`PeriodicI2c`]); [`Pace`] computes the times of the samples from the times of these reads.
//!
//! The registers are those of the register map RM-MPU-6000A, revision 4.2. The ranges are ±2000 °/s and ±8 g, the low-pass filter
//! has a bandwidth of 98 Hz (a delay of 2.8 ms), and the sample rate is 1 kHz.

mod pace;
mod stream;

use core::fmt;

use embedded_hal_async::delay::DelayNs;
use embedded_hal_async::i2c::{Error as _, ErrorKind, I2c, Operation};
use glint_i2c::{PeriodicI2c, PeriodicRead};

use crate::fixed::Q32_32;

pub use pace::Pace;
pub use stream::{Sink, Stream};

/// The chip's two possible I2C addresses: the first with its pin AD0 low, the second with AD0 high.
pub const ADDRESSES: [u8; 2] = [0x68, 0x69];

/// LSB of the gyroscope per 10 °/s, at the range that [`Mpu6050`] configures.
const LSB_PER_10_DPS: i64 = 164;
/// LSB of the gyroscope per °/s: 16.4.
pub const GYRO_LSB_PER_DPS: Q32_32 = Q32_32::from_bits((LSB_PER_10_DPS << 32) / 10);

/// Converts a rate from 1/256 LSB (below 2^32 in magnitude) to °/s, rounded towards zero to a multiple of 2^−32.
#[must_use]
pub const fn degrees_per_second(rate: i64) -> Q32_32 {
    Q32_32::from_bits((rate << 24) * 10 / LSB_PER_10_DPS)
}

/// The time between two samples of the chip, in µs.
pub const PERIOD: u32 = 1_000;

/// Number of reads per interrupt of the processor.
const BATCH: u8 = 5;

/// Time that a reset of the chip takes, in ms.
const RESET: u32 = 100;
/// Time that the gyroscope's oscillator needs to settle, in ms.
const START: u32 = 30;

const SMPLRT_DIV: u8 = 0x19;
const INT_ENABLE: u8 = 0x38;
const INT_STATUS: u8 = 0x3a;
const PWR_MGMT_1: u8 = 0x6b;
const WHO_AM_I: u8 = 0x75;

/// Bit DEVICE_RESET of PWR_MGMT_1.
const DEVICE_RESET: u8 = 0x80;
/// Value of PWR_MGMT_1 for a chip that is awake and clocked by the oscillator of its x gyroscope.
const CLOCK_OF_X: u8 = 0x01;
/// Bit DATA_RDY of INT_ENABLE and INT_STATUS.
const DATA_RDY: u8 = 0x01;

/// Values of four consecutive registers from SMPLRT_DIV on: 1 kHz, DLPF_CFG 2 (the filter of 98 Hz), ±2000 °/s, ±8 g.
const CONFIGURATION: [u8; 4] = [0x00, 0x02, 0x18, 0x10];

/// The type of a chip, by the contents of its register WHO_AM_I.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Identity {
    /// An MPU-6050 or MPU-6000.
    Mpu6050,
    /// An MPU-6500.
    Mpu6500,
    /// An MPU-9250.
    Mpu9250,
    /// An MPU-9255.
    Mpu9255,
    /// An ICM-20689, which is sold as MPU-6050.
    Icm20689,
    /// Another chip, which keeps the configuration of an MPU-6050 and is used as an MPU-6050. The value is the
    /// contents of its register WHO_AM_I.
    Other(u8),
}

/// Values of WHO_AM_I that no chip has: all bits low or high, as on a bus without an answer.
const NO_CHIP: [u8; 2] = [0x00, RELEASED];

impl Identity {
    /// The known chips: contents of the register WHO_AM_I, type and name.
    const ALL: [(u8, Self, &str); 5] = [
        (0x68, Self::Mpu6050, "MPU-6050"),
        (0x70, Self::Mpu6500, "MPU-6500"),
        (0x71, Self::Mpu9250, "MPU-9250"),
        (0x73, Self::Mpu9255, "MPU-9255"),
        (0x98, Self::Icm20689, "ICM-20689"),
    ];

    /// The identity of a chip by the contents of its register WHO_AM_I; `None` for a value that no chip has.
    fn of(found: u8) -> Option<Self> {
        let known = Self::ALL.iter().find(|(code, ..)| *code == found);
        let other = || (!NO_CHIP.contains(&found)).then_some(Self::Other(found));
        known.map(|(_, identity, _)| *identity).or_else(other)
    }

    /// Converts `raw`, the chip's temperature register, to 1/100 °C. The quotient is rounded towards 0.
    pub const fn temperature(self, raw: i16) -> i32 {
        let raw = raw as i32;
        match self {
            // The temperature is 36.53 °C plus 1/340 °C per LSB.
            Self::Mpu6050 | Self::Other(_) => 3_653 + raw * 5 / 17,
            // The temperature is 21 °C plus 1/333.87 °C per LSB.
            Self::Mpu6500 | Self::Mpu9250 | Self::Mpu9255 => 2_100 + raw * 10_000 / 33_387,
            // The temperature is 25 °C plus 1/326.8 °C per LSB.
            Self::Icm20689 => 2_500 + raw * 1_000 / 3_268,
        }
    }
}

impl fmt::Display for Identity {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        if let Self::Other(found) = self {
            return write!(
                f,
                "unknown chip, used as an MPU-6050: WHO_AM_I is {found:#04x}"
            );
        }
        let known = Self::ALL.iter().find(|(_, identity, _)| identity == self);
        f.write_str(known.map_or("", |(.., name)| name))
    }
}

/// One sample of the chip in counts; all its numbers were measured at the same time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Measurement {
    /// The specific force along each axis, in units of 1/4096 g.
    pub accel: [i16; 3],
    /// The temperature in counts, which [`Identity::temperature`] converts to 1/100 °C.
    pub temperature: i16,
    /// The rate about each axis in counts, [`GYRO_LSB_PER_DPS`] counts per °/s.
    pub gyro: [i16; 3],
}

impl Measurement {
    const BYTES: usize = 14;

    fn from_bytes(bytes: &[u8; Self::BYTES]) -> Self {
        let (words, _) = bytes.as_chunks::<2>();
        let mut all = [0; 7];
        for (count, word) in all.iter_mut().zip(words) {
            *count = i16::from_be_bytes(*word);
        }
        let [ax, ay, az, temperature, gx, gy, gz] = all;
        Self {
            accel: [ax, ay, az],
            temperature,
            gyro: [gx, gy, gz],
        }
    }
}

/// Error of the sensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Error<E> {
    /// Error of the I2C bus.
    Bus(E),
    /// The register WHO_AM_I has this value, which no chip has.
    Identity(u8),
    /// A register does not keep the written value.
    Register {
        /// Number of the register.
        register: u8,
        /// The written value.
        expected: u8,
        /// The value read.
        found: u8,
    },
    /// The chip answers, but has no new sample.
    Silent,
    /// Many successive samples are equal, so the chip does not measure.
    Frozen,
    /// The chip sent only a part of its sample.
    Cut,
}

impl<E> From<E> for Error<E> {
    fn from(error: E) -> Self {
        Self::Bus(error)
    }
}

impl<E: fmt::Display> fmt::Display for Error<E> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Bus(error) => error.fmt(f),
            Self::Identity(found) => {
                write!(f, "WHO_AM_I is {found:#04x}: expected")?;
                let mut between = " ";
                for (code, _, name) in Identity::ALL {
                    write!(f, "{between}{code:#04x} ({name})")?;
                    between = ", ";
                }
                Ok(())
            }
            Self::Register {
                register,
                expected,
                found,
            } => write!(
                f,
                "register {register:#04x} is {found:#04x}: expected {expected:#04x} as written"
            ),
            Self::Silent => write!(f, "no samples: expected {} per second", 1_000_000 / PERIOD),
            Self::Frozen => f.write_str("all samples are equal: expected noise"),
            Self::Cut => f.write_str("the sensor vanished within a sample: expected all its bytes"),
        }
    }
}

/// A driver of the chip on an I2C bus.
pub struct Mpu6050<B> {
    bus: B,
    address: u8,
}

impl<B: I2c> Mpu6050<B> {
    /// Makes a driver for a chip on `bus`; [`start`](Self::start) finds the chip.
    pub const fn new(bus: B) -> Self {
        Self {
            bus,
            address: ADDRESSES[0],
        }
    }

    /// Finds the chip at one of its addresses, then resets and configures it, which takes 0.13 s. Without `reset`, a chip that is
    /// already configured stays unchanged.
    ///
    /// # Errors
    /// The chip is absent, or does not accept its configuration.
    pub async fn start(
        &mut self,
        reset: bool,
        delay: &mut impl DelayNs,
    ) -> Result<Identity, Error<B::Error>> {
        let identity = self.find().await?;
        if reset || self.check().await.is_err() {
            self.write(PWR_MGMT_1, &[DEVICE_RESET]).await?;
            delay.delay_ms(RESET).await;
            self.write(PWR_MGMT_1, &[CLOCK_OF_X]).await?;
            delay.delay_ms(START).await;
            self.write(SMPLRT_DIV, &CONFIGURATION).await?;
            self.write(INT_ENABLE, &[DATA_RDY]).await?;
            self.check().await?;
        }
        Ok(identity)
    }

    /// Checks that the chip is awake and configured. A chip loses its configuration when its supply fails.
    ///
    /// # Errors
    /// The chip is not configured, or absent.
    pub async fn check(&mut self) -> Result<(), Error<B::Error>> {
        self.expect(PWR_MGMT_1, [CLOCK_OF_X]).await?;
        self.expect(SMPLRT_DIV, CONFIGURATION).await?;
        self.expect(INT_ENABLE, [DATA_RDY]).await
    }

    async fn find(&mut self) -> Result<Identity, Error<B::Error>> {
        let mut found = [0];
        for address in ADDRESSES {
            self.address = address;
            let answer = self.bus.write_read(address, &[WHO_AM_I], &mut found).await;
            match answer {
                Ok(()) => return Identity::of(found[0]).ok_or(Error::Identity(found[0])),
                // No chip answers at the first address: the loop tries the second address.
                Err(error)
                    if address == ADDRESSES[0]
                        && matches!(error.kind(), ErrorKind::NoAcknowledge(_)) => {}
                Err(error) => return Err(error.into()),
            }
        }
        Err(Error::Identity(found[0]))
    }

    /// Writes consecutive registers, from the number `register` on.
    async fn write(&mut self, register: u8, values: &[u8]) -> Result<(), Error<B::Error>> {
        let mut operations = [Operation::Write(&[register]), Operation::Write(values)];
        Ok(self.bus.transaction(self.address, &mut operations).await?)
    }

    /// Reads consecutive registers, from the number `register` on, and checks that they have the expected values.
    async fn expect<const N: usize>(
        &mut self,
        register: u8,
        expected: [u8; N],
    ) -> Result<(), Error<B::Error>> {
        let mut found = [0; N];
        self.bus
            .write_read(self.address, &[register], &mut found)
            .await?;
        for ((expected, found), register) in expected.into_iter().zip(found).zip(register..) {
            if found != expected {
                return Err(Error::Register {
                    register,
                    expected,
                    found,
                });
            }
        }
        Ok(())
    }
}

/// The bytes of one periodic read: INT_STATUS, the sample, then EXT_SENS_DATA_00, which is 0.
///
/// The master, not the chip, acknowledges received bytes, so the master does not detect a chip that vanishes during a read:
/// the released bus reads as ones. EXT_SENS_DATA_00 verifies that the chip responded until the end of the sample.
type Burst = [u8; 1 + Measurement::BYTES + 1];

/// Value that the master reads if no device sends.
const RELEASED: u8 = 0xff;

impl<B: PeriodicI2c> Mpu6050<B> {
    /// Starts to read the chip every `period` µs. A read is one burst, which takes 0.45 ms at 400 kHz; during a burst the chip
    /// keeps its data constant.
    ///
    /// # Errors
    /// The bus fails.
    pub fn begin_polling(&mut self, period: u32) -> Result<(), Error<B::Error>> {
        Ok(self.bus.begin(PeriodicRead {
            address: self.address,
            register: INT_STATUS,
            length: size_of::<Burst>() as u8,
            period,
            batch: BATCH,
        })?)
    }

    /// Waits for the next periodic read, and returns the time of its start in µs, and its sample. The sample is `None` if an
    /// earlier read already returned it.
    ///
    /// # Errors
    /// The bus fails, or the chip vanishes within the sample.
    pub async fn poll(&mut self) -> Result<(u64, Option<Measurement>), Error<B::Error>> {
        let mut bytes = Burst::default();
        let time = self.bus.next(&mut bytes).await?;
        let [status, data @ .., end] = bytes;
        if end == RELEASED {
            return Err(Error::Cut);
        }
        let is_new = status & DATA_RDY != 0;
        Ok((time, is_new.then(|| Measurement::from_bytes(&data))))
    }
}
