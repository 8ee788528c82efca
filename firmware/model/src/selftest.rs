//! Pictures of the self-test, and the checksums of their colours: the CRC-32 of the colours, row by row, the low byte of each colour first.
//!
//! The firmware draws each picture with the gateware, and compares its checksum with the model's checksum. A test of this crate
//! computes and stores the checksums.

mod checksums;

use glint_core::appearance::Appearance;
use glint_core::camera::{View, ViewError};
use glint_core::colour::{Rgb565, Shading};
use glint_core::feature::{ANTIALIASING, EDGES, FIELD, MESH, SPHERES, STEREO, TEXTURE, WIREFRAME};
use glint_core::field::Field;
use glint_core::fixed::{Q32_32, Turns};
use glint_core::mesh::Mesh;
use glint_core::picture::{Edges, Samples, Size};
use glint_core::quality::Quality;
use glint_core::rectangle::{Part, Rectangle};
use glint_core::shape::Shape;
use glint_core::stereo::{Stereo, Tint};
use glint_core::texture::{self, Blend, Picture, Texture};
use glint_core::wireframe::{CUBE, Motion, Program};

use crate::{FieldSubject, Frame, MeshSubject, Subject, WireframeSubject};

/// A picture of the self-test. Each picture needs a different part of the gateware.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TestPicture {
    /// The torus with flat shading: the triangle engine.
    Triangle,
    /// The torus with smooth shading.
    Smooth,
    /// The torus with four samples a pixel: averages.
    Average,
    /// The torus behind rectangles: textures.
    Texture,
    /// The cube of the wireframe simulator: the line engine.
    Line,
    /// A sponge of three levels: the raymarcher.
    Sponge,
    /// A field of repeated cubes.
    Cubes,
    /// A field of two spheres: the sphere unit of the raymarcher.
    Spheres,
    /// Repeated cubes for two eyes.
    Stereo,
    /// The hidden edges of the torus behind rectangles: textures after lines.
    TextureLine,
    /// Repeated cubes for two eyes behind rectangles: textures after a field.
    TextureStereo,
}

/// The mesh of all pictures with a mesh.
pub const MESH_SHAPE: Shape = Shape::Torus;

impl TestPicture {
    /// All pictures, in the order of their definition.
    pub const ALL: [Self; 11] = [
        Self::Triangle,
        Self::Smooth,
        Self::Average,
        Self::Texture,
        Self::Line,
        Self::Sponge,
        Self::Cubes,
        Self::Spheres,
        Self::Stereo,
        Self::TextureLine,
        Self::TextureStereo,
    ];

    /// Name for messages: the gateware block, and the feature of the block that the picture needs.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Triangle => "triangle flat",
            Self::Smooth => "triangle smooth",
            Self::Average => "triangle average",
            Self::Texture => "triangle texture",
            Self::Line => "line",
            Self::Sponge => "raymarch sponge",
            Self::Cubes => "raymarch cubes",
            Self::Spheres => "raymarch spheres",
            Self::Stereo => "raymarch stereo",
            Self::TextureLine => "line texture",
            Self::TextureStereo => "raymarch texture",
        }
    }

    /// Whether this build of the firmware includes the code that draws the picture.
    pub const fn is_built(self) -> bool {
        match self {
            Self::Triangle | Self::Smooth => MESH.is_built,
            Self::Average => MESH.is_built && ANTIALIASING.is_built,
            Self::Texture => TEXTURE.is_built,
            Self::Line => WIREFRAME.is_built,
            Self::Sponge | Self::Cubes => FIELD.is_built,
            Self::Spheres => SPHERES.is_built,
            Self::Stereo => STEREO.is_built,
            Self::TextureLine => TEXTURE.is_built && EDGES.is_built,
            // This picture is drawn as two frames, one per eye, which builds without meshes do not support.
            Self::TextureStereo => TEXTURE.is_built && STEREO.is_built && MESH.is_built,
        }
    }

    /// The stored checksum of the colours.
    pub const fn stored(self) -> u32 {
        checksums::STORED[self as usize]
    }

    /// Calls `draw` with the description of the picture. `mesh` is the mesh of [`MESH_SHAPE`].
    ///
    /// # Errors
    /// [`ViewError`] for a camera out of range; never returned, because all pictures have valid cameras.
    pub fn describe(
        self,
        mesh: Option<Mesh>,
        draw: &mut dyn FnMut(&Frame),
    ) -> Result<(), ViewError> {
        let degrees = |degrees| Turns::from_degrees(Q32_32::from_num(degrees));
        let view = match self {
            // From within the torus, so that triangles are clipped.
            Self::Texture if TEXTURE.is_built => {
                let (zero, up) = (Q32_32::ZERO, Q32_32::lit("0.3"));
                View::look([zero, zero, up], degrees(0), degrees(10), degrees(0))?
            }
            _ => View::spherical(Q32_32::lit("2.5"), degrees(40), degrees(65))?,
        };
        let stereo = matches!(self, Self::Stereo | Self::TextureStereo).then_some(EYES);
        let samples = match self {
            Self::Average => Samples::Four,
            _ => Samples::One,
        };
        let mut memory = Aligned([0; _]);
        let rectangles = match self {
            Self::Texture | Self::TextureLine | Self::TextureStereo if TEXTURE.is_built => {
                rectangles(&mut memory.0)
            }
            _ => None,
        };
        let mut draw = |subject| {
            draw(&Frame {
                stereo,
                samples,
                rectangles: rectangles.as_ref().map_or(&[], |all| all),
                ..Frame::new(subject, view, Size::W320)
            });
        };
        if MESH.is_built
            && let (Some(shading), Some(mesh)) = (self.shading(), mesh)
        {
            let mesh = MeshSubject {
                shading,
                ..MeshSubject::new(mesh)
            };
            draw(if EDGES.is_built && self == Self::TextureLine {
                Subject::edges(mesh, Edges::Hidden)
            } else {
                Subject::Mesh(mesh)
            });
        }
        if WIREFRAME.is_built
            && self == Self::Line
            && let Ok(program) = Program::new_checked(CUBE.as_flattened())
        {
            let pose = Motion::default().pose();
            draw(Subject::Wireframe(WireframeSubject { program, pose }));
        }
        if FIELD.is_built
            && let Some(Ok(field)) = self.field().map(Field::parse)
        {
            draw(Subject::Field(FieldSubject {
                field: &field,
                appearance: &Appearance::default(),
                quality: Quality::default(),
            }));
        }
        Ok(())
    }

    const fn shading(self) -> Option<Shading> {
        match self {
            Self::Triangle | Self::Average | Self::Texture | Self::TextureLine => {
                Some(Shading::Flat)
            }
            Self::Smooth => Some(Shading::Smooth),
            Self::Line
            | Self::Sponge
            | Self::Cubes
            | Self::Spheres
            | Self::Stereo
            | Self::TextureStereo => None,
        }
    }

    /// The field in the notation of the console; `None` for a picture without a field.
    const fn field(self) -> Option<&'static str> {
        match self {
            Self::Sponge => Some("menger:3"),
            Self::Cubes | Self::Stereo | Self::TextureStereo => Some("cubes:2,0.4"),
            Self::Spheres => Some("spheres:0,0,0,0.6;0.9,0.1,-0.2,0.35"),
            Self::Triangle
            | Self::Smooth
            | Self::Average
            | Self::Texture
            | Self::Line
            | Self::TextureLine => None,
        }
    }
}

/// The texture of all rectangles: 8×8 texels, transparent in the corners and on a diagonal.
const PICTURE: Picture = Picture {
    size_log2: [3; 2],
    is_cut_out: true,
    is_atlas: true,
    blend: Blend::ALL[5],
    // The sum is truncated to 16 bits. Any colours are suitable, as long as neighbouring texels differ.
    texel: |[x, y]| ((x + y) % 7 != 0).then_some(Rgb565((x * 0x1F03 + y * 0x0841) as u16)),
};

/// Memory of a texture for the engine.
#[repr(align(16))]
struct Aligned([u8; 160]);

/// The rectangles of all pictures with textures: the first has one texel per pixel, and the second shows a mirrored and enlarged part, and
/// extends beyond the picture. Their texture is drawn in `memory`.
fn rectangles(memory: &mut [u8]) -> Option<[Rectangle<'_>; 2]> {
    texture::draw(memory, &PICTURE)?;
    let texture = Texture::new_checked(memory).ok()?;
    let part = |place, size| Part { place, size };
    let small = Rectangle::new(texture, part([0; 2], [8; 2]), [150, 80]);
    let large = Rectangle {
        place: [170, 60],
        size: [301, 77],
        part: part([1, 2], [6, 5]),
        is_mirrored: [true, false],
        ..small
    };
    Some([small, large])
}

/// The distance of the eyes, and the glasses, of all stereo pictures.
const EYES: Stereo = Stereo {
    half_separation: Q32_32::lit("0.05"),
    zero_parallax: Q32_32::lit("2.5"),
    tint: Tint::RedCyan,
};
