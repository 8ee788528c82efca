//! Compares triangle setup, culling and shading with the model.

mod frame;

use glint_core::colour::Rgb565;
use glint_model::triangle::descriptor::{self, Descriptor};
use glint_model::triangle::setup::{Bounds, Facing, Oriented, Setup};
use glint_model::triangle::shade::{Light, Lit, intensity, lit};
use glint_model::{SIZES, ScreenVertex, Shading};
use glint_testbench::{Bits, Layout, Module, Pipe, Port, Record};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

use frame::{Frame, WHITE, frame};

/// Largest coordinate within the guard band, s12.8.
const GUARD: i32 = 2047 << 8;
/// Largest depth w, u18.6.
const NEAREST: u32 = ((1 << 18) - 1) << 6;

#[derive(Clone, Copy, Debug)]
struct Input {
    vertices: [ScreenVertex; 3],
    colour: u16,
    normal: [i16; 3],
    light: [Light; 3],
}

/// Types of a triangle's members at the module's ports.
struct Types {
    vertices: Layout,
    vertex: Layout,
    lights: Layout,
    light: Layout,
}

impl Types {
    fn of(module: &Module) -> Self {
        let port = |name| module.record(name).layout().clone();
        Self {
            vertices: port("in_vertices"),
            vertex: module.packed_type("triangle_pkg::screen_vertex_t").clone(),
            lights: port("in_light"),
            light: module.packed_type("triangle_pkg::light_t").clone(),
        }
    }

    /// Packs a vertex in screen coordinates.
    fn vertex(&self, vertex: ScreenVertex) -> Record {
        let record = self.vertex.record();
        record
            .with("x", vertex.x)
            .with("y", vertex.y)
            .with("w", vertex.w)
    }

    /// Packs the light of a vertex's visible side: of the back side if lit, else of the front side.
    fn light(&self, light: Light) -> Record {
        let back = light.back != Lit::default();
        let Lit([r, g, b]) = if back { light.back } else { light.front };
        let record = self.light.record().with("back", back);
        record.with("red", r).with("green", g).with("blue", b)
    }

    /// Packs a triangle for the input stream.
    fn item(&self, input: &Input, ability: Shading) -> Vec<Bits> {
        let mut vertices = self.vertices.record();
        let mut lights = self.lights.record();
        for (i, part) in ["[0]", "[1]", "[2]"].into_iter().enumerate() {
            vertices.set_bits(part, self.vertex(input.vertices[i]));
            if ability == Shading::Smooth {
                lights.set_bits(part, self.light(input.light[i]));
            }
        }
        let colour = Bits::from(u64::from(input.colour));
        let normal = Bits::pack(16, input.normal);
        vec![vertices.bits(), colour, normal, lights.bits()]
    }
}

/// Returns the two payloads (ports) of the expected descriptor; `None` for a culled triangle.
fn expected(frame: &Frame, input: &Input) -> Option<[Bits; 2]> {
    let oriented = Oriented::new(input.vertices)?;
    let facing = oriented.facing;
    let seen = if frame.mirror {
        facing.opposite()
    } else {
        facing
    };
    if frame.cull && seen == Facing::Back {
        return None;
    }
    let (width, height) = frame.size;
    let bounds = Bounds::new(&oriented.vertices, width, height)?;
    let colour = lit(
        Rgb565(input.colour),
        frame
            .light
            .shares(intensity(input.normal, &frame.light.row, seen)),
    );
    let setup = match frame.shading {
        Shading::Flat => Setup::new(&oriented, bounds),
        Shading::Smooth => {
            let lit = facing.order(input.light.map(|light| light.to(seen)));
            Setup::smooth(&oriented, bounds, &lit)
        }
    };
    let [first, _, planes] = Descriptor::new(&setup, colour, None)
        .words(descriptor::Layout::SMOOTH)
        .map(Bits::from_words);
    Some([first, planes])
}

struct Bench {
    pipe: Pipe,
    ability: Shading,
    busy: Port,
    culled: Port,
    drawn: Port,
}

impl Bench {
    fn new(ability: Shading, seed: u32, stalls: [f64; 2]) -> Self {
        let name = match ability {
            Shading::Flat => "setup",
            Shading::Smooth => "setup_smooth",
        };
        let input = ("in", &["vertices", "colour", "normal", "light"][..]);
        let output = ("out", &["descriptor", "planes"][..]);
        let pipe = Pipe::new(name, seed, input, output, stalls);
        let [busy, culled, drawn] = ["busy", "culled", "drawn"].map(|name| pipe.module.port(name));
        Self {
            pipe,
            ability,
            busy,
            culled,
            drawn,
        }
    }

    /// Sends the triangles of a frame through the setup, compares the descriptors and returns the number of
    /// clocks.
    fn check(&mut self, frame: &Frame, inputs: &[Input]) -> u64 {
        let module = &mut self.pipe.module;
        module.drive("width", frame.size.0);
        module.drive("height", frame.size.1);
        module.drive("cull_back", frame.cull);
        module.drive("mirror", frame.mirror);
        let light = &frame.light;
        module.drive_all("row_light", light.row);
        module.drive_all("light_colour", light.colour);
        module.drive_all("ambient", light.ambient);
        module.drive("smooth", frame.shading == Shading::Smooth);
        let planes_type = module.packed_type("records_pkg::planes_t").clone();
        let types = Types::of(module);
        for input in inputs {
            self.pipe.source.push(types.item(input, self.ability));
        }
        let (mut culled, mut drawn, mut all_taken) = (0, 0, inputs.is_empty());
        let (counted, busy) = ([self.culled, self.drawn], self.busy);
        let clocks = self.pipe.run(1000 + 500 * inputs.len() as u64, |pipe| {
            let [is_culled, is_drawn] = counted.map(|port| pipe.module.is_high(port));
            culled += usize::from(is_culled);
            drawn += usize::from(is_drawn);
            let was_taken = std::mem::replace(&mut all_taken, pipe.source.is_empty());
            was_taken && !pipe.module.is_high(busy)
        });
        let mut found = self.pipe.sink.take().into_iter();
        for input in inputs {
            if let Some(expected) = expected(frame, input) {
                let mut descriptor = found.next().map(|item| [item[0], item[1]]);
                // The planes of a flat triangle are unused, except the bit `smooth`.
                if let (Some([_, planes]), Shading::Flat) = (&mut descriptor, frame.shading) {
                    let smooth = planes_type.record_of(*planes).get("smooth");
                    *planes = planes_type.record().with("smooth", smooth).bits();
                }
                assert_eq!(descriptor, Some(expected), "{input:?} in {frame:?}");
            }
        }
        assert_eq!(found.next(), None, "an unexpected descriptor in {frame:?}");
        let visible = inputs
            .iter()
            .filter(|i| expected(frame, i).is_some())
            .count();
        assert_eq!((culled, drawn), (inputs.len() - visible, visible));
        clocks
    }
}

/// Makes a random triangle of one of several difficult kinds.
fn triangle(random: &mut Pcg64Mcg, (width, height): (u32, u32)) -> Input {
    let [w, h] = [width, height].map(|size| (size << 8) as i32);
    let mut places = [[0; 2]; 3];
    let kind = random.random_range(0..10);
    let centre = [
        random.random_range(-512..w + 512),
        random.random_range(-512..h + 512),
    ];
    for place in &mut places {
        *place = match kind {
            // Vertices anywhere in the guard band, or at the ends and the middle of its range.
            0 | 1 => [0; 2].map(|_| random.random_range(-GUARD..=GUARD)),
            2 => [0; 2].map(|_| [-GUARD, GUARD, 0, 128][random.random_range(0..4)]),
            // Triangles about as large as the picture.
            3 => [w, h]
                .map(|size| [0, size][random.random_range(0..2)] + random.random_range(-600..600)),
            // Small triangles, tiny triangles, and triangles with vertices on pixel centres or pixel corners.
            4 | 5 => centre.map(|x| x + random.random_range(-3000..3000)),
            6 => centre.map(|x| x + random.random_range(-100..100)),
            7 => centre.map(|x| (x & !255) + 128 * random.random_range(-8..8)),
            _ => centre.map(|x| x + random.random_range(-60_000..60_000)),
        };
    }
    // Slivers: the last vertex is near the line through the other vertices.
    if kind == 8 {
        let (t, [a, b, last]) = (random.random_range(0..=256), &mut places);
        for i in 0..2 {
            last[i] = a[i] + (((b[i] - a[i]) * t) >> 8) + random.random_range(-1..=1);
        }
    }
    // Makes horizontal and vertical edges, and triangles without area.
    if random.random_ratio(1, 3) {
        let [i, k] = [0; 2].map(|_| random.random_range(0..3));
        let axis = random.random_range(0..2);
        places[i][axis] = places[k][axis];
    }
    let vertices = places.map(|[x, y]| ScreenVertex {
        x: x.clamp(-GUARD, GUARD),
        y: y.clamp(-GUARD, GUARD),
        w: match random.random_range(0..5) {
            0 => 0,
            1 => NEAREST,
            _ => random.random_range(0..=NEAREST),
        },
    });
    Input {
        vertices,
        colour: random.random_range(0..=u16::MAX),
        normal: [0; 3].map(|_| match random.random_range(0..6) {
            0 => i16::MIN,
            1 => i16::MAX,
            2 => 0,
            3 => random.random_range(-1 << 14..=1 << 14),
            _ => random.random_range(i16::MIN..=i16::MAX),
        }),
        light: [0; 3].map(|_| light(random)),
    }
}

/// Makes random light of a vertex, on its front or its back side.
fn light(random: &mut Pcg64Mcg) -> Light {
    let colour = [[0; 3], [255; 3], random.random()][random.random_range(0..3)];
    let intensity = [0, 1, 256, random.random_range(0..=256)][random.random_range(0..4)];
    let lit = Lit::new(Rgb565::with_fractions(colour), [intensity; 3]);
    let dark = Lit::default();
    let [front, back] = [[lit, dark], [dark, lit]][random.random_range(0..2)];
    Light { front, back }
}

#[test]
fn random_triangles() {
    random_triangles_of(Shading::Flat);
}

/// Sends frames with flat and with smooth shading in one sequence.
#[test]
fn random_triangles_smooth() {
    random_triangles_of(Shading::Smooth);
}

fn random_triangles_of(ability: Shading) {
    let mut random = Pcg64Mcg::new(1);
    let shares = [[0.0, 0.0], [0.5, 0.5], [0.0, 0.95], [0.95, 0.0]];
    let mut benches = [0, 1, 2, 3].map(|seed| Bench::new(ability, seed, shares[seed as usize]));
    let (mut drawn, mut culled) = (0, 0);
    for round in 0..48 {
        let mut frame = frame(&mut random, round);
        if round % 3 > 0 {
            frame.shading = ability;
        }
        let inputs: Vec<Input> = (0..250)
            .map(|_| triangle(&mut random, frame.size))
            .collect();
        benches[round % 4].check(&frame, &inputs);
        let visible = inputs
            .iter()
            .filter(|i| expected(&frame, i).is_some())
            .count();
        drawn += visible;
        culled += inputs.len() - visible;
    }
    assert!(
        drawn > 3000 && culled > 2000,
        "{drawn} drawn, {culled} culled"
    );
}

/// Sends triangles smaller than 3 pixels, half of them with vertices on pixel centres and corners, where the top-left rule
/// decides coverage.
#[test]
fn tiny_triangles() {
    let mut random = Pcg64Mcg::new(9);
    let mut bench = Bench::new(Shading::Flat, 9, [0.3, 0.3]);
    let (mut drawn, mut dropped) = (0, 0);
    for round in 0..24 {
        let frame = Frame {
            cull: false,
            ..frame(&mut random, round)
        };
        let (width, height) = frame.size;
        let inputs: Vec<Input> = (0..500)
            .map(|number| {
                let corner = [width, height].map(|size| random.random_range(-3..=size as i32) << 8);
                let places = [0; 3].map(|_| {
                    corner.map(|from| match number % 2 {
                        0 => from + 128 * random.random_range(0..=6),
                        _ => from + random.random_range(0..=768),
                    })
                });
                input(places, [5000, 6000, 7000])
            })
            .collect();
        bench.check(&frame, &inputs);
        for input in &inputs {
            let is_drawn = expected(&frame, input).is_some();
            drawn += u32::from(is_drawn);
            dropped += u32::from(!is_drawn);
        }
    }
    assert!(
        drawn > 2000 && dropped > 2000,
        "{drawn} drawn, {dropped} dropped"
    );
}

fn input(places: [[i32; 2]; 3], w: [u32; 3]) -> Input {
    Input {
        vertices: [0, 1, 2].map(|i| {
            let [x, y] = places[i];
            ScreenVertex { x, y, w: w[i] }
        }),
        colour: 0xFFFF,
        normal: [0, 0, -1 << 14],
        light: [[0, 256], [256, 0], [200, 0]].map(|[front, back]| Light {
            front: Lit::new(Rgb565::WHITE.fractions(), [front; 3]),
            back: Lit::new(Rgb565::WHITE.fractions(), [back; 3]),
        }),
    }
}

/// Sets up all triangles between extreme vertices, in every order, with and without culling, at every size of the picture.
#[test]
fn corners_of_the_guard_band_and_of_the_picture() {
    corners(Shading::Flat);
}

#[test]
fn corners_of_the_guard_band_and_of_the_picture_smooth() {
    corners(Shading::Smooth);
}

fn corners(shading: Shading) {
    let mut bench = Bench::new(shading, 7, [0.2, 0.2]);
    for size in SIZES {
        let [w, h] = [size.0, size.1].map(|x| (x << 8) as i32);
        let corners = [
            [-GUARD, -GUARD],
            [GUARD, -GUARD],
            [-GUARD, GUARD],
            [GUARD, GUARD],
            [128, 128],
            [w - 128, 128],
            [128, h - 128],
            [w - 128, h - 128],
            [w, h],
            [0, 0],
            [129, 127],
        ];
        let mut inputs = Vec::new();
        for a in corners {
            for b in corners {
                for c in corners {
                    let depths = [[0, NEAREST, 0], [NEAREST, 0, 1], [NEAREST; 3]];
                    inputs.push(input([a, b, c], depths[inputs.len() % 3]));
                }
            }
        }
        for cull in [false, true] {
            let frame = Frame {
                size,
                cull,
                mirror: false,
                light: WHITE,
                shading,
            };
            bench.check(&frame, &inputs);
        }
    }
}

/// A triangle with all vertices beyond one side of the picture has empty bounds, so the setup needs no separate test.
#[test]
fn off_the_picture_is_without_a_centre() {
    let mut random = Pcg64Mcg::new(5);
    for size in SIZES {
        let [w, h] = [size.0, size.1].map(|x| (x << 8) as i32);
        for round in 0..1000 {
            let (low, high) = [(-GUARD, -1), ([w, h][round % 2], GUARD)][round / 2 % 2];
            let vertices = [0; 3].map(|_| {
                let off = random.random_range(low..=high);
                let any = random.random_range(-GUARD..=GUARD);
                let [x, y] = if round % 2 == 0 {
                    [off, any]
                } else {
                    [any, off]
                };
                ScreenVertex { x, y, w: 0 }
            });
            assert_eq!(Bounds::new(&vertices, size.0, size.1), None, "{vertices:?}");
        }
    }
}

#[test]
fn clocks_a_triangle() {
    clocks(Shading::Flat);
}

#[test]
fn clocks_a_triangle_smooth() {
    clocks(Shading::Smooth);
}

fn clocks(shading: Shading) {
    const COUNT: u64 = 200;
    let mut bench = Bench::new(shading, 3, [0.0, 0.0]);
    let places = [[1000, 1000], [1000, 9000], [9000, 1000]];
    let front = input(places, [5000, 6000, 7000]);
    let back = input([places[0], places[2], places[1]], [5000, 6000, 7000]);
    let frame = Frame {
        size: SIZES[0],
        cull: true,
        mirror: false,
        light: WHITE,
        shading,
    };
    let latency = bench.check(&frame, &[front]);
    let drawn = bench.check(&frame, &[front; COUNT as usize]);
    let culled = bench.check(&frame, &[back; COUNT as usize]);
    let (most, each) = match shading {
        Shading::Flat => (86, 11),
        Shading::Smooth => (196, 33),
    };
    assert!(latency <= most, "{latency} clocks for one triangle");
    assert!(
        drawn <= each * COUNT + most,
        "{drawn} clocks for {COUNT} triangles drawn"
    );
    assert!(
        culled <= 3 * COUNT + 12,
        "{culled} clocks for {COUNT} triangles culled"
    );
}
