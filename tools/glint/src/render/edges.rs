//! Wireframes of meshes over their pictures: each edge once, hidden by the depths of the faces.

use crate::picture::Image;
use glint_core::colour::Rgb565;
use glint_core::mesh::Mesh;
use glint_model::edges::{Biases, biases, edge};
use glint_model::{FrameBuffer, MeshSetup};
use std::collections::BTreeMap;

/// Colour of the edges: white.
const COLOUR: Rgb565 = Rgb565(0xFFFF);

/// How the edges of a mesh are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Wireframe {
    /// Edges alone, without those that faces hide
    Hidden,
    /// Edges over the shaded faces
    Over,
}

/// Counts of drawn edges.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EdgeCounts {
    /// Edges of the mesh with a part in the picture's volume.
    pub lines: u32,
    /// Pixels written.
    pub pixels: u64,
}

/// The edges of a mesh, as pairs of positions, each with the largest biases of the faces at it.
pub fn edges(mesh: &Mesh, setup: &MeshSetup, cull: bool) -> BTreeMap<[[i16; 3]; 2], Biases> {
    let mut edges = BTreeMap::new();
    for chunk in mesh.chunks() {
        let position = |i: u16| chunk.vertex(usize::from(i)).map(|vertex| vertex.position);
        for triangle in chunk.triangles() {
            let [Some(a), Some(b), Some(c)] = triangle.indices.map(position) else {
                continue;
            };
            let needed = biases(setup, [a, b, c], cull).unwrap_or_default();
            for [from, to] in [[a, b], [b, c], [c, a]] {
                let most: &mut Biases = edges.entry([from.min(to), from.max(to)]).or_default();
                *most = [most[0].max(needed[0]), most[1].max(needed[1])];
            }
        }
    }
    edges
}

/// Draws the edges of a mesh into its picture, which has depth codes. `Hidden` first takes all faces away, which leaves `clear`.
pub fn draw_edges(
    image: &mut Image,
    wireframe: Wireframe,
    clear: Rgb565,
    edges: &BTreeMap<[[i16; 3]; 2], Biases>,
    setup: &MeshSetup,
) -> EdgeCounts {
    if wireframe == Wireframe::Hidden {
        image.colour.fill(clear.0);
    }
    let mut target = FrameBuffer {
        width: image.width,
        height: image.height,
        colour: &mut image.colour,
        depth: &mut image.depth,
    };
    let mut counts = EdgeCounts::default();
    for (&ends, &biases) in edges {
        if let Some(line) = edge(setup, ends, COLOUR, biases) {
            counts.lines += 1;
            counts.pixels += u64::from(line.draw(&mut target));
        }
    }
    counts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::{Frame, Subject, on_model};
    use crate::{convert, generate, view};
    use glint_core::picture::Size;

    /// On a sphere, whose faces hide no edge of another front face, each edge of a front face has all its pixels, and edges of back
    /// faces alone have none, except at the silhouette. At vertices other faces hide up to 4 of 1,352 pixels.
    #[test]
    fn faces_hide_the_edges_behind_them_alone() {
        let model = generate::named("icosphere:6").unwrap();
        let (mesh, _) = convert::convert(&model, convert::Options::default()).unwrap();
        let mesh = Mesh::new_checked(&mesh).unwrap();
        for camera in ["2,30,60", "2.5,200,90", "4,77,10"] {
            for size in [Size::W320, Size::W1280] {
                let frame = Frame::new(Subject::mesh(mesh), view::spherical(camera).unwrap(), size);
                let constants = frame.constants().unwrap();
                let setup = constants.mesh().unwrap();
                let image = on_model(&frame).unwrap().image;
                let edges = edges(&mesh, setup, true);
                assert_eq!(edges.len(), 3 * 720 / 2);
                let (front, back): (BTreeMap<_, _>, BTreeMap<_, _>) =
                    edges.into_iter().partition(|(_, biases)| *biases != [0; 2]);
                let counts = [front, back].map(|edges| {
                    let mut everywhere = image.clone();
                    everywhere.depth.fill(0);
                    [image.clone(), everywhere].map(|mut image| {
                        draw_edges(&mut image, Wireframe::Over, Rgb565(0), &edges, setup).pixels
                    })
                });
                println!("{camera}, {size:?}: {counts:?}");
                let [front, back] = counts;
                assert!(200 * (front[1] - front[0]) <= front[1]);
                assert!(20 * back[0] <= back[1]);
            }
        }
    }
}
