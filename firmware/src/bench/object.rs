//! Benchmark of the frame constants of an object, which the soft core computes for each object of each frame.

use core::cell::RefCell;

use glint_core::camera::View;
use glint_core::fixed::{Q8_24, Q32_32, Turns};
use glint_core::matrix::{Axis, Matrix};
use glint_core::picture::Size;
use glint_model::{MeshSetup, Placement};

use super::measure::{Report, measure};

/// Radius of the mesh, 14 fraction bits: 0.5.
const RADIUS: u32 = 1 << 13;

/// Measures the frame constants of rotated objects with uniform and with non-uniform scale.
pub fn object(report: Report) {
    let [width, height] = Size::W640.pixels();
    let view = View::spherical(Q32_32::lit("3"), Turns(1 << 29), Turns(1 << 29));
    let Ok(view) = view else { return };
    let Ok(camera) = MeshSetup::new(&view, width, height, 0) else {
        return;
    };
    let [half, quarter, one] = ["0.5", "0.25", "1.5"].map(|x| x.parse().unwrap_or(Q8_24::ONE));
    for (name, scale) in [
        ("object", [half; 3]),
        ("object_stretched", [half, quarter, one]),
    ] {
        let placements = [1_u32, 3, 5, 7].map(|eighths| {
            let turned = Matrix::scale(scale)
                .and_then(|matrix| matrix.then(&Matrix::rotation(Axis::Z, Turns(eighths << 28))))
                .and_then(|matrix| matrix.then(&Matrix::rotation(Axis::X, Turns(eighths << 27))))
                .and_then(|matrix| matrix.then(&Matrix::translation([half, quarter, one])?));
            Placement::new(turned.unwrap_or(Matrix::IDENTITY))
        });
        let own = RefCell::new(MeshSetup::default());
        measure(
            report,
            name,
            |phase| (phase >> 30) as usize,
            |number| {
                // The constants are computed in place, as when a frame is drawn.
                let mut own = own.borrow_mut();
                let placement: Option<&Placement> = placements.get(number);
                placement.map(|placement| placement.update(&mut own, &view, &camera, RADIUS))
            },
        );
    }
}
