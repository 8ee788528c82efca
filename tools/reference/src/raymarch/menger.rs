//! Hits of rays on the Menger sponge, by traversal of its cells.
//!
//! A cell of the last level has an index along each axis, from 0 to 3^depth − 1. In base 3, each digit of the index is the
//! position (0, 1 or 2) of the enclosing cell of a level within the enclosing cell of the previous level. A cell with the digit 1
//! along two or three axes is a hole.

use super::solids::Slabs;
use super::surface::Hit;
use crate::camera::Ray;

/// Finds the first point of a ray inside the sponge with a parameter of at least `t_min`.
pub(super) fn hit(depth: u32, ray: &Ray, t_min: f64) -> Option<Hit> {
    let slabs = Slabs::new([1.0; 3], ray)?;
    if slabs.exit <= t_min {
        return None;
    }
    let count = 3i64.pow(depth);
    let number = |t: f64| {
        ray.at(t)
            .map(|c| ((c + 1.0) / 2.0 * count as f64).floor() as i64)
    };
    let mut t = slabs.enter.max(t_min);
    // Axis of the ray's entry face into the current cell; `None` if the ray starts in this cell.
    let mut entered = (slabs.enter >= t_min).then_some(slabs.axis);
    let mut cell = number(t).map(|i| i.clamp(0, count - 1));
    while let Some(side) = hole(cell, count) {
        // Along each axis, the index of a hole's first cell is a multiple of the hole's side.
        let first = cell.map(|i| i / side * side);
        let border = |axis: usize| {
            let d = ray.direction[axis];
            if d == 0.0 {
                return f64::INFINITY;
            }
            let end = first[axis] + if d > 0.0 { side } else { 0 };
            (2.0 * end as f64 / count as f64 - 1.0 - ray.origin[axis]) / d
        };
        let across = (0..3).fold(0, |next, axis| {
            if border(axis) < border(next) {
                axis
            } else {
                next
            }
        });
        t = t.max(border(across));
        entered = Some(across);
        let reached = number(t);
        for axis in 0..3 {
            let forward = ray.direction[axis] > 0.0;
            // Rounding must not move the cell against the ray's direction, or the traversal might not end.
            cell[axis] = match (axis == across, forward) {
                (true, true) => first[axis] + side,
                (true, false) => first[axis] - 1,
                (false, true) => reached[axis].clamp(cell[axis], first[axis] + side - 1),
                (false, false) => reached[axis].clamp(first[axis], cell[axis]),
            };
        }
        if !(0..count).contains(&cell[across]) {
            return None;
        }
    }
    Some(match entered {
        Some(axis) => Hit::entered(t, axis, ray.direction),
        None => Hit::inside(t),
    })
}

/// Returns the side of the largest hole that contains the cell, in cells of the last level; `None` if the cell is solid.
fn hole(cell: [i64; 3], count: i64) -> Option<i64> {
    let mut side = count;
    while side > 1 {
        side /= 3;
        if cell.iter().filter(|&&i| i / side % 3 == 1).count() >= 2 {
            return Some(side);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raymarch::surface::Face;

    #[test]
    fn the_cells_are_as_many_as_the_sponge_has() {
        for depth in 1..=4 {
            let count = 3i64.pow(depth);
            let range = || 0..count;
            let cells =
                range().flat_map(|x| range().flat_map(move |y| range().map(move |z| [x, y, z])));
            let full = cells.filter(|&cell| hole(cell, count).is_none()).count();
            assert_eq!(full, 20usize.pow(depth));
        }
    }

    #[test]
    fn a_ray_flies_through_the_tunnel_or_ends_at_a_wall() {
        let along = |direction| {
            let origin = [0.0, -2.0, 0.0];
            let found = hit(1, &Ray { origin, direction }, 0.0)?;
            Some((found.t, found.face))
        };
        let face = |axis| Face::Axis {
            axis,
            positive: false,
        };
        assert_eq!(along([0.0, 1.0, 0.0]), None);
        let near = |found: Option<(f64, Face)>, t: f64, axis| {
            let (at, hit) = found.expect("a wall");
            (at - t).abs() < 1e-12 && hit == face(axis)
        };
        // A steep ray, which hits the ceiling of its entry tunnel.
        assert!(near(along([0.0, 2.0, 0.5]), 2.0 / 3.0, 2));
        // A less steep ray, which crosses the middle of the sponge and hits the far wall of the tunnel along z.
        assert!(near(along([0.0, 2.0, 0.3]), 7.0 / 6.0, 1));
    }

    #[test]
    fn a_ray_that_starts_within_says_so() {
        let ray = Ray {
            origin: [0.99; 3],
            direction: [1.0, 0.0, 0.0],
        };
        assert_eq!(hit(3, &ray, 0.0), Some(Hit::inside(0.0)));
        assert_eq!(hit(3, &ray, 0.02), None);
    }
}
