//! The motion sensor that the page turns, and the hand that the page moves in front of the camera.

use crate::message::ToPage;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use virtual_image_sensor::{Hand, ImageSensor, Model, Scene, Timing};
use virtual_mpu6050::{Chip, Imperfections, Source, State, Wires};

/// Time constant in s with which the sensor follows the page's attitude.
const FOLLOW: f64 = 0.03;
/// Maximum rotation rate of the sensor in °/s, below its range of 2000 °/s.
const MAX_RATE: f64 = 1500.0;
/// Width and height of a frame of the camera in pixels.
const CAMERA: [usize; 2] = [320, 240];
/// Timing of the camera: 59.9 frames of this size per second, the rate of the monitor.
const CAMERA_TIMING: Timing = Timing {
    clock: 15_000_000,
    ..Timing::OV7670
};
/// Noise of the sensor; the firmware refuses to calibrate a sensor without noise.
const NOISE: Imperfections = Imperfections {
    noise: 0.005,
    accel_noise: 0.0004,
    ..Imperfections::NONE
};

/// A quaternion w, x, y, z.
type Quaternion = [f64; 4];

/// The attitude and the hand position that the page has set.
#[derive(Debug)]
pub struct Motion(Mutex<Wanted>);

#[derive(Clone, Copy, Debug)]
struct Wanted {
    /// Attitude from body to world.
    attitude: Quaternion,
    /// Centre of the hand, as fractions of the width and the height of the camera's frame.
    hand: Option<[f64; 2]>,
}

impl Default for Motion {
    fn default() -> Self {
        Self(Mutex::new(Wanted {
            attitude: [1.0, 0.0, 0.0, 0.0],
            hand: None,
        }))
    }
}

impl Motion {
    fn lock(&self) -> MutexGuard<'_, Wanted> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Sets the attitude of the sensor, a quaternion with a length from 0.001 to 1000. Returns
    /// false if the quaternion is invalid.
    pub fn turn(&self, attitude: Quaternion) -> bool {
        let length = attitude.iter().map(|c| c * c).sum::<f64>().sqrt();
        let is_attitude = (1e-3..1e3).contains(&length);
        if is_attitude {
            self.lock().attitude = attitude.map(|c| c / length);
        }
        is_attitude
    }

    /// Moves the hand, or removes it with `None`. Returns false if the position is outside of the
    /// frame.
    pub fn move_hand(&self, place: Option<[f64; 2]>) -> bool {
        let is_inside = place.is_none_or(|place| place.iter().all(|c| (0.0..=1.0).contains(c)));
        if is_inside {
            self.lock().hand = place;
        }
        is_inside
    }

    /// The last attitude and hand position that a page has set.
    pub fn message(&self) -> ToPage {
        let Wanted { attitude, hand } = *self.lock();
        ToPage::Motion { attitude, hand }
    }

    /// A motion sensor that the page turns.
    pub fn sensor(self: &Arc<Self>) -> Wires {
        let motion = Arc::clone(self);
        let turning = Mutex::new(Turning {
            time: 0.0,
            attitude: [1.0, 0.0, 0.0, 0.0],
        });
        let state = move |time| {
            let wanted = motion.lock().attitude;
            let mut turning = turning.lock().unwrap_or_else(PoisonError::into_inner);
            turning.follow(time, wanted)
        };
        Wires::new(Chip::new(Source::Motion(Box::new(state)), NOISE, 1))
    }

    /// The image sensor in front of which the page moves a hand.
    pub fn camera(self: &Arc<Self>) -> ImageSensor {
        let motion = Arc::clone(self);
        let [width, height] = CAMERA.map(|length| length as f64);
        let mut scene = Scene::new(CAMERA, move |_| {
            let hand = motion.lock().hand;
            let place = hand.map(|[x, y]| Hand {
                centre: [x * width, y * height],
                area: width * height / 16.0,
            });
            place.into_iter().collect()
        });
        scene.noise = 2.0;
        ImageSensor::new(Model::Ov7670, scene, CAMERA_TIMING)
    }
}

/// The simulated body that carries the sensor.
struct Turning {
    time: f64,
    attitude: Quaternion,
}

impl Turning {
    /// Turns the body towards `wanted` up to the time `time` in s, and returns its motion at this
    /// time.
    fn follow(&mut self, time: f64, wanted: Quaternion) -> State {
        let step = (time - self.time).max(1e-6);
        self.time = time;
        let [w, x, y, z] = product(conjugate(self.attitude), wanted);
        let sine = (x * x + y * y + z * z).sqrt();
        // The absolute value selects the shorter of the two rotations.
        let angle = 2.0 * sine.atan2(w.abs());
        let part = 1.0 - (-step / FOLLOW).exp();
        let turned = (angle * part).min(MAX_RATE.to_radians() * step);
        let sign = if w < 0.0 { -1.0 } else { 1.0 };
        let axis = [x, y, z].map(|c| sign * c / sine.max(1e-12));
        let (sin, cos) = (turned / 2.0).sin_cos();
        let turn = [cos, axis[0] * sin, axis[1] * sin, axis[2] * sin];
        self.attitude = product(self.attitude, turn);
        let length = self.attitude.iter().map(|c| c * c).sum::<f64>().sqrt();
        self.attitude = self.attitude.map(|c| c / length);
        let [w, x, y, z] = self.attitude;
        State {
            rate: axis.map(|c| c * (turned / step).to_degrees()),
            force: [
                2.0 * (x * z - w * y),
                2.0 * (y * z + w * x),
                1.0 - 2.0 * (x * x + y * y),
            ],
            ..State::default()
        }
    }
}

fn conjugate([w, x, y, z]: Quaternion) -> Quaternion {
    [w, -x, -y, -z]
}

fn product([aw, ax, ay, az]: Quaternion, [bw, bx, by, bz]: Quaternion) -> Quaternion {
    [
        aw * bw - ax * bx - ay * by - az * bz,
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_body_reaches_the_attitude_and_its_rates_add_up() {
        let motion = Motion::default();
        assert!(!motion.turn([0.0; 4]) && !motion.turn([f64::NAN, 0.0, 0.0, 0.0]));
        assert!(!motion.move_hand(Some([0.5, 1.1])) && motion.move_hand(None));
        // A rotation of 90° about x: the body's y axis points up.
        assert!(motion.turn([2.0, 2.0, 0.0, 0.0]));
        let wanted = motion.lock().attitude;
        let mut turning = Turning {
            time: 0.0,
            attitude: [1.0, 0.0, 0.0, 0.0],
        };
        let mut angle = 0.0;
        let mut last = State::default();
        for step in 1..=1000 {
            last = turning.follow(f64::from(step) / 1000.0, wanted);
            assert!(last.rate[0] <= MAX_RATE + 1e-6);
            angle += last.rate[0] / 1000.0;
        }
        assert!((angle - 90.0).abs() < 1e-6, "{angle}");
        assert!((last.force[1] - 1.0).abs() < 1e-6, "{:?}", last.force);
    }
}
