//! The raster pass: draws the descriptors of the band lists in memory into a frame in memory.

use glint_core::colour::Rounding;
use glint_core::picture::{Quarter, Samples, Size, Window};
use glint_core::texture::{Blend, Filter, Texture};
use glint_model::line::band_bounds;
use glint_model::triangle::descriptor::{Contents, Descriptor, GROUP, LENGTHS, Layout, list_word};
use glint_model::triangle::raster::draw_groups;
use glint_model::triangle::setup::Bounds;
use glint_model::triangle::textured::{OfTexture, Textured};
use glint_model::{Fog, FrameBuffer, Sky, average_lines};
use litex_pac::triangle::{Counters, Error, Raster, offset};

use super::region::{COUNT_BITS, Regions, WORD, entry, list_words, picture_size, record};
use super::time::{RasterTime, Work};
use crate::MainMemory;
use crate::engines::parameters::Parameters;
use crate::engines::raymarch::Raymarcher;

/// The first and the last drawn word of a line. For an empty line, the first word is greater than the last word.
type Extent = [i32; 2];

const EMPTY: Extent = [i32::MAX, 0];

const fn united(a: Extent, b: Extent) -> Extent {
    let first = if a[0] < b[0] { a[0] } else { b[0] };
    let last = if a[1] > b[1] { a[1] } else { b[1] };
    [first, last]
}

/// A set of lists and descriptors.
struct Set {
    /// Addresses of the lists and the descriptors, in 16-byte words.
    lists: u32,
    descriptors: u32,
    /// Size of a descriptor in 16-byte words.
    descriptor_words: u32,
    /// Number of descriptors.
    count: u32,
}

/// The raster unit.
pub struct RasterUnit {
    colour: Vec<u16>,
    depth: Vec<u32>,
    /// Extents of the lines of this frame, and of the last frame in each slot.
    now: Vec<Extent>,
    last: [Vec<Extent>; 2],
    /// Whether the frame buffer of each slot contains a complete frame.
    known: [bool; 2],
}

impl RasterUnit {
    pub fn new() -> Self {
        let [pixels, lines] = [Size::W1280.pixel_count(), Size::W1280.height() as usize];
        Self {
            colour: vec![0; pixels],
            depth: vec![0; pixels],
            now: vec![EMPTY; lines],
            last: [vec![EMPTY; lines], vec![EMPTY; lines]],
            known: [false; 2],
        }
    }

    /// Records that the frame in the slot is incomplete.
    pub fn cancel(&mut self, slot: bool) {
        self.known[usize::from(slot)] = false;
    }

    /// Draws the frame of a pass.
    ///
    /// # Errors
    /// The reason why the pass is refused; memory is then unchanged.
    pub fn run(
        &mut self,
        flags: Raster,
        parameters: &Parameters,
        layout: Layout,
        raymarcher: &mut Raymarcher,
        now: u64,
        ram: &mut MainMemory,
    ) -> Result<Work, Error> {
        let descriptor_words = layout.words() as u32 / 4;
        let size = picture_size(flags.size()).ok_or(Error::Size)?;
        let list_shift = parameters.unsigned(offset::LIST_SHIFT, 5);
        let frame = parameters.word(offset::FRAME);
        let averages = flags.average().then(|| Averages::of(flags, size));
        let has_depth = flags.depth() && averages.is_none();
        let depth = has_depth.then(|| parameters.word(offset::DEPTH));
        let pixels = averages.as_ref().map_or(size, |averages| averages.frame);
        let frame_words = (pixels.pixel_count() / GROUP as usize) as u64;
        let mut regions = Regions::default();
        regions.check(frame, frame_words);
        if let Some(depth) = depth {
            regions.check(depth, 2 * frame_words);
        }
        let sets = [
            (
                flags.first(),
                [offset::LISTS_0, offset::DESCRIPTORS_0, offset::COUNT_0],
            ),
            (
                flags.second(),
                [offset::LISTS_1, offset::DESCRIPTORS_1, offset::COUNT_1],
            ),
        ]
        .map(|(is_present, [lists, descriptors, count])| {
            is_present.then(|| {
                let [lists, descriptors] = [lists, descriptors].map(|at| parameters.word(at));
                let count = parameters.unsigned(count, COUNT_BITS);
                regions.check(lists, list_words(size, list_shift));
                regions.check(descriptors, u64::from(count) * u64::from(descriptor_words));
                Set {
                    lists: lists / WORD,
                    descriptors: descriptors / WORD,
                    descriptor_words,
                    count,
                }
            })
        });
        regions.result()?;

        let clear = parameters.unsigned(offset::CLEAR, 16) as u16;
        let slot = usize::from(flags.slot());
        let has_field = raymarcher.draws();
        let sky = (flags.sky() && !has_field).then(|| read_sky(parameters));
        let is_whole =
            flags.whole() || has_depth || sky.is_some() || averages.is_some() || !self.known[slot];
        let table = parameters.word(offset::TEXTURES) / WORD;
        let mut drawing = self.begin(size, clear, Rounding::new(flags.dither()), layout, table);
        drawing.fog = flags.fog().then(|| read_fog(parameters));
        if has_field {
            drawing.draw_field(raymarcher, now);
        }
        let sky_first = layout.is_textured && flags.sky_first() && sky.is_some();
        if let Some(sky) = sky {
            let samples = averages.as_ref().map_or(Samples::One, |_| Samples::Four);
            drawing.draw_sky(&sky, samples, sky_first);
        }
        for band in 0..size.bands() {
            for set in sets.iter().flatten() {
                drawing.draw_list(set, band, list_shift, ram);
            }
            drawing.end_band(band, is_whole);
        }
        if has_field || sky_first {
            drawing.cover();
        }
        let Drawing {
            counts,
            time,
            is_damaged,
            ..
        } = drawing;
        let mut written = match averages {
            None => self.flush(size, slot, is_whole, frame, ram),
            Some(averages) => self.flush_averages(size, &averages, frame, ram),
        };
        if let Some(depth) = depth {
            written += self.flush_depth(size, depth, ram);
        }
        self.known[slot] = true;
        // Counters are modulo 2^32.
        let counters = Counters {
            items_in: counts.read as u32,
            items_out: written,
            cycles_walking: time.walking as u32,
            groups: counts.groups as u32,
            pixels_covered: counts.covered as u32,
            pixels_drawn: counts.drawn as u32,
            ..Counters::default()
        };
        Ok(Work {
            error: if is_damaged { Error::List } else { Error::None },
            cycles: time.cycles(),
            counters,
        })
    }

    fn begin(
        &mut self,
        size: Size,
        clear: u16,
        rounding: Rounding,
        layout: Layout,
        textures: u32,
    ) -> Drawing<'_> {
        let [width, height] = size.pixels();
        let pixels = size.pixel_count();
        // The buffers have the size of the largest picture.
        let colour = self.colour.get_mut(..pixels).unwrap_or_default();
        let depth = self.depth.get_mut(..pixels).unwrap_or_default();
        colour.fill(clear);
        depth.fill(0);
        self.now.fill(EMPTY);
        Drawing {
            size,
            target: FrameBuffer {
                width,
                height,
                colour,
                depth,
                rounding,
            },
            layout,
            textures,
            fog: None,
            extents: &mut self.now,
            counts: Counts::default(),
            time: RasterTime::default(),
            is_damaged: false,
        }
    }

    /// Writes the words of a frame that can differ from the words in memory. Returns the number of written words.
    fn flush(
        &mut self,
        size: Size,
        slot: usize,
        is_whole: bool,
        frame: u32,
        ram: &mut MainMemory,
    ) -> u32 {
        let (width, words) = (size.width() as usize, (size.width() as i32) / GROUP);
        let lines = self.colour.chunks_exact(width).zip(&self.now);
        let lines = lines.zip(&mut self.last[slot]).take(size.height() as usize);
        let mut written = 0;
        for (number, ((line, now), last)) in (0..).zip(lines) {
            let [first, end] = match united(*now, *last) {
                _ if is_whole => [0, words],
                [first, last] => [first, last + 1],
            };
            *last = *now;
            if first >= end {
                continue;
            }
            let pixels = (first * GROUP) as usize..(end * GROUP) as usize;
            let place = frame + 2 * (number * size.width() + pixels.start as u32);
            let line = line.get(pixels).unwrap_or_default();
            if let Some(bytes) = ram.bytes_mut(place, 2 * line.len()) {
                for (bytes, pixel) in bytes.as_chunks_mut().0.iter_mut().zip(line) {
                    *bytes = pixel.to_le_bytes();
                }
            }
            written += (end - first) as u32;
        }
        written
    }

    /// Writes the averages of all samples. Returns the number of written words.
    fn flush_averages(
        &self,
        size: Size,
        averages: &Averages,
        frame: u32,
        ram: &mut MainMemory,
    ) -> u32 {
        let width = size.width() as usize;
        let pairs = self.colour.chunks_exact(2 * width);
        let lines = size.height() / 2;
        let mut pixels = vec![0; width / 2];
        for (y, pair) in (0..lines).zip(pairs) {
            average_lines(
                pair.split_at(width).into(),
                y,
                averages.rounding,
                &mut pixels,
            );
            let [left, top] = averages.origin;
            let place = frame + 2 * ((top + y) * averages.frame.width() + left);
            if let Some(bytes) = ram.bytes_mut(place, 2 * pixels.len()) {
                for (bytes, pixel) in bytes.as_chunks_mut().0.iter_mut().zip(&pixels) {
                    *bytes = pixel.to_le_bytes();
                }
            }
        }
        lines * size.width() / 2 / GROUP as u32
    }

    /// Writes the depths of a frame. Returns the number of written words.
    fn flush_depth(&self, size: Size, place: u32, ram: &mut MainMemory) -> u32 {
        let depth = self.depth.get(..size.pixel_count()).unwrap_or_default();
        if let Some(bytes) = ram.bytes_mut(place, 4 * depth.len()) {
            for (bytes, code) in bytes.as_chunks_mut().0.iter_mut().zip(depth) {
                *bytes = code.to_le_bytes();
            }
        }
        (depth.len() / 4) as u32
    }
}

/// The pixels of a frame with four samples a pixel.
struct Averages {
    /// Size of the frame.
    frame: Size,
    /// Column and line of the frame at which the pixels begin.
    origin: [u32; 2],
    /// How the averages are rounded.
    rounding: Rounding,
}

impl Averages {
    /// The pixels for a picture of samples of this size.
    fn of(flags: Raster, samples: Size) -> Self {
        let rounding = Rounding::new(flags.dither());
        if flags.quarter() {
            let quarter = Quarter {
                is_right: flags.right(),
                is_lower: flags.lower(),
            };
            let window = Window {
                size: samples,
                quarter: Some(quarter),
            };
            return Self {
                frame: samples,
                origin: window.origin().map(|place| place / 2),
                rounding,
            };
        }
        // Not all sizes of samples have a picture size of half their width and height.
        let half = Size::ALL
            .into_iter()
            .find(|size| size.doubled() == Some(samples));
        Self {
            frame: half.unwrap_or(samples),
            origin: [0; 2],
            rounding,
        }
    }
}

/// Counts of a frame.
#[derive(Default)]
struct Counts {
    /// Number of words read from memory.
    read: u64,
    groups: u64,
    covered: u64,
    drawn: u64,
}

/// A frame that is being drawn.
struct Drawing<'a> {
    size: Size,
    layout: Layout,
    /// Address of the table of textures, in 16-byte words.
    textures: u32,
    fog: Option<Fog>,
    target: FrameBuffer<'a>,
    extents: &'a mut [Extent],
    counts: Counts,
    time: RasterTime,
    /// Whether a list was too long, contained an invalid descriptor number, or named a damaged descriptor.
    is_damaged: bool,
}

impl Drawing<'_> {
    /// Draws the descriptors in one band's list of a set.
    fn draw_list(&mut self, set: &Set, band: u32, list_shift: u32, ram: &MainMemory) {
        let length = entry(ram, set.lists, band);
        self.counts.read += 1;
        if length > 4 << list_shift {
            self.is_damaged = true;
            return;
        }
        self.counts.read += u64::from(length.div_ceil(4));
        let list = set.lists + list_word(band, list_shift);
        let bounds = band_bounds(self.size, band);
        for place in 0..length {
            let number = entry(ram, list, place);
            self.is_damaged |= number >= set.count;
            let number = number & ((1 << COUNT_BITS) - 1);
            let first = set.descriptors + set.descriptor_words * number;
            let records =
                (0..set.descriptor_words).map(|word| record(ram, first.wrapping_add(word)));
            let words = records.flat_map(|record| {
                let words = [0, 4, 8, 12].map(|at| record[at..].first_chunk().copied());
                words.map(|word| word.map_or(0, u32::from_le_bytes))
            });
            self.draw(
                &Descriptor::from_words(words, self.layout),
                set.descriptor_words,
                &bounds,
                ram,
            );
        }
    }

    /// Draws the part of a triangle or a line that lies in a band.
    fn draw(
        &mut self,
        descriptor: &Descriptor,
        descriptor_words: u32,
        band: &Bounds,
        ram: &MainMemory,
    ) {
        let Self {
            target,
            extents,
            textures,
            fog,
            ..
        } = self;
        let mut groups = 0;
        let mut visit = |row: i32, columns: Extent| {
            groups += (columns[1] - columns[0] + 1) as u32;
            if let Some(extent) = extents.get_mut(row as usize) {
                *extent = united(*extent, columns);
            }
        };
        let mut colours = 0;
        let [covered, drawn] = match descriptor.contents(target.width) {
            Contents::Triangle(setup, colour, texture) => {
                let Some(part) = setup.in_rows(band.top..band.bottom) else {
                    return;
                };
                // The gateware keeps a descriptor for later bands, so its words are read in its first band only.
                if part.bounds.top == setup.bounds.top {
                    self.counts.read += u64::from(descriptor_words);
                }
                let below = part.bounds.top - setup.bounds.top;
                let textured = texture.and_then(|texture| {
                    let texture = read_texture(ram, *textures, &texture.moved(below))?;
                    // An estimate: counts only the words of the texture's header, because the texel
                    // cache is not modelled.
                    self.counts.read += 2;
                    Some(texture)
                });
                let fog = fog.as_ref();
                let coverage =
                    draw_groups(&part, colour, textured.as_ref(), fog, target, &mut visit);
                colours = match textured {
                    // With smooth shading, the engine draws one pixel per cycle.
                    _ if part.light.is_some() => coverage.covered,
                    Some(textured) if textured.texture.blend() != Blend::Opaque => {
                        coverage.drawn + BLENDED_GROUP * groups
                    }
                    Some(textured) => {
                        coverage.covered / quad_pixels(textured.texture.sampler().filter)
                    }
                    None => 0,
                };
                if fog.is_some() {
                    // One cycle for each half of a group; about half of the groups have only one half with pixels.
                    colours = colours.max(groups + groups / 2);
                }
                [coverage.covered, coverage.drawn]
            }
            Contents::Piece(piece) => {
                self.counts.read += u64::from(descriptor_words);
                let mut covered = 0;
                let drawn = piece.draw(band, target, &mut |pixel| {
                    covered += 1;
                    visit(pixel.row, [pixel.column / GROUP; 2]);
                });
                [covered, drawn]
            }
            Contents::Stray => {
                self.is_damaged = true;
                return;
            }
        };
        self.time.add(groups, colours);
        self.counts.groups += u64::from(groups);
        self.counts.covered += u64::from(covered);
        self.counts.drawn += u64::from(drawn);
    }

    /// Draws the field; the gateware draws it band by band, before the triangles of the band.
    fn draw_field(&mut self, raymarcher: &mut Raymarcher, now: u64) {
        let field = raymarcher.draw(self.size, &mut self.target, now);
        self.time.add_background(field.cycles);
        self.counts.groups += u64::from(field.pixels);
        self.counts.covered += u64::from(field.pixels);
        self.counts.drawn += u64::from(field.pixels);
    }

    /// Draws the sky. With `is_first`, the sky comes before the triangles of each band, one group per cycle; otherwise during the flush.
    fn draw_sky(&mut self, sky: &Sky, samples: Samples, is_first: bool) {
        // The buffer has the size of the picture.
        let _ = sky.fill(samples, &mut self.target, &mut || {});
        if is_first {
            let groups = self.size.pixel_count() as u64 / GROUP as u64;
            self.time.add_background(groups);
        }
    }

    /// Extends all lines to the whole width, because a field or the sky covers them. This happens after the estimates of
    /// all bands, because flushing whole lines takes no longer than the rays of a band.
    fn cover(&mut self) {
        let last = self.size.width() as i32 / GROUP - 1;
        let lines = self.extents.iter_mut().take(self.size.height() as usize);
        lines.for_each(|extent| *extent = [0, last]);
    }

    fn end_band(&mut self, band: u32, is_whole: bool) {
        let bounds = band_bounds(self.size, band);
        let lines = self
            .extents
            .get(bounds.top as usize..bounds.bottom as usize);
        let words = if is_whole {
            self.size.band_lines() * self.size.width() / GROUP as u32
        } else {
            let words = |[first, last]: &Extent| (last - first + 1).max(0) as u32;
            lines.unwrap_or_default().iter().map(words).sum()
        };
        self.time.end_band(self.size, words);
    }
}

/// Number of cycles of a group that is blended with the picture, in addition to a cycle for each of its drawn pixels.
const BLENDED_GROUP: u32 = 8;

/// Number of textured pixels that the engine draws per cycle.
const fn quad_pixels(filter: Filter) -> u32 {
    match filter {
        Filter::Nearest => 4,
        Filter::Bilinear => 2,
    }
}

/// The sky of a raster pass.
fn read_sky(parameters: &Parameters) -> Sky {
    let height = |offset| parameters.word(offset) as i32;
    let colour = |offset| colour(parameters, offset);
    Sky {
        above: height(offset::SKY_ABOVE),
        across: height(offset::SKY_ACROSS),
        down: height(offset::SKY_DOWN),
        zenith: colour(offset::SKY_ZENITH),
        horizon: colour(offset::SKY_HORIZON),
        nadir: colour(offset::SKY_NADIR),
    }
}

/// The fog of a raster pass.
fn read_fog(parameters: &Parameters) -> Fog {
    let offset = parameters.signed(offset::FOG_OFFSET, 13);
    Fog::in_perspective(offset, colour(parameters, offset::FOG_COLOUR))
}

/// A colour of a raster pass.
fn colour(parameters: &Parameters, offset: u32) -> [u8; 3] {
    let [red, green, blue, _] = parameters.word(offset).to_le_bytes();
    [red, green, blue]
}

/// Reads a texture through the frame's table at the address `table`, in 16-byte words. Returns
/// `None` if the table's entry does not point to a valid texture.
fn read_texture<'a>(ram: &'a MainMemory, table: u32, of: &OfTexture) -> Option<Textured<'a>> {
    let place = entry(ram, table, of.number.into());
    let length = u32::from_le_bytes(ram.array(place.wrapping_add(4))?);
    let texture = Texture::new_checked(ram.bytes(place, length as usize)?).ok()?;
    Some(of.with(texture))
}

const _: () = assert!(Size::W1280.bands() as usize <= LENGTHS);
