//! Unique edges.

use glint_core::wireframe::unique_edges;
use proptest::prelude::*;
use std::collections::BTreeSet;

fn of_triangles(triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
    triangles
        .iter()
        .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
        .collect()
}

#[test]
fn closed_and_open_meshes() {
    // A tetrahedron has 6 edges, even without one of its faces; two triangles with one common edge have 5.
    let tetrahedron = [[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]];
    assert_eq!(unique_edges(&mut of_triangles(&tetrahedron)).len(), 6);
    assert_eq!(unique_edges(&mut of_triangles(&tetrahedron[1..])).len(), 6);
    assert_eq!(unique_edges(&mut of_triangles(&tetrahedron[2..])).len(), 5);
    // A triangle that uses a vertex twice has one edge, and a triangle that is a point has none.
    assert_eq!(unique_edges(&mut of_triangles(&[[7, 7, 3]])), [[3, 7]]);
    assert!(unique_edges(&mut of_triangles(&[[7; 3]])).is_empty());
    assert!(unique_edges::<u16>(&mut []).is_empty());
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn each_edge_once(mut edges in prop::collection::vec([0..12_u16, 0..12], 0..100)) {
        let expected: BTreeSet<_> = edges.iter().filter(|[a, b]| a != b).map(|&[a, b]| [a.min(b), a.max(b)]).collect();
        prop_assert!(unique_edges(&mut edges).iter().eq(&expected));
    }
}
