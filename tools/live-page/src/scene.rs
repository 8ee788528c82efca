//! Scene files that a page sends, with the files that they name.

use crate::beside::Beside;
use glint_core::shape::Shape;
use glint_core::wireframe::text::assemble;
use glint_core::wireframe::{EXTENSIONS, Program};
use glint_mesh::convert::{Options, TextureOptions};
use glint_mesh::texture::CUTOFF;
use glint_mesh::{generate, model, texture};
use glint_scene_file::SceneFile;

/// A scene to show.
#[derive(Debug)]
pub struct Scene {
    /// Name of its file.
    pub name: String,
    /// The files to upload.
    pub files: Vec<File>,
    /// The console commands that show it.
    pub commands: Vec<String>,
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
    name.ends_with(".toml")
}

impl Scene {
    /// Parses a scene file, and converts the files that it names. `beside` has the files that came with it.
    ///
    /// # Errors
    /// A file violates its format, or is missing. The error is one line for the user.
    pub fn of_file(name: &str, text: &[u8], beside: &mut Beside) -> Result<Self, String> {
        let text = str::from_utf8(text)
            .map_err(|error| format!("{name}: expected text in UTF-8: {error}"))?;
        let stem = name
            .rsplit('/')
            .next()
            .and_then(|last| last.strip_suffix(".toml"));
        let scene = SceneFile::parse(stem.unwrap_or(name), name, text);
        let scene = scene.map_err(|error| error.to_string().replace('\n', "; "))?;
        if !scene.scenes().is_empty() {
            return Err(format!(
                "{name}: expected the scene of a picture, found a list of scenes"
            ));
        }
        let mut files = Vec::new();
        let mut remarks = scene.notes().into_iter().map(str::to_owned).collect();
        let mut add = |name: &str, convert: Convert, is_program| {
            let bytes =
                convert(name, beside, &mut remarks).map_err(|error| match beside.hint() {
                    Some(hint) => format!("{error}; {hint}"),
                    None => error,
                })?;
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
        let commands = ["scene default"].into_iter().chain(scene.lines());
        Ok(Self {
            name: name.to_owned(),
            files,
            commands: commands.map(str::to_owned).collect(),
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
    let options = Options::default();
    let model = if generate::is_name(name) {
        model::load(name, options)
    } else {
        let bytes = read(name, beside)?;
        model::of_file(name, bytes, options, &mut |name| beside.read(name))
    };
    let model = model.map_err(|error| error.to_string())?;
    remarks.extend(model.remarks().iter().cloned());
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

fn of_program(name: &str, beside: &mut Beside, _: &mut Vec<String>) -> Result<Vec<u8>, String> {
    let bytes = read(name, beside)?;
    let [text_form, _] = EXTENSIONS;
    let extension = name.rsplit_once('.').map(|(_, extension)| extension);
    let text = String::from_utf8_lossy(&bytes);
    let program = match extension == Some(text_form) {
        true => assemble(&text),
        false => Program::new_checked(&bytes).map(|program| program.bytes().to_vec()),
    };
    program.map_err(|error| format!("{name}: {error}"))
}
