//! Frames of scene files.

use crate::convert::Options;
use crate::error::{FormatError, InputError};
use crate::model;
use glint_core::colour::Shading;
use glint_core::console::Setting;
use glint_core::mesh::Mesh;
use glint_core::picture::Size;
use glint_core::quality::Quality;
use glint_core::shape::{MAX_BYTES, Shape};
use glint_core::wireframe::{CUBE, Program};
use glint_model::Frame;
use glint_scene::{AnyBoard, Assets};
use glint_scene_file::SceneFile;
use std::fmt::Display;

/// The error for a scene that no board can draw, with the reason.
fn refuse(reason: impl Display) -> FormatError {
    FormatError::whole("a scene that boards can show", reason.to_string())
}

/// Settings that override those of a scene.
#[derive(Clone, Copy, Default)]
pub struct Changes {
    /// Shading of meshes.
    pub shading: Option<Shading>,
    /// Quality of the picture; also sets its size.
    pub quality: Option<Quality>,
    /// Size of the picture; overrides the size of the quality.
    pub size: Option<Size>,
}

/// Whether a shape that is built into the firmware has this name.
pub fn is_shape(name: &str) -> bool {
    Shape::NAMES.contains(&name)
}

/// The mesh of a scene by name: a shape that is built into the firmware, a file, or a generator.
///
/// # Errors
/// Those of [`model::load`].
pub fn mesh(name: &str) -> Result<Vec<u8>, InputError> {
    match Shape::ALL.into_iter().find(|shape| shape.name() == name) {
        Some(shape) => {
            let mut bytes = vec![0; MAX_BYTES];
            let length = shape.write(&mut bytes).unwrap_or(0);
            bytes.truncate(length);
            Ok(bytes)
        }
        None => Ok(model::load(name, Options::default())?.mesh),
    }
}

/// The wireframe program that is built into the firmware.
///
/// # Errors
/// None: the program is valid.
pub fn program() -> Result<Program<'static>, InputError> {
    let program = Program::new_checked(CUBE.as_flattened());
    program.map_err(|error| refuse(error).in_file("program"))
}

/// Calls `draw` with the frame of a scene after `changes`.
///
/// # Errors
/// A mesh cannot be read, or no board can draw the scene.
pub fn draw<T>(
    file: &SceneFile,
    changes: &Changes,
    draw: impl FnOnce(&Frame) -> T,
) -> Result<T, InputError> {
    let in_scene = |error: FormatError| error.in_file(file.name());
    let mut scene = file.scene().clone();
    scene.options.shading = changes.shading.unwrap_or(scene.options.shading);
    if let Some(quality) = changes.quality {
        let set = scene.apply(&Setting::Quality { quality }, &mut AnyBoard);
        set.map_err(|error| in_scene(refuse(error)))?;
    }
    scene.size = changes.size.unwrap_or(scene.size);
    let names = file.meshes();
    let bytes = names.iter().map(|name| mesh(name));
    let bytes = bytes.collect::<Result<Vec<_>, _>>()?;
    let meshes = bytes.iter().map(|bytes| Mesh::new_checked(bytes));
    let meshes = meshes.collect::<Result<Vec<_>, _>>();
    let meshes = meshes.map_err(|error| in_scene(refuse(error)))?;
    let objects: Vec<_> = (scene.objects.iter())
        .flat_map(|placed| {
            let known = names.iter().position(|known| *known == *placed.mesh);
            let mesh = known.and_then(|known| meshes.get(known));
            mesh.map(|mesh| scene.object(&placed.place, *mesh))
        })
        .collect();
    Ok(draw(&scene.frame(Assets {
        // A scene without objects has at most one mesh.
        mesh: meshes.first().copied(),
        objects: &objects,
        program: program()?,
    })))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render;
    use glint_scene_file::{NAMES, built_in};

    #[test]
    fn every_scene_has_its_content() {
        let stats = |name: &str| {
            let scene = built_in(name).unwrap();
            let changes = Changes {
                size: Some(Size::W320),
                ..Changes::default()
            };
            draw(&scene, &changes, |frame| render::on_model(frame).unwrap())
                .unwrap()
                .stats
        };
        let objects = stats("objects");
        let counts = objects.triangles();
        assert_eq!(counts.triangles_in, 5 * 1024);
        assert!(counts.triangles_drawn > 2000, "{counts:?}");
        let simple = stats("simplegpu");
        let counts = simple.triangles();
        assert_eq!((counts.triangles_in, counts.triangles_culled), (6, 0));
        assert!(counts.triangles_clipped >= 3, "{counts:?}");
        let wireframe = stats("wireframe").wireframe.unwrap();
        assert_eq!((wireframe.segments, wireframe.lines), (12, 12));
        let torus = stats("mesh-in-field");
        assert!(torus.triangles().triangles_drawn > 300);
        for name in NAMES {
            let stats = stats(name);
            // The picture of a field contains more than its background.
            assert!(
                stats
                    .rays
                    .is_none_or(|rays| rays.hits * 9 > rays.rays && rays.undecided == 0),
                "{name}"
            );
        }
    }
}
