//! Integration methods from angular rates to an attitude, in f64.

use super::quaternion::Quaternion;
use crate::camera::{Vector, cross};
use glint_core::orientation::{LONGEST_CURVE, MOST_STRETCH};

/// An integration method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Integrates the rates about the body's axes directly as yaw, pitch and roll.
    Angles,
    /// Replaces the attitude q by q + q·ω·dt/2, normalised, with the newest sample's rate ω.
    FirstOrder,
    /// Rotates by the newest sample's rate times dt, through the quaternion exponential.
    Newest,
    /// Rotates by the mean rate of the last two samples times dt, through the quaternion exponential.
    Trapezoid,
    /// As `Trapezoid`, with the coning term of a rate linear in time: the effect of a rotation axis that turns during the step.
    Coning,
    /// Integrates the parabola through the last three samples, with a coning term.
    Parabola,
    /// Integrates the cubic through the last four samples, with the firmware's coning term.
    Cubic,
    /// As `Cubic`, but with the exact coefficient of the coning term for the cubic. The firmware's coefficient differs from the exact one,
    /// which reduces the error.
    PlainCubic,
}

impl Method {
    /// All methods, cheapest first.
    pub const ALL: [Self; 8] = [
        Self::Angles,
        Self::FirstOrder,
        Self::Newest,
        Self::Trapezoid,
        Self::Coning,
        Self::Parabola,
        Self::PlainCubic,
        Self::Cubic,
    ];

    /// The method's name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Angles => "rates added to angles",
            Self::FirstOrder => "first order",
            Self::Newest => "newest sample",
            Self::Trapezoid => "trapezoid",
            Self::Coning => "trapezoid and coning",
            Self::Parabola => "parabola",
            Self::PlainCubic => "cubic, plain coning",
            Self::Cubic => "cubic",
        }
    }
}

/// Integrates rates to an attitude by one method.
#[derive(Clone, Debug)]
pub struct Integrator {
    method: Method,
    attitude: Quaternion,
    /// Yaw, pitch and roll, which [`Method::Angles`] integrates.
    angles: Vector,
    last: Vector,
    difference: Vector,
    second: Vector,
    ages: [f64; 2],
    steps: u32,
}

fn combine(a: Vector, b: Vector, factor: f64) -> Vector {
    [0, 1, 2].map(|i| a[i] + factor * b[i])
}

impl Integrator {
    /// Makes an integrator that starts at an attitude and at a rate in rad/s.
    pub fn new(method: Method, attitude: Quaternion, rate: Vector) -> Self {
        Self {
            method,
            attitude,
            angles: attitude.angles(),
            last: rate,
            difference: [0.0; 3],
            second: [0.0; 3],
            ages: [0.0; 2],
            steps: 0,
        }
    }

    /// Restarts the interpolation of the rate at `rate`, as if no earlier sample existed. The attitude does not change.
    pub fn restart(&mut self, rate: Vector) {
        self.last = rate;
        self.steps = 0;
    }

    /// The integration method.
    pub fn method(&self) -> Method {
        self.method
    }

    /// Sets the attitude from which the integration continues.
    pub fn set_attitude(&mut self, attitude: Quaternion) {
        self.attitude = attitude;
        self.angles = attitude.angles();
    }

    /// Returns the current attitude.
    pub fn attitude(&self) -> Quaternion {
        self.attitude
    }

    /// Rotates the attitude by the rotation during the last `step` seconds. `rate` is the rate at the end of the step, in rad/s.
    pub fn advance(&mut self, rate: Vector, step: f64) {
        self.advance_corrected(rate, step, [0.0; 3]);
    }

    /// As [`Self::advance`], with an additional small rotation. `correction` is half the small rotation's angle about each body
    /// axis, in radians. `Method::Angles` and `Method::FirstOrder` ignore the additional rotation.
    pub fn advance_corrected(&mut self, rate: Vector, step: f64, correction: Vector) {
        match self.method {
            Method::Angles => {
                let [roll, pitch, yaw] = rate.map(|x| x * step);
                self.angles = combine(self.angles, [yaw, pitch, roll], 1.0);
                self.attitude = Quaternion::of_angles(self.angles);
            }
            Method::FirstOrder => {
                let [x, y, z] = rate.map(|x| x * step / 2.0);
                self.attitude = self.attitude.times(Quaternion([1.0, x, y, z])).normalised();
            }
            _ => {
                let turn = self.turn(rate, step);
                let half = combine(correction, turn, 0.5);
                self.attitude = self.attitude.times(Quaternion::exp(half)).normalised();
            }
        }
        self.last = rate;
    }

    /// Computes the rotation vector of a step of `step` seconds with the rate `rate` at its end.
    fn turn(&mut self, rate: Vector, step: f64) -> Vector {
        // The firmware compares step lengths in whole microseconds. Here, steps that differ by less than a nanosecond count as equal.
        let within = |longest: f64| step <= longest + 1e-9;
        let curved = within(f64::from(LONGEST_CURVE) * 1e-6)
            && (self.steps == 0 || within(f64::from(MOST_STRETCH) * self.ages[0]));
        if !curved {
            self.steps = 0;
        }
        let e1 = combine(rate, self.last, -1.0);
        let [h1, h2] = self.ages;
        let (mut s, mut d) = ([0.0; 3], [0.0; 3]);
        let (mut near, mut far) = (0.0, 0.0);
        let degree = match self.method {
            Method::Parabola => 2,
            Method::Cubic | Method::PlainCubic => 3,
            _ => 1,
        };
        if degree >= 2 && self.steps >= 1 {
            let g = step / h1;
            let change = combine(e1, self.difference, -g);
            s = change.map(|x| x * step / (step + h1));
            if degree >= 3 && self.steps >= 2 {
                d = combine(s, self.second, -g * g);
                near = step / (step + h1 + h2);
                far = (step + 2.0 * h1) / (step + h1 + h2);
            }
        }
        let straight = combine(rate, self.last, 1.0).map(|x| x / 2.0);
        let curve = [0, 1, 2].map(|i| (2.0 * s[i] + d[i] * far) / 12.0);
        let mean = match self.method {
            Method::Newest => rate,
            _ => combine(straight, curve, -1.0),
        };
        let third = match self.method {
            Method::PlainCubic => -0.1,
            _ => 1.8,
        };
        let end = combine(e1, d, third * near);
        let mut turn = mean.map(|x| x * step);
        if curved && !matches!(self.method, Method::Newest | Method::Trapezoid) {
            turn = combine(turn, cross(mean, end), step * step / 12.0);
        }
        self.steps = if curved { (self.steps + 1).min(2) } else { 0 };
        self.difference = e1;
        self.second = s;
        self.ages = [step, h1];
        turn
    }
}
