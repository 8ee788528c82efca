//! Repair of faces with the wrong winding.

use crate::polygons::{Face, Polygons, Vector};
use crate::triangulate::{cross, dot, sub};
use std::collections::HashMap;

/// Reverses faces so that neighbours have consistent windings, and every closed part of the mesh
/// has a positive volume: its faces are counter-clockwise seen from outside. Points with equal
/// coordinates count as one point.
///
/// A part is a set of faces connected by edges that have exactly two faces. Adds remarks: the number of reversed faces, and
///
/// - open parts, whose outside is unknown: the winding of most of their faces is kept;
/// - one-sided parts, such as a Möbius strip: they are left unchanged;
/// - edges of more than two faces: neighbours at these edges are not compared.
pub fn repair(polygons: &mut Polygons) {
    let faces = welded(polygons);
    let edges = Edges::of(&faces);
    let mut turned = vec![None; faces.len()];
    let mut counts = Counts::default();
    for first in 0..faces.len() {
        if turned[first].is_some() {
            continue;
        }
        let part = edges.part(&faces, first, &mut turned);
        let turn_all = if !part.two_sided {
            counts.one_sided += 1;
            part.faces
                .iter()
                .for_each(|&face| turned[face] = Some(false));
            false
        } else if is_closed(&faces, &part.faces, &turned) {
            volume(polygons, &part.faces, &turned) < 0.0
        } else {
            counts.open += 1;
            let count = part
                .faces
                .iter()
                .filter(|&&face| turned[face] == Some(true))
                .count();
            2 * count > part.faces.len()
        };
        if turn_all {
            for &face in &part.faces {
                turned[face] = turned[face].map(|turned| !turned);
            }
        }
    }
    for (face, turned) in polygons.faces.iter().zip(&turned) {
        if *turned == Some(true) {
            // The first corner stays first, because a triangulation may depend on it.
            polygons.corners[face.first as usize..][1..face.count as usize].reverse();
            counts.turned += 1;
        }
    }
    counts.crowded = edges.0.values().filter(|users| users.len() > 2).count();
    counts.remark(polygons);
}

/// Whether faces form closed surfaces that face outwards.
pub fn are_solid(polygons: &Polygons, faces: &[usize]) -> bool {
    let turned = vec![Some(false); polygons.faces.len()];
    is_closed(&welded(polygons), faces, &turned) && volume(polygons, faces, &turned) > 0.0
}

/// Counts for the remarks.
#[derive(Default)]
struct Counts {
    turned: usize,
    open: usize,
    one_sided: usize,
    crowded: usize,
}

impl Counts {
    fn remark(&self, polygons: &mut Polygons) {
        let faces = polygons.faces.len();
        let mut remark = |text: String| polygons.remarks.push(format!("winding: {text}"));
        remark(format!("{} of {faces} faces reversed", self.turned));
        if self.open > 0 {
            remark(format!(
                "{} open parts: their outside is unknown, so the winding of most of their faces is kept",
                self.open
            ));
        }
        if self.one_sided > 0 {
            remark(format!(
                "{} one-sided parts (such as a Möbius strip): left unchanged",
                self.one_sided
            ));
        }
        if self.crowded > 0 {
            remark(format!(
                "{} edges of more than two faces: neighbours there are not compared",
                self.crowded
            ));
        }
    }
}

/// Returns the corners of all faces as numbers of distinct points, without consecutive duplicates.
fn welded(polygons: &Polygons) -> Vec<Vec<u32>> {
    let mut numbers = HashMap::new();
    let numbers: Vec<u32> = polygons
        .points
        .iter()
        .map(|point| {
            let next = numbers.len() as u32;
            // The addition turns −0 into +0.
            *numbers
                .entry(point.map(|c| (c + 0.0).to_bits()))
                .or_insert(next)
        })
        .collect();
    let face = |face: &Face| {
        let corners = polygons.corners_of(face).iter();
        let mut corners: Vec<u32> = corners
            .map(|corner| numbers[corner.point as usize])
            .collect();
        corners.dedup();
        while corners.len() > 1 && corners.first() == corners.last() {
            corners.pop();
        }
        corners
    };
    polygons.faces.iter().map(face).collect()
}

/// The directed edges of a face.
fn edges_of(corners: &[u32]) -> impl Iterator<Item = (u32, u32)> {
    let next = corners.iter().cycle().skip(1);
    // A face of one or two distinct points has no area and no edge.
    let count = if corners.len() < 3 { 0 } else { corners.len() };
    corners.iter().copied().zip(next.copied()).take(count)
}

/// For each edge, identified by its lower and its higher point number, the faces that use it, and
/// whether each face traverses it from the lower to the higher point.
struct Edges(HashMap<(u32, u32), Vec<(usize, bool)>>);

/// A set of faces connected by edges that have exactly two faces.
struct Patch {
    faces: Vec<usize>,
    /// Whether the faces can be reversed so that all neighbours have consistent windings.
    two_sided: bool,
}

impl Edges {
    fn of(faces: &[Vec<u32>]) -> Self {
        let mut edges: HashMap<_, Vec<_>> = HashMap::new();
        for (number, corners) in faces.iter().enumerate() {
            for (a, b) in edges_of(corners) {
                edges
                    .entry((a.min(b), a.max(b)))
                    .or_default()
                    .push((number, a < b));
            }
        }
        Self(edges)
    }

    /// Collects the faces of a part, starting with the face `first`, and determines whether each
    /// face must be reversed to be consistent with `first`.
    fn part(&self, faces: &[Vec<u32>], first: usize, turned: &mut [Option<bool>]) -> Patch {
        let mut part = Patch {
            faces: vec![first],
            two_sided: true,
        };
        turned[first] = Some(false);
        let mut next = 0;
        while let Some(&face) = part.faces.get(next) {
            next += 1;
            for (a, b) in edges_of(&faces[face]) {
                let Some(&[one, other]) = self.0.get(&(a.min(b), a.max(b))).map(Vec::as_slice)
                else {
                    continue;
                };
                // Consistent neighbours traverse their common edge in opposite directions.
                let disagree = one.1 == other.1;
                let neighbour = if one.0 == face { other.0 } else { one.0 };
                let wanted = turned[face].map(|turned| turned ^ disagree);
                match turned[neighbour] {
                    None => {
                        turned[neighbour] = wanted;
                        part.faces.push(neighbour);
                    }
                    found => part.two_sided &= found == wanted,
                }
            }
        }
        part
    }
}

/// Whether a part is closed: after the reversals, its faces traverse each edge equally often in
/// each direction.
fn is_closed(faces: &[Vec<u32>], part: &[usize], turned: &[Option<bool>]) -> bool {
    let mut balance: HashMap<(u32, u32), i32> = HashMap::new();
    for &face in part {
        for (a, b) in edges_of(&faces[face]) {
            let forward = (a < b) ^ (turned[face] == Some(true));
            *balance.entry((a.min(b), a.max(b))).or_default() += if forward { 1 } else { -1 };
        }
    }
    balance.values().all(|&balance| balance == 0)
}

/// Six times the volume of a closed part after the reversals; positive if its faces are counter-clockwise seen from outside.
fn volume(polygons: &Polygons, part: &[usize], turned: &[Option<bool>]) -> f64 {
    let fan = |face: &Face, origin: Vector| -> f64 {
        let corners = polygons.corners_of(face).iter();
        let points: Vec<Vector> = corners
            .map(|&corner| sub(polygons.point(corner), origin))
            .collect();
        let [first, rest @ ..] = points.as_slice() else {
            return 0.0;
        };
        rest.windows(2)
            .map(|pair| dot(*first, cross(pair[0], pair[1])))
            .sum()
    };
    // A point of the part is the origin, so that rounding errors stay small for a part far from the
    // file's origin.
    let first = part
        .first()
        .and_then(|&face| polygons.corners_of(&polygons.faces[face]).first());
    let origin = first.map_or([0.0; 3], |&corner| polygons.point(corner));
    part.iter()
        .map(|&face| {
            let volume = fan(&polygons.faces[face], origin);
            if turned[face] == Some(true) {
                -volume
            } else {
                volume
            }
        })
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Location;
    use crate::generate;
    use crate::polygons::Corner;

    /// Reverses about a third of the faces, in a fixed pseudo-random pattern.
    fn turn_some(polygons: &mut Polygons, seed: u32) -> usize {
        let mut count = 0;
        for (number, face) in (seed..).zip(&polygons.faces) {
            if number.wrapping_mul(0x9E37_79B9).wrapping_mul(number | 1) >> 16 & 0xff < 85 {
                polygons.corners[face.first as usize..][1..face.count as usize].reverse();
                count += 1;
            }
        }
        count
    }

    fn strip(points: &[Vector], faces: &[[u32; 3]]) -> Polygons {
        let mut polygons = Polygons::default();
        for &point in points {
            polygons.add_point(point, Location::Whole).unwrap();
        }
        for face in faces {
            polygons
                .add_face(&face.map(Corner::at), None, Location::Whole)
                .unwrap();
        }
        polygons
    }

    #[test]
    fn closed_meshes_are_restored() {
        for name in "cube icosphere:8 torus-knot gear teapot sponge:2 scan:8".split(' ') {
            let whole = generate::named(name).unwrap();
            for seed in [1, 1000, 77_777] {
                let mut polygons = whole.clone();
                let count = turn_some(&mut polygons, seed);
                repair(&mut polygons);
                assert!(polygons.corners == whole.corners, "{name}");
                let faces = whole.faces.len();
                let remark = format!("winding: {count} of {faces} faces reversed");
                assert_eq!(polygons.remarks[0], remark);
            }
            // All faces are reversed.
            let mut polygons = whole.clone();
            for face in &whole.faces {
                polygons.corners[face.first as usize..][1..face.count as usize].reverse();
            }
            repair(&mut polygons);
            assert!(polygons.corners == whole.corners, "{name}, inside out");
        }
    }

    #[test]
    fn triangles_without_shared_points_are_connected() {
        let whole = generate::named("icosphere:4").unwrap();
        let mut apart = Polygons::default();
        for face in &whole.faces {
            let points = whole
                .corners_of(face)
                .iter()
                .map(|&corner| whole.point(corner));
            let points = points.map(|point| apart.add_point(point, Location::Whole).unwrap());
            let corners: Vec<Corner> = points.map(Corner::at).collect();
            apart.add_face(&corners, None, Location::Whole).unwrap();
        }
        let expected = apart.corners.clone();
        turn_some(&mut apart, 5);
        repair(&mut apart);
        assert!(apart.corners == expected);
    }

    #[test]
    fn parts_are_repaired_apart() {
        // Two tetrahedra that share an edge, far from the origin; the faces of the second are reversed.
        let [near, x, far] = [1e6 - 1.0, 1e6, 1e6 + 1.0];
        let edge = [[x, 0.0, 0.0], [x, 0.0, 1.0]];
        let sides = [
            [far, 0.0, 0.0],
            [x, 1.0, 0.0],
            [near, 0.0, 0.0],
            [x, -1.0, 0.0],
        ];
        let first = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let second = [[0, 1, 4], [0, 5, 1], [0, 4, 5], [1, 5, 4]];
        let points = [&edge[..], &sides].concat();
        let mut polygons = strip(&points, &[first, second].concat());
        let before = polygons.corners.clone();
        repair(&mut polygons);
        assert_eq!(polygons.corners[..12], before[..12]);
        assert!(polygons.corners[12..].iter().ne(&before[12..]));
        assert_eq!(
            polygons.remarks,
            [
                "winding: 4 of 8 faces reversed",
                "winding: 1 edges of more than two faces: neighbours there are not compared"
            ]
        );
    }

    #[test]
    fn an_open_mesh_keeps_the_side_of_most_faces() {
        let places = [(0., 0.), (1., 0.), (1., 1.), (0., 1.), (2., 0.)];
        let points = places.map(|(x, y)| [x, y, 0.0]);
        let mut polygons = strip(&points, &[[0, 1, 2], [0, 3, 2], [1, 4, 2]]);
        repair(&mut polygons);
        let corners: Vec<u32> = polygons.corners.iter().map(|corner| corner.point).collect();
        assert_eq!(corners, [0, 1, 2, 0, 2, 3, 1, 4, 2]);
        let remark = &polygons.remarks[1];
        assert!(remark.starts_with("winding: 1 open parts"), "{remark}");
    }

    #[test]
    fn a_moebius_strip_is_left_as_it_is() {
        // The Möbius strip of five triangles with five points: each triangle shares an edge with the next, in a ring.
        let points = [
            [1., 0., 0.],
            [0.3, 1., 0.2],
            [-0.8, 0.6, 0.],
            [-0.8, -0.6, 0.3],
            [0.3, -1., 0.],
        ];
        let faces = [[0, 1, 2], [1, 2, 3], [2, 3, 4], [3, 4, 0], [4, 0, 1]];
        let mut polygons = strip(&points, &faces);
        let before = polygons.corners.clone();
        repair(&mut polygons);
        assert_eq!(polygons.corners, before);
        assert_eq!(
            polygons.remarks,
            [
                "winding: 0 of 5 faces reversed",
                "winding: 1 one-sided parts (such as a Möbius strip): left unchanged"
            ]
        );
    }
}
