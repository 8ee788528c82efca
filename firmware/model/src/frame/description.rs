//! The description of a picture: subject, camera, size and light.

use glint_core::appearance::Appearance;
use glint_core::camera::View;
use glint_core::colour::{Rgb565, Rounding, Shading, Winding};
use glint_core::feature::{ANTIALIASING, FIELD, MESH, MESH_IN_FIELD, OBJECT, TEXTURE};
use glint_core::field::Field;
use glint_core::fixed::U4_28;
use glint_core::light::{Background, Gradient, MeshLighting, Rgb};
use glint_core::matrix::Matrix;
use glint_core::mesh::Mesh;
use glint_core::picture::{Edges, Quarter, Samples, Size, Window};
use glint_core::quality::Quality;
use glint_core::rectangle::Rectangle;
use glint_core::stereo::Stereo;
use glint_core::texture::Texture;

use crate::raymarch::FieldOptions;
use crate::triangle::{Clip, MeshLight, Options, Placement};
use crate::wireframe::WireframeSubject;

/// The description of one picture.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    /// What the picture shows, for example a mesh or a field.
    pub subject: Subject<'a>,
    /// Camera. Not used for a wireframe, whose program contains its eye and view plane.
    pub view: View,
    /// Width and height of the picture.
    pub size: Size,
    /// Number of samples that are averaged to a pixel.
    pub samples: Samples,
    /// The quarter to draw, if the frame [is divided](Self::is_divided).
    pub quarter: Quarter,
    /// Background: the colour of pixels without a triangle. A field covers every pixel.
    pub clear: Rgb565,
    /// A sky or another gradient, which is drawn in place of `clear` behind meshes and their edges.
    pub sky: Option<Gradient>,
    /// Density of the fog on the meshes per world unit: transmittance is e^(−density · z) at depth z. 0 is no fog. The fog of a field is
    /// in the field's appearance.
    pub fog: U4_28,
    /// How colours are rounded to RGB565.
    pub rounding: Rounding,
    /// Light on the meshes. A field, and a mesh in it, have the lights of the field's appearance.
    pub lighting: MeshLighting,
    /// The replacement texture, which all faces with a texture show in place of their own; `None` for their own textures.
    pub replacement_texture: Option<Texture<'a>>,
    /// Two eyes for a stereo picture, or `None` for one eye.
    pub stereo: Option<Stereo>,
    /// Rectangles in front of everything else, which are drawn in their order.
    pub rectangles: &'a [Rectangle<'a>],
}

/// What the picture of a frame shows.
#[derive(Clone, Copy, Debug)]
pub enum Subject<'a> {
    /// One mesh, in world coordinates.
    Mesh(MeshSubject<'a>),
    /// The edges of a mesh: [`Frame::draw`] draws only the faces, and [`Frame::draw_edges`] draws the edges. Create this subject with
    /// [`Subject::edges`].
    Edges(MeshSubject<'a>, Edges),
    /// One distance field.
    Field(FieldSubject<'a>),
    /// A mesh and a distance field that hide each other by depth.
    MeshInField(MeshSubject<'a>, FieldSubject<'a>),
    /// Several meshes, each with its own model matrix. At equal depths the later object hides the earlier object.
    Objects(&'a [Object<'a>]),
    /// A program of the wireframe simulator.
    Wireframe(WireframeSubject<'a>),
}

/// A mesh with a position in the world.
// The order of the fields saves data cache lines, as in `Placement`.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Object<'a> {
    /// Colour that replaces the colours of the mesh.
    pub colour: Option<Rgb565>,
    /// The mesh and its drawing options.
    pub subject: MeshSubject<'a>,
    /// Position and orientation: a model matrix.
    pub placement: Placement,
}

/// A mesh and its drawing options.
#[derive(Clone, Copy, Debug)]
pub struct MeshSubject<'a> {
    /// The mesh to draw.
    pub mesh: Mesh<'a>,
    /// Whether back faces are culled.
    pub cull: bool,
    /// Source of the colours: triangles (flat) or vertices (smooth).
    pub shading: Shading,
    /// The volume to which triangles are clipped.
    pub clip: Clip,
    /// The rule that selects the visible side of a triangle.
    pub winding: Winding,
    /// Whether the textures of the mesh are drawn.
    pub textures: bool,
}

/// A distance field and its drawing options.
#[derive(Clone, Copy, Debug)]
pub struct FieldSubject<'a> {
    /// The field to draw.
    pub field: &'a Field,
    /// Material, lights, background, fog and occlusion.
    pub appearance: &'a Appearance,
    /// Quality, which determines the precision of the rays. The size of the picture is in [`Frame`].
    pub quality: Quality,
}

impl<'a> MeshSubject<'a> {
    fn options(&self) -> Options<'a> {
        Options {
            cull: self.cull,
            shading: self.shading,
            winding: self.winding,
            textures: self.textures,
            ..Options::default()
        }
    }

    /// Whether back faces are culled: with [`Winding::Screen`] no triangle is culled.
    pub fn culls(&self) -> bool {
        self.cull && self.winding == Winding::Mesh
    }

    /// Whether the mesh has textures that are drawn.
    pub const fn has_textures(&self) -> bool {
        TEXTURE.is_built && self.textures && self.mesh.has_textures()
    }

    /// A mesh with flat shading, culled back faces, clipping to the guard band, its own winding, and its textures.
    pub const fn new(mesh: Mesh<'a>) -> Self {
        Self {
            mesh,
            cull: true,
            shading: Shading::Flat,
            clip: Clip::Guard,
            winding: Winding::Mesh,
            textures: true,
        }
    }
}

impl<'a> Subject<'a> {
    /// A mesh with the options of [`MeshSubject::new`].
    pub const fn mesh(mesh: Mesh<'a>) -> Self {
        Self::Mesh(MeshSubject::new(mesh))
    }

    /// The edges of a mesh. Faces that only hide edges are black, so they are shaded flat.
    pub const fn edges(mesh: MeshSubject<'a>, edges: Edges) -> Self {
        let shading = match edges {
            Edges::Hidden => Shading::Flat,
            Edges::Over => mesh.shading,
        };
        Self::Edges(MeshSubject { shading, ..mesh }, edges)
    }

    /// The mesh, if the subject has one.
    pub const fn mesh_part(&self) -> Option<&MeshSubject<'a>> {
        match self {
            Self::Mesh(mesh) | Self::Edges(mesh, _) | Self::MeshInField(mesh, _)
                if MESH.is_built =>
            {
                Some(mesh)
            }
            Self::Mesh(_)
            | Self::Edges(..)
            | Self::MeshInField(..)
            | Self::Field(_)
            | Self::Objects(_)
            | Self::Wireframe(_) => None,
        }
    }

    /// The objects, if the subject has several meshes.
    pub const fn objects(&self) -> Option<&'a [Object<'a>]> {
        match self {
            Self::Objects(objects) if OBJECT.is_built => Some(objects),
            Self::Mesh(_)
            | Self::Edges(..)
            | Self::MeshInField(..)
            | Self::Field(_)
            | Self::Objects(_)
            | Self::Wireframe(_) => None,
        }
    }

    /// All meshes, in their order.
    pub fn meshes(&self) -> impl Iterator<Item = &MeshSubject<'a>> {
        let objects = self.objects().unwrap_or_default();
        let objects = objects.iter().map(|object| &object.subject);
        self.mesh_part().into_iter().chain(objects)
    }

    /// All meshes with their model matrices; none for a field, with or without a mesh.
    pub fn placed_meshes(&self) -> impl Iterator<Item = (Mesh<'a>, Matrix)> + Clone {
        let mesh = self.mesh_part().filter(|_| self.field_part().is_none());
        let mesh = mesh.map(|subject| (subject.mesh, Matrix::IDENTITY));
        let objects = self.objects().unwrap_or_default().iter();
        let objects = objects.map(|object| (object.subject.mesh, *object.placement.matrix()));
        mesh.into_iter().chain(objects)
    }

    /// The mesh with this number, and the colour that replaces the colours of the mesh; `None` after the last mesh.
    #[inline(always)]
    pub fn coloured_mesh(&self, number: usize) -> Option<(&MeshSubject<'a>, Option<Rgb565>)> {
        match self {
            Self::Objects(objects) if OBJECT.is_built => {
                let object = objects.get(number)?;
                Some((&object.subject, object.colour))
            }
            Self::Mesh(_)
            | Self::Edges(..)
            | Self::MeshInField(..)
            | Self::Field(_)
            | Self::Objects(_)
            | Self::Wireframe(_) => self.coloured_part().filter(|_| number == 0),
        }
    }

    /// The mesh of a subject without objects, and the colour that replaces the colours of the mesh.
    // Not inlined, so that `coloured_mesh`, which the firmware calls for each object of a frame, is short and has no jump table.
    #[inline(never)]
    fn coloured_part(&self) -> Option<(&MeshSubject<'a>, Option<Rgb565>)> {
        let is_hidden = matches!(self, Self::Edges(_, Edges::Hidden));
        Some((self.mesh_part()?, is_hidden.then_some(Rgb565(0))))
    }

    /// The field, if the subject has one.
    pub const fn field_part(&self) -> Option<&FieldSubject<'a>> {
        match self {
            Self::Field(field) | Self::MeshInField(_, field) if FIELD.is_built => Some(field),
            Self::Mesh(_)
            | Self::Edges(..)
            | Self::MeshInField(..)
            | Self::Field(_)
            | Self::Objects(_)
            | Self::Wireframe(_) => None,
        }
    }
}

impl FieldSubject<'_> {
    pub(super) fn options(&self, view: &View, stereo: Option<Stereo>) -> FieldOptions {
        FieldOptions::new(self.field, self.appearance, self.quality, stereo, view)
    }
}

impl<'a> Frame<'a> {
    /// A frame with one eye, one sample a pixel, a black background, white light at the camera for its meshes, and no rectangles.
    pub const fn new(subject: Subject<'a>, view: View, size: Size) -> Self {
        Self {
            subject,
            view,
            size,
            samples: Samples::One,
            quarter: Quarter::ALL[0],
            clear: Rgb565(0),
            sky: None,
            fog: U4_28::ZERO,
            rounding: Rounding::Dithered,
            lighting: MeshLighting::CAMERA,
            replacement_texture: None,
            stereo: None,
            rectangles: &[],
        }
    }

    /// Whether the frame is drawn one quarter at a time, because its samples form a picture that is larger than the largest size.
    #[inline(always)]
    pub const fn is_divided(&self) -> bool {
        self.window().quarter.is_some()
    }

    /// The samples to draw: those of the whole picture, or of the quarter `quarter` if the frame [is divided](Self::is_divided).
    #[inline(always)]
    pub const fn window(&self) -> Window {
        match (self.drawn_samples(), self.size.doubled()) {
            (Samples::One, _) => Window::whole(self.size),
            (Samples::Four, Some(size)) => Window::whole(size),
            (Samples::Four, None) => Window {
                size: self.size,
                quarter: Some(self.quarter),
            },
        }
    }

    /// The number of samples per pixel that are drawn: always one in a build without antialiasing.
    #[inline(always)]
    pub const fn drawn_samples(&self) -> Samples {
        if ANTIALIASING.is_built {
            self.samples
        } else {
            Samples::One
        }
    }

    /// The frames into which this frame is divided, to be drawn in this order: one for each quarter, or only this frame.
    pub fn parts(&self) -> impl Iterator<Item = Self> {
        let count = if self.is_divided() {
            Quarter::ALL.len()
        } else {
            1
        };
        let quarters = Quarter::ALL.into_iter().take(count);
        quarters.map(|quarter| Self { quarter, ..*self })
    }

    /// The rectangles to draw: none in a build without textures.
    // Inlined, like all conditions on rectangles, so that builds without textures contain no code for rectangles.
    #[inline(always)]
    pub const fn drawn_rectangles(&self) -> &'a [Rectangle<'a>] {
        if TEXTURE.is_built {
            self.rectangles
        } else {
            &[]
        }
    }

    /// A frame with one eye, and with the mesh lights and the background of `appearance`. If `appearance` has no background, `default` is
    /// used. Wireframes and hidden edges have a black background.
    pub fn in_appearance(
        subject: Subject<'a>,
        view: View,
        size: Size,
        appearance: &Appearance,
        default: Background,
    ) -> Self {
        let background = appearance.background.unwrap_or(default);
        let [_, horizon] = background.colours();
        let (clear, sky, fog) = match subject {
            Subject::Mesh(_) | Subject::Objects(_) | Subject::Edges(_, Edges::Over) => (
                Rgb565::from_rgb888(horizon),
                background.gradient(),
                appearance.fog,
            ),
            Subject::Edges(_, Edges::Hidden)
            | Subject::Field(_)
            | Subject::MeshInField(..)
            | Subject::Wireframe(_) => (Rgb565(0), None, U4_28::ZERO),
        };
        Self {
            clear,
            sky,
            fog,
            lighting: appearance.mesh_lighting(),
            ..Self::new(subject, view, size)
        }
    }

    /// The mesh with this number, and its drawing options with the light [`FrameConstants::light`](super::FrameConstants::light); `None`
    /// after the last mesh. The option `clear` has no effect.
    pub fn numbered_mesh<'s>(
        &'s self,
        number: usize,
        light: Option<&'s MeshLight>,
    ) -> Option<(&'s MeshSubject<'a>, Options<'s>)> {
        let (subject, colour) = self.subject.coloured_mesh(number)?;
        let object = self
            .subject
            .objects()
            .and_then(|objects| objects.get(number));
        let placement = object.map(|object| &object.placement);
        let options = Options {
            colour,
            light,
            normals: placement.and_then(Placement::normals),
            replacement_texture: self.replacement_texture.as_ref(),
            lit_in_world: placement.is_some_and(Placement::has_normals_in_world),
            ..subject.options()
        };
        Some((subject, options))
    }

    /// The density and the colour of the fog on the meshes. The colour is that of the background at the horizon. Both are the frame's or,
    /// for a mesh in a field, those of the field's appearance.
    pub fn mesh_fog(&self) -> (U4_28, Rgb) {
        match &self.subject {
            Subject::MeshInField(_, field) if MESH_IN_FIELD.is_built => {
                let [_, horizon] = field.appearance.field_background().colours();
                (field.appearance.fog, horizon)
            }
            Subject::Mesh(_)
            | Subject::Edges(..)
            | Subject::MeshInField(..)
            | Subject::Field(_)
            | Subject::Objects(_)
            | Subject::Wireframe(_) => {
                let gradient = self.sky.map(|Gradient { colours, .. }| colours);
                let [_, horizon, _] = gradient.unwrap_or([self.clear.to_rgb888(); 3]);
                (self.fog, horizon)
            }
        }
    }

    /// The lighting of the meshes: the frame's lighting or, for a mesh in a field, the lighting of the field's appearance.
    pub fn mesh_lighting(&self) -> MeshLighting {
        match &self.subject {
            Subject::MeshInField(_, field) if MESH_IN_FIELD.is_built => {
                field.appearance.mesh_lighting()
            }
            Subject::Mesh(_)
            | Subject::Edges(..)
            | Subject::MeshInField(..)
            | Subject::Field(_)
            | Subject::Objects(_)
            | Subject::Wireframe(_) => self.lighting,
        }
    }
}
