//! What commands do to the picture, and what their pictures need: blocks of the gateware, and meshes.

use super::command::Command;
use super::object::ObjectAction;
use super::values::{GestureAction, ImuAction};
use crate::block::Block;

/// Effect of a command on the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// Nothing: it shows or measures something, or sets what does not belong to a scene.
    None,
    /// It sets the picture, or what moves the camera. The lines of a scene are such commands.
    Picture,
    /// It changes the uploads.
    Uploads,
}

impl<'a> Command<'a> {
    /// Effect of the command on the picture.
    pub const fn effect(&self) -> Effect {
        match self {
            Self::Load { .. }
            | Self::Unload { .. }
            | Self::Program { upload: Some(_) }
            | Self::Replay { upload: Some(_) } => Effect::Uploads,
            Self::Scene { name: Some(_) }
            | Self::Program { upload: None }
            | Self::Press { .. }
            | Self::Field { field: Some(_) }
            | Self::Mesh { on: Some(_) }
            | Self::Stereo { eyes: Some(_) }
            | Self::Object {
                action:
                    Some(
                        ObjectAction::Show
                        | ObjectAction::Add { .. }
                        | ObjectAction::Change { .. }
                        | ObjectAction::Remove(_),
                    ),
            }
            | Self::Material { material: Some(_) }
            | Self::Light { light: Some(_) }
            | Self::Ambient { colour: Some(_) }
            | Self::Background {
                background: Some(_),
            }
            | Self::Fog { density: Some(_) }
            | Self::Occlusion { on: Some(_) }
            | Self::Undecided { on: Some(_) }
            | Self::Camera { .. }
            | Self::View { view: Some(_) }
            | Self::Look { .. }
            | Self::LookAt { .. }
            | Self::FieldOfView { .. }
            | Self::Orthographic { .. }
            | Self::Zoom { .. }
            | Self::Fit { .. }
            | Self::Orbit { .. }
            | Self::Imu {
                action: Some(ImuAction::Follow(_) | ImuAction::Recentre),
            }
            | Self::Mounting { mounting: Some(_) }
            | Self::Sensitivity { gain: Some(_) }
            | Self::Gesture {
                action:
                    Some(
                        GestureAction::On
                        | GestureAction::Vga
                        | GestureAction::Off
                        | GestureAction::Mark
                        | GestureAction::Unmark,
                    ),
            }
            | Self::Quality { quality: Some(_) }
            | Self::Size { .. }
            | Self::Backend { backend: Some(_) }
            | Self::Shading { shading: Some(_) }
            | Self::Cull { .. }
            | Self::Clip { .. }
            | Self::Winding { .. }
            | Self::Edges { edges: Some(_) }
            | Self::Prepass { .. } => Effect::Picture,
            _ => Effect::None,
        }
    }

    /// The optional blocks of the gateware, other than scan-out, that the command needs.
    pub const fn blocks(&self) -> &'static [Block] {
        match self {
            Self::Scene { name: Some(_) }
            | Self::Object {
                action: Some(ObjectAction::Show | ObjectAction::Add { .. }),
            } => &[Block::Triangle],
            Self::Program { .. }
            | Self::Edges {
                edges: Some(Some(_)),
            } => &[Block::Triangle, Block::Line],
            Self::Field {
                field: Some(Some(_)),
            } => &[Block::Raymarch],
            Self::Gesture {
                action: Some(GestureAction::On | GestureAction::Vga),
            } => &[Block::Gesture],
            _ => &[],
        }
    }

    /// Name of the mesh that the command shows as a line of a scene, where the command `scene` shows meshes alone.
    pub const fn mesh(&self) -> Option<&'a str> {
        match self {
            Self::Scene { name: Some(mesh) }
            | Self::Object {
                action: Some(ObjectAction::Add { mesh, .. }),
            } => Some(mesh),
            _ => None,
        }
    }
}
