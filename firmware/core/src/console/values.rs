//! Types of arguments: numbers, angles, colours, fields and values of several words.
//!
//! The parsers of numbers and fields are not inlined, so that all commands share one copy. A smaller firmware is loaded faster.

use core::fmt::{self, Display};

use super::argument::{Argument, Reader, WordArgument, group};
use super::error::ValueError;
use super::syntax::{NameList, Parameter, Shape, WordKind};
use crate::calibration::{MOST_SAMPLES, SAMPLES};
use crate::camera::{self, Lens, Projection};
use crate::choice::choices;
use crate::field::{self, KINDS};
use crate::fixed::{Q2_23, Q4_28, Q32_32, Turns, U4_28, U8_28, parse_i32};
use crate::imu::Follow;
use crate::light::{self, Background, HIGHLIGHT_FORM, Highlight, Rgb, parse_rgb};
use crate::matrix::Axis;
use crate::mesh::{self, MAX_BYTES};
use crate::picture;
use crate::steering::{self, Direction, SENSITIVITY};
use crate::stereo;
use crate::wire::Manifest;

/// A name; accepts any word.
pub struct Name;

impl WordArgument for Name {
    type Value<'a> = &'a str;
    const KIND: WordKind = WordKind::Text(&"a name");

    fn parse(text: &str) -> Option<&str> {
        Some(text)
    }
}

/// The name of a mesh.
pub struct MeshName;

impl WordArgument for MeshName {
    type Value<'a> = &'a str;
    const KIND: WordKind = WordKind::Name(NameList::Meshes, &NAME_FORM);

    fn parse(text: &str) -> Option<&str> {
        Some(text).filter(|text| mesh::is_name(text))
    }
}

const NAME_FORM: &str = "a name of at most 24 visible characters of ASCII";

/// The name of an uploaded texture.
pub struct TextureName;

impl WordArgument for TextureName {
    type Value<'a> = &'a str;
    const KIND: WordKind = WordKind::Name(NameList::Textures, &NAME_FORM);

    fn parse(text: &str) -> Option<&str> {
        MeshName::parse(text)
    }
}

/// The name of an upload: a mesh, a texture or a program.
pub struct UploadName;

impl WordArgument for UploadName {
    type Value<'a> = &'a str;
    const KIND: WordKind = WordKind::Name(NameList::Uploads, &NAME_FORM);

    fn parse(text: &str) -> Option<&str> {
        MeshName::parse(text)
    }
}

/// The name of a scene or a mesh.
pub struct SceneName;

impl WordArgument for SceneName {
    type Value<'a> = &'a str;
    const KIND: WordKind = WordKind::Name(NameList::Scenes, &"a name");

    fn parse(text: &str) -> Option<&str> {
        Some(text)
    }
}

/// A decimal number.
impl WordArgument for Q32_32 {
    type Value<'a> = Self;
    const KIND: WordKind = WordKind::Text(&"a number");

    #[inline(never)]
    fn parse(text: &str) -> Option<Self> {
        text.parse().ok()
    }
}

/// A decimal number, rounded to the fixed-point format Q2.23.
impl WordArgument for Q2_23 {
    type Value<'a> = Self;
    const KIND: WordKind = WordKind::Text(&"a number from -2 to 2");

    #[inline(never)]
    fn parse(text: &str) -> Option<Self> {
        let number = parse_i32(text);
        number.filter(|number| (-2..2).contains(number))
    }
}

/// A decimal number, rounded to the fixed-point format U4.28.
impl WordArgument for U4_28 {
    type Value<'a> = Self;
    const KIND: WordKind = WordKind::Text(&"a number from 0 to below 16");

    #[inline(never)]
    fn parse(text: &str) -> Option<Self> {
        U8_28::parse(text)?.checked_to_num()
    }
}

/// A decimal number, rounded to the fixed-point format Q4.28.
impl WordArgument for Q4_28 {
    type Value<'a> = Self;
    const KIND: WordKind = WordKind::Text(&"a number from -8 to below 8");

    #[inline(never)]
    fn parse(text: &str) -> Option<Self> {
        parse_i32(text)
    }
}

/// A decimal number, rounded to the fixed-point format U8.28.
impl WordArgument for U8_28 {
    type Value<'a> = Self;
    const KIND: WordKind = WordKind::Text(&"a number from 0 to below 256");

    #[inline(never)]
    fn parse(text: &str) -> Option<Self> {
        let number = text.parse().ok();
        number.filter(|number| *number < 256)
    }
}

/// An angle in degrees.
impl WordArgument for Turns {
    type Value<'a> = Self;
    const KIND: WordKind = WordKind::Text(&"a number of degrees");

    #[inline(never)]
    fn parse(text: &str) -> Option<Self> {
        Q32_32::parse(text).map(Self::from_degrees)
    }
}

/// An angle from 0 to 180 degrees.
pub struct HalfTurn;

impl WordArgument for HalfTurn {
    type Value<'a> = Turns;
    const KIND: WordKind = WordKind::Text(&"a number of degrees from 0 to 180");

    fn parse(text: &str) -> Option<Turns> {
        let degrees = Q32_32::parse(text)?;
        let is_accepted = (0..=180).contains(&degrees);
        is_accepted.then(|| Turns::from_degrees(degrees))
    }
}

/// A whole number from `MIN` to `MAX`, decimal, or hexadecimal with `0x`.
pub struct Whole<const MAX: u32, const MIN: u32 = 0>;

impl<const MAX: u32, const MIN: u32> WordArgument for Whole<MAX, MIN> {
    type Value<'a> = u32;
    const KIND: WordKind = WordKind::Text(&Between(MIN, MAX));

    fn parse(text: &str) -> Option<u32> {
        whole(text).filter(|number| (MIN..=MAX).contains(number))
    }
}

/// A whole number from 0 to 65535.
impl WordArgument for u16 {
    type Value<'a> = Self;
    const KIND: WordKind = WordKind::Text(&Between(0, Self::MAX as u32));

    fn parse(text: &str) -> Option<Self> {
        whole(text)?.try_into().ok()
    }
}

struct Between(u32, u32);

impl Display for Between {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "a whole number from {} to {}", self.0, self.1)
    }
}

/// A number of up to 8 hexadecimal digits.
pub struct Hexadecimal;

impl WordArgument for Hexadecimal {
    type Value<'a> = u32;
    const KIND: WordKind = WordKind::Text(&"up to 8 hexadecimal digits");

    fn parse(text: &str) -> Option<u32> {
        digits(text.strip_prefix("0x").unwrap_or(text), 16)
    }
}

#[inline(never)]
fn whole(text: &str) -> Option<u32> {
    match text.strip_prefix("0x") {
        Some(text) => digits(text, 16),
        None => digits(text, 10),
    }
}

/// Parses a whole number in the base `radix` that consists of digits only, without a sign.
#[inline(never)]
fn digits(text: &str, radix: u32) -> Option<u32> {
    let digits = text.bytes().all(|byte| byte.is_ascii_hexdigit());
    u32::from_str_radix(text, radix).ok().filter(|_| digits)
}

/// A colour as six hexadecimal digits.
impl WordArgument for Rgb {
    type Value<'a> = Self;
    const KIND: WordKind = WordKind::Text(&"a colour RRGGBB");

    fn parse(text: &str) -> Option<Self> {
        parse_rgb(text)
    }
}

/// The text form of a highlight.
impl WordArgument for Highlight {
    type Value<'a> = Self;
    const KIND: WordKind = WordKind::Text(&HIGHLIGHT_FORM);

    fn parse(text: &str) -> Option<Self> {
        Self::parse(text)
    }
}

/// The text form of a background.
impl WordArgument for Background {
    type Value<'a> = Self;
    const KIND: WordKind = WordKind::Either(
        Self::WHITE,
        &WordKind::Either(Self::SKY, &WordKind::Either(Self::GRADIENT, &Rgb::KIND)),
    );

    fn parse(text: &str) -> Option<Self> {
        Self::parse(text)
    }
}

/// The text form of a distance field.
impl WordArgument for field::Field {
    type Value<'a> = Self;
    const KIND: WordKind = WordKind::Forms(&KINDS);

    #[inline(never)]
    fn parse(text: &str) -> Option<Self> {
        Self::parse(text).ok()
    }

    fn error(text: &str) -> Option<ValueError<'_>> {
        Self::parse(text).err().map(ValueError::Field)
    }
}

/// The text form of stereo settings.
impl WordArgument for stereo::Stereo {
    type Value<'a> = Self;
    const KIND: WordKind = WordKind::Text(&stereo::FORM);

    fn parse(text: &str) -> Option<Self> {
        Self::parse(text).ok()
    }

    fn error(text: &str) -> Option<ValueError<'_>> {
        Self::parse(text).err().map(ValueError::Stereo)
    }
}

/// The text form of a light.
impl WordArgument for light::Light {
    type Value<'a> = Self;
    const KIND: WordKind = WordKind::Text(&light::FORM);

    fn parse(text: &str) -> Option<Self> {
        Self::parse(text).ok()
    }

    fn error(text: &str) -> Option<ValueError<'_>> {
        Self::parse(text).err().map(ValueError::Light)
    }
}

/// The sensitivity of a camera that the sensor steers: the ratio (gain) of the camera's turns to the sensor's turns. On the
/// console the sensitivity is a decimal number; the stored value is in units of 1/256, rounded down.
pub struct Sensitivity;

impl WordArgument for Sensitivity {
    type Value<'a> = u16;
    const KIND: WordKind = U4_28::KIND;

    fn parse(text: &str) -> Option<u16> {
        // The number has 28 fraction bits: its upper 12 bits are in units of 1/256.
        let gain = (<U4_28 as WordArgument>::parse(text)?.to_bits() >> 20) as u16;
        (SENSITIVITY[0]..=SENSITIVITY[1])
            .contains(&gain)
            .then_some(gain)
    }

    fn error(text: &str) -> Option<ValueError<'_>> {
        <U4_28 as WordArgument>::parse(text).map(|_| ValueError::Sensitivity)
    }
}

group! {
    /// Length and checksum of an upload.
    Upload: Manifest = (bytes: Whole<MAX_BYTES>, crc32: Hexadecimal)
        => Ok::<_, ValueError>(Manifest { length: bytes, crc32 })
}

group! {
    /// Width and height of the picture.
    Size: picture::Size = (w: Whole<1280>, h: Whole<720>)
        => picture::Size::of(w, h).ok_or(ValueError::Size([w, h]))
}

group! {
    /// The kernel of the command `bench`, and an optional number of frames.
    Benchmark: (&'a str, Option<u32>) = (kernel: Name, frames: Option<Whole<100, 1>>)
        => Ok::<_, ValueError>((kernel, frames))
}

group! {
    /// A camera: eye, basis, half width, near plane, projection (by default perspective) and window.
    View: camera::View = (
        ex: Q32_32, ey: Q32_32, ez: Q32_32,
        ux: Q2_23, uy: Q2_23, uz: Q2_23,
        vx: Q2_23, vy: Q2_23, vz: Q2_23,
        nx: Q2_23, ny: Q2_23, nz: Q2_23,
        half_width: U8_28, near: U4_28, projection: Option<Projected>,
    ) => {
        let view = camera::View::new_checked([ex, ey, ez], [ux, uy, uz], [vx, vy, vz], [nx, ny, nz], half_width, near);
        let (projection, window) = projection.unwrap_or_default();
        let lens = window.map(|(half_height, middle)| {
            Lens::window(projection, [half_width, half_height], middle, near)
        });
        view.and_then(|view| match lens {
            Some(lens) => Ok(view.with_lens(lens?)),
            None => Ok(view.with_projection(projection)),
        })
        .map_err(ValueError::View)
    }
}

group! {
    /// A projection, and a window other than the centred one with square pixels.
    Projected: (Projection, Option<(U8_28, [Q32_32; 2])>) = (projection: Projection, window: Option<Window>)
        => Ok::<_, ValueError>((projection, window))
}

group! {
    /// Half height and middle of a window.
    Window: (U8_28, [Q32_32; 2]) = (half_height: U8_28, x: Q4_28, y: Q4_28)
        => Ok::<_, ValueError>((half_height, [x, y].map(Into::into)))
}

group! {
    /// A camera given by its eye and its direction of view, and by the direction up on the screen, by default z.
    LookAt: camera::View = (ex: Q32_32, ey: Q32_32, ez: Q32_32, gx: Q32_32, gy: Q32_32, gz: Q32_32, up: Option<Up>)
        => camera::View::towards([ex, ey, ez], [gx, gy, gz], up.unwrap_or(camera::UP)).map_err(ValueError::View)
}

group! {
    /// The direction that points up on the screen.
    Up: [Q32_32; 3] = (ux: Q32_32, uy: Q32_32, uz: Q32_32) => Ok::<_, ValueError>([ux, uy, uz])
}

/// A field of view in degrees.
pub struct FieldOfView;

impl WordArgument for FieldOfView {
    type Value<'a> = Turns;
    const KIND: WordKind = WordKind::Text(&"a number of degrees from 1 to 179");

    fn parse(text: &str) -> Option<Turns> {
        let degrees = Q32_32::parse(text)?;
        let is_accepted = (1..=179).contains(&degrees);
        is_accepted.then(|| Turns::from_degrees(degrees))
    }
}

group! {
    /// A horizontal and a vertical field of view; the default of the vertical field of view is that of square pixels.
    FieldsOfView: (Turns, Option<Turns>) = (x: FieldOfView, y: Option<FieldOfView>) => Ok::<_, ValueError>((x, y))
}

group! {
    /// The axis that is up on the screen, and a horizontal field of view.
    Fit: (Axis, Option<Turns>) = (up: Axis, angle: Option<FieldOfView>) => Ok::<_, ValueError>((up, angle))
}

group! {
    /// The mounting of the sensor: which of its directions points into the scene, and which points up on the screen.
    Mounting: steering::Mounting = (forward: Direction, up: Direction)
        => steering::Mounting::new(forward, up).ok_or(ValueError::Mounting)
}

/// An action of the command `imu`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImuAction {
    /// Measure the bias with this number of samples.
    Calibrate(u32),
    /// Print this number of samples; `None` prints samples until the next command.
    Stream(Option<u32>),
    /// Let the sensor steer the camera in this mode; `None` stops the steering.
    Follow(Option<Follow>),
    /// Turn the steered camera about the vertical axis, back to heading 0.
    Recentre,
}

/// The first word of an [`ImuAction`].
#[derive(Clone, Copy)]
enum Action {
    Calibrate,
    Stream,
    Look,
    Orbit,
    Off,
    Recentre,
}

choices!(Action {
    Calibrate: "calibrate",
    Stream: "stream",
    Look: "look",
    Orbit: "orbit",
    Off: "off",
    Recentre: "recentre",
});

impl ImuAction {
    const fn new(action: Action, samples: Option<u32>) -> Result<Self, ValueError<'static>> {
        Ok(match (action, samples) {
            (Action::Calibrate, None) => Self::Calibrate(SAMPLES),
            (Action::Calibrate, Some(samples)) => Self::Calibrate(samples),
            (Action::Stream, samples) => Self::Stream(samples),
            (_, Some(samples)) => {
                let action = action.name();
                return Err(ValueError::Samples { action, samples });
            }
            (Action::Look, None) => Self::Follow(Some(Follow::Look)),
            (Action::Orbit, None) => Self::Follow(Some(Follow::Orbit)),
            (Action::Off, None) => Self::Follow(None),
            (Action::Recentre, None) => Self::Recentre,
        })
    }
}

group! {
    /// The action of the command `imu`, and an optional number of samples.
    Imu: ImuAction = (action: Action, samples: Option<Whole<{ MOST_SAMPLES[1] }>>)
        => ImuAction::new(action, samples)
}

/// An action of the command `gesture`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GestureAction {
    /// Set up the image sensor for 320×240, and let the hand steer the camera.
    On,
    /// Set up the image sensor for 640×480, and let the hand steer the camera.
    Vga,
    /// Turn the image sensor off; the camera keeps its position.
    Off,
    /// Find the ranges of the hand's colour (calibrate).
    Calibrate,
    /// Send a small picture that marks the pixels of the hand's colour.
    Mask,
    /// Draw the position of the hand in a corner of the picture.
    Mark,
    /// Stop drawing the position of the hand.
    Unmark,
}

choices!(GestureAction {
    On: "on",
    Vga: "vga",
    Off: "off",
    Calibrate: "calibrate",
    Mask: "mask",
    Mark: "mark",
    Unmark: "unmark",
});

/// An action of the command `demo`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DemoAction {
    /// Start the demo with the first scene.
    On,
    /// Stop the demo; the current scene remains on the screen.
    Off,
    /// Show the next scene.
    Next,
    /// Show the previous scene.
    Previous,
    /// Keep the shown scene.
    Hold,
    /// Continue after `hold`.
    Run,
}

choices!(DemoAction {
    On: "on",
    Off: "off",
    Next: "next",
    Previous: "previous",
    Hold: "hold",
    Run: "run",
});
