//! Errors of a raymarched picture compared with the reference picture.

use super::{Face, Field, Hit};
use crate::camera::{Ray, Size, Vector, cross, dot, length};

/// Distance in pixels between the ray through a pixel's centre and each of the four neighbouring rays of `Expected::stable`.
const BESIDE: f64 = 0.05;

/// Largest relative difference in depth between the ray through a stable pixel's centre and its neighbouring rays.
const STEADY: f64 = 1e-3;

/// The reference result of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Expected {
    /// The hit of the ray through the pixel's centre.
    pub hit: Option<Hit>,
    /// Whether the pixel is stable: the rays 0.05 pixels to the left, to the right, above and below have the same result as the ray through
    /// the centre. The results are the same if all rays hit the same face of the same part of the field (`Hit::member`) at depths that
    /// differ by at most a thousandth, or if all rays miss. At an unstable pixel a correct picture may differ from the reference.
    pub stable: bool,
}

/// Computes the reference picture of a field, row by row, from hits at parameters from `t_min` to `t_max`.
///
/// `ray` returns the ray of a pixel and may be [`Camera::ray`](crate::camera::Camera::ray).
///
/// # Panics
/// As for [`Field::hit`].
pub fn expected(
    field: &Field,
    size: Size,
    (t_min, t_max): (f64, f64),
    ray: impl Fn([f64; 2]) -> Ray,
) -> Vec<Expected> {
    let at = |x: f64, y: f64| {
        let ray = ray([x, y]);
        field.hit(ray.origin, ray.direction, t_min, t_max)
    };
    let rows = 0..size.height;
    rows.flat_map(|row| (0..size.width).map(move |column| (f64::from(column), f64::from(row))))
        .map(|(x, y)| {
            let hit = at(x, y);
            let stable = [(-BESIDE, 0.0), (BESIDE, 0.0), (0.0, -BESIDE), (0.0, BESIDE)]
                .into_iter()
                .all(|(dx, dy)| alike(hit, at(x + dx, y + dy)));
            Expected { hit, stable }
        })
        .collect()
}

/// Whether a neighbouring ray has the same result as the ray through the pixel's centre: the same surface at nearly equal depth,
/// or also a miss.
fn alike(centre: Option<Hit>, beside: Option<Hit>) -> bool {
    match (centre, beside) {
        (None, None) => true,
        (Some(a), Some(b)) => {
            (a.face, a.member) == (b.face, b.member) && (a.t - b.t).abs() <= STEADY * a.t
        }
        _ => false,
    }
}

/// Result of a pixel in a compared picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RayOutcome {
    /// The ray hits a surface.
    Hit {
        /// Parameter of the ray at the hit.
        t: f64,
        /// The face that was hit.
        face: Face,
        /// Outward normal of any length; used only for round faces.
        normal: Vector,
    },
    /// The ray hits no surface.
    Miss,
    /// The ray reached the step limit before a hit or a miss.
    Undecided,
}

/// Quantiles of a list of values by nearest rank: at least p % of all values are at most the quantile of p %.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantiles {
    /// Quantile of 50 %.
    pub median: f64,
    /// Quantile of 99 %.
    pub p99: f64,
    /// Largest of the values.
    pub max: f64,
}

impl Quantiles {
    /// Computes the quantiles of a list of values; `None` for an empty list.
    fn new(mut values: Vec<f64>) -> Option<Self> {
        values.sort_by(f64::total_cmp);
        let max = *values.last()?;
        let rank = |percent: usize| values[(values.len() * percent).div_ceil(100) - 1];
        Some(Self {
            median: rank(50),
            p99: rank(99),
            max,
        })
    }
}

/// Errors of a picture compared with the reference, over all pixels, including unstable pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accuracy {
    /// Number of compared pixels. Each pixel has one ray.
    pub rays: usize,
    /// Fraction of unstable pixels.
    pub unstable: f64,
    /// Intersection over union of the hits: the number of pixels with a hit in both picture and reference, divided by the number
    /// of pixels with a hit in at least one of them. The value is 1 if there are no hits. Undecided pixels count as misses.
    pub iou: f64,
    /// Pixels where the reference hits and the picture misses.
    pub false_miss: usize,
    /// Pixels where the picture hits and the reference misses.
    pub false_hit: usize,
    /// Number of undecided pixels of the picture.
    pub undecided: usize,
    /// Absolute difference of the rays' parameters at the hit, over the pixels that hit in both picture and reference.
    pub depth: Option<Quantiles>,
    /// Fraction of pixels with different faces among the pixels that hit in both picture and reference; 0 without such pixels.
    pub wrong_faces: f64,
    /// Angle between the normals in degrees, over the pixels where picture and reference both hit a round face.
    pub normal: Option<Quantiles>,
}

/// Compares a picture with the reference pixel by pixel.
///
/// # Panics
/// When the two pictures differ in size.
pub fn accuracy(expected: &[Expected], found: &[RayOutcome]) -> Accuracy {
    assert_eq!(expected.len(), found.len(), "pixels of both");
    let (mut false_miss, mut false_hit, mut undecided) = (0, 0, 0);
    let (mut either, mut wrong) = (0, 0);
    let (mut depths, mut angles) = (Vec::new(), Vec::new());
    for (expected, found) in expected.iter().zip(found) {
        match (expected.hit, *found) {
            (Some(hit), RayOutcome::Hit { t, face, normal }) => {
                depths.push((t - hit.t).abs());
                wrong += usize::from(face != hit.face);
                if (face, hit.face) == (Face::Round, Face::Round) {
                    angles.push(degrees(normal, hit.normal));
                }
            }
            (Some(_), RayOutcome::Miss) => false_miss += 1,
            (None, RayOutcome::Hit { .. }) => false_hit += 1,
            (_, RayOutcome::Undecided) => undecided += 1,
            (None, RayOutcome::Miss) => {}
        }
        either += usize::from(expected.hit.is_some() || matches!(found, RayOutcome::Hit { .. }));
    }
    let part = |count: usize, of: usize| count as f64 / of.max(1) as f64;
    let both = depths.len();
    Accuracy {
        rays: expected.len(),
        unstable: part(
            expected.iter().filter(|e| !e.stable).count(),
            expected.len(),
        ),
        iou: if either == 0 { 1.0 } else { part(both, either) },
        false_miss,
        false_hit,
        undecided,
        depth: Quantiles::new(depths),
        wrong_faces: part(wrong, both),
        normal: Quantiles::new(angles),
    }
}

/// Returns the angle between two directions, in degrees.
fn degrees(a: Vector, b: Vector) -> f64 {
    // The arc tangent is also exact for small angles, unlike the arc cosine.
    length(cross(a, b)).atan2(dot(a, b)).to_degrees()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Camera;

    const TOP: Face = Face::Axis {
        axis: 2,
        positive: true,
    };
    const SIDE: Face = Face::Axis {
        axis: 0,
        positive: true,
    };

    fn shows(t: f64, face: Face, normal: Vector) -> Expected {
        Expected {
            hit: Some(Hit {
                t,
                normal,
                face,
                member: 0,
            }),
            stable: true,
        }
    }

    fn hit(t: f64, face: Face, normal: Vector) -> RayOutcome {
        RayOutcome::Hit { t, face, normal }
    }

    #[test]
    fn each_difference_is_counted_once() {
        let x = [1.0, 0.0, 0.0];
        let background = Expected {
            hit: None,
            stable: false,
        };
        let expected = [
            shows(1.0, TOP, x),
            shows(1.0, TOP, x),
            shows(2.0, Face::Round, x),
            shows(2.0, TOP, x),
            shows(2.0, TOP, x),
            background,
            background,
            background,
        ];
        let found = [
            hit(1.0, TOP, x),
            hit(1.25, SIDE, x),
            hit(1.5, Face::Round, [3.0, 3.0, 0.0]),
            RayOutcome::Miss,
            RayOutcome::Undecided,
            hit(9.0, TOP, x),
            RayOutcome::Miss,
            RayOutcome::Undecided,
        ];
        let accuracy = accuracy(&expected, &found);
        let normal = accuracy.normal.expect("a round pixel");
        assert!((normal.median - 45.0).abs() < 1e-12 && normal.median == normal.max);
        let depth = Quantiles {
            median: 0.25,
            p99: 0.5,
            max: 0.5,
        };
        let hand_made = Accuracy {
            rays: 8,
            unstable: 0.375,
            iou: 0.5,
            false_miss: 1,
            false_hit: 1,
            undecided: 2,
            depth: Some(depth),
            wrong_faces: 1.0 / 3.0,
            normal: Some(normal),
        };
        assert_eq!(accuracy, hand_made);
    }

    #[test]
    fn nothing_to_compare_is_no_error() {
        let accuracy = accuracy(&[], &[]);
        assert_eq!((accuracy.iou, accuracy.wrong_faces), (1.0, 0.0));
        assert_eq!((accuracy.depth, accuracy.normal), (None, None));
    }

    #[test]
    fn quantiles_are_by_nearest_rank() {
        let upto = |n: u32| Quantiles::new((1..=n).rev().map(f64::from).collect());
        let some = |median, p99, max| Some(Quantiles { median, p99, max });
        assert_eq!(upto(0), None);
        assert_eq!(upto(1), some(1.0, 1.0, 1.0));
        assert_eq!(upto(4), some(2.0, 4.0, 4.0));
        assert_eq!(upto(200), some(100.0, 198.0, 200.0));
    }

    #[test]
    fn pixels_are_unstable_along_edges_and_where_the_depth_changes_fast() {
        let size = Size {
            width: 101,
            height: 101,
        };
        let seen = |field: &Field, eye, target| {
            let camera = Camera::looking(eye, target, 0.5, 0.01);
            let ray = |pixel| camera.ray(pixel, size);
            expected(field, size, (camera.near, 100.0), ray)
        };
        // The cube's front face extends 33 2/3 pixels to each side of the picture's middle, so no ray is close to its border.
        let cube = Field::Box { half: [1.0; 3] };
        let front = seen(&cube, [0.0, -4.0, 0.0], [0.0; 3]);
        assert!(front.iter().all(|pixel| pixel.stable));
        let hits = front.iter().filter(|pixel| pixel.hit.is_some()).count();
        assert_eq!(hits, 67 * 67);
        // An edge of the cube runs down the middle column.
        let edge = seen(&cube, [4.0, -4.0, 0.0], [0.0; 3]);
        for pixel in edge.chunks(101).map(|row| row[50]) {
            assert_eq!(pixel.stable, pixel.hit.is_none());
        }
        let floor = Field::Planes { half: 1.0 };
        let grazed = seen(&floor, [0.0, 0.0, 0.95], [50.0, 0.0, 0.95]);
        let unstable = grazed.iter().filter(|pixel| !pixel.stable).count();
        assert!((1000..10_000).contains(&unstable), "{unstable}");
    }
}
