//! Hits of rays on solids repeated along all three axes.

use super::surface::Hit;
use crate::camera::Ray;

/// Finds the first hit of a ray with copies of a solid. The copies' centres are the points whose coordinates are integer
/// multiples of the period.
///
/// `hit` returns the hit of a given ray with the copy about the origin. Each centre is the centre of a cubic cell. The function visits the
/// cells in the order in which the ray crosses them, up to the ray parameter `t_max` (Amanatides and Woo 1987). Every point of a copy must
/// be nearest to the copy's own centre.
pub(super) fn nearest(
    period: f64,
    ray: &Ray,
    t_min: f64,
    t_max: f64,
    hit: impl Fn(&Ray) -> Option<Hit>,
) -> Option<Hit> {
    let mut cell = ray.at(t_min).map(|c| (c / period).round());
    let mut enter = t_min;
    let mut best: Option<Hit> = None;
    while enter <= best.map_or(t_max, |best| best.t.min(t_max)) {
        let [x, y, z] = [0, 1, 2].map(|axis| ray.origin[axis] - cell[axis] * period);
        let local = Ray {
            origin: [x, y, z],
            direction: ray.direction,
        };
        best = Hit::nearer(best, hit(&local));
        // Each border is computed from the cell's index, because rounding errors would accumulate in a running sum.
        let border = |axis: usize| {
            let d = ray.direction[axis];
            if d == 0.0 {
                return f64::INFINITY;
            }
            ((cell[axis] + d.signum() / 2.0) * period - ray.origin[axis]) / d
        };
        let next = (0..3).fold(0, |next, axis| {
            if border(axis) < border(next) {
                axis
            } else {
                next
            }
        });
        enter = border(next);
        cell[next] += ray.direction[next].signum();
    }
    best
}
