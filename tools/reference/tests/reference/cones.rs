//! Compares the raymarcher's prepass with exact hits. The prepass marches a cone for each block of pixels, and the block's rays
//! start at the cone's end. No ray may start behind its hit surface.

use glint_core::camera::View;
use glint_core::field::Field as Scene;
use glint_core::fixed::Q32_32;
use glint_model::SIZES;
use glint_model::raymarch::{Cones, FieldOptions, FieldSetup, Rays, Stereo, Tint};
use glint_reference::camera::Camera;
use glint_reference::raymarch::{Field, views};

/// Largest error from the truncation of a point and of a face's position, in field units (docs/formats/raymarch.md).
const STEPS: f64 = 2.0 / 4096.0;

/// Comparison of a picture's rays with and without a prepass.
#[derive(Debug, Default)]
struct Seen {
    hits: usize,
    /// Number of rays that start farther along with the prepass than without it.
    helped: usize,
    /// Largest distance of a ray's start behind its hit surface, in field units.
    behind: f64,
    /// Number of rays whose kind of result (hit, miss or undecided) changes with the prepass.
    changed: usize,
    /// Mean number of evaluations per ray without a prepass, and with a prepass including its cones.
    cost: [f64; 2],
}

/// Marches the rays of one pixel in each `stride` × `stride` block of a picture, with and without the prepass. Checks that no ray
/// starts behind its hit surface by more than the rounding error `STEPS`.
fn see(scene: &str, setup: &FieldSetup, stride: u32) -> Seen {
    let field = Field::of(&Scene::parse(scene).expect("a field"));
    let size = (setup.width, setup.height);
    let units = setup.scale.to_num::<f64>() * 4096.0;
    let mut rays = Rays::new(setup);
    let mut seen = Seen::default();
    let eyes = if setup.stereo.is_some() { 2 } else { 1 };
    let mut count = 0;
    for (x, y) in (0..size.1 / stride).flat_map(|y| {
        (0..size.0 / stride).map(move |x| (x * stride + y % stride, y * stride + x % stride))
    }) {
        for eye in 0..eyes {
            let plain = setup.ray(eye, x, y);
            let ray = rays.ray(eye, x, y);
            assert!(ray.start >= plain.start);
            let [end, found] = [&plain, &ray].map(|ray| setup.march(ray));
            count += 1;
            seen.helped += usize::from(ray.start > plain.start);
            seen.changed += usize::from(
                std::mem::discriminant(&end.state) != std::mem::discriminant(&found.state),
            );
            seen.cost[0] += f64::from(end.steps);
            seen.cost[1] += f64::from(found.steps);
            let origin = setup.eyes[eye].origin.map(|x| (f64::from(x) + 0.5) / units);
            let direction = ray.direction.map(|x| f64::from(x) / f64::from(1 << 17));
            let begin = f64::from(plain.start) / units;
            let far = f64::from(setup.tuning.far) / units;
            if let Some(hit) = field.hit(origin, direction, begin, far) {
                seen.hits += 1;
                let behind = f64::from(ray.start) / 4096.0 - hit.t * units / 4096.0;
                assert!(
                    behind <= STEPS,
                    "{scene}, pixel {x}, {y} of eye {eye} starts {behind} behind {hit:?}: {ray:?}, {found:?}"
                );
                seen.behind = seen.behind.max(behind);
            }
        }
    }
    seen.cost[1] += rays.evaluations() as f64;
    seen.cost = seen.cost.map(|cost| cost / f64::from(count));
    seen
}

/// Returns the model's constants of a picture with a prepass.
fn with_prepass(scene: &str, view: &View, size: (u32, u32), stereo: Option<Stereo>) -> FieldSetup {
    let scene = Scene::parse(scene).expect("a field");
    let options = FieldOptions {
        prepass: true,
        stereo,
        ..FieldOptions::of(&scene)
    };
    FieldSetup::new(&scene, view, size, &options).expect("a size")
}

#[test]
fn no_ray_of_the_views_starts_behind_a_surface() {
    for (name, eye, target) in views::views() {
        let view = views::camera(eye, target).view().unwrap();
        for block in 2..=4 {
            let mut setup = with_prepass("menger:4", &view, SIZES[0], None);
            setup.cones = Some(Cones::new(block, setup.is_round(), &setup.steps));
            let seen = see("menger:4", &setup, 1);
            println!("{name}, blocks of {}: {seen:?}", 1 << block);
            assert!(seen.hits > 10_000 && seen.changed < 10, "{seen:?}");
        }
    }
}

/// Draws frames of random cameras with any field of view, in mono and stereo, in every kind of field, and checks the starts of
/// their rays (see `see`). The environment variable `GLINT_CONES` sets the number of frames, by default 39.
#[test]
fn no_ray_of_random_cameras_starts_behind_a_surface() {
    let mut state = 7_u64;
    let mut random = |low: f64, high: f64| {
        state = state
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        low + (high - low) * (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let fields = [
        "menger:4",
        "menger:6",
        "menger:1",
        "box:1,0.5,0.25",
        "cubes:2,0.5",
        "cubes:0.25,0.1",
        "planes:0.5",
        "sphere:0.8",
        "lattice:1,0.3",
        "lattice:0.25,0.11",
        "spheres:0.5,0,0,0.4;-0.5,0.1,0,0.45;0,0,0.6,0.3",
        "union:box:0.6,0.6,0.2+sphere:0.5",
        "smooth:0.3,box:0.6,0.6,0.2+sphere:0.5",
    ];
    let frames = std::env::var("GLINT_CONES").map_or(39, |text| text.parse().expect("a number"));
    let (mut hits, mut helped, mut changed) = (0, 0, 0);
    let mut behind: f64 = 0.0;
    for frame in 0..frames {
        let reach = [0.9, 1.5, 3.0, 15.0][frame % 4];
        let eye = [0, 1, 2].map(|_| random(-reach, reach));
        let target = eye.map(|x| random(-0.8, 0.8) - 0.3 * x);
        let camera = Camera::looking(
            eye,
            target,
            random(0.0, 1.0).powi(3) * 3.9 + 0.06,
            random(0.01, 0.3),
        );
        let view = camera.view().expect("a camera");
        let scene = fields[frame % fields.len()];
        let stereo = (frame % 3 == 0).then(|| Stereo {
            half_separation: Q32_32::from_num(random(0.0, 0.3)),
            zero_parallax: Q32_32::from_num(random(1.0, 5.0)),
            tint: Tint::RedBlue,
        });
        let setup = with_prepass(scene, &view, SIZES[frame % 3], stereo);
        let seen = see(scene, &setup, [3, 7, 13][frame % 3]);
        hits += seen.hits;
        helped += seen.helped;
        changed += seen.changed;
        behind = behind.max(seen.behind);
    }
    println!("{hits} hits, {helped} helped, {changed} changed, {behind} units behind at most");
    assert!(hits > 100_000 && helped > 50_000 || frames < 39);
}
