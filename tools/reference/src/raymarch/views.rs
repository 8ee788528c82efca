//! Cameras that look at the Menger sponge, shared by the measurements and the tests.

use crate::camera::{Camera, Vector};

/// Half the width of each picture, in world units in the plane at distance 1.
pub const HALF_WIDTH: f64 = 0.9;

/// Distance of the near plane from the eye for each picture, in world units.
pub const NEAR: f64 = 0.01;

/// Returns name, position of the eye and position of the target of each view. Positions are in world units, and +z is up.
///
/// Every coordinate is a multiple of 1/64, hence exact in every fixed-point format.
pub fn views() -> [(&'static str, Vector, Vector); 4] {
    [
        ("outside", [2.1875, 1.6875, 1.3125], [0.0; 3]),
        // The eye is a quarter of a unit in front of the face at y = −1 and looks obliquely at a corner of the largest hole.
        ("close", [0.5, -1.25, 0.4375], [0.375, -1.0, 0.3125]),
        // The eye is in the sponge's largest tunnel along y.
        (
            "tunnel",
            [0.0625, -0.8125, 0.09375],
            [-0.125, 0.9375, 0.03125],
        ),
        // The eye is a sixteenth of a unit above the face at z = 1 and looks down at it at an angle of less than two degrees.
        ("grazing", [-1.1875, -0.9375, 1.0625], [0.8125, 0.5625, 1.0]),
    ]
}

/// Returns the camera at `eye` that looks at `target`, with `HALF_WIDTH` and `NEAR`.
pub fn camera(eye: Vector, target: Vector) -> Camera {
    Camera::looking(eye, target, HALF_WIDTH, NEAR)
}

/// Returns rotations of a head that looks around for a second. Each rotation is yaw to the right, pitch downwards and roll, in
/// degrees. The first rotation is zero.
///
/// # Panics
/// When the file `look-around.csv` (time in milliseconds and the three angles) is damaged.
pub fn path() -> Vec<Vector> {
    let rows = include_str!("look-around.csv").lines().skip(1);
    rows.map(|row| {
        let numbers: Vec<f64> = row.split(',').flat_map(str::parse).collect();
        let [_, yaw, pitch, roll] = numbers[..] else {
            panic!("look-around.csv: expected a time and three angles, found {row}");
        };
        [yaw, pitch, roll]
    })
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{Size, dot};
    use crate::raymarch::Field;
    use glint_core::camera::View;
    use glint_core::fixed::{Q32_32, Turns};

    #[test]
    fn every_view_starts_in_the_open_and_shows_the_sponge() {
        let size = Size {
            width: 64,
            height: 36,
        };
        for (name, eye, target) in views() {
            let camera = camera(eye, target);
            for (axis, other) in [
                (camera.u, camera.v),
                (camera.v, camera.n),
                (camera.n, camera.u),
            ] {
                let right = (dot(axis, axis) - 1.0).abs() < 1e-12 && dot(axis, other).abs() < 1e-12;
                assert!(right, "{name}");
            }
            for depth in 1..=6 {
                let sponge = Field::Menger { depth };
                assert!(sponge.distance(eye) > NEAR, "{name} at depth {depth}");
                let shown = (0..size.width * size.height).filter(|i| {
                    let pixel = [i % size.width, i / size.width].map(f64::from);
                    let ray = camera.ray(pixel, size);
                    sponge.hit(ray.origin, ray.direction, NEAR, 100.0).is_some()
                });
                let shown = shown.count();
                assert!(shown > 500, "{name} at depth {depth}");
            }
        }
    }
    #[test]
    fn a_turned_camera_is_the_free_camera() {
        let ahead = Camera::looking([0.0; 3], [0.0, 1.0, 0.0], HALF_WIDTH, NEAR);
        let path = path();
        assert_eq!((path.len(), path[0]), (8, [0.0; 3]));
        for angles in path {
            let [yaw, pitch, roll] =
                angles.map(|angle| Turns::from_degrees(Q32_32::from_num(angle)));
            let free =
                View::look([Q32_32::ZERO; 3], yaw, pitch, roll).expect("an eye at the origin");
            let (free, turned) = (Camera::of(&free), ahead.turned(angles));
            for (found, wanted) in [(turned.u, free.u), (turned.v, free.v), (turned.n, free.n)] {
                for (a, b) in found.into_iter().zip(wanted) {
                    assert!((a - b).abs() < 1e-6, "{angles:?}: {found:?}, {wanted:?}");
                }
            }
        }
    }
}
