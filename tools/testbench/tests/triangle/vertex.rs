//! Compares the vertex stage with the model.

use glint_core::camera::Projection;
use glint_model::triangle::vertex::{project, transform};
use glint_model::{MeshSetup, Projected, SIZES, ScreenVertex};
use glint_testbench::{Bits, Layout, Module, Pipe, Record};
use glint_vectors::{Camera, Random};

/// Computes the vertex stage's expected output with the model; x and y are saturated to s12.8.
fn expected(layout: &Layout, frame: &MeshSetup, position: [i16; 3]) -> Record {
    let projected = project(frame, &transform(frame, position));
    let ScreenVertex { x, y, w } = projected.place().copied().unwrap_or_default();
    let [x, y] = [x, y].map(|x| x.clamp(-1 << 19, (1 << 19) - 1));
    layout
        .record()
        .with("place.x", x)
        .with("place.y", y)
        .with("place.w", w)
        .with("beyond", projected.is_beyond_guard())
        .with("behind", projected == Projected::Behind)
}

fn set_frame(module: &mut Module, frame: &MeshSetup) {
    let is_orthographic = frame.projection == Projection::Orthographic;
    module.drive("orthographic", is_orthographic);
    module.drive("scale_shift", frame.engine_shift());
    module.drive_all("row_u", frame.u);
    module.drive_all("row_v", frame.v);
    module.drive_all("row_n", frame.n);
    for (name, value) in ["tx", "ty", "tz"].into_iter().zip(frame.translation) {
        module.drive(name, value);
    }
    module.drive("near_z", frame.near);
    module.drive("centre_x", frame.width / 2);
    module.drive("centre_y", frame.height / 2);
    module.drive("depth_mantissa", frame.depth.mantissa);
    module.drive("depth_exponent", frame.depth.exponent);
}

struct Bench {
    pipe: Pipe,
    /// Type of a vertex at the module's output.
    vertex: Layout,
}

impl Bench {
    fn new(seed: u32, stalls: [f64; 2]) -> Self {
        let (input, output) = (("in", &["position"][..]), ("out", &["vertex"][..]));
        let pipe = Pipe::new("vertex_stage", seed, input, output, stalls);
        let vertex = pipe.module.record("out_vertex").layout().clone();
        Self { pipe, vertex }
    }

    /// Sends the vertices of a frame through the vertex stage, compares the results and returns the number of clocks.
    fn check(&mut self, frame: &MeshSetup, positions: &[[i16; 3]]) -> u64 {
        set_frame(&mut self.pipe.module, frame);
        for position in positions {
            self.pipe.source.push(vec![Bits::pack(16, *position)]);
        }
        let limit = 1000 + 200 * positions.len() as u64;
        let is_done = |pipe: &Pipe| pipe.sink.items().len() == positions.len();
        let clocks = self.pipe.run(limit, is_done);
        self.pipe.module.clock();
        for (&position, item) in positions.iter().zip(self.pipe.sink.take()) {
            let expected = expected(&self.vertex, frame, position);
            assert_eq!(item[0], expected.bits(), "{position:?} in {frame:?}");
        }
        clocks
    }
}

/// Makes a random camera at a distance up to 8 that looks at a point of the mesh, or in any direction.
fn camera(random: &mut Random, round: u32) -> Camera {
    let half_width = match round % 8 {
        0 => 0.05,
        1 => 4.0,
        2 => 0.0088,
        3 => 114.0,
        _ => random.logarithmic(0.05, 4.0),
    };
    // A narrow field of view needs a farther near plane.
    let nearest = if round % 8 == 2 { 0.0625 } else { 0.01 };
    let near = match round % 6 {
        0 => nearest,
        1 => 2.0,
        _ => random.logarithmic(nearest, 2.0),
    };
    let distance = if random.coin() {
        7.999
    } else {
        random.real(0.0, 8.0)
    };
    let eye = random.direction().map(|x| x * distance);
    let towards = if round.is_multiple_of(3) {
        random.direction()
    } else {
        eye.map(|x| random.real(-1.0, 1.0) - x)
    };
    let place = [0; 2].map(|_| random.real(-half_width, half_width));
    Camera::aimed(random, eye, towards, place, half_width, near)
}

fn position(random: &mut Random) -> [i16; 3] {
    let reach = [1 << 15, 1 << 13, 4][(random.bits() % 8).saturating_sub(5) as usize];
    [0; 3].map(|_| random.integer(-reach, reach - 1) as i16)
}

/// Index of a vertex's kind: 0 nearer than the near plane, 1 beyond the guard band, 2 visible.
fn kind(frame: &MeshSetup, position: [i16; 3]) -> usize {
    match project(frame, &transform(frame, position)) {
        Projected::Behind => 0,
        Projected::BeyondGuard(_) => 1,
        Projected::Visible(_) => 2,
    }
}

const RADIUS: u32 = 56_756;

#[test]
fn random_cameras_and_vertices() {
    let mut random = Random(1);
    let shares = [[0.0, 0.0], [0.5, 0.5], [0.0, 0.95], [0.95, 0.0]];
    let mut benches = [0, 1, 2, 3].map(|seed| Bench::new(seed, shares[seed as usize]));
    let mut seen = [0; 3];
    for round in 0..600 {
        let (width, height) = SIZES[round as usize % 3];
        let projection = Projection::ALL[round as usize / 4 % 2];
        let view = camera(&mut random, round)
            .rounded()
            .with_projection(projection);
        let radius = if random.coin() { RADIUS } else { 14_190 };
        let frame = MeshSetup::new(&view, width, height, radius).unwrap();
        let positions: Vec<_> = (0..60).map(|_| position(&mut random)).collect();
        for &position in &positions {
            seen[kind(&frame, position)] += 1;
        }
        benches[round as usize % 4].check(&frame, &positions);
    }
    println!("behind, beyond the guard band, visible: {seen:?}");
    assert!(seen.iter().all(|&count| count > 2000));
}

/// Tests frame constants whose near plane, depth scale or translation puts a vertex at a limit.
#[test]
fn edges() {
    let mut random = Random(2);
    let mut bench = Bench::new(7, [0.1, 0.1]);
    let (mut near_planes, mut guard_edges, mut full_depths) = (0, 0, 0);
    for round in 0..1200 {
        let (width, height) = SIZES[round as usize % 3];
        let view = camera(&mut random, round).rounded();
        let mut frame = MeshSetup::new(&view, width, height, RADIUS).unwrap();
        let least = frame.near.min(1 << 36);
        let at = position(&mut random);
        let z = transform(&frame, at).z;

        // Puts the near plane at the vertex, 1 ulp nearer and farther, and at larger distances from
        // the vertex.
        if (least + 1..1 << 38).contains(&z) {
            near_planes += 1;
            for off in [-1, 0, 1, -(1 << 20), 1 << 20] {
                let near = frame.near;
                frame.near = z + off;
                bench.check(&frame, &[at]);
                frame.near = near;
            }
        }
        if z < frame.near {
            continue;
        }

        // Scales depths to put the vertex's depth w at or near its limit.
        let depth = frame.depth;
        for exponent in -5..=5 {
            frame.depth.exponent = exponent;
            frame.depth.mantissa = random.integer(1 << 16, (1 << 17) - 1) as u32;
            full_depths +=
                u32::from(expected(&bench.vertex, &frame, at).get("place.w") == 0xFF_FFC0);
            bench.check(&frame, &[at]);
        }
        frame.depth = depth;

        // Chooses a translation that puts x or y of the vertex near an end of the guard band.
        let axis = random.integer(0, 1) as usize;
        let side = if random.coin() { 1 } else { -1 };
        let centre = [width, height][axis] as i64 / 2;
        let place = side * 2047 * 256 - 256 * centre;
        // Solves x = X·2^(31 − f)/Z for X: x in 1/256 pixel from the centre, X and Z in camera coordinates, and
        // f = `scale_shift`.
        let wanted = ((i128::from(place) * i128::from(z)) >> (31 - frame.scale_shift)) as i64;
        let vertex = transform(&frame, at);
        let translation = frame.translation;
        let unit = (z >> (31 - frame.scale_shift)).max(1);
        for steps in -3..=3 {
            let offset = steps * unit / 2 + wanted - [vertex.x, vertex.y][axis];
            frame.translation[axis] = translation[axis] + offset;
            if frame.translation[axis].unsigned_abs() >= 1 << 42 {
                continue;
            }
            let edge = expected(&bench.vertex, &frame, at).signed(["place.x", "place.y"][axis])
                - side * 2047 * 256;
            guard_edges += u32::from(edge.abs() <= 2);
            bench.check(&frame, &[at]);
        }
        // With the largest translations, the screen position and its intermediate result X' (docs/formats/triangle.md) saturate.
        for far in [(1 << 42) - 1, -(1 << 42), 1 << 41] {
            frame.translation[axis] = far;
            bench.check(&frame, &[at]);
        }
    }
    println!(
        "near planes {near_planes}, edges of the guard band {guard_edges}, full depths {full_depths}"
    );
    assert!(near_planes > 100 && guard_edges > 1000 && full_depths > 100);
}

/// Tests frame constants in orthographic projection that put a vertex at a limit: at the near plane, at the guard band, and on
/// both sides of a rounding limit of depth and position, for every depth scale and scale shift.
#[test]
fn orthographic_edges() {
    let mut random = Random(6);
    let mut bench = Bench::new(11, [0.1, 0.1]);
    let view = camera(&mut random, 4).rounded();
    let view = view.with_projection(Projection::Orthographic);
    let (mut scales, mut seen) = ([[false; 12]; 12], [0; 3]);
    for round in 0..6000 {
        let (width, height) = SIZES[round % 3];
        let mut frame = MeshSetup::new(&view, width, height, RADIUS).unwrap();
        frame.depth.exponent = random.integer(-6, 5) as i32;
        frame.near = 4 << (18 + frame.depth.exponent);
        frame.scale_shift = random.integer(7, 18) as u32;
        scales[(frame.depth.exponent + 6) as usize][frame.scale_shift as usize - 7] = true;
        let range = 1_i64 << (36 + frame.depth.exponent);
        let unit = 1_i64 << (12 + frame.depth.exponent);
        let z = match round / 3 % 4 {
            0 => frame.near + random.integer(-1, 1) * random.integer(0, unit),
            1 => range - random.integer(1, 200 * unit),
            2 => random.integer(1, (1 << 24) - 1) * unit + random.integer(-1, 1),
            _ => random.integer(frame.near, range - 1),
        };
        // Positions near midpoints of the grid of 1/256 pixel: inside the picture, at the ends of the guard band, and far beyond.
        let pixel = 1_i64 << (6 + frame.scale_shift);
        let mut place = |size: u32| {
            let centre = 256 * i64::from(size) / 2;
            let whole = match round / 12 % 4 {
                0 => 2047 * 256 - centre + random.integer(-2, 2),
                1 => -2047 * 256 - centre + random.integer(-2, 2),
                2 => (1 << 20) * [1, -1][round % 2] + random.integer(-2, 2),
                _ => random.integer(-1 << 18, 1 << 18),
            };
            let x = whole * pixel + pixel / 2 + random.integer(-1, 1);
            x.clamp(-1 << 42, (1 << 42) - 1)
        };
        frame.translation = [place(width), place(height), z];
        seen[kind(&frame, [0; 3])] += 1;
        bench.check(&frame, &[[0; 3]]);
    }
    println!("behind, beyond the guard band, visible: {seen:?}");
    assert!(scales == [[true; 12]; 12] && seen.iter().all(|&count| count > 300));
}

/// A vertex at the origin has the translation as camera coordinates. The tested translations cover mantissas of Z at both ends of
/// each seed interval (table entry) of the reciprocal, and X' (docs/formats/triangle.md) on both sides of rounding limits.
#[test]
fn mantissas_and_shifts() {
    let mut random = Random(4);
    let mut bench = Bench::new(9, [0.0, 0.0]);
    let view = camera(&mut random, 0).rounded();
    let mut seen = [false; 19];
    for round in 0..3072 {
        let (width, height) = SIZES[round as usize % 3];
        let mut frame = MeshSetup::new(&view, width, height, RADIUS).unwrap();
        // The smallest accepted distance of the near plane: 0.01 with 37 fraction bits.
        frame.near = 1_374_389_535;
        let seed = round / 4 % 256;
        let mantissa =
            (1 << 23) + (seed << 15) + [0, 1, (1 << 15) - 1, 1 << 14][round as usize % 4];
        let lead = random.integer(30, 40);
        // The bits of Z below the mantissa are all zeros, all ones, or random.
        let below = (1 << (lead - 23)) - 1;
        let z = mantissa << (lead - 23)
            | [0, below, random.bits() as i64 & below][round as usize / 1024];
        frame.scale_shift = random.integer(10, 18) as u32;
        frame.depth.exponent = random.integer(-5, 5) as i32;
        let shift = frame.scale_shift as usize + lead as usize - 34;
        seen[shift - 6] = true;
        let mut limit = || {
            let half = 1 << (shift - 1);
            let whole = [(1 << 24) - 1, 1 << 24, random.integer(0, 1 << 24)];
            let x = (whole[random.integer(0, 2) as usize] << shift) + half + random.integer(-1, 0);
            (if random.coin() { x } else { -x }).clamp(-1 << 42, (1 << 42) - 1)
        };
        frame.translation = [limit(), limit(), z];
        bench.check(&frame, &[[0; 3]]);
    }
    assert_eq!(seen, [true; 19]);
}

#[test]
fn a_vertex_in_six_clocks() {
    let mut random = Random(3);
    let view = camera(&mut random, 2).rounded();
    let frame = MeshSetup::new(&view, 640, 360, RADIUS).unwrap();
    let positions: Vec<_> = (0..200).map(|_| position(&mut random)).collect();
    let clocks = Bench::new(5, [0.0, 0.0]).check(&frame, &positions);
    assert!(clocks <= 6 * 200 + 45, "{clocks} clocks");
}
