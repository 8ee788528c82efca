//! Frames of scene files.

use crate::convert::{Options, TextureOptions};
use crate::error::{FormatError, InputError};
use crate::generate;
use crate::model;
use crate::texture;
use crate::wireframe;
use glint_core::colour::Shading;
use glint_core::console::Setting;
use glint_core::mesh::Mesh;
use glint_core::picture::{Samples, Size};
use glint_core::quality::Quality;
use glint_core::shape::{MAX_BYTES, Shape};
use glint_core::texture::Texture;
use glint_core::wireframe::{CUBE, Program};
use glint_model::Frame;
use glint_scene::{AnyBoard, Assets, Board};
use glint_scene_file::SceneFile;
use std::fmt::Display;
use std::path::Path;

/// The error for a scene that no board can draw, with the reason.
fn refuse(reason: impl Display) -> FormatError {
    FormatError::whole("a scene that boards can show", reason.to_string())
}

/// Settings that override the settings of a scene.
#[derive(Clone, Copy, Default)]
pub struct Changes {
    /// Shading of meshes.
    pub shading: Option<Shading>,
    /// Quality of the picture; also sets its size.
    pub quality: Option<Quality>,
    /// Size of the picture; overrides the size of the quality.
    pub size: Option<Size>,
    /// Number of samples of a pixel.
    pub samples: Option<Samples>,
}

/// Whether `name` is the name of a shape that is built into the firmware.
pub fn is_shape(name: &str) -> bool {
    Shape::NAMES.contains(&name)
}

/// The mesh of a scene by name: a shape that is built into the firmware, a file in the folder of the scene, or a generator.
///
/// # Errors
/// As for [`model::load`].
pub fn mesh(name: &str, folder: &Path) -> Result<Vec<u8>, InputError> {
    match Shape::ALL.into_iter().find(|shape| shape.name() == name) {
        Some(shape) => {
            let mut bytes = vec![0; MAX_BYTES];
            let length = shape.write(&mut bytes).unwrap_or(0);
            bytes.truncate(length);
            Ok(bytes)
        }
        None => Ok(model::load(&path(name, folder), Options::default())?.mesh),
    }
}

/// The texture of a scene: a file in the folder of the scene.
///
/// # Errors
/// As for [`texture::load`].
pub fn texture(name: &str, folder: &Path) -> Result<Vec<u8>, InputError> {
    let converted = texture::load(&folder.join(name), &TextureOptions::default());
    Ok(converted?.0)
}

/// The wireframe program of a scene in binary form: a file in the folder of the scene.
///
/// # Errors
/// As for [`wireframe::read`].
pub fn program(name: &str, folder: &Path) -> Result<Vec<u8>, InputError> {
    Ok(wireframe::read(&folder.join(name))?.bytes)
}

/// The path of a scene's mesh in the folder of the scene; for a generator its name, unless a file
/// has this name.
pub fn path(name: &str, folder: &Path) -> String {
    let file = folder.join(name);
    let is_generated = generate::is_name(name) && !file.exists();
    match file.to_str() {
        Some(file) if !is_generated => file.to_owned(),
        _ => name.to_owned(),
    }
}

/// The meshes of a scene, with their names.
struct Meshes<'a> {
    names: &'a [String],
    meshes: &'a [Mesh<'a>],
}

impl Board for Meshes<'_> {
    fn has_size(&self, size: Size) -> bool {
        AnyBoard.has_size(size)
    }

    fn has_engine(&self) -> bool {
        AnyBoard.has_engine()
    }

    fn has_mesh(&mut self, name: &str) -> bool {
        self.mesh(name).is_some()
    }

    fn mesh(&self, name: &str) -> Option<Mesh<'_>> {
        let known = self.names.iter().position(|known| known == name)?;
        self.meshes.get(known).copied()
    }

    fn has_texture(&self, name: &str) -> bool {
        AnyBoard.has_texture(name)
    }

    fn has_program(&self, name: &str) -> bool {
        AnyBoard.has_program(name)
    }
}

/// The wireframe program that is built into the firmware.
///
/// # Errors
/// None: the program is valid.
pub fn built_in_program() -> Result<Program<'static>, InputError> {
    let program = Program::new_checked(CUBE.as_flattened());
    program.map_err(|error| refuse(error).in_file("program"))
}

/// Calls `draw` with the frame of a scene after `changes`.
///
/// # Errors
/// A mesh, the texture or the wireframe program cannot be read, or no board can draw the scene, or no camera shows all meshes.
pub fn draw<T>(
    file: &SceneFile,
    changes: &Changes,
    draw: impl FnOnce(&Frame) -> T,
) -> Result<T, InputError> {
    let in_scene = |error: FormatError| error.in_file(file.name());
    let names = file.meshes();
    let bytes = names.iter().map(|name| mesh(name, file.folder()));
    let bytes = bytes.collect::<Result<Vec<_>, _>>()?;
    let meshes = bytes.iter().map(|bytes| Mesh::new_checked(bytes));
    let meshes = meshes.collect::<Result<Vec<_>, _>>();
    let meshes = meshes.map_err(|error| in_scene(refuse(error)))?;
    let texture = file.texture().map(|name| texture(name, file.folder()));
    let texture = texture.transpose()?;
    let texture = texture.as_deref().map(Texture::new_checked).transpose();
    let texture = texture.map_err(|error| in_scene(refuse(error)))?;
    let program = file.program().map(|name| program(name, file.folder()));
    let program = program.transpose()?;
    let program = match &program {
        Some(bytes) => wireframe::check(bytes).map_err(in_scene)?,
        None => built_in_program()?,
    };
    let mut board = Meshes {
        names,
        meshes: &meshes,
    };
    let scene = file.scene_on(&mut board);
    let mut scene = scene.map_err(|reason| in_scene(refuse(reason)))?;
    scene.options.shading = changes.shading.unwrap_or(scene.options.shading);
    if let Some(quality) = changes.quality {
        let set = scene.apply(&Setting::Quality { quality }, &mut AnyBoard);
        set.map_err(|error| in_scene(refuse(error)))?;
    }
    scene.size = changes.size.unwrap_or(scene.size);
    scene.fixed_samples = changes.samples.or(scene.fixed_samples);
    let objects: Vec<_> = (scene.objects.iter())
        .flat_map(|placed| {
            let mesh = board.mesh(&placed.mesh);
            mesh.map(|mesh| scene.object(&placed.place, mesh))
        })
        .collect();
    Ok(draw(&scene.frame(Assets {
        // A scene without objects has at most one mesh.
        mesh: meshes.first().copied(),
        objects: &objects,
        replacement_texture: texture,
        program,
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
            // The picture of a field must contain more than its background.
            assert!(
                stats
                    .rays
                    .is_none_or(|rays| rays.hits * 9 > rays.rays && rays.undecided == 0),
                "{name}"
            );
        }
    }
}
