//! Effects of commands on the picture.

use super::command::{Command, Setting};
use super::object::ObjectAction;
use super::values::{GestureAction, ImuAction};

/// Effect of a command on the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// None: the command shows or measures something, or sets state outside the scene.
    None,
    /// The command changes the picture, or the source of camera motion. The lines of a scene are such commands.
    Picture,
    /// The command changes the uploads.
    Uploads,
}

impl Command<'_> {
    /// Effect of the command on the picture.
    pub const fn effect(&self) -> Effect {
        match self {
            Self::Set(setting) => setting.effect(),
            Self::Load { .. }
            | Self::Unload { .. }
            | Self::Program { upload: Some(_) }
            | Self::Replay { upload: Some(_) } => Effect::Uploads,
            Self::Scene { name: Some(_) }
            | Self::Program { upload: None }
            | Self::Press { .. }
            | Self::Orbit { .. }
            | Self::Mounting { mounting: Some(_) }
            | Self::Sensitivity { gain: Some(_) } => Effect::Picture,
            Self::Imu {
                action: Some(action),
            } => match action {
                ImuAction::Follow(_) | ImuAction::Recentre => Effect::Picture,
                ImuAction::Calibrate(_) | ImuAction::Stream(_) => Effect::None,
            },
            Self::Gesture {
                action: Some(action),
            } => match action {
                GestureAction::On
                | GestureAction::Vga
                | GestureAction::Off
                | GestureAction::Mark
                | GestureAction::Unmark => Effect::Picture,
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

impl Setting<'_> {
    /// All options affect the picture of a scene, except the text over the picture, which belongs to no scene.
    const fn effect(&self) -> Effect {
        if let Self::Overlay { .. }
        | Self::Object {
            action: ObjectAction::List,
        } = self
        {
            return Effect::None;
        }
        Effect::Picture
    }
}
