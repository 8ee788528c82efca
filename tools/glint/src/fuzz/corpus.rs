//! Seeds of the fuzz targets: small valid inputs that cover every feature of the format.

use super::mutate::MAX_INPUT;
use super::targets::Target;
use super::{firmware, host, transfer};
use crate::convert::{self, Options};
use crate::error::Location;
use crate::formats::gltf::example::{TWO_MESHES, as_binary};
use crate::formats::{gltf, write};
use crate::generate;
use crate::image;
use crate::polygons::{Corner, Polygons, Rgb8};
use glint_core::flash::{CONTENTS, Kind, Piece};
use glint_core::mesh::Mesh;
use glint_core::orientation::log::{Setup, record, to_bytes};
use glint_core::orientation::{Sample, Units};
use glint_core::wireframe::CUBE;
use glint_core::wireframe::text::assemble;
use glint_scene_file::{NAMES, SceneFile, built_in};
use glint_texture::example;

/// Returns the seeds of a target. No seed exceeds the maximum length of an input.
pub fn of(target: Target) -> Vec<Vec<u8>> {
    let seeds = match target {
        Target::Upload => transfer::seeds(),
        Target::Host => host::seeds(),
        Target::Console => texts(CONSOLE),
        Target::Firmware => texts(CONSOLE)
            .into_iter()
            .chain(firmware::seeds())
            .collect(),
        Target::Obj => texts(OBJ).into_iter().chain(written(write::obj)).collect(),
        Target::Stl => texts(STL).into_iter().chain(written(write::stl)).collect(),
        Target::Ply => texts(PLY).into_iter().chain(written(write::ply)).collect(),
        Target::Gltf => gltfs(),
        Target::Glm => meshes(),
        Target::Texture => example::files().into_iter().chain(textures()).collect(),
        Target::Imu => texts(IMU).into_iter().chain([still_log()]).collect(),
        Target::Replay => images(),
        Target::WireframeText => texts(WIREFRAMES),
        Target::WireframeWords => WIREFRAMES
            .iter()
            .filter_map(|text| assemble(text).ok())
            .collect(),
        Target::Scene => texts(&[&glint_scene_file::TEXTS[..], SCENES].concat()),
        Target::Flash => contents(),
    };
    seeds
        .into_iter()
        .filter(|seed| seed.len() <= MAX_INPUT)
        .collect()
}

fn texts(texts: &[&str]) -> Vec<Vec<u8>> {
    texts.iter().map(|text| text.as_bytes().to_vec()).collect()
}

/// Small models: generated models, and a model with a concave polygon that has a colour.
fn models() -> Vec<Polygons> {
    let mut models: Vec<Polygons> = ["cube", "icosphere:1", "icosphere:2", "sponge:0"]
        .iter()
        .filter_map(|name| generate::named(name).ok())
        .collect();
    let mut star = Polygons::default();
    let corners: Vec<Corner> = (0..12)
        .filter_map(|i| {
            let (radius, angle) = (
                if i % 2 == 0 { 1.0 } else { 0.4 },
                f64::from(i) * std::f64::consts::TAU / 12.0,
            );
            star.point_colours.push(Rgb8([i as u8 * 20, 200, 100]));
            let point = [
                radius * angle.cos(),
                radius * angle.sin(),
                f64::from(i) * 0.01,
            ];
            star.add_point(point, Location::Whole).ok().map(Corner::at)
        })
        .collect();
    let colour = Some(Rgb8([255, 0, 0]));
    if star.add_face(&corners, colour, Location::Whole).is_ok() {
        models.push(star);
    }
    models
}

fn written(write: impl Fn(&Polygons, &mut Vec<u8>) -> std::io::Result<()>) -> Vec<Vec<u8>> {
    let one = |polygons: Polygons| {
        let mut out = Vec::new();
        write(&polygons, &mut out).ok().map(|()| out)
    };
    models().into_iter().filter_map(one).collect()
}

fn gltfs() -> Vec<Vec<u8>> {
    let binary = as_binary(TWO_MESHES).map(|(binary, _)| binary);
    let textured = textured();
    texts(&[TWO_MESHES, &textured])
        .into_iter()
        .chain(binary)
        .collect()
}

/// The example glTF, with a texture on its first mesh.
fn textured() -> String {
    let texture = "\"alphaMode\": \"MASK\", \"pbrMetallicRoughness\": {\"baseColorTexture\": {\"index\": 0, \"texCoord\": 0, \
                   \"extensions\": {\"KHR_texture_transform\": {\"offset\": [0.5, 0], \"rotation\": 1, \"scale\": [2, 1]}}}, ";
    let lists = "\"images\": [{\"uri\": \"a.png\"}], \"textures\": [{\"source\": 0, \"sampler\": 0}], \
                 \"samplers\": [{\"wrapS\": 33071, \"wrapT\": 33648, \"magFilter\": 9728}], \"scene\": 0";
    let coordinates =
        "}, {\"bufferView\": 0, \"componentType\": 5126, \"count\": 4, \"type\": \"VEC2\"}]\n}";
    TWO_MESHES
        .trim_end()
        .replacen("\"pbrMetallicRoughness\": {", texture, 1)
        .replacen("\"scene\": 0", lists, 1)
        .replacen("\"NORMAL\": 1", "\"NORMAL\": 1, \"TEXCOORD_0\": 4", 1)
        .replacen("}]\n}", coordinates, 1)
}

/// The mesh of the glTF of [`textured`] in a board's memory layout.
fn textured_mesh() -> Option<Vec<u8>> {
    let polygons = gltf::parse(textured().as_bytes(), &mut |_| Some(example::small_png()));
    let converted = convert::convert(&polygons.ok()?, Options::default());
    converted.ok().map(|(mesh, _)| mesh)
}

/// Textures in a board's memory layout.
fn textures() -> Vec<Vec<u8>> {
    let mesh = textured_mesh();
    let mesh = mesh.as_ref().and_then(|mesh| Mesh::new_checked(mesh).ok());
    let textures = mesh.iter().flat_map(Mesh::textures);
    textures.map(|texture| texture.bytes().to_vec()).collect()
}

fn meshes() -> Vec<Vec<u8>> {
    models()
        .iter()
        .filter_map(|polygons| convert::convert(polygons, Options::default()).ok())
        .map(|(mesh, _)| mesh)
        .chain(textured_mesh())
        .collect()
}

/// A log of a sensor at rest, long enough for a calibration.
fn still_log() -> Vec<u8> {
    let mut log = String::from("t_us,ax,ay,az,gx,gy,gz\n");
    for i in 0..80 {
        let noise = i * 7 % 5 - 2;
        log += &format!(
            "{},{},-30,{},{},{noise},18\n",
            1_000 * i,
            90 + noise,
            4_100 - noise,
            74 - noise
        );
    }
    log.into_bytes()
}

/// Contents of flash images: each built-in scene, and a scene with its own mesh.
fn contents() -> Vec<Vec<u8>> {
    let small = SceneFile::parse(
        "small",
        "small.toml",
        "title = \"x\"\nmodel = \"sponge:0\"\ncamera = \"2.5 40 65\"\n",
    );
    let scenes = NAMES.into_iter().filter_map(built_in);
    let pieces = |scene: SceneFile| image::pieces(&[scene]).ok();
    let image = |pieces: Vec<Piece>| {
        let image = image::make(&[], &[0; 64], &pieces).ok()?;
        image.get(CONTENTS..).map(<[u8]>::to_vec)
    };
    let piece = |kind, bytes: &[u8]| Piece {
        kind,
        name: "ball.wfb".to_owned(),
        bytes: bytes.to_vec(),
    };
    let program = vec![
        piece(Kind::Program, CUBE.as_flattened()),
        piece(Kind::Scene, b"program ball.wfb\n"),
    ];
    let contents = scenes.chain(small.ok()).filter_map(pieces);
    contents.chain([program]).filter_map(image).collect()
}

/// Logs of 200, 30 and 1 samples in a board's format, with different options. The two longer logs contain rest, motion, repeated
/// time stamps and a gap.
fn images() -> Vec<Vec<u8>> {
    let image = |tilt, follow_bias, samples: u32| {
        let setup = Setup::new(Units::MPU_6050, tilt, follow_bias, [1_000, -300, 0]).ok()?;
        let mut image = setup.header(samples).to_vec();
        for i in 0..samples {
            let turns = (i as i16).wrapping_mul(1_821);
            let late = u32::from(i > 20) * 600_000;
            image.extend(to_bytes(record(&Sample {
                t_us: u64::from(u32::MAX - 10_000) + u64::from(2_000 * (i - i / 9) + late),
                accel: [(i % 5) as i16, -40, 4_090],
                gyro: if i % 40 < 20 {
                    [4, -1, 0]
                } else {
                    [turns, i16::MAX, -turns]
                },
            })));
        }
        Some(image)
    };
    [(true, true, 200), (false, false, 30), (true, false, 1)]
        .into_iter()
        .filter_map(|(tilt, follow_bias, samples)| image(tilt, follow_bias, samples))
        .collect()
}

const IMU: &[&str] = &[
    "t_us,ax,ay,az,temp,gx,gy,gz\n9323,-139,-453,4420,-4880,2077,1116,-320\n15163,-115,-512,4304,-4848,2219,1379,-500\n",
    "gz,gy,gx,az,ay,ax,t_us\r\n32767,-32768,32767,0,0,4096,4294967290\r\n-32768,32767,1,0,0,-4096,4294968290\r\n\r\n0,0,0,0,0,0,9294968290\r\n",
    "t_us,ax,ay,az,gx,gy,gz\n5,0,0,0,1,1,1\n5,0,0,0,1,1,1\n4,0,0,0,1,1,1\n18446744073709551615,-32768,-32768,-32768,1,1,1\n",
];

const WIREFRAMES: &[&str] = &[
    "# a triangle\neye 0 0 8\nplane 4\nwindow -4 -2.25 4 2.25\nsegment -1 -1 0  1 -1 0 # low\nsegment 1 -1 0  0 1 0\nsegment 0 1 0  -1 -1 0\nend\n",
    "segment -16 -16 -16 15.9995 15.9995 15.9995\nsegment 0 0 0 0 0 0\r\nsegment 1 1 -1 1 1 9\nwindow -0.5 -0.5 -0.4995 -0.4995\nplane -1\neye 15 -15 0\n\nend\n",
];

const CONSOLE: &[&str] = &[
    "help\rhelp camera\rinfo\rscene\rscene cube\rscene model\r",
    "object add cube scale 0.5 rotate z 30 move 1,0,-2 colour ff8000\robject list\robject move 1 0,0,1\robject remove all\rmodels\r",
    "program\rprogram cube\rprogram 96 deadbeef ball.wfb\rprogram ball.wfb\runload ball.wfb\rpress up\r",
    "camera 2.5 30 60\rcamera 5 -720.125 179.99999\rorbit 12\rorbit\r",
    "view\rview 0 -3 0 1 0 0 0 0 -1 0 1 0 0.9 0.1\r",
    "field\rfield menger:4\rfield cubes:2,0.5\rfield off\rstereo\rstereo 0.05,3\rstereo 0.05,3,red-cyan\rstereo off\rprepass on\r",
    "look 10 20 -30.5\rsize 320 180\rsize 1280 720\rframe\rframe depth\r",
    "load 4096 deadbeef\rreplay 64 0\rreplay\rrender\rcull on\rcull off\rstats\rstats json\r",
    "backend\rbackend cpu\rbackend gateware\rshading\rshading smooth\rbench\rbench sine\rselftest\r",
    "leds 0xffff\rleds 7\rbuttons\rreboot\r",
    "inf\x08\x08\x1b[A\x1b[B\x1b[C\x1b[D\x1b[H\x1b[F\x1b[3~\x01\x05\x0b\x15\x17\x0c\x03help\r\n",
];

const OBJ: &[&str] = &[
    "mtllib beside.mtl\nnewmtl a\nKd 1 0.5 0\nmap_Kd a.png\nnewmtl b\nmap_Kd -clamp on -s 1 2 3 b.png\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 -0.5\nvt 1e9 nan\nusemtl a\nf 1/1 2/2 3/3\nusemtl b\nf 1/1 3/-1 2/2\nf 1 2/1 3\n",
    "# all kinds of faces\nmtllib beside.mtl\no thing\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 1\nvt 0 0\nvt 1 0\nvn 0 0 1\nvn 0 1 0\ng side\ns 1\nusemtl red\nf 1/1/1 2/2/1 3//1 4\nf -1 -2 -3\nf 1 2 5\nusemtl green\nf 2//2 3//2 5//2\nl 1 2\np 1\n",
    "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nv 0 1 0 255 255 0\nv 0.2 0.5 0.0 1 1 1 1\nf 1 2 3 4 5\n",
    "v 0 0 0 1.0\nv 3 0 0\nv 3 3 0\\\n\nv 1 1 0\nv 0 3 0\nf 1 2 \\\n3 4 5\n",
];

const STL: &[&str] = &[
    "solid name with words\nfacet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1 0 0\n  vertex 0 1 0\n endloop\nendfacet\nfacet normal nan nan nan\n outer loop\n  vertex 0 0 1e-3\n  vertex 1 0 .5\n  vertex 0 1 -1e2\n endloop\nendfacet\nendsolid name\nsolid\nendsolid\n",
];

/// Scenes of meshes without a camera, with a material.
const SCENES: &[&str] = &[
    "title = \"a\"\nmodel = \"gear\"\nup = \"y\"\nfov = 40\nzoom = 1.5\nmaterial = \"jade\"\n",
    "title = \"a\"\nprogram = \"ball.wfb\"\nsteer = \"buttons\"\n",
    "title = \"a\"\nobject = [\"cube\", \"torus scale 0.5 colour 00ff00\"]\northographic = 2\nmaterial = \"gold\"\n",
];

const PLY: &[&str] = &[
    "ply\nformat ascii 1.0\ncomment made here\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\nproperty float nz\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n0 0 0 0 0 1 255 0 0\n1 0 0 0 0 1 0 255 0\n1 1 0 0 0 1 0 0 255\n0 1 0 0 0 1 9 9 9\n3 0 1 2\n4 0 1 2 3\n",
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\nelement edge 1\nproperty int a\nproperty list uchar float b\nelement face 1\nproperty float red\nproperty float green\nproperty float blue\nproperty list uint uint vertex_index\nend_header\n0 0 0\n1 0 0\n0 1 0\n5 2 1 2\n0.5 0.25 1 3 0 1 2\n",
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n8 0 1 2 3 -1 0 1 2\n",
];
