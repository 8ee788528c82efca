//! The commands: what they are, and the table of their syntax.

use core::fmt;

use super::ParseError;
use super::error::Fault;
use super::grammar::Kind::{
    self, Basis, Choice, Degrees, HalfTurn, Hexadecimal, Length, Name, Number, Scale,
};
use super::grammar::{Argument, DEFAULT, OFF, Syntax, Value, Words};
use crate::calibration::{MOST_SAMPLES, SAMPLES};
use crate::camera::View;
use crate::colour::Shading;
use crate::field::Field;
use crate::fixed::{Q32_32, Turns, U4_28};
use crate::follow::{Direction, Mounting, SENSITIVITY};
use crate::imu::Follow;
use crate::light::{Background, Light, Material, Rgb};
use crate::mesh::MAX_BYTES;
use crate::picture::{Backend, Size};
use crate::stereo::Stereo;
use crate::wire::Manifest;

/// A command, parsed and checked as far as it can be without the machine.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(
    clippy::large_enum_variant,
    reason = "there is one command at a time, and nowhere to box it"
)]
pub enum Command<'a> {
    /// Nothing was typed.
    Empty,
    /// `help [COMMAND]`: write [`write_help`].
    Help(Option<&'a str>),
    /// `info [KEY]`; with a key only its line.
    Info(Option<&'a str>),
    /// `scene [NAME]`; without a name it lists the scenes.
    Scene(Option<&'a str>),
    /// `field [off|FIELD]`; without one it prints the present one, and `off` is none.
    Field(Option<Option<Field>>),
    /// `stereo [off|E,ZERO[,TINT]]`; without eyes it prints the present ones, and `off` is the camera's one.
    Stereo(Option<Option<Stereo>>),
    /// `mesh [on|off]`; without a choice it prints the present one.
    Mesh(Option<bool>),
    /// `material [NAME]`; without a name it prints the present one.
    Material(Option<Material>),
    /// `light [default|LIGHT]`; without one it prints them all, and `default` is none of one's own.
    Light(Option<Option<Light>>),
    /// `ambient [default|RRGGBB]`; without a colour it prints the present one, and `default` is none of one's own.
    Ambient(Option<Option<Rgb>>),
    /// `background [NAME]`; without a name it prints the present one.
    Background(Option<Background>),
    /// `fog [off|DENSITY]`; without one it prints the present one, and 0 is off.
    Fog(Option<U4_28>),
    /// `occlusion [on|off]`; without a choice it prints the present one.
    Occlusion(Option<bool>),
    /// `camera R THETA PHI`
    Camera {
        /// The distance from the origin.
        r: Q32_32,
        /// The azimuth.
        theta: Turns,
        /// The angle from the z axis, at most half a turn.
        phi: Turns,
    },
    /// `view [...]`; without numbers it prints the view.
    View(Option<View>),
    /// `look YAW PITCH ROLL`
    Look {
        /// To the right.
        yaw: Turns,
        /// Downwards.
        pitch: Turns,
        /// About the direction of view.
        roll: Turns,
    },
    /// `imu [ACTION [SAMPLES]]`; without an action it prints how the sensor is.
    Imu(Option<ImuAction>),
    /// `mounting [FORWARD UP]`; without directions it prints the present ones.
    Mounting(Option<Mounting>),
    /// `sensitivity [TIMES]`, in 1/256, rounded down; without a number it prints the present one.
    Sensitivity(Option<u16>),
    /// `replay [BYTES CRC32]`, at most [`MAX_BYTES`] bytes; without arguments it sends the attitudes of the last one.
    Replay(Option<Manifest>),
    /// `orbit [FRAMES]`
    Orbit {
        /// How many frames a turn has.
        frames: Option<u32>,
    },
    /// `size W H`
    Size(Size),
    /// `frame [depth]`
    Frame {
        /// Depth instead of colour.
        depth: bool,
    },
    /// `load BYTES CRC32`, at most [`MAX_BYTES`] bytes.
    Load(Manifest),
    /// `render [depth]`
    Render {
        /// With its depth codes in memory, which an engine leaves out unless told.
        depth: bool,
    },
    /// `cull on|off`
    Cull(bool),
    /// `prepass on|off`
    Prepass(bool),
    /// `stats [json]`
    Stats {
        /// As JSON.
        json: bool,
    },
    /// `backend [cpu|gateware]`; without one it prints the present one.
    Backend(Option<Backend>),
    /// `shading [flat|smooth]`; without one it prints the present one.
    Shading(Option<Shading>),
    /// `bench [KERNEL]`; without a name it runs all.
    Bench(Option<&'a str>),
    /// `selftest`
    SelfTest,
    /// `leds VALUE`
    Leds(u16),
    /// `buttons`
    Buttons,
    /// `reboot`
    Reboot,
}

/// What the sensor is to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImuAction {
    /// Find its bias in so many samples.
    Calibrate(u32),
    /// Print so many samples; for ever where there is no number.
    Stream(Option<u32>),
    /// Turn the camera as told, or no longer.
    Follow(Option<Follow>),
    /// Make where it points the middle.
    Recentre,
}

/// Makes a command of the values of its arguments; `None` when they are not those of its syntax, which a test excludes.
pub(super) type Build = for<'a> fn(&[Value<'a>]) -> Option<Result<Command<'a>, Fault<'a>>>;

/// The sensor's directions.
const DIRECTIONS: [&str; 6] = ["x", "-x", "y", "-y", "z", "-z"];

/// On or off.
const SWITCH: Argument = ("on|off", Choice(&["on", "off"]));

/// The length of an upload and its checksum.
const UPLOAD: [Argument; 2] = [("BYTES", Number(MAX_BYTES)), ("CRC32", Hexadecimal)];

/// Every command, in the order of the help.
static COMMANDS: [(Syntax, Build); 34] = [
    (
        Syntax::new("help", "lists the commands, or explains one").with_optional(&[("COMMAND", Kind::Command)]),
        |values| match *values {
            [] => accept(Command::Help(None)),
            [Value::Name(name)] => accept(Command::Help(Some(name))),
            _ => None,
        },
    ),
    (
        Syntax::new("info", "says what this machine is and what it holds, or one line of it").with_optional(&[("KEY", Name)]),
        |values| match *values {
            [] => accept(Command::Info(None)),
            [Value::Name(key)] => accept(Command::Info(Some(key))),
            _ => None,
        },
    ),
    (
        Syntax::new("scene", "lists the scenes, or shows one").with_optional(&[("NAME", Name)]),
        |values| match *values {
            [] => accept(Command::Scene(None)),
            [Value::Name(name)] => accept(Command::Scene(Some(name))),
            _ => None,
        },
    ),
    (
        Syntax::new("field", "says which distance field is shown, or shows one, or the mesh again")
            .with_optional(&[("off|FIELD", Kind::Field)]),
        |values| match *values {
            [] => accept(Command::Field(None)),
            [Value::Name(OFF)] => accept(Command::Field(Some(None))),
            [Value::Name(text)] => {
                Some(Field::parse(text).map(|field| Command::Field(Some(Some(field)))).map_err(Fault::Field))
            }
            _ => None,
        },
    ),
    (
        Syntax::new("stereo", "says with which two eyes a field is seen, or chooses them, or one")
            .with_optional(&[("off|EYES", Kind::Stereo)]),
        |values| match *values {
            [] => accept(Command::Stereo(None)),
            [Value::Name(OFF)] => accept(Command::Stereo(Some(None))),
            [Value::Name(text)] => {
                Some(Stereo::parse(text).map(|eyes| Command::Stereo(Some(Some(eyes)))).map_err(Fault::Stereo))
            }
            _ => None,
        },
    ),
    (
        Syntax::new("mesh", "says whether a field is drawn with the mesh in it, or chooses")
            .with_optional(&[SWITCH]),
        |values| match *values {
            [] => accept(Command::Mesh(None)),
            [Value::Choice(off)] => accept(Command::Mesh(Some(off == 0))),
            _ => None,
        },
    ),
    (
        Syntax::new("material", "says what a field is made of, or chooses; normal: each face in the colour of its normal")
            .with_optional(&[("MATERIAL", Choice(&Material::NAMES))]),
        |values| match *values {
            [] => accept(Command::Material(None)),
            [Value::Choice(choice)] => accept(Command::Material(Material::ALL.get(choice).copied())),
            _ => None,
        },
    ),
    (
        Syntax::new("light", "says which lights shine on a field, adds one by the direction to it, or goes back to the material's own")
            .with_optional(&[("default|LIGHT", Kind::Light)]),
        |values| match *values {
            [] => accept(Command::Light(None)),
            [Value::Name(DEFAULT)] => accept(Command::Light(Some(None))),
            [Value::Name(text)] => {
                Some(Light::parse(text).map(|light| Command::Light(Some(Some(light)))).map_err(Fault::Light))
            }
            _ => None,
        },
    ),
    (
        Syntax::new("ambient", "says which light comes from everywhere on a field, or chooses")
            .with_optional(&[("default|RRGGBB", Kind::Colour)]),
        |values| match *values {
            [] => accept(Command::Ambient(None)),
            [Value::Colour(colour)] => accept(Command::Ambient(Some(colour))),
            _ => None,
        },
    ),
    (
        Syntax::new("background", "says what is behind a field, or chooses")
            .with_optional(&[("BACKGROUND", Choice(&Background::NAMES))]),
        |values| match *values {
            [] => accept(Command::Background(None)),
            [Value::Choice(choice)] => accept(Command::Background(Background::ALL.get(choice).copied())),
            _ => None,
        },
    ),
    (
        Syntax::new("fog", "says how dense the fog in front of a field is, or chooses: e^-z of it is left z/DENSITY away")
            .with_optional(&[("off|DENSITY", Kind::Fog)]),
        |values| match *values {
            [] => accept(Command::Fog(None)),
            [Value::Scale(density)] => accept(Command::Fog(Some(density))),
            _ => None,
        },
    ),
    (
        Syntax::new("occlusion", "says whether narrow places of a field are darkened, or chooses")
            .with_optional(&[SWITCH]),
        |values| match *values {
            [] => accept(Command::Occlusion(None)),
            [Value::Choice(off)] => accept(Command::Occlusion(Some(off == 0))),
            _ => None,
        },
    ),
    (
        Syntax::new("camera", "looks at the origin from a distance of 2 to 5, by azimuth and angle from the z axis")
            .with(&[("R", Length), ("THETA", Degrees), ("PHI", HalfTurn)]),
        |values| match *values {
            [Value::Length(r), Value::Angle(theta), Value::Angle(phi)] => accept(Command::Camera { r, theta, phi }),
            _ => None,
        },
    ),
    (
        Syntax::new("view", "prints the camera, or sets it: the eye, the basis (right, down, forward), half width, near plane")
            .with_optional(&[
                ("EX", Length),
                ("EY", Length),
                ("EZ", Length),
                ("UX", Basis),
                ("UY", Basis),
                ("UZ", Basis),
                ("VX", Basis),
                ("VY", Basis),
                ("VZ", Basis),
                ("NX", Basis),
                ("NY", Basis),
                ("NZ", Basis),
                ("HALF_WIDTH", Scale),
                ("NEAR", Scale),
            ]),
        view,
    ),
    (
        Syntax::new("look", "turns the camera where it is: to the right, downwards, and about its direction")
            .with(&[("YAW", Degrees), ("PITCH", Degrees), ("ROLL", Degrees)]),
        |values| match *values {
            [Value::Angle(yaw), Value::Angle(pitch), Value::Angle(roll)] => accept(Command::Look { yaw, pitch, roll }),
            _ => None,
        },
    ),
    (
        Syntax::new("imu", "says how the sensor is, calibrates it while it is still, prints its samples, or lets the camera follow it")
            .with_optional(&[
                ("ACTION", Choice(&["calibrate", "stream", "look", "orbit", "off", "recentre"])),
                ("SAMPLES", Number(MOST_SAMPLES[1])),
            ])
            .with_spare(1),
        |values| {
            let action = match *values {
                [] => return accept(Command::Imu(None)),
                [Value::Choice(0)] => ImuAction::Calibrate(SAMPLES),
                [Value::Choice(0), Value::Number(samples)] => ImuAction::Calibrate(samples),
                [Value::Choice(1)] => ImuAction::Stream(None),
                [Value::Choice(1), Value::Number(samples)] => ImuAction::Stream(Some(samples)),
                [Value::Choice(2)] => ImuAction::Follow(Some(Follow::Look)),
                [Value::Choice(3)] => ImuAction::Follow(Some(Follow::Orbit)),
                [Value::Choice(4)] => ImuAction::Follow(None),
                [Value::Choice(5)] => ImuAction::Recentre,
                [Value::Choice(_), Value::Number(count)] => return Some(Err(Fault::Samples { count })),
                _ => return None,
            };
            accept(Command::Imu(Some(action)))
        },
    ),
    (
        Syntax::new("replay", "takes an upload of a log (binary) and makes attitudes of its samples, or downloads the last ones (binary)")
            .with_optional(&UPLOAD),
        |values| match *values {
            [] => accept(Command::Replay(None)),
            [Value::Number(length), Value::Number(crc32)] => accept(Command::Replay(Some(Manifest { length, crc32 }))),
            _ => None,
        },
    ),
    (
        Syntax::new("mounting", "says which directions of the sensor look into the scene and up on the screen, or chooses")
            .with_optional(&[("FORWARD", Choice(&DIRECTIONS)), ("UP", Choice(&DIRECTIONS))]),
        |values| match *values {
            [] => accept(Command::Mounting(None)),
            [Value::Choice(forward), Value::Choice(up)] => {
                let direction = |choice| DIRECTIONS.get(choice).copied().and_then(Direction::parse);
                let mounting = Mounting::new(direction(forward)?, direction(up)?);
                Some(mounting.map(|mounting| Command::Mounting(Some(mounting))).ok_or(Fault::Mounting))
            }
            _ => None,
        },
    ),
    (
        Syntax::new("sensitivity", "says how many times as far as the sensor the camera turns, or chooses: 0.125 to 8")
            .with_optional(&[("TIMES", Scale)]),
        |values| match *values {
            [] => accept(Command::Sensitivity(None)),
            [Value::Scale(times)] => {
                // 28 fraction bits; below 16, so 12 bits are left.
                let part = (times.to_bits() >> 20) as u16;
                let is_accepted = (SENSITIVITY[0]..=SENSITIVITY[1]).contains(&part);
                Some(is_accepted.then_some(Command::Sensitivity(Some(part))).ok_or(Fault::Sensitivity))
            }
            _ => None,
        },
    ),
    (
        Syntax::new("orbit", "goes once round the z axis, in so many frames").with_optional(&[("FRAMES", Number(MAX_ORBIT))]),
        |values| match *values {
            [] => accept(Command::Orbit { frames: None }),
            [Value::Number(frames)] => accept(Command::Orbit { frames: Some(frames) }),
            _ => None,
        },
    ),
    (
        Syntax::new("size", "sets the size of the picture: 320 180, 640 360 or 1280 720")
            .with(&[("W", Number(1280)), ("H", Number(720))]),
        |values| match *values {
            [Value::Number(width), Value::Number(height)] => {
                let size = Size::of(width, height);
                Some(size.map(Command::Size).ok_or(Fault::Size { width, height }))
            }
            _ => None,
        },
    ),
    (
        Syntax::new("frame", "downloads the last frame, its colours or its depth (binary)")
            .with_optional(&[("depth", Choice(&["depth"]))]),
        |values| accept(Command::Frame { depth: !values.is_empty() }),
    ),
    (
        Syntax::new("load", "takes an upload of a mesh (binary) and shows it")
            .with(&UPLOAD),
        |values| match *values {
            [Value::Number(length), Value::Number(crc32)] => accept(Command::Load(Manifest { length, crc32 })),
            _ => None,
        },
    ),
    (
        Syntax::new("render", "draws the picture again and says what it took; with its depth in memory, or without")
            .with_optional(&[("depth", Choice(&["depth"]))]),
        |values| accept(Command::Render { depth: !values.is_empty() }),
    ),
    (
        Syntax::new("prepass", "marches cones before the rays of a field, or only rays").with(&[SWITCH]),
        |values| match *values {
            [Value::Choice(off)] => accept(Command::Prepass(off == 0)),
            _ => None,
        },
    ),
    (
        Syntax::new("cull", "leaves back faces out, or draws them").with(&[SWITCH]),
        |values| match *values {
            [Value::Choice(off)] => accept(Command::Cull(off == 0)),
            _ => None,
        },
    ),
    (
        Syntax::new("stats", "says what the last frame took").with_optional(&[("json", Choice(&["json"]))]),
        |values| accept(Command::Stats { json: !values.is_empty() }),
    ),
    (
        Syntax::new("backend", "says who renders, or chooses").with_optional(&[("cpu|gateware", Choice(&["cpu", "gateware"]))]),
        |values| match *values {
            [] => accept(Command::Backend(None)),
            [Value::Choice(0)] => accept(Command::Backend(Some(Backend::Cpu))),
            [Value::Choice(_)] => accept(Command::Backend(Some(Backend::Gateware))),
            _ => None,
        },
    ),
    (
        Syntax::new("shading", "says where colours come from, or chooses: faces, or vertices")
            .with_optional(&[("flat|smooth", Choice(&["flat", "smooth"]))]),
        |values| match *values {
            [] => accept(Command::Shading(None)),
            [Value::Choice(0)] => accept(Command::Shading(Some(Shading::Flat))),
            [Value::Choice(_)] => accept(Command::Shading(Some(Shading::Smooth))),
            _ => None,
        },
    ),
    (
        Syntax::new("bench", "measures the kernels, or one").with_optional(&[("KERNEL", Name)]),
        |values| match *values {
            [] => accept(Command::Bench(None)),
            [Value::Name(name)] => accept(Command::Bench(Some(name))),
            _ => None,
        },
    ),
    (Syntax::new("selftest", "tests the machine"), |_| accept(Command::SelfTest)),
    (
        Syntax::new("leds", "sets the 16 LEDs").with(&[("VALUE", Number(u16::MAX as u32))]),
        |values| match *values {
            // The syntax keeps it within 16 bits.
            [Value::Number(value)] => accept(Command::Leds(value as u16)),
            _ => None,
        },
    ),
    (Syntax::new("buttons", "says which buttons and switches are on"), |_| accept(Command::Buttons)),
    (Syntax::new("reboot", "starts the machine again"), |_| accept(Command::Reboot)),
];

/// The most frames an orbit has.
const MAX_ORBIT: u32 = 3_600;

const fn accept<'a>(command: Command<'a>) -> Option<Result<Command<'a>, Fault<'a>>> {
    Some(Ok(command))
}

fn view<'a>(values: &[Value<'a>]) -> Option<Result<Command<'a>, Fault<'a>>> {
    use Value::{Basis as B, Length as L, Scale as S};
    Some(match *values {
        [] => Ok(Command::View(None)),
        #[rustfmt::skip]
        [L(ex), L(ey), L(ez), B(ux), B(uy), B(uz), B(vx), B(vy), B(vz), B(nx), B(ny), B(nz), S(half_width), S(near)] => {
            View::new_checked([ex, ey, ez], [ux, uy, uz], [vx, vy, vz], [nx, ny, nz], half_width, near)
                .map(|view| Command::View(Some(view)))
                .map_err(Fault::View)
        },
        _ => return None,
    })
}

impl<'a> Command<'a> {
    /// Parses a line: a command and its arguments, between blanks.
    ///
    /// # Errors
    /// What is wrong, where, and what was expected.
    pub fn parse(line: &'a str) -> Result<Self, ParseError<'a>> {
        let mut words = Words::new(line);
        let Some(word) = words.next() else {
            return Ok(Self::Empty);
        };
        let unknown = ParseError(Fault::Unknown { word });
        let (syntax, build) = find(word.text).ok_or(unknown)?;
        let values = syntax.parse(words)?;
        build(&values).ok_or(unknown)?.map_err(ParseError)
    }
}

/// The entry of a command in the table.
pub(super) fn find(name: &str) -> Option<&'static (Syntax, Build)> {
    COMMANDS.iter().find(|(syntax, _)| syntax.name == name)
}

/// Writes the help of one command or, when there is none of the name, the list of all.
///
/// # Errors
/// Those of the writer.
pub fn write_help(out: &mut dyn fmt::Write, command: Option<&str>) -> fmt::Result {
    match command.and_then(find) {
        Some((syntax, _)) => {
            writeln!(out, "{syntax}\n  {}", syntax.summary)?;
            syntax
                .arguments
                .iter()
                .try_for_each(|(name, kind)| writeln!(out, "  {name}: {kind}"))
        }
        None => {
            COMMANDS.iter().try_for_each(|(syntax, _)| {
                writeln!(out, "{:12}{}", syntax.name, syntax.summary)
            })?;
            writeln!(out, "`help COMMAND` says how one is used")
        }
    }
}
