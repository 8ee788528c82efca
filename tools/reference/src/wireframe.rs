//! Drift of the wireframe simulator's motions, measured against f64.

use glint_core::fixed::Q5_11;
use glint_core::wireframe::{
    Key, Motion, PAN, Point, ROTATION_COSINE, ROTATION_SINE, Segment, Step, accumulate,
};

use crate::camera::Vector;

/// An implementation of motions of end points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Each frame applies the whole motion to the points of the program: [`Motion`].
    DriftFree,
    /// Each step moves the end points in Q5.11, rounded to nearest: [`accumulate`].
    Nearest,
    /// Like `Nearest`, but each product is rounded down, as a shifter does.
    Truncated,
}

impl Form {
    /// All forms.
    pub const ALL: [Self; 3] = [Self::DriftFree, Self::Nearest, Self::Truncated];

    /// Name in the report.
    pub const fn name(self) -> &'static str {
        match self {
            Self::DriftFree => "drift-free",
            Self::Nearest => "in place, nearest",
            Self::Truncated => "in place, truncated",
        }
    }
}

/// A sequence of steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Session {
    /// Rotations about one axis in one direction.
    Turning,
    /// Alternating rotations up and down.
    Rocking,
    /// Rotations in all four directions, by a fixed random sequence.
    Wandering,
}

impl Session {
    /// All sessions.
    pub const ALL: [Self; 3] = [Self::Turning, Self::Rocking, Self::Wandering];

    /// Name in the report.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Turning => "turning: right, right, …",
            Self::Rocking => "rocking: up, down, up, …",
            Self::Wandering => "wandering: random arrows",
        }
    }

    /// The session's infinite sequence of steps.
    pub fn steps(self) -> impl Iterator<Item = Step> {
        let mut state = 1_u32;
        (0_u32..).map(move |number| {
            let key = match self {
                Self::Turning => Key::Right,
                Self::Rocking if number.is_multiple_of(2) => Key::Up,
                Self::Rocking => Key::Down,
                Self::Wandering => {
                    // A linear congruential generator (Knuth and Lewis); its upper bits select the key.
                    state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                    [Key::Up, Key::Down, Key::Left, Key::Right][(state >> 30) as usize]
                }
            };
            key.step(true)
        })
    }
}

/// Errors of the end points after some steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drift {
    /// Number of steps.
    pub steps: u32,
    /// Largest distance of an end point from its exact position.
    pub distance: f64,
    /// Relative growth of the end points' mean distance from the origin.
    pub growth: f64,
}

/// Moves the corners of a cube of side 4 about the origin by a session's steps, and returns the errors after each number of steps
/// in the ascending list `after`.
///
/// The exact position is rotated in f64 at each step, by the angle of the simulator's cosine and sine. A step that is not possible in Q5.11
/// is skipped, which counts as an error.
pub fn drift(form: Form, session: Session, after: &[u32]) -> Vec<Drift> {
    let corner = |i: usize| [0, 1, 2].map(|axis| if i >> axis & 1 == 0 { -2.0 } else { 2.0 });
    let start: Vec<Vector> = (0..8).map(corner).collect();
    let program: Vec<Segment> = start
        .chunks_exact(2)
        .map(|ends| [0, 1].map(|end| ends[end].map(Q5_11::from_num)))
        .collect();
    let mut motion = Motion::default();
    let (mut moved, mut exact) = (program.clone(), start.clone());
    let mut steps = session.steps();
    let mut done = 0;
    let mut drifts = Vec::new();
    for &target in after {
        for step in steps.by_ref().take((target - done) as usize) {
            exact.iter_mut().for_each(|point| rotate(point, step));
            match form {
                Form::DriftFree => motion.apply(step),
                Form::Nearest => accumulate::apply(&mut moved, step),
                Form::Truncated => truncated(&mut moved, step),
            };
        }
        done = target;
        let pose = motion.pose();
        let found: Vec<Vector> = moved
            .iter()
            .flat_map(|&segment| match form {
                Form::DriftFree => pose.segment(segment),
                _ => accumulate::segment(segment),
            })
            .map(|point| point.map(f64::from))
            .collect();
        let length = |point: &Vector| point.iter().map(|x| x * x).sum::<f64>().sqrt();
        let errors = found.iter().zip(&exact).map(|(found, exact)| {
            length(&[
                found[0] - exact[0],
                found[1] - exact[1],
                found[2] - exact[2],
            ])
        });
        drifts.push(Drift {
            steps: target,
            distance: errors.fold(0.0, f64::max),
            growth: found.iter().map(length).sum::<f64>() / start.iter().map(length).sum::<f64>()
                - 1.0,
        });
    }
    drifts
}

/// Moves a point in f64.
fn rotate([x, y, z]: &mut Vector, step: Step) {
    let angle = f64::from(ROTATION_SINE).atan2(f64::from(ROTATION_COSINE));
    let (sine, cosine) = angle.sin_cos();
    let turn = |i: &mut f64, j: &mut f64, forwards| {
        let sine = if forwards { sine } else { -sine };
        (*i, *j) = (*i * cosine - *j * sine, *i * sine + *j * cosine);
    };
    match step {
        Step::Pan(steps) => {
            for (x, steps) in [x, y, z].into_iter().zip(steps) {
                *x += f64::from(steps) * f64::from(PAN);
            }
        }
        Step::AboutX { forwards } => turn(y, z, forwards),
        Step::AboutY { forwards } => turn(z, x, forwards),
    }
}

/// Rotates all end points in Q5.11, each product rounded down. Returns `false` if the range does not allow the rotation.
fn truncated(segments: &mut [Segment], step: Step) -> bool {
    let turn = |i: Q5_11, j: Q5_11, forwards| {
        let product = |x: Q5_11, y: Q5_11| (i32::from(x.to_bits()) * i32::from(y.to_bits())) >> 11;
        let sine = if forwards {
            ROTATION_SINE
        } else {
            -ROTATION_SINE
        };
        let sums = [
            product(i, ROTATION_COSINE) - product(j, sine),
            product(i, sine) + product(j, ROTATION_COSINE),
        ];
        let [i, j] = sums.map(|sum| i16::try_from(sum).ok().map(Q5_11::from_bits));
        Some((i?, j?))
    };
    let moved = |[x, y, z]: Point| match step {
        Step::Pan(_) => Some([x, y, z]),
        Step::AboutX { forwards } => turn(y, z, forwards).map(|(y, z)| [x, y, z]),
        Step::AboutY { forwards } => turn(z, x, forwards).map(|(z, x)| [x, y, z]),
    };
    let points = segments.as_flattened_mut();
    let possible = points.iter().all(|&point| moved(point).is_some());
    if possible {
        for point in points {
            *point = moved(*point).unwrap_or(*point);
        }
    }
    possible
}
