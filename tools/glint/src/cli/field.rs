//! The options on the command line for a distance field.

use super::common::{bad_value, named};
use clap::Args;
use glint::error::{InputError, quote};
use glint::field;
use glint_core::appearance::Appearance;
use glint_core::colour::Rgb565;
use glint_core::field::{Field, KINDS};
use glint_core::fixed::U4_28;
use glint_core::light::{self, Background, Light, MAX_LIGHTS, Material, parse_rgb};
use glint_core::stereo::{self, Stereo};
use std::fmt::Display;

/// Options of a distance field and its appearance, and of the light on meshes.
#[derive(Args)]
pub struct FieldArguments {
    #[arg(long, value_name = "FIELD", help = field_help())]
    field: Option<String>,
    /// Stereo: one eye E to the left of the camera and one E to the right (0 to 1), with zero parallax at the distance ZERO; lengths in
    /// world units. The left eye is red, the right one blue or cyan [default tint: red-blue].
    #[arg(long, value_name = stereo::FORM, allow_hyphen_values = true)]
    stereo: Option<String>,
    /// Material of a field; `normal` colours each face by its normal [default: normal]. Without a field, the colour of meshes instead of
    /// their own ones.
    #[arg(long, value_parser = named(Material::ALL, Material::name))]
    material: Option<Material>,
    /// A light: the direction to it, or `camera` for a light at the camera, and its colour [default colour: white]. Up to four on a
    /// field [default: none on `normal`, sun and sky on other materials], one on meshes [default: camera]; of several, the first
    /// one lights the mesh in a field.
    #[arg(long, value_name = light::FORM, allow_hyphen_values = true)]
    light: Vec<String>,
    /// Ambient light [default: 404040 with a --light; without, white on a field and black on meshes].
    #[arg(long, value_name = "RRGGBB")]
    ambient: Option<String>,
    /// Background: `white`, `sky` or a colour RRGGBB [default: white behind a field, black behind meshes]. Meshes have the sky's colour at
    /// the horizon.
    #[arg(long, value_name = "white|sky|RRGGBB")]
    background: Option<String>,
    /// Fog in the background's colour: transmittance is exp(-distance * DENSITY), with the distance in world units. DENSITY is
    /// from 0 to below 16.
    #[arg(long, value_name = "DENSITY", allow_hyphen_values = true)]
    fog: Option<String>,
    /// Ambient occlusion: darken a field's surface where other surfaces are close.
    #[arg(long)]
    occlusion: bool,
    /// Draw the rays of a field that reach their step limit magenta, instead of the horizon's colour.
    #[arg(long)]
    undecided: bool,
    /// Before the rays, march a cone around the rays of each block of pixels; the block's rays start where its cone ends. This
    /// saves evaluations of the field.
    #[arg(long)]
    prepass: bool,
}

impl FieldArguments {
    /// The text of `--field`, if given.
    pub fn name(&self) -> Option<&str> {
        self.field.as_deref()
    }

    /// The file of a list of spheres, if `--field` names one.
    pub fn file(&self) -> Option<&str> {
        self.name().and_then(field::file)
    }

    /// The parsed field, if `--field` is given.
    pub fn field(&self) -> Result<Option<Field>, InputError> {
        let parse = |text| {
            let text = field::with_files(text)?;
            Field::parse(&text)
                .map_err(|error| bad_value("--field", "a distance field", escaped(error)))
        };
        self.name().map(parse).transpose()
    }

    /// The parsed stereo settings, if `--stereo` is given.
    pub fn stereo(&self) -> Result<Option<Stereo>, InputError> {
        let parse = |text| {
            Stereo::parse(text).map_err(|error| bad_value("--stereo", "two eyes", escaped(error)))
        };
        self.stereo.as_deref().map(parse).transpose()
    }

    /// Whether cones are marched before the rays (`--prepass`).
    pub const fn prepass(&self) -> bool {
        self.prepass
    }

    /// The colour of meshes without a field, if `--material` is given.
    pub fn mesh_colour(&self) -> Result<Option<Rgb565>, InputError> {
        match (self.material, &self.field) {
            (Some(Material::Normal), None) => Err(bad_value(
                "--material",
                "a material of one colour on meshes",
                Material::Normal.name(),
            )),
            (Some(material), None) => Ok(Some(Rgb565::from_rgb888(material.faces()[0]))),
            _ => Ok(None),
        }
    }

    /// The appearance of the field, with lights and background of meshes. Other options of a field that are given without a field
    /// are an error, and so are several lights.
    pub fn appearance(&self) -> Result<Appearance, InputError> {
        let given = [
            ("--fog", self.fog.is_some()),
            ("--occlusion", self.occlusion),
            ("--undecided", self.undecided),
            ("--prepass", self.prepass),
        ];
        if let (None, Some((option, _))) = (&self.field, given.iter().find(|(_, given)| *given)) {
            return Err(bad_value(option, "a --field", "a mesh".to_owned()));
        }
        if self.field.is_none() && self.light.len() > 1 {
            let found = self.light.len().to_string();
            return Err(bad_value("--light", "one light on meshes", found));
        }
        let fog = self.fog.as_deref().map(|text| {
            let found = quote(text.as_bytes());
            text.parse::<U4_28>()
                .map_err(|_| bad_value("--fog", "a density of at least 0 and below 16", found))
        });
        let ambient = self.ambient.as_deref().map(|text| {
            let found = quote(text.as_bytes());
            parse_rgb(text).ok_or_else(|| bad_value("--ambient", "a colour RRGGBB", found))
        });
        let background = self.background.as_deref().map(|text| {
            let found = quote(text.as_bytes());
            Background::parse(text)
                .ok_or_else(|| bad_value("--background", "white, sky or a colour RRGGBB", found))
        });
        let mut appearance = Appearance {
            material: self.material.unwrap_or_default(),
            ambient: ambient.transpose()?,
            background: background.transpose()?,
            fog: fog.transpose()?.unwrap_or_default(),
            occlusion: self.occlusion,
            undecided: self.undecided,
            ..Appearance::default()
        };
        for text in &self.light {
            let light = Light::parse(text)
                .map_err(|error| bad_value("--light", "a light", escaped(error)))?;
            let found = self.light.len();
            appearance.lights.push(light).map_err(|_| {
                let expected = format!("at most {MAX_LIGHTS} lights");
                bad_value("--light", &expected, found.to_string())
            })?;
        }
        Ok(appearance)
    }
}

fn field_help() -> String {
    let kinds = KINDS.map(|(form, what)| format!("{form} ({what})"));
    format!(
        "A distance field, alone or around the model: {}. `spheres:FILE.json` reads [[cx,cy,cz,r],...]",
        kinds.join(", ")
    )
}

/// The text of an error, escaped to one line because it may quote arbitrary input.
fn escaped(error: impl Display) -> String {
    error.to_string().escape_debug().to_string()
}
