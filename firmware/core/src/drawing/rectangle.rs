//! Rectangles of the screen that show parts of textures: sprites, and characters of a font (docs/textures.md, "Rectangles").

use crate::colour::Rgb565;
use crate::texture::Texture;

/// A rectangle of the screen that shows a part of a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rectangle<'a> {
    /// The texture, whose filter, transparent texels and blending apply.
    pub texture: Texture<'a>,
    /// Column and row of the upper left pixel. The rectangle may be partly or wholly outside of the picture.
    pub place: [i16; 2],
    /// Width and height in pixels. A rectangle without pixels is not drawn.
    pub size: [u16; 2],
    /// The part of the texture. A rectangle whose part is not in its texture is not drawn.
    pub part: Part,
    /// Whether the part is flipped horizontally, and whether it is flipped vertically.
    pub is_mirrored: [bool; 2],
    /// Colour by which the texels are multiplied. White leaves the texels unchanged.
    pub colour: Rgb565,
}

/// A part of a texture, in texels of its largest level.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part {
    /// Column and row of the upper left texel.
    pub place: [u16; 2],
    /// Width and height in texels.
    pub size: [u16; 2],
}

impl<'a> Rectangle<'a> {
    /// Makes a rectangle that shows a part of a texture with one pixel per texel.
    pub const fn new(texture: Texture<'a>, part: Part, place: [i16; 2]) -> Self {
        Self {
            texture,
            place,
            size: part.size,
            part,
            is_mirrored: [false; 2],
            colour: Rgb565::WHITE,
        }
    }
}
