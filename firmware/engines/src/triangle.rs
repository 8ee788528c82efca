//! Converts the frame constants of meshes to geometry passes.

use glint_core::camera::Projection;
use glint_core::mesh::{Mesh, Rgb565};
use glint_core::picture::{Samples, Size, Window};
use glint_hal::triangle::{
    self, Average, DepthScale, GeometryStart, Lists, Prepared, Quarter, Textures, TriangleEngine,
};
use glint_model::triangle::descriptor::Layout;
use glint_model::{Fog, MeshLight, MeshSetup, Shading, Sky};

/// A geometry pass of a mesh.
#[derive(Clone, Copy, Debug)]
pub struct MeshPass<'a> {
    /// The mesh to draw.
    pub mesh: &'a Mesh<'a>,
    /// The part of the picture to draw.
    pub window: Window,
    /// The frame constants of the mesh for `window`.
    pub frame: &'a MeshSetup,
    /// Colours of the light on the mesh; `None` for white light at the camera, without ambient light. The direction of the light is in
    /// `frame`. With smooth shading and without `cull`, ambient light is not allowed.
    pub light: Option<&'a MeshLight>,
    /// Whether back faces are culled.
    pub cull: bool,
    /// Source of the colours; `Flat` if the engine has no smooth shading.
    pub shading: Shading,
    /// Colour that replaces the colours of the mesh.
    pub colour: Option<Rgb565>,
    /// The textures of the mesh, if they are drawn; only under flat shading.
    pub textures: Option<Textures<'a>>,
    /// Empty memory for the output of the pass. `None` appends to the output of the previous pass, which must have the same picture size
    /// and light colours.
    pub lists: Option<Lists>,
}

impl MeshPass<'_> {
    /// Writes the registers of the pass with [`TriangleEngine::prepare_geometry`]. The previous pass must have ended, or have been
    /// started at least 128 clock cycles ago.
    pub fn prepare(&self, engine: &mut TriangleEngine) -> Prepared {
        let (frame, quarter) = (self.frame, self.window.quarter);
        let light = self.light;
        let (light, ambient) =
            light.map_or(MeshLight::PLAIN, |light| (light.colour, light.ambient));
        engine.prepare_geometry(&triangle::Geometry {
            mesh: self.mesh.records().as_flattened(),
            options: GeometryStart::default()
                .with_size(size_code(self.window.size))
                .with_cull(self.cull)
                .with_smooth(self.shading == Shading::Smooth)
                .with_orthographic(frame.projection == Projection::Orthographic)
                .with_mirror(frame.mirrors)
                .with_quarter(quarter.is_some())
                .with_right(quarter.is_some_and(|quarter| quarter.is_right))
                .with_lower(quarter.is_some_and(|quarter| quarter.is_lower)),
            scale_shift: frame.engine_shift() as u8,
            u: &frame.u,
            v: &frame.v,
            n: &frame.n,
            light: &frame.light,
            translation: &frame.translation,
            near: frame.near,
            depth_scale: DepthScale::default()
                .with_mantissa(frame.depth.mantissa)
                .with_exponent(frame.depth.exponent as u8),
            lights: [light, ambient],
            colour: self.colour.map(|colour| colour.0),
            textures: self.textures,
            lists: self.lists,
        })
    }
}

/// The sky of a raster pass; `is_first` if the pass blends textures with the sky.
#[must_use]
pub const fn sky(sky: &Sky, is_first: bool) -> triangle::Sky {
    triangle::Sky {
        above: sky.above,
        across: sky.across,
        down: sky.down,
        zenith: sky.zenith,
        horizon: sky.horizon,
        nadir: sky.nadir,
        is_first,
    }
}

/// The averaging of samples in a raster pass that draws this window of a frame; `None` for one sample per pixel.
#[must_use]
pub fn average(samples: Samples, window: Window) -> Option<Average> {
    let quarter = window.quarter.map(|quarter| Quarter {
        is_right: quarter.is_right,
        is_lower: quarter.is_lower,
    });
    (samples == Samples::Four).then_some(Average { quarter })
}

/// The fog of a raster pass.
#[must_use]
pub const fn fog(fog: &Fog) -> triangle::Fog {
    triangle::Fog {
        offset: fog.offset,
        colour: fog.colour,
    }
}

/// The layout of an engine's descriptors.
#[must_use]
pub fn layout(engine: &TriangleEngine) -> Layout {
    Layout {
        is_textured: engine.draws_textures(),
        is_smooth: engine.shades_smoothly(),
    }
}

/// The register value for a picture size.
#[must_use]
pub const fn size_code(size: Size) -> triangle::Size {
    match size {
        Size::W320 => triangle::Size::W320,
        Size::W640 => triangle::Size::W640,
        Size::W1280 => triangle::Size::W1280,
    }
}
