//! The argument MODEL of the command line: a mesh file, or a generator.

use crate::convert::{self, Options, Report};
use crate::error::InputError;
use crate::formats::{self, Format, glm};
use crate::generate;
use crate::polygons::Polygons;
use std::path::Path;

/// A mesh for boards, and the report of its conversion.
pub struct Model {
    /// The mesh in the board's memory layout.
    pub mesh: Vec<u8>,
    /// The report of the conversion; `None` for a `.glm` file, which needs no conversion.
    pub report: Option<Report>,
}

/// Whether `name` stands for a generator. If a file of this name exists, it stands for the file.
fn is_generated(name: &str) -> bool {
    generate::is_name(name) && !Path::new(name).exists()
}

/// Reads or generates the polygons of a model.
///
/// # Errors
/// The file cannot be read or parsed, or no such generator exists.
pub fn polygons(name: &str) -> Result<Polygons, InputError> {
    if is_generated(name) {
        generate::named(name).map_err(|error| error.in_file(name))
    } else {
        formats::read(Path::new(name))
    }
}

/// Reads or generates a model and converts it.
///
/// # Errors
/// As [`polygons`] and [`convert::convert`].
pub fn load(name: &str, options: Options) -> Result<Model, InputError> {
    let path = Path::new(name);
    let polygons = if is_generated(name) {
        polygons(name)?
    } else {
        let (format, mesh) = formats::read_mesh(path)?;
        if format == Format::Glm {
            glm::check_file(&mesh).map_err(|error| error.in_path(path))?;
            return Ok(Model { mesh, report: None });
        }
        formats::parse(path, format, &mesh)?
    };
    let (mesh, report) =
        convert::convert(&polygons, options).map_err(|error| error.in_path(path))?;
    Ok(Model {
        mesh,
        report: Some(report),
    })
}
