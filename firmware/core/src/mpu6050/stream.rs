//! Samples for ever.

use core::convert::Infallible;

use embedded_hal_async::delay::DelayNs;
use embedded_hal_async::i2c::I2c;

use super::{Error, Identity, Measurement, Mpu6050, PERIOD};

/// Where it is there at once, a sample is looked for so much sooner the next time, in µs: it may have been there for a while. More
/// than a hundredth of a period, by which the chip's clock may be off.
const SOONER: u64 = 30;
/// And so much later where the first look has found none.
const LATER: u64 = 60;
/// No sample for so long is a failure, in µs.
const SILENCE: u64 = 20_000;
/// So many samples that are all the same are one.
const FROZEN: u32 = 50;
/// Between two attempts, in ms: where there is no sensor, it is all that it costs.
const AGAIN: u32 = 30;

/// A clock that can be waited for.
pub trait Time: DelayNs {
    /// The time in µs.
    fn now_us(&self) -> u64;
}

/// Where samples go.
pub trait Sink<E> {
    /// The chip was found, and is set up.
    fn on_start(&mut self, identity: Identity);
    /// A sample that was measured at a time in µs, later by the filter's delay; right within 0.15 ms, and the first dozen after a
    /// start within 0.2 ms.
    fn on_sample(&mut self, time: u64, measurement: &Measurement);
    /// Something went wrong. It is tried again, and told again.
    fn on_error(&mut self, error: Error<E>);
}

/// Reads a chip for ever.
///
/// Each sample is read once, at the pace of the chip's own clock. After an error the chip is looked for every 30 ms; where it has kept its
/// configuration samples go on at once, and otherwise it is reset and set up again.
pub struct Stream<B, T, S> {
    chip: Mpu6050<B>,
    time: T,
    sink: S,
}

impl<B: I2c, T: Time, S: Sink<B::Error>> Stream<B, T, S> {
    /// From a bus to a sink.
    pub const fn new(bus: B, time: T, sink: S) -> Self {
        Self {
            chip: Mpu6050::new(bus),
            time,
            sink,
        }
    }

    /// Runs for ever.
    pub async fn run(&mut self) -> ! {
        let mut reset = false;
        loop {
            let error = match self.chip.start(reset, &mut self.time).await {
                Ok(identity) => {
                    self.sink.on_start(identity);
                    let Err(error) = self.read_all().await;
                    // One that answers and does not measure may be configured all the same.
                    reset = !matches!(error, Error::Bus(_));
                    error
                }
                Err(error) => error,
            };
            self.sink.on_error(error);
            self.time.delay_ms(AGAIN).await;
        }
    }

    async fn read_all(&mut self) -> Result<Infallible, Error<B::Error>> {
        let mut last_time = self.meet().await?;
        let mut next = last_time + u64::from(PERIOD) + LATER;
        let mut last = Measurement::default();
        let mut same = 0;
        loop {
            let wait = next.saturating_sub(self.time.now_us());
            // At most a period and a bit.
            self.time.delay_us(wait as u32).await;
            let measurement;
            (last_time, measurement, next) = self.next(last_time).await?;
            same = if measurement == last { same + 1 } else { 0 };
            if same == FROZEN {
                return Err(Error::Frozen);
            }
            self.sink.on_sample(last_time, &measurement);
            last = measurement;
        }
    }

    /// Waits until a sample is measured: when that was. What was there before is old, or was measured before the ranges were set.
    async fn meet(&mut self) -> Result<u64, Error<B::Error>> {
        self.chip.is_ready().await?;
        let start = self.time.now_us();
        let mut before = start;
        while !self.chip.is_ready().await? {
            before = self.time.now_us();
            if before - start > SILENCE {
                return Err(Error::Silent);
            }
        }
        Ok(before)
    }

    /// Waits for a sample: when it was measured, which it is, and when to look for the next one.
    async fn next(&mut self, last_time: u64) -> Result<(u64, Measurement, u64), Error<B::Error>> {
        let mut before = None;
        loop {
            let now = self.time.now_us();
            if let Some(measurement) = self.chip.read().await? {
                // It came between two looks, and the pace has it come soon after the first.
                let (time, next) = match before {
                    None => (now, now + u64::from(PERIOD) - SOONER),
                    Some(before) => (before, before + u64::from(PERIOD) + LATER),
                };
                return Ok((time, measurement, next));
            }
            before = Some(now);
            if now.saturating_sub(last_time) > SILENCE {
                return Err(Error::Silent);
            }
        }
    }
}
