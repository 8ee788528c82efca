//! Settings of the gesture engine for gesture control, and set-up of the image sensor over the engine's I2C bus.

use embedded_hal::delay::DelayNs;
use glint_core::gesture::{EngineSetting, Region, Statistics, Window};
use glint_core::image_sensor::{Error, FrameSize, ImageSensor, Model};
use glint_hal::gesture::GestureEngine;
use glint_hal::timer::{Clock, Waiting, block_on};
use glint_i2c::{NoAcknowledge, TwoWires};

/// Reason why the image sensor cannot be set up.
pub type SetUpError = Error<NoAcknowledge>;

/// Time in ms from the end of a reset until every supported chip answers. The OV5640 takes the longest.
const RESET_TIME: u32 = 20;

type Sensor<'a> = ImageSensor<TwoWires<&'a mut GestureEngine, Waiting>>;

fn sensor(engine: &mut GestureEngine, clock: Clock) -> Sensor<'_> {
    ImageSensor::new(TwoWires::new(engine, Waiting(clock)))
}

/// Resets the image sensor, sets it up for a size, and starts the engine, which takes frames from the next VSYNC on. Takes about 50 ms, in
/// which the CPU serves only interrupts.
///
/// # Errors
/// The chip is absent or unknown, or does not accept its set-up; its power is then off.
pub fn start(
    engine: &mut GestureEngine,
    size: FrameSize,
    mut clock: Clock,
) -> Result<Model, SetUpError> {
    engine.set_power(false);
    // Longer than the minimum reset pulse of every supported chip.
    clock.delay_ms(1);
    engine.set_power(true);
    clock.delay_ms(RESET_TIME);
    let started = block_on(sensor(engine, clock).start(size, &mut Waiting(clock)));
    match started {
        Ok(model) => engine.receive(size.pixels(), model.is_vsync_low()),
        Err(_) => engine.set_power(false),
    }
    started
}

/// Whether the image sensor that [`start`] found still has the settings that `start` wrote. Takes about 5 ms, or less than 1 ms without a
/// sensor.
///
/// # Errors
/// The chip does not answer.
pub fn keeps(
    engine: &mut GestureEngine,
    model: Model,
    size: FrameSize,
    clock: Clock,
) -> Result<bool, SetUpError> {
    block_on(sensor(engine, clock).keeps(model, size))
}

/// Looks for an image sensor after the previous one has stopped answering. Takes about 2 ms, or less than 1 ms without a sensor.
///
/// # Errors
/// No known chip answers.
pub fn find(engine: &mut GestureEngine, clock: Clock) -> Result<Model, SetUpError> {
    engine.set_power(true);
    block_on(sensor(engine, clock).find())
}

/// Sets the windows of the channels Cr and Cb.
pub fn set_windows(engine: &mut GestureEngine, windows: [Window; 2]) {
    engine.set_windows(windows.map(|window| [window.lower, window.upper]));
}

/// Sets the region in which the engine counts pixels, and the minimum length of a counted run.
pub fn set_gate(engine: &mut GestureEngine, setting: &EngineSetting) {
    let Region { first, last } = setting.region;
    engine.set_gate([first, last], setting.least_run);
}

/// The statistics of the last whole frame; `None` if the engine replaced them during the read.
#[must_use]
pub fn statistics(engine: &GestureEngine) -> Option<Statistics> {
    let counts = engine.counts()?;
    let [first, last] = counts.corners;
    Some(Statistics {
        size: counts.size,
        count: counts.count,
        sums: counts.sums,
        bounds: Region { first, last },
        is_whole: true,
    })
}
