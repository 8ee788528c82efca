//! Draws frames with the bit-exact model, in this process and without a board.

use super::rendered::{Error, Rendered};
use crate::picture::Image;
use glint_core::picture::Samples;
use glint_model::edges::EdgeList;
use glint_model::{Frame, FrameBuffer, FrameStats, Projected, RenderError, Subject};

/// Draws a frame with the bit-exact model.
///
/// # Errors
/// A [`RenderError`] for a frame beyond the limits of the model.
pub fn on_model(frame: &Frame) -> Result<Rendered, Error> {
    let (image, stats) = picture(frame).map_err(Error::Render)?;
    let stats = stats.into();
    Ok(Rendered { image, stats })
}

/// Renders a picture for one eye or for two eyes.
fn picture(frame: &Frame) -> Result<(Image, FrameStats), RenderError> {
    let Some(eyes) = frame.eyes()? else {
        return picture_of_one(frame);
    };
    let (mut image, left) = picture_of_one(&eyes.left)?;
    let (other, right) = picture_of_one(&eyes.right)?;
    let words = |image: &Image| -> Vec<u32> {
        let pairs = image.colour.as_chunks().0.iter();
        pairs
            .map(|&[a, b]| u32::from(a) | u32::from(b) << 16)
            .collect()
    };
    let mut composed = words(&image);
    eyes.compose(&mut composed, &words(&other), &mut || {});
    let pixels = composed
        .into_iter()
        .flat_map(|word| [word as u16, (word >> 16) as u16]);
    image.colour = pixels.collect();
    Ok((image, left + right))
}

/// Renders a frame for one eye.
pub(super) fn picture_of_one(frame: &Frame) -> Result<(Image, FrameStats), RenderError> {
    if frame.samples == Samples::One {
        return samples(frame);
    }
    let mut image = Image {
        colour: vec![0; frame.size.pixel_count()],
        ..Image::empty(frame.size)
    };
    let mut sum: Option<FrameStats> = None;
    for part in frame.parts() {
        let (drawn, stats) = samples(&part)?;
        part.average(&drawn.colour, &mut image.colour, &mut || {});
        sum = Some(sum.map_or(stats, |sum| sum + stats));
    }
    Ok((image, sum.unwrap_or_default()))
}

/// Renders the samples of a frame's window.
fn samples(frame: &Frame) -> Result<(Image, FrameStats), RenderError> {
    let size = frame.window().size;
    let pixels = size.pixel_count();
    let mut image = Image {
        colour: vec![0; pixels],
        depth: vec![0; pixels],
        ..Image::empty(size)
    };
    let buffer = &mut FrameBuffer {
        width: image.width,
        height: image.height,
        colour: &mut image.colour,
        depth: &mut image.depth,
        rounding: frame.rounding,
    };
    let scratch = &mut vec![Projected::Behind; frame.scratch_vertices()];
    let (constants, quiet) = (frame.constants()?, &mut || {});
    let mut stats = frame.draw(&constants, buffer, scratch, quiet)?;
    if let Subject::Edges(subject, _) = &frame.subject {
        let mut memory = vec![0; EdgeList::words(&subject.mesh)];
        let list = &mut EdgeList::new(&mut memory);
        frame.draw_edges(&constants, list, buffer, scratch, quiet, &mut stats)?;
    }
    Ok((image, stats))
}

#[cfg(test)]
mod tests {
    use super::on_model;
    use crate::render::Rendered;
    use crate::{convert, generate, view};
    use glint_core::colour::Rounding;
    use glint_core::mesh::Mesh;
    use glint_core::picture::{Edges, Size};
    use glint_model::edges::EdgeList;
    use glint_model::line::{LineDepth, Segment};
    use glint_model::{Frame, FrameBuffer, Projected, RenderError, Subject};

    #[test]
    fn the_cube_from_the_front() {
        let (mesh, _) = convert::convert(
            &generate::named("cube").unwrap(),
            convert::Options::default(),
        )
        .unwrap();
        let frame = Frame::new(
            Subject::mesh(Mesh::new_checked(&mesh).unwrap()),
            view::spherical("2.5,0,90").unwrap(),
            Size::W320,
        );
        let Rendered { image, stats } = on_model(&frame).unwrap();
        let triangles = stats.triangles();
        assert_eq!((triangles.triangles_in, triangles.triangles_drawn), (12, 2));
        // The front face is a square of half width 0.5 at depth 2. The picture's half width is 160 pixels, or 0.9 at depth 1, so
        // the face ends `half` pixels to the right of the picture's centre.
        let half = (160.0 * 0.25 / 0.9) as usize;
        let scale = frame.constants().unwrap().depth_scale().unwrap();
        let depth = |x: usize, y: usize| scale.distance(image.depth[y * 320 + x]);
        assert!((depth(160, 90).unwrap().to_num::<f64>() - 2.0).abs() < 1e-4);
        assert!(depth(160 + half - 1, 90).is_some() && depth(160 + half + 1, 90).is_none());
        assert_eq!(
            triangles.pixels_drawn.unwrap(),
            image.depth.iter().filter(|&&code| code > 0).count() as u64
        );
    }

    /// On a sphere, no face hides an edge of a front face. So all pixels of these edges are drawn,
    /// except up to 4 of 1,352 pixels that other faces hide at vertices. No pixels of edges between
    /// back faces are drawn, except at the silhouette.
    #[test]
    fn faces_hide_the_edges_behind_them_alone() {
        let model = generate::named("icosphere:6").unwrap();
        let (mesh, _) = convert::convert(&model, convert::Options::default()).unwrap();
        let mesh = Mesh::new_checked(&mesh).unwrap();
        let mut memory = vec![0; EdgeList::words(&mesh)];
        let mut list = EdgeList::new(&mut memory);
        for camera in ["2,30,60", "2.5,200,90", "4,77,10"] {
            for size in [Size::W320, Size::W1280] {
                let frame = Frame::new(Subject::mesh(mesh), view::spherical(camera).unwrap(), size);
                let constants = frame.constants().unwrap();
                let setup = constants.mesh().unwrap();
                let mut scratch = vec![Projected::Behind; frame.scratch_vertices()];
                // Edges of front faces, and edges between back faces, which have no depth bias.
                let mut segments = [const { Vec::new() }; 2];
                let mut put = |segment: &Segment| {
                    let is_back = segment.depth == LineDepth::Tested { bias: 0 };
                    segments[usize::from(is_back)].push(*segment);
                };
                let quiet = &mut || {};
                let counts = list.segments(&mesh, true, setup, &mut scratch, quiet, &mut put);
                assert_eq!(counts.unwrap().edges, 3 * 720 / 2);
                let image = on_model(&frame).unwrap().image;
                let counts = segments.map(|segments| {
                    let mut everywhere = image.clone();
                    everywhere.depth.fill(0);
                    [image.clone(), everywhere].map(|mut image| {
                        let mut target = FrameBuffer {
                            width: image.width,
                            height: image.height,
                            colour: &mut image.colour,
                            depth: &mut image.depth,
                            rounding: Rounding::Dithered,
                        };
                        let drawn = segments.iter().map(|segment| segment.draw(&mut target));
                        drawn.sum::<u32>()
                    })
                });
                println!("{camera}, {size:?}: {counts:?}");
                let [front, back] = counts;
                assert!(200 * (front[1] - front[0]) <= front[1]);
                assert!(20 * back[0] <= back[1]);
            }
        }
    }

    #[test]
    fn a_list_of_edges_needs_memory_for_all_of_them() {
        let model = generate::named("icosphere:2").unwrap();
        let (mesh, _) = convert::convert(&model, convert::Options::default()).unwrap();
        let mesh = Mesh::new_checked(&mesh).unwrap();
        // 80 triangles, and 120 edges in a table of 128 slots.
        let mut memory = vec![0; 3 * 80 + 4 * 128];
        assert_eq!(EdgeList::new(&mut memory).make(&mesh, &mut || {}), Ok(()));
        memory.pop();
        let refused = EdgeList::new(&mut memory).make(&mesh, &mut || {});
        assert_eq!(refused, Err(RenderError::Edges { triangles: 80 }));
    }

    /// Each depth of a frame of edges is the depth of a face, or of an edge in front of it; with
    /// hidden edges, all colours are black or white.
    #[test]
    fn edges_lie_over_the_faces() {
        let model = generate::named("sponge:1").unwrap();
        let (mesh, _) = convert::convert(&model, convert::Options::default()).unwrap();
        let subject = Subject::mesh(Mesh::new_checked(&mesh).unwrap());
        let faces = Frame::new(subject, view::spherical("2,30,60").unwrap(), Size::W320);
        let expected = on_model(&faces).unwrap().image;
        let [hidden, over] = Edges::ALL.map(|edges| {
            let subject = Subject::edges(*subject.mesh_part().unwrap(), edges);
            on_model(&Frame { subject, ..faces }).unwrap()
        });
        assert_eq!(hidden.stats, over.stats);
        assert!(hidden.image.depth == over.image.depth);
        let mut lines = 0;
        for (at, &depth) in expected.depth.iter().enumerate() {
            let is_line = hidden.image.colour[at] == 0xFFFF;
            assert!(is_line || hidden.image.colour[at] == 0);
            if is_line {
                assert!(hidden.image.depth[at] >= depth && over.image.colour[at] == 0xFFFF);
                lines += 1;
            } else {
                assert!(hidden.image.depth[at] == depth);
                assert!(over.image.colour[at] == expected.colour[at]);
            }
        }
        assert!(lines > 2000, "{lines}");
    }
}
