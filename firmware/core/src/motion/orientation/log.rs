//! The format of a log of sensor samples, which a board can replay: a header, then one record for each sample. A replay computes
//! the attitude after each sample, and writes the attitude over the sample's record.
//!
//! All numbers are little-endian. The difference of the times of two samples, modulo 2^32, is signed: below 2^31 µs (36 minutes) the
//! second sample is later, otherwise it is earlier.
//!
//! | bytes | header |
//! |---|---|
//! | 0–3 | `GIMU` |
//! | 4–7 | number of samples, at least 1 |
//! | 8–15 | LSB of the gyroscope per °/s, s32.32 |
//! | 16–19 | LSB of the accelerometer per g |
//! | 20–23 | flags: bit 0 for tilt correction by the accelerometer, bit 1 for tracking of the bias at rest |
//! | 24–35 | bias of the gyroscope in 1/256 LSB, s32 ×3 |
//! | 36–47 | reserved, 0 |
//!
//! | bytes | record | as an attitude |
//! |---|---|---|
//! | 0–3 | time in µs modulo 2^32, u32 | w, s2.30 |
//! | 4–9 | accelerometer x, y, z, s16 ×3 | x (4–7), y (8–11) |
//! | 10–15 | gyroscope x, y, z, s16 ×3 | z (12–15) |

use core::fmt;

use super::quaternion::Quaternion;
use super::rest::RestBias;
use super::sample::Sample;
use super::scale::{LSB_PER_DPS, Scale};
use super::tilt::{LSB_PER_G, TIME_CONSTANT, Tilt};
use super::tracker::{Counts, Tracker};
use super::units::Units;
use crate::fixed::Q32_32;

/// Size of the header in bytes.
pub const HEADER_BYTES: usize = 48;
/// Size of a record in bytes.
pub const RECORD_BYTES: usize = 16;
/// Largest accepted magnitude of a bias, in 1/256 LSB. No mean of 16-bit counts exceeds this limit.
pub const LARGEST_BIAS: u32 = 1 << 23;

const MAGIC: [u8; 4] = *b"GIMU";
const TILT: u32 = 1 << 0;
const FOLLOW_BIAS: u32 = 1 << 1;

/// The four words of a record: a sample, or the attitude after this sample.
pub type Record = [u32; 4];

/// The parameters of a replay, from the log's header.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Setup {
    units: Units,
    scale: Scale,
    tilt: bool,
    follow_bias: bool,
    bias: [i32; 3],
}

/// Reason why bytes are not a log.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LogError {
    /// The log is shorter than a header. The value is its length in bytes.
    Short(usize),
    /// The magic number is wrong.
    Magic([u8; 4]),
    /// The log has no samples.
    Empty,
    /// The length of the log does not match the number of samples in its header.
    Length {
        /// The number of samples in the header.
        samples: u32,
        /// The number of bytes of the log.
        bytes: usize,
    },
    /// The gyroscope's LSB per °/s are out of range.
    PerDps(Q32_32),
    /// The accelerometer's LSB per g are out of range.
    PerG(u32),
    /// The header has unknown flags.
    Flags(u32),
    /// The bias of an axis is out of range.
    Bias {
        /// The axis, 0 for x.
        axis: usize,
        /// The bias in 1/256 LSB.
        bias: i32,
    },
    /// Reserved bytes of the header are not 0.
    Reserved,
}

impl fmt::Display for LogError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("log: expected ")?;
        match *self {
            Self::Short(bytes) => {
                write!(f, "a header of {HEADER_BYTES} bytes, found {bytes} bytes")
            }
            Self::Magic(found) => write!(
                f,
                "\"{}\" at the start, found \"{}\"",
                MAGIC.escape_ascii(),
                found.escape_ascii()
            ),
            Self::Empty => f.write_str("at least one sample, found none"),
            Self::Length { samples, bytes } => write!(
                f,
                "{} bytes for {samples} samples, found {bytes}",
                length(samples)
            ),
            Self::PerDps(lsb) => {
                let [low, high] = LSB_PER_DPS;
                write!(f, "from {low} to {high} LSB per °/s, found {lsb}")
            }
            Self::PerG(lsb) => {
                let [low, high] = LSB_PER_G;
                write!(f, "from {low} to {high} LSB per g, found {lsb}")
            }
            Self::Flags(flags) => write!(
                f,
                "no flags but {:#x}, found {flags:#x}",
                TILT | FOLLOW_BIAS
            ),
            Self::Bias { axis, bias } => write!(
                f,
                "a bias within ±{LARGEST_BIAS}/256 LSB, found {bias}/256 of axis {axis}"
            ),
            Self::Reserved => f.write_str("zeros in bytes 36 to 47, found others"),
        }
    }
}

impl core::error::Error for LogError {}

/// Length in bytes of a log with this number of samples.
const fn length(samples: u32) -> u64 {
    HEADER_BYTES as u64 + RECORD_BYTES as u64 * samples as u64
}

impl Setup {
    /// Makes the parameters of a replay, after checking them: the units of the counts, whether the accelerometer corrects the
    /// tilt, whether the bias is tracked at rest, and the bias in 1/256 LSB.
    ///
    /// # Errors
    /// The units or the bias are out of range.
    pub fn new(
        units: Units,
        tilt: bool,
        follow_bias: bool,
        bias: [i32; 3],
    ) -> Result<Self, LogError> {
        let scale = Scale::new(units.per_dps).ok_or(LogError::PerDps(units.per_dps))?;
        if !(LSB_PER_G[0]..=LSB_PER_G[1]).contains(&units.per_g) {
            return Err(LogError::PerG(units.per_g));
        }
        for (axis, &bias) in bias.iter().enumerate() {
            if bias.unsigned_abs() > LARGEST_BIAS {
                return Err(LogError::Bias { axis, bias });
            }
        }
        Ok(Self {
            units,
            scale,
            tilt,
            follow_bias,
            bias,
        })
    }

    /// Makes a tracker with these parameters, which has not yet taken a sample.
    pub fn tracker(&self) -> Tracker {
        let tilt = self
            .tilt
            .then(|| Tilt::new(self.units.per_g, TIME_CONSTANT));
        let mut tracker = Tracker::new(self.scale, tilt);
        tracker.set_bias(self.bias);
        if self.follow_bias {
            tracker.follow_bias(RestBias::new(self.units, self.bias));
        }
        tracker
    }

    /// Encodes the header of a log with these parameters and this number of samples.
    pub fn header(&self, samples: u32) -> [u8; HEADER_BYTES] {
        let mut flags = 0;
        if self.tilt {
            flags |= TILT;
        }
        if self.follow_bias {
            flags |= FOLLOW_BIAS;
        }
        let [x, y, z] = self.bias.map(i32::to_le_bytes);
        let parts: [&[u8]; 8] = [
            &MAGIC,
            &samples.to_le_bytes(),
            &self.units.per_dps.to_bits().to_le_bytes(),
            &self.units.per_g.to_le_bytes(),
            &flags.to_le_bytes(),
            &x,
            &y,
            &z,
        ];
        let mut header = [0; HEADER_BYTES];
        let bytes = parts.into_iter().flatten();
        header
            .iter_mut()
            .zip(bytes)
            .for_each(|(to, &byte)| *to = byte);
        header
    }

    fn parse(header: &[u8; HEADER_BYTES]) -> Result<(Self, u32), LogError> {
        let &[
            magic,
            samples,
            low,
            high,
            per_g,
            flags,
            x,
            y,
            z,
            ref rest @ ..,
        ] = header.as_chunks().0
        else {
            return Err(LogError::Short(header.len()));
        };
        if magic != MAGIC {
            return Err(LogError::Magic(magic));
        }
        let flags = u32::from_le_bytes(flags);
        if flags & !(TILT | FOLLOW_BIAS) != 0 {
            return Err(LogError::Flags(flags));
        }
        if *rest != [[0; 4]; 3] {
            return Err(LogError::Reserved);
        }
        let per_dps =
            i64::from(u32::from_le_bytes(low)) | i64::from(i32::from_le_bytes(high)) << 32;
        let units = Units {
            per_dps: Q32_32::from_bits(per_dps),
            per_g: u32::from_le_bytes(per_g),
        };
        let bias = [x, y, z].map(i32::from_le_bytes);
        let setup = Self::new(units, flags & TILT != 0, flags & FOLLOW_BIAS != 0, bias)?;
        Ok((setup, u32::from_le_bytes(samples)))
    }
}

/// Checks a log, and returns its parameters and the bytes of its records.
///
/// # Errors
/// The first deviation from the format.
pub fn open(bytes: &mut [u8]) -> Result<(Setup, &mut [[u8; RECORD_BYTES]]), LogError> {
    let all = bytes.len();
    let (header, records) = bytes
        .split_first_chunk_mut::<HEADER_BYTES>()
        .ok_or(LogError::Short(all))?;
    let (setup, samples) = Setup::parse(header)?;
    if samples == 0 {
        return Err(LogError::Empty);
    }
    if all as u64 != length(samples) {
        return Err(LogError::Length {
            samples,
            bytes: all,
        });
    }
    Ok((setup, records.as_chunks_mut().0))
}

/// Decodes a record from its bytes.
pub fn from_bytes(bytes: &[u8; RECORD_BYTES]) -> Record {
    let mut words = bytes
        .as_chunks()
        .0
        .iter()
        .map(|&word| u32::from_le_bytes(word));
    [0; 4].map(|nothing| words.next().unwrap_or(nothing))
}

/// Encodes a record to its bytes.
pub fn to_bytes(record: Record) -> [u8; RECORD_BYTES] {
    let mut bytes = [0; RECORD_BYTES];
    for (to, word) in bytes.as_chunks_mut().0.iter_mut().zip(record) {
        *to = word.to_le_bytes();
    }
    bytes
}

/// Packs a sample into a record.
pub fn record(sample: &Sample) -> Record {
    let pair = |low: i16, high: i16| u32::from(low as u16) | u32::from(high as u16) << 16;
    let ([ax, ay, az], [gx, gy, gz]) = (sample.accel, sample.gyro);
    // The record contains the low word of the time.
    let time = sample.t_us as u32;
    [time, pair(ax, ay), pair(az, gx), pair(gy, gz)]
}

/// The time in µs before the first sample of a log, for [`sample`]: with this value the first sample has the time of its record.
pub const START: u64 = 1 << 31;

/// Unpacks the sample in a record. `last` is the time in µs of the previous sample, or [`START`].
pub const fn sample([time, ax_ay, az_gx, gy_gz]: Record, last: u64) -> Sample {
    let step = time.wrapping_sub(last as u32).cast_signed();
    Sample {
        // Times wrap modulo 2^64, so a time before 0 does not affect later times.
        t_us: last.wrapping_add_signed(step as i64),
        accel: [ax_ay as i16, (ax_ay >> 16) as i16, az_gx as i16],
        gyro: [(az_gx >> 16) as i16, gy_gz as i16, (gy_gz >> 16) as i16],
    }
}

/// Packs an attitude into a record.
pub fn attitude_record(attitude: Quaternion) -> Record {
    attitude.parts.map(|part| part as u32)
}

/// Unpacks the attitude in a record; `None` unless the quaternion's length is 1 (within 2^−28).
pub fn attitude(record: Record) -> Option<Quaternion> {
    Quaternion::exact(record.map(|part| part as i32))
}

/// Replays a log in place: replaces each sample by the attitude after this sample. Returns the numbers of samples by their effect
/// on the attitude.
///
/// # Errors
/// The bytes are not a log; they are not modified.
pub fn replay(bytes: &mut [u8]) -> Result<Counts, LogError> {
    let (setup, records) = open(bytes)?;
    let mut tracker = setup.tracker();
    let mut time = START;
    for record in records {
        let sample = sample(from_bytes(record), time);
        time = sample.t_us;
        tracker.on_sample(&sample);
        *record = to_bytes(attitude_record(tracker.attitude()));
    }
    Ok(tracker.counts())
}
