//! Order of a mesh's triangles for the engine's vertex cache.

use crate::error::FormatError;
use crate::formats::glm;
use glint_core::mesh::{self, Attribute, IndexedTriangle, Vertex};
use glint_model::triangle::vertex_cache;

/// A mesh in the board's memory layout, and the number of vertices that the engine fetches to draw
/// it.
pub struct Encoded {
    /// The encoded mesh.
    pub bytes: Vec<u8>,
    /// Number of vertex fetches to draw the mesh once.
    pub fetches: u32,
}

/// The optional parts of a mesh.
#[derive(Default)]
pub struct Extra<'a> {
    /// The texture coordinates of the vertices in the board's memory layout; empty if the mesh has none.
    pub coordinates: &'a [u8],
    /// The textures in the board's memory layout.
    pub textures: &'a [Vec<u8>],
}

impl Encoded {
    /// Encodes triangles in the order given, and in each chunk the vertices in the order of their first use.
    ///
    /// # Errors
    /// The mesh is too large.
    pub fn new(
        vertices: &[Vertex],
        triangles: &[IndexedTriangle],
        extra: &Extra,
    ) -> Result<Self, FormatError> {
        let attributes = [(Attribute::TextureCoordinates, extra.coordinates)];
        let attributes = if extra.coordinates.is_empty() {
            &[][..]
        } else {
            &attributes
        };
        let encoded = mesh::encode_with(vertices, triangles, attributes, extra.textures);
        let bytes = encoded.map_err(|error| match error {
            mesh::EncodeError::TooLarge => {
                let expected = format!("a mesh of at most {} bytes", mesh::MAX_BYTES);
                let textures: usize = extra.textures.iter().map(Vec::len).sum();
                let found = match textures {
                    0 => "more".into(),
                    _ => format!("more, {textures} of them for textures"),
                };
                FormatError::whole(expected, found)
            }
            other => FormatError::whole("a mesh", other.to_string()),
        })?;
        let fetches = vertex_cache::fetches(&glm::check(&bytes)?);
        Ok(Self { bytes, fetches })
    }
}

/// Returns the triangles in an order for which the engine fetches few vertices. Triangles with the same three indices keep their
/// order.
///
/// The vertices of a chunk are numbered in the order of their first use, so a new vertex replaces
/// the oldest vertex in the direct-mapped cache, as in a FIFO of the same size. The algorithm is by
/// Sander, Nehab and Barczak, "Fast Triangle Reordering for Vertex Locality and Reduced Overdraw",
/// ACM Transactions on Graphics 26(3), 2007: it emits all triangles about one vertex, then about
/// the next vertex, in linear time. `vertices` is greater than all indices.
pub fn for_cache(vertices: usize, triangles: &[IndexedTriangle]) -> Vec<IndexedTriangle> {
    let mut fans = Fans::new(vertices, triangles);
    let mut ordered = Vec::with_capacity(triangles.len());
    let mut next = fans.after_dead_end();
    while let Some(vertex) = next {
        let start = ordered.len();
        fans.draw(vertex, triangles, &mut ordered);
        let drawn = ordered.get(start..).unwrap_or_default();
        next = fans.best(drawn).or_else(|| fans.after_dead_end());
    }
    ordered
}

/// The triangles about each vertex, and the state of the simulated vertex cache.
struct Fans {
    /// Triangle numbers grouped by vertex, in each group in the order of the file.
    triangles: Vec<u32>,
    /// For each vertex, the index in `triangles` of the start of its group, followed by the end of the last group.
    starts: Vec<usize>,
    /// For each vertex, the number of its triangles that are not drawn yet.
    left: Vec<u32>,
    is_drawn: Vec<bool>,
    /// For each vertex, the value of the fetch counter after its last fetch.
    fetched: Vec<usize>,
    fetches: usize,
    /// Vertices of the drawn triangles, most recent last.
    recent: Vec<u32>,
    /// The vertices before this vertex have no triangles left.
    cursor: usize,
}

impl Fans {
    fn new(vertices: usize, triangles: &[IndexedTriangle]) -> Self {
        let mut left = vec![0; vertices];
        for index in triangles.iter().flat_map(|triangle| triangle.indices) {
            left[index as usize] += 1;
        }
        let mut starts = vec![0; vertices + 1];
        for (vertex, count) in left.iter().enumerate() {
            starts[vertex + 1] = starts[vertex] + *count as usize;
        }
        let mut ends = starts.clone();
        let mut about = vec![0; 3 * triangles.len()];
        for (number, triangle) in (0..).zip(triangles) {
            for index in triangle.indices {
                let end = &mut ends[index as usize];
                about[*end] = number;
                *end += 1;
            }
        }
        Self {
            triangles: about,
            starts,
            left,
            is_drawn: vec![false; triangles.len()],
            fetched: vec![0; vertices],
            fetches: vertex_cache::SLOTS,
            recent: Vec::new(),
            cursor: 0,
        }
    }

    /// Number of fetches since the last fetch of a vertex: less than [`vertex_cache::SLOTS`] while it is in the cache.
    fn age(&self, vertex: u32) -> usize {
        self.fetches - self.fetched[vertex as usize]
    }

    /// Draws the triangles about a vertex.
    fn draw(
        &mut self,
        vertex: u32,
        triangles: &[IndexedTriangle],
        ordered: &mut Vec<IndexedTriangle>,
    ) {
        for place in self.starts[vertex as usize]..self.starts[vertex as usize + 1] {
            let number = self.triangles[place] as usize;
            if std::mem::replace(&mut self.is_drawn[number], true) {
                continue;
            }
            ordered.push(triangles[number]);
            for corner in triangles[number].indices {
                self.recent.push(corner);
                self.left[corner as usize] -= 1;
                if self.age(corner) >= vertex_cache::SLOTS {
                    self.fetches += 1;
                    self.fetched[corner as usize] = self.fetches;
                }
            }
        }
    }

    /// Chooses the next vertex among the vertices of `drawn` with triangles left: the oldest vertex
    /// that stays in the cache until its triangles are drawn or, if none stays, the first vertex.
    fn best(&self, drawn: &[IndexedTriangle]) -> Option<u32> {
        let mut best = None;
        for vertex in drawn.iter().flat_map(|triangle| triangle.indices) {
            let left = self.left[vertex as usize] as usize;
            if left == 0 {
                continue;
            }
            let age = self.age(vertex);
            let rank = if age + 2 * left < vertex_cache::SLOTS {
                age + 1
            } else {
                0
            };
            if best.is_none_or(|(highest, _)| rank > highest) {
                best = Some((rank, vertex));
            }
        }
        best.map(|(_, vertex)| vertex)
    }

    /// The most recently drawn vertex with triangles left; otherwise the first vertex with
    /// triangles left.
    fn after_dead_end(&mut self) -> Option<u32> {
        let is_left = |left: &[u32], vertex: u32| left[vertex as usize] > 0;
        while let Some(vertex) = self.recent.pop() {
            if is_left(&self.left, vertex) {
                return Some(vertex);
            }
        }
        while self.left.get(self.cursor) == Some(&0) {
            self.cursor += 1;
        }
        (self.cursor < self.left.len()).then_some(self.cursor as u32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grid of `side`² squares, row by row, each of two triangles. The colour of a triangle is
    /// its number.
    fn grid(side: u32) -> (Vec<Vertex>, Vec<IndexedTriangle>) {
        let row = side + 1;
        let triangles = (0..side * side).flat_map(|square| {
            let corner = square / side * row + square % side;
            [
                [corner, corner + 1, corner + row],
                [corner + 1, corner + row + 1, corner + row],
            ]
        });
        let triangle = |(number, indices): (u16, [u32; 3])| IndexedTriangle {
            indices,
            colour: mesh::Rgb565(number),
            ..IndexedTriangle::default()
        };
        let triangles = (0..).zip(triangles).map(triangle).collect();
        (vec![Vertex::default(); (row * row) as usize], triangles)
    }

    #[test]
    fn a_grid_wider_than_the_cache_is_fetched_once() {
        // A row has more vertices than the cache, so in row order every inner vertex is fetched twice.
        let (vertices, mut triangles) = grid(150);
        triangles.sort_by_key(|triangle| triangle.indices[0] % 151);
        triangles.sort_by_key(|triangle| triangle.colour.0 % 7);
        let before = Encoded::new(&vertices, &triangles, &Extra::default())
            .unwrap()
            .fetches;
        let ordered = for_cache(vertices.len(), &triangles);
        let after = Encoded::new(&vertices, &ordered, &Extra::default())
            .unwrap()
            .fetches;
        let count = vertices.len() as u32;
        assert!(
            before > 3 * count && after < count + count / 50,
            "{before} {after} of {count}"
        );
    }

    #[test]
    fn every_triangle_comes_once_and_equal_ones_in_order() {
        let (vertices, mut triangles) = grid(30);
        let again: Vec<_> = triangles.iter().step_by(3).copied().collect();
        triangles.extend(again.into_iter().map(|triangle| IndexedTriangle {
            colour: mesh::Rgb565(triangle.colour.0 + 2000),
            ..triangle
        }));
        let ordered = for_cache(vertices.len(), &triangles);
        let mut later = std::collections::HashSet::new();
        for triangle in &ordered {
            assert!(triangle.colour.0 >= 2000 || !later.contains(&triangle.indices));
            later.insert(triangle.indices);
        }
        let sorted = |mut triangles: Vec<IndexedTriangle>| {
            triangles.sort_by_key(|triangle| triangle.colour.0);
            triangles
        };
        assert_eq!(sorted(ordered), sorted(triangles));
    }
}
