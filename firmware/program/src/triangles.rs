//! Triangles in pixels: a list that other libraries, or a program's own geometry, fill for each picture. The triangle engine draws them
//! as a mesh that an orthographic camera sees.

use bytemuck::{must_cast_slice, must_cast_slice_mut};
use glint_core::camera::{Projection, View, ViewError};
use glint_core::colour::Rgb565;
use glint_core::deviation::Deviation;
use glint_core::feature::TEXTURE;
use glint_core::fixed::{Q32_32, Turns, U8_28};
use glint_core::mesh::{
    Attribute, ChunkHeader, MAGIC, MAX_RADIUS, Mesh, MeshHeader, Triangle as Record, Vertex,
};
use glint_core::picture::Size;
use glint_core::records::{self, TEXTURES};
use glint_core::texture::{self, Blend};

use crate::Aligned;

/// A triangle of a picture.
///
/// ```
/// use glint_program::core::colour::Rgb565;
/// use glint_program::core::texture::Blend;
/// use glint_program::triangles::Triangle;
///
/// /// Half of a square of this size, whose upper left pixel is (`x`, `y`).
/// fn half_square([x, y]: [i32; 2], size: i32, colour: Rgb565) -> Triangle {
///     let corners = [[x, y], [x + size, y], [x, y + size]];
///     Triangle {
///         corners: corners.map(|corner| corner.map(|pixels| 4 * pixels)),
///         depths: [0; 3],
///         colours: [colour; 3],
///         blend: Blend::Opaque,
///     }
/// }
/// assert_eq!(half_square([10, 0], 5, Rgb565::WHITE).corners[1], [60, 0]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Triangle {
    /// Corners, to the right and down from the upper left corner of the picture, in quarters of a pixel: the middle of the pixel (x, y) is
    /// (4x + 2, 4y + 2). A corner more than 8,191 pixels from the middle of the picture is moved to this distance on each axis. A triangle
    /// with a corner more than some 2,000 pixels outside of the picture requires the feature `clipping`.
    pub corners: [[i32; 2]; 3],
    /// Depth of each corner: a pixel of a smaller depth hides others, and of equal depths the later triangle hides the earlier one.
    pub depths: [u16; 3],
    /// Colour of each corner. With flat shading the triangle has their mean.
    pub colours: [Rgb565; 3],
    /// How the triangle is blended with the picture behind it. A blended triangle hides nothing that comes later. It requires the feature
    /// `texture`; without it the triangle is opaque.
    pub blend: Blend,
}

/// A memory word. Its parts are stored as 32 bits, which takes the soft core fewer cycles than storing bytes.
type Word = [u32; 4];

/// Number of bytes of a memory word.
const WORD: usize = records::WORD;

/// Number of triangles in a chunk.
const CHUNK: usize = 32;
/// Number of vertices in a chunk: three for each triangle, because triangles share no vertices.
const VERTICES: usize = 3 * CHUNK;
/// Number of words of a chunk.
const CHUNK_WORDS: usize = 1 + VERTICES + CHUNK;
/// Number of words of a chunk with the texture coordinates of its vertices, which are 0.
const BLOCK: usize = if TEXTURE.is_built {
    CHUNK_WORDS + VERTICES * Attribute::TextureCoordinates.bytes() / WORD
} else {
    CHUNK_WORDS
};
/// Number of words of the mesh's header.
const HEADER: usize = MeshHeader::BYTES / WORD;
/// Base-2 logarithm of the quarters of a pixel in a world unit.
const QUARTERS_LOG2: u32 = 14;
/// The normal of all triangles: towards the camera, s2.14.
const NORMAL: [i16; 3] = [0, -(1 << 14), 0];

/// A list of at most 32·(`N` − 1) triangles for a picture of one size.
///
/// A list takes `N` times 2,832 bytes, without the feature `texture` 2,064 bytes.
///
/// ```
/// # use glint_program::core::{colour::Rgb565, texture::Blend};
/// # use glint_program::{Board, Program, host::Host};
/// use glint_program::core::picture::Size;
/// use glint_program::triangles::{Triangle, Triangles};
/// use glint_program::{Picture, PictureError};
///
/// # struct Flag { list: Triangles<2> }
/// # impl Program for Flag {
/// fn start(_: &mut Board) -> Self {
///     let mut list = Triangles::new();
///     list.set(Size::W640, [Triangle {
///         corners: [[0, 0], [4 * 640, 0], [0, 4 * 360]],
///         depths: [0; 3],
///         colours: [Rgb565::from_rgb888([0xff, 0, 0]); 3],
///         blend: Blend::Opaque,
///     }]);
///     Self { list }
/// }
/// #     fn update(&mut self, _: &mut Board) {}
/// fn draw<'p>(&'p self, picture: &mut Picture<'p>) -> Result<(), PictureError> {
///     picture.triangles(&self.list)?;
///     Ok(())
/// }
/// # }
/// # let mut host = Host::<Flag>::start();
/// # host.run(1)?;
/// # assert_eq!(host.size(), Size::W640);
/// # assert!(host.picture()[0] == 0xf800 && host.picture()[640 * 360 - 1] != 0xf800);
/// # Ok::<(), glint_program::host::HostError>(())
/// ```
pub struct Triangles<const N: usize> {
    /// A mesh of whole chunks. The first block leaves room for the header, and for the textures behind the last chunk.
    words: Aligned<[[Word; BLOCK]; N]>,
    /// Number of words of the mesh.
    length: usize,
    size: Size,
}

impl<const N: usize> Triangles<N> {
    /// Largest number of triangles.
    ///
    /// ```
    /// assert_eq!(glint_program::triangles::Triangles::<3>::CAPACITY, 64);
    /// ```
    pub const CAPACITY: usize = CHUNK * (N - 1);

    /// An empty list.
    ///
    /// ```
    /// use glint_program::core::picture::Size;
    /// use glint_program::triangles::Triangles;
    ///
    /// let mut list = Triangles::<4>::new();
    /// assert_eq!(list.set(Size::W320, []), 0);
    /// ```
    #[must_use]
    pub fn new() -> Self {
        const { assert!(N > 1, "a list of triangles needs at least 2 blocks") };
        let mut list = Self {
            words: Aligned([[[0; 4]; BLOCK]; N]),
            length: 0,
            size: Size::W320,
        };
        list.finish(0, 0);
        list
    }

    /// Replaces the triangles, for a picture of this size. Triangles without area are left out. Returns the number of triangles that exceed
    /// the [capacity](Self::CAPACITY); they are left out too.
    ///
    /// ```
    /// # use glint_program::core::{colour::Rgb565, picture::Size, texture::Blend};
    /// use glint_program::triangles::{Triangle, Triangles};
    ///
    /// # let corners = [[0, 0], [0, 8], [8, 0]];
    /// # let (depths, colours, blend) = ([0; 3], [Rgb565::WHITE; 3], Blend::Opaque);
    /// let triangle = Triangle { corners, depths, colours, blend };
    /// let mut list = Triangles::<2>::new();
    /// assert_eq!(list.set(Size::W320, [triangle; 32]), 0);
    /// assert_eq!(list.set(Size::W320, [triangle; 40]), 8);
    /// ```
    pub fn set(&mut self, size: Size, triangles: impl IntoIterator<Item = Triangle>) -> usize {
        let mut new = self.replace(size);
        let is_beyond = |triangle| !new.add(&triangle);
        triangles.into_iter().map(is_beyond).map(usize::from).sum()
    }

    /// Removes all triangles, and returns a value that adds new ones, for a picture of this size. The list shows them when the value is
    /// dropped.
    ///
    /// ```
    /// # use glint_program::core::{colour::Rgb565, picture::Size, texture::Blend};
    /// # use glint_program::triangles::{Triangle, Triangles};
    /// # let corners = [[0, 0], [0, 8], [8, 0]];
    /// # let (depths, colours, blend) = ([0; 3], [Rgb565::WHITE; 3], Blend::Opaque);
    /// # let triangle = Triangle { corners, depths, colours, blend };
    /// let mut list = Triangles::<2>::new();
    /// let mut new = list.replace(Size::W640);
    /// while new.add(&triangle) {}
    /// ```
    pub fn replace(&mut self, size: Size) -> New<'_, N> {
        self.size = size;
        New {
            list: self,
            middle: size.pixels().map(|pixels| 2 * pixels as i32),
            count: 0,
            largest_texture: 0,
        }
    }

    /// Writes the headers, the texture coordinates and the textures, and removes earlier triangles from the rest of the last chunk.
    fn finish(&mut self, count: usize, largest_texture: u8) {
        let words = self.words.0.as_flattened_mut();
        let chunks = count.div_ceil(CHUNK).max(1);
        for number in 0..chunks {
            let chunk = words.get_mut(HEADER + CHUNK_WORDS * number..);
            let Some((header, records)) = chunk.and_then(<[_]>::split_first_mut) else {
                break;
            };
            let chunk = ChunkHeader {
                vertices: VERTICES as u32,
                triangles: CHUNK as u32,
            };
            *header = word(chunk.to_bytes());
            let used = (count - CHUNK * number).min(CHUNK);
            // The words may have been those of a texture.
            for unused in [3 * used..VERTICES, VERTICES + used..VERTICES + CHUNK] {
                records.get_mut(unused).unwrap_or_default().fill([0; 4]);
            }
        }
        let mut length = HEADER + CHUNK_WORDS * chunks;
        let mut attributes = 0;
        if TEXTURE.is_built && largest_texture != 0 {
            let coordinates = (BLOCK - CHUNK_WORDS) * chunks;
            if let Some(rest) = words.get_mut(length..) {
                let (zeros, rest) = rest.split_at_mut_checked(coordinates).unwrap_or_default();
                zeros.fill([0; 4]);
                let textures = draw_textures(must_cast_slice_mut(rest), largest_texture);
                length += coordinates + textures / WORD;
                attributes = Attribute::TextureCoordinates.bit() | TEXTURES;
            }
        }
        let header = MeshHeader {
            magic: MAGIC,
            length: (WORD * length) as u32,
            chunks: chunks as u32,
            vertices: (VERTICES * chunks) as u32,
            triangles: (CHUNK * chunks) as u32,
            // A constant radius, so that depths have the same precision in all pictures.
            radius: MAX_RADIUS,
            checksum: 0,
            attributes,
        };
        if let Some(first) = must_cast_slice_mut(words).first_chunk_mut() {
            *first = header.to_bytes();
        }
        self.length = length;
    }

    /// Size of the pictures of this list.
    pub(crate) const fn size(&self) -> Size {
        self.size
    }

    /// The camera that sees the list.
    ///
    /// # Errors
    /// [`ViewError`], which no size causes.
    pub(crate) fn view(&self) -> Result<View, ViewError> {
        // 2.25 world units before the plane of depth 32,768, so the smallest depth is behind the near plane.
        let eye = [Q32_32::ZERO, Q32_32::lit("-2.25"), Q32_32::ZERO];
        let half_width = U8_28::from_bits(u64::from(2 * self.size.width()) << (28 - QUARTERS_LOG2));
        let ahead = View::look(eye, Turns(0), Turns(0), Turns(0))?;
        ahead
            .with_projection(Projection::Orthographic)
            .with_half_width(half_width)
    }

    /// The list as a mesh.
    ///
    /// # Errors
    /// [`Deviation`], which no list causes.
    pub(crate) fn mesh(&self) -> Result<Mesh<'_>, Deviation> {
        let words = self.words.0.as_flattened().get(..self.length);
        Mesh::new_checked(must_cast_slice(words.unwrap_or_default()))
    }
}

impl<const N: usize> Default for Triangles<N> {
    fn default() -> Self {
        Self::new()
    }
}

/// New triangles of a list.
///
/// ```
/// # use glint_program::core::{colour::Rgb565, picture::Size, texture::Blend};
/// use glint_program::triangles::{New, Triangle, Triangles};
///
/// /// Adds a square of this size, whose upper left pixel is (`x`, `y`).
/// fn square<const N: usize>(new: &mut New<N>, [x, y]: [i32; 2], size: i32, colour: Rgb565) {
///     let [left, top, right, bottom] = [x, y, x + size, y + size].map(|pixels| 4 * pixels);
///     for corners in [[[left, top], [right, top], [right, bottom]], [[left, top], [right, bottom], [left, bottom]]] {
///         new.add(&Triangle { corners, depths: [0; 3], colours: [colour; 3], blend: Blend::Opaque });
///     }
/// }
/// square(&mut Triangles::<2>::new().replace(Size::W320), [0, 0], 10, Rgb565::WHITE);
/// ```
pub struct New<'l, const N: usize> {
    list: &'l mut Triangles<N>,
    /// The middle of the picture, in quarters of a pixel.
    middle: [i32; 2],
    count: usize,
    largest_texture: u8,
}

impl<const N: usize> New<'_, N> {
    /// Adds a triangle; one without area is left out. Returns `false` if the list is full.
    ///
    /// ```
    /// # use glint_program::core::{colour::Rgb565, picture::Size, texture::Blend};
    /// # use glint_program::triangles::{Triangle, Triangles};
    /// # let corners = [[0, 0], [0, 8], [8, 0]];
    /// # let (depths, colours, blend) = ([0; 3], [Rgb565::WHITE; 3], Blend::Opaque);
    /// # let triangle = Triangle { corners, depths, colours, blend };
    /// let mut list = Triangles::<2>::new();
    /// let mut new = list.replace(Size::W320);
    /// assert!((0..32).all(|_| new.add(&triangle)) && !new.add(&triangle));
    /// ```
    pub fn add(&mut self, triangle: &Triangle) -> bool {
        let [a, b, c] = triangle.corners.map(|corner| self.place(corner));
        let product = |a: i32, b: i32| i64::from(a) * i64::from(b);
        let [clockwise, counter_clockwise] = [
            product(b[0] - a[0], c[1] - a[1]),
            product(c[0] - a[0], b[1] - a[1]),
        ];
        if clockwise == counter_clockwise {
            return true;
        }
        let (chunk, place) = (self.count / CHUNK, self.count % CHUNK);
        let words = self.list.words.0.as_flattened_mut();
        let chunk = words.get_mut(HEADER + CHUNK_WORDS * chunk..);
        let chunk = chunk.and_then(<[_]>::first_chunk_mut::<CHUNK_WORDS>);
        let Some(chunk) = chunk.filter(|_| self.count < Triangles::<N>::CAPACITY) else {
            return false;
        };
        // Seen from the front, corners are counter-clockwise.
        let order = if clockwise > counter_clockwise {
            [0, 2, 1]
        } else {
            [0, 1, 2]
        };
        let first = 3 * place;
        for (number, corner) in order.into_iter().enumerate() {
            let [x, y] = [a, b, c][corner];
            let vertex = Vertex {
                // 16 bits suffice for the saturated place, and for the depth minus 2^15.
                position: [
                    x as i16,
                    (i32::from(triangle.depths[corner]) - (1 << 15)) as i16,
                    -y as i16,
                ],
                normal: NORMAL,
                colour: triangle.colours[corner],
                fine: 0,
            };
            if let Some(place) = chunk.get_mut(1 + first + number) {
                *place = word(vertex.to_bytes());
            }
        }
        let texture = if TEXTURE.is_built {
            triangle.blend.number()
        } else {
            0
        };
        let record = Record {
            // At most 95.
            indices: [0, 1, 2].map(|corner| (first + corner) as u16),
            colour: mean(&triangle.colours),
            normal: NORMAL,
            texture,
        };
        if let Some(place) = chunk.get_mut(1 + VERTICES + place) {
            *place = word(record.to_bytes());
        }
        self.largest_texture = self.largest_texture.max(texture);
        self.count += 1;
        true
    }

    /// The place of a corner from the middle of the picture; saturates.
    fn place(&self, [x, y]: [i32; 2]) -> [i32; 2] {
        let limit = i32::from(i16::MAX);
        let [middle_x, middle_y] = self.middle;
        [x.saturating_sub(middle_x), y.saturating_sub(middle_y)]
            .map(|place| place.clamp(-limit, limit))
    }
}

impl<const N: usize> Drop for New<'_, N> {
    fn drop(&mut self) {
        self.list.finish(self.count, self.largest_texture);
    }
}

/// The memory word with these bytes.
fn word(bytes: [u8; WORD]) -> Word {
    let (parts, _) = bytes.as_chunks();
    [0, 1, 2, 3].map(|i: usize| parts.get(i).map_or(0, |&part| u32::from_le_bytes(part)))
}

/// The mean of three colours, each channel rounded to nearest.
fn mean(colours: &[Rgb565; 3]) -> Rgb565 {
    let [first, second, third] = colours;
    if first == second && second == third {
        return *first;
    }
    let channels = colours.map(|colour| colour.channels().map(u16::from));
    let [r, g, b] = [0, 1, 2].map(|i: usize| {
        let sum: u16 = channels.iter().map(|channels| channels[i]).sum();
        (2 * sum + 3) / 6
    });
    Rgb565(r << 11 | g << 5 | b)
}

/// Writes a white texture for each kind of blending up to this number, and returns their length in bytes.
fn draw_textures(memory: &mut [u8], largest: u8) -> usize {
    let mut length = 0;
    for blend in Blend::ALL.into_iter().skip(1).take(largest.into()) {
        let picture = texture::Picture {
            size_log2: [3; 2],
            is_cut_out: false,
            is_atlas: true,
            blend,
            texel: |_| Some(Rgb565::WHITE),
        };
        let rest = memory.get_mut(length..).unwrap_or_default();
        length += texture::draw(rest, &picture).unwrap_or(0);
    }
    length
}
