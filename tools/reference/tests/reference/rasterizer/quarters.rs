//! Checks the samples of pictures that are drawn in quarters, 2560×1440 in all, against the exact rasterizer in the whole picture: a seam
//! between the quarters would be a difference.

use glint_core::colour::Rgb565;
use glint_core::mesh::Mesh;
use glint_core::picture::{Quarter, Samples, Size, Window};
use glint_model::triangle::raster;
use glint_model::triangle::setup::Setup;
use glint_model::triangle::vertex::{project, transform};
use glint_model::{Frame, MeshSubject, Projected, ScreenVertex, Subject};
use glint_reference::triangle::exact::{ExactTriangle, SnappedVertex};
use glint_vectors::Picture;
use glint_vectors::picture::CLEAR;
use glint_vectors::triangles::set_up;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

use super::cameras::{direction, log_range, looking_at};
use super::coverage::DEPTH_LIMIT;
use super::scenes::{Scene, spread};

const COLOUR: Rgb565 = Rgb565(0xFFFF);
/// Steps of a vertex per sample.
const STEPS: i32 = 256;
/// Samples of a quarter.
const SIZE: (u32, u32) = (1280, 720);
/// Column and line of the middle of the picture.
const MIDDLE: [i32; 2] = [1280, 720];

/// The samples of the four quarters.
struct Quarters([Picture; 4]);

/// What was compared.
#[derive(Clone, Copy, Debug, Default)]
struct Tally {
    /// Covered samples.
    covered: u64,
    /// Triangles without a sample.
    empty: u64,
    /// Triangles with samples in more than one quarter.
    divided: u64,
}

fn snapped(vertex: ScreenVertex) -> SnappedVertex {
    SnappedVertex {
        x: vertex.x.into(),
        y: vertex.y.into(),
        w: vertex.w.into(),
    }
}

fn origin(quarter: Quarter) -> [i32; 2] {
    let window = Window {
        size: Size::W1280,
        quarter: Some(quarter),
    };
    window.origin().map(|place| place as i32)
}

impl Quarters {
    fn new() -> Self {
        Self([(); 4].map(|()| Picture::blank(SIZE)))
    }

    /// Draws the setups of a triangle, one for each quarter, compares all samples near it with the exact rasterizer, and clears them. The
    /// vertices are those in the whole picture.
    fn check(
        &mut self,
        vertices: [ScreenVertex; 3],
        setups: [Option<Setup>; 4],
        tally: &mut Tally,
    ) {
        for (picture, setup) in self.0.iter_mut().zip(&setups) {
            if let Some(setup) = setup {
                raster::draw(setup, COLOUR, &mut picture.target());
            }
        }
        let exact = ExactTriangle::new(vertices.map(snapped));
        let range = |axis: usize| {
            let places = vertices.map(|vertex| [vertex.x, vertex.y][axis].div_euclid(STEPS));
            let [a, b, c] = places.map(|place| place.clamp(-1, 2 * MIDDLE[axis]));
            let (first, last) = (a.min(b).min(c) - 1, a.max(b).max(c) + 1);
            first.max(0)..last.min(2 * MIDDLE[axis] - 1) + 1
        };
        let mut covered = [0; 4];
        for y in range(1) {
            for x in range(0) {
                let number = usize::from(x >= MIDDLE[0]) + 2 * usize::from(y >= MIDDLE[1]);
                let place = (y % MIDDLE[1] * MIDDLE[0] + x % MIDDLE[0]) as usize;
                let picture = &mut self.0[number];
                let code = std::mem::take(&mut picture.depth[place]);
                let colour = std::mem::replace(&mut picture.colour[place], CLEAR);
                let (column, row) = (x.into(), y.into());
                let expected = exact.as_ref().filter(|exact| exact.covers(column, row));
                let is_right = match expected {
                    Some(exact) => {
                        covered[number] += 1;
                        let error = exact.depth(column, row).error_of(code).abs();
                        colour == COLOUR.0 && error <= DEPTH_LIMIT
                    }
                    None => colour == CLEAR && code == 0,
                };
                assert!(is_right, "({x}, {y}) of {vertices:?}: {code}, {expected:?}");
            }
        }
        tally.covered += covered.iter().sum::<u64>();
        tally.empty += u64::from(covered == [0; 4]);
        let with_samples = covered.iter().filter(|&&count| count > 0).count();
        tally.divided += u64::from(with_samples > 1);
    }

    /// Checks a triangle that is given by its vertices in the whole picture.
    fn check_vertices(&mut self, vertices: [ScreenVertex; 3], tally: &mut Tally) {
        let setups = Quarter::ALL.map(|quarter| {
            let [left, top] = origin(quarter).map(|place| STEPS * place);
            let vertices = vertices.map(|vertex| ScreenVertex {
                x: vertex.x - left,
                y: vertex.y - top,
                ..vertex
            });
            set_up(vertices, SIZE).map(|(_, setup)| setup)
        });
        self.check(vertices, setups, tally);
    }

    /// Whether all samples are clear: no triangle has drawn a sample far from it.
    fn are_clear(&self) -> bool {
        let is_clear = |picture: &Picture| {
            let is_cleared = |&colour: &u16| colour == CLEAR;
            picture.colour.iter().all(is_cleared) && picture.depth.iter().all(|&code| code == 0)
        };
        self.0.iter().all(is_clear)
    }
}

/// The vertices of the triangles of a scene in the picture of a frame's samples, `None` for a triangle that a quarter clips.
fn places(frame: &Frame, scene: &Scene) -> Vec<Option<[ScreenVertex; 3]>> {
    let setups: Vec<_> = (frame.parts())
        .map(|part| *part.constants().unwrap().mesh().unwrap())
        .collect();
    let place = |index: u32| {
        let position = scene.positions[index as usize];
        let mut places =
            setups
                .iter()
                .map(|setup| match project(setup, &transform(setup, position)) {
                    Projected::Visible(place) => Some(place),
                    Projected::BeyondGuard(_) | Projected::Behind => None,
                });
        // The first quarter begins at the beginning of the picture.
        let first = places.next()??;
        places.all(|place| place.is_some()).then_some(first)
    };
    let triangles = scene.triangles.iter();
    triangles
        .map(|indices| {
            let [a, b, c] = indices.map(place);
            Some([a?, b?, c?])
        })
        .collect()
}

/// Random frames with triangles about the middle of the picture, through the whole setup of frames.
#[test]
fn quarters_have_the_samples_of_the_whole_picture() {
    let mut random = Pcg64::seed_from_u64(1);
    let (mut quarters, mut tally) = (Quarters::new(), Tally::default());
    for number in 0..10_000 {
        let eye = direction(&mut random).map(|part| 2.0 * part);
        let roll = random.random_range(0.0..std::f64::consts::TAU);
        let camera = looking_at(eye, [0.0; 3], roll, 0.6, 0.1);
        let scene = spread(&mut random, 3, 0.1, [0.002, 0.15]);
        let bytes = scene.encode();
        let subject = MeshSubject {
            cull: false,
            ..MeshSubject::new(Mesh::new_checked(&bytes).unwrap())
        };
        let frame = Frame {
            samples: Samples::Four,
            ..Frame::new(Subject::Mesh(subject), camera.rounded(), Size::W1280)
        };
        let mut setups = vec![[const { None }; 4]; scene.triangles.len()];
        for (quarter, part) in frame.parts().enumerate() {
            let mut scratch = vec![Projected::Behind; part.scratch_vertices()];
            let constants = part.constants().unwrap();
            let made = part.set_up_meshes(&constants, &mut scratch, &mut |triangle, setup, _| {
                setups[triangle.index as usize][quarter] = Some(*setup);
            });
            made.unwrap();
        }
        for (vertices, setups) in places(&frame, &scene).into_iter().zip(setups) {
            if let Some(vertices) = vertices {
                quarters.check(vertices, setups, &mut tally);
            }
        }
        assert!(number % 1000 != 0 || quarters.are_clear());
    }
    println!("{tally:?}");
    assert!(quarters.are_clear());
    assert!(
        tally.covered > 10_000_000 && tally.divided > 1000,
        "{tally:?}"
    );
}

/// A vertex whose position is in steps of 1/256 sample from the middle of the picture. All have the same depth, because other depths would
/// be too steep in a sliver.
fn vertex([x, y]: [i32; 2]) -> ScreenVertex {
    ScreenVertex {
        x: STEPS * MIDDLE[0] + x,
        y: STEPS * MIDDLE[1] + y,
        w: 1 << 22,
    }
}

/// Triangles and their neighbours, with vertices at the centres of samples or on lines through them: each sample on the common edge belongs
/// to exactly one of the two.
#[test]
fn edges_through_samples_belong_to_one_triangle() {
    let mut random = Pcg64::seed_from_u64(2);
    let (mut quarters, mut tally) = (Quarters::new(), Tally::default());
    for _ in 0..2000 {
        let centre =
            |random: &mut Pcg64| [(); 2].map(|()| STEPS * random.random_range(-40..40) + STEPS / 2);
        // The edge passes through the centres of samples between its ends.
        let start = centre(&mut random);
        let (step, count) = ([(); 2].map(|()| random.random_range(-4..=4)), 8);
        let end = [0, 1].map(|axis: usize| start[axis] + count * STEPS * step[axis]);
        let [a, b] = [start, end].map(vertex);
        let aside = [
            centre(&mut random),
            [(); 2].map(|()| random.random_range(-10_000..10_000)),
        ];
        for place in aside {
            let c = vertex(place);
            for vertices in [[a, b, c], [b, a, c], [c, b, a]] {
                quarters.check_vertices(vertices, &mut tally);
            }
        }
        // The parallelogram of the edge and a vertex on each side.
        let [dx, dy] = [0, 1].map(|axis: usize| end[axis] - start[axis]);
        let beside = [start[0] - dy, start[1] + dx].map(|place| place + STEPS);
        let mirrored = [0, 1].map(|axis: usize| start[axis] + end[axis] - beside[axis]);
        let [c, d] = [beside, mirrored].map(vertex);
        let [first, second] =
            [[a, b, c], [b, a, d]].map(|vertices| ExactTriangle::new(vertices.map(snapped)));
        if let (Some(first), Some(second)) = (first, second) {
            for i in 1..count {
                let [x, y] = [0, 1].map(|axis: usize| {
                    i64::from(MIDDLE[axis] + (start[axis] - STEPS / 2) / STEPS + i * step[axis])
                });
                assert!(first.covers(x, y) != second.covers(x, y), "{x}, {y}");
            }
        }
        for vertices in [[a, b, c], [b, a, d]] {
            quarters.check_vertices(vertices, &mut tally);
        }
    }
    println!("{tally:?}");
    assert!(quarters.are_clear());
    assert!(
        tally.covered > 1_000_000 && tally.divided > 1000,
        "{tally:?}"
    );
}

/// Triangles up to 1500 samples long and narrower than a sample: some of them have no sample at all.
#[test]
fn slivers_have_the_samples_inside_them() {
    let mut random = Pcg64::seed_from_u64(3);
    let (mut quarters, mut tally) = (Quarters::new(), Tally::default());
    for number in 0..2000 {
        let reach = STEPS * if number % 10 == 0 { 500 } else { 20 };
        let mut place = || [(); 2].map(|()| random.random_range(-reach..reach));
        let [from, to] = [place(), place()];
        let along = f64::from(random.random_range(0..=4)) / 4.0;
        let width = log_range(&mut random, 1.0, f64::from(STEPS));
        let turn: f64 = random.random_range(0.0..std::f64::consts::TAU);
        let aside = [turn.cos(), turn.sin()].map(|part| (width * part).round() as i32);
        let third = [0, 1].map(|axis: usize| {
            from[axis] + (along * f64::from(to[axis] - from[axis])) as i32 + aside[axis]
        });
        let vertices = [from, to, third].map(vertex);
        quarters.check_vertices(vertices, &mut tally);
    }
    println!("{tally:?}");
    assert!(quarters.are_clear());
    assert!(tally.covered > 5000 && tally.empty > 100, "{tally:?}");
}
