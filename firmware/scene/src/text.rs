//! Scenes as console commands.

use core::fmt::{self, Display, Write};

use glint_core::choice::{OrWord, switch_name};
use glint_core::console::{OWN, OptionName};
use glint_core::feature::{ANIMATE, TEXTURE};
use glint_core::fixed::{Turns, U4_28};
use glint_core::light::{HexColour, Rgb};
use glint_core::picture::Size;
use glint_model::Clip;

use crate::scene::{Kind, PlacedMesh, Scene, Sphere};

/// Displays width and height as arguments of `size`.
#[derive(PartialEq)]
struct Pixels(Size);

impl Display for Pixels {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{} {}", self.0.width(), self.0.height())
    }
}

/// Writes the arguments of `camera`, each the shortest decimal that reads back as the same bits.
impl Display for Sphere {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let [theta, phi] = [self.theta, self.phi].map(Turns::to_degrees);
        write!(f, "{} {theta} {phi}", self.r)
    }
}

fn or_off<T>(value: Option<T>) -> OrWord<T> {
    OrWord(value, "off")
}

impl Scene {
    /// Writes an option in the console's form.
    ///
    /// # Errors
    /// The errors of `out`.
    pub fn show(&self, option: OptionName, out: &mut dyn Write) -> fmt::Result {
        self.write_option(option, None, out)
    }

    /// Writes the lights in use, including default lights.
    fn show_lights(&self, out: &mut dyn Write) -> fmt::Result {
        let mut lights = self.appearance.lighting().lights;
        if self.appearance.lights.is_empty() && !self.shows_field() {
            lights.clear();
            // The empty list has space for one light.
            let _ = lights.push(self.appearance.mesh_lighting().light);
        }
        if lights.is_empty() {
            writeln!(out, "light none")?;
        }
        lights
            .iter()
            .try_for_each(|light| writeln!(out, "light {light}"))
    }

    /// The ambient light in use.
    fn shown_ambient(&self) -> Rgb {
        if self.shows_field() {
            self.appearance.lighting().ambient
        } else {
            self.appearance.mesh_lighting().ambient
        }
    }

    /// Writes the console commands that change the scene `from`, which has no objects, to this scene. Steps of the wireframe are
    /// left out.
    ///
    /// # Errors
    /// The errors of `out`.
    pub fn write_lines(&self, from: &Self, out: &mut dyn Write) -> fmt::Result {
        let is_wireframe = matches!(self.kind, Kind::Wireframe(_));
        let program = self.program.as_ref();
        let program = program.filter(|program| from.program.as_ref() != Some(program));
        if let Some(program) = program.filter(|_| !is_wireframe) {
            // The command also shows the program, which excludes stereo, so it comes before the options, and a mesh is shown again.
            writeln!(out, "program {program}\nscene {}", self.mesh)?;
        }
        for &option in OptionName::ALL {
            if !matches!(option, OptionName::Field | OptionName::Edges) {
                self.write_option(option, Some(from), out)?;
            }
        }
        // Adding objects has shown the objects, so `scene` must show the mesh again. The field follows the mesh, and edges come last
        // because they require a single mesh.
        let shows_mesh = self.kind == Kind::Solid && self.field.is_none();
        if self.mesh != from.mesh || shows_mesh && !self.objects.is_empty() {
            writeln!(out, "scene {}", self.mesh)?;
        }
        self.write_option(OptionName::Field, Some(from), out)?;
        self.write_option(OptionName::Edges, Some(from), out)?;
        match self.kind {
            Kind::Solid => Ok(()),
            Kind::Objects => writeln!(out, "object show"),
            Kind::Wireframe(_) => match program {
                Some(program) => writeln!(out, "program {program}"),
                None => writeln!(out, "program"),
            },
        }
    }

    /// Writes the commands that set an option, unless its value is equal in the scene `from`; without `from`, shows the option.
    fn write_option(
        &self,
        option: OptionName,
        from: Option<&Self>,
        out: &mut dyn Write,
    ) -> fmt::Result {
        let name = option.name();
        match option {
            OptionName::Field => self.put(name, from, out, |scene| or_off(scene.field)),
            OptionName::Mesh => self.put(name, from, out, |scene| switch_name(scene.with_mesh)),
            OptionName::Stereo => self.put(name, from, out, |scene| or_off(scene.stereo)),
            OptionName::Object => {
                let mut numbered = (1..).zip(&self.objects);
                numbered.try_for_each(|(number, PlacedMesh { mesh, place, .. })| match from {
                    Some(_) => writeln!(out, "{name} add {mesh} {place}"),
                    None => writeln!(out, "{name} {number} {mesh} {place}"),
                })
            }
            OptionName::Material => self.put(name, from, out, |scene| scene.appearance.material),
            OptionName::Light => {
                let Some(from) = from else {
                    return self.show_lights(out);
                };
                let lights = &self.appearance.lights;
                let added = lights.strip_prefix(&from.appearance.lights[..]);
                if added.is_none() {
                    writeln!(out, "{name} default")?;
                }
                let mut added = added.unwrap_or(lights).iter();
                added.try_for_each(|light| writeln!(out, "{name} {light}"))
            }
            OptionName::Ambient if from.is_none() => {
                writeln!(out, "{name} {}", HexColour(self.shown_ambient()))
            }
            OptionName::Ambient => self.put(name, from, out, |scene| {
                OrWord(scene.appearance.ambient.map(HexColour), "default")
            }),
            OptionName::Highlight => {
                self.put(name, from, out, |scene| or_off(scene.appearance.highlight))
            }
            OptionName::Shadow => self.put(name, from, out, |scene| {
                switch_name(scene.appearance.shadow)
            }),
            OptionName::Background => self.put(name, from, out, |scene| {
                OrWord(scene.appearance.background, "default")
            }),
            OptionName::Fog => self.put(name, from, out, |scene| {
                or_off(Some(scene.appearance.fog).filter(|fog| *fog != U4_28::ZERO))
            }),
            OptionName::Occlusion => self.put(name, from, out, |scene| {
                switch_name(scene.appearance.occlusion)
            }),
            OptionName::Undecided => self.put(name, from, out, |scene| {
                switch_name(scene.appearance.undecided)
            }),
            OptionName::Camera => self.put(name, from, out, |scene| scene.sphere),
            OptionName::View => {
                // A changed camera on a sphere has also changed the view.
                let from = from.filter(|from| from.sphere == self.sphere);
                self.put(name, from, out, |scene| scene.view)
            }
            // The command `view` includes these options, and `clip` includes the far plane of `projection`.
            OptionName::Look
            | OptionName::LookAt
            | OptionName::Projection
            | OptionName::FieldOfView
            | OptionName::Orthographic
            | OptionName::Near
            | OptionName::Zoom
            | OptionName::Fit => Ok(()),
            OptionName::Quality => self.put(name, from, out, |scene| scene.quality),
            OptionName::Size => {
                // A changed quality has also changed the size.
                let from = from.filter(|from| from.quality == self.quality);
                self.put(name, from, out, |scene| Pixels(scene.size))
            }
            OptionName::Antialiasing if from.is_none() => {
                writeln!(out, "{name} {}", self.samples())
            }
            OptionName::Antialiasing => {
                // A changed quality has also changed the samples.
                let from = from.filter(|from| from.quality == self.quality);
                self.put(name, from, out, |scene| {
                    OrWord(scene.fixed_samples, "default")
                })
            }
            OptionName::Backend => self.put(name, from, out, |scene| scene.backend),
            OptionName::Shading => self.put(name, from, out, |scene| scene.options.shading),
            OptionName::Cull => self.put(name, from, out, |scene| switch_name(scene.options.cull)),
            OptionName::Textures => TEXTURE.when_built(|| {
                self.put(name, from, out, |scene| switch_name(scene.options.textures))
            }),
            OptionName::Texture => TEXTURE.when_built(|| {
                self.put(name, from, out, |scene| OrWord(scene.texture.clone(), OWN))
            }),
            OptionName::Clip => self.put(name, from, out, |scene| match scene.options.clip {
                Clip::Guard => or_off(None),
                Clip::View { far } => or_off(Some(far)),
            }),
            OptionName::Winding => self.put(name, from, out, |scene| scene.options.winding),
            OptionName::Edges => self.put(name, from, out, |scene| or_off(scene.edges)),
            OptionName::Dither => self.put(name, from, out, |scene| switch_name(scene.dither)),
            OptionName::Overlay => self.put(name, from, out, |scene| switch_name(scene.overlay)),
            OptionName::Animate => {
                ANIMATE.when_built(|| self.put(name, from, out, |scene| scene.animation))
            }
            // The option has no effect, and the scene does not store its value.
            OptionName::Prepass => Ok(()),
        }
    }

    /// Writes the command that sets an option to its value, unless the option has the same value in the scene `from`.
    fn put<T: Display + PartialEq>(
        &self,
        name: &str,
        from: Option<&Self>,
        out: &mut dyn Write,
        value: impl Fn(&Self) -> T,
    ) -> fmt::Result {
        let new = value(self);
        if from.is_some_and(|from| value(from) == new) {
            return Ok(());
        }
        writeln!(out, "{name} {new}")
    }
}
