//! Errors of screen positions and of shades if one stage of the pipeline has a shorter or a longer word.

use anyhow::Result;
use glint_model::triangle::MeshSetup;
use glint_model::triangle::vertex::{CameraVertex, snap, transform};
use glint_variants::reciprocal::reciprocal;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use super::trial::{Errors, Trial};
use crate::camera::{Camera, Size, Vector, dot, normalised};

/// Number of vertices.
const VERTICES: u32 = 1 << 17;
const SIZE: Size = Size {
    width: 640,
    height: 360,
};

fn rounded(x: f64, bits: u32) -> f64 {
    let unit = f64::from(bits).exp2();
    (x * unit).round() / unit
}

/// Returns a random vertex in the box of 1×1×1, and a camera at a distance of 2 to 5 that looks at the box's middle.
fn case(random: &mut Pcg64Mcg) -> (Vector, Camera) {
    let vertex = [0; 3].map(|_| random.random_range(-0.5..0.5));
    let direction = normalised([0; 3].map(|_| random.random_range(-1.0..1.0f64) + 1e-3));
    let distance = random.random_range(2.0..5.0);
    let eye = direction.map(|x| x * distance);
    (vertex, Camera::looking(eye, [0.0; 3], 0.4781, 0.1))
}

/// Measures the errors of positions, in pixels of a picture that is 640 pixels wide. `found` computes a position from a vertex and a
/// camera.
fn positions(thinning: u32, found: impl Fn(Vector, &Camera) -> Option<[f64; 2]>) -> Errors {
    let mut random = Pcg64Mcg::seed_from_u64(4);
    let mut errors = Errors::default();
    for _ in 0..VERTICES / thinning {
        let (vertex, camera) = case(&mut random);
        let exact = camera.screen(camera.coordinates(vertex), SIZE);
        if let Some(found) = found(vertex, &camera) {
            let off = (found[0] - exact[0]).hypot(found[1] - exact[1]);
            errors.add(&[off], || vertex.map(|x| format!("{x:.4}")).join(", "));
        }
    }
    errors
}

pub fn formats(thinning: u32) -> Result<Vec<Trial>> {
    let mut trials = Vec::new();
    let mut add = |kernel, config: String, shipped, bits, errors| {
        trials.push(Trial {
            kernel,
            config,
            shipped,
            bits: Some(bits),
            errors,
        });
    };
    for bits in [8, 10, 12, 14, 16] {
        let errors = positions(thinning, |vertex, camera| {
            let vertex = vertex.map(|x| rounded(x, bits));
            Some(camera.screen(camera.coordinates(vertex), SIZE))
        });
        let config = format!("vertices: {bits} fraction bits");
        add("vertex", config, bits == 14, bits + 2, errors);
    }
    for bits in [10, 12, 14, 16, 18, 20, 23] {
        let errors = positions(thinning, |vertex, camera| {
            let row = |row: Vector| row.map(|x| rounded(x, bits));
            let camera = Camera {
                u: row(camera.u),
                v: row(camera.v),
                n: row(camera.n),
                ..*camera
            };
            Some(camera.screen(camera.coordinates(vertex), SIZE))
        });
        let config = format!("camera's axes: {bits} fraction bits");
        add("basis", config, bits == 23, bits + 2, errors);
    }
    let [none, one, two]: [fn(u32) -> u32; 3] = [reciprocal::<0>, reciprocal::<1>, reciprocal::<2>];
    for (bits, inverse) in [(10, none), (17, one), (24, two)] {
        let errors = positions(thinning, |vertex, camera| {
            let [x, y, z] = camera.coordinates(vertex);
            let lead = z.log2().floor();
            let mantissa = (z * (23.0 - lead).exp2()) as u32;
            let inverse = f64::from(inverse(mantissa)) * (-24.0 - lead).exp2();
            Some(camera.screen([x * inverse, y * inverse, 1.0], SIZE))
        });
        let config = format!("reciprocal of the depth: {bits} bits");
        add("inverse", config, bits == 24, bits, errors);
    }
    for bits in [4, 5, 6, 8, 10] {
        let errors = positions(thinning, |vertex, camera| {
            let place = camera.screen(camera.coordinates(vertex), SIZE);
            Some(place.map(|x| rounded(x, bits)))
        });
        let config = format!("positions: {bits} fraction bits");
        add("snap", config, bits == 8, bits + 12, errors);
    }
    let errors = positions(thinning, |vertex, camera| {
        let frame = MeshSetup::new(&camera.view().ok()?, SIZE.width, SIZE.height, 1 << 14).ok()?;
        let vertex = vertex.map(|x| (x * f64::from(1 << 14)).round() as i16);
        let vertex: CameraVertex = transform(&frame, vertex);
        let place = snap(&frame, &vertex);
        Some([place.x, place.y].map(|x| f64::from(x) / 256.0))
    });
    let config = "all of them, as the vertex stage computes".to_owned();
    add("stage", config, true, 20, errors);
    for bits in [6, 8, 10, 12, 14] {
        let errors = shades(thinning, |normal| normal.map(|x| rounded(x, bits)), |x| x);
        let config = format!("normals: {bits} fraction bits");
        add("normal", config, bits == 14, bits + 2, errors);
    }
    for bits in [5, 6, 8, 10] {
        let errors = shades(thinning, |normal| normal, |x| rounded(x, bits));
        let config = format!("intensities: {bits} fraction bits");
        add("intensity", config, bits == 8, bits + 1, errors);
    }
    Ok(trials)
}

/// Measures the errors of a face's intensity, in steps of 1/255, that are caused by rounding the normal and the intensity.
fn shades(
    thinning: u32,
    normal: impl Fn(Vector) -> Vector,
    intensity: impl Fn(f64) -> f64,
) -> Errors {
    let mut random = Pcg64Mcg::seed_from_u64(5);
    let mut errors = Errors::default();
    for _ in 0..VERTICES / thinning {
        let [exact, light] =
            [0; 2].map(|_| normalised([0; 3].map(|_| random.random_range(-1.0..1.0f64) + 1e-3)));
        let clamped = |x: f64| x.clamp(0.0, 1.0);
        let found = clamped(intensity(dot(normal(exact), light)));
        let off = 255.0 * (found - clamped(dot(exact, light)));
        errors.add(&[off], || exact.map(|x| format!("{x:.4}")).join(", "));
    }
    errors
}
