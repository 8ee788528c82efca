//! The built-in scenes of the designs that Glint unites: meshes, places, camera, light and options, for board and host.

use glint_core::camera::{UP, View, ViewError};
use glint_core::colour::{Shading, Winding};
use glint_core::fixed::{Q32_32, Turns, U8_28};
use glint_core::light::{Light, MeshLighting, Rgb};
use glint_core::mesh::Mesh;
use glint_core::object::Place;
use glint_core::shape::Shape;
use glint_core::words::Words;

use crate::frame::MeshSubject;
use crate::triangle::Clip;

/// The objects of the scene `objects`, each with its place in the words of the console: five meshes of 1,024 triangles.
const OBJECTS: [(Shape, &str); 5] = [
    (Shape::Sphere, "scale 0.8"),
    (Shape::Torus, "scale 1.5,1.5,0.8 rotate x 25 rotate y 15"),
    (
        Shape::Sphere,
        "scale 0.35,0.35,0.7 rotate x -30 move 0.1,1.05,0.2",
    ),
    (
        Shape::Cylinder,
        "scale 0.5,0.5,0.6 rotate x -25 move -0.1,-1.1,0.15",
    ),
    (
        Shape::Torus,
        "scale 0.45,-0.45,0.7 rotate y 75 rotate z 40 move 0.5,0.65,-0.15",
    ),
];

/// The mesh of the scene `simplegpu`.
pub const SIMPLEGPU: Shape = Shape::Polygons;

/// Camera, light and options of a scene.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// Camera.
    pub view: View,
    /// The light, and ambient light.
    pub lighting: MeshLighting,
    /// Options of the meshes.
    pub options: MeshOptions,
}

/// Options that all meshes of a scene have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MeshOptions {
    /// Whether back faces are left out.
    pub cull: bool,
    /// Source of the colours.
    pub shading: Shading,
    /// Clipping of triangles.
    pub clip: Clip,
    /// The rule that tells which side of a triangle is seen.
    pub winding: Winding,
}

/// The options of [`MeshSubject::new`].
impl Default for MeshOptions {
    fn default() -> Self {
        Self {
            cull: true,
            shading: Shading::Flat,
            clip: Clip::Guard,
            winding: Winding::Mesh,
        }
    }
}

impl MeshOptions {
    /// A mesh with these options.
    pub const fn subject<'a>(&self, mesh: Mesh<'a>) -> MeshSubject<'a> {
        MeshSubject {
            mesh,
            cull: self.cull,
            shading: self.shading,
            clip: self.clip,
            winding: self.winding,
        }
    }
}

impl Settings {
    /// The scene `objects`: Gouraud shading, and one coloured light in a fixed direction without ambient light.
    ///
    /// # Errors
    /// None, as a test shows.
    pub fn objects() -> Result<Self, ViewError> {
        let degrees = |degrees| Turns::from_degrees(Q32_32::const_from_int(degrees));
        Ok(Self {
            view: View::spherical(Q32_32::lit("2.2"), degrees(20), degrees(70))?,
            lighting: MeshLighting {
                ambient: [0; 3],
                light: light([3, -1, 2], [0xFF, 0xF0, 0xD8]),
            },
            options: MeshOptions {
                shading: Shading::Smooth,
                ..MeshOptions::default()
            },
        })
    }

    /// The scene `simplegpu`: a camera with a gaze and the direction z up, a field of view of 150°, clipping to the six planes of the
    /// view volume, the winding by the upper left vertex, and colours without light.
    ///
    /// # Errors
    /// None, as a test shows.
    pub fn simplegpu() -> Result<Self, ViewError> {
        let eye = [Q32_32::ZERO, Q32_32::lit("-1.2"), Q32_32::lit("0.3")];
        let gaze = [Q32_32::lit("0.1"), Q32_32::ONE, Q32_32::lit("-0.1")];
        let angle = Turns::from_degrees(Q32_32::lit("150"));
        Ok(Self {
            view: View::towards(eye, gaze, UP)?.with_field_of_view(angle)?,
            lighting: MeshLighting {
                ambient: [0xFF; 3],
                light: light([0, 0, 1], [0; 3]),
            },
            options: MeshOptions {
                clip: Clip::View {
                    far: U8_28::lit("3"),
                },
                winding: Winding::Screen,
                ..MeshOptions::default()
            },
        })
    }
}

/// A light in a direction, which is not 0.
fn light(towards: [i32; 3], colour: Rgb) -> Light {
    let light = Light::new(towards.map(Q32_32::from_num), colour);
    light.unwrap_or(Light::at_camera(colour))
}

/// Meshes and places of the scene `objects`.
pub fn objects() -> impl Iterator<Item = (Shape, Place)> {
    OBJECTS.into_iter().filter_map(|(shape, text)| {
        // A test parses all of them.
        let place = Place::parse(&mut Words::new(text)).ok()?;
        Some((shape, place))
    })
}
