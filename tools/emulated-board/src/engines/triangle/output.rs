//! The output of the geometry passes of a frame: descriptors, band lists, and the list of exceptions.

use std::mem;

use glint_core::picture::Size;
use glint_model::triangle::descriptor::{Layout, ListCounts, ListWriter, list_word};
use litex_pac::triangle::offset;

use super::region::{COUNT_BITS, Regions, list_words};
use crate::MainMemory;
use crate::engines::parameters::Parameters;

/// The memory regions for the output.
#[derive(Clone, Copy)]
pub struct OutputLimits {
    /// Addresses of descriptors, lists and exceptions.
    places: [u32; 3],
    descriptor_limit: u32,
    list_shift: u32,
    /// Number of 16-byte words of the table of lengths and all lists.
    list_words: u64,
    exception_limit: u32,
    /// The layout of a descriptor.
    layout: Layout,
}

impl OutputLimits {
    /// Reads the parameters of a pass of an engine whose descriptors have this layout.
    pub fn new(parameters: &Parameters, size: Size, layout: Layout) -> Self {
        let list_shift = parameters.unsigned(offset::LIST_SHIFT, 5);
        let count = |register| parameters.unsigned(register, COUNT_BITS);
        Self {
            places: [
                offset::GEOMETRY_DESCRIPTORS,
                offset::GEOMETRY_LISTS,
                offset::EXCEPTIONS,
            ]
            .map(|register| parameters.word(register)),
            descriptor_limit: count(offset::DESCRIPTOR_LIMIT),
            list_shift,
            list_words: list_words(size, list_shift),
            exception_limit: count(offset::EXCEPTION_LIMIT),
            layout,
        }
    }

    /// Number of 32-bit words of a descriptor.
    const fn descriptor_size(&self) -> usize {
        self.layout.words()
    }

    pub fn check(&self, regions: &mut Regions) {
        let [descriptors, lists, exceptions] = self.places;
        let descriptor_words = u64::from(self.descriptor_limit) * self.descriptor_size() as u64 / 4;
        regions.check(descriptors, descriptor_words);
        regions.check(lists, self.list_words);
        regions.check(exceptions, self.exception_limit.div_ceil(4).into());
    }
}

/// The list of exceptions: indices of triangles in their meshes.
#[derive(Default)]
pub struct Exceptions {
    numbers: Vec<u32>,
    limit: usize,
    is_full: bool,
}

impl Exceptions {
    /// Appends an index, if the list has space.
    pub fn put(&mut self, number: u32) {
        if self.numbers.len() < self.limit {
            self.numbers.push(number);
        } else {
            self.is_full = true;
        }
    }
}

/// The output of a frame's passes so far.
pub struct Output {
    room: OutputLimits,
    descriptors: Vec<u32>,
    lists: Vec<u32>,
    counts: ListCounts,
    exceptions: Exceptions,
    /// Counts of descriptors, list entries and exceptions in memory.
    written: (ListCounts, usize),
}

impl Output {
    pub const fn new() -> Self {
        Self {
            room: OutputLimits {
                places: [0; 3],
                descriptor_limit: 0,
                list_shift: 0,
                list_words: 0,
                exception_limit: 0,
                layout: Layout::FLAT,
            },
            descriptors: Vec::new(),
            lists: Vec::new(),
            counts: ListCounts::EMPTY,
            exceptions: Exceptions {
                numbers: Vec::new(),
                limit: 0,
                is_full: false,
            },
            written: (ListCounts::EMPTY, 0),
        }
    }

    /// Prepares a pass, which continues the output of the previous pass or starts with empty lists.
    pub fn open(&mut self, room: OutputLimits, continues: bool) {
        if !continues {
            let Self {
                descriptors, lists, ..
            } = mem::replace(self, Self::new());
            (self.descriptors, self.lists) = (descriptors, lists);
        }
        self.room = room;
        let descriptor_words = room.descriptor_limit as usize * room.descriptor_size();
        self.descriptors.resize(descriptor_words, 0);
        self.lists.resize(4 * room.list_words as usize, 0);
        self.exceptions.limit = room.exception_limit as usize;
    }

    /// The band lists of a picture of this size and the list of exceptions, to which a pass appends.
    pub fn parts(&mut self, size: Size) -> (ListWriter<'_>, &mut Exceptions) {
        let lists = ListWriter::new(
            &mut self.descriptors,
            &mut self.lists,
            &mut self.counts,
            size.width(),
            self.room.list_shift,
            self.room.layout,
        );
        (lists, &mut self.exceptions)
    }

    /// Number of descriptors.
    pub const fn descriptors(&self) -> u32 {
        self.counts.descriptors()
    }

    /// Number of exceptions.
    pub const fn exceptions(&self) -> u32 {
        self.exceptions.numbers.len() as u32
    }

    /// Whether a descriptor, a list entry or an exception exceeded its region.
    pub const fn is_full(&self) -> bool {
        self.counts.is_full() || self.exceptions.is_full
    }

    /// Writes the new output to memory. Returns the number of written 16-byte words.
    pub fn write(&mut self, ram: &mut MainMemory) -> u32 {
        let [descriptors, lists, exceptions] = self.room.places;
        let (before, listed) = mem::replace(
            &mut self.written,
            (self.counts.clone(), self.exceptions.numbers.len()),
        );
        let mut put = |place: u32, first: usize, words: Option<&[u32]>| {
            let words = words.unwrap_or_default();
            let start = place.wrapping_add(4 * first as u32);
            if let Some(bytes) = ram.bytes_mut(start, 4 * words.len()) {
                for (bytes, word) in bytes.as_chunks_mut().0.iter_mut().zip(words) {
                    *bytes = word.to_le_bytes();
                }
            }
        };
        let ends = [&before, &self.counts].map(|counts| counts.descriptors() as usize);
        let [first, end] = ends.map(|number| number * self.room.descriptor_size());
        put(descriptors, first, self.descriptors.get(first..end));
        let mut written = (end - first).div_ceil(4);
        let lengths = before.lengths().iter().zip(self.counts.lengths());
        for (band, (&from, &to)) in (0..).zip(lengths) {
            let list = 4 * list_word(band, self.room.list_shift) as usize;
            let (first, end) = (list + from as usize, list + to as usize);
            put(lists, first, self.lists.get(first..end));
            // At the end of a pass, the incomplete last word of each list is written, even if the list has not grown.
            written += (to / 4 - from / 4 + u32::from(to % 4 > 0)) as usize;
        }
        put(lists, 0, Some(self.counts.lengths()));
        // Each length and each exception is written in a separate word.
        written += self.counts.lengths().len() + self.exceptions.numbers.len() - listed;
        for (place, number) in self.exceptions.numbers.iter().enumerate().skip(listed) {
            put(exceptions, place, Some(&[*number]));
        }
        written as u32
    }
}
