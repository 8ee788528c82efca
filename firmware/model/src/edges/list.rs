//! List of the edges of a mesh without duplicates, and their segments in a frame.

use glint_core::mesh::{Mesh, Triangle};

use super::table::{KEY_WORDS, Table};
use super::{Biases, Corner, EdgeStats, face, segment};
use crate::error::RenderError;
use crate::line::Segment;
use crate::triangle::{MeshSetup, Projected, project_chunk};

/// Number of triangles between two calls of `progress`.
const TRIANGLES_PER_CALL: usize = 64;

/// Placeholder for the number of an edge of length 0.
const NONE: u32 = u32::MAX;
/// Flag in the number of an edge, set only in the first triangle with this edge. `segments` emits the edge at this triangle.
const FIRST: u32 = 1 << 31;

/// The numbers of a triangle's three edges; edge i goes from corner i to the next corner.
type Sides = [u32; 3];

/// The edges of a mesh without duplicates: edges between equal pairs of positions count as one edge, even with different vertices.
///
/// The list is made when a mesh is first drawn, in the caller's memory. It needs three words per triangle, and four words times the next
/// power of two above the number of edges.
pub struct EdgeList<'m> {
    /// [`Sides`] for each triangle; then, while the list is made, a [`Table`] of the edges, and later the [`Biases`] of each edge.
    memory: &'m mut [u32],
    /// Address and length of the listed mesh; `None` for an empty list.
    mesh: Option<(usize, usize)>,
    /// Number of edges in the list.
    count: usize,
}

impl<'m> EdgeList<'m> {
    /// An empty list in `memory`.
    pub const fn new(memory: &'m mut [u32]) -> Self {
        Self {
            memory,
            mesh: None,
            count: 0,
        }
    }

    /// Number of words of memory that suffice for the list of a mesh.
    pub fn words(mesh: &Mesh) -> usize {
        let triangles = mesh.triangle_count() as usize;
        3 * triangles + Table::words(3 * triangles)
    }

    /// Empties the list. Call this after writes to the memory of the listed mesh: the list detects another mesh only by its address and
    /// length.
    pub const fn clear(&mut self) {
        self.mesh = None;
    }

    /// Makes the list of a mesh, unless the memory already holds the list of this mesh.
    ///
    /// Not inlined, because most frames do not run it.
    ///
    /// # Errors
    /// [`RenderError::Edges`] for a mesh whose edges do not fit the memory.
    #[inline(never)]
    pub fn make(&mut self, mesh: &Mesh, progress: &mut dyn FnMut()) -> Result<(), RenderError> {
        let bytes = mesh.bytes();
        let place = Some((bytes.as_ptr().addr(), bytes.len()));
        if self.mesh == place {
            return Ok(());
        }
        self.mesh = None;
        let triangles = mesh.triangle_count();
        let full = RenderError::Edges { triangles };
        let (sides, rest) = split(self.memory, triangles).ok_or(full)?;
        let mut table = Table::new(rest, 3 * triangles as usize).ok_or(full)?;
        let mut sides = sides.iter_mut();
        for chunk in mesh.chunks() {
            let numbered = chunk.triangles().zip(sides.by_ref());
            for (index, (triangle, sides)) in numbered.enumerate() {
                if index % TRIANGLES_PER_CALL == 0 {
                    progress();
                }
                let corners = corners(&triangle, |i| Some(chunk.vertex(i)?.position));
                let Some(corners) = corners else { continue };
                let [a, b, c] = corners;
                for (ends, number) in [[a, b], [b, c], [c, a]].into_iter().zip(sides) {
                    let [from, to] = ordered(ends, |at| *at);
                    *number = NONE;
                    if from != to {
                        let (edge, is_first) = table.insert(key([from, to])).ok_or(full)?;
                        *number = if is_first { edge | FIRST } else { edge };
                    }
                }
            }
        }
        self.count = table.len();
        self.mesh = place;
        Ok(())
    }

    /// Calls `emit` with the segment of each edge that has a part in the view volume of the frame, in the order of the triangles. With
    /// `cull`, back faces cause no bias. `scratch` must hold the vertices of the largest chunk. Calls `progress` at short intervals.
    ///
    /// # Errors
    /// [`RenderError::Edges`] or [`RenderError::Scratch`]; no segment was then emitted.
    pub fn segments(
        &mut self,
        mesh: &Mesh,
        cull: bool,
        frame: &MeshSetup,
        scratch: &mut [Projected],
        progress: &mut dyn FnMut(),
        emit: &mut dyn FnMut(&Segment),
    ) -> Result<EdgeStats, RenderError> {
        let (expected, found) = (mesh.largest_chunk(), scratch.len());
        let scratch = scratch
            .get_mut(..expected)
            .ok_or(RenderError::Scratch { expected, found })?;
        self.make(mesh, progress)?;
        let triangles = mesh.triangle_count();
        let full = RenderError::Edges { triangles };
        let (sides, rest) = split(self.memory, triangles).ok_or(full)?;
        let biases = rest.get_mut(..self.count).ok_or(full)?;
        biases.fill(0);

        let mut widen = |corners: &[Corner; 3], sides: &Sides| {
            let needed = face(frame, corners, cull);
            if needed == Biases::default() {
                return;
            }
            for &number in sides {
                if let Some(stored) = biases.get_mut((number & !FIRST) as usize) {
                    let [a, b] = unpacked(*stored);
                    *stored = packed([a.max(needed[0]), b.max(needed[1])]);
                }
            }
        };
        each_triangle(mesh, sides, Some(frame), scratch, progress, &mut widen);
        let mut drawn = 0;
        let mut draw = |[a, b, c]: &[Corner; 3], &[ab, bc, ca]: &Sides| {
            for (number, ends) in [(ab, [a, b]), (bc, [b, c]), (ca, [c, a])] {
                if number & FIRST == 0 {
                    continue;
                }
                let ends = ordered(ends, |(at, _)| *at);
                if let Some(&stored) = biases.get((number & !FIRST) as usize)
                    && let Some(segment) = segment(frame, ends, unpacked(stored))
                {
                    drawn += 1;
                    emit(&segment);
                }
            }
        };
        // If a mesh has a single chunk, its projected vertices are still in the scratch memory.
        let projects = mesh.chunks().nth(1).map(|_| frame);
        each_triangle(mesh, sides, projects, scratch, progress, &mut draw);
        Ok(EdgeStats {
            edges: self.count as u32,
            drawn,
        })
    }
}

/// Calls `visit` with the corners and the `sides` of each triangle of a mesh. With `projects`, first projects the vertices of each chunk
/// into `scratch`; otherwise `scratch` must already hold the projected vertices.
///
/// Not inlined, so that memory.x can place it beside its callees, and both stay in the instruction cache.
#[inline(never)]
fn each_triangle(
    mesh: &Mesh,
    sides: &[Sides],
    projects: Option<&MeshSetup>,
    scratch: &mut [Projected],
    progress: &mut dyn FnMut(),
    visit: &mut dyn FnMut(&[Corner; 3], &Sides),
) {
    let mut numbers = sides.iter();
    for chunk in mesh.chunks() {
        if let Some(frame) = projects {
            project_chunk(frame, &chunk, scratch);
        }
        let numbered = chunk.triangles().zip(numbers.by_ref());
        for (index, (triangle, sides)) in numbered.enumerate() {
            if index % TRIANGLES_PER_CALL == 0 {
                progress();
            }
            let of = |i| Some((chunk.vertex(i)?.position, scratch.get(i)?));
            if let Some(corners) = corners(&triangle, of) {
                visit(&corners, sides);
            }
        }
    }
}

/// Splits off the memory for the [`Sides`] of all triangles; `None` if `memory` is too small.
fn split(memory: &mut [u32], triangles: u32) -> Option<(&mut [Sides], &mut [u32])> {
    let (sides, rest) = memory.split_at_mut_checked(3 * triangles as usize)?;
    Some((sides.as_chunks_mut().0, rest))
}

/// The results of `of` for the three vertex indices of a triangle; `None` for an invalid index, which a checked mesh does not contain.
fn corners<T>(triangle: &Triangle, of: impl Fn(usize) -> Option<T>) -> Option<[T; 3]> {
    let [Some(a), Some(b), Some(c)] = triangle.indices.map(|i| of(usize::from(i))) else {
        return None;
    };
    Some([a, b, c])
}

/// The ends of an edge, sorted by position.
fn ordered<T>([from, to]: [T; 2], position: impl Fn(&T) -> [i16; 3]) -> [T; 2] {
    if position(&from) <= position(&to) {
        [from, to]
    } else {
        [to, from]
    }
}

/// The key of an edge in the hash table: its two positions.
fn key([[ax, ay, az], [bx, by, bz]]: [[i16; 3]; 2]) -> [u32; KEY_WORDS] {
    [
        packed_pair(ax, ay),
        packed_pair(az, bx),
        packed_pair(by, bz),
    ]
}

const fn packed_pair(low: i16, high: i16) -> u32 {
    packed([low as u16, high as u16])
}

const fn packed([low, high]: [u16; 2]) -> u32 {
    low as u32 | (high as u32) << 16
}

const fn unpacked(word: u32) -> Biases {
    [word as u16, (word >> 16) as u16]
}
