//! Samples for ever.

use core::convert::Infallible;

use embedded_hal_async::delay::DelayNs;
use embedded_hal_async::i2c::{Error as _, ErrorKind};

use super::pace::Pace;
use super::{Error, Identity, Measurement, Mpu6050, PERIOD};
use crate::i2c::PeriodicI2c;

/// The time between two looks for a sample, in µs: a little more than one takes, and a little less than half a period, so that each
/// sample is found and the looks move across the samples' times by 40 µs a sample.
const LOOK: u32 = 480;
/// The same for a chip that stretches the clock: a little less than a period, which moves by as much.
const LONG_LOOK: u32 = 960;

/// No sample for so long is a failure, in µs.
const SILENCE: u32 = 20_000;
/// So many samples that are all the same are one.
const FROZEN: u32 = 50;
/// Between two attempts, in ms: where there is no sensor, it is all that it costs.
const AGAIN: u32 = 30;

/// Where samples go.
pub trait Sink<E> {
    /// The chip was found, and is set up.
    fn on_start(&mut self, identity: Identity);
    /// A sample that was measured at a time in µs, later by the filter's delay; right within 0.1 ms, and the first hundred after a
    /// start within 0.3 ms.
    fn on_sample(&mut self, time: u64, measurement: &Measurement);
    /// Something went wrong. It is tried again, and told again.
    fn on_error(&mut self, error: Error<E>);
}

/// Reads a chip for ever.
///
/// Each sample is read once. After an error the chip is looked for every 30 ms; where it has kept its
/// configuration samples go on at once, and otherwise it is reset and set up again.
pub struct Stream<B, D, S> {
    chip: Mpu6050<B>,
    delay: D,
    sink: S,
}

impl<B: PeriodicI2c, D: DelayNs, S: Sink<B::Error>> Stream<B, D, S> {
    /// From a bus to a sink.
    pub const fn new(bus: B, delay: D, sink: S) -> Self {
        Self {
            chip: Mpu6050::new(bus),
            delay,
            sink,
        }
    }

    /// Runs for ever.
    pub async fn run(&mut self) -> ! {
        let mut reset = false;
        let mut look = LOOK;
        loop {
            let Err(error) = self.start_and_read(reset, look).await;
            // One that answers and does not measure may be configured all the same.
            reset = matches!(error, Error::Silent | Error::Frozen);
            let is_late = matches!(&error, Error::Bus(error) if error.kind() == ErrorKind::Overrun);
            look = if is_late { LONG_LOOK } else { LOOK };
            self.sink.on_error(error);
            self.delay.delay_ms(AGAIN).await;
        }
    }

    async fn start_and_read(
        &mut self,
        reset: bool,
        look: u32,
    ) -> Result<Infallible, Error<B::Error>> {
        let identity = self.chip.start(reset, &mut self.delay).await?;
        self.sink.on_start(identity);
        self.read_all(look).await
    }

    /// Looks for samples every `look` µs.
    async fn read_all(&mut self, look: u32) -> Result<Infallible, Error<B::Error>> {
        self.chip.begin_looks(look)?;
        let mut pace = Pace::new(PERIOD);
        let mut last = Measurement::default();
        let (mut same, mut silent) = (0, 0);
        loop {
            let (time, measurement) = self.chip.look().await?;
            let measured = pace.on_look(time, measurement.is_some());
            let Some(measurement) = measurement else {
                silent += look;
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
