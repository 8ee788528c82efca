//! The constants of a frame, which are computed once before drawing.

use glint_core::feature::{FIELD, FOG, MESH, MESH_IN_FIELD, OBJECT, SKY};
use glint_core::light::MeshLighting;
use glint_core::object::MAX_OBJECTS;

use super::description::{Frame, Object, Subject};
use crate::depth::DepthScale;
use crate::error::RenderError;
use crate::fog::Fog;
use crate::mesh_in_field;
use crate::raymarch::{FieldOptions, FieldSetup, Palette};
use crate::sky::Sky;
use crate::triangle::mesh_setup::Scale;
use crate::triangle::{MeshLight, MeshSetup};

/// Values of a frame that do not depend on the pixel or triangle, computed once before drawing.
///
/// The constants take about 3,700 bytes, mostly for the rays and the palette of a field. To save the time of a copy, keep one
/// `FrameConstants` and [update](Self::update) it for each frame.
#[derive(Clone, Debug, Default)]
pub struct FrameConstants {
    /// Constants of a single mesh, or the constants that all objects share.
    mesh: Option<MeshSetup>,
    scale: Scale,
    light: Option<MeshLight>,
    sky: Option<Sky>,
    fog: Option<Fog>,
    field: Option<FieldConstants>,
}

/// Frame constants of a field.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FieldConstants {
    /// Constants of the rays and of the solid.
    pub setup: FieldSetup,
    /// Colours of surfaces, sky and fog.
    pub palette: Palette,
}

impl FrameConstants {
    /// Returns the constants of the mesh, or the constants that all objects share; `None` for a frame without a mesh or objects.
    pub const fn mesh(&self) -> Option<&MeshSetup> {
        if MESH.is_built {
            self.mesh.as_ref()
        } else {
            None
        }
    }

    /// Returns the constants of the mesh with this number in `frame`; `None` after the last mesh. `self` must hold the constants of
    /// `frame`.
    ///
    /// The constants of an object are computed in `own`, which the caller reuses for all objects of a frame, in order: copying the
    /// shared constants, or storing the constants of all objects, would be slow on the soft core.
    ///
    /// # Errors
    /// A [`RenderError`] for an object that cannot be drawn.
    #[inline(always)]
    pub fn mesh_setup<'s>(
        &'s self,
        frame: &Frame,
        number: usize,
        own: &'s mut MeshSetup,
    ) -> Result<Option<&'s MeshSetup>, RenderError> {
        let (Some(objects), Some(camera)) = (frame.subject.objects(), &self.mesh) else {
            return Ok(self.mesh().filter(|_| number == 0));
        };
        let Some(Object {
            subject, placement, ..
        }) = objects.get(number)
        else {
            return Ok(None);
        };
        if number == 0 {
            *own = *camera;
        }
        own.volume = camera.volume_of(subject.clip)?;
        placement.update(own, &frame.view, camera, subject.mesh.radius())?;
        Ok(Some(own))
    }

    /// Returns a copy of the constants of the mesh with this number in `frame`; `None` after the last mesh.
    ///
    /// # Errors
    /// As [`mesh_setup`](Self::mesh_setup).
    #[inline(never)]
    pub fn numbered_mesh(
        &self,
        frame: &Frame,
        number: usize,
    ) -> Result<Option<MeshSetup>, RenderError> {
        let mut own = self.mesh.unwrap_or_default();
        Ok(self.mesh_setup(frame, number, &mut own)?.copied())
    }

    /// Checks that each mesh of `frame` can be drawn. `self` must hold the constants of `frame`.
    ///
    /// # Errors
    /// As [`mesh_setup`](Self::mesh_setup).
    pub fn check_meshes(&self, frame: &Frame) -> Result<(), RenderError> {
        let mut number = 0;
        while self.numbered_mesh(frame, number)?.is_some() {
            number += 1;
        }
        Ok(())
    }

    /// Returns the light on the meshes; `None` for white light at the camera, without ambient light.
    pub const fn light(&self) -> Option<&MeshLight> {
        self.light.as_ref()
    }

    /// Returns the sky behind the meshes, if the frame has a sky.
    pub const fn sky(&self) -> Option<&Sky> {
        if SKY.is_built {
            self.sky.as_ref()
        } else {
            None
        }
    }

    /// Returns the fog on the meshes, if the frame has fog.
    pub const fn fog(&self) -> Option<&Fog> {
        if FOG.is_built {
            self.fog.as_ref()
        } else {
            None
        }
    }

    /// Returns the constants of the field, if the frame has a field.
    pub const fn field(&self) -> Option<&FieldConstants> {
        if FIELD.is_built {
            self.field.as_ref()
        } else {
            None
        }
    }

    /// The scale between depth codes and distances in world units; `None` before the first frame.
    pub fn depth_scale(&self) -> Option<DepthScale> {
        match (self.mesh(), self.field()) {
            (Some(mesh), _) => Some(mesh.depth),
            (None, Some(field)) => Some(field.setup.world_depth),
            (None, None) => None,
        }
    }

    /// Replaces the constants by those of `frame`. Does not check objects; [`mesh_setup`](Self::mesh_setup) checks each object.
    ///
    /// # Errors
    /// A [`RenderError`] for a frame that cannot be drawn; `self` then holds no constants. [`RenderError::Stereo`] for a frame that must be
    /// drawn as two frames ([`Frame::eyes`]).
    pub fn update(&mut self, frame: &Frame) -> Result<(), RenderError> {
        let result = self.compute(frame);
        if result.is_err() {
            (self.mesh, self.sky, self.fog, self.field) = (None, None, None, None);
        }
        result
    }

    fn compute(&mut self, frame: &Frame) -> Result<(), RenderError> {
        (self.light, self.field) = (None, None);
        let (view, window) = (&frame.view, frame.window());
        if frame.is_pair() {
            return Err(RenderError::Stereo);
        }
        match &frame.subject {
            Subject::Mesh(subject) | Subject::Edges(subject, _) if MESH.is_built => {
                let mesh = self.mesh.get_or_insert_default();
                mesh.update(view, window, subject.mesh.radius(), &mut self.scale)?;
                mesh.volume = mesh.volume_of(subject.clip)?;
            }
            Subject::Field(subject) if FIELD.is_built => {
                self.mesh = None;
                let options = subject.options(view, frame.stereo);
                let setup = FieldSetup::in_window(subject.field, view, window, &options)?;
                self.set_field(setup, &options);
            }
            Subject::MeshInField(mesh, subject) if MESH_IN_FIELD.is_built => {
                let (radius, clip) = (mesh.mesh.radius(), mesh.clip);
                let options = subject.options(view, None);
                let (mesh, field) =
                    mesh_in_field::constants(view, window, radius, subject.field, &options)?;
                self.mesh = Some(mesh.with_clip(clip)?);
                self.set_field(field, &options);
            }
            Subject::Objects(objects) if objects.len() > MAX_OBJECTS => {
                return Err(RenderError::Objects(objects.len()));
            }
            Subject::Objects(objects) if OBJECT.is_built => {
                let camera = self.mesh.get_or_insert_default();
                camera.update(view, window, 0, &mut self.scale)?;
                camera.set_depths(depths(objects, camera));
            }
            // A wireframe, or a subject that this build does not support.
            Subject::Wireframe(_)
            | Subject::Mesh(_)
            | Subject::Edges(..)
            | Subject::Field(_)
            | Subject::MeshInField(..)
            | Subject::Objects(_) => self.mesh = None,
        }
        if SKY.is_built {
            let gradient = frame
                .sky
                .filter(|_| self.mesh.is_some() && self.field.is_none());
            self.sky = gradient.map(|gradient| {
                let sky = Sky::new(view, frame.size.pixels(), gradient);
                sky.in_window(window, frame.drawn_samples())
            });
        }
        if FOG.is_built {
            let (density, colour) = frame.mesh_fog();
            let depth = self.mesh().map(|mesh| mesh.depth);
            self.fog = depth.and_then(|depth| Fog::new(density, depth, colour));
        }
        let lighting = frame.mesh_lighting();
        if MESH.is_built
            && let Some(mesh) = &mut self.mesh
            && lighting != MeshLighting::CAMERA
        {
            let light = MeshLight::new(&lighting, view);
            mesh.light = light.row;
            self.light = Some(light);
        }
        Ok(())
    }

    fn set_field(&mut self, setup: FieldSetup, options: &FieldOptions) {
        let palette = options.palette_for(&setup);
        self.field = Some(FieldConstants { setup, palette });
    }
}

/// The smallest and the largest depth of all objects, with 37 fraction bits; `None` without objects.
#[inline(never)]
fn depths(objects: &[Object], camera: &MeshSetup) -> Option<[i64; 2]> {
    let depths = objects.iter().map(|object| {
        let radius = object.subject.mesh.radius();
        object.placement.depths(camera, radius)
    });
    depths.reduce(|[a, b], [c, d]| [a.min(c), b.max(d)])
}
