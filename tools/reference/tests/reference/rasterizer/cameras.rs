//! Random cameras.

use glint_reference::camera::{Camera, Vector, cross, normalised, subtract};
use rand::RngExt;
use rand_pcg::Pcg64;

/// Returns a camera at `eye` that looks at `target`, rolled by `roll` radians about its line of sight.
pub fn looking_at(eye: Vector, target: Vector, roll: f64, half_width: f64, near: f64) -> Camera {
    let n = normalised(subtract(target, eye));
    // An arbitrary direction that is not parallel to n.
    let aside = if n[2].abs() < 0.9 {
        [0.0, 0.0, 1.0]
    } else {
        [1.0, 0.0, 0.0]
    };
    let u0 = normalised(cross(n, aside));
    let v0 = cross(n, u0);
    let (sin, cos) = roll.sin_cos();
    let rolled = |a: f64, b: f64| [0, 1, 2].map(|i| a * u0[i] + b * v0[i]);
    Camera {
        eye,
        u: rolled(cos, sin),
        v: rolled(-sin, cos),
        n,
        half_width,
        near,
    }
}

/// Returns a random camera. It looks at a random point near the origin, from a random direction at this distance.
pub fn around(random: &mut Pcg64, distance: f64, half_width: f64, near: f64) -> Camera {
    let target = [(); 3].map(|()| random.random_range(-0.3..0.3));
    let direction = direction(random);
    let eye = [0, 1, 2].map(|i| target[i] + distance * direction[i]);
    looking_at(
        eye,
        target,
        random.random_range(0.0..std::f64::consts::TAU),
        half_width,
        near,
    )
}

/// Returns a random direction, uniformly distributed on the sphere.
pub fn direction(random: &mut Pcg64) -> Vector {
    let z: f64 = random.random_range(-1.0..1.0);
    let (sin, cos) = random.random_range(0.0..std::f64::consts::TAU).sin_cos();
    let across = (1.0 - z * z).sqrt();
    [across * cos, across * sin, z]
}

/// Returns a random number from `low` to `high` with a uniformly distributed logarithm.
pub fn log_range(random: &mut Pcg64, low: f64, high: f64) -> f64 {
    random
        .random_range(low.ln()..high.ln())
        .exp()
        .clamp(low, high)
}
