//! Scenes of triangles, encoded as meshes, and random test cases.

use glint_core::camera::View;
use glint_core::mesh::{IndexedTriangle, Rgb565, Vertex, encode};
use glint_reference::camera::{Camera, Size, Vector};
use glint_vectors::Picture;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

use super::cameras::{around, log_range};

/// The number 1 in the format Q2.14.
pub const ONE: f64 = 16384.0;

pub const SMALL: Size = Size {
    width: 320,
    height: 180,
};
pub const MIDDLE: Size = Size {
    width: 640,
    height: 360,
};
pub const LARGE: Size = Size {
    width: 1280,
    height: 720,
};

/// A list of triangles with vertex coordinates in Q2.14.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    pub positions: Vec<[i16; 3]>,
    pub triangles: Vec<[u32; 3]>,
    /// A face normal for each triangle, or empty.
    pub normals: Vec<[i16; 3]>,
    /// A colour for each triangle, or empty.
    pub colours: Vec<u16>,
}

impl Scene {
    /// Adds a vertex at `point`, rounded to Q2.14, and returns the vertex's index.
    pub fn vertex(&mut self, point: Vector) -> u32 {
        self.positions.push(point.map(|x| (x * ONE).round() as i16));
        self.positions.len() as u32 - 1
    }

    /// Adds a triangle with three vertices of its own.
    pub fn triangle(&mut self, points: [Vector; 3]) {
        let indices = points.map(|point| self.vertex(point));
        self.triangles.push(indices);
    }

    /// Returns the corners of a triangle. The conversion to f64 is exact.
    pub fn corners(&self, triangle: usize) -> [Vector; 3] {
        self.triangles[triangle]
            .map(|index| self.positions[index as usize].map(|x| f64::from(x) / ONE))
    }

    /// Returns the corners of all triangles.
    pub fn all_corners(&self) -> Vec<[Vector; 3]> {
        (0..self.triangles.len()).map(|i| self.corners(i)).collect()
    }

    /// Returns a scene that contains only the triangle with this index.
    pub fn only(&self, triangle: usize) -> Self {
        Self {
            positions: self.triangles[triangle]
                .map(|index| self.positions[index as usize])
                .to_vec(),
            triangles: vec![[0, 1, 2]],
            normals: self.normals.get(triangle).copied().into_iter().collect(),
            colours: self.colours.get(triangle).copied().into_iter().collect(),
        }
    }

    /// Draws the scene with the model.
    pub fn draw(&self, view: &View, size: Size, cull: bool) -> Picture {
        Picture::of_bytes(&self.encode(), view, (size.width, size.height), cull)
    }

    /// Encodes the scene as a mesh and returns its bytes.
    pub fn encode(&self) -> Vec<u8> {
        let vertices: Vec<Vertex> = self
            .positions
            .iter()
            .map(|&position| Vertex {
                position,
                ..Vertex::default()
            })
            .collect();
        let triangles: Vec<IndexedTriangle> = self
            .triangles
            .iter()
            .enumerate()
            .map(|(i, &indices)| IndexedTriangle {
                indices,
                colour: Rgb565(self.colours.get(i).copied().unwrap_or(0xFFFF)),
                normal: self.normals.get(i).copied().unwrap_or_default(),
                texture: 0,
            })
            .collect();
        encode(&vertices, &triangles).expect("a valid small mesh")
    }
}

/// A test case: a scene with a camera and drawing options.
pub struct Case {
    pub name: String,
    pub scene: Scene,
    pub camera: Camera,
    pub size: Size,
    pub cull: bool,
}

/// A function that makes a random scene and a camera for it.
type Kind = fn(&mut Pcg64) -> (Scene, Camera);

/// Name and function of each kind of random case. Each kind tests a different difficulty of rasterization.
const KINDS: [(&str, Kind); 8] = [
    ("a cloud of small triangles", cloud),
    ("triangles larger than the picture", large),
    ("slivers", slivers),
    ("a camera among the triangles", inside),
    ("a narrow view", narrow),
    ("a wide view", wide),
    ("triangles of a pixel and less", tiny),
    ("closed bodies cut by a far near plane", bodies),
];

/// Makes the random case of a seed.
pub fn random_case(seed: u64) -> Case {
    let mut random = Pcg64::seed_from_u64(seed);
    let kinds = KINDS.len() as u64;
    let (kind, make) = KINDS[(seed % kinds) as usize];
    let (mut scene, camera) = make(&mut random);
    // Larger pictures have fewer triangles, so that the test takes less time.
    let (size, most) = match seed / kinds % 10 {
        8 => (MIDDLE, 25),
        9 => (LARGE, 10),
        _ => (SMALL, usize::MAX),
    };
    scene.triangles.truncate(most);
    Case {
        name: format!("seed {seed}, {kind}"),
        scene,
        camera,
        size,
        cull: (seed / kinds).is_multiple_of(2),
    }
}

fn point(random: &mut Pcg64, reach: f64) -> Vector {
    [(); 3].map(|()| random.random_range(-reach..reach))
}

fn near(random: &mut Pcg64, middle: Vector, reach: f64) -> Vector {
    let offset = point(random, reach);
    [0, 1, 2].map(|i| middle[i] + offset[i])
}

/// Makes `count` random triangles with middles in a box of half width `reach` about the origin. Each triangle's size is random
/// between the two `sizes`.
pub fn spread(random: &mut Pcg64, count: usize, reach: f64, sizes: [f64; 2]) -> Scene {
    let mut scene = Scene::default();
    for _ in 0..count {
        let middle = point(random, reach);
        let size = log_range(random, sizes[0], sizes[1]);
        scene.triangle([(); 3].map(|()| near(random, middle, size)));
    }
    scene
}

fn cloud(random: &mut Pcg64) -> (Scene, Camera) {
    let distance = random.random_range(2.0..5.0);
    (
        spread(random, 60, 0.5, [0.02, 0.4]),
        around(random, distance, 0.9, 0.1),
    )
}

fn large(random: &mut Pcg64) -> (Scene, Camera) {
    let distance = random.random_range(2.0..5.0);
    (
        spread(random, 12, 0.4, [0.5, 1.5]),
        around(random, distance, 0.5, 0.1),
    )
}

fn slivers(random: &mut Pcg64) -> (Scene, Camera) {
    let mut scene = Scene::default();
    for _ in 0..50 {
        let (a, b) = (point(random, 0.8), point(random, 0.8));
        let t = random.random_range(-0.2..1.2);
        let width = log_range(random, 0.2 / ONE, 0.01);
        let on = [0, 1, 2].map(|i| a[i] + t * (b[i] - a[i]));
        scene.triangle([a, b, near(random, on, width)]);
    }
    let distance = random.random_range(1.0..4.0);
    (scene, around(random, distance, 0.6, 0.1))
}

fn inside(random: &mut Pcg64) -> (Scene, Camera) {
    let (distance, near) = (random.random_range(0.05..0.6), log_range(random, 0.01, 0.3));
    (
        spread(random, 30, 0.7, [0.1, 1.0]),
        around(random, distance, 0.9, near),
    )
}

fn narrow(random: &mut Pcg64) -> (Scene, Camera) {
    let (distance, half_width) = (random.random_range(0.5..4.0), log_range(random, 0.05, 0.2));
    (
        spread(random, 30, 0.3, [0.02, 1.5]),
        around(random, distance, half_width, 0.05),
    )
}

fn wide(random: &mut Pcg64) -> (Scene, Camera) {
    let (distance, half_width) = (random.random_range(0.02..1.0), log_range(random, 1.5, 4.0));
    (
        spread(random, 30, 0.6, [0.1, 1.0]),
        around(random, distance, half_width, 0.01),
    )
}

fn tiny(random: &mut Pcg64) -> (Scene, Camera) {
    let distance = random.random_range(1.0..3.0);
    (
        spread(random, 250, 0.4, [1.0 / ONE, 0.02]),
        around(random, distance, 0.4, 0.1),
    )
}

/// Makes a scene of random tetrahedra, whose triangles share edges.
fn bodies(random: &mut Pcg64) -> (Scene, Camera) {
    let mut scene = Scene::default();
    for _ in 0..10 {
        let middle = point(random, 0.9);
        let corners = [(); 4].map(|()| near(random, middle, 0.8));
        let [a, b, c, d] = corners.map(|corner| scene.vertex(corner));
        scene
            .triangles
            .extend([[a, b, c], [a, c, d], [a, d, b], [b, d, c]]);
    }
    let near = random.random_range(0.5..2.0);
    (scene, around(random, 1.5, 0.9, near))
}
