//! Tests of the clipping of triangles that cross the near plane or leave the guard band: the remaining vertices, and the same result for
//! each choice of the first vertex. `glint-reference` compares the pixels of clipped triangles with exact results.

use glint_model::triangle::vertex::project;
use glint_model::{Projected, SIZES};
use glint_vectors::{Camera, Model, Picture, Random};

use crate::{clipped, random_frame, random_vertex};

/// Clipping keeps vertices inside the volume bit for bit, and removes vertices outside of the volume.
#[test]
fn what_is_inside_is_never_cut() {
    let mut random = Random(10);
    let (mut kept, mut at_the_limit) = (0, 0);
    for _ in 0..100_000 {
        let frame = random_frame(&mut random);
        let triangle = [0; 3].map(|_| random_vertex(&mut random, &frame));
        let vertices = &clipped(&frame, triangle);
        assert!(vertices.len() <= 8);
        for vertex in &triangle {
            match project(&frame, vertex) {
                Projected::Visible(place) => {
                    assert!(vertices.contains(vertex));
                    kept += 1;
                    at_the_limit += u32::from(place.x.abs().max(place.y.abs()) > 2000 << 8);
                }
                Projected::Behind => assert!(!vertices.contains(vertex)),
                Projected::BeyondGuard(place) => {
                    assert!(
                        place.x.abs().max(place.y.abs()) < 2048 << 8 || !vertices.contains(vertex)
                    );
                }
            }
        }
        for vertex in vertices {
            let (Projected::Visible(place) | Projected::BeyondGuard(place)) =
                project(&frame, vertex)
            else {
                panic!("{vertex:?} is behind")
            };
            assert!(place.x.abs().max(place.y.abs()) < 2048 << 8);
        }
    }
    assert!(
        kept > 10_000 && at_the_limit > 100,
        "{kept}, {at_the_limit}"
    );
}

#[test]
fn clipping_does_not_depend_on_the_first_vertex() {
    let mut random = Random(2);
    let mut clipped = 0;
    for _ in 0..100 {
        let view = Camera::inside(&mut random).rounded();
        let model = Model::random(&mut random, 6, 32768);
        let pictures =
            [0, 1, 2].map(|turns| Picture::of(&model.rotated(turns), &view, SIZES[0], false));
        clipped += pictures[0].stats.clipped;
        for other in &pictures[1..] {
            assert_eq!(other.coverage(), pictures[0].coverage());
            assert_eq!(other.stats.clipped, pictures[0].stats.clipped);
            // Colours are not compared, because the test computes normals in f64 and their rounding depends on the order of
            // the vertices.
            let exceptions = |picture: &Picture| -> Vec<_> {
                let clipped = picture.drawn.iter().filter(|t| t.clipped);
                clipped.map(|t| (t.vertices, t.facing)).collect()
            };
            assert_eq!(exceptions(other), exceptions(&pictures[0]));
        }
    }
    assert!(clipped > 200, "{clipped}");
}
