//! Memory that the geometry pass of a frame writes and the raster pass reads.

use core::mem;

use glint_core::feature::TEXTURE;
use glint_core::mesh::{Attribute, Mesh};
use glint_core::picture::Size;
use glint_core::texture::{Blend, Texture};
use glint_hal::triangle::{Lists, Set, Textures};
use glint_model::line::Segment;
use glint_model::triangle::descriptor::{Layout, ListCounts, list_shift};
use glint_model::{Stats, WireframeStats};

use super::fallback::Fallback;

/// Capacity of the memory of one frame. The CPU draws frames that need more memory.
#[derive(Clone, Copy)]
pub struct Capacity {
    /// Largest number of exceptions (triangles that need clipping) of a frame, and of descriptors without
    /// optional parts in a set. With optional parts, fewer descriptors fit.
    descriptors: usize,
    /// Number of 32-bit words of a set of band lists, including the table of list lengths.
    list_words: usize,
}

impl Capacity {
    /// The capacity for each of two frames in `words` 32-bit words; `None` if this memory is too small. A frame has two sets of lists; each
    /// set takes a sixteenth to an eighth of the memory.
    pub fn of(words: usize) -> Option<Self> {
        let list_words = 1 << (words / 8).checked_ilog2()?;
        let descriptors = 1 << (words / 96).checked_ilog2()?;
        (list_words >= 1 << 16).then_some(Self {
            descriptors,
            list_words,
        })
    }

    /// Number of 32-bit words for the descriptors of one set.
    const fn descriptor_words(self) -> usize {
        self.descriptors * Layout::FLAT.words()
    }
}

/// Memory of one frame: two sets of descriptors and band lists, and the list of exceptions.
pub struct Buffers {
    /// Descriptors of triangles that are not clipped.
    pub descriptors: &'static mut [u32],
    /// Band lists of these descriptors.
    pub lists: &'static mut [u32],
    /// Numbers of the exceptions: triangles that need clipping, which the geometry pass skips.
    pub exceptions: &'static mut [u32],
    /// Descriptors of clipped triangles, of the lines of a mesh's edges, or the segments of a wireframe.
    pub clipped_descriptors: &'static mut [u32],
    /// Band lists of clipped triangles, or of the lines of a mesh's edges.
    pub clipped_lists: &'static mut [u32],
    /// Counts of the clipper's output in `clipped_descriptors` and `clipped_lists`, if `sets` has a second set.
    pub clipped_counts: ListCounts,
    /// The sets of lists written by the geometry passes and by the clipper.
    pub sets: [Option<Set>; 2],
    /// Triangle counts of the geometry passes and of the clipper.
    pub stats: Stats,
    /// The textures to which the descriptors refer.
    pub textures: TextureTable,
    /// The list shift of the geometry and raster passes for each picture size, in the order of [`Size::ALL`].
    list_shifts: [u8; Size::ALL.len()],
}

impl Buffers {
    /// Splits off the memory of a frame from `memory`; `None` if `memory` is too small.
    pub fn split_off(memory: &mut &'static mut [u32], room: Capacity) -> Option<Self> {
        let mut piece = |length| {
            let (piece, rest) = mem::take(memory).split_at_mut_checked(length)?;
            *memory = rest;
            Some(piece)
        };
        Some(Self {
            descriptors: piece(room.descriptor_words())?,
            lists: piece(room.list_words)?,
            exceptions: piece(room.descriptors)?,
            clipped_descriptors: piece(room.descriptor_words())?,
            clipped_lists: piece(room.list_words)?,
            clipped_counts: ListCounts::EMPTY,
            sets: [None; 2],
            stats: Stats::default(),
            textures: TextureTable::new(piece(if TEXTURE.is_built {
                TextureTable::WORDS
            } else {
                0
            })?),
            list_shifts: Size::ALL.map(|size| list_shift(size.width(), room.list_words) as u8),
        })
    }

    /// The memory for the segments of a wireframe: that of the clipped triangles, which a wireframe does not have.
    pub const fn segments(&self) -> &[[u32; Segment::WORDS]] {
        self.clipped_descriptors.as_chunks().0
    }

    /// The memory for the segments of a wireframe, mutable.
    pub const fn segments_mut(&mut self) -> &mut [[u32; Segment::WORDS]] {
        self.clipped_descriptors.as_chunks_mut().0
    }

    /// Removes the sets and counts of the previous frame.
    pub fn clear(&mut self) {
        (self.sets, self.stats) = ([None; 2], Stats::default());
    }

    /// The list shift of the geometry and raster passes for a picture of this size.
    pub const fn list_shift(&self, size: Size) -> u8 {
        self.list_shifts[size as usize]
    }

    /// Number of descriptors of this layout that fit the memory of a set.
    pub const fn descriptor_limit(&self, layout: Layout) -> u32 {
        (self.descriptors.len() / layout.words()) as u32
    }

    /// The memory for the output of geometry passes, for a picture of this size and descriptors of this layout.
    pub fn lists(&self, layout: Layout, size: Size) -> Lists {
        Lists {
            descriptors: address(self.descriptors),
            descriptor_limit: self.descriptor_limit(layout),
            lists: address(self.lists),
            list_shift: self.list_shift(size),
            exceptions: address(self.exceptions),
            exception_limit: self.exceptions.len() as u32,
        }
    }

    /// The memory for the output of the geometry pass of a mesh's edges, which are drawn after its faces.
    pub fn edge_lists(&self, layout: Layout, size: Size) -> Lists {
        Lists {
            descriptors: address(self.clipped_descriptors),
            lists: address(self.clipped_lists),
            ..self.lists(layout, size)
        }
    }

    /// The set of lists that geometry passes have written, with `count` descriptors.
    pub fn set(&self, count: u32) -> Set {
        Set {
            descriptors: address(self.descriptors),
            count,
            lists: address(self.lists),
        }
    }

    /// The set of lists of clipped triangles, or of a mesh's edges, with `count` descriptors.
    pub fn clipped_set(&self, count: u32) -> Set {
        Set {
            descriptors: address(self.clipped_descriptors),
            count,
            lists: address(self.clipped_lists),
        }
    }
}

/// The table of the addresses of a frame's textures (docs/textures.md, "Textures of a frame"). Entry 0 is not used.
pub struct TextureTable {
    addresses: &'static mut [u32],
    /// Number of the last texture.
    count: usize,
    /// Whether a texture is blended with the picture behind it.
    blends: bool,
}

impl TextureTable {
    /// Number of 32-bit words in a table: a descriptor has 8 bits for the number of a texture.
    const WORDS: usize = 1 << 8;

    const fn new(addresses: &'static mut [u32]) -> Self {
        Self {
            addresses,
            count: 0,
            blends: false,
        }
    }

    /// Removes the textures of the previous frame.
    pub const fn clear(&mut self) {
        (self.count, self.blends) = (0, false);
    }

    /// Adds the textures of a mesh to the table, unless the table already contains them; with a replacement texture, adds entries of this
    /// texture in their place. Returns the textures for the geometry pass; `None` for a mesh without textures or texture coordinates.
    ///
    /// # Errors
    /// The table is full.
    pub fn of_mesh<'a>(
        &mut self,
        mesh: &Mesh<'a>,
        replacement: Option<&Texture>,
    ) -> Result<Option<Textures<'a>>, Fallback> {
        let coordinates = mesh.attribute(Attribute::TextureCoordinates);
        let Some((coordinates, first)) = coordinates.zip(mesh.textures().next()) else {
            return Ok(None);
        };
        // The textures of a mesh are consecutive entries of the table.
        let before = match replacement {
            Some(replacement) => {
                // All meshes of the frame show this texture, so the meshes share its entries.
                let mut missing = mesh.textures().skip(self.count);
                missing
                    .all(|_| self.add(replacement).is_some())
                    .then_some(0)
            }
            None => {
                let first = self.number(&first);
                let fits = mesh
                    .textures()
                    .all(|texture| self.number(&texture).is_some());
                first.filter(|_| fits).map(|first| first - 1)
            }
        };
        let before = before.ok_or(Fallback::TooManyTextures)?;
        Ok(Some(Textures {
            coordinates,
            before,
        }))
    }

    /// The number of a texture in the table. Adds the texture if the table does not contain it; `None` if the table is full.
    pub fn number(&mut self, texture: &Texture) -> Option<u8> {
        let address = address(texture.bytes());
        let known = self.addresses.get(1..=self.count).unwrap_or_default();
        match known.iter().rposition(|&known| known == address) {
            Some(place) => u8::try_from(place + 1).ok(),
            None => self.add(texture),
        }
    }

    /// Adds a texture to the table, and returns its number; `None` if the table is full.
    fn add(&mut self, texture: &Texture) -> Option<u8> {
        let next = self.count + 1;
        *self.addresses.get_mut(next)? = address(texture.bytes());
        self.count = next;
        self.blends |= texture.blend() != Blend::Opaque;
        u8::try_from(next).ok()
    }

    /// Whether a texture of the frame is blended with the picture behind it.
    pub const fn blends(&self) -> bool {
        TEXTURE.is_built && self.blends
    }

    /// The address of the table for the engine; `None` without textures.
    pub fn address(&self) -> Option<u32> {
        (TEXTURE.is_built && self.count > 0).then(|| address(self.addresses))
    }
}

/// Progress of the projection of a wireframe's program, or of a mesh's edges, to segments in memory.
#[derive(Default)]
pub struct Projected {
    /// Number of projected words of the program.
    pub words: usize,
    /// Number of segments in memory.
    pub lines: u32,
    /// Counts of the projected words, without pixels.
    pub stats: WireframeStats,
}

/// The bus address of a region of memory, for the engine.
pub fn address<T>(memory: &[T]) -> u32 {
    memory.as_ptr().addr() as u32
}
