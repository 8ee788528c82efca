//! Scene files that a page sends, with the files that they name.

use crate::beside::{Beside, MAX_UPLOAD};
use glint_core::shape::Shape;
use glint_core::wireframe::text::{assemble, lines_after_end};
use glint_core::wireframe::{EXTENSIONS, Program};
use glint_mesh::convert::{Options, TextureOptions};
use glint_mesh::texture::CUTOFF;
use glint_mesh::{generate, model, texture};
use glint_scene_file::{MAX_BYTES, SceneFile, Steer};
use std::path::Path;

/// A scene to show.
#[derive(Debug)]
pub struct Scene {
    /// Name of its file.
    pub name: String,
    /// The files to upload.
    pub files: Vec<File>,
    /// The console commands that set the picture.
    pub commands: Vec<String>,
    /// The console command that starts the control of the camera, if any.
    pub control: Option<String>,
    /// The remarks on the files.
    pub remarks: Vec<String>,
}

/// A file of a scene, in the board's memory layout.
#[derive(Debug)]
pub struct File {
    /// Its name on the board.
    pub name: String,
    /// The mesh, the texture or the wireframe program.
    pub bytes: Vec<u8>,
    /// Whether it is a wireframe program.
    pub is_program: bool,
}

/// Whether a file is a scene file.
pub fn is_scene(name: &str) -> bool {
    stem(name).is_some()
}

/// The name of a scene file without folder and extension; `None` for another file.
fn stem(name: &str) -> Option<&str> {
    let (stem, extension) = name.rsplit('/').next()?.rsplit_once('.')?;
    extension.eq_ignore_ascii_case("toml").then_some(stem)
}

impl Scene {
    /// Parses a scene file, and converts the files that it names. `beside` has the files that came with it.
    ///
    /// # Errors
    /// A file violates its format, or is missing. The error is one line for the user.
    pub fn of_file(name: &str, text: &[u8], beside: &mut Beside) -> Result<Self, String> {
        if text.len() as u64 > MAX_BYTES {
            let found = text.len();
            return Err(format!(
                "{name}: expected at most {MAX_BYTES} bytes, found {found}"
            ));
        }
        let text = str::from_utf8(text)
            .map_err(|error| format!("{name}: expected text in UTF-8: {error}"))?;
        let scene = SceneFile::parse(stem(name).unwrap_or(name), name, text);
        let scene = scene.map_err(|error| error.to_string().replace('\n', "; "))?;
        if !scene.scenes().is_empty() {
            return Err(format!(
                "{name}: expected the scene of a picture, found a list of scenes"
            ));
        }
        let (mut files, mut size) = (Vec::new(), 0);
        let mut remarks = scene.notes().into_iter().map(str::to_owned).collect();
        let mut add = |name: &str, convert: Convert, is_program| {
            let bytes =
                convert(name, beside, &mut remarks).map_err(|error| match beside.hint() {
                    Some(hint) => format!("{error}; {hint}"),
                    None => error,
                })?;
            size += bytes.len();
            if size > MAX_UPLOAD {
                return Err(format!(
                    "{name}: expected meshes, textures and programs of at most {MAX_UPLOAD} bytes together"
                ));
            }
            let name = name.to_owned();
            files.push(File {
                name,
                bytes,
                is_program,
            });
            Ok::<(), String>(())
        };
        for mesh in scene.meshes().iter().filter(|mesh| !is_built_in(mesh)) {
            add(mesh, of_mesh, false)?;
        }
        scene
            .texture()
            .map_or(Ok(()), |name| add(name, of_texture, false))?;
        scene
            .program()
            .map_or(Ok(()), |name| add(name, of_program, true))?;
        remarks.extend(beside.hint());
        let settings = scene.settings().iter().cloned();
        let control = match scene.steer() {
            Steer::Command(command) => Some(command.clone()),
            Steer::Fixed | Steer::Buttons => None,
        };
        Ok(Self {
            name: name.to_owned(),
            files,
            commands: ["scene default".to_owned()]
                .into_iter()
                .chain(settings)
                .collect(),
            control,
            remarks,
        })
    }
}

/// Converts the file with a name, and adds the remarks on it.
type Convert = fn(&str, &mut Beside, &mut Vec<String>) -> Result<Vec<u8>, String>;

/// Whether every board has the mesh.
fn is_built_in(mesh: &str) -> bool {
    mesh == "cube" || Shape::NAMES.contains(&mesh)
}

/// The bytes of a file that the scene names.
fn read(name: &str, beside: &mut Beside) -> Result<Vec<u8>, String> {
    let bytes = beside.read(name);
    bytes.ok_or_else(|| format!("expected the file {name} of the scene"))
}

fn of_mesh(name: &str, beside: &mut Beside, remarks: &mut Vec<String>) -> Result<Vec<u8>, String> {
    let (options, path) = (Options::default(), Path::new(name));
    let model = if generate::is_name(name) {
        model::generated(name, options)
    } else {
        let bytes = read(name, beside)?;
        // The names in a mesh file are relative to its folder.
        let mut read = |other: &str| beside.read(&path.with_file_name(other).to_string_lossy());
        model::of_file(name, bytes, options, &mut read)
    };
    let model = model.map_err(|error| error.to_string())?;
    remarks.extend(model.remarks().iter().cloned());
    remarks.extend(model.inside_out().map(str::to_owned));
    Ok(model.mesh)
}

fn of_texture(
    name: &str,
    beside: &mut Beside,
    remarks: &mut Vec<String>,
) -> Result<Vec<u8>, String> {
    let bytes = read(name, beside)?;
    let converted = texture::of_bytes(&bytes, &TextureOptions::default(), None, CUTOFF);
    let (bytes, report) = converted.map_err(|error| error.in_path(name.as_ref()).to_string())?;
    remarks.extend(report.remarks);
    Ok(bytes)
}

fn of_program(
    name: &str,
    beside: &mut Beside,
    remarks: &mut Vec<String>,
) -> Result<Vec<u8>, String> {
    let bytes = read(name, beside)?;
    let [text_form, _] = EXTENSIONS;
    let extension = name.rsplit_once('.').map(|(_, extension)| extension);
    let is_text = extension.is_some_and(|extension| extension.eq_ignore_ascii_case(text_form));
    let text = String::from_utf8_lossy(&bytes);
    let (bytes, ignored) = if is_text {
        (assemble(&text), lines_after_end(&text))
    } else {
        let program = Program::new_checked(&bytes);
        let ignored = program.as_ref().map_or(0, Program::ignored);
        (program.map(|program| program.bytes().to_vec()), ignored)
    };
    if ignored > 0 {
        remarks.push(format!("{name}: what follows the end is ignored"));
    }
    bytes.map_err(|error| format!("{name}: {error}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRIANGLE: &str = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n";

    fn scene(text: &str, files: &[(&str, &str)]) -> Result<Scene, String> {
        let files = files.iter();
        let files = files.map(|&(name, text)| (name.to_owned(), text.into()));
        let name = "own/A.TOML";
        Scene::of_file(name, text.as_bytes(), &mut Beside::new(name, files))
    }

    #[test]
    fn a_scene_has_its_files_and_commands() {
        let text =
            "title = 'A'\nobject = ['m/a.obj', 'icosphere:1', 'sphere']\ncamera = '3 0 60'\n";
        let files = |first, second| {
            [
                ("own/a.mtl", first),
                ("own/m/a.mtl", second),
                ("own/m/a.obj", TRIANGLE),
            ]
        };
        let [red, green] = ["newmtl m\nKd 1 0 0\n", "newmtl m\nKd 0 1 0\n"];
        let found = scene(text, &files(red, green)).unwrap();
        let names: Vec<_> = found.files.iter().map(|file| file.name.as_str()).collect();
        assert_eq!(names, ["m/a.obj", "icosphere:1"]);
        assert_eq!(found.remarks, [""; 0]);
        assert_eq!(found.commands[0], "scene default");
        assert!(
            found.commands.contains(&"object add sphere".to_owned()),
            "{found:?}"
        );
        // The material is that in the folder of the mesh.
        let other = scene(text, &files(green, green)).unwrap();
        assert_eq!(found.files[0].bytes, other.files[0].bytes);
        let other = scene(text, &files(red, red)).unwrap();
        assert_ne!(found.files[0].bytes, other.files[0].bytes);
    }

    #[test]
    fn errors_name_the_file() {
        let long = "#".repeat(MAX_BYTES as usize + 1);
        for (text, files, error) in [
            ("title = 'A'\nfov = 500", &[][..], "own/A.TOML: "),
            (
                &long,
                &[],
                "own/A.TOML: expected at most 1048576 bytes, found 1048577",
            ),
            (
                "title = 'A'\nscenes = ['cubes']",
                &[],
                "own/A.TOML: expected the scene of a picture, found a list of scenes",
            ),
            (
                "title = 'A'\nmodel = 'crate'\ntexture = 'a.png'",
                &[],
                "expected the file a.png of the scene; drop 'A.TOML' together with 'a.png'",
            ),
            (
                "title = 'A'\nprogram = 'a.WFT'",
                &[("a.WFT", "eye\n")],
                "a.WFT: wireframe program, line 1: ",
            ),
            (
                "title = 'A'\nprogram = 'a.wfb'",
                &[("a.wfb", "eye\n")],
                "a.wfb: wireframe program, ",
            ),
        ] {
            let found = scene(text, files).unwrap_err();
            assert!(found.starts_with(error), "{found}");
            assert!(!found.contains('\n'), "{found}");
        }
    }
}
