//! Tests of the wireframe simulator: programs, keys, motion, projection, edges.

mod edges;
mod keys;
mod motion;
mod programs;
mod projection;

use glint_core::fixed::Q5_11;
use glint_core::wireframe::{Point, Viewing, Window};

/// The Q5.11 nearest to a number.
fn q(x: f64) -> Q5_11 {
    Q5_11::from_num(x)
}

fn point([x, y, z]: [f64; 3]) -> Point {
    [q(x), q(y), q(z)]
}

fn viewing(eye: [f64; 3], plane: f64, [xl, yl, xh, yh]: [f64; 4]) -> Viewing {
    Viewing {
        eye: point(eye),
        plane: q(plane),
        window: Window {
            low: [q(xl), q(yl)],
            high: [q(xh), q(yh)],
        },
    }
}
