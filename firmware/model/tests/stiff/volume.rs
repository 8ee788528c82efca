//! The planes of the view volume, and vertices in the plane of the eye.

use glint_core::camera::View;
use glint_core::colour::Rgb565;
use glint_core::fixed::U8_28;
use glint_core::matrix::Matrix;
use glint_core::mesh::Mesh;
use glint_core::picture::Size;
use glint_model::triangle::clip::clip;
use glint_model::triangle::vertex::transform;
use glint_model::{
    Clip, Frame, FrameConstants, MeshSetup, MeshSubject, Object, RenderError, Subject,
};
use glint_vectors::{Camera, Model, Picture};

use crate::case::{Case, number, object, refused, view_volume};

pub const CASES: &[Case] = &[
    ("near = far", || refused(mesh_with_far("0.1"))),
    ("far nearer than near", || refused(mesh_with_far("0.05"))),
    ("far/near of 10,000", deep_volume),
    ("object at 3,150 times the distance of near", || {
        let bytes = Model::cube(8192).encoded();
        let place = Matrix::translation([0.0, 29.5, 0.0].map(number)).unwrap();
        let objects = [object(&bytes, place)];
        let frame = Frame::new(Subject::Objects(&objects), camera(0.01), Size::W320);
        refused(frame.constants())
    }),
    ("vertex with w = 0, in the plane of the eye", || {
        vertex_at_eye_plane([16384, 0, -300]);
        vertex_at_eye_plane([-1, 0, 32767]);
        "cut off: what remains is at the near plane or beyond".to_owned()
    }),
    ("vertex with w = 0, at the eye", || {
        vertex_at_eye_plane([0, 0, 0]);
        "cut off: what remains is at the near plane or beyond".to_owned()
    }),
    ("object wholly in front of the near plane", || {
        outside([0.0, -2.2, 0.0])
    }),
    ("object wholly beyond the far plane", || {
        outside([0.0, 1.2, 0.0])
    }),
    ("object wholly left of the picture", || {
        outside([-2.3, 0.0, 0.0])
    }),
    ("object wholly right of the picture", || {
        outside([2.3, 0.0, 0.0])
    }),
    ("object wholly above the picture", || {
        outside([0.0, 0.0, 1.5])
    }),
    ("object wholly below the picture", || {
        outside([0.0, 0.0, -1.5])
    }),
];

/// A frame of a cube, with a near plane at 0.1.
fn mesh_with_far(far: &str) -> Result<FrameConstants, RenderError> {
    let bytes = Model::cube(8192).encoded();
    let subject = MeshSubject {
        clip: Clip::View {
            far: far.parse::<U8_28>().unwrap(),
        },
        ..MeshSubject::new(Mesh::new_checked(&bytes).unwrap())
    };
    Frame::new(Subject::Mesh(subject), camera(0.1), Size::W320).constants()
}

/// A camera two units in front of the origin that looks along y, with the sides of its view volume at ±0.9 at distance 1.
fn camera(near: f64) -> View {
    Camera::looking([0.0, -2.0, 0.0], [0.0; 3], 0.9, near).rounded()
}

/// A cube at the near plane beside the middle of the picture, and pairs of cubes in the middle about 13 units away.
fn deep_volume() -> String {
    let (near, far) = (0.01, 100.0);
    let bytes = Model::cube(8192).encoded();
    let cube = |place: [f64; 3], size: f64, colour| {
        let matrix = Matrix::scale([number(size); 3])
            .and_then(|matrix| matrix.then(&Matrix::translation(place.map(number))?));
        let mut object = Object {
            colour: Some(Rgb565(colour)),
            ..object(&bytes, matrix.unwrap())
        };
        object.subject.clip = view_volume(far);
        object
    };
    let [red, blue] = [0xF800, 0x001F];
    // Depth codes at both planes, the largest code of the picture, and the colour in its middle.
    let draw = |front: [f64; 2]| {
        let [first, second] = front.map(|depth| [0.0, depth - 1.5, 0.0]);
        let objects = [
            cube([0.0, -1.9848, 0.0075], 0.01, 0xFFFF),
            cube(first, 1.0, red),
            cube(second, 1.0, blue),
        ];
        let frame = Frame::new(Subject::Objects(&objects), camera(near), Size::W320);
        let scale = frame.constants().unwrap().depth_scale().unwrap();
        let k = f64::from(scale.mantissa) * 2f64.powi(scale.exponent);
        let picture = Picture::of_frame(&frame);
        let largest = picture.depth.iter().max().copied().unwrap();
        let colour = picture.colour[picture.colour.len() / 2 + 160];
        assert!(largest > 250_000, "{largest}");
        ([k / near, k / far].map(f64::round), colour)
    };
    // Equal codes, in both orders: the later cube is seen. Then different ones: the nearer cube is seen.
    for (front, seen) in [
        ([13.02, 13.04], blue),
        ([13.04, 13.02], blue),
        ([13.02, 13.5], red),
        ([13.5, 13.02], blue),
    ] {
        let (_, colour) = draw(front);
        assert!(colour & seen != 0 && colour & !seen == 0, "{front:?}");
    }
    let ([nearest, farthest], _) = draw([13.02, 13.5]);
    format!(
        "drawn with depth codes from {nearest} at the near plane to {farthest} at the far plane; of equal codes the later triangle wins"
    )
}

/// Checks a triangle with one vertex in the plane of the eye.
fn vertex_at_eye_plane(position: [i16; 3]) {
    let view = Camera {
        eye: [0.0; 3],
        ..Camera::of(&camera(0.1))
    }
    .rounded();
    let frame = MeshSetup::new(&view, 320, 180, 56_756).unwrap();
    for volume in [Clip::Guard, view_volume(1.5)] {
        let frame = frame.with_clip(volume).unwrap();
        let inside = [[0, 8192, 0], [2000, 9000, 0]].map(|p| transform(&frame, p));
        let vertex = transform(&frame, position);
        assert_eq!(vertex.z, 0);
        let polygon = clip(&frame, [inside[0], vertex, inside[1]]);
        let vertices = polygon.vertices();
        assert!(vertices.len() >= 3 && !vertices.contains(&vertex));
        assert!(vertices.iter().all(|v| v.z >= frame.near));
    }
}

/// Draws a cube of side 0.2 at this place, without a far plane too if the place is not beyond it.
fn outside(place: [f64; 3]) -> String {
    let bytes = Model::cube(1638).encoded();
    let drawn = |place: [f64; 3], clip: Clip| {
        let matrix = Matrix::translation(place.map(number)).unwrap();
        let mut object = object(&bytes, matrix);
        (object.subject.clip, object.subject.cull) = (clip, false);
        let objects = [object];
        let frame = Frame::new(Subject::Objects(&objects), camera(0.1), Size::W320);
        let picture = Picture::of_frame(&frame);
        (picture.stats.drawn, picture.covered())
    };
    let far = view_volume(3.0);
    let whole = drawn([0.0; 3], far);
    assert!(whole.0 == 12 && whole.1 > 0, "{whole:?}");
    assert_eq!(drawn(place, far), (0, 0));
    if place[1] <= 0.0 {
        assert_eq!(drawn(place, Clip::Guard), (0, 0));
    }
    "nothing is drawn".to_owned()
}
