//! The task that shows the state of the board on LEDs and digits.

use core::time::Duration;

use glint_core::feature::IMU;
use glint_core::tasks::Turn;
use glint_hal::timer::{Clock, Deadline};
use glint_program::hardware::Devices;
use glint_program::sensor::{self, Imu};
use litex_pac::cpu;

use crate::demo::Demo;
use crate::panel;
use crate::picture::Picture;

/// Time between two updates of the blinking LED and of the digits.
const HEARTBEAT: Duration = Duration::from_millis(500);

/// Shows the state of the board on LEDs and digits.
pub struct Indicators {
    clock: Clock,
    /// Time of the next update.
    beat: Deadline,
    /// The current level of the blinking LED.
    blinks: bool,
}

impl Indicators {
    /// Creates indicators whose first update is due at once.
    pub fn new(clock: Clock) -> Self {
        Self {
            clock,
            beat: clock.after(Duration::ZERO),
            blinks: false,
        }
    }

    /// Shows the state of the board if an update is due. Sets the LEDs only with `heartbeat`.
    pub fn poll(
        &mut self,
        devices: &mut Option<Devices>,
        demo: &Demo,
        picture: &Picture,
        imu: &Imu,
        heartbeat: bool,
    ) -> Turn {
        if !self.beat.passed() {
            return Turn::Wait;
        }
        self.beat = self.clock.after(HEARTBEAT);
        self.blinks = !self.blinks;
        // Polls the future that reads the sensor, so that a transfer without an interrupt can time out.
        sensor::advance(cpu::cycles_low());
        let calibrated = imu.calibrated_eighths().filter(|_| IMU.is_built);
        if let Some(devices) = devices {
            if heartbeat {
                devices.leds.set(panel::leds(demo, self.blinks, calibrated));
            }
            if devices.tests_digits.is_none_or(|end| end.passed()) {
                let drawn = picture.drawn().and_then(Result::ok);
                let rate = drawn.map(|drawn| drawn.rate(self.clock.frequency()));
                devices
                    .digits
                    .show(panel::digits(demo, rate, self.blinks, calibrated.is_some()));
            }
        }
        Turn::Again
    }
}
