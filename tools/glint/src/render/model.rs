//! The bit-exact model as a renderer, in this process and without a board.

use super::renderer::{Error, Parts, Rendered, Renderer};
use crate::picture::Image;
use crate::transfer::Progress;
use glint_model::{Frame, FrameBuffer, Projected};

/// Renders with the bit-exact model in this process, without a board.
#[derive(Clone, Copy, Debug, Default)]
pub struct ModelRenderer;

impl Renderer for ModelRenderer {
    fn render(&mut self, frame: &Frame, _: Parts, _: &mut Progress) -> Result<Rendered, Error> {
        on_model(frame)
    }
}

/// Draws a frame with the bit-exact model.
///
/// # Errors
/// The eye is too far from the origin for a mesh, or a mesh in a field is requested for two eyes.
pub fn on_model(frame: &Frame) -> Result<Rendered, Error> {
    let ([width, height], pixels) = (frame.size.pixels(), frame.size.pixel_count());
    let mut image = Image {
        width,
        height,
        colour: vec![0; pixels],
        depth: vec![0; pixels],
    };
    let mut buffer = FrameBuffer {
        width,
        height,
        colour: &mut image.colour,
        depth: &mut image.depth,
    };
    let mut scratch = vec![Projected::Behind; frame.scratch_vertices()];
    let stats = frame
        .constants()
        .and_then(|constants| frame.draw(&constants, &mut buffer, &mut scratch, &mut || {}))
        .map_err(Error::Render)?;
    Ok(Rendered {
        image,
        stats: stats.into(),
    })
}

#[cfg(test)]
mod tests {
    use super::on_model;
    use crate::render::Rendered;
    use crate::{convert, generate, view};
    use glint_core::mesh::Mesh;
    use glint_core::picture::Size;
    use glint_model::{Frame, Subject};

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
}
