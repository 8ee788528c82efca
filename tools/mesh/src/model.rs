//! The argument MODEL of the command line: a mesh file, or a generator.

use crate::convert::{self, Options, Report, TextureOptions, TextureReport};
use crate::error::{FormatError, InputError};
use crate::formats::{self, Beside, Format, STDIN, glm};
use crate::generate::{self, NAMES};
use crate::polygons::Polygons;
use crate::texture::is_texture;
use glint_core::framing::upright;
use glint_core::matrix::Axis;
use glint_core::mesh::{MAX_NAME, Mesh};
use glint_core::wireframe::is_program_file;
use std::path::Path;

/// A mesh for boards, with the report of its conversion.
pub struct Model {
    /// The mesh in the board's memory layout.
    pub mesh: Vec<u8>,
    /// The report of the conversion; `None` for a `.glm` file that is not converted.
    pub report: Option<Report>,
    /// The axis that points up in the format of the file; z for a generator.
    pub up: Axis,
}

impl Model {
    /// Reports on the textures that were converted.
    pub fn textures(&self) -> &[TextureReport] {
        self.report.as_ref().map_or(&[], |report| &report.textures)
    }

    /// Whether the surface is known to be smooth, as [`Report::smooth`] states.
    pub fn is_smooth(&self) -> bool {
        self.report.as_ref().is_some_and(|report| report.smooth)
    }

    /// The remarks on the file.
    pub fn remarks(&self) -> &[String] {
        self.report.as_ref().map_or(&[], |report| &report.remarks)
    }

    /// Returns a remark if the mesh is closed and inside out, because only its far side is then
    /// drawn.
    pub fn inside_out(&self) -> Option<&'static str> {
        let mesh = Mesh::new_checked(&self.mesh).ok()?;
        is_inside_out(&mesh).then_some(
            "the mesh is inside out, and back faces are not drawn: `cull off` on the console draws them, \
             `glint convert --fix-winding` reverses the faces",
        )
    }
}

/// Whether a mesh is closed and its faces point inwards: the exact sum of its area vectors is 0,
/// and its volume is negative.
fn is_inside_out(mesh: &Mesh) -> bool {
    let mut area = [0_i128; 3];
    let mut volume = 0_i128;
    for chunk in mesh.chunks() {
        for triangle in chunk.triangles() {
            let corners = triangle
                .indices
                .map(|index| chunk.vertex(usize::from(index)));
            let [Some(a), Some(b), Some(c)] = corners else {
                return false;
            };
            let [a, b, c] = [a, b, c].map(|vertex| vertex.position.map(i128::from));
            let [p, q] = [b, c].map(|corner| [0, 1, 2].map(|i| corner[i] - a[i]));
            let normal = [(1, 2), (2, 0), (0, 1)].map(|(i, j)| p[i] * q[j] - p[j] * q[i]);
            for axis in 0..3 {
                area[axis] += normal[axis];
                volume += a[axis] * normal[axis];
            }
        }
    }
    area == [0; 3] && volume < 0
}

/// The name under which a file is uploaded: the file's name without folder, for a mesh also without extension. `-` replaces characters that
/// a name cannot contain. `None` for a generator.
pub fn board_name(file: &str) -> Option<String> {
    let path = Path::new(file);
    let name = if is_texture(file) || is_program_file(file) {
        path.file_name()?
    } else {
        path.extension().and(path.file_stem())?
    };
    let visible = |c: char| if c.is_ascii_graphic() { c } else { '-' };
    let name = name.to_string_lossy();
    Some(name.chars().map(visible).take(MAX_NAME).collect())
}

/// Whether `name` selects a generator. A file with the name of a generator has precedence.
fn is_generated(name: &str) -> bool {
    generate::is_name(name) && !Path::new(name).exists()
}

/// Checks that a name without an extension is the name of an existing file, because it may be a
/// misspelt generator.
///
/// # Errors
/// The name has no extension, and no file has this name. The error lists the generators.
fn check_name(name: &str) -> Result<(), InputError> {
    let path = Path::new(name);
    if name == STDIN || path.extension().is_some() || path.exists() {
        return Ok(());
    }
    let expected = format!("a mesh file or a generator ({NAMES})");
    Err(FormatError::whole(expected, "neither").in_file(name))
}

/// Reads the polygons of a mesh file.
///
/// # Errors
/// The file cannot be read or parsed. The error for the name of a generator states the command for generators.
pub fn of_mesh_file(path: &Path) -> Result<Polygons, InputError> {
    if let Some(name) = path.to_str() {
        if is_generated(name) {
            let expected = format!("a mesh file; `glint model {name}` makes this model");
            return Err(FormatError::whole(expected, "a generator").in_file(name));
        }
        check_name(name)?;
    }
    formats::read(path)
}

/// Reads or generates the polygons of a model.
///
/// # Errors
/// The file cannot be read or parsed, or no such generator exists.
pub fn polygons(name: &str) -> Result<Polygons, InputError> {
    if is_generated(name) {
        generate::named(name).map_err(|error| error.in_file(name))
    } else {
        check_name(name)?;
        formats::read(Path::new(name))
    }
}

/// Reads or generates a model and converts it. A `.glm` file remains unchanged, except that its
/// textures are converted if the options change them.
///
/// # Errors
/// As for [`polygons`] and [`convert::convert`].
pub fn load(name: &str, options: Options) -> Result<Model, InputError> {
    if is_generated(name) {
        return generated(name, options);
    }
    let path = Path::new(name);
    check_name(name)?;
    let (format, bytes) = formats::read_mesh(path)?;
    of_bytes(
        path,
        format,
        bytes,
        options,
        &mut formats::in_folder_of(path),
    )
}

/// Generates a model and converts it; reads no file.
///
/// # Errors
/// No such generator exists.
pub fn generated(name: &str, options: Options) -> Result<Model, InputError> {
    let polygons = generate::named(name).map_err(|error| error.in_file(name))?;
    converted(Path::new(name), &polygons, options)
}

/// Converts a mesh file in memory. The extension of its name selects the format; `beside` reads auxiliary files by their names.
///
/// # Errors
/// As for [`load`].
pub fn of_file(
    name: &str,
    bytes: Vec<u8>,
    options: Options,
    beside: &mut Beside,
) -> Result<Model, InputError> {
    let path = Path::new(name);
    of_bytes(path, Format::of(path)?, bytes, options, beside)
}

fn of_bytes(
    path: &Path,
    format: Format,
    bytes: Vec<u8>,
    options: Options,
    beside: &mut Beside,
) -> Result<Model, InputError> {
    if format == Format::Glm && options.textures == TextureOptions::default() {
        glm::check_file(&bytes).map_err(|error| error.in_path(path))?;
        return Ok(Model {
            mesh: bytes,
            report: None,
            up: up_of(path),
        });
    }
    let polygons = formats::parse(path, format, &bytes, beside)?;
    // A mesh in a board's memory layout keeps everything but its textures.
    let is_kept = format == Format::Glm;
    let options = Options {
        keep_scale: is_kept || options.keep_scale,
        keep_order: is_kept || options.keep_order,
        ..options
    };
    converted(path, &polygons, options)
}

/// The axis that points up in files with the extension of `path`.
fn up_of(path: &Path) -> Axis {
    let extension = path.extension().and_then(|extension| extension.to_str());
    extension.and_then(upright).map_or(Axis::Z, |(up, _)| up)
}

fn converted(path: &Path, polygons: &Polygons, options: Options) -> Result<Model, InputError> {
    let (mesh, report) =
        convert::convert(polygons, options).map_err(|error| error.in_path(path))?;
    Ok(Model {
        mesh,
        report: Some(report),
        up: up_of(path),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The remark on an OBJ file of a cube; `change` edits each line.
    fn remark(change: impl Fn(&str) -> String) -> Option<&'static str> {
        let mut obj = Vec::new();
        let mut cube = generate::named("cube").unwrap();
        convert::place(&mut cube, Options::default()).unwrap();
        formats::write::obj(&cube, &mut obj).unwrap();
        let text = String::from_utf8(obj).unwrap();
        let text: String = text.lines().map(|line| change(line) + "\n").collect();
        let model = of_file("a.obj", text.into(), Options::default(), &mut |_| None).unwrap();
        model.inside_out()
    }

    /// Reverses the order of the corners in the line of a face.
    fn reversed(line: &str) -> String {
        let Some(corners) = line.strip_prefix("f ") else {
            return line.to_owned();
        };
        let corners: Vec<_> = corners.split(' ').rev().collect();
        format!("f {}", corners.join(" "))
    }

    #[test]
    fn closed_meshes_that_are_inside_out_have_a_remark() {
        assert_eq!(remark(str::to_owned), None);
        assert!(remark(reversed).unwrap().contains("inside out"));
        // An open box has no inside.
        let mut faces = std::cell::Cell::new(0);
        let open = |line: &str| {
            if line.starts_with("f ") {
                faces.set(faces.get() + 1);
                if faces.get() == 1 {
                    return String::new();
                }
            }
            reversed(line)
        };
        assert_eq!(remark(open), None);
        assert!(*faces.get_mut() > 1);
    }
}
