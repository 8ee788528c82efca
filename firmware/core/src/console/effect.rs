//! Effects of commands on the picture.

use super::command::{Command, Setting};
use super::object::ObjectAction;
use super::program::ProgramAction;
use super::values::{GestureAction, ImuAction};

/// Effect of a command on the picture. A line of a scene is a command with one of the effects `Option`, `Subject`, `Wireframe` and
/// `Motion`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Effect<'c, 'a> {
    /// None: the command shows or measures something, or sets state outside the scene.
    None,
    /// The command sets an option of the scene.
    Option(&'c Setting<'a>),
    /// The command shows the mesh or the scene with this name.
    Subject(&'a str),
    /// The command shows the wireframe: the program with this name, or for `None` the program of the scene.
    Wireframe(Option<&'a str>),
    /// The command sets or starts the motion of the camera or the wireframe.
    Motion,
    /// The command changes the uploads.
    Uploads,
}

impl<'a> Command<'a> {
    /// Effect of the command on the picture.
    pub const fn effect(&self) -> Effect<'_, 'a> {
        match self {
            Self::Set(setting) => setting.effect(),
            Self::Load { .. }
            | Self::Unload { .. }
            | Self::Program {
                action: Some(ProgramAction::Upload { .. }),
            }
            | Self::Replay { upload: Some(_) } => Effect::Uploads,
            Self::Scene { name: Some(name) } => Effect::Subject(name),
            Self::Program {
                action: Some(ProgramAction::Show(name)),
            } => Effect::Wireframe(Some(name)),
            Self::Program { action: None } => Effect::Wireframe(None),
            Self::Press { .. }
            | Self::Orbit { .. }
            | Self::Mounting { mounting: Some(_) }
            | Self::Sensitivity { gain: Some(_) } => Effect::Motion,
            Self::Imu {
                action: Some(action),
            } => match action {
                ImuAction::Follow(_) | ImuAction::Recentre => Effect::Motion,
                ImuAction::Calibrate(_) | ImuAction::Stream(_) => Effect::None,
            },
            Self::Gesture {
                action: Some(action),
            } => match action {
                GestureAction::On
                | GestureAction::Vga
                | GestureAction::Off
                | GestureAction::Mark
                | GestureAction::Unmark => Effect::Motion,
                GestureAction::Calibrate | GestureAction::Mask => Effect::None,
            },
            Self::Show(_)
            | Self::Help { .. }
            | Self::Info { .. }
            | Self::SelfTest {}
            | Self::Echo { .. }
            | Self::Leds { .. }
            | Self::Buttons {}
            | Self::Reboot {}
            | Self::Scene { name: None }
            | Self::Models {}
            | Self::Demo { .. }
            | Self::Imu { action: None }
            | Self::Mounting { mounting: None }
            | Self::Sensitivity { gain: None }
            | Self::Replay { upload: None }
            | Self::Gesture { action: None }
            | Self::Render { .. }
            | Self::Frame { .. }
            | Self::Stats { .. }
            | Self::Bench { .. } => Effect::None,
        }
    }
}

impl<'a> Setting<'a> {
    /// Every setting changes an option of the scene, except `overlay`, which belongs to no scene, and `object list`.
    const fn effect(&self) -> Effect<'_, 'a> {
        if let Self::Overlay { .. }
        | Self::Object {
            action: ObjectAction::List,
        } = self
        {
            return Effect::None;
        }
        Effect::Option(self)
    }
}
