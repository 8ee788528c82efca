//! Test scenes: typical and extreme fields and cameras.

use glint_core::camera::View;
use glint_core::field::{Field, Primitive};
use glint_core::fixed::Q32_32;
use glint_model::SIZES;
use glint_model::raymarch::exits::{Exits, Words};
use glint_model::raymarch::{FieldOptions, FieldSetup, Form, Light, Lights, Shine, Stereo, Tint};

use glint_vectors::{Camera, Random};

/// Fields for a build of the raymarcher that supports sponges only.
pub const SPONGES: [&str; 4] = ["menger:4", "menger:3", "menger:2", "menger:1"];

/// Fields with spheres.
pub const ROUND: [&str; 8] = [
    "sphere:1",
    "sphere:12",
    "sphere:0.01",
    "lattice:2,0.5",
    "lattice:0.25,0.124",
    "moving:0.25,0.75,200",
    "spheres:0,0,0,0.75;1,0.25,0.5,0.5;-0.75,-0.5,0.75,0.25",
    "spheres:0,0,0,0.5;1,0,0,0.5;0,1,0,0.5;0,0,1,0.5;-1,0,0,0.5;0,-1,0,0.5;0,0,-1,0.5;8,-8,8,3.5",
];

/// Unions with a fillet, which need marching rays, for a build with sponges up to depth 4.
pub const SMOOTH: [&str; 9] = [
    "smooth:0.25,menger:2+sphere:1",
    "smooth:0.5,menger:3+spheres:1,1,1,0.5;-1,0,0,0.25;0,0,0,0.125",
    "smooth:0.01,menger:1+moving:1,0.5,30",
    "smooth:0.1,menger:4+moving:0.5,1,60",
    "smooth:0.25,box:1,1,0.25+sphere:0.625",
    "smooth:0.2,box:1,0.5,0.25+moving:0.25,1",
    "smooth:0.5,box:12,12,12+spheres:0,0,11.4,0.5;1,2,-10.9,1",
    "smooth:0.5,box:0.01,0.01,0.01+spheres:8,-8,8,3.5;-11,-11,-11,0.75",
    "smooth:0.05,box:0.5,12,0.02+spheres:0,0,0,0.5;1,0,0,0.5;0,1,0,0.5;0,0,1,0.5;-1,0,0,0.5;0,-1,0,0.5;0,0,-1,0.5;8,-8,8,3.5",
];

/// Unions of a bounded field with flat faces and of spheres.
pub const UNIONS: [&str; 7] = [
    "union:menger:4+sphere:0.75",
    "union:menger:2+moving:0.25,1,-75",
    "union:menger:3+spheres:1,1,1,0.5;-1,0,0,0.25;0,0,0,0.125",
    "union:menger:1+spheres:0,0,1.5,0.5;8,-8,8,3.5",
    "smooth:0.25,menger:2+sphere:1",
    "smooth:0.5,menger:3+spheres:1,1,1,0.5;-1,0,0,0.25;0,0,0,0.125",
    "smooth:0.01,menger:1+moving:1,0.5,30",
];

/// Unions of an unbounded field and of spheres.
pub const ENDLESS_UNIONS: [&str; 7] = [
    "union:cubes:2,0.4+sphere:1.1",
    "union:cubes:0.25,0.1+spheres:0,0,0,0.3;1,1,0,3.9",
    "union:boxes:1,0.5,0.5,0.05+spheres:0,0,0.3,0.4;3,-3,0.5,0.8",
    "union:lattice:1,0.1+moving:0.9,0.75,40",
    "union:lattice:4,1+spheres:0.2,0.1,-0.15,1;0,0,0,0.9;4,0,0.1,1",
    "union:lattice:2,0.5+spheres:0,0,0,0.6;1,0,0,0.5;0,1,0,0.5;0,0,1,0.5;-1,0,0,0.5;0,-1,0,0.5;8,-8,8,3.5",
    "union:planes:1+spheres:0,0,-0.7,0.5;2,1,1,0.4",
];

/// Fields with faces perpendicular to the axes.
pub const FIELDS: [&str; 16] = [
    "menger:4",
    "menger:6",
    "menger:5",
    "menger:1",
    "box:1,0.5,0.25",
    "box:0.01,12,3",
    "cubes:2,0.5",
    "cubes:0.25,0.1",
    "cubes:16,7.9",
    "boxes:2,0.7,0.3,0.12",
    "boxes:2,0.25,1,0.15",
    "boxes:0.25,0.125,0.01,0.125",
    "boxes:16,8,8,8",
    "planes:0.5",
    "planes:12",
    "planes:0.01",
];

/// Returns an example of each kind of field that is neither in `FIELDS` nor in `ROUND`.
pub fn further_kinds() -> Vec<&'static str> {
    let listed = [&FIELDS[..], &ROUND].concat();
    let kind = |text: &&str| text.split(':').next().map(str::to_owned);
    let is_new = |text: &&str| !listed.iter().any(|other| kind(other) == kind(text));
    Primitive::EXAMPLES.into_iter().filter(is_new).collect()
}

/// Makes a random camera inside or outside of a field, with any direction.
pub fn camera(random: &mut Random) -> View {
    let distance = match random.bits() % 4 {
        0 => random.real(0.0, 1.0),
        1 => random.real(0.5, 2.0),
        2 => random.real(0.0, 8.0),
        _ => 1.2,
    };
    camera_at(random, distance)
}

/// Makes a random camera at a distance from the origin, with any direction.
fn camera_at(random: &mut Random, distance: f64) -> View {
    let eye = random.direction().map(|x| x * distance);
    let towards = match random.bits() % 4 {
        0 => random.direction(),
        // A direction nearly along an axis.
        1 => {
            let axis = (random.bits() % 3) as usize;
            let little = random.logarithmic(1e-7, 1e-1);
            let mut towards = random.direction().map(|x| x * little);
            towards[axis] = if random.coin() { 1.0 } else { -1.0 };
            towards
        }
        _ => eye.map(|x| random.real(-0.7, 0.7) - x),
    };
    let half_width = random.logarithmic(0.05, 4.0);
    let near = random.logarithmic(0.01, 2.0);
    Camera::aimed(random, eye, towards, [0.0; 2], half_width, near).rounded()
}

/// Lowers the step limit of marching rays to `cap` if it is higher.
pub fn limit_steps(setup: &mut FieldSetup, cap: u32) {
    if let Form::Marching(marching) = &mut setup.form {
        marching.cap = marching.cap.min(cap);
    }
}

/// Makes random frame constants like [`setup`], but without shadows.
pub fn unshaded_setup(random: &mut Random, fields: &[impl AsRef<str>]) -> FieldSetup {
    let mut setup = setup(random, fields);
    if let Form::Exits(exits) = &mut setup.form {
        exits.sun = None;
    }
    setup
}

/// Makes random frame constants, with random tuning and one or two eyes.
pub fn setup(random: &mut Random, fields: &[impl AsRef<str>]) -> FieldSetup {
    let camera = camera(random);
    setup_from(random, fields, &camera)
}

/// Makes random frame constants like [`setup`], of a picture with this many columns.
pub fn setup_of_width(random: &mut Random, fields: &[impl AsRef<str>], width: u32) -> FieldSetup {
    loop {
        let setup = setup(random, fields);
        if setup.width == width {
            return setup;
        }
    }
}

/// Makes random frame constants of marching rays in fields of [`SMOOTH`], some of them seen from very far away.
pub fn marching_setup(random: &mut Random) -> FieldSetup {
    let camera = match random.bits() % 4 {
        0 => {
            let distance = random.real(8.0, 31.0);
            camera_at(random, distance)
        }
        _ => camera(random),
    };
    setup_from(random, &SMOOTH, &camera)
}

fn setup_from(random: &mut Random, fields: &[impl AsRef<str>], camera: &View) -> FieldSetup {
    let field = Field::parse(fields[random.bits() as usize % fields.len()].as_ref()).unwrap();
    let mut options = FieldOptions::of(&field);
    options.stereo = random.coin().then(|| stereo(random));
    options.sun = random.coin().then(|| sun(random));
    if random.coin() {
        let tuning = &mut options.tuning;
        tuning.threshold = random.logarithmic(1.0, 65536.0) as u32;
        tuning.footprint = random.integer(7, 15) as u32;
        tuning.cap = random.logarithmic(1.0, 1024.0) as u32;
    }
    FieldSetup::new(&field, camera, size(random), &options).unwrap()
}

/// Makes a random direction to a light, along an axis in some cases.
fn sun(random: &mut Random) -> [i16; 3] {
    if random.bits().is_multiple_of(4) {
        let mut direction = [0; 3];
        direction[random.bits() as usize % 3] = if random.coin() { 1 << 14 } else { -(1 << 14) };
        return direction;
    }
    random
        .direction()
        .map(|part| (part * 16384.0).round() as i16)
}

/// Makes random constants of rays by exits in a field; returns them, and the number of eyes.
pub fn exits(random: &mut Random, field: &str) -> (Exits, usize) {
    let field = Field::parse(field).expect("a field");
    let stereo = random.coin().then(|| stereo(random));
    let (view, size) = (camera(random), size(random));
    let exits = Exits::new(&field, &view, size, stereo, Words::CHOSEN).expect("a frame");
    (exits, 1 + usize::from(stereo.is_some()))
}

/// Number of rays of a test. The environment variable `GLINT_RTL_RAYS` sets it, 150,000 by default.
pub fn rays() -> usize {
    std::env::var("GLINT_RTL_RAYS").map_or(150_000, |text| text.parse().unwrap())
}

/// Shares of stalls of the source and of the sink of a bench.
pub const STALLS: [[f64; 2]; 4] = [[0.0, 0.0], [0.5, 0.5], [0.0, 0.95], [0.9, 0.0]];

/// Makes a random size of a picture.
pub fn size(random: &mut Random) -> (u32, u32) {
    SIZES[random.bits() as usize % SIZES.len()]
}

/// Makes random parameters of two eyes.
pub fn stereo(random: &mut Random) -> Stereo {
    Stereo {
        half_separation: Q32_32::from_num(random.real(0.0, 1.0)),
        zero_parallax: Q32_32::from_num(random.real(1.0, 5.0)),
        tint: Tint::RedBlue,
    }
}

/// Makes random lights and materials.
pub fn lights(random: &mut Random, is_stereo: bool) -> Lights {
    let mut colour = || [0; 3].map(|_| random.bits() as u8);
    let materials = [0; 8].map(|_| colour());
    let ambient = colour();
    let colours = [0; 4].map(|_| colour());
    let shine = colour();
    let mut light = |colour| Light {
        direction: random.direction().map(|x| (x * 65535.0) as i32),
        colour,
    };
    let list = colours.map(&mut light);
    let light = light(shine);
    let normals = random.coin().then(|| Lights::components(is_stereo));
    let fewest = if normals.is_some() { 0 } else { 1 };
    let count = random.integer(fewest, 4) as usize;
    Lights {
        axes: [1 << 16; 3],
        ambient,
        list,
        count,
        normals,
        highlight: (count != 0 && random.coin()).then(|| Shine {
            light,
            steepness: random.integer(256, 6952) as u16,
        }),
        materials,
    }
}
