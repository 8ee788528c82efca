//! Pictures of the model's raymarcher as input of [`metrics`], and each ray's number of evaluations of the field's distance.

use glint_core::camera::View;
use glint_core::field::{
    Boxes, CentredSphere, Cone, Cubes, Cuboid, Field as Scene, Lattice, Menger, MovingSphere,
    Octahedron, Planes, Primitive,
};
use glint_core::fixed::Q32_32;
use glint_model::raymarch::exits::Exits;
use glint_model::raymarch::{FieldOptions, FieldSetup, Form, Marching, RayEnd};

use super::metrics::{self, Accuracy, Expected, Quantiles, RayOutcome, accuracy};
use super::rendered::outcome;
use super::{Field, Plane, Sphere, exited, views};
use crate::camera::{Camera, Size, Vector};

pub use super::rendered::RenderedRay;

/// Draws the picture of one eye with the model, row by row. Eye 0 is the left or only eye.
pub fn picture(setup: &FieldSetup, eye: usize) -> Vec<RenderedRay> {
    let tracer = setup.tracer();
    pixels(setup)
        .map(|(x, y)| rendered_ray(setup, &tracer.trace(eye, x, y)))
        .collect()
}

/// Converts `end`, the model's result of a ray, to the form of the comparison.
pub fn rendered_ray(setup: &FieldSetup, end: &RayEnd) -> RenderedRay {
    let coded = setup.world_depth.distance(setup.depth_code(end));
    RenderedRay {
        outcome: outcome(end, depth(setup, end.depth), setup.spheres()),
        coded: coded.map(|depth| depth.to_num()),
        steps: end.evaluations,
    }
}

/// Converts the model's depth along the camera's n, in the format of [`RayEnd::depth`], to world units.
pub fn depth(setup: &FieldSetup, depth: u64) -> f64 {
    let units = depth as f64 * (-21.0 - f64::from(setup.exponent)).exp2();
    units / setup.scale.to_num::<f64>()
}

/// Returns the largest depth of a hit by a ray, in world units along the camera's n. `direction` is the ray's direction, whose component
/// along n is 1.
pub fn reach(setup: &FieldSetup, eye: usize, direction: Vector) -> f64 {
    match &setup.form {
        Form::Exits(exits) => exited::reach(exits, eye, direction),
        Form::Marching(marching) => depth(setup, marching.depth_of(Marching::FARTHEST)),
    }
}

/// Computes the reference picture up to the far limit of the model's rays. The numbers of `camera` must be exact in the formats
/// of a `View`.
fn expected(setup: &FieldSetup, field: &Field, camera: &Camera) -> Vec<Expected> {
    let size = Size {
        width: setup.width,
        height: setup.height,
    };
    let reaches: Vec<f64> = pixels(setup)
        .map(|(x, y)| {
            let ray = camera.ray([x, y].map(f64::from), size);
            reach(setup, 0, ray.direction)
        })
        .collect();
    let farthest = reaches.iter().copied().fold(0.0, f64::max);
    let limits = (camera.near, farthest);
    let mut picture = metrics::expected(field, size, limits, |pixel| camera.ray(pixel, size));
    for (pixel, reach) in picture.iter_mut().zip(reaches) {
        pixel.hit = pixel.hit.filter(|hit| hit.t <= reach);
    }
    picture
}

/// Returns column and row of every pixel of a picture, row by row.
fn pixels(setup: &FieldSetup) -> impl Iterator<Item = (u32, u32)> {
    let width = setup.width;
    (0..setup.height).flat_map(move |y| (0..width).map(move |x| (x, y)))
}

impl Field {
    /// Converts `scene`, a field of `glint_core`, to the reference's solid with the same numbers.
    pub fn of(scene: &Scene) -> Self {
        match scene {
            Scene::Primitive(primitive) => Self::of_primitive(primitive),
            Scene::Union(union) => {
                let [a, b] = [union.first(), union.spheres()]
                    .map(|member| Box::new(Self::of_primitive(member)));
                match union.blend().to_num() {
                    0.0 => Self::Union(a, b),
                    k => Self::SmoothUnion { k, a, b },
                }
            }
        }
    }

    fn of_primitive(primitive: &Primitive) -> Self {
        let number = |x: Q32_32| x.to_num::<f64>();
        match *primitive {
            Primitive::Menger(Menger { depth }) => Self::Menger {
                depth: depth.into(),
            },
            Primitive::Box(Cuboid { half }) => Self::Box {
                half: half.map(number),
            },
            Primitive::Cubes(Cubes { period, half }) => Self::Boxes {
                period: number(period),
                half: [number(half); 3],
            },
            Primitive::Boxes(Boxes { period, half }) => Self::Boxes {
                period: number(period),
                half: half.map(|side| match number(side) {
                    touching if 2.0 * touching >= number(period) => f64::INFINITY,
                    side => side,
                }),
            },
            Primitive::Planes(Planes { half }) => Self::Planes { half: number(half) },
            Primitive::Octahedron(Octahedron { size }) => Self::Convex(
                (0..8)
                    .map(|signs| Plane {
                        normal: [0, 1, 2].map(|i| if signs >> i & 1 == 1 { 1.0 } else { -1.0 }),
                        offset: number(size),
                    })
                    .collect(),
            ),
            Primitive::Sphere(CentredSphere { radius }) => Self::Spheres(vec![Sphere {
                centre: [0.0; 3],
                radius: number(radius),
            }]),
            Primitive::Spheres(ref spheres) => Self::Spheres(
                spheres
                    .iter()
                    .map(|sphere| Sphere {
                        centre: sphere.centre.map(number),
                        radius: number(sphere.radius),
                    })
                    .collect(),
            ),
            Primitive::Lattice(Lattice { period, radius }) => Self::Lattice {
                period: number(period),
                radius: number(radius),
            },
            Primitive::Cone(Cone { radius, height }) => Self::Cone {
                radius: number(radius),
                height: number(height),
            },
            Primitive::Moving(MovingSphere {
                radius,
                orbit,
                angle,
            }) => {
                let angle = f64::from(angle.0) * (-32f64).exp2() * std::f64::consts::TAU;
                let orbit = number(orbit);
                Self::Spheres(vec![Sphere {
                    centre: [orbit * angle.cos(), orbit * angle.sin(), 0.0],
                    radius: number(radius),
                }])
            }
        }
    }
}

/// A field, a camera and the reference picture.
pub struct Subject {
    /// Name of the camera's position.
    pub name: String,
    /// Text form of the field.
    pub scene: String,
    /// Size of the picture: width and height in pixels.
    pub size: (u32, u32),
    /// The camera, with numbers exactly representable in a view.
    pub camera: Camera,
    /// The field as the reference's solid.
    pub field: Field,
    /// The reference picture, with hits up to the default far limit of the model's rays.
    pub expected: Vec<Expected>,
    /// The field in the form of `glint_core`.
    pub parsed: Scene,
    view: View,
}

impl Subject {
    /// Makes a subject and computes its reference picture. `scene` is the
    /// text form of a field, and `size` is one of [`glint_model::SIZES`].
    ///
    /// # Panics
    /// If the field, the camera or the size is invalid.
    pub fn new(name: &str, scene: &str, camera: &Camera, size: (u32, u32)) -> Self {
        let parsed = Scene::parse(scene).expect("a field");
        let view = camera.view().expect("a camera");
        let mut subject = Self {
            name: name.to_owned(),
            scene: scene.to_owned(),
            size,
            camera: Camera::of(&view),
            field: Field::of(&parsed),
            expected: vec![],
            parsed,
            view,
        };
        let setup = subject.setup(&FieldOptions::default());
        subject.expected = expected(&setup, &subject.field, &subject.camera);
        subject
    }

    /// Returns the model's constants of a frame of this subject with these options.
    pub fn setup(&self, options: &FieldOptions) -> FieldSetup {
        FieldSetup::new(&self.parsed, &self.view, self.size, options).expect("a supported size")
    }

    /// Whether the model draws this subject by exits.
    pub fn is_drawn_by_exits(&self) -> bool {
        Exits::draws(&self.parsed)
    }

    /// Draws this subject with the model and these options.
    pub fn picture(&self, options: &FieldOptions) -> Vec<RenderedRay> {
        picture(&self.setup(options), 0)
    }

    /// Draws this subject with the model and the options of its field, and compares the picture with the reference.
    pub fn measure(&self) -> Measured {
        let picture = self.picture(&FieldOptions::of(&self.parsed));
        Measured::new(&self.expected, &picture)
    }
}

/// Returns subjects with the Menger sponge of depth 4, one for each of the [`views`].
pub fn sponges(size: (u32, u32)) -> Vec<Subject> {
    views::views()
        .into_iter()
        .map(|(name, eye, target)| {
            Subject::new(name, "menger:4", &views::camera(eye, target), size)
        })
        .collect()
}

/// Returns subjects with the flat fields (with plane faces) other than the sponge, seen from the side. All of these fields except
/// the box extend to the horizon.
pub fn others(size: (u32, u32)) -> Vec<Subject> {
    let camera = views::camera([1.25, -1.875, 0.40625], [0.0; 3]);
    [
        "box:1,0.5,0.25",
        "cubes:0.25,0.1",
        "cubes:2,0.5",
        "planes:12",
        "planes:0.5",
    ]
    .map(|scene| Subject::new("aside", scene, &camera, size))
    .into()
}

/// Returns subjects with round fields (with spheres) and with unions, each seen from the side and from within.
pub fn rounds(size: (u32, u32)) -> Vec<Subject> {
    let scenes = [
        "sphere:1",
        "sphere:0.25",
        "spheres:0,0,0,0.75;1,0.25,0.5,0.5;-0.75,-0.5,0.75,0.25;0.5,-1,-0.25,0.375;\
         0.25,1,-0.5,0.5;0,-0.75,0.5,0.125;-1.25,0.5,-0.25,0.625;1.125,-0.5,-0.5,0.0625",
        "lattice:1,0.3",
        "moving:0.375,0.75,60",
        "union:menger:3+moving:0.5,1,60",
        "union:box:0.5,0.25,1+sphere:0.625",
        "smooth:0.25,box:1,1,0.25+sphere:0.625",
        "smooth:0.1,menger:3+moving:0.5,1,60",
    ];
    let target = [0.015625, 0.0, 0.03125];
    let views = [
        ("aside", [2.1875, 1.6875, 1.3125], 0.9),
        ("amid", [0.375, -1.3125, 0.53125], 1.5),
    ];
    scenes
        .into_iter()
        .flat_map(|scene| {
            views.map(|(name, eye, half_width)| {
                let camera = Camera::looking(eye, target, half_width, 0.01);
                Subject::new(name, scene, &camera, size)
            })
        })
        .collect()
}

/// Errors of a picture, and its number of evaluations of the field's distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// Errors of the picture, with depths computed from the rays' parameters t.
    pub accuracy: Accuracy,
    /// Errors of the depths from depth codes, over the pixels that hit in both picture and reference.
    pub coded: Option<Quantiles>,
    /// Number of evaluations of the field by all rays.
    pub evaluations: u64,
    /// Largest number of evaluations by a single ray.
    pub most: u32,
}

impl Measured {
    /// Compares a picture, or the concatenated rays of several pictures, with the reference.
    pub fn new(expected: &[Expected], found: &[RenderedRay]) -> Self {
        let outcomes =
            |of: fn(&RenderedRay) -> RayOutcome| found.iter().map(of).collect::<Vec<_>>();
        Self {
            accuracy: accuracy(expected, &outcomes(|ray| ray.outcome)),
            coded: accuracy(expected, &outcomes(RenderedRay::by_code)).depth,
            evaluations: found.iter().map(|ray| u64::from(ray.steps)).sum(),
            most: found.iter().map(|ray| ray.steps).max().unwrap_or(0),
        }
    }

    /// Returns the mean number of evaluations per ray.
    pub fn cost(&self) -> f64 {
        self.evaluations as f64 / self.accuracy.rays.max(1) as f64
    }
}
