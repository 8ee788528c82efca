//! Back faces of double-sided faces. The engine draws only one side of a triangle.

use super::winding;
use crate::error::{FormatError, Location};
use crate::polygons::{Corner, Polygons};
use std::collections::HashMap;

/// Numbers of the double-sided faces.
fn double_sided(polygons: &Polygons) -> Vec<usize> {
    let faces = polygons.faces.iter().enumerate();
    let faces = faces.filter(|(_, face)| face.double_sided);
    faces.map(|(number, _)| number).collect()
}

/// Whether the back of a double-sided face can be visible: true unless the double-sided faces
/// enclose solids.
pub fn are_needed(polygons: &Polygons) -> bool {
    let faces = double_sided(polygons);
    !faces.is_empty() && !winding::are_solid(polygons, &faces)
}

/// Adds a reversed copy of each double-sided face, with reversed normals, and a remark.
///
/// # Errors
/// The mesh has too many triangles or normals.
pub fn add(polygons: &mut Polygons) -> Result<(), FormatError> {
    let faces = double_sided(polygons);
    let mut reversed: HashMap<u32, u32> = HashMap::new();
    let mut corners: Vec<Corner> = Vec::new();
    for &number in &faces {
        let face = polygons.faces[number];
        corners.clear();
        corners.extend(polygons.corners_of(&face).iter().rev());
        for corner in &mut corners {
            if corner.normal == Corner::NO_NORMAL {
                continue;
            }
            corner.normal = match reversed.get(&corner.normal) {
                Some(&normal) => normal,
                None => {
                    let normal = polygons.normals[corner.normal as usize].map(|c| -c);
                    let number = polygons.add_normal(normal, Location::Whole)?;
                    reversed.insert(corner.normal, number);
                    number
                }
            };
        }
        polygons.add_face(&corners, face.colour, Location::Whole)?;
        if let Some(back) = polygons.faces.last_mut() {
            back.texture = face.texture;
        }
        polygons.faces[number].double_sided = false;
    }
    polygons.remark(format!(
        "{} double-sided faces get back faces, which the engine draws as additional faces",
        faces.len()
    ));
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::{Options, convert};
    use super::*;
    use crate::generate;

    /// Number of triangles of a cube with double-sided faces after `change`.
    fn triangles(change: impl Fn(&mut Polygons)) -> u32 {
        let mut cube = generate::named("cube").unwrap();
        change(&mut cube);
        for face in &mut cube.faces {
            face.double_sided = true;
        }
        let report = convert(&cube, Options::default()).unwrap().1;
        let mut remarks = report.remarks.iter();
        let is_remarked = remarks.any(|text| text.contains("back faces"));
        assert_eq!(is_remarked, report.triangles > 12);
        report.triangles
    }

    #[test]
    fn double_sided_faces_are_doubled_if_their_backs_are_visible() {
        assert_eq!(triangles(|_| ()), 12);
        // An open box, and an inside-out cube.
        assert_eq!(triangles(|cube| cube.faces.truncate(5)), 20);
        assert_eq!(triangles(|cube| cube.corners.reverse()), 24);
    }

    #[test]
    fn normals_are_reversed() {
        let mut polygons = Polygons::default();
        for point in [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]] {
            polygons.add_point(point, Location::Whole).unwrap();
        }
        let normal = polygons.add_normal([0.0, 0.0, 1.0], Location::Whole);
        assert_eq!(normal, Ok(0));
        let corners = [0, 1, 2].map(|point| Corner {
            normal: if point < 2 { 0 } else { Corner::NO_NORMAL },
            ..Corner::at(point)
        });
        polygons.add_face(&corners, None, Location::Whole).unwrap();
        polygons.faces[0].double_sided = true;
        assert!(are_needed(&polygons));
        add(&mut polygons).unwrap();
        assert!(!are_needed(&polygons));
        assert_eq!(polygons.normals, [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]);
        let back = polygons.corners_of(&polygons.faces[1]).iter();
        let back: Vec<_> = back.map(|corner| (corner.point, corner.normal)).collect();
        assert_eq!(back, [(2, Corner::NO_NORMAL), (1, 1), (0, 1)]);
    }
}
