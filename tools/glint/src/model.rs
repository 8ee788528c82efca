//! What the command line calls a MODEL: a mesh file, or the name of a generator.

use crate::convert::{self, Options, Report};
use crate::error::InputError;
use crate::formats::{self, Format, glm};
use crate::generate;
use crate::polygons::Polygons;
use std::path::Path;

/// A mesh ready for a board, and what its conversion did, if it needed one.
pub struct Model {
    /// The mesh as it lies in memory.
    pub mesh: Vec<u8>,
    /// What the conversion did; nothing for a `.glm`, which is taken as it is.
    pub report: Option<Report>,
}

/// Whether a name is that of a generator. A file of that name goes before.
fn is_generated(name: &str) -> bool {
    generate::is_name(name) && !Path::new(name).exists()
}

/// Reads or makes the polygons of a model.
///
/// # Errors
/// It cannot be read, is not what its name says, or there is no such generator.
pub fn polygons(name: &str) -> Result<Polygons, InputError> {
    if is_generated(name) {
        generate::named(name).map_err(|error| error.in_file(name))
    } else {
        formats::read(Path::new(name))
    }
}

/// Reads or makes a model and converts it.
///
/// # Errors
/// As [`polygons`] and [`convert::convert`].
pub fn load(name: &str, options: Options) -> Result<Model, InputError> {
    let path = Path::new(name);
    if !is_generated(name) && Format::of(path)? == Format::Glm {
        let mesh = formats::read_file(path)?;
        glm::check(&mesh).map_err(|error| error.in_file(name.escape_debug().to_string()))?;
        return Ok(Model { mesh, report: None });
    }
    let (mesh, report) = convert::convert(&polygons(name)?, options)
        .map_err(|error| error.in_file(name.escape_debug().to_string()))?;
    Ok(Model {
        mesh,
        report: Some(report),
    })
}
