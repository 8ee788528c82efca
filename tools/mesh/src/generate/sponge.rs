//! The Menger sponge as the faces between full and empty cells, with shared points.

use super::builder::Builder;
use crate::error::FormatError;
use crate::polygons::{Polygons, Rgb8, Vector};

/// The sponge of depth `level` in the cube of edge 1 about the origin, coloured by position.
pub fn sponge(level: u32) -> Result<Polygons, FormatError> {
    let mut builder = Builder::default();
    cells(&mut builder, [0; 3], level, 3_i64.pow(level))?;
    Ok(builder.coloured(|point| Rgb8::from_unit(point.map(|c| 0.66 + 0.6 * c))))
}

/// Adds the outer faces of the full cells in the cube at `corner` with 3^`level` cells along each
/// edge. The recursive order keeps neighbouring faces close to each other in the mesh, so that its
/// chunks share few points.
fn cells(
    builder: &mut Builder,
    corner: [i64; 3],
    level: u32,
    size: i64,
) -> Result<(), FormatError> {
    let Some(below) = level.checked_sub(1) else {
        return cell(builder, corner, size);
    };
    let step = 3_i64.pow(below);
    for part in 0..27 {
        let place = [part % 3, part / 3 % 3, part / 9];
        if !is_hole(place) {
            cells(
                builder,
                [0, 1, 2].map(|i| corner[i] + step * place[i]),
                below,
                size,
            )?;
        }
    }
    Ok(())
}

/// Whether the part at `place` (0 to 2 on each axis) of a cube cut into 27 is empty: the part in the centre, and the middle part
/// of each side.
fn is_hole(place: [i64; 3]) -> bool {
    place.iter().filter(|&&c| c == 1).count() >= 2
}

fn is_full(mut cell: [i64; 3], size: i64) -> bool {
    if cell.iter().any(|c| !(0..size).contains(c)) {
        return false;
    }
    while cell != [0; 3] {
        if is_hole(cell.map(|c| c % 3)) {
            return false;
        }
        cell = cell.map(|c| c / 3);
    }
    true
}

fn cell(builder: &mut Builder, cell: [i64; 3], size: i64) -> Result<(), FormatError> {
    for axis in 0..3 {
        for outward in [1, -1] {
            let mut beside = cell;
            beside[axis] += outward;
            if is_full(beside, size) {
                continue;
            }
            let square = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[a, b]| -> Vector {
                let mut point = cell;
                point[axis] += i64::from(outward == 1);
                point[(axis + 1) % 3] += if outward == 1 { a } else { 1 - a };
                point[(axis + 2) % 3] += b;
                point.map(|c| (2 * c - size) as f64 / (2 * size) as f64)
            });
            builder.face(&square, None)?;
        }
    }
    Ok(())
}
