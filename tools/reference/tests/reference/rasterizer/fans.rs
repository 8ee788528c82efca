//! Checks that triangles with shared edges cover every pixel exactly once.

use glint_reference::camera::Camera;
use glint_reference::triangle::surface::{Class, ProjectedTriangle};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

use super::cameras::{around, log_range, view};
use super::renderer::{Renderer, exact};
use super::scenes::{Case, ONE, SMALL, Scene};

/// Number of lattice steps along each of two sides of a [`Cut`].
const STEPS: i64 = 200;

/// A large triangle cut into many triangles with shared edges. All vertices lie on a lattice in the plane of the large triangle,
/// so the union of the small triangles is exactly the large triangle.
struct Cut {
    origin: [i64; 3],
    sides: [[i64; 3]; 2],
    places: Vec<[i64; 2]>,
    triangles: Vec<[u32; 3]>,
}

impl Cut {
    /// Makes a random uncut triangle with corner coordinates from −`reach` to `reach`.
    fn new(random: &mut Pcg64, reach: f64) -> Self {
        let reach = (reach * ONE) as i64;
        let mut corner = || [(); 3].map(|()| random.random_range(-reach..reach));
        let (origin, b, c) = (corner(), corner(), corner());
        let side = |to: [i64; 3]| [0, 1, 2].map(|i| (to[i] - origin[i]) / STEPS);
        Self {
            origin,
            sides: [side(b), side(c)],
            places: vec![[0, 0], [STEPS, 0], [0, STEPS]],
            triangles: vec![[0, 1, 2]],
        }
    }

    /// Cuts a random triangle into three at an inner lattice point, if any. The first vertex of each part, from which the model
    /// computes the depth plane, is random.
    fn cut(&mut self, random: &mut Pcg64) {
        let chosen = random.random_range(0..self.triangles.len());
        let [a, b, c] = self.triangles[chosen];
        let corners = [a, b, c].map(|i| self.places[i as usize]);
        let weights = [(); 3].map(|()| random.random_range(0.2..1.0));
        let sum: f64 = weights.iter().sum();
        let middle = [0, 1].map(|axis| {
            let weighted = (0..3).map(|i| weights[i] * corners[i][axis] as f64);
            (weighted.sum::<f64>() / sum).round() as i64
        });
        let parts = [[0, 1], [1, 2], [2, 0]].map(|[i, j]| area([corners[i], corners[j], middle]));
        if parts.iter().any(|&area| area <= 0) {
            return;
        }
        let middle = {
            self.places.push(middle);
            self.places.len() as u32 - 1
        };
        let mut part = |pair: [u32; 2]| {
            let [a, b] = pair;
            [[a, b, middle], [b, middle, a], [middle, a, b]][random.random_range(0..3)]
        };
        self.triangles[chosen] = part([a, b]);
        self.triangles.push(part([b, c]));
        self.triangles.push(part([c, a]));
    }

    fn scene(&self) -> Scene {
        let position = |place: &[i64; 2]| {
            [0, 1, 2].map(|i| {
                (self.origin[i] + place[0] * self.sides[0][i] + place[1] * self.sides[1][i]) as i16
            })
        };
        Scene {
            positions: self.places.iter().map(position).collect(),
            triangles: self.triangles.clone(),
            ..Scene::default()
        }
    }
}

/// Returns twice the signed area of a triangle.
fn area([a, b, c]: [[i64; 2]; 3]) -> i64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])
}

/// Returns two scenes: a random large triangle, and the triangles that it is cut into. About half of the parts show their back
/// face.
fn whole_and_parts(random: &mut Pcg64, reach: f64) -> (Scene, Scene) {
    let mut cut = Cut::new(random, reach);
    let whole = cut.scene();
    for _ in 0..25 {
        cut.cut(random);
    }
    let mut parts = cut.scene();
    mix_winding(random, &mut parts);
    (whole, parts)
}

/// Swaps two vertices in about half of the triangles, which reverses their orientation.
fn mix_winding(random: &mut Pcg64, scene: &mut Scene) {
    for triangle in &mut scene.triangles {
        if random.random_bool(0.5) {
            triangle.swap(0, 1);
        }
    }
}

/// Counts the triangles of a case that cover each pixel. The triangles are drawn one by one.
fn counts(renderer: &mut Renderer, case: &Case) -> Vec<u32> {
    let view = view(&case.camera);
    let mut counts = vec![0; (case.size.width * case.size.height) as usize];
    for triangle in 0..case.scene.triangles.len() {
        renderer.draw(&case.scene.only(triangle), &view, case.size, case.cull);
        for (count, &code) in counts.iter_mut().zip(&renderer.depth) {
            *count += u32::from(code != 0);
        }
    }
    counts
}

/// Checks the number of triangles that cover each pixel: one inside the triangles' common outline, none outside, at most one for a pixel
/// centre close to the outline. Returns the number of pixels inside. `outline` is the index of the outline in the scene `whole`.
fn check_against_outline(case: &Case, outline: usize, whole: &Scene, counts: &[u32]) -> u64 {
    let camera = Camera::from(&view(&case.camera));
    let outline = ProjectedTriangle::new(&camera, case.size, whole.corners(outline));
    let mut inside = 0;
    for row in 0..case.size.height {
        for column in 0..case.size.width {
            let count = counts[(row * case.size.width + column) as usize];
            let right = match outline.classify(column, row, 1.5 / 256.0) {
                Class::Full => {
                    inside += 1;
                    count == 1
                }
                Class::Partial => count <= 1,
                Class::None => count == 0,
            };
            assert!(
                right,
                "{}: pixel ({column}, {row}) is covered {count} times\n{camera:?}",
                case.name
            );
        }
    }
    inside
}

#[test]
fn a_cut_triangle_covers_what_it_did_before_and_once() {
    let mut renderer = Renderer::default();
    let mut inside = 0;
    for seed in 0..40 {
        let mut random = Pcg64::seed_from_u64(1000 + seed);
        let (whole, scene) = whole_and_parts(&mut random, 1.2);
        let distance = random.random_range(2.0..4.0);
        let case = Case {
            name: format!("fan, seed {seed}"),
            scene,
            camera: around(&mut random, distance, 0.9, 0.1),
            size: SMALL,
            cull: false,
        };
        let counts = counts(&mut renderer, &case);
        check_against_outline(&case, 0, &whole, &counts);

        // Without clipping, the outline's snapped corners determine the inner pixels exactly.
        renderer.draw(&whole, &view(&case.camera), case.size, false);
        let mut expected = vec![0; counts.len()];
        if let Some(outline) = renderer.drawn.first().and_then(exact) {
            outline.for_each_pixel(case.size.width, case.size.height, |column, row| {
                expected[(row * case.size.width + column) as usize] = 1;
                inside += 1;
            });
        }
        let wrong = counts
            .iter()
            .zip(&expected)
            .position(|(count, expected)| count != expected);
        assert_eq!(
            wrong, None,
            "{}: covered differently from its outline",
            case.name
        );
    }
    println!("fans: {inside} pixels inside 40 outlines, each covered once");
    assert!(inside > 50_000);
}

#[test]
fn a_cut_triangle_stays_whole_where_it_is_clipped() {
    let mut renderer = Renderer::default();
    let (mut inside, mut clipped) = (0, 0);
    for seed in 0..40 {
        let mut random = Pcg64::seed_from_u64(2000 + seed);
        let (whole, scene) = whole_and_parts(&mut random, 1.9);
        let (distance, half_width) = (
            random.random_range(0.05..0.5),
            log_range(&mut random, 0.1, 4.0),
        );
        let near = log_range(&mut random, 0.01, 0.5);
        let case = Case {
            name: format!("clipped fan, seed {seed}"),
            scene,
            camera: around(&mut random, distance, half_width, near),
            size: SMALL,
            cull: false,
        };
        let counts = counts(&mut renderer, &case);
        inside += check_against_outline(&case, 0, &whole, &counts);
        clipped += renderer
            .draw(&case.scene, &view(&case.camera), case.size, false)
            .clipped;
    }
    println!("clipped fans: {inside} pixels inside 40 outlines, {clipped} clipped triangles");
    assert!(inside > 100_000 && clipped > 100);
}
