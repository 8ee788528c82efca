//! Whole frames: order, facing, clipping, chunks, errors.

mod common;

use common::{CLEAR, Camera, Model, Picture, Random, world};
use glint_core::mesh::Mesh;
use glint_model::setup::{Facing, Oriented};
use glint_model::{Buffer, FrameSetup, Options, Projected, RenderError, SIZES, Target, render};

const SIZE: (u32, u32) = SIZES[0];

fn front() -> Camera {
    Camera::looking([3.0, 0.3, 0.2], [0.0; 3], 0.9, 0.1)
}

/// Triangles all over the cube of ±2, so that cameras inside it see them cross the near plane and the guard band.
fn soup(random: &mut Random, triangles: usize, reach: i64) -> Model {
    let mut corner = || [0; 3].map(|_| random.integer(-reach, reach - 1) as i16);
    Model::soup(
        &(0..triangles)
            .map(|_| [corner(), corner(), corner()])
            .collect::<Vec<_>>(),
    )
}

fn inside(random: &mut Random) -> Camera {
    let eye = [0; 3].map(|_| random.real(-1.0, 1.0));
    let (half_width, near) = (random.logarithmic(0.05, 4.0), random.logarithmic(0.01, 0.5));
    let towards = random.direction();
    Camera::aimed(random, eye, towards, [0.0; 2], half_width, near)
}

#[test]
fn a_sphere_is_a_disc_without_holes() {
    let sphere = Model::sphere(0.5, 24);
    for size in SIZES {
        let view = front().rounded();
        let picture = Picture::of(&sphere, &view, size, true);
        assert_eq!(
            picture.stats.drawn + picture.stats.culled,
            picture.stats.triangles_in
        );
        assert_eq!(picture.stats.clipped, 0);
        // Front faces do not overlap on a convex body: every covered pixel is drawn, once.
        assert_eq!(picture.stats.pixels_drawn, picture.covered() as u64);
        assert_eq!(picture.stats.pixels_covered, picture.stats.pixels_drawn);
        for row in picture.coverage().chunks(size.0 as usize) {
            let span: Vec<usize> = (0..row.len()).filter(|&i| row[i]).collect();
            assert!(span.windows(2).all(|pair| pair[1] == pair[0] + 1), "a hole");
        }
        // The disc of tangents from the eye, seen by 24 rings.
        let distance: f64 = (9.0f64 + 0.09 + 0.04).sqrt();
        let radius = f64::from(size.0) / 2.0 / 0.9 * 0.5 / (distance * distance - 0.25).sqrt();
        let disc = std::f64::consts::PI * radius * radius;
        assert!(
            (0.97..1.0).contains(&(picture.covered() as f64 / disc)),
            "{} of {disc}",
            picture.covered()
        );
        assert!(
            picture
                .colour
                .iter()
                .zip(&picture.depth)
                .all(|(&c, &d)| (d == 0) == (c == CLEAR))
        );
    }
}

/// Culling takes what would be behind; without it, the outline is the same and the picture too, as far as the depths decide.
#[test]
fn culling_and_windings() {
    let sphere = Model::sphere(0.5, 12);
    let view = front().rounded();
    let [culled, both] = [true, false].map(|cull| Picture::of(&sphere, &view, SIZE, cull));
    assert_eq!(
        both.stats.drawn + both.stats.culled,
        both.stats.triangles_in
    );
    assert!(culled.stats.drawn < both.stats.drawn);
    assert_eq!(culled.depth, both.depth);
    assert_eq!(culled.colour, both.colour);
    assert!(culled.drawn.iter().all(|t| t.facing == Facing::Front));

    // Turned inside out with its normals, the far side shows, and shading negates them.
    let inverted = Picture::of(&sphere.flipped(), &view, SIZE, true);
    assert_eq!(inverted.coverage(), culled.coverage());
    assert!(
        inverted
            .depth
            .iter()
            .zip(&culled.depth)
            .all(|(&far, &near)| near == 0 || far < near)
    );
    let far_sides: Vec<_> = both
        .drawn
        .iter()
        .filter(|t| t.facing == Facing::Back)
        .map(|t| (t.index, t.colour))
        .collect();
    assert_eq!(
        far_sides,
        inverted
            .drawn
            .iter()
            .map(|t| (t.index, t.colour))
            .collect::<Vec<_>>()
    );
}

/// Where depths are equal the later triangle wins.
#[test]
fn ties_go_to_the_later() {
    let triangle = [[0, -8000, -8000], [0, 8000, -8000], [0, 0, 8000]];
    let view = front().rounded();
    let once = Picture::of(&Model::soup(&[triangle]), &view, SIZE, true);
    assert!(once.covered() > 1000);
    for copies in 2..5 {
        let picture = Picture::of(&Model::soup(&vec![triangle; copies]), &view, SIZE, true);
        let last = picture.drawn.last().unwrap().colour.0;
        assert_eq!(picture.depth, once.depth);
        assert_eq!(picture.stats.pixels_drawn, (once.covered() * copies) as u64);
        assert!(
            picture
                .colour
                .iter()
                .zip(&picture.depth)
                .all(|(&c, &d)| c == if d == 0 { CLEAR } else { last })
        );
    }
}

/// Without ties the order does not matter, and exceptions are drawn after all others.
#[test]
fn order() {
    let mut random = Random(1);
    let mut parts = 0;
    for _ in 0..20 {
        let camera = inside(&mut random);
        let view = camera.rounded();
        let model = soup(&mut random, 40, 32768);
        let mut reversed = model.clone();
        reversed.triangles.reverse();
        let [forwards, backwards] = [&model, &reversed].map(|m| Picture::of(m, &view, SIZE, false));
        assert_eq!(forwards.depth, backwards.depth);
        let regular = forwards.drawn.iter().take_while(|t| !t.clipped).count();
        let (regular, exceptions) = forwards.drawn.split_at(regular);
        assert!(regular.windows(2).all(|pair| pair[0].index < pair[1].index));
        assert!(
            exceptions.iter().all(|t| t.clipped)
                && exceptions
                    .windows(2)
                    .all(|pair| pair[0].index <= pair[1].index)
        );
        parts += exceptions.len();
    }
    assert!(parts > 100, "{parts}");
}

/// Triangles across the near plane and beyond the guard band look the same whichever vertex they name first.
#[test]
fn clipping_does_not_depend_on_the_first_vertex() {
    let mut random = Random(2);
    let mut clipped = 0;
    for _ in 0..100 {
        let view = inside(&mut random).rounded();
        let model = soup(&mut random, 6, 32768);
        let pictures =
            [0, 1, 2].map(|turns| Picture::of(&model.rotated(turns), &view, SIZE, false));
        clipped += pictures[0].stats.clipped;
        for other in &pictures[1..] {
            assert_eq!(other.coverage(), pictures[0].coverage());
            assert_eq!(other.stats.clipped, pictures[0].stats.clipped);
            let exceptions = |p: &Picture| {
                p.drawn
                    .iter()
                    .filter(|t| t.clipped)
                    .copied()
                    .collect::<Vec<_>>()
            };
            let (mine, theirs) = (exceptions(&pictures[0]), exceptions(other));
            // Their colours too: normals are made from the vertices, in f64, and shift with the order by a rounding at most.
            assert_eq!(mine.len(), theirs.len());
            assert!(
                mine.iter()
                    .zip(&theirs)
                    .all(|(a, b)| a.vertices == b.vertices && a.facing == b.facing)
            );
        }
    }
    assert!(clipped > 200, "{clipped}");
}

/// From inside a closed mesh, whatever the near plane and the guard band cut, no pixel is missed, and away from the near
/// plane none is drawn twice by neighbours.
#[test]
fn from_inside_every_pixel_is_covered() {
    let mut random = Random(3);
    let (mut clipped, mut twice, mut pixels) = (0, 0, 0);
    for round in 0..60 {
        let model = if round % 2 == 0 {
            Model::cube(32767)
        } else {
            Model::sphere(1.9, 7)
        };
        let mut camera = inside(&mut random);
        camera.eye = camera.eye.map(|x| x * 0.6);
        // The near plane must not reach the walls: a corner of the picture may be far from its centre.
        camera.near = 0.01;
        camera.half_width = camera.half_width.min(2.0);
        let size = SIZES[round % 3];
        let picture = Picture::of(&model.flipped(), &camera.rounded(), size, true);
        assert_eq!(picture.covered(), picture.depth.len(), "round {round}");
        clipped += picture.stats.clipped;
        twice += picture.stats.pixels_covered - picture.depth.len() as u64;
        pixels += picture.depth.len();
    }
    println!("{clipped} triangles clipped, {twice} of {pixels} pixels covered twice");
    assert!(clipped > 200);
    // Rounding bends a cut edge by half a subpixel; nothing else may overlap.
    assert!(twice < pixels as u64 / 100_000, "{twice}");
}

/// The cuts are where they should be: a plane square across the near plane ends at its horizon, and its depths are right.
#[test]
fn the_near_plane_cuts_where_it_is() {
    // The floor z = −0.25 from an eye above it, looking along it.
    let floor = Model {
        positions: vec![
            [-32768, -32768, -4096],
            [32767, -32768, -4096],
            [32767, 32767, -4096],
            [-32768, 32767, -4096],
        ],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
    };
    for near in [0.01, 0.1, 0.5, 1.0] {
        for size in SIZES {
            let camera = Camera {
                eye: [0.0; 3],
                u: [1.0, 0.0, 0.0],
                v: [0.0, 0.0, -1.0],
                n: [0.0, 1.0, 0.0],
                half_width: 0.9,
                near,
            };
            let view = camera.rounded();
            let picture = Picture::of(&floor, &view, size, true);
            assert_eq!(picture.stats.clipped, 2);
            let frame = FrameSetup::new(&view, size.0, size.1, 56_756).unwrap();
            let (w, h) = (f64::from(size.0), f64::from(size.1));
            let scale = w / 2.0 / 0.9;
            let mut seen = 0;
            for (pixel, &code) in picture.depth.iter().enumerate() {
                let (x, y) = (
                    (pixel % size.0 as usize) as f64 + 0.5,
                    (pixel / size.0 as usize) as f64 + 0.5,
                );
                let z = 0.25 * scale / (y - h / 2.0);
                let across = (x - w / 2.0) / scale * z;
                // Half a subpixel from the border either is right.
                let rows_off = (y - h / 2.0 - 0.25 * scale / near)
                    .abs()
                    .min((y - h / 2.0 - 0.125 * scale).abs());
                let border = rows_off < 0.01 || (across.abs() - 2.0).abs() < 0.01 * z / scale;
                let expected = y > h / 2.0 && z >= near && z <= 2.0 && across.abs() < 2.0;
                assert!(
                    border || expected == (code != 0),
                    "{x}, {y} at {near}: {code}"
                );
                if let Some(found) = frame.depth.distance(code) {
                    let (found, slope) =
                        (found.to_num::<f64>(), 0.25 * scale / (y - h / 2.0).powi(2));
                    // A code, and half a subpixel along the slope.
                    let tolerance = z / f64::from(code) + slope / 256.0;
                    assert!((found - z).abs() <= tolerance, "{found} for {z}");
                    seen += 1;
                }
            }
            assert!(seen > 500, "{seen}");
        }
    }
}

/// A vertex in the eye itself, on the near plane, and triangles seen edge on.
#[test]
fn apex_at_the_eye() {
    let camera = |near| Camera {
        eye: [0.0; 3],
        u: [1.0, 0.0, 0.0],
        v: [0.0, 0.0, -1.0],
        n: [0.0, 1.0, 0.0],
        half_width: 0.9,
        near,
    };
    let far = [
        [-8000, 16000, -6000],
        [8000, 16000, -6000],
        [0, 16000, 7000],
    ];
    // A pyramid with its tip in the eye covers what its base covers, but for slivers of half a subpixel.
    let base = Picture::of(&Model::soup(&[far]), &camera(0.01).rounded(), SIZE, false);
    let tip = [0, 0, 0];
    let sides: Vec<_> = (0..3).map(|i| [tip, far[i], far[(i + 1) % 3]]).collect();
    let edge_on = Picture::of(&Model::soup(&sides), &camera(0.01).rounded(), SIZE, false);
    assert_eq!(edge_on.stats.clipped, 3);
    assert!(edge_on.covered() < 20, "{}", edge_on.covered());
    assert!(base.covered() > 2000);
    // Exactly on the near plane is not behind.
    let on = [[-8000, 8192, -6000], [8000, 8192, -6000], [0, 8192, 7000]];
    let [at, beyond] = [0.5, 0.500_01]
        .map(|near| Picture::of(&Model::soup(&[on]), &camera(near).rounded(), SIZE, false));
    assert_eq!((at.stats.drawn, at.stats.clipped), (1, 0));
    assert_eq!(
        (beyond.stats.drawn, beyond.stats.clipped, beyond.covered()),
        (0, 0, 0)
    );
    // The nearest depth there is gives the largest code.
    assert!(
        at.depth
            .iter()
            .all(|&code| code == 0 || (262_139..=262_141).contains(&code))
    );
}

/// Triangles that reach far over the guard band cover what they cover without it.
#[test]
fn the_guard_band_cuts_nothing_visible() {
    let mut random = Random(4);
    let mut clipped = 0;
    for _ in 0..40 {
        let mut camera = inside(&mut random);
        camera.eye = [0.0, -1.2, 0.0];
        (camera.u, camera.v, camera.n) = ([1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]);
        camera.half_width = 0.05;
        // About 3,000 pixels a unit: most corners are thousands of pixels outside.
        let mut triangle = [[0; 3]; 3].map(|_: [i16; 3]| {
            [0, 1, 2].map(|k| random.integer(-32768, 32767) as i16 / [1, 4, 1][k])
        });
        triangle[0] = [
            random.integer(-800, 800) as i16,
            0,
            random.integer(-400, 400) as i16,
        ];
        let view = camera.rounded();
        let picture = Picture::of(&Model::soup(&[triangle]), &view, SIZE, false);
        clipped += picture.stats.clipped;
        let corners = triangle.map(|p| Camera::of(&view).project(world(p), SIZE.0, SIZE.1));
        let area = |a: [f64; 3], b: [f64; 3], [x, y]: [f64; 2]| {
            (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])
        };
        let sign = area(corners[0], corners[1], [corners[2][0], corners[2][1]]).signum();
        for (pixel, &code) in picture.depth.iter().enumerate() {
            let place = [(pixel % 320) as f64 + 0.5, (pixel / 320) as f64 + 0.5];
            let distance = (0..3)
                .map(|i| {
                    let (a, b) = (corners[i], corners[(i + 1) % 3]);
                    sign * area(a, b, place) / (b[0] - a[0]).hypot(b[1] - a[1])
                })
                .fold(f64::INFINITY, f64::min);
            assert!(
                distance.abs() < 3.0 / 256.0 || (distance > 0.0) == (code != 0),
                "{distance} at {place:?}"
            );
        }
    }
    assert!(clipped >= 30, "{clipped}");
}

/// A mesh in two chunks gives the same picture as the same triangles in one.
#[test]
fn chunks() {
    let mut random = Random(5);
    let positions: Vec<[i16; 3]> = (0..3000)
        .map(|_| [0; 3].map(|_| random.integer(-20_000, 20_000) as i16))
        .collect();
    let triangles: Vec<[u32; 3]> = (0..22_000)
        .map(|_| [0; 3].map(|_| random.integer(0, 2999) as u32))
        .collect();
    let apart: Vec<_> = triangles
        .iter()
        .map(|t| t.map(|i| positions[i as usize]))
        .collect();
    let [one, two] = [
        Model {
            positions,
            triangles,
        },
        Model::soup(&apart),
    ]
    .map(|model| model.encoded());
    assert_eq!(
        [&one, &two].map(|bytes| Mesh::new_checked(bytes).unwrap().chunks().count()),
        [1, 2]
    );
    let view = Camera::looking([0.1, 0.1, 0.0], [0.0, 0.0, 0.1], 0.3, 0.02).rounded();
    let [one, two] = [one, two].map(|bytes| Picture::of_bytes(&bytes, &view, SIZE, true));
    assert!(one == two, "{:?} {:?}", one.stats, two.stats);
    let clipped = |indices: std::ops::Range<u32>| {
        one.drawn
            .iter()
            .any(|t| t.clipped && indices.contains(&t.index))
    };
    assert!(clipped(0..21_000) && clipped(21_900..22_000));
}

/// The same camera and mesh give the same bits, and a used scratch and target do not matter.
#[test]
fn frames_do_not_depend_on_what_was_before() {
    let bytes = Model::sphere(0.5, 9).encoded();
    let mesh = Mesh::new_checked(&bytes).unwrap();
    let mut scratch = vec![Projected::Behind; 5000];
    let mut used = Picture::blank(SIZE);
    for i in 0..4 {
        let camera = Camera::looking([2.0, 0.5 * f64::from(i), 0.3], [0.0; 3], 0.9, 0.1);
        let options = Options {
            cull: i % 2 == 0,
            clear: CLEAR,
        };
        let stats = render(
            &mesh,
            &camera.rounded(),
            &mut used.target(),
            &mut scratch,
            &options,
        )
        .unwrap();
        let fresh = Picture::of_bytes(&bytes, &camera.rounded(), SIZE, options.cull);
        assert_eq!(
            (&used.colour, &used.depth, stats),
            (&fresh.colour, &fresh.depth, fresh.stats)
        );
    }
}

#[test]
fn what_does_not_fit_is_refused() {
    let bytes = Model::cube(8000).encoded();
    let mesh = Mesh::new_checked(&bytes).unwrap();
    let view = front().rounded();
    let refuse = |(width, height): (u32, u32), colours: usize, depths: usize, room: usize| {
        let (mut colour, mut depth) = (vec![7; colours], vec![7; depths]);
        let mut target = Target {
            width,
            height,
            colour: &mut colour,
            depth: &mut depth,
        };
        let result = render(
            &mesh,
            &view,
            &mut target,
            &mut vec![Projected::Behind; room],
            &Options::default(),
        );
        let untouched = colour.iter().all(|&c| c == 7) && depth.iter().all(|&d| d == 7);
        assert_eq!(untouched, result.is_err());
        result.map_err(|error| (error, error.to_string()))
    };
    let pixels = 320 * 180;
    assert!(refuse(SIZE, pixels, pixels, 8).is_ok());
    for (size, colours, depths, room, error, text) in [
        (
            (320, 240),
            76_800,
            76_800,
            8,
            RenderError::Size {
                width: 320,
                height: 240,
            },
            "picture size 320x240: expected 320x180, 640x360, 1280x720",
        ),
        (
            (0, 0),
            0,
            0,
            8,
            RenderError::Size {
                width: 0,
                height: 0,
            },
            "picture size 0x0: expected 320x180, 640x360, 1280x720",
        ),
        (
            SIZE,
            pixels - 1,
            pixels,
            8,
            RenderError::Buffer {
                buffer: Buffer::Colour,
                expected: pixels,
                found: pixels - 1,
            },
            "colour buffer of 57599 pixels: expected 57600, the picture's width times its height",
        ),
        (
            SIZE,
            pixels,
            pixels + 1,
            8,
            RenderError::Buffer {
                buffer: Buffer::Depth,
                expected: pixels,
                found: pixels + 1,
            },
            "depth buffer of 57601 pixels: expected 57600, the picture's width times its height",
        ),
        (
            SIZE,
            pixels,
            pixels,
            7,
            RenderError::Scratch {
                expected: 8,
                found: 7,
            },
            "scratch for 7 vertices: expected at least 8, as the largest chunk has",
        ),
    ] {
        assert_eq!(
            refuse(size, colours, depths, room),
            Err((error, text.into()))
        );
    }
    assert_eq!(
        FrameSetup::new(&view, 1, 1, 0),
        Err(RenderError::Size {
            width: 1,
            height: 1
        })
    );
}

/// Anything a checked mesh may hold, from anywhere a camera may be: no overflow, no panic, and every drawn triangle in its widths.
#[test]
fn anything_goes() {
    let mut random = Random(6);
    let mut clipped = 0;
    for round in 0..400 {
        let reach = [32768, 8192, 64][round % 3];
        let mut model = soup(&mut random, 24, reach);
        if round % 5 == 0 {
            model
                .positions
                .iter_mut()
                .for_each(|p| *p = p.map(|x| if x < 0 { i16::MIN } else { i16::MAX }));
        }
        let distance = random.real(0.0, 7.999);
        let half_width = [0.05, 4.0, random.logarithmic(0.05, 4.0)][round % 3];
        let near = [0.01, 2.0, random.logarithmic(0.01, 2.0)][round / 3 % 3];
        let eye = random.direction().map(|x| x * distance);
        let towards = random.direction();
        let camera = Camera::aimed(&mut random, eye, towards, [0.0; 2], half_width, near);
        let picture = Picture::of(
            &model,
            &camera.rounded(),
            SIZES[usize::from(round % 20 == 0) * 2],
            false,
        );
        clipped += picture.stats.clipped;
        for triangle in &picture.drawn {
            let limit = if triangle.clipped {
                2048 << 8
            } else {
                2047 << 8
            };
            assert!(
                triangle.vertices.iter().all(|v| v.x.abs() <= limit
                    && v.y.abs() <= limit
                    && v.w < ((1 << 18) - 3) * 64)
            );
            assert_eq!(
                Oriented::new(triangle.vertices).unwrap().facing,
                Facing::Back
            );
        }
    }
    assert!(clipped > 1000, "{clipped}");
}
