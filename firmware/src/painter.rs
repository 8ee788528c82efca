//! Draws with the triangle engine: geometry, clipping of what the engine leaves to the program, raster.

use core::mem;

use glint_core::camera::View;
use glint_core::mesh::Mesh;
use glint_model::descriptor::{self, Descriptor, TABLE_WORDS, band_rows, list_word};
use glint_model::{FrameSetup, Options, RenderError, Shading, Stats, clip_exceptions};
use litex_hal::triangle::{
    Counters, Engine, Fault, Geometry, Lists, Outcome, Prepared, Raster, Set,
};
use litex_pac::cpu;

/// The most descriptors of a set, where they are small, and the most exceptions. A frame with more is the CPU's.
const DESCRIPTORS: usize = 1 << 16;
/// Numbers of a set's descriptors; where these are large there is room for half as many.
const DESCRIPTOR_NUMBERS: usize = DESCRIPTORS * descriptor::words(Shading::Flat);
/// Numbers of all lists of a set, and of the table of their lengths.
const LIST_NUMBERS: usize = 1 << 20;
const LENGTHS: usize = 4 * TABLE_WORDS as usize;

/// Cycles without anything read, written or drawn after which the engine is given up: a tenth of a second.
const STUCK: u64 = litex_hal::timer::FREQUENCY as u64 / 10;

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
    /// The mesh.
    pub mesh: &'a Mesh<'a>,
    /// The camera.
    pub view: &'a View,
    /// The picture's size.
    pub size: (u32, u32),
    /// Whether back faces are left out.
    pub cull: bool,
    /// Where colours come from.
    pub shading: Shading,
    /// RGB565, row by row.
    pub colour: &'a mut [u16],
    /// Depth codes, if they are wanted.
    pub depth: Option<&'a mut [u32]>,
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
    /// How far the engine can shade.
    ability: Shading,
    rooms: [Room; 2],
    /// The first frame buffer's address, and what both hold.
    first_buffer: u32,
    known: [Known; 2],
    stage: Stage,
    /// The constants of the frame whose geometry was begun last.
    frame: Option<FrameSetup>,
    watch: Watch,
    start: (u64, Counters),
}

/// A frame by the engine.
pub struct Painted {
    /// Clock cycles from the first register written to the end seen.
    pub cycles: u64,
    /// What was counted; of many frames, triangles of the last and no pixels.
    pub stats: Stats,
    /// The engine's counters for this frame.
    pub counters: Counters,
}

impl Painter {
    /// A painter of two frame buffers, of which the first lies at `first_buffer`; nothing if `memory` is too small.
    pub fn new(engine: Engine, mut memory: &'static mut [u32], first_buffer: u32) -> Option<Self> {
        Some(Self {
            start: (0, engine.counters()),
            ability: engine.ability(),
            engine,
            rooms: [Room::cut(&mut memory)?, Room::cut(&mut memory)?],
            first_buffer,
            known: [None; 2],
            stage: Stage::Idle,
            frame: None,
            watch: Watch::default(),
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
    pub fn advance(&mut self, target: &mut Target) -> Option<Result<Painted, Fault>> {
        let step = match self.stage {
            Stage::Idle => {
                self.start = (cpu::cycles(), self.engine.counters());
                self.watch = Watch::default();
                match self.constants(target) {
                    Ok(frame) => {
                        let prepared = self.prepare_geometry(target, frame, 0);
                        self.start_geometry(prepared);
                    }
                    Err(fault) => return Some(Err(fault)),
                }
                self.stage = Stage::Geometry;
                return None;
            }
            Stage::Geometry => match self.engine.geometry() {
                None => return self.watch(target),
                Some(Ok(())) => self.clip(target),
                Some(fault) => fault,
            },
            Stage::Raster => match self.engine.raster() {
                None => return self.watch(target),
                Some(Ok(())) => {
                    self.stage = Stage::Idle;
                    let (start, counters) = self.start;
                    let counters = self.engine.counters() - counters;
                    return Some(Ok(Painted {
                        cycles: cpu::cycles() - start,
                        stats: Stats {
                            // The walker comes to a group of eight a clock.
                            pixels_tested: 8 * u64::from(counters.walking),
                            pixels_covered: counters.pixels_covered.into(),
                            pixels_drawn: counters.pixels_drawn.into(),
                            ..self.rooms[0].stats
                        },
                        counters,
                    }));
                }
                Some(fault) => fault,
            },
        };
        match step {
            Ok(()) => {
                self.start_raster(target);
                self.stage = Stage::Raster;
                None
            }
            Err(fault) => Some(self.give_up(target, fault)),
        }
    }

    /// Draws a frame again and again, back to back: while one is rastered the next one's geometry is made. What is returned
    /// is of `count` frames, from the beginning of a raster pass to the beginning of a later one. Nobody looks at the
    /// console meanwhile.
    ///
    /// # Errors
    /// As [`advance`](Self::advance).
    pub fn repeat(&mut self, target: &mut Target, count: u32) -> Result<Painted, Fault> {
        self.watch = Watch::default();
        let mut prepared = self.prepare_geometry(target, self.constants(target)?, 0);
        for frame in 0..=count {
            self.start_geometry(prepared);
            // The next frame's, while the engine works.
            let constants = self.constants(target)?;
            self.wait(Engine::geometry, target)?;
            if let Err(fault) = self.clip(target) {
                return self.give_up(target, fault);
            }
            // It goes where the raster pass still reads.
            prepared = self.prepare_geometry(target, constants, 1);
            if frame > 0 {
                self.wait(Engine::raster, target)?;
            }
            if frame == 0 {
                self.start = (cpu::cycles(), self.engine.counters());
            }
            if frame == count {
                break;
            }
            self.start_raster(target);
            // What is being drawn stays where it is.
            self.rooms.swap(0, 1);
        }
        let (start, counters) = self.start;
        Ok(Painted {
            cycles: cpu::cycles() - start,
            stats: self.rooms[1].stats,
            counters: self.engine.counters() - counters,
        })
    }

    /// Waits for the end of a pass.
    fn wait(&mut self, outcome: fn(&Engine) -> Outcome, target: &mut Target) -> Result<(), Fault> {
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
    fn constants(&self, target: &Target) -> Result<FrameSetup, Fault> {
        if target.shading == Shading::Smooth && self.ability == Shading::Flat {
            return Err(Fault::Shading);
        }
        let (width, height) = target.size;
        FrameSetup::new(target.view, width, height, target.mesh.radius()).map_err(|error| {
            match error {
                RenderError::Eye(_) => Fault::Eye,
                _ => Fault::Size,
            }
        })
    }

    /// Prepares a geometry pass that goes into a room.
    fn prepare_geometry(&mut self, target: &Target, frame: FrameSetup, room: usize) -> Prepared {
        let frame = self.frame.insert(frame);
        let room = &self.rooms[room];
        let pass = Geometry {
            mesh: target.mesh,
            frame,
            cull: target.cull,
            shading: target.shading,
            lists: Lists {
                descriptors: address(room.descriptors),
                descriptor_limit: (DESCRIPTOR_NUMBERS / descriptor::words(self.ability)) as u32,
                lists: address(room.lists),
            },
            exceptions: address(room.exceptions),
            exception_limit: DESCRIPTORS as u32,
        };
        self.engine
            .prepare_geometry(&pass, list_shift(target.size.0) as u8)
    }

    fn start_geometry(&mut self, pass: Prepared) {
        // SAFETY: the room is this painter's own, free of the pass before, and looked at when this one has ended; the mesh
        // is kept while the painter is busy.
        unsafe { self.engine.start_geometry(pass) };
    }

    fn start_raster(&mut self, target: &mut Target) {
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
            sets: self.rooms[0].sets,
        };
        *known = Some(size);
        // SAFETY: the lists are this painter's own and stay as they are until the pass has ended; frame and depth codes
        // are lent to it until then.
        unsafe { self.engine.start_raster(&pass) };
    }

    /// Makes descriptors of what the engine has left to be clipped.
    fn clip(&mut self, target: &Target) -> Result<(), Fault> {
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
                cull: target.cull,
                shading: target.shading,
                ..Options::default()
            };
            clipped_drawn = clip_exceptions(
                target.mesh,
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
    fn watch(&mut self, target: &mut Target) -> Option<Result<Painted, Fault>> {
        self.watch
            .is_stuck(&self.engine.counters())
            .then(|| self.give_up(target, Fault::Stuck))
    }

    fn give_up(&mut self, target: &mut Target, fault: Fault) -> Result<Painted, Fault> {
        self.engine.cancel();
        self.stage = Stage::Idle;
        self.forget(target.colour);
        Err(fault)
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

fn address(memory: &[u32]) -> u32 {
    memory.as_ptr().addr() as u32
}
