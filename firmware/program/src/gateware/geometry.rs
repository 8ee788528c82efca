//! The geometry passes of a frame: one for each mesh, and clipping by the CPU.
//!
//! While the pass of a mesh runs, the CPU clips the exceptions of the previous mesh, computes the constants of the next mesh, and writes
//! them to the registers of the engine, which has copied the registers of the running pass.
//!
//! Some mesh options require that the CPU does all steps before the raster pass; the CPU then does these steps for all meshes of the frame.

use core::mem;

use glint_core::colour::{Shading, Winding};
use glint_core::feature::{CLIPPING, CPU, MESH, TEXTURE};
use glint_engines::triangle::MeshPass;
use glint_hal::triangle::{Counts, EngineError, Error, Prepared, TriangleEngine};
use glint_model::edges::EdgeList;
use glint_model::triangle::descriptor::{Layout, ListCounts, ListWriter};
use glint_model::triangle::setup::Setup;
use glint_model::triangle::textured::{OfTexture, Textured};
use glint_model::{
    Clip, DrawnTriangle, Frame, FrameConstants, MeshSetup, Subject, clip_exceptions,
};
use litex_pac::cpu;

use super::buffers::{Buffers, TextureTable};
use super::fallback::{Fallback, Unsupported};
use crate::memory::Scratch;

/// Number of triangles that the CPU makes between two calls of [`Cpu::progress`].
const TRIANGLES_A_CALL: u32 = 32;

/// Resources for the steps that the CPU does in place of the gateware.
pub struct Cpu<'a> {
    /// Memory for projected vertices.
    pub scratch: &'a mut Scratch,
    /// Memory for the edges of a mesh.
    pub edges: &'a mut EdgeList<'static>,
    /// Called at short intervals during long steps.
    pub progress: &'a mut dyn FnMut(),
}

/// A frame, and the resources of its geometry passes.
pub struct Job<'a> {
    /// The frame to draw.
    pub frame: &'a Frame<'a>,
    /// Frame constants of all meshes.
    pub constants: &'a FrameConstants,
    /// The triangle engine.
    pub engine: &'a mut TriangleEngine,
    /// The memory of the frame.
    pub buffers: &'a mut Buffers,
}

/// The state of the geometry passes.
pub struct GeometryPasses {
    /// Layout of the descriptors of this gateware.
    layout: Layout,
    /// Whether the engine has geometry passes.
    has_geometry: bool,
    /// Number of the mesh whose pass was started last.
    number: usize,
    /// Of the meshes whose passes have ended: the number of triangles, and the number of triangles drawn after clipping.
    triangles: u32,
    drawn_clipped: u32,
    /// Frame constants of the object whose pass was prepared last.
    own: MeshSetup,
    /// The pass of the next mesh, whose registers have been written.
    prepared: Option<Prepared>,
    /// The reason why the CPU makes the descriptors of all meshes; `None` if geometry passes make them.
    unsupported: Option<Unsupported>,
}

impl GeometryPasses {
    /// The initial state, for an engine whose descriptors have this layout.
    pub fn new(layout: Layout, has_geometry: bool) -> Self {
        Self {
            layout,
            has_geometry,
            number: 0,
            triangles: 0,
            drawn_clipped: 0,
            own: MeshSetup::default(),
            prepared: None,
            unsupported: None,
        }
    }

    /// The reason why the CPU makes the descriptors of the frame, if it does.
    pub const fn unsupported(&self) -> Option<Unsupported> {
        self.unsupported
    }

    /// Whether the running pass is the last one, because no further pass has been prepared.
    pub const fn is_last(&self) -> bool {
        self.prepared.is_none()
    }

    /// Writes the registers of the geometry pass of the first mesh of a frame, if it has one.
    pub fn prepare(&mut self, job: &mut Job) -> Result<(), Fallback> {
        self.prepared = None;
        if !MESH.is_built {
            return Ok(());
        }
        self.unsupported = if self.has_geometry {
            unsupported(job.frame)
        } else {
            (job.frame.subject.meshes().next()).map(|_| Unsupported::Geometry)
        };
        match self.unsupported {
            None => {}
            Some(_) if CPU.is_built => return Ok(()),
            Some(unsupported) => return Err(Fallback::Descriptors(unsupported)),
        }
        self.prepare_mesh(job, 0)
    }

    /// Writes the registers of the geometry pass of the mesh with this number, if the frame has that mesh.
    fn prepare_mesh(&mut self, job: &mut Job, number: usize) -> Result<(), Fallback> {
        let Some((subject, colour)) = job.frame.subject.coloured_mesh(number) else {
            return Ok(());
        };
        let setup = job.constants.mesh_setup(job.frame, number, &mut self.own)?;
        let textures = if TEXTURE.is_built && subject.has_textures() {
            job.buffers
                .textures
                .of_mesh(&subject.mesh, job.frame.replacement_texture.as_ref())?
        } else {
            None
        };
        let pass = MeshPass {
            mesh: &subject.mesh,
            window: job.frame.window(),
            frame: setup.ok_or(EngineError::from(Error::Size))?,
            light: job.constants.light(),
            cull: subject.cull,
            shading: subject.shading,
            colour,
            textures,
            lists: (number == 0).then(|| job.buffers.lists(self.layout, job.frame.window().size)),
        };
        self.prepared = Some(pass.prepare(job.engine));
        Ok(())
    }

    /// Starts the prepared geometry pass of the first mesh, and prepares the pass of the second mesh. Returns whether a pass runs; `false`
    /// without a mesh, or if the CPU has made all descriptors.
    pub fn start(&mut self, job: &mut Job, cpu: &mut Cpu) -> Result<bool, Fallback> {
        job.buffers.clear();
        if !MESH.is_built {
            return Ok(false);
        }
        if CPU.is_built && self.unsupported.is_some() {
            self.set_up(job, cpu)?;
            return Ok(false);
        }
        (self.number, self.triangles, self.drawn_clipped) = (0, 0, 0);
        let starts = self.start_prepared(job);
        if starts {
            self.prepare_mesh(job, 1)?;
        }
        Ok(starts)
    }

    /// Starts the prepared geometry pass, if any. Returns whether a pass was started.
    fn start_prepared(&mut self, job: &mut Job) -> bool {
        let Some(pass) = self.prepared.take() else {
            return false;
        };
        // SAFETY: the buffers belong to the renderer, are not used by an earlier frame, and are read after the end of this pass; the mesh
        // and its texture coordinates are unchanged while the renderer is busy.
        unsafe { job.engine.start_geometry(pass) };
        true
    }

    /// Continues after the end of a geometry pass: starts the pass of the next mesh, clips the triangles that the ended pass has listed,
    /// and prepares the pass after the next. Returns whether there is a next mesh.
    pub fn advance(&mut self, job: &mut Job) -> Result<bool, Fallback> {
        if !MESH.is_built {
            return Ok(false);
        }
        let (number, counts) = (self.number, job.engine.counts());
        let starts = self.start_prepared(job);
        self.triangles += counts.triangles;
        if counts.exceptions > job.buffers.stats.clipped {
            if !CLIPPING.is_built {
                return Err(Fallback::Descriptors(Unsupported::Clipping));
            }
            self.clip(job, number, &counts)?;
        }
        if starts {
            self.number = number + 1;
            self.prepare_mesh(job, number + 2)?;
        } else {
            self.finish(job, &counts);
        }
        Ok(starts)
    }

    /// Clips those triangles of the mesh with this number that the engine has listed and that have not been clipped yet.
    ///
    /// Not inlined, because few meshes have such triangles.
    #[inline(never)]
    fn clip(&mut self, job: &mut Job, number: usize, counts: &Counts) -> Result<(), Fallback> {
        let buffers = &mut *job.buffers;
        let subject = job.frame.numbered_mesh(number, job.constants.light());
        let setup = job.constants.numbered_mesh(job.frame, number)?;
        let both = subject.zip(setup.as_ref());
        let ((subject, options), setup) = both.ok_or(EngineError::from(Error::Size))?;
        cpu::flush_data_cache();
        let joins = joins_clipped(job.frame);
        if joins {
            buffers.clipped_counts = ListCounts::of(buffers.lists, counts.descriptors);
        } else if buffers.sets[1].is_none() {
            buffers.clipped_counts = ListCounts::EMPTY;
        }
        let clipped = mem::replace(&mut buffers.stats.clipped, counts.exceptions);
        let listed = clipped as usize..counts.exceptions as usize;
        let list_shift = buffers.list_shift(job.frame.window().size).into();
        let exceptions = buffers.exceptions.get(listed).unwrap_or_default();
        let mut numbers = exceptions.iter().copied();
        let (descriptors, lists) = if joins {
            (&mut *buffers.descriptors, &mut *buffers.lists)
        } else {
            (
                &mut *buffers.clipped_descriptors,
                &mut *buffers.clipped_lists,
            )
        };
        let mut writer = ListWriter::new(
            descriptors,
            lists,
            &mut buffers.clipped_counts,
            setup.width,
            list_shift,
            self.layout,
        );
        let (textures, mut is_full) = (&mut buffers.textures, false);
        let mut put = |triangle: &DrawnTriangle, setup: &Setup, textured: Option<&Textured>| {
            let texture = numbered(textures, textured, &mut is_full);
            writer.put(setup, triangle.colour, texture.as_ref());
        };
        self.drawn_clipped +=
            clip_exceptions(&subject.mesh, setup, &options, &mut numbers, &mut put);
        let count = writer
            .finish()
            .map_err(|_| EngineError::from(Error::Full))?;
        if is_full {
            return Err(Fallback::TooManyTextures);
        }
        if joins {
            buffers.sets[0] = Some(buffers.set(count));
        } else {
            buffers.sets[1] = Some(buffers.clipped_set(count));
        }
        Ok(())
    }

    /// Stores the results of all geometry passes, after the last pass: the set of descriptors, unless the clipper has already stored the
    /// set, and the triangle counts.
    fn finish(&self, job: &mut Job, counts: &Counts) {
        let buffers = &mut *job.buffers;
        if buffers.sets[0].is_none() {
            buffers.sets[0] = Some(buffers.set(counts.descriptors));
        }
        let drawn = counts.descriptors + self.drawn_clipped;
        let stats = &mut buffers.stats;
        stats.triangles_in = self.triangles;
        stats.culled = self.triangles.saturating_sub(drawn);
        stats.drawn = drawn;
    }

    /// Makes the descriptors and lists of all meshes on the CPU.
    ///
    /// Not inlined, because few frames need it.
    #[inline(never)]
    fn set_up(&self, job: &mut Job, cpu: &mut Cpu) -> Result<(), Fallback> {
        let (constants, frame) = (job.constants, job.frame);
        constants.check_meshes(frame)?;
        let size = frame.window().size;
        let width = size.width();
        let buffers = &mut *job.buffers;
        let list_shift = buffers.list_shift(size).into();
        let mut whole = ListCounts::EMPTY;
        buffers.clipped_counts = ListCounts::EMPTY;
        let mut whole = ListWriter::new(
            buffers.descriptors,
            buffers.lists,
            &mut whole,
            width,
            list_shift,
            self.layout,
        );
        let mut clipped = ListWriter::new(
            buffers.clipped_descriptors,
            buffers.clipped_lists,
            &mut buffers.clipped_counts,
            width,
            list_shift,
            self.layout,
        );
        let scratch = cpu.scratch.vertices(frame.scratch_vertices());
        let joins = joins_clipped(frame);
        let (textures, mut is_full) = (&mut buffers.textures, false);
        let mut put = |triangle: &DrawnTriangle, setup: &Setup, textured: Option<&Textured>| {
            if triangle.index.is_multiple_of(TRIANGLES_A_CALL) {
                (cpu.progress)();
            }
            let writer = if triangle.clipped && !joins {
                &mut clipped
            } else {
                &mut whole
            };
            let texture = numbered(textures, textured, &mut is_full);
            writer.put(setup, triangle.colour, texture.as_ref());
        };
        let stats = frame.set_up_meshes(constants, scratch, &mut put)?;
        let full = |_| EngineError::from(Error::Full);
        if is_full {
            return Err(Fallback::TooManyTextures);
        }
        let whole = whole.finish().map_err(full)?;
        let clipped = clipped.finish().map_err(full)?;
        buffers.sets = [
            Some(buffers.set(whole)),
            (clipped > 0).then(|| buffers.clipped_set(clipped)),
        ];
        buffers.stats = stats;
        Ok(())
    }
}

/// A texture for a descriptor; `None` if the triangle has no texture, or if the table is full, which sets `is_full`.
fn numbered(
    table: &mut TextureTable,
    textured: Option<&Textured>,
    is_full: &mut bool,
) -> Option<OfTexture> {
    let textured = textured.filter(|_| TEXTURE.is_built)?;
    let number = table.number(&textured.texture);
    *is_full |= number.is_none();
    Some(textured.numbered(number?))
}

/// Whether clipped triangles are appended to the set of unclipped triangles, because the second set holds the lines of the mesh's edges.
const fn joins_clipped(frame: &Frame) -> bool {
    matches!(frame.subject, Subject::Edges(..))
}

/// The first option of a frame's meshes that geometry passes do not support.
fn unsupported(frame: &Frame) -> Option<Unsupported> {
    let lacking = frame.subject.meshes().find_map(|subject| {
        let sees_dark_sides = subject.shading == Shading::Smooth && !subject.cull;
        if subject.clip != Clip::Guard {
            Some(Unsupported::Volume)
        } else if subject.winding != Winding::Mesh {
            Some(Unsupported::Winding)
        } else {
            let is_lit = sees_dark_sides && frame.mesh_lighting().ambient != [0; 3];
            is_lit.then_some(Unsupported::DarkSides)
        }
    });
    let mut objects = frame.subject.objects().unwrap_or_default().iter();
    let mut normals = || objects.position(|object| object.placement.normals().is_some());
    lacking.or_else(|| normals().map(|index| Unsupported::Normals(index + 1)))
}
