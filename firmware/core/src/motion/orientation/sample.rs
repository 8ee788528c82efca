//! Samples of a motion sensor.

/// One measurement of the sensor in raw counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sample {
    /// Time in µs, from an arbitrary origin.
    pub t_us: u64,
    /// Specific force along each axis, in counts.
    pub accel: [i16; 3],
    /// Angular rate about each axis, in counts.
    pub gyro: [i16; 3],
}
