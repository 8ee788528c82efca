//! The command-line options for a distance field, and for the appearance of a scene.

use super::common::{SizeArguments, bad_value};
use super::heading;
use super::options::OptionArguments;
use clap::Args;
use glint::error::InputError;
use glint::field;
use glint_core::colour::Rgb565;
use glint_core::field::{Field, KINDS};
use glint_core::light::Material;
use glint_scene::{Defaults, Scene};

/// The options for a distance field and for the appearance of a scene.
#[derive(Args)]
pub struct FieldArguments {
    #[arg(long, value_name = "FIELD", help = field_help(), conflicts_with = "scene", help_heading = heading::SUBJECT)]
    field: Option<String>,
    #[command(flatten)]
    pub options: OptionArguments,
}

impl FieldArguments {
    /// The value of `--field`, if given.
    pub fn name(&self) -> Option<&str> {
        self.field.as_deref()
    }

    /// The file with the list of spheres, if `--field` names one.
    pub fn file(&self) -> Option<&str> {
        self.name().and_then(field::file)
    }

    /// The start scene with these options, and with those for the size.
    pub fn scene(&self, size: &SizeArguments, defaults: Defaults) -> anyhow::Result<Scene> {
        let parse = |text| {
            let text = field::with_files(text)?;
            Field::parse(&text).map_err(|error| {
                let found = error.to_string().escape_debug().to_string();
                bad_value("--field", "a distance field", found)
            })
        };
        let mut scene = Scene {
            field: self.name().map(parse).transpose()?,
            ..size.scene(defaults)?
        };
        self.options.apply(&mut scene)?;
        Ok(scene)
    }

    /// The colour that replaces the colours of meshes without a field, if `--material` is given.
    pub fn mesh_colour(&self, scene: &Scene) -> Result<Option<Rgb565>, InputError> {
        if scene.field.is_some() || !self.options.has("material") {
            return Ok(None);
        }
        let material = scene.appearance.material;
        let option = "--material";
        if material == Material::Normal {
            let expected = "a material of one colour on meshes";
            return Err(bad_value(option, expected, material.name()));
        }
        if scene.edges.is_some() {
            return Err(bad_value(option, "a mesh with faces", "--wireframe"));
        }
        Ok(Some(Rgb565::from_rgb888(material.faces()[0])))
    }
}

fn field_help() -> String {
    let kinds = KINDS.map(|(form, what)| format!("{form} ({what})"));
    format!(
        "A distance field, alone or around the model: {}. `spheres:FILE.json` reads [[cx,cy,cz,r],...]",
        kinds.join(", ")
    )
}
