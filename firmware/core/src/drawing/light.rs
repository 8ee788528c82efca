//! Lights, and the lit colours of distance fields.
//!
//! Faces perpendicular to the axes have only six directions, so their six lit colours are computed once per frame, and no
//! lighting is computed per pixel. Spheres are lit per pixel, and meshes per triangle or vertex, in `glint-model` and in the
//! gateware. Light depends only on the angles between
//! the normal, the direction to the light and the direction to the camera, and on shadows.

use core::fmt;

use heapless::Vec;

use crate::camera::View;
use crate::choice::choices;
use crate::field::MAX_SPHERES;
use crate::fixed::Q32_32;
use crate::vector::unit;

/// Red, green and blue, 8 bits each.
pub type Rgb = [u8; 3];

/// Largest number of lights.
pub const MAX_LIGHTS: usize = 4;

/// Text form of a light.
pub const FORM: &str = "X,Y,Z[,RRGGBB] or camera[,RRGGBB]";

/// The first word of the text form of a light at the camera.
const CAMERA: &str = "camera";

/// 1 in the format of a direction, s1.14.
const ONE: i32 = 1 << 14;

/// A light at infinite distance, in a fixed direction or behind the camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Light {
    /// Direction to the light as entered, of any length; `None` for a light at the camera.
    towards: Option<[Q32_32; 3]>,
    /// Direction to the light, scaled to length 1: s1.14, rounded to nearest. The vector is 0 for a light at the camera before
    /// [`seen_from`](Self::seen_from).
    direction: [i16; 3],
    colour: Rgb,
}

impl Light {
    /// Makes a light from the direction to it, which has any length except 0, and its colour.
    ///
    /// # Errors
    /// All components of the direction are 0.
    pub fn new(towards: [Q32_32; 3], colour: Rgb) -> Result<Self, LightError<'static>> {
        let direction = unit::<14>(towards.map(Q32_32::to_bits)).ok_or(LightError::Nowhere)?;
        Ok(Self {
            towards: Some(towards),
            // A component is at most 2^14 in magnitude.
            direction: direction.map(|x| x as i16),
            colour,
        })
    }

    /// Makes a light at the camera: the direction to it is opposite to the camera's forward axis.
    pub const fn at_camera(colour: Rgb) -> Self {
        Self {
            towards: None,
            direction: [0; 3],
            colour,
        }
    }

    /// Whether the light is at the camera.
    pub const fn is_at_camera(&self) -> bool {
        self.towards.is_none()
    }

    /// Returns the light as seen from a camera: sets the direction of a light at the camera, and leaves other lights unchanged.
    #[must_use]
    pub fn seen_from(self, view: &View) -> Self {
        Self {
            direction: if self.is_at_camera() {
                back(view)
            } else {
                self.direction
            },
            ..self
        }
    }

    /// The direction to the light as a vector of length 1, s1.14; 0 for a light at the camera before
    /// [`seen_from`](Self::seen_from).
    pub const fn direction(&self) -> [i16; 3] {
        self.direction
    }

    /// The colour of the light: red, green and blue.
    pub const fn colour(&self) -> Rgb {
        self.colour
    }

    /// Parses the text form, such as `1,-2,3`, `0,0,1,ffc080` or `camera`: the direction to the light, of any length, or
    /// `camera`, then the colour, white by default.
    ///
    /// # Errors
    /// The text has another form, or the direction is 0.
    pub fn parse(text: &str) -> Result<Self, LightError<'_>> {
        let form = LightError::Form(text);
        let mut words = text.split(',');
        let mut direction = [Q32_32::ZERO; 3];
        let is_at_camera = words.clone().next() == Some(CAMERA);
        if is_at_camera {
            words.next();
        } else {
            for number in &mut direction {
                let word = words.next().ok_or(form)?;
                *number = Q32_32::from_str(word).map_err(|_| form)?;
            }
        }
        let colour = match words.next() {
            Some(word) => parse_rgb(word).ok_or(form)?,
            None => [0xFF; 3],
        };
        match words.next() {
            Some(_) => Err(form),
            None if is_at_camera => Ok(Self::at_camera(colour)),
            None => Self::new(direction, colour),
        }
    }
}

/// The direction opposite to a camera's forward axis, s1.14.
fn back(view: &View) -> [i16; 3] {
    view.n().map(|x| {
        let x = (-x.to_bits() + (1 << 8)) >> 9;
        // The length of the axis may exceed 1 by 10^−4.
        x.clamp(-ONE, ONE) as i16
    })
}

/// Writes the text form, with the colour.
impl fmt::Display for Light {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self.towards {
            Some([x, y, z]) => write!(f, "{x},{y},{z}")?,
            None => f.write_str(CAMERA)?,
        }
        write!(f, ",{}", HexColour(self.colour))
    }
}

/// Converts a fraction from units of 1/255 to units of 1/256, so that 1 becomes a power of two.
pub const fn whole(part: u8) -> i32 {
    part as i32 + (part >> 7) as i32
}

/// Displays a colour as the six hexadecimal digits that [`parse_rgb`] reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HexColour(pub Rgb);

impl fmt::Display for HexColour {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        self.0
            .iter()
            .try_for_each(|channel| write!(f, "{channel:02x}"))
    }
}

/// Parses a colour of six hexadecimal digits, two per channel; `None` for any other text.
pub fn parse_rgb(text: &str) -> Option<Rgb> {
    let digits = text.len() == 6 && text.bytes().all(|byte| byte.is_ascii_hexdigit());
    let number = u32::from_str_radix(text, 16).ok().filter(|_| digits)?;
    let [_, red, green, blue] = number.to_be_bytes();
    Some([red, green, blue])
}

/// Reason why a text is not the text form of a light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LightError<'a> {
    /// This text does not have the form that `FORM` states.
    Form(&'a str),
    /// All components of the direction are 0.
    Nowhere,
}

impl fmt::Display for LightError<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Form(text) => write!(f, "{text}: expected {FORM}"),
            Self::Nowhere => f.write_str("direction 0,0,0: expected a non-zero direction"),
        }
    }
}

impl core::error::Error for LightError<'_> {}

/// The lighting of a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Lighting {
    /// Ambient light, which all faces receive.
    pub ambient: Rgb,
    /// Lights in order; only the first light has shadows and a highlight.
    pub lights: Vec<Light, MAX_LIGHTS>,
    /// Highlight of the first light.
    pub highlight: Option<Highlight>,
    /// Direction halfway between the directions to the first light and to the camera, s1.14, of length 1; 0 if they are opposite, and before
    /// [`seen_from`](Self::seen_from).
    pub half: [i16; 3],
}

impl Lighting {
    /// Full ambient light and no lights: surfaces have the colours of their material.
    pub const PLAIN: Self = Self {
        ambient: [0xFF; 3],
        lights: Vec::new(),
        highlight: None,
        half: [0; 3],
    };

    /// Default ambient light of a scene with lights set by the user.
    pub const AMBIENT: Rgb = [0x40; 3];

    /// Returns the default lighting of all materials except `Normal`: a sun and a sky, whose directions give each face a
    /// different brightness.
    pub fn day() -> Self {
        let sun = Light {
            towards: Some([3, -5, 8].map(Q32_32::from_num)),
            direction: [4_965, -8_275, 13_240],
            colour: [0xFF, 0xF4, 0xE0],
        };
        let sky = Light {
            towards: Some([-2, 1, 2].map(Q32_32::from_num)),
            direction: [-10_923, 5_461, 10_923],
            colour: [0x30, 0x38, 0x48],
        };
        Self {
            ambient: Self::AMBIENT,
            lights: Vec::from_array([sun, sky]),
            ..Self::PLAIN
        }
    }

    /// Returns the lighting as seen from a camera: sets the directions of the highlight and of lights at
    /// the camera.
    #[must_use]
    pub fn seen_from(mut self, view: &View) -> Self {
        for light in &mut self.lights {
            *light = light.seen_from(view);
        }
        if let (Some(_), Some(first)) = (self.highlight, self.lights.first()) {
            let back = back(view);
            let sum = core::array::from_fn(|i| i64::from(first.direction[i]) + i64::from(back[i]));
            self.half = unit::<14>(sum).map_or([0; 3], |half| half.map(|x| x as i16));
        }
        self
    }

    /// Computes the lit colours of six faces, perpendicular to the axes, from their colours c in full light. Each channel is
    /// c·min(1, ambient + Σ max(0, n·l)·light), where 255 stands for 1, n is the face's normal and l the direction to a light.
    /// Only the directions and the result are rounded (to nearest).
    pub fn shine_on(&self, faces: &[Rgb; 6]) -> [Rgb; 6] {
        core::array::from_fn(|face| {
            self.lit(faces[face], |direction| {
                let along = i32::from(direction[face / 2]);
                // The faces are in the order −x, x, −y, y, −z, z, so faces with odd numbers have normals in the positive
                // direction.
                if face % 2 == 1 { along } else { -along }
            })
        })
    }

    /// Computes the shadowed colours of the faces perpendicular to x, y and z that face the first light.
    pub fn shadows(&self, faces: &[Rgb; 6]) -> [Rgb; 3] {
        let Some((first, rest)) = self.lights.split_first() else {
            return [[0; 3]; 3];
        };
        let others = Self {
            ambient: self.ambient,
            lights: rest.iter().copied().collect(),
            ..Self::PLAIN
        };
        let lit = others.shine_on(faces);
        core::array::from_fn(|axis| lit[2 * axis + usize::from(first.direction[axis] >= 0)])
    }

    /// Computes the lit colours of the eight faces perpendicular to the diagonals, from their colours in full light. Bit i of a
    /// face's number is set if component i of its normal is positive. The cosine n·l is rounded down.
    pub fn shine_on_octants(&self, faces: &[Rgb; 8]) -> [Rgb; 8] {
        // The magnitude of each component of a face's normal: 1/√3 with 14 fraction bits.
        const PART: i32 = 9_459;
        core::array::from_fn(|face| {
            self.lit(faces[face], |direction| {
                let along = |i: usize| {
                    let part = i32::from(direction[i]);
                    if face >> i & 1 == 1 { part } else { -part }
                };
                ((along(0) + along(1) + along(2)) * PART) >> 14
            })
        })
    }

    /// Computes the lit colour of a face, from its colour in full light and the cosine between its normal and a direction. Cosines have
    /// 14 fraction bits.
    fn lit(&self, colour: Rgb, cosine: impl Fn(&[i16; 3]) -> i32) -> Rgb {
        let highlight = self.highlight.zip(self.lights.first());
        let highlight = highlight.map_or([0; 3], |(highlight, light)| {
            let share = whole(highlight_share(
                highlight.steepness(),
                cosine(&self.half) << 2,
            ));
            highlight
                .colour(light.colour)
                .map(|part| (i32::from(part) * share) >> 8)
        });
        core::array::from_fn(|channel| {
            let sum: i32 = self
                .lights
                .iter()
                .map(|light| cosine(&light.direction).max(0) * i32::from(light.colour[channel]))
                .sum();
            let light = (i32::from(self.ambient[channel]) * ONE + sum).min(255 * ONE);
            // The product is below 2^30.
            let lit = i32::from(colour[channel]) * light;
            let lit = (lit + 255 * ONE / 2) / (255 * ONE);
            (lit + highlight[channel]).min(255) as u8
        })
    }
}

/// Highlight of the first light on fields: the light's colour times STRENGTH·cos^EXPONENT of the angle between the normal and the
/// direction halfway to the light and to the camera (J. F. Blinn, "Models of light reflection for computer synthesized pictures", 1977).
/// Light and camera are far away, so the direction is a constant of the frame.
///
/// The power is replaced by max(0, 1 − k·(1 − cos))^4, as R. F. Lyon proposes ("Phong shading reformulation for hardware renderer
/// simplification", 1993). The steepness k = (54·EXPONENT + 40)/256 has the smallest errors: at most 0.037 of the strength,
/// with all roundings, and 0.006 for the exponent 4.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Highlight {
    /// The strength, in thousandths, at most 1000.
    strength: u16,
    /// The exponent, 4 to 128.
    exponent: u8,
}

/// Text form of a highlight.
pub const HIGHLIGHT_FORM: &str = "STRENGTH,EXPONENT: from 0 to 1, and a whole number from 4 to 128";

impl Highlight {
    /// Parses the text form, such as `0.6,32`: the strength, to three digits after the point, and the exponent. `None` for any other text.
    pub fn parse(text: &str) -> Option<Self> {
        let (strength, exponent) = text.split_once(',')?;
        let strength = Q32_32::from_str(strength).ok()?;
        // A number may begin with a sign.
        let is_digits = exponent.bytes().all(|byte| byte.is_ascii_digit());
        let exponent = exponent.parse().ok().filter(|_| is_digits)?;
        let is_valid =
            (Q32_32::ZERO..=Q32_32::ONE).contains(&strength) && (4..=128).contains(&exponent);
        is_valid.then(|| Self {
            strength: ((strength.to_bits() * 1_000 + (1 << 31)) >> 32) as u16,
            exponent,
        })
    }

    /// The steepness, u5.8.
    pub const fn steepness(self) -> u16 {
        54 * self.exponent as u16 + 40
    }

    /// The colour at the centre of the highlight, from the colour of the light, rounded to nearest.
    pub fn colour(self, light: Rgb) -> Rgb {
        light.map(|part| ((u32::from(part) * u32::from(self.strength) + 500) / 1_000) as u8)
    }
}

/// Brightness of a highlight relative to its strength, in units of 1/255, for a steepness in u5.8 and
/// a cosine with 16 fraction bits, at most 1. Each product is rounded down.
pub const fn highlight_share(steepness: u16, cosine: i32) -> u8 {
    const FULL: i32 = (1 << 16) - 1;
    let below = if cosine > FULL {
        0
    } else if cosine < 0 {
        FULL
    } else {
        FULL - cosine
    };
    let away = (below * steepness as i32) >> 8;
    let x = if away > FULL { 0 } else { (FULL - away) as u32 };
    let square = (x * x) >> 16;
    ((square * square) >> 24) as u8
}

/// Writes the text form.
impl fmt::Display for Highlight {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let [whole, thousandths] = [self.strength / 1_000, self.strength % 1_000];
        write!(f, "{whole}")?;
        let (mut digits, mut width) = (thousandths, 3);
        while width > 1 && digits % 10 == 0 {
            digits /= 10;
            width -= 1;
        }
        if thousandths != 0 {
            write!(f, ".{digits:0width$}")?;
        }
        write!(f, ",{}", self.exponent)
    }
}

/// The lighting of the meshes of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MeshLighting {
    /// Ambient light, which all faces receive.
    pub ambient: Rgb,
    /// The only light.
    pub light: Light,
}

impl MeshLighting {
    /// White light at the camera, and no ambient light.
    pub const CAMERA: Self = Self {
        ambient: [0; 3],
        light: Light::at_camera([0xFF; 3]),
    };
}

/// Material of a solid, which determines its colours.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Material {
    /// The colour depends on the normal.
    #[default]
    Normal,
    /// Successive spheres have the colours of the single-colour materials; faces have that of `Ivory`.
    Mixed,
    /// Reddish brown.
    Clay,
    /// Green.
    Jade,
    /// Light blue.
    Sky,
    /// Yellow.
    Gold,
    /// Nearly white.
    Ivory,
    /// Dark grey.
    Slate,
}

choices!(Material {
    Normal: "normal",
    Mixed: "mixed",
    Clay: "clay",
    Jade: "jade",
    Sky: "sky",
    Gold: "gold",
    Ivory: "ivory",
    Slate: "slate",
});

impl Material {
    /// The colours of the six faces in full light, by the direction of their normals: −x, x, −y, y, −z, z.
    pub const fn faces(self) -> [Rgb; 6] {
        match self {
            Self::Normal => [
                [40, 130, 130],
                [230, 130, 130],
                [130, 40, 130],
                [130, 230, 130],
                [130, 130, 40],
                [130, 130, 230],
            ],
            Self::Clay => [[196, 110, 78]; 6],
            Self::Jade => [[72, 168, 120]; 6],
            Self::Sky => [[120, 176, 230]; 6],
            Self::Gold => [[232, 184, 72]; 6],
            Self::Ivory | Self::Mixed => [[244, 238, 220]; 6],
            Self::Slate => [[104, 114, 128]; 6],
        }
    }

    /// The colours of the eight faces perpendicular to the diagonals, in full light. Bit i of a face's number is set if component
    /// i of its normal is positive.
    pub const fn octants(self) -> [Rgb; 8] {
        let mut colours = [self.faces()[0]; 8];
        if let Self::Normal = self {
            let mut face = 0;
            while face < colours.len() {
                let mut i = 0;
                while i < 3 {
                    // The colour of a face perpendicular to an axis is 130 − 90 or 130 + 100 in the channel of this axis, and 130
                    // in the two other channels. Each component of a diagonal normal is 1/√3 in magnitude, so each channel is 130
                    // − 90/√3 or 130 + 100/√3.
                    colours[face][i] = if face >> i & 1 == 1 { 188 } else { 78 };
                    i += 1;
                }
                face += 1;
            }
        }
        colours
    }

    /// The colours of the spheres in full light, by their numbers. With `Normal`, the colour of a sphere
    /// depends on the normal instead.
    pub const fn spheres(self) -> [Rgb; MAX_SPHERES] {
        let mut colours = [self.faces()[0]; MAX_SPHERES];
        if let Self::Mixed = self {
            let mut number = 0;
            while number < MAX_SPHERES {
                colours[number] = Self::ALL[2 + number % (Self::ALL.len() - 2)].faces()[0];
                number += 1;
            }
        }
        colours
    }

    /// The default lighting of the material. `Normal` needs no lights, because its colours already distinguish directions.
    pub fn light(self) -> Lighting {
        match self {
            Self::Normal => Lighting::PLAIN,
            Self::Mixed
            | Self::Clay
            | Self::Jade
            | Self::Sky
            | Self::Gold
            | Self::Ivory
            | Self::Slate => Lighting::day(),
        }
    }
}

/// Three colours behind meshes, with linear changes between them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Gradient {
    /// Colours at zenith, horizon and nadir, or at the top, in the middle and at the bottom of the picture.
    pub colours: [Rgb; 3],
    /// Whether the colours have fixed positions in the picture, independent of the camera.
    pub is_fixed: bool,
}

/// Background of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Background {
    /// White.
    White,
    /// A sky: blue above, pale at the horizon and below it; behind meshes darker towards the nadir.
    Sky,
    /// Greys, dark at the top of the picture and light at the bottom; behind a field, from zenith to horizon.
    Gradient,
    /// One colour.
    Colour(Rgb),
}

impl Background {
    /// Colour at the nadir of the sky behind meshes.
    const GROUND: Rgb = [98, 96, 92];
    /// Colour at the bottom of the gradient.
    const BOTTOM: Rgb = [168, 174, 182];

    /// Text form of [`Background::White`].
    pub const WHITE: &'static str = "white";
    /// Text form of [`Background::Sky`].
    pub const SKY: &'static str = "sky";
    /// Text form of [`Background::Gradient`].
    pub const GRADIENT: &'static str = "gradient";

    /// Parses `white`, `sky`, `gradient` or a colour RRGGBB; `None` for any other text.
    pub fn parse(text: &str) -> Option<Self> {
        match text {
            Self::WHITE => Some(Self::White),
            Self::SKY => Some(Self::Sky),
            Self::GRADIENT => Some(Self::Gradient),
            colour => parse_rgb(colour).map(Self::Colour),
        }
    }

    /// The colours behind meshes; `None` for a single colour.
    pub const fn gradient(self) -> Option<Gradient> {
        let (nadir, is_fixed) = match self {
            Self::Sky => (Self::GROUND, false),
            Self::Gradient => (Self::BOTTOM, true),
            Self::White | Self::Colour(_) => return None,
        };
        let [zenith, horizon] = self.colours();
        Some(Gradient {
            colours: [zenith, horizon, nadir],
            is_fixed,
        })
    }

    /// Two colours: the colour at the zenith, and the colour at and below the horizon.
    pub const fn colours(self) -> [Rgb; 2] {
        match self {
            Self::White => [[0xFF; 3]; 2],
            Self::Sky => [[64, 120, 216], [214, 228, 242]],
            Self::Gradient => [[36, 40, 48], [92, 98, 108]],
            Self::Colour(colour) => [colour; 2],
        }
    }
}

/// Writes the text form.
impl fmt::Display for Background {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match *self {
            Self::White => f.write_str(Self::WHITE),
            Self::Sky => f.write_str(Self::SKY),
            Self::Gradient => f.write_str(Self::GRADIENT),
            Self::Colour(colour) => HexColour(colour).fmt(f),
        }
    }
}
