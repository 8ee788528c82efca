//! Tests of the winding rule that uses positions on the screen.

use glint_core::colour::{Shading, Winding};
use glint_core::fixed::Q32_32;
use glint_core::light::{Light, MeshLighting};
use glint_core::mesh::{IndexedTriangle, Mesh, Rgb565, Vertex, encode};
use glint_core::picture::Size;
use glint_model::triangle::setup::Oriented;
use glint_model::{Frame, MeshSubject, ScreenVertex, Subject};
use glint_vectors::{Camera, Picture, Random};

/// All orders of three vertices.
const ORDERS: [[usize; 3]; 6] = [
    [0, 1, 2],
    [1, 2, 0],
    [2, 0, 1],
    [0, 2, 1],
    [2, 1, 0],
    [1, 0, 2],
];

#[test]
fn the_upper_left_vertex_is_first_and_the_others_follow_clockwise() {
    let mut random = Random(1);
    for _ in 0..20_000 {
        // The coordinates are small, so that vertices often have the same y.
        let vertices = [0; 3].map(|_| ScreenVertex {
            x: random.integer(-4, 4) as i32,
            y: random.integer(-4, 4) as i32,
            w: 0,
        });
        let [a, b, c] = Oriented::screen_order(&vertices).map(|i| vertices[i]);
        let (ab, ac) = ((b.x - a.x, b.y - a.y), (c.x - a.x, c.y - a.y));
        assert!(ab.0 * ac.1 - ac.0 * ab.1 >= 0, "{vertices:?}");
        for other in [b, c] {
            assert!((a.y, a.x) <= (other.y, other.x), "{vertices:?}");
        }
    }
}

/// The picture depends neither on the order of the vertices in the mesh, nor on the signs of the normals.
#[test]
fn the_order_in_the_mesh_does_not_matter() {
    let mut random = Random(2);
    let mut covered = 0;
    for round in 0..30 {
        let vertices: Vec<_> = (0..30)
            .map(|_| Vertex {
                position: [0; 3].map(|_| random.integer(-30_000, 30_000) as i16),
                normal: random.direction().map(|x| (x * 16_384.0) as i16),
                colour: Rgb565(random.bits() as u16),
                fine: random.bits() as u8,
            })
            .collect();
        let triangles: Vec<_> = (0..20)
            .map(|_| IndexedTriangle {
                indices: [0; 3].map(|_| random.integer(0, 29) as u32),
                colour: Rgb565(random.bits() as u16),
                normal: random.direction().map(|x| (x * 16_384.0) as i16),
                texture: 0,
            })
            .collect();
        let view = Camera::inside(&mut random).rounded();
        let lighting = if round % 3 == 0 {
            MeshLighting::CAMERA
        } else {
            MeshLighting {
                ambient: [20, 40, 60],
                light: Light::new(random.direction().map(Q32_32::from_num), [255, 200, 150])
                    .unwrap(),
            }
        };
        let picture = |order: [usize; 3], sign: i16| {
            let turned: Vec<_> = triangles
                .iter()
                .map(|t| IndexedTriangle {
                    indices: order.map(|i| t.indices[i]),
                    normal: t.normal.map(|x| x * sign),
                    ..*t
                })
                .collect();
            let bytes = encode(&vertices, &turned).unwrap();
            let subject = MeshSubject {
                shading: [Shading::Flat, Shading::Smooth][round % 2],
                winding: Winding::Screen,
                ..MeshSubject::new(Mesh::new_checked(&bytes).unwrap())
            };
            Picture::of_frame(&Frame {
                lighting,
                ..Frame::new(Subject::Mesh(subject), view, Size::W320)
            })
        };
        let first = picture(ORDERS[0], 1);
        covered += first.covered();
        let same = |other: &Picture| other.colour == first.colour && other.depth == first.depth;
        for order in ORDERS {
            let are_same = [1, -1].map(|sign| same(&picture(order, sign)));
            assert_eq!(are_same, [true; 2], "{order:?}");
        }
    }
    assert!(covered > 100_000, "{covered}");
}
