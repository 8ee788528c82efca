//! Errors of commands.

use core::fmt::{self, Display};

use glint_core::block::Block;
use glint_core::camera::ViewError;
use glint_core::console::{LINE_MAX, ParseError};
use glint_core::deviation::Deviation;
use glint_core::feature::{DEMO, Feature, GESTURE, IMU, REPLAY, UPLOAD, WIREFRAME};
use glint_core::flash::Kind;
use glint_core::gesture::ColourError;
use glint_core::orientation::log::LogError;
use glint_core::wire::Failure;
use glint_engines::gesture::SetUpError;
use glint_program::drawn::DrawError;
use glint_program::gateware::Fallback;
use glint_program::sensor::{CalibrationError, SensorError};
use glint_program::shapes::Shapes;
use glint_scene::{LineError, SettingError};

use crate::arena::MAX_UPLOADS;
use crate::models::{NameError, UploadError};
use crate::scenes::{BuiltIn, DEFAULT, SCENES};

/// Reason why a command failed. `Display` is the text after `error: `.
#[derive(Debug)]
pub enum CommandError<'l> {
    /// The line is not a command.
    Parse(ParseError<'l>),
    /// The build does not include a feature that the command needs.
    LeftOut(Feature),
    /// The line is longer than [`LINE_MAX`].
    Overlong,
    /// The camera is out of range.
    View(ViewError),
    /// `info` has no entry of this name.
    Key(&'l str),
    /// The name is not a mesh or a scene.
    Scene(&'l str),
    /// The scene, list or mesh of this name in the flash is damaged.
    Flash(&'l str, Deviation),
    /// The text of the scene of this name in the flash has an invalid line.
    Line(&'l str, LineError<'static>),
    /// A scene requires a mesh that the board does not have.
    NoMesh {
        /// Name of the scene.
        name: &'l str,
        /// Name of the mesh.
        mesh: &'l str,
    },
    /// The item of this kind and name in the flash, a mesh, a texture or a program, is refused.
    FlashItem(Kind, &'l str, UploadError),
    /// The gateware lacks these blocks, one bit each, which the scene of this name needs.
    Blocks(&'l str, u32),
    /// This build lacks parts of the firmware that this scene needs.
    Features(&'static BuiltIn),
    /// An option of the scene cannot be set.
    Setting(SettingError<'l>),
    /// `bench field` requires that a field is shown.
    NoField,
    /// `bench triangle` requires triangles, but a field is shown.
    FieldShown,
    /// The gateware cannot draw the frame.
    Engine(Fallback),
    /// An upload, or a mesh in the flash, is longer than the free memory.
    TooLong {
        /// Name of the upload command, or of the mesh in the flash.
        name: &'l str,
        /// Length of the data in bytes.
        bytes: usize,
        /// Size of the free memory in bytes.
        free: usize,
    },
    /// Nothing can be uploaded under this name.
    UploadName(&'l str, NameError),
    /// The upload of this name cannot be removed, because the object with this number, from 1, uses it;
    /// `None` if no upload has the name.
    Unload(&'l str, Option<u32>),
    /// A transfer failed.
    Transfer(Failure),
    /// The upload of a mesh or a texture is refused.
    Upload(UploadError),
    /// The upload of a wireframe program is refused.
    Program(UploadError),
    /// A key of the wireframe was pressed while no wireframe is shown.
    NoWireframe,
    /// A key would move the wireframe out of range.
    Reach,
    /// The last frame could not be drawn.
    Render(DrawError),
    /// No frame has been drawn yet.
    NoFrame,
    /// A picture with four samples per pixel has no depth codes.
    DepthsOfSamples,
    /// `bench` has no kernel with this name; the list contains the valid names.
    Kernel(&'l str, &'static [&'static str]),
    /// The number of self-tests that failed.
    SelfTest(u32),
    /// The calibration of the sensor failed.
    Calibration(CalibrationError),
    /// The sensor sends no samples.
    Sensor(SensorError),
    /// The SoC has no gesture engine.
    NoGesture,
    /// The image sensor is off.
    GestureOff,
    /// The image sensor cannot be set up.
    ImageSensor(SetUpError),
    /// The image sensor sent no whole frame in time.
    NoSensorFrame,
    /// The windows of the hand's colour were not found.
    HandColour(ColourError),
    /// The upload is not a log.
    Log(LogError),
    /// The demo is off.
    DemoOff,
    /// No log has been completely replayed since the last upload.
    NoReplay,
    /// Devices are unavailable because the build ids of firmware and gateware differ.
    Mismatch,
}

impl CommandError<'_> {
    /// The error number that the digits show if the demo cannot show a scene (docs/boards.md).
    pub const fn number(&self) -> u8 {
        match self {
            Self::Flash(..) => 2,
            Self::Scene(_) => 3,
            Self::NoMesh { .. }
            | Self::Setting(SettingError::Texture(_) | SettingError::Program(_))
            | Self::FlashItem(..)
            | Self::TooLong { .. }
            | Self::UploadName(..) => 4,
            Self::Blocks(..) => 5,
            Self::Features(_) | Self::LeftOut(_) => 6,
            Self::Line(..) => 7,
            Self::Parse(..)
            | Self::Overlong
            | Self::View(..)
            | Self::Key(..)
            | Self::Setting(..)
            | Self::NoField
            | Self::FieldShown
            | Self::Engine(..)
            | Self::Unload(..)
            | Self::Transfer(..)
            | Self::Upload(..)
            | Self::Program(..)
            | Self::NoWireframe
            | Self::Reach
            | Self::Render(..)
            | Self::NoFrame
            | Self::DepthsOfSamples
            | Self::Kernel(..)
            | Self::SelfTest(..)
            | Self::Calibration(..)
            | Self::Sensor(..)
            | Self::NoGesture
            | Self::GestureOff
            | Self::ImageSensor(..)
            | Self::NoSensorFrame
            | Self::HandColour(..)
            | Self::Log(..)
            | Self::DemoOff
            | Self::NoReplay
            | Self::Mismatch => 8,
        }
    }

    /// Whether the image sensor or the gesture engine is missing or failed, so that no hand moves the camera.
    pub const fn is_of_sensor(&self) -> bool {
        matches!(self, Self::ImageSensor(_) | Self::NoGesture)
    }
}

impl From<ViewError> for CommandError<'_> {
    fn from(error: ViewError) -> Self {
        Self::View(error)
    }
}

impl<'l> From<SettingError<'l>> for CommandError<'l> {
    fn from(error: SettingError<'l>) -> Self {
        Self::Setting(error)
    }
}

impl Display for CommandError<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Parse(error) => error.fmt(f),
            Self::LeftOut(feature) => feature.fmt(f),
            Self::Overlong => write!(f, "line: expected at most {LINE_MAX} bytes"),
            Self::View(error) => error.fmt(f),
            Self::Key(key) => write!(f, "info `{key}`: expected an entry, `info` lists them"),
            Self::Scene(name) => {
                write!(f, "scene `{name}`: expected")?;
                let scenes = SCENES.iter().map(|scene| scene.name);
                let mut names = Shapes::names().chain(scenes).chain([DEFAULT]);
                names.try_for_each(|name| write!(f, " {name} or"))?;
                f.write_str(" an uploaded mesh, `scene` lists them")
            }
            Self::Flash(name, error) => DEMO.when_built(|| write!(f, "{name}: {error}")),
            Self::Line(name, error) => DEMO.when_built(|| write!(f, "scene {name}: {error}")),
            Self::NoMesh { name, mesh } => write!(
                f,
                "scene {name}: no mesh `{mesh}`, expected a built-in mesh or a mesh of the flash"
            ),
            Self::FlashItem(kind, name, error) => DEMO.when_built(|| {
                write!(f, "{} {name} of the flash: {error}", kind.name())
            }),
            Self::Blocks(name, lacks) => {
                write!(f, "scene {name}: this gateware lacks")?;
                let mut lacks = Block::of_bits(*lacks);
                lacks.try_for_each(|block| write!(f, " {block}"))?;
                write!(f, ", expected a build by `cargo xtask gateware --scene {name}`")
            }
            Self::Features(built_in) => {
                let name = built_in.name;
                write!(f, "scene {name}: this firmware lacks")?;
                let mut lacks = built_in.lacks_features();
                lacks.try_for_each(|feature| write!(f, " {}", feature.name))?;
                write!(f, ", expected a build by `cargo xtask firmware --scene {name}`")
            }
            Self::Setting(error) => error.fmt(f),
            Self::NoField => {
                f.write_str("bench field: no field shown, expected `field FIELD` first")
            }
            Self::FieldShown => {
                f.write_str("bench triangle: field shown, expected `field off` first")
            }
            Self::Engine(error) => error.fmt(f),
            Self::TooLong { name, bytes, free } => write!(
                f,
                "{name} {bytes}: expected at most {free} bytes, the free memory; `unload NAME` frees the memory of an upload"
            ),
            Self::UploadName(name, error) => {
                write!(f, "upload `{name}`: ")?;
                match error {
                    NameError::Scene => f.write_str("the name of a scene, expected another name"),
                    NameError::Own => f.write_str("the keyword for a mesh's own textures, expected another name"),
                    NameError::OtherKind => DEMO.when_built(|| write!(
                        f,
                        "an upload of another kind has this name; `unload {name}` removes it"
                    )),
                    NameError::Full => write!(
                        f,
                        "{MAX_UPLOADS} uploads, expected at most {MAX_UPLOADS}; `unload NAME` removes one"
                    ),
                }
            }
            Self::Unload(name, None) => write!(
                f,
                "unload `{name}`: expected an upload, `models` lists them"
            ),
            Self::Unload(name, Some(number)) => write!(
                f,
                "unload `{name}`: {}",
                UploadError::Object(*number)
            ),
            Self::Transfer(error) => error.fmt(f),
            Self::Upload(error) => UPLOAD.when_built(|| write!(f, "load: refused, previous uploads kept: {error}")),
            Self::Program(error) => WIREFRAME.when_built(|| write!(f, "program: previous scene kept: {error}")),
            Self::NoWireframe => f.write_str(
                "press: no wireframe shown, expected `program` first",
            ),
            Self::Reach => {
                f.write_str("press: the key would move the wireframe more than 16 units from its start, expected another key")
            }
            Self::Render(error) => write!(f, "render: {error}"),
            Self::NoFrame => f.write_str("stats: no frame drawn, expected `render` first"),
            Self::DepthsOfSamples => {
                f.write_str("depth: no depth codes with several samples per pixel, expected `aa 1` first")
            }
            Self::Kernel(name, expected) => {
                write!(f, "bench `{name}`: expected one of")?;
                expected
                    .iter()
                    .try_for_each(|kernel| write!(f, " {kernel}"))
            }
            Self::SelfTest(failed) => write!(f, "selftest: {failed} failed, expected none"),
            Self::Calibration(error) => IMU.when_built(|| write!(f, "imu calibrate: {error}")),
            Self::Sensor(error) => IMU.when_built(|| write!(f, "imu: {error}")),
            Self::NoGesture => f.write_str("gesture: no gesture engine in this SoC"),
            Self::GestureOff => {
                f.write_str("gesture: the image sensor is off, expected `gesture on` first")
            }
            Self::ImageSensor(error) => GESTURE.when_built(|| write!(f, "gesture: {error}")),
            Self::NoSensorFrame => f.write_str(
                "gesture: no whole frame within 500 ms, `gesture` shows what the image sensor sends",
            ),
            Self::HandColour(error) => GESTURE.when_built(|| write!(f, "gesture calibrate: {error}")),
            Self::Log(error) => REPLAY.when_built(|| write!(f, "replay: {error}")),
            Self::DemoOff => f.write_str("demo: off, expected `demo on` first"),
            Self::NoReplay => {
                f.write_str("replay: no attitudes, expected an upload of a log first")
            }
            Self::Mismatch => f.write_str(
                "devices: build ids of firmware and gateware differ, expected matching gateware",
            ),
        }
    }
}
