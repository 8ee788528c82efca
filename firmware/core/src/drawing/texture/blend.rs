//! Blending of a texture with the picture behind it (docs/formats/texture.md, "Blending").

use crate::colour::Rgb565;

/// How the colours of a texture are blended with the picture behind it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Blend {
    /// The texture replaces the picture.
    #[default]
    Opaque,
    /// The result is a weighted mean: the texture has this weight, and the picture has the rest.
    Share(Eighths),
    /// The colours of the texture are added to the picture.
    Additive,
}

/// A number of eighths, 1 to 7. Other modules take it from [`Blend::ALL`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Eighths(u8);

impl Blend {
    /// All rules, by their numbers in the header.
    pub const ALL: [Self; 9] = [
        Self::Opaque,
        Self::Share(Eighths(1)),
        Self::Share(Eighths(2)),
        Self::Share(Eighths(3)),
        Self::Share(Eighths(4)),
        Self::Share(Eighths(5)),
        Self::Share(Eighths(6)),
        Self::Share(Eighths(7)),
        Self::Additive,
    ];

    /// The number of this rule in the header.
    pub const fn number(self) -> u8 {
        match self {
            Self::Opaque => 0,
            Self::Share(Eighths(eighths)) => eighths,
            Self::Additive => 8,
        }
    }

    /// The colour of a pixel from the colour of the texture, `source`, and the colour behind it. Each channel of a blend with a share is
    /// rounded to nearest, a half upwards; each channel of a sum saturates.
    pub fn over(self, source: Rgb565, behind: Rgb565) -> Rgb565 {
        let mix = |source: u8, behind: u8, most: u8| match self {
            Self::Opaque => source,
            Self::Share(Eighths(eighths)) => {
                // At most 8·63 + 4.
                let [eighths, source, behind] = [eighths, source, behind].map(u16::from);
                ((source * eighths + behind * (8 - eighths) + 4) >> 3) as u8
            }
            Self::Additive => (source + behind).min(most),
        };
        let ([r, g, b], [red, green, blue]) = (source.channels(), behind.channels());
        let [r, g, b] = [mix(r, red, 31), mix(g, green, 63), mix(b, blue, 31)].map(u16::from);
        Rgb565(r << 11 | g << 5 | b)
    }
}
