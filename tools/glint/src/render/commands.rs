//! The console commands that make a board draw a frame.

use glint_core::appearance::Appearance;
use glint_core::camera::View;
use glint_core::choice::switch_name;
use glint_core::light::{Background, Hexadecimal, MeshLighting};
use glint_core::object::Place;
use glint_core::picture::{Edges, Size};
use glint_core::stereo::Stereo;
use glint_model::{Clip, FieldSubject, Frame, MeshSubject, Object};

/// The console commands that set the quality of a field's rays, if the frame has a field, and the size.
pub fn quality_commands(frame: &Frame) -> impl Iterator<Item = String> {
    let field = frame.subject.field_part();
    let quality = field.map(|field| format!("quality {}", field.quality));
    quality.into_iter().chain([size_command(frame.size)])
}

/// The console command that sets the picture's size.
pub fn size_command(size: Size) -> String {
    format!("size {} {}", size.width(), size.height())
}

/// The console commands that set the options of a mesh, and show its faces alone.
pub fn mesh_commands(subject: &MeshSubject) -> [String; 5] {
    [
        format!("cull {}", switch_name(subject.cull)),
        format!("shading {}", subject.shading),
        match subject.clip {
            Clip::Guard => "clip off".to_owned(),
            Clip::View { far } => format!("clip {far}"),
        },
        format!("winding {}", subject.winding),
        "edges off".to_owned(),
    ]
}

/// The console command that shows the edges of the mesh that is shown alone.
pub fn edges_command(edges: Edges) -> String {
    format!("edges {edges}")
}

/// The console command that adds an object with the mesh `name`. Its decimals are exact.
pub fn object_command(name: &str, object: &Object) -> String {
    let place = Place {
        matrix: *object.placement.matrix(),
        colour: object.colour,
    };
    format!("object add {name} {place}")
}

/// The console commands that set the lighting of meshes.
pub fn lighting_commands(lighting: &MeshLighting) -> Vec<String> {
    let mut commands = vec!["light default".to_owned()];
    if *lighting == MeshLighting::CAMERA {
        commands.push("ambient default".to_owned());
    } else {
        commands.push(format!("light {}", lighting.light));
        commands.push(format!("ambient {}", Hexadecimal(lighting.ambient)));
    }
    commands
}

/// The console command that sets the background.
pub fn background_command(background: Option<Background>) -> String {
    match background {
        Some(background) => format!("background {background}"),
        None => "background default".to_owned(),
    }
}

/// The console command that sets two eyes, or one.
pub fn stereo_command(stereo: Option<Stereo>) -> String {
    match stereo {
        Some(stereo) => format!("stereo {stereo}"),
        None => "stereo off".to_owned(),
    }
}

/// The console command that sets a view. Its decimals are exact, so that the board reads the same fixed-point numbers.
pub fn view_command(view: &View) -> String {
    format!("view {view}")
}

/// The console commands that set a field, alone or together with the mesh that the board has. Only the last command makes the
/// board draw a frame.
pub fn field_commands(subject: &FieldSubject, with_mesh: bool) -> Vec<String> {
    let Appearance {
        material,
        lights,
        ambient,
        background,
        fog,
        occlusion,
        undecided,
    } = subject.appearance;
    let ambient = ambient.map(|ambient| Hexadecimal(ambient).to_string());
    let mut commands = vec![
        // While the field is off, commands that change its options make the board draw no frame.
        "field off".to_owned(),
        format!("material {}", material.name()),
        "light default".to_owned(),
    ];
    commands.extend(lights.iter().map(|light| format!("light {light}")));
    commands.extend([
        format!("ambient {}", ambient.as_deref().unwrap_or("default")),
        background_command(*background),
        format!("fog {fog}"),
        format!("occlusion {}", switch_name(*occlusion)),
        format!("undecided {}", switch_name(*undecided)),
        format!("mesh {}", switch_name(with_mesh)),
        format!("prepass {}", switch_name(subject.prepass)),
    ]);
    commands.push(format!("field {}", subject.field));
    commands
}

#[cfg(test)]
mod tests {
    use super::view_command;
    use crate::view;
    use glint_core::camera::Projection;

    #[test]
    fn a_view_survives_the_console() {
        for projection in Projection::ALL {
            let view = view::spherical("3.3,33.3,66.6").unwrap();
            let view = view.with_projection(projection);
            let command = view_command(&view);
            assert!(command.len() < glint_core::console::LINE_MAX);
            let parsed = glint_core::console::Command::parse(&command).unwrap();
            let expected = glint_core::console::Setting::View { view };
            assert_eq!(parsed, Some(expected.into()));
        }
    }
}
