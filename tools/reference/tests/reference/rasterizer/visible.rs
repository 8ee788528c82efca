//! Checks the visible surface and depth in pictures of whole scenes, at all pixels where snapping the vertices cannot change the surface.

use glint_reference::camera::{Camera, cross, dot, length, subtract};
use glint_reference::triangle::surface::{Tolerance, Visible, visible_surfaces};
use glint_vectors::picture::CLEAR;

use super::coverage::snap_limit;
use super::scenes::{Case, ONE, random_case};

/// Numbers of compared pixels, and the largest error of a depth.
#[derive(Debug, Default)]
struct Tally {
    stable: u64,
    surface: u64,
    unstable: u64,
    /// Largest error of the depth in depth codes, without the effect of displaced vertices on a slope.
    depth_error: f64,
}

/// Largest allowed error of the depth in depth codes, without the effect of displaced vertices on a slope.
const DEPTH_LIMIT: f64 = 2.0;

/// Gives every triangle a unique colour, and a normal towards the camera, which leaves the colour unshaded.
fn colour_by_number(case: &mut Case) {
    let camera = &case.camera;
    for (i, [a, b, c]) in case.scene.all_corners().into_iter().enumerate() {
        let front = dot(
            cross(subtract(b, a), subtract(c, a)),
            subtract(a, camera.eye),
        ) < 0.0;
        let towards = if front { -ONE } else { ONE };
        case.scene
            .normals
            .push(camera.n.map(|x| (x * towards).round() as i16));
        case.scene.colours.push(i as u16 + 1);
    }
}

fn check(case: &Case, tally: &mut Tally) {
    let view = case.camera.rounded();
    let camera = Camera::of(&view);
    let corners = case.scene.all_corners();
    let radius = corners
        .iter()
        .flatten()
        .map(|&p| length(p))
        .fold(0.0, f64::max);
    // A mesh stores its radius with 14 fraction bits, rounded up.
    let radius = (radius * ONE).ceil() / ONE;
    let depth_scale = camera.depth_scale(radius);
    let tolerance = Tolerance {
        pixels: snap_limit(case.size),
        inverse_depth: DEPTH_LIMIT / depth_scale,
    };
    let picture = case.scene.draw(&view, case.size, case.cull);
    let expected = visible_surfaces(&camera, case.size, &corners, case.cull, tolerance);
    for (i, visible) in expected.iter().enumerate() {
        let (colour, code) = (picture.colour[i], picture.depth[i]);
        let place = || {
            let width = case.size.width as usize;
            format!(
                "{}, pixel ({}, {})\n{camera:?}",
                case.name,
                i % width,
                i / width
            )
        };
        match *visible {
            Visible::Unstable => tally.unstable += 1,
            Visible::Background => {
                tally.stable += 1;
                assert!(
                    colour == CLEAR && code == 0,
                    "{}: triangle {colour} − 1 on the background",
                    place()
                );
            }
            Visible::Surface {
                triangle,
                inverse_depth,
                slope,
            } => {
                tally.stable += 1;
                tally.surface += 1;
                assert_eq!(
                    usize::from(colour),
                    triangle + 1,
                    "{}: a wrong triangle is visible",
                    place()
                );
                let exact = (inverse_depth * depth_scale).max(1.0);
                let moved = slope * tolerance.pixels * depth_scale;
                let error = (f64::from(code) - exact).abs() - moved;
                tally.depth_error = tally.depth_error.max(error);
                assert!(
                    error <= DEPTH_LIMIT,
                    "{}: depth {code} for {exact:.2} ± {moved:.2}",
                    place()
                );
            }
        }
    }
}

#[test]
fn the_right_surface_is_in_front_wherever_it_is_certain() {
    let mut tally = Tally::default();
    for seed in 10_000..10_200 {
        let mut case = random_case(seed);
        colour_by_number(&mut case);
        check(&case, &mut tally);
    }
    println!("visible surfaces of 200 random scenes: {tally:?}");
    assert!(
        tally.surface > 1_000_000,
        "too few pixels have a certain surface: {tally:?}"
    );
    assert!(
        tally.unstable * 20 < tally.stable,
        "too many pixels have an uncertain surface: {tally:?}"
    );
}
