//! The camera that the page moves by dragging on the picture. The camera orbits the point that it
//! looks at.

use glint_core::camera::{MAX_EYE, Projection, View};
use glint_core::fixed::{Q32_32, U8_28};

/// Smallest distance of the eye from the point that it looks at, in world units.
const NEAREST: f64 = 0.3;
/// Largest distance of the eye from the origin, below the limit for meshes.
const FARTHEST: f64 = 7.9;
/// Smallest angle between the direction of view and the up axis, in radians.
const POLE: f64 = 0.05;
/// Allowed range of [`Drag::zoom`].
const ZOOM: std::ops::RangeInclusive<f64> = 0.01..=100.0;

/// A vector in world units.
type Vector = [f64; 3];

/// A motion of the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drag {
    /// Angles in radians by which the subject turns to the right and down on the screen.
    pub turn: [f64; 2],
    /// Factor by which the distance between the eye and the subject changes.
    pub zoom: f64,
}

impl Drag {
    /// No motion.
    pub const NONE: Self = Self {
        turn: [0.0; 2],
        zoom: 1.0,
    };

    /// Whether the numbers are in range.
    pub fn is_valid(&self) -> bool {
        self.turn.iter().all(|angle| angle.abs() <= 10.0) && ZOOM.contains(&self.zoom)
    }

    /// Combines this motion with the motion `next` after it.
    #[must_use]
    pub fn then(&self, next: &Self) -> Self {
        Self {
            turn: [0, 1].map(|i| self.turn[i] + next.turn[i]),
            zoom: (self.zoom * next.zoom).clamp(*ZOOM.start(), *ZOOM.end()),
        }
    }
}

fn dot(a: Vector, b: Vector) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

fn cross(a: Vector, b: Vector) -> Vector {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| a[i] * b[j] - a[j] * b[i])
}

/// The sum a·x + b·y.
fn combined(a: f64, x: Vector, b: f64, y: Vector) -> Vector {
    [0, 1, 2].map(|i| a * x[i] + b * y[i])
}

fn vector<T: Copy + Into<Q32_32>>(vector: [T; 3]) -> Vector {
    vector.map(|c| c.into().to_num())
}

/// The coordinate axis, with its sign, that is up on the screen: among the axes with the smallest
/// tilt to the left or right, the one that points up most.
pub fn up(view: &View) -> Vector {
    let [u, v] = [view.u(), view.v()].map(vector);
    let mut best = [0.0, 0.0, 1.0];
    let mut found = (f64::MAX, 0.0);
    for axis in 0..3 {
        let mut direction = [0.0; 3];
        direction[axis] = if v[axis] > 0.0 { -1.0 } else { 1.0 };
        let (tilt, rise) = ((u[axis].abs() * 1e3).round(), v[axis].abs());
        if tilt < found.0 || tilt == found.0 && rise > found.1 {
            (best, found) = (direction, (tilt, rise));
        }
    }
    best
}

/// The camera after a motion, with the direction `up` pointing up on the screen; `None` if no such
/// camera exists.
pub fn moved(view: &View, drag: &Drag, up: Vector) -> Option<View> {
    let [eye, forward] = [vector(view.eye()), vector(view.n())];
    // The pivot is the point on the line of sight that is nearest to the origin, if it is in front
    // of the eye.
    let distance = -dot(eye, forward);
    let distance = if distance > NEAREST { distance } else { 1.0 };
    let pivot = combined(1.0, eye, distance, forward);
    let back = forward.map(|c| -c);
    let rise = dot(back, up).clamp(-1.0, 1.0);
    let level = combined(1.0, back, -rise, up);
    let length = dot(level, level).sqrt();
    let level = if length > 1e-6 {
        level.map(|c| c / length)
    } else {
        vector(view.v()).map(|c| c * -rise.signum())
    };
    let [yaw, pitch] = drag.turn;
    let polar = (rise.acos() - pitch).clamp(POLE, std::f64::consts::PI - POLE);
    let (sin, cos) = yaw.sin_cos();
    let level = combined(cos, level, -sin, cross(up, level));
    let (sin, cos) = polar.sin_cos();
    let back = combined(sin, level, cos, up);
    let is_parallel = view.projection() == Projection::Orthographic;
    let zoomed = if is_parallel {
        distance
    } else {
        (distance * drag.zoom).max(NEAREST)
    };
    let at = |distance| combined(1.0, pivot, distance, back);
    let farthest = FARTHEST.max(dot(eye, eye).sqrt()).min(MAX_EYE.into());
    let mut eye = at(zoomed);
    if dot(eye, eye).sqrt() > farthest {
        eye = at(distance);
    }
    let fixed = |vector: Vector| vector.map(Q32_32::saturating_from_num);
    let view = View::towards(fixed(eye), fixed(back.map(|c| -c)), fixed(up))
        .ok()?
        .with_lens_of(view);
    if !is_parallel {
        return Some(view);
    }
    let factor = U8_28::saturating_from_num(1.0 / drag.zoom);
    Some(view.zoomed(factor).unwrap_or(view))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glint_core::fixed::Turns;

    fn spherical(r: &str, theta: &str, phi: &str) -> View {
        let [r, theta, phi] = [r, theta, phi].map(|text| text.parse::<Q32_32>().unwrap());
        View::spherical(r, Turns::from_degrees(theta), Turns::from_degrees(phi)).unwrap()
    }

    fn is_near(found: &View, expected: &View) -> bool {
        let pairs = [
            (vector(found.eye()), vector(expected.eye())),
            (vector(found.n()), vector(expected.n())),
        ];
        let pairs = pairs.iter().flat_map(|(a, b)| a.iter().zip(b));
        pairs.into_iter().all(|(a, b)| (a - b).abs() < 1e-5)
    }

    /// A drag to the right moves the camera to the left around the up axis, so that the subject
    /// turns to the right.
    #[test]
    fn a_drag_moves_the_camera_around_the_subject() {
        let view = spherical("3", "30", "60");
        let up = up(&view);
        assert_eq!(up, [0.0, 0.0, 1.0]);
        for (degrees, zoom, expected) in [
            ([0.0, 0.0], 1.0, spherical("3", "30", "60")),
            ([20.0, 0.0], 1.0, spherical("3", "10", "60")),
            ([0.0, 25.0], 1.0, spherical("3", "30", "35")),
            ([-300.0, -20.0], 1.5, spherical("4.5", "330", "80")),
        ] {
            let turn = degrees.map(f64::to_radians);
            let found = moved(&view, &Drag { turn, zoom }, up).unwrap();
            assert!(is_near(&found, &expected), "{degrees:?}: {found}");
            assert_eq!(found.half_width(), view.half_width());
        }
    }

    /// The camera stops before the poles, and keeps its distance at the limits of the distance.
    #[test]
    fn motion_has_limits() {
        let view = spherical("3", "30", "60");
        let far = |zoom| {
            let drag = Drag { zoom, ..Drag::NONE };
            let found = moved(&view, &drag, up(&view)).unwrap();
            let eye = vector(found.eye());
            dot(eye, eye).sqrt()
        };
        assert!((far(100.0) - 3.0).abs() < 1e-6);
        assert!((far(0.01) - NEAREST).abs() < 1e-6);
        for pitch in [9.0, -9.0] {
            let drag = Drag {
                turn: [0.3, pitch],
                zoom: 1.0,
            };
            let found = moved(&view, &drag, up(&view)).unwrap();
            assert_eq!(up(&found), [0.0, 0.0, 1.0]);
            assert!(vector(found.v())[2] < 0.0, "z is up");
        }
        let pole = spherical("3", "30", "0");
        assert!(moved(&pole, &Drag::NONE, [0.0, 0.0, 1.0]).is_some());
        assert!(
            !Drag {
                turn: [f64::NAN, 0.0],
                zoom: 1.0
            }
            .is_valid()
        );
        assert!(
            !Drag {
                turn: [0.0; 2],
                zoom: 0.0
            }
            .is_valid()
        );
        assert!(Drag::NONE.is_valid());
    }

    #[test]
    fn another_axis_may_be_up_and_lenses_zoom() {
        let zero = Q32_32::ZERO;
        let towards = |up| {
            View::towards(
                [zero, zero, "3".parse().unwrap()],
                [zero, zero, -Q32_32::ONE],
                up,
            )
        };
        let view = towards([zero, Q32_32::ONE, zero]).unwrap();
        assert_eq!(up(&view), [0.0, 1.0, 0.0]);
        let view = view.with_projection(Projection::Orthographic);
        let drag = Drag {
            zoom: 2.0,
            ..Drag::NONE
        };
        let found = moved(&view, &drag, up(&view)).unwrap();
        let [before, after]: [f64; 2] = [view, found].map(|view| view.half_width().to_num());
        assert!((after - 2.0 * before).abs() < 1e-6);
        assert!(is_near(&found, &view));
    }
}
