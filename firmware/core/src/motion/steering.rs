//! Cameras steered by the attitude of a sensor: a camera that turns in place, and a camera that orbits the origin.
//!
//! The camera's basis is computed from the attitude's quaternion without angles, so it has no singularity: a small turn of the
//! sensor turns the picture by an equally small angle, even at the zenith and the nadir.

use core::fmt;

use crate::camera::{DEFAULT_HALF_WIDTH, DEFAULT_NEAR, RADIUS, View, ViewError};
use crate::choice::choices;
use crate::cordic::to_polar;
use crate::fixed::{Q2_23, Q2_30, Q32_32, Turns};
use crate::orientation::Quaternion;
use crate::trig::sin_cos_q30;

/// A direction along one of the sensor's axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Along +x of the sensor.
    X,
    /// Along −x of the sensor.
    MinusX,
    /// Along +y of the sensor.
    Y,
    /// Along −y of the sensor.
    MinusY,
    /// Along +z of the sensor.
    Z,
    /// Along −z of the sensor.
    MinusZ,
}

choices!(Direction {
    X: "x",
    MinusX: "-x",
    Y: "y",
    MinusY: "-y",
    Z: "z",
    MinusZ: "-z",
});

impl Direction {
    /// Number of the direction's axis: 0, 1, 2 for x, y, z.
    const fn axis(self) -> usize {
        match self {
            Self::X | Self::MinusX => 0,
            Self::Y | Self::MinusY => 1,
            Self::Z | Self::MinusZ => 2,
        }
    }

    /// Returns this direction in the world, with 30 fraction bits. `axes` are the directions of the sensor's
    /// axes x, y and z in the world.
    fn of(self, axes: &[[i32; 3]; 3]) -> [i32; 3] {
        let axis = axes[self.axis()];
        match self {
            Self::X | Self::Y | Self::Z => axis,
            // The negation cannot overflow: a component is at most 2^30 in magnitude plus a rounding error.
            Self::MinusX | Self::MinusY | Self::MinusZ => axis.map(|x| -x),
        }
    }
}

/// Mounting of the sensor: which of its directions points into the scene, and which points up on the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mounting {
    forward: Direction,
    up: Direction,
}

impl Default for Mounting {
    /// Forward is y and up is z. With this mounting and the identity as attitude the camera looks along +y, as with
    /// [`View::look`] and all angles 0.
    fn default() -> Self {
        Self {
            forward: Direction::Y,
            up: Direction::Z,
        }
    }
}

impl Mounting {
    /// Makes a mounting from two directions of the sensor: `forward` points into the scene, `up` points up on the screen. Returns `None`
    /// unless they are perpendicular.
    pub fn new(forward: Direction, up: Direction) -> Option<Self> {
        (forward.axis() != up.axis()).then_some(Self { forward, up })
    }
}

/// Writes the directions forward and up in the form that the console accepts.
impl fmt::Display for Mounting {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{} {}", self.forward, self.up)
    }
}

/// Returns the camera at `eye` that looks in the forward direction of the sensor.
///
/// The basis is orthonormal within 2^−21.
///
/// # Errors
/// The eye is more than 32 world units from the origin.
pub fn free_look(
    eye: [Q32_32; 3],
    attitude: Quaternion,
    mounting: Mounting,
) -> Result<View, ViewError> {
    let [u, v, n] = basis(attitude, mounting);
    View::new_checked(eye, u, v, n, DEFAULT_HALF_WIDTH, DEFAULT_NEAR)
}

/// Returns the camera that looks at the origin from the distance `r`, in the forward direction of the sensor: yaw and pitch of
/// the sensor move the eye about the origin, roll turns the picture.
///
/// # Errors
/// `r` is outside [2, 5] world units.
pub fn orbit(r: Q32_32, attitude: Quaternion, mounting: Mounting) -> Result<View, ViewError> {
    if !(RADIUS[0]..=RADIUS[1]).contains(&r) {
        return Err(ViewError::Radius(r));
    }
    let n = mounting.forward.of(&attitude.axes());
    // r ≤ 5 and |n| ≤ 1, so the result is below 6.
    let eye =
        n.map(|x| Q32_32::from_bits(((i128::from(r.to_bits()) * -i128::from(x)) >> 30) as i64));
    free_look(eye, attitude, mounting)
}

/// Computes the vectors u, v and n of the camera's basis.
fn basis(attitude: Quaternion, mounting: Mounting) -> [[Q2_23; 3]; 3] {
    let axes = attitude.axes();
    let n = mounting.forward.of(&axes);
    let up = mounting.up.of(&axes);
    let v = up.map(|x| -x);
    // The direction to the right is u = forward × up.
    let u = [0, 1, 2].map(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let wide = |a: i32, b: i32| i64::from(a) * i64::from(b);
        ((wide(n[j], up[k]) - wide(n[k], up[j]) + (1 << 29)) >> 30) as i32
    });
    [u, v, n].map(|row| row.map(|x| Q2_23::from_bits((x + (1 << 6)) >> 7)))
}

/// The sensitivity 1, in units of 1/256. With this value the camera turns as far as the sensor.
pub const NATURAL: u16 = 256;
/// Smallest and largest accepted sensitivity, in units of 1/256.
pub const SENSITIVITY: [u16; 2] = [32, 2_048];

/// Computes the camera's attitude from the sensor's attitude, the attitude chosen as centre, and the sensitivity.
///
/// With the sensitivity 1 the camera's attitude is a constant rotation times the sensor's attitude, with the same accuracy. Any
/// other sensitivity scales the angle of each turn and keeps its axis; the horizon may drift.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Steering {
    sensitivity: u16,
    /// The sensor's attitude at the last call.
    seen: Option<Quaternion>,
    camera: Quaternion,
    /// The rotation from the sensor's attitude to the camera's: the camera's attitude is this quaternion
    /// times the sensor's attitude.
    offset: Quaternion,
}

impl Default for Steering {
    fn default() -> Self {
        Self::new(NATURAL)
    }
}

impl Steering {
    /// Starts with a sensitivity in units of 1/256, which is limited to the range [`SENSITIVITY`].
    pub fn new(sensitivity: u16) -> Self {
        Self {
            sensitivity: sensitivity.clamp(SENSITIVITY[0], SENSITIVITY[1]),
            seen: None,
            camera: Quaternion::IDENTITY,
            offset: Quaternion::IDENTITY,
        }
    }

    /// The sensitivity, in units of 1/256.
    pub const fn sensitivity(&self) -> u16 {
        self.sensitivity
    }

    /// Changes the sensitivity, in units of 1/256; the camera keeps its attitude.
    pub fn set_sensitivity(&mut self, sensitivity: u16) {
        self.sensitivity = sensitivity.clamp(SENSITIVITY[0], SENSITIVITY[1]);
    }

    /// Takes the sensor's new attitude, and returns the camera's attitude.
    pub fn follow(&mut self, attitude: Quaternion) -> Quaternion {
        match self.seen.replace(attitude) {
            Some(seen) if self.sensitivity != NATURAL => {
                let turn = seen.inverse().times(attitude);
                self.camera = self.camera.times(scaled(turn, self.sensitivity));
                self.offset = self.camera.times(attitude.inverse());
            }
            _ => self.camera = self.offset.times(attitude),
        }
        self.camera
    }

    /// Turns the camera about the vertical axis to the heading 0, the heading of the identity. From then on the sensor's current
    /// attitude corresponds to this heading. The horizon does not change.
    pub fn recentre(&mut self) {
        let back = Quaternion::about_axis(2, -self.camera.heading());
        self.camera = back.times(self.camera);
        self.offset = back.times(self.offset);
    }

    /// Makes the sensor's current attitude the centre: the camera's attitude becomes the identity, so the horizon changes too.
    pub fn level(&mut self) {
        self.offset = self.seen.unwrap_or(Quaternion::IDENTITY).inverse();
        self.camera = Quaternion::IDENTITY;
    }
}

/// Scales the angle of the rotation `turn` by `sensitivity`/256 and keeps its axis. The angle before scaling is reduced to at
/// most 180°.
fn scaled(turn: Quaternion, sensitivity: u16) -> Quaternion {
    let [w, x, y, z] = turn
        .canonical()
        .parts()
        .map(|part| i64::from(part.to_bits()));
    // The sum of squares is at most 2^60.
    let sine = (x * x + y * y + z * z).isqrt();
    if sine == 0 {
        return Quaternion::IDENTITY;
    }
    let (_, half) = to_polar(w << 30, sine << 30);
    // The product is at most 8 times a quarter of a turn; the conversion to 32 bits drops whole turns.
    let half = Turns(((u64::from(half.0) * u64::from(sensitivity)) >> 8) as u32);
    let (sin, cos) = sin_cos_q30(half);
    let along = |x: i64| Q2_30::from_bits((i64::from(sin.to_bits()) * x / sine) as i32);
    Quaternion::new([cos, along(x), along(y), along(z)]).unwrap_or(Quaternion::IDENTITY)
}
