//! Compares the model's coverage with Mesa's software rasterizer llvmpipe, on machines that have Mesa and moderngl.
//!
//! llvmpipe draws each triangle twice. From the model's vertices, snapped to the subpixel grid, llvmpipe must cover the model's
//! pixels. From the unsnapped vertices, which llvmpipe snaps to its own grid, pixels may differ only if llvmpipe snaps a vertex
//! to another position.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use glint_reference::camera::{Camera, Size, Vector};
use glint_reference::triangle::exact::{ExactTriangle, SnappedVertex};
use glint_reference::triangle::surface::{Class, ProjectedTriangle};
use serde::{Deserialize, Serialize};

use super::cameras::view;
use super::renderer::Renderer;
use super::scenes::{SMALL, random_case};

/// Input of the script compare.py.
#[derive(Serialize)]
struct Scenes {
    width: u32,
    height: u32,
    reach: u32,
    triangles: Vec<Triangle>,
}

#[derive(Serialize)]
struct Triangle {
    clip: [[f64; 4]; 3],
    screen: Option<[[f64; 2]; 3]>,
    covered: Vec<[u32; 3]>,
}

/// Output of the script compare.py.
#[derive(Deserialize)]
struct Results {
    renderer: String,
    version: String,
    triangles: Vec<Comparison>,
}

#[derive(Deserialize)]
struct Comparison {
    projected: Differences,
    snapped: Option<Differences>,
}

#[derive(Debug, Deserialize)]
struct Differences {
    missing: Vec<[u32; 2]>,
    extra: Vec<[u32; 2]>,
}

impl Differences {
    fn count(&self) -> usize {
        self.missing.len() + self.extra.len()
    }

    fn pixels(&self) -> impl Iterator<Item = &[u32; 2]> {
        self.missing.iter().chain(&self.extra)
    }
}

/// A triangle drawn by the model, with data to explain a difference.
struct Subject {
    name: String,
    exact: ProjectedTriangle,
    /// Unsnapped positions of the triangle's corners on the screen, in pixels. Meaningless for corners behind the eye.
    places: [[f64; 2]; 3],
    /// The model's snapped corners in the order of `places`; `None` if the triangle was clipped.
    snapped: Option<[SnappedVertex; 3]>,
    covered: Vec<bool>,
}

/// Distance in pixels from the middle of the picture to each border of llvmpipe's viewport. The viewport is larger than the
/// model's guard band (the positions without clipping), so llvmpipe clips only triangles that the model also clips.
const REACH: u32 = 2400;

/// Converts a point from world to clip coordinates. x/w and y/w are −1 and 1 at the borders of the viewport, and the near plane
/// is at z = −w.
fn clip_coordinates(camera: &Camera, size: Size, point: Vector) -> [f64; 4] {
    let [x, y, z] = camera.coordinates(point);
    let scale = camera.pixels_per_unit(size) / f64::from(REACH);
    [x * scale, y * scale, z - 2.0 * camera.near, z]
}

/// Returns the runs of covered pixels, row by row. A run has its row, its first column, and the column after its last.
fn spans(covered: &[bool], size: Size) -> Vec<[u32; 3]> {
    let mut spans = Vec::new();
    for (row, pixels) in (0..).zip(covered.chunks(size.width as usize)) {
        let mut start = 0;
        for run in pixels.chunk_by(|a, b| a == b) {
            let end = start + run.len() as u32;
            if run[0] {
                spans.push([row, start, end]);
            }
            start = end;
        }
    }
    spans
}

/// Returns the snapped vertices of the triangle drawn by the model, in the order of `places`, the corners' unsnapped positions.
/// Returns `None` if the triangle was clipped.
fn snapped_corners(renderer: &Renderer, places: [[f64; 2]; 3]) -> Option<[SnappedVertex; 3]> {
    let [drawn] = renderer.drawn.as_slice() else {
        return None;
    };
    let corners = places.map(|place| {
        let offset = |vertex: &SnappedVertex| {
            (vertex.x as f64 - place[0] * 256.0).hypot(vertex.y as f64 - place[1] * 256.0)
        };
        let vertices = drawn.vertices.map(super::renderer::snapped);
        vertices
            .into_iter()
            .min_by(|a, b| offset(a).total_cmp(&offset(b)))
    });
    match (drawn.clipped, corners) {
        (false, [Some(a), Some(b), Some(c)]) => Some([a, b, c]),
        _ => None,
    }
}

fn subjects() -> (Scenes, Vec<Subject>) {
    let mut renderer = Renderer::default();
    let (mut triangles, mut subjects) = (Vec::new(), Vec::new());
    for case in (20_000..20_032)
        .map(random_case)
        .filter(|case| case.size == SMALL)
    {
        let view = view(&case.camera);
        let camera = Camera::from(&view);
        for number in 0..case.scene.triangles.len() {
            renderer.draw(&case.scene.only(number), &view, SMALL, false);
            let corners = case.scene.corners(number);
            let places = corners.map(|corner| camera.screen(camera.coordinates(corner), SMALL));
            let snapped = snapped_corners(&renderer, places);
            let covered: Vec<bool> = renderer.depth.iter().map(|&code| code != 0).collect();
            triangles.push(Triangle {
                clip: corners.map(|corner| clip_coordinates(&camera, SMALL, corner)),
                screen: snapped
                    .map(|vertices| vertices.map(|v| [v.x, v.y].map(|c| c as f64 / 256.0))),
                covered: spans(&covered, SMALL),
            });
            subjects.push(Subject {
                name: format!("{}, triangle {number}, {camera:?}", case.name),
                exact: ProjectedTriangle::new(&camera, SMALL, corners),
                places,
                snapped,
                covered,
            });
        }
    }
    let scenes = Scenes {
        width: SMALL.width,
        height: SMALL.height,
        reach: REACH,
        triangles,
    };
    (scenes, subjects)
}

/// Returns llvmpipe's snapped coordinate of `place`, in steps of 1/256 pixel; `None` if f32 rounding errors in llvmpipe may change it.
fn llvmpipe_snap(place: f64) -> Option<i64> {
    let steps = place * 256.0;
    // Error bound of a few f32 operations, each with a relative error of 2^-24, on numbers as large as the position and the picture.
    let uncertain = 0.01 + (steps.abs() + 160.0 * 256.0) * 4.0 / 16_777_216.0;
    ((steps - steps.floor() - 0.5).abs() > uncertain).then(|| steps.round() as i64)
}

/// Returns llvmpipe's snapped vertices; `None` if they are uncertain.
fn llvmpipe_vertices(places: [[f64; 2]; 3]) -> Option<[SnappedVertex; 3]> {
    let [a, b, c] = places.map(|[x, y]| {
        let (x, y) = (llvmpipe_snap(x)?, llvmpipe_snap(y)?);
        Some(SnappedVertex { x, y, w: 0 })
    });
    Some([a?, b?, c?])
}

/// Returns llvmpipe's coverage: the model's coverage with the differing pixels inverted.
fn llvmpipe_coverage(subject: &Subject, differences: &Differences) -> Vec<bool> {
    let mut covered = subject.covered.clone();
    for &[column, row] in differences.pixels() {
        let pixel = &mut covered[(row * SMALL.width + column) as usize];
        *pixel = !*pixel;
    }
    covered
}

#[test]
fn llvmpipe_differs_only_where_a_vertex_snapped_differently() {
    let (scenes, subjects) = subjects();
    let results = match compare(&scenes) {
        Ok(results) => results,
        Err(reason) => {
            // Written directly to the terminal, because the test harness captures the output of tests.
            let _ = writeln!(
                std::io::stderr(),
                "SKIPPED the comparison with llvmpipe: {reason}"
            );
            return;
        }
    };
    assert_eq!(results.triangles.len(), subjects.len());
    let mut tally = Tally::default();
    for (subject, comparison) in subjects.iter().zip(&results.triangles) {
        tally.add(subject, comparison);
    }
    println!("{} ({}): {tally:?}", results.renderer, results.version);
    assert!(
        tally.whole > 300 && tally.other_covered > 10_000,
        "too few triangles were compared: {tally:?}"
    );
}

/// Counts of compared triangles and differing pixels.
#[derive(Debug, Default)]
struct Tally {
    /// Number of unclipped drawn triangles.
    whole: usize,
    covered: usize,
    snapped_differently: usize,
    differing_pixels: usize,
    /// Number of clipped or undrawn triangles.
    others: usize,
    other_covered: usize,
    other_differing_pixels: usize,
}

impl Tally {
    fn add(&mut self, subject: &Subject, comparison: &Comparison) {
        let covered = subject.covered.iter().filter(|&&covered| covered).count();
        let projected = &comparison.projected;
        // The model and llvmpipe apply the same rule, and their vertices differ by at most one grid step. So only pixels close to
        // an edge can differ.
        for &[column, row] in projected.pixels() {
            let class = subject.exact.classify(column, row, 2.0 / 256.0);
            assert_eq!(
                class,
                Class::Partial,
                "{}: ({column}, {row}) is not at an edge",
                subject.name
            );
        }
        let Some(snapped) = subject.snapped else {
            self.others += 1;
            self.other_covered += covered;
            self.other_differing_pixels += projected.count();
            return;
        };
        self.whole += 1;
        self.covered += covered;
        if let Some(differences) = &comparison.snapped {
            let same = differences.count() == 0;
            assert!(
                same,
                "{}: the same vertices {snapped:?} give {differences:?}",
                subject.name
            );
        }
        let theirs = llvmpipe_vertices(subject.places);
        let same_vertices = theirs.is_some_and(|theirs| {
            std::iter::zip(theirs, snapped)
                .all(|(theirs, ours)| (theirs.x, theirs.y) == (ours.x, ours.y))
        });
        if same_vertices {
            assert_eq!(
                projected.count(),
                0,
                "{}: all vertices snapped equally, but {projected:?}",
                subject.name
            );
        } else {
            self.snapped_differently += 1;
            self.differing_pixels += projected.count();
        }
        // If llvmpipe's snapped vertices are certain, llvmpipe must cover the same pixels as the exact rasterizer.
        if let Some(theirs) = theirs {
            let mut expected = vec![false; subject.covered.len()];
            if let Some(triangle) = ExactTriangle::new(theirs) {
                triangle.for_each_pixel(SMALL.width, SMALL.height, |column, row| {
                    expected[(row * SMALL.width + column) as usize] = true;
                });
            }
            let found = llvmpipe_coverage(subject, projected);
            assert!(
                found == expected,
                "{}: llvmpipe is not exact for {theirs:?}",
                subject.name
            );
        }
    }
}

/// Runs compare.py on scenes and returns its results. The error is the reason that llvmpipe is not available.
fn compare(scenes: &Scenes) -> Result<Results, String> {
    let reference = Path::new(env!("CARGO_MANIFEST_DIR"));
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("llvmpipe-scenes.json");
    let json = serde_json::to_vec(scenes).expect("numbers are JSON");
    std::fs::write(&path, json).expect("a writable build folder");
    let environment = reference.join("../../.venv/bin/python");
    let python = if environment.exists() {
        environment
    } else {
        "python3".into()
    };
    let output = Command::new(&python)
        .arg(reference.join("llvmpipe/compare.py"))
        .arg(&path)
        .output()
        .map_err(|error| format!("{} does not run ({error})", python.display()))?;
    read(&output)
}

/// Reads the results of compare.py, or the reason that llvmpipe is not available. Panics if compare.py failed in another way.
fn read(output: &Output) -> Result<Results, String> {
    let complaint = String::from_utf8_lossy(&output.stderr).trim().to_owned();
    match output.status.code() {
        Some(0) => {
            Ok(serde_json::from_slice(&output.stdout).expect("compare.py prints its results"))
        }
        Some(3) => Err(complaint),
        _ => panic!("compare.py failed: {complaint}"),
    }
}
