//! Unique edges of meshes.

/// Removes duplicates of undirected edges: sorts the edges in place, each with its smaller index first, and returns the slice of
/// the unique edges in increasing order. Edges from an index to itself are removed.
///
/// The list of a mesh has three edges for each triangle, or one edge for each corner of a polygon. An edge inside a closed mesh then occurs
/// twice, in both directions, and an edge on the border of an open mesh once. The function needs no memory besides the slice.
pub fn unique_edges<T: Copy + Ord>(edges: &mut [[T; 2]]) -> &mut [[T; 2]] {
    for edge in &mut *edges {
        edge.sort_unstable();
    }
    edges.sort_unstable();
    let mut count = 0;
    let mut last = None;
    for from in 0..edges.len() {
        let Some(&edge) = edges.get(from) else { break };
        let [a, b] = edge;
        if a == b || last == Some(edge) {
            continue;
        }
        last = Some(edge);
        if let Some(to) = edges.get_mut(count) {
            *to = edge;
            count += 1;
        }
    }
    edges.get_mut(..count).unwrap_or_default()
}
