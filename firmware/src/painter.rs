//! Draws with the triangle engine: geometry, clipping of what the engine leaves to the program, raster; and with the raymarcher, whose
//! fields are drawn in the raster pass, after the triangles.

use core::mem;

use glint_core::appearance::Appearance;
use glint_core::camera::View;
use glint_core::field::Field;
use glint_core::mesh::Mesh;
use glint_core::stereo::Stereo;
use glint_hal::raymarch::{self, Raymarcher};
use glint_hal::triangle::{
    Counters, Engine, Fault, Geometry, Lists, Outcome, Prepared, Raster, Set,
};
use glint_model::descriptor::{self, Descriptor, TABLE_WORDS, band_rows, list_word};
use glint_model::raymarch::{FieldOptions, FieldSetup, FieldStats, Palette, Prepass};
use glint_model::{
    MeshSetup, Options, RenderError, Shading, Stats, clip_exceptions, mesh_in_field,
};
use litex_pac::cpu;

use crate::scene::{Counts, Fallback};

/// The most descriptors of a set, where they are small, and the most exceptions. A frame with more is the CPU's.
const DESCRIPTORS: usize = 1 << 16;
/// Numbers of a set's descriptors; where these are large there is room for half as many.
const DESCRIPTOR_NUMBERS: usize = DESCRIPTORS * descriptor::words(Shading::Flat);
/// Numbers of all lists of a set, and of the table of their lengths.
const LIST_NUMBERS: usize = 1 << 20;
const LENGTHS: usize = 4 * TABLE_WORDS as usize;

/// Cycles without anything read, written or drawn after which the engine is given up: a tenth of a second.
const STUCK: u64 = glint_hal::timer::FREQUENCY as u64 / 10;

/// Questions whether a pass has ended between two whether it moves at all.
const POLLS: u32 = 100;

/// Entries of a list are 4 << this: what fits [`LIST_NUMBERS`] for the bands of a picture of this width.
const fn list_shift(width: u32) -> u32 {
    match width {
        320 => 15,
        640 => 14,
        _ => 12,
    }
}

/// What is to be drawn, and where.
pub struct Target<'a> {
    /// What is shown.
    pub what: What<'a>,
    /// The picture's size.
    pub size: (u32, u32),
    /// RGB565, row by row.
    pub colour: &'a mut [u16],
    /// Depth codes, if they are wanted.
    pub depth: Option<&'a mut [u32]>,
}

/// What a frame shows.
#[derive(Clone, Copy)]
pub enum What<'a> {
    /// A mesh.
    Triangles(Triangles<'a>),
    /// A field.
    Field(Marched<'a>),
    /// A mesh in a field.
    Both(Triangles<'a>, Marched<'a>),
}

impl<'a> What<'a> {
    /// The mesh, if there is one.
    pub const fn triangles(&self) -> Option<&Triangles<'a>> {
        match self {
            Self::Triangles(triangles) | Self::Both(triangles, _) => Some(triangles),
            Self::Field(_) => None,
        }
    }

    /// The field, if there is one.
    pub const fn marched(&self) -> Option<&Marched<'a>> {
        match self {
            Self::Field(marched) | Self::Both(_, marched) => Some(marched),
            Self::Triangles(_) => None,
        }
    }

    /// The constants of the frame.
    ///
    /// # Errors
    /// It cannot be drawn.
    pub fn constants(&self, size: (u32, u32)) -> Result<Constants, RenderError> {
        let (frame, field) = match self {
            Self::Triangles(Triangles { mesh, view, .. }) => {
                let frame = MeshSetup::new(view, size.0, size.1, mesh.radius())?;
                (Some(frame), None)
            }
            Self::Field(marched) => {
                let options = marched.options();
                let setup = FieldSetup::new(marched.field, marched.view, size, &options)?;
                (None, Some((setup, options.palette_for(&setup))))
            }
            Self::Both(Triangles { mesh, view, .. }, marched) => {
                let (radius, options) = (mesh.radius(), marched.options());
                let (frame, setup) =
                    mesh_in_field::constants(view, size, radius, marched.field, &options)?;
                (Some(frame), Some((setup, options.palette_for(&setup))))
            }
        };
        Ok(Constants { frame, field })
    }
}

/// The constants of a frame.
pub struct Constants {
    /// Of its mesh.
    pub frame: Option<MeshSetup>,
    /// Of its field, and its colours.
    pub field: Option<(FieldSetup, Palette)>,
}

/// A mesh, and how it is drawn.
#[derive(Clone, Copy)]
pub struct Triangles<'a> {
    /// The mesh.
    pub mesh: &'a Mesh<'a>,
    /// The camera.
    pub view: &'a View,
    /// Whether back faces are left out.
    pub cull: bool,
    /// Where colours come from.
    pub shading: Shading,
}

/// A field, and how it is drawn.
#[derive(Clone, Copy)]
pub struct Marched<'a> {
    /// The field.
    pub field: &'a Field,
    /// The camera.
    pub view: &'a View,
    /// Two eyes, or one.
    pub stereo: Option<Stereo>,
    /// How it looks.
    pub appearance: &'a Appearance,
    /// Whether cones go before the rays.
    pub prepass: bool,
}

impl Marched<'_> {
    fn options(&self) -> FieldOptions {
        FieldOptions {
            prepass: self.prepass.then_some(Prepass::Fitting),
            ..FieldOptions::new(self.field, self.appearance, self.stereo)
        }
    }
}

/// Memory of a frame between its passes.
struct Room {
    /// The engine's set and its exceptions.
    descriptors: &'static mut [u32],
    lists: &'static mut [u32],
    exceptions: &'static mut [u32],
    /// The set of what was clipped.
    clipped_descriptors: &'static mut [u32],
    clipped_lists: &'static mut [u32],
    /// What the geometry pass and the clipper have left here.
    sets: [Option<Set>; 2],
    stats: Stats,
}

impl Room {
    /// Cuts a room off the memory, if there is enough.
    fn cut(memory: &mut &'static mut [u32]) -> Option<Self> {
        let mut piece = |length| {
            let (piece, rest) = mem::take(memory).split_at_mut_checked(length)?;
            *memory = rest;
            Some(piece)
        };
        Some(Self {
            descriptors: piece(DESCRIPTOR_NUMBERS)?,
            lists: piece(LIST_NUMBERS)?,
            exceptions: piece(DESCRIPTORS)?,
            clipped_descriptors: piece(DESCRIPTOR_NUMBERS)?,
            clipped_lists: piece(LIST_NUMBERS)?,
            sets: [None; 2],
            stats: Stats::default(),
        })
    }
}

/// What a buffer holds: the size of the frame that the engine drew there last, nothing if anybody else may have.
type Known = Option<(u32, u32)>;

/// What is going on.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Stage {
    Idle,
    Geometry,
    Raster,
}

/// The engine and its memory.
pub struct Painter {
    engine: Engine,
    /// The raymarcher, where there is one.
    raymarcher: Option<Raymarcher>,
    /// How far the engine can shade.
    ability: Shading,
    rooms: [Room; 2],
    /// The first frame buffer's address, and what both hold.
    first_buffer: u32,
    known: [Known; 2],
    stage: Stage,
    /// The constants of the frame whose geometry was begun last.
    frame: Option<MeshSetup>,
    watch: Watch,
    start: (u64, Counters),
    field_start: raymarch::Counters,
}

/// A frame by the engine.
pub struct Painted {
    /// Clock cycles from the first register written to the end seen.
    pub cycles: u64,
    /// What was counted; of many frames of a mesh, triangles of the last and no pixels.
    pub stats: Counts,
    /// The engine's counters for this frame.
    pub counters: Counters,
}

impl Painter {
    /// A painter of two frame buffers, of which the first lies at `first_buffer`; nothing if `memory` is too small.
    pub fn new(
        engine: Engine,
        raymarcher: Option<Raymarcher>,
        mut memory: &'static mut [u32],
        first_buffer: u32,
    ) -> Option<Self> {
        Some(Self {
            start: (0, engine.counters()),
            ability: engine.ability(),
            engine,
            raymarcher,
            rooms: [Room::cut(&mut memory)?, Room::cut(&mut memory)?],
            first_buffer,
            known: [None; 2],
            stage: Stage::Idle,
            frame: None,
            watch: Watch::default(),
            field_start: raymarch::Counters::default(),
        })
    }

    /// Whether a frame has been begun and not ended.
    pub fn is_busy(&self) -> bool {
        self.stage != Stage::Idle
    }

    /// Whether [`advance`](Self::advance) has something to do.
    pub fn has_news(&self) -> bool {
        match self.stage {
            Stage::Idle => false,
            Stage::Geometry => self.engine.geometry().is_some(),
            Stage::Raster => self.engine.raster().is_some(),
        }
    }

    /// Somebody else has written, or will write, to a frame buffer.
    pub fn forget(&mut self, colour: &[u16]) {
        let slot = usize::from(self.slot(colour));
        if let Some(known) = self.known.get_mut(slot) {
            *known = None;
        }
    }

    /// Begins the frame of `target`, or goes on with it; it has to stay the same until this ends with something.
    ///
    /// # Errors
    /// The frame cannot be drawn by the engine, which is free again.
    pub fn advance(&mut self, target: &mut Target) -> Option<Result<Painted, Fallback>> {
        let step = match (self.stage, target.what) {
            (Stage::Idle, what) => {
                self.mark_start();
                return self.begin(&what, target).err().map(Err);
            }
            (Stage::Geometry, What::Triangles(triangles) | What::Both(triangles, _)) => {
                match self.engine.geometry() {
                    None => return self.watch(target),
                    Some(Ok(())) => self.clip(&triangles),
                    Some(fault) => fault,
                }
            }
            (_, what) => match self.engine.raster() {
                None => return self.watch(target),
                Some(Ok(())) => {
                    self.stage = Stage::Idle;
                    return Some(Ok(self.painted(&what, 0)));
                }
                Some(fault) => fault,
            },
        };
        match step {
            Ok(()) => {
                self.start_raster(target, self.rooms[0].sets);
                self.stage = Stage::Raster;
                None
            }
            Err(fault) => Some(self.give_up(target, fault)),
        }
    }

    /// From now on it counts.
    fn mark_start(&mut self) {
        self.field_start = self
            .raymarcher
            .as_ref()
            .map(Raymarcher::counters)
            .unwrap_or_default();
        self.start = (cpu::cycles(), self.engine.counters());
        self.watch = Watch::default();
    }

    /// What was drawn since; triangles are counted in a room.
    fn painted(&self, what: &What, room: usize) -> Painted {
        let (start, counters) = self.start;
        let cycles = cpu::cycles() - start;
        let counters = self.engine.counters() - counters;
        let field = self
            .raymarcher
            .as_ref()
            .filter(|_| what.marched().is_some());
        let field = field.map(|raymarcher| raymarcher.counters() - self.field_start);
        let field_pixels = field.map_or(0, |field| field.pixels);
        let triangles = what.triangles().map(|_| Stats {
            // The walker comes to a group of eight a clock.
            pixels_tested: 8 * u64::from(counters.walking),
            pixels_covered: counters.pixels_covered.wrapping_sub(field_pixels).into(),
            pixels_drawn: counters.pixels_drawn.into(),
            ..self.rooms[room].stats
        });
        let stats = Counts {
            triangles,
            rays: field.map(FieldStats::from),
        };
        Painted {
            cycles,
            stats,
            counters,
        }
    }

    fn begin(&mut self, what: &What, target: &mut Target) -> Result<(), Fallback> {
        let constants = self.constants(what, target.size)?;
        self.set_field(constants.field.as_ref(), false)?;
        if let Some(triangles) = what.triangles() {
            let prepared = self.prepare_geometry(triangles, &constants, 0)?;
            self.start_geometry(prepared);
            self.stage = Stage::Geometry;
        } else {
            self.start_raster(target, [None; 2]);
            self.stage = Stage::Raster;
        }
        Ok(())
    }

    /// Has a field drawn in the frames from now on, or none. Its tables are not looked at where the raymarcher is known to have them.
    fn set_field(
        &mut self,
        field: Option<&(FieldSetup, Palette)>,
        has_tables: bool,
    ) -> Result<(), Fallback> {
        match (&mut self.raymarcher, field) {
            (Some(raymarcher), Some((setup, palette))) => {
                let outcome = if has_tables {
                    raymarcher.set_field_with_tables_held(setup, palette)
                } else {
                    raymarcher.set_field(setup, palette)
                };
                outcome.map_err(|missing| Fallback::Field(Some(missing)))
            }
            (Some(raymarcher), None) => {
                raymarcher.clear_field();
                Ok(())
            }
            (None, Some(_)) => Err(Fallback::Field(None)),
            (None, None) => Ok(()),
        }
    }

    /// Whether the raymarcher has a field's tables.
    fn has_tables(&self, field: Option<&(FieldSetup, Palette)>) -> bool {
        let both = self.raymarcher.as_ref().zip(field);
        both.is_some_and(|(raymarcher, (_, palette))| raymarcher.has_tables(palette))
    }

    /// Draws a frame again and again, back to back: while one is rastered the next one's geometry is made. What is returned
    /// is of `count` frames, from the beginning of a raster pass to the beginning of a later one. Nobody looks at the
    /// console meanwhile.
    ///
    /// # Errors
    /// As [`advance`](Self::advance).
    pub fn repeat(&mut self, target: &mut Target, count: u32) -> Result<Painted, Fallback> {
        match target.what {
            What::Triangles(triangles) | What::Both(triangles, _) => {
                self.repeat_mesh(&triangles, target, count)
            }
            What::Field(_) => self.repeat_field(target, count),
        }
    }

    fn repeat_mesh(
        &mut self,
        triangles: &Triangles,
        target: &mut Target,
        count: u32,
    ) -> Result<Painted, Fallback> {
        self.watch = Watch::default();
        let what = target.what;
        let mut now = self.constants(&what, target.size)?;
        self.set_field(now.field.as_ref(), false)?;
        let mut prepared = self.prepare_geometry(triangles, &now, 0)?;
        for frame in 0..=count {
            self.start_geometry(prepared);
            // The next frame's, while the engine works.
            let next = self.constants(&what, target.size)?;
            self.wait(Engine::geometry, target)?;
            if let Err(fault) = self.clip(triangles) {
                return self.give_up(target, fault);
            }
            // It goes where the raster pass still reads.
            prepared = self.prepare_geometry(triangles, &next, 1)?;
            if frame > 0 {
                self.wait(Engine::raster, target)?;
            }
            if frame == 0 {
                self.mark_start();
            }
            if frame == count {
                break;
            }
            // Its registers hold while a raster pass runs.
            if now.field.is_some() {
                self.set_field(now.field.as_ref(), false)?;
            }
            self.start_raster(target, self.rooms[0].sets);
            // What is being drawn stays where it is.
            self.rooms.swap(0, 1);
            now = next;
        }
        Ok(self.painted(&what, 1))
    }

    /// The constants of the next frame wait in the program, as registers hold while a field is drawn.
    fn repeat_field(&mut self, target: &mut Target, count: u32) -> Result<Painted, Fallback> {
        let what = target.what;
        let mut now = self.constants(&what, target.size)?;
        let mut has_tables = false;
        self.mark_start();
        for _ in 0..count {
            self.set_field(now.field.as_ref(), has_tables)?;
            self.start_raster(target, [None; 2]);
            now = self.constants(&what, target.size)?;
            has_tables = self.has_tables(now.field.as_ref());
            self.wait(Engine::raster, target)?;
        }
        Ok(self.painted(&what, 0))
    }

    /// Waits for the end of a pass.
    fn wait(
        &mut self,
        outcome: fn(&Engine) -> Outcome,
        target: &mut Target,
    ) -> Result<(), Fallback> {
        loop {
            for _ in 0..POLLS {
                match outcome(&self.engine) {
                    Some(Ok(())) => return Ok(()),
                    Some(Err(fault)) => return self.give_up(target, fault).map(drop),
                    None => {}
                }
            }
            if let Some(stuck) = self.watch(target) {
                return stuck.map(drop);
            }
        }
    }

    /// The constants of a frame that the engine can draw.
    fn constants(&self, what: &What, size: (u32, u32)) -> Result<Constants, Fault> {
        let shading = what.triangles().map(|triangles| triangles.shading);
        if shading == Some(Shading::Smooth) && self.ability == Shading::Flat {
            return Err(Fault::Shading);
        }
        what.constants(size).map_err(fault_of)
    }

    /// Prepares a geometry pass that goes into a room.
    fn prepare_geometry(
        &mut self,
        triangles: &Triangles,
        constants: &Constants,
        room: usize,
    ) -> Result<Prepared, Fault> {
        let frame = self.frame.insert(constants.frame.ok_or(Fault::Size)?);
        let width = frame.width;
        let room = &self.rooms[room];
        let pass = Geometry {
            mesh: triangles.mesh,
            frame,
            cull: triangles.cull,
            shading: triangles.shading,
            lists: Lists {
                descriptors: address(room.descriptors),
                descriptor_limit: (DESCRIPTOR_NUMBERS / descriptor::words(self.ability)) as u32,
                lists: address(room.lists),
            },
            exceptions: address(room.exceptions),
            exception_limit: DESCRIPTORS as u32,
        };
        Ok(self.engine.prepare_geometry(&pass, list_shift(width) as u8))
    }

    fn start_geometry(&mut self, pass: Prepared) {
        // SAFETY: the room is this painter's own, free of the pass before, and looked at when this one has ended; the mesh
        // is kept while the painter is busy.
        unsafe { self.engine.start_geometry(pass) };
    }

    fn start_raster(&mut self, target: &mut Target, sets: [Option<Set>; 2]) {
        let slot = self.slot(target.colour);
        let size = target.size;
        let known = &mut self.known[usize::from(slot)];
        let pass = Raster {
            size,
            frame: target.colour.as_ptr().addr() as u32,
            slot,
            whole: *known != Some(size),
            depth: target.depth.as_deref().map(address),
            clear: 0,
            sets,
        };
        *known = Some(size);
        // SAFETY: the lists are this painter's own and stay as they are until the pass has ended; frame and depth codes
        // are lent to it until then.
        unsafe { self.engine.start_raster(&pass) };
    }

    /// Makes descriptors of what the engine has left to be clipped.
    fn clip(&mut self, triangles: &Triangles) -> Result<(), Fault> {
        let frame = self.frame.as_ref().ok_or(Fault::Size)?;
        let room = &mut self.rooms[0];
        let counts = self.engine.counts();
        room.sets = [
            Some(Set {
                descriptors: address(room.descriptors),
                count: counts.descriptors,
                lists: address(room.lists),
            }),
            None,
        ];
        let mut clipped_drawn = 0;
        if counts.exceptions > 0 {
            cpu::flush_data_cache();
            let numbers = room
                .exceptions
                .get(..counts.exceptions as usize)
                .unwrap_or_default();
            let mut writer = ListWriter {
                descriptors: room.clipped_descriptors,
                lists: room.clipped_lists,
                lengths: [0; LENGTHS],
                count: 0,
                width: frame.width,
                ability: self.ability,
                full: false,
            };
            let options = Options {
                cull: triangles.cull,
                shading: triangles.shading,
                ..Options::default()
            };
            clipped_drawn = clip_exceptions(
                triangles.mesh,
                frame,
                &options,
                &mut numbers.iter().copied(),
                &mut |setup, colour| {
                    let (top, bottom) = (setup.bounds.top, setup.bounds.bottom);
                    writer.put(&Descriptor::new(setup, colour), top as u32, bottom as u32);
                },
            );
            let (count, full) = (writer.count, writer.finish());
            if full {
                return Err(Fault::Full);
            }
            room.sets[1] = Some(Set {
                descriptors: address(room.clipped_descriptors),
                count,
                lists: address(room.clipped_lists),
            });
        }
        let drawn = counts.descriptors + clipped_drawn;
        room.stats = Stats {
            triangles_in: counts.triangles,
            culled: counts.triangles.saturating_sub(drawn),
            clipped: counts.exceptions,
            drawn,
            ..Stats::default()
        };
        Ok(())
    }

    /// Gives the frame up if nothing has moved for long.
    fn watch(&mut self, target: &mut Target) -> Option<Result<Painted, Fallback>> {
        self.watch
            .is_stuck(&self.engine.counters())
            .then(|| self.give_up(target, Fault::Stuck))
    }

    fn give_up(&mut self, target: &mut Target, fault: Fault) -> Result<Painted, Fallback> {
        self.engine.cancel();
        self.stage = Stage::Idle;
        self.forget(target.colour);
        Err(fault.into())
    }

    fn slot(&self, colour: &[u16]) -> bool {
        colour.as_ptr().addr() as u32 != self.first_buffer
    }
}

/// Writes a set of lists as the engine does.
struct ListWriter<'a> {
    descriptors: &'a mut [u32],
    lists: &'a mut [u32],
    lengths: [u32; LENGTHS],
    count: u32,
    width: u32,
    ability: Shading,
    full: bool,
}

impl ListWriter<'_> {
    fn put(&mut self, descriptor: &Descriptor, top: u32, bottom: u32) {
        let words = descriptor.words(self.ability);
        let at = self.count as usize * words.len();
        let Some(to) = self.descriptors.get_mut(at..at + words.len()) else {
            self.full = true;
            return;
        };
        to.copy_from_slice(words);
        let rows = band_rows(self.width);
        let room = 4 << list_shift(self.width);
        for band in top / rows..=(bottom - 1) / rows {
            let Some(length) = self.lengths.get_mut(band as usize) else {
                continue;
            };
            let at = 4 * list_word(band, list_shift(self.width)) as usize + *length as usize;
            match self.lists.get_mut(at) {
                Some(entry) if (*length as usize) < room => {
                    *entry = self.count;
                    *length += 1;
                }
                _ => self.full = true,
            }
        }
        self.count += 1;
    }

    /// Writes the lengths; returns whether something had no room.
    fn finish(self) -> bool {
        if let Some(table) = self.lists.first_chunk_mut() {
            *table = self.lengths;
        }
        self.full
    }
}

/// Sees whether the engine goes on.
#[derive(Default)]
struct Watch {
    moved: u32,
    since: Option<u64>,
}

impl Watch {
    fn is_stuck(&mut self, counters: &Counters) -> bool {
        let moved = counters
            .words_read
            .wrapping_add(counters.words_written)
            .wrapping_add(counters.walking);
        let now = cpu::cycles();
        match self.since {
            Some(since) if moved == self.moved => now - since > STUCK,
            _ => {
                (self.moved, self.since) = (moved, Some(now));
                false
            }
        }
    }
}

fn fault_of(error: RenderError) -> Fault {
    match error {
        RenderError::Eye(_) => Fault::Eye,
        _ => Fault::Size,
    }
}

fn address(memory: &[u32]) -> u32 {
    memory.as_ptr().addr() as u32
}
