//! The endless stream of samples from a chip.

use core::convert::Infallible;

use embedded_hal_async::delay::DelayNs;
use embedded_hal_async::i2c::{Error as _, ErrorKind};
use glint_i2c::PeriodicI2c;

use super::pace::Pace;
use super::{Error, Identity, Measurement, Mpu6050, PERIOD};

/// Time between the starts of two reads in µs. This is slightly longer than the duration of a read, and slightly shorter than
/// half a sample period. Therefore no sample is missed, and relative to the samples the reads drift by 40 µs per sample period.
const POLL_PERIOD: u32 = 480;
/// Time between the starts of two reads in µs for a chip that stretches the I2C clock. This is slightly shorter than a sample
/// period, and results in the same drift as `POLL_PERIOD`.
const SLOW_POLL_PERIOD: u32 = 960;

/// Longest accepted time without a new sample, in µs.
const SILENCE: u32 = 20_000;
/// Number of successive equal samples that counts as an error.
const FROZEN: u32 = 50;
/// Pause before the next attempt to find the chip, in ms. The pause limits the CPU load while the sensor is absent.
const RETRY_DELAY: u32 = 30;

/// Receiver of samples.
pub trait Sink<E> {
    /// The chip was found and configured.
    fn on_start(&mut self, identity: Identity);
    /// Takes a sample and its time in µs. The chip's filter delays the time relative to the measured motion. Apart
    /// from this delay, the error of the time is at most 0.1 ms, or 0.3 ms for the first hundred samples after a start.
    fn on_sample(&mut self, time: u64, measurement: &Measurement);
    /// The chip was not found, or reading it failed. The stream then retries.
    fn on_error(&mut self, error: Error<E>);
}

/// Reads a chip endlessly.
///
/// Each sample is read once. After an error the stream searches for the chip every 30 ms. A chip that is still configured continues at
/// once. Any other chip is reset and configured; so is a chip that sent no samples, or only equal samples.
pub struct Stream<B, D, S> {
    chip: Mpu6050<B>,
    delay: D,
    sink: S,
}

impl<B: PeriodicI2c, D: DelayNs, S: Sink<B::Error>> Stream<B, D, S> {
    /// Makes a stream that reads the chip on `bus` and passes the samples to `sink`.
    pub const fn new(bus: B, delay: D, sink: S) -> Self {
        Self {
            chip: Mpu6050::new(bus),
            delay,
            sink,
        }
    }

    /// Finds, configures and reads the chip endlessly.
    pub async fn run(&mut self) -> ! {
        let mut reset = false;
        let mut period = POLL_PERIOD;
        loop {
            let Err(error) = self.start_and_read(reset, period).await;
            // A chip that responds without measuring may appear correctly configured, so the next start resets the chip.
            reset = matches!(error, Error::Silent | Error::Frozen);
            let is_late = matches!(&error, Error::Bus(error) if error.kind() == ErrorKind::Overrun);
            period = if is_late {
                SLOW_POLL_PERIOD
            } else {
                POLL_PERIOD
            };
            self.sink.on_error(error);
            self.delay.delay_ms(RETRY_DELAY).await;
        }
    }

    async fn start_and_read(
        &mut self,
        reset: bool,
        period: u32,
    ) -> Result<Infallible, Error<B::Error>> {
        let identity = self.chip.start(reset, &mut self.delay).await?;
        self.sink.on_start(identity);
        self.read_all(period).await
    }

    /// Reads the chip every `period` µs, until an error occurs.
    async fn read_all(&mut self, period: u32) -> Result<Infallible, Error<B::Error>> {
        self.chip.begin_polling(period)?;
        let mut pace = Pace::new(PERIOD);
        let mut last = Measurement::default();
        let (mut same, mut silent) = (0, 0);
        loop {
            let (time, measurement) = self.chip.poll().await?;
            let measured = pace.on_poll(time, measurement.is_some());
            let Some(measurement) = measurement else {
                silent += period;
                if silent > SILENCE {
                    return Err(Error::Silent);
                }
                continue;
            };
            silent = 0;
            same = if measurement == last { same + 1 } else { 0 };
            if same == FROZEN {
                return Err(Error::Frozen);
            }
            last = measurement;
            if let Some(time) = measured {
                self.sink.on_sample(time, &measurement);
            }
        }
    }
}
