//! Generated models: closed surfaces, counter-clockwise seen from outside, z up. Hall, fence and window are open.

mod builder;
mod cube;
mod gear;
mod globe;
mod hall;
mod icosphere;
mod scan;
mod sponge;
mod teapot;
mod torus_knot;

use crate::error::FormatError;
use crate::polygons::Polygons;

/// Names of the generators, for messages and help.
pub const NAMES: &str = "cube, icosphere:N (frequency, 1 to 64), torus-knot, gear, teapot, globe, hall, fence, window (these four with textures), \
    scan:N (frequency, 1 to 64) or sponge:N (0 to 4)";

/// Whether a name is the name of a generator, not of a file.
pub fn is_name(name: &str) -> bool {
    let stem = name.split(':').next().unwrap_or_default();
    matches!(
        stem,
        "cube"
            | "icosphere"
            | "torus-knot"
            | "gear"
            | "teapot"
            | "globe"
            | "hall"
            | "fence"
            | "window"
            | "sponge"
            | "scan"
    )
}

/// Generates the model with a name such as `icosphere:4`.
///
/// # Errors
/// No generator has this name, or its number is missing or out of range.
pub fn named(name: &str) -> Result<Polygons, FormatError> {
    let refuse = || {
        FormatError::whole(
            format!("a model {NAMES}"),
            crate::error::quote(name.as_bytes()),
        )
    };
    let (stem, number) = match name.split_once(':') {
        Some((stem, number)) => (stem, Some(number.parse::<u32>().map_err(|_| refuse())?)),
        None => (name, None),
    };
    let mut polygons = match (stem, number) {
        ("cube", None) => cube::cube(),
        ("icosphere", Some(frequency @ 1..=64)) => icosphere::icosphere(frequency),
        ("torus-knot", None) => torus_knot::torus_knot(),
        ("gear", None) => gear::gear(),
        ("teapot", None) => teapot::teapot(),
        ("globe", None) => globe::globe(),
        ("hall", None) => hall::hall(),
        ("fence", None) => hall::fence(),
        ("window", None) => hall::window(),
        ("sponge", Some(level @ 0..=4)) => sponge::sponge(level),
        ("scan", Some(frequency @ 1..=64)) => scan::scan(frequency),
        _ => Err(refuse()),
    }?;
    let smooth = ["icosphere", "torus-knot", "teapot", "globe", "scan"];
    polygons.is_smooth = Some(smooth.contains(&stem));
    Ok(polygons)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::convert::{self, Options};
    use crate::formats::glm;
    use crate::polygons::Vector;
    use crate::triangulate::{self, cross, dot};
    use std::collections::HashMap;

    pub const ALL: [&str; 10] = [
        "cube",
        "icosphere:1",
        "icosphere:8",
        "torus-knot",
        "gear",
        "teapot",
        "globe",
        "sponge:0",
        "sponge:2",
        "scan:8",
    ];

    /// The enclosed volume, positive for faces that are counter-clockwise seen from outside.
    pub fn volume(polygons: &Polygons) -> f64 {
        let mut scratch = triangulate::Scratch::default();
        let mut sum = 0.0;
        for face in &polygons.faces {
            for triangle in triangulate::face(polygons, face, &mut scratch) {
                let [a, b, c]: [Vector; 3] = triangle.map(|corner| polygons.point(corner));
                sum += dot(a, cross(b, c)) / 6.0;
            }
        }
        sum
    }

    /// Checks that a mesh is closed: every edge occurs equally often in both directions.
    fn assert_closed(name: &str, edges: impl Iterator<Item = (u32, u32)>) {
        let mut balance: HashMap<(u32, u32), i32> = HashMap::new();
        for (a, b) in edges {
            assert_ne!(a, b, "{name}: an edge without length");
            *balance.entry((a.min(b), a.max(b))).or_default() += if a < b { 1 } else { -1 };
        }
        let open = balance.values().filter(|&&n| n != 0).count();
        assert_eq!(
            open,
            0,
            "{name}: {open} of {} edges are open",
            balance.len()
        );
    }

    #[test]
    fn all_are_closed_and_run_counter_clockwise() {
        for name in ALL {
            let mut polygons = named(name).unwrap();
            polygons.finish().unwrap();
            assert!(volume(&polygons) > 0.0, "{name}");
            let corners = |face| polygons.corners_of(face).iter().map(|corner| corner.point);
            let edges = polygons
                .faces
                .iter()
                .flat_map(|face| corners(face).zip(corners(face).cycle().skip(1)));
            assert_closed(name, edges);
        }
    }

    #[test]
    fn all_convert_without_loss_and_stay_closed() {
        for name in ALL {
            let polygons = named(name).unwrap();
            let (bytes, report) = convert::convert(&polygons, Options::default()).unwrap();
            assert_eq!(report.degenerate, 0, "{name}");
            assert!(report.error_max_lsb <= 0.75f64.sqrt() + 1e-9, "{name}");
            let chunk = glm::check(&bytes).unwrap().chunks().next().unwrap();
            let mut numbers = HashMap::new();
            let places: Vec<u32> = chunk
                .vertices()
                .map(|v| {
                    let next = numbers.len() as u32;
                    *numbers.entry(v.position).or_insert(next)
                })
                .collect();
            let edges = chunk.triangles().flat_map(|triangle| {
                let [a, b, c] = triangle.indices.map(|i| places[usize::from(i)]);
                [(a, b), (b, c), (c, a)]
            });
            assert_closed(name, edges);
        }
    }

    /// Hall, fence and window are open and textured; the textures of fence and window have transparent texels.
    #[test]
    fn props_have_textures() {
        for (name, triangles, textures) in [("hall", 8, 2), ("fence", 4, 1), ("window", 20, 2)] {
            let polygons = named(name).unwrap();
            let (bytes, report) = convert::convert(&polygons, Options::default()).unwrap();
            let counts = (report.triangles, report.degenerate);
            assert_eq!(counts, (triangles, 0), "{name}");
            assert_eq!(report.textures.len(), textures, "{name}");
            let cut_out = report.textures.iter().any(|texture| texture.report.cut_out);
            assert_eq!(cut_out, name != "hall");
            assert!(report.remarks.is_empty(), "{:?}", report.remarks);
            let mesh = glm::check(&bytes).unwrap();
            let mut all = mesh.chunks().flat_map(|chunk| chunk.triangles());
            assert!(all.all(|triangle| triangle.texture > 0), "{name}");
        }
    }

    #[test]
    fn names() {
        let wrong =
            "cube:1 icosphere icosphere:0 icosphere:65 icosphere:x sponge:5 Teapot sponge:-1";
        for name in wrong.split(' ').chain([""]) {
            assert!(named(name).is_err(), "{name}");
        }
        assert!(is_name("sponge:9") && !is_name("sponge.obj"));
    }

    #[test]
    fn volumes() {
        let close = |name: &str, expected: f64, tolerance: f64| {
            let found = volume(&named(name).unwrap());
            let error = (found / expected - 1.0).abs();
            assert!(error < tolerance, "{name}: {found} instead of {expected}");
        };
        close("cube", 1.0, 1e-12);
        close("icosphere:16", 4.0 / 3.0 * std::f64::consts::PI, 0.01);
        close("sponge:2", (20.0f64 / 27.0).powi(2), 1e-12);
    }

    #[test]
    fn the_sponges_count() {
        for (level, cells, eights) in [(0, 1, 1), (1, 20, 8), (2, 400, 64), (3, 8000, 512)] {
            // A sponge of level n has 2·20^n + 4·8^n outer faces.
            let sponge = named(&format!("sponge:{level}")).unwrap();
            assert_eq!(sponge.faces.len(), 2 * cells + 4 * eights);
        }
    }
}
