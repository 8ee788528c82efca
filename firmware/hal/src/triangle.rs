//! The triangle engine: meshes in memory become frames in memory.
//!
//! A frame takes two passes. The geometry pass makes descriptors and band lists of a mesh, and a list of the triangles that
//! need clipping. The raster pass draws a frame from such lists, and from a second set that the program may have made
//! (docs/formats.md, "Descriptors and band lists"). The passes may run at the same time, for two frames.
//!
//! The engine reads and writes memory by addresses and beside the CPU's data cache, so starting a pass is unsafe: see
//! [`Engine::start_geometry`] and [`Engine::start_raster`]. What the CPU wrote before is seen by the engine; what the
//! engine has written is seen after `litex_pac::cpu::flush_data_cache`.

use core::fmt;
use core::ops::Sub;
use core::sync::atomic::{Ordering, compiler_fence};

use glint_core::mesh::Mesh;
use glint_model::{MeshSetup, SIZES, Shading};
use litex_pac::triangle::{
    self, Control, DepthScale, EvEnable, EvPending, Geometry as GeometryStart,
    Raster as RasterStart,
};

use crate::Absent;

/// What `ident` reads where the block is present: `TRIA` in ASCII.
const IDENT: u32 = u32::from_be_bytes(*b"TRIA");

/// Why a pass has not done what it was asked for; the error codes of the register `status`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// The picture's size is none that the engine has.
    Size,
    /// A region of memory was not aligned, or not wholly in main memory; nothing was touched.
    Address,
    /// Started while busy.
    Busy,
    /// The mesh does not end where it says.
    Mesh,
    /// There was no room for all descriptors, list entries or exceptions.
    Full,
    /// A list was longer than lists are, or named a descriptor that is not there, or none.
    List,
    /// The pass was cancelled.
    Cancelled,
    /// Nothing was read, written or drawn for long: no code of the engine's, but what a program finds.
    Stuck,
    /// Smooth shading was wanted of an engine without: what a program finds, too.
    Shading,
    /// The eye is farther away than the engine's widths allow: what a program finds, too.
    Eye,
}

impl Fault {
    fn of(code: u8) -> Result<(), Self> {
        match code {
            0 => Ok(()),
            1 => Err(Self::Size),
            2 => Err(Self::Address),
            3 => Err(Self::Busy),
            4 => Err(Self::Mesh),
            5 => Err(Self::Full),
            6 => Err(Self::List),
            _ => Err(Self::Cancelled),
        }
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            Self::Size => "triangle engine: size: expected 320x180, 640x360 or 1280x720",
            Self::Address => {
                "triangle engine: address: expected a multiple of 16 bytes in main memory"
            }
            Self::Busy => "triangle engine: started while busy",
            Self::Mesh => "triangle engine: the mesh does not end where it says",
            Self::Full => {
                "triangle engine: no room for all descriptors, list entries or exceptions"
            }
            Self::List => "triangle engine: a list is damaged",
            Self::Cancelled => "triangle engine: cancelled",
            Self::Stuck => "triangle engine: nothing moves",
            Self::Shading => "triangle engine: this gateware has no smooth shading",
            Self::Eye => "triangle engine: the eye is too far from the origin",
        })
    }
}

impl core::error::Error for Fault {}

/// Where a geometry pass puts what it makes; every address is a multiple of 16.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lists {
    /// Address of the descriptors, of as many bytes as the engine's [`ability`](Engine::ability) gives them.
    pub descriptors: u32,
    /// How many there is room for.
    pub descriptor_limit: u32,
    /// Address of the band lists.
    pub lists: u32,
}

/// A geometry pass.
#[derive(Clone, Copy, Debug)]
pub struct Geometry<'a> {
    /// The mesh.
    pub mesh: &'a Mesh<'a>,
    /// The constants of the frame.
    pub frame: &'a MeshSetup,
    /// Whether back faces are left out.
    pub cull: bool,
    /// Where colours come from, as far as the engine can.
    pub shading: Shading,
    /// What it makes.
    pub lists: Lists,
    /// Address of the numbers of exceptions, 4 bytes each.
    pub exceptions: u32,
    /// How many there is room for.
    pub exception_limit: u32,
}

/// A geometry pass whose registers are written.
#[must_use]
pub struct Prepared {
    start: GeometryStart,
}

/// A set of lists to draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Set {
    /// Address of the descriptors.
    pub descriptors: u32,
    /// How many there are.
    pub count: u32,
    /// Address of the band lists.
    pub lists: u32,
}

/// A raster pass.
#[derive(Clone, Copy, Debug)]
pub struct Raster {
    /// Width and height in pixels, one of [`SIZES`].
    pub size: (u32, u32),
    /// Address of the frame to write.
    pub frame: u32,
    /// Which of the two frame buffers that is.
    pub slot: bool,
    /// Nothing is known of what the frame buffer holds.
    pub whole: bool,
    /// Address of the depth codes to write, if they are wanted.
    pub depth: Option<u32>,
    /// The colour where nothing is drawn, RGB565.
    pub clear: u16,
    /// The sets, drawn in this order in each band.
    pub sets: [Option<Set>; 2],
}

/// What the last geometry pass has counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Triangles of the mesh.
    pub triangles: u32,
    /// Triangles that were behind, or off one side of the picture.
    pub unseen: u32,
    /// Triangles left out by the setup.
    pub culled: u32,
    /// Descriptors made.
    pub descriptors: u32,
    /// Triangles that need clipping.
    pub exceptions: u32,
}

/// The engine's free-running counters. All wrap, so that differences are right.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Cycles in which a pass ran.
    pub busy: u32,
    /// Cycles in which memory did not take a command.
    pub stalled: u32,
    /// Cycles in which memory did not take a read.
    pub stalled_reads: u32,
    /// Cycles in which memory did not take a write of the geometry pass.
    pub stalled_lists: u32,
    /// Cycles in which memory did not take a write of the raster pass.
    pub stalled_frame: u32,
    /// Words of 16 bytes read.
    pub words_read: u32,
    /// Words of 16 bytes written.
    pub words_written: u32,
    /// Cycles of geometry passes.
    pub geometry: u32,
    /// Vertices transformed.
    pub vertices: u32,
    /// Cycles of raster passes.
    pub raster: u32,
    /// Cycles in which a triangle was walked over.
    pub walking: u32,
    /// Those of them without a pixel.
    pub empty: u32,
    /// Groups of eight pixels of which some were covered.
    pub groups: u32,
    /// Pixels covered by a triangle, each as often as it is.
    pub pixels_covered: u32,
    /// Pixels written: covered, and not behind what was there.
    pub pixels_drawn: u32,
    /// Cycles in which a group waited for the one before it.
    pub held: u32,
    /// Cycles in which the flush of a band waited for memory.
    pub memory: u32,
    /// Cycles in which a drawn band waited for the flush of the one before it.
    pub flush: u32,
}

impl Sub for Counters {
    type Output = Self;

    fn sub(self, earlier: Self) -> Self {
        let d = u32::wrapping_sub;
        Self {
            busy: d(self.busy, earlier.busy),
            stalled: d(self.stalled, earlier.stalled),
            stalled_reads: d(self.stalled_reads, earlier.stalled_reads),
            stalled_lists: d(self.stalled_lists, earlier.stalled_lists),
            stalled_frame: d(self.stalled_frame, earlier.stalled_frame),
            words_read: d(self.words_read, earlier.words_read),
            words_written: d(self.words_written, earlier.words_written),
            geometry: d(self.geometry, earlier.geometry),
            vertices: d(self.vertices, earlier.vertices),
            raster: d(self.raster, earlier.raster),
            walking: d(self.walking, earlier.walking),
            empty: d(self.empty, earlier.empty),
            groups: d(self.groups, earlier.groups),
            pixels_covered: d(self.pixels_covered, earlier.pixels_covered),
            pixels_drawn: d(self.pixels_drawn, earlier.pixels_drawn),
            held: d(self.held, earlier.held),
            memory: d(self.memory, earlier.memory),
            flush: d(self.flush, earlier.flush),
        }
    }
}

/// A pass that was started: still running, or how it has ended.
pub type Outcome = Option<Result<(), Fault>>;

/// The engine, known to be there.
pub struct Engine {
    registers: triangle::Triangle,
}

impl Engine {
    /// Takes the block if it is there. Its interrupt tells of the end of every pass.
    ///
    /// # Errors
    /// When something else answers, or nothing.
    pub fn probe(registers: triangle::Triangle) -> Result<Self, Absent> {
        match registers.ident().read() {
            IDENT => {
                registers
                    .ev_enable()
                    .write(EvEnable::default().with_geometry(true).with_raster(true));
                Ok(Self { registers })
            }
            found => Err(Absent {
                expected: IDENT,
                found,
            }),
        }
    }

    /// How far it can shade; descriptors have more words where that is smoothly (`glint_model::descriptor::words`).
    #[must_use]
    pub fn ability(&self) -> Shading {
        if self.registers.caps().read().gouraud() {
            Shading::Smooth
        } else {
            Shading::Flat
        }
    }

    /// Writes down a geometry pass, which is the longer part of starting it, while none runs. `list_shift`: a list has room for
    /// 4 << `list_shift` entries; that of both passes.
    pub fn prepare_geometry(&mut self, pass: &Geometry, list_shift: u8) -> Prepared {
        let registers = &self.registers;
        let frame = pass.frame;
        let records = pass.mesh.records();
        registers.mesh().write(records.as_ptr().addr() as u32);
        registers.mesh_bytes().write(size_of_val(records) as u32);
        registers
            .geometry_descriptors()
            .write(pass.lists.descriptors);
        registers
            .descriptor_limit()
            .write(pass.lists.descriptor_limit);
        registers.geometry_lists().write(pass.lists.lists);
        registers.list_shift().write(list_shift);
        registers.exceptions().write(pass.exceptions);
        registers.exception_limit().write(pass.exception_limit);

        registers.scale_shift().write(frame.scale_shift as u8);
        let [u, v, n] = [frame.u, frame.v, frame.n].map(|row| row.map(|value| value as u32));
        for (register, value) in [
            (registers.row_u0(), u[0]),
            (registers.row_u1(), u[1]),
            (registers.row_u2(), u[2]),
            (registers.row_v0(), v[0]),
            (registers.row_v1(), v[1]),
            (registers.row_v2(), v[2]),
            (registers.row_n0(), n[0]),
            (registers.row_n1(), n[1]),
            (registers.row_n2(), n[2]),
            (registers.tx_low(), frame.translation[0] as u32),
            (registers.ty_low(), frame.translation[1] as u32),
            (registers.tz_low(), frame.translation[2] as u32),
            (registers.near_low(), frame.near as u32),
        ] {
            register.write(value);
        }
        for (register, value) in [
            (registers.tx_high(), frame.translation[0]),
            (registers.ty_high(), frame.translation[1]),
            (registers.tz_high(), frame.translation[2]),
        ] {
            register.write((value >> 32) as u16);
        }
        registers.near_high().write((frame.near >> 32) as u8);
        registers.depth_scale().write(
            DepthScale::default()
                .with_mantissa(frame.depth.mantissa)
                .with_exponent(frame.depth.exponent as u8),
        );
        Prepared {
            start: GeometryStart::default()
                .with_start(true)
                .with_cull(pass.cull)
                .with_smooth(pass.shading == Shading::Smooth)
                .with_size(size_code((frame.width, frame.height))),
        }
    }

    /// Starts the geometry pass that was prepared last.
    ///
    /// # Safety
    /// Until the pass has ended nobody writes its mesh, and nobody reads or writes what it makes; what is there is lost.
    pub unsafe fn start_geometry(&mut self, pass: Prepared) {
        // What the CPU has written must be on its way to memory before the engine is started.
        compiler_fence(Ordering::SeqCst);
        self.registers.geometry().write(pass.start);
    }

    /// Starts a raster pass.
    ///
    /// # Safety
    /// Until the pass has ended nobody writes the lists and descriptors, and nobody reads or writes the frame and the
    /// depth codes, which are lost.
    pub unsafe fn start_raster(&mut self, pass: &Raster) {
        let registers = &self.registers;
        registers.frame().write(pass.frame);
        registers.depth().write(pass.depth.unwrap_or(0));
        registers.clear().write(pass.clear);
        let [first, second] = pass.sets;
        if let Some(set) = first {
            registers.lists_0().write(set.lists);
            registers.descriptors_0().write(set.descriptors);
            registers.count_0().write(set.count);
        }
        if let Some(set) = second {
            registers.lists_1().write(set.lists);
            registers.descriptors_1().write(set.descriptors);
            registers.count_1().write(set.count);
        }
        compiler_fence(Ordering::SeqCst);
        registers.raster().write(
            RasterStart::default()
                .with_start(true)
                .with_size(size_code(pass.size))
                .with_first(first.is_some())
                .with_second(second.is_some())
                .with_depth(pass.depth.is_some())
                .with_slot(pass.slot)
                .with_whole(pass.whole),
        );
    }

    /// How the geometry pass that was started last has ended, if it has.
    #[must_use]
    pub fn geometry(&self) -> Outcome {
        let status = self.registers.status().read();
        (!status.geometry_busy()).then(|| Fault::of(status.geometry_error()))
    }

    /// How the raster pass that was started last has ended, if it has.
    #[must_use]
    pub fn raster(&self) -> Outcome {
        let status = self.registers.status().read();
        (!status.raster_busy()).then(|| Fault::of(status.raster_error()))
    }

    /// Gives up what runs. What is started afterwards is drawn right; the frame that was given up is not, and the next one
    /// in its buffer has to be whole.
    pub fn cancel(&mut self) {
        self.registers
            .control()
            .write(Control::default().with_cancel(true));
    }

    /// What the geometry pass that has ended last has counted.
    #[must_use]
    pub fn counts(&self) -> Counts {
        let registers = &self.registers;
        Counts {
            triangles: registers.triangles().read(),
            unseen: registers.unseen().read(),
            culled: registers.culled().read(),
            descriptors: registers.descriptor_count().read(),
            exceptions: registers.exception_count().read(),
        }
    }

    /// The counters.
    #[must_use]
    pub fn counters(&self) -> Counters {
        let registers = &self.registers;
        Counters {
            busy: registers.cycles_busy().read(),
            stalled: registers.cycles_stalled().read(),
            stalled_reads: registers.stalled_reads().read(),
            stalled_lists: registers.stalled_lists().read(),
            stalled_frame: registers.stalled_frame().read(),
            words_read: registers.items_in().read(),
            words_written: registers.items_out().read(),
            geometry: registers.cycles_geometry().read(),
            vertices: registers.vertices().read(),
            raster: registers.cycles_raster().read(),
            walking: registers.cycles_walking().read(),
            empty: registers.cycles_empty().read(),
            groups: registers.groups().read(),
            pixels_covered: registers.pixels_covered().read(),
            pixels_drawn: registers.pixels_drawn().read(),
            held: registers.cycles_held().read(),
            memory: registers.cycles_memory().read(),
            flush: registers.cycles_flush().read(),
        }
    }
}

/// Clears the engine's interrupt; its handler calls this.
pub fn acknowledge() {
    // SAFETY: nobody else writes the pending register, and both events are cleared: the passes' states are in `status`.
    let registers = unsafe { triangle::Triangle::steal() };
    registers
        .ev_pending()
        .write(EvPending::default().with_geometry(true).with_raster(true));
}

/// The code of a size; 3, which the engine refuses, for any that it has not.
fn size_code(size: (u32, u32)) -> u8 {
    SIZES
        .iter()
        .position(|&known| known == size)
        .map_or(3, |code| code as u8)
}

#[cfg(test)]
mod tests;
