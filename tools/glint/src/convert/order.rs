//! Order of a mesh's triangles for the engine's vertex cache.

use crate::error::FormatError;
use crate::formats::glm;
use glint_core::mesh::{self, IndexedTriangle, Vertex};
use glint_model::triangle::vertex_cache;
use std::collections::{HashMap, VecDeque};

/// A mesh in the board's memory layout, with the number of vertices that the engine fetches for it.
pub struct Encoded {
    /// The mesh.
    pub bytes: Vec<u8>,
    /// Number of fetches.
    pub fetches: u32,
}

impl Encoded {
    /// Encodes triangles in the order given, and in each chunk the vertices in the order of their first use.
    ///
    /// # Errors
    /// The mesh is too large.
    pub fn new(vertices: &[Vertex], triangles: &[IndexedTriangle]) -> Result<Self, FormatError> {
        let bytes = mesh::encode(vertices, triangles).map_err(|error| match error {
            mesh::EncodeError::TooLarge => FormatError::whole(
                format!("a mesh of at most {} bytes", mesh::MAX_BYTES),
                "more",
            ),
            other => FormatError::whole("a mesh", other.to_string()),
        })?;
        let fetches = vertex_cache::fetches(&glm::check(&bytes)?);
        Ok(Self { bytes, fetches })
    }
}

/// Returns the triangles in an order for which the engine fetches few vertices. Triangles with the same three indices keep their
/// order.
///
/// The vertices of a chunk are numbered in the order of their first use, so a new vertex replaces the oldest one in the
/// direct-mapped cache, as in a FIFO of as many places.
pub fn for_cache(vertices: usize, triangles: &[IndexedTriangle]) -> Vec<IndexedTriangle> {
    let indices: Vec<u32> = triangles.iter().flat_map(|t| t.indices).collect();
    let places = vertex_cache::SLOTS as u32;
    let ordered = meshopt::optimize_vertex_cache_fifo(&indices, vertices, places);
    let mut rest: HashMap<[u32; 3], VecDeque<&IndexedTriangle>> = HashMap::new();
    for triangle in triangles {
        rest.entry(triangle.indices)
            .or_default()
            .push_back(triangle);
    }
    let (ordered, _) = ordered.as_chunks();
    ordered
        .iter()
        .filter_map(|indices| rest.get_mut(indices)?.pop_front().copied())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grid of `side`² squares of two triangles, row by row. Each triangle has its number as colour.
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
        // A row has more vertices than the cache, so row by row every inner vertex is fetched twice.
        let (vertices, mut triangles) = grid(150);
        triangles.sort_by_key(|triangle| triangle.indices[0] % 151);
        triangles.sort_by_key(|triangle| triangle.colour.0 % 7);
        let before = Encoded::new(&vertices, &triangles).unwrap().fetches;
        let ordered = for_cache(vertices.len(), &triangles);
        let after = Encoded::new(&vertices, &ordered).unwrap().fetches;
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
