//! The camera options of the command line.

use super::common::{bad_value, named};
use super::messages::note;
use clap::Args;
use glint::view;
use glint_core::camera::View;
use glint_core::fixed::Turns;
use glint_core::framing::Sphere;
use glint_core::matrix::Axis;
use glint_core::stereo::Stereo;
use glint_model::{MAX_EYE, RenderError};
use std::path::{Path, PathBuf};

/// Options of the camera.
#[derive(Args)]
pub struct CameraArguments {
    /// A camera on a sphere about the origin: the distance (2 to 5), azimuth and polar angle in degrees. The half width of the
    /// image plane at distance 1 is 0.9, and the near plane is at 0.1 [default: a camera that shows the whole model; with a field
    /// 4,30,60].
    #[arg(
        long,
        value_name = "R,THETA,PHI",
        conflicts_with_all = ["view", "up"],
        allow_hyphen_values = true
    )]
    camera: Option<String>,
    /// A camera at the eye E in the direction of the gaze G, with the direction U (by default z) up on the screen.
    #[arg(
        long,
        value_name = "EX,EY,EZ,GX,GY,GZ[,UX,UY,UZ]",
        conflicts_with_all = ["view", "camera", "up"],
        allow_hyphen_values = true
    )]
    look_at: Option<String>,
    /// A camera at the eye E along +y, turned to the right by YAW, down by PITCH, and about its direction by ROLL, in degrees.
    #[arg(
        long,
        value_name = "EX,EY,EZ,YAW,PITCH[,ROLL]",
        conflicts_with_all = ["view", "camera", "look_at", "up"],
        allow_hyphen_values = true
    )]
    look: Option<String>,
    #[command(flatten)]
    lens: LensArguments,
    /// A camera from a file: {"eye":[x,y,z],"u":[..],"v":[..],"n":[..],"half_width":h,"near":z,"projection":"perspective"}.
    #[arg(long, value_name = "VIEW.json", conflicts_with = "up")]
    view: Option<PathBuf>,
}

/// Options for any camera, including the default camera that shows the whole model.
#[derive(Args)]
struct LensArguments {
    /// The axis of the model that points up on the screen if no camera is given [default: y for .obj, .gltf and .glb, otherwise
    /// z].
    #[arg(long, value_parser = named(Axis::ALL, Axis::name))]
    up: Option<Axis>,
    /// Enlarge the middle of the picture by this factor, with a narrower field of view.
    #[arg(long, value_name = "FACTOR")]
    zoom: Option<f64>,
    /// The horizontal field of view, 1 to 179 degrees, instead of the camera's half width. Pixels are square.
    #[arg(long, value_name = "DEGREES")]
    fov: Option<String>,
    /// Orthographic projection, with WIDTH world units (0.0174 to 230) across the picture. A field requires perspective.
    #[arg(long, value_name = "WIDTH", conflicts_with_all = ["fov", "zoom", "stereo"])]
    orthographic: Option<String>,
}

/// Subject of a picture whose camera is not given.
pub struct Shown<'a> {
    /// The bounding sphere of the model; `None` for a field, with or without a mesh.
    pub sphere: Option<Sphere>,
    /// The name of the model's file or generator, if any.
    pub model: Option<&'a str>,
    /// Whether a mesh limits the distance of the camera.
    pub has_mesh: bool,
    /// Whether the subject has a field, which requires perspective.
    pub has_field: bool,
    /// The two eyes.
    pub stereo: Option<Stereo>,
}

impl CameraArguments {
    /// Whether an option gives a camera; lens options alone do not.
    const fn is_given(&self) -> bool {
        self.camera.is_some()
            || self.look_at.is_some()
            || self.look.is_some()
            || self.view.is_some()
    }

    /// The file of the camera, if any.
    pub fn file(&self) -> Option<&Path> {
        self.view.as_deref()
    }

    /// The camera.
    pub fn view(&self, shown: &Shown) -> anyhow::Result<View> {
        if shown.has_field && self.lens.orthographic.is_some() {
            return Err(bad_value("--orthographic", "a mesh", "a --field").into());
        }
        let view = match (
            &self.view,
            &self.look_at,
            &self.look,
            &self.camera,
            shown.sphere,
        ) {
            (Some(path), ..) => {
                let view = view::read(path)?;
                check_eye(&view, shown, &path.display().to_string())?;
                view
            }
            (_, Some(text), ..) => {
                let view = view::look_at(text).map_err(|error| error.in_file("--look-at"))?;
                check_eye(&view, shown, "--look-at")?;
                view
            }
            (_, _, Some(text), ..) => {
                let view = view::look(text).map_err(|error| error.in_file("--look"))?;
                check_eye(&view, shown, "--look")?;
                view
            }
            (_, _, _, None, Some(sphere)) => {
                let name = shown.model.unwrap_or("--object");
                return self.lens.framed(
                    &sphere,
                    name,
                    self.lens.up_of(shown.model),
                    Turns::default(),
                );
            }
            (_, _, _, camera, _) => {
                let camera = camera.as_deref().unwrap_or("4,30,60");
                view::spherical(camera).map_err(|error| error.in_file("--camera"))?
            }
        };
        self.lens.applied(view)
    }

    /// The camera for a picture of a scene whose own camera is `view`. The lens options also apply to the scene's camera.
    pub fn of_scene(&self, view: View) -> anyhow::Result<View> {
        if self.lens.up.is_some() {
            return Err(bad_value("--up", "a model", "a --scene").into());
        }
        let shown = Shown {
            sphere: None,
            model: None,
            has_mesh: false,
            has_field: false,
            stereo: None,
        };
        match self.is_given() {
            true => self.view(&shown),
            false => self.lens.applied(view),
        }
    }

    /// The cameras of a full turn in the given number of steps, starting with the camera of [`view`](Self::view). A camera that
    /// shows the whole model goes around the model about the up axis; any other camera goes around the origin about z.
    pub fn turn(&self, shown: &Shown, steps: u16) -> anyhow::Result<Vec<View>> {
        match shown.sphere.filter(|_| !self.is_given()) {
            Some(sphere) => {
                let name = shown.model.unwrap_or("--object");
                let up = self.lens.up_of(shown.model);
                angles(steps)
                    .map(|angle| self.lens.framed(&sphere, name, up, angle))
                    .collect()
            }
            None => turn(&self.view(shown)?, steps),
        }
    }
}

/// The angles of a full turn in the given number of steps, starting with 0.
fn angles(steps: u16) -> impl Iterator<Item = Turns> {
    (0..steps).map(move |step| Turns(((u64::from(step) << 32) / u64::from(steps)) as u32))
}

/// The cameras of a full turn about the z axis in the given number of steps, starting with `first`.
pub fn turn(first: &View, steps: u16) -> anyhow::Result<Vec<View>> {
    let turned = |angle| Ok(view::turned(first, angle).map_err(|error| error.in_file("camera"))?);
    angles(steps).map(turned).collect()
}

impl LensArguments {
    /// The camera that shows the whole model `name`, turned by `turned` about the axis `up`.
    fn framed(&self, sphere: &Sphere, name: &str, up: Axis, turned: Turns) -> anyhow::Result<View> {
        let angle = self.fov.as_deref().map(view::field_of_view).transpose();
        let angle = angle.map_err(|error| error.in_file("--fov"))?;
        let view = sphere.framed(up, turned, angle);
        self.projected(view.map_err(|error| bad_value(name, "a camera", error.to_string()))?)
    }

    /// The up axis from the option or from the format of the model; prints a note in the second case.
    fn up_of(&self, model: Option<&str>) -> Axis {
        self.up.unwrap_or_else(|| {
            let extension = model.and_then(|model| Path::new(model).extension()?.to_str());
            let is_upright = |known: &str| {
                extension.is_some_and(|extension| extension.eq_ignore_ascii_case(known))
            };
            match ["obj", "gltf", "glb"]
                .into_iter()
                .find(|known| is_upright(known))
            {
                Some(extension) => {
                    note(format_args!(
                        "y is up, as usual in .{extension}; --up z changes it"
                    ));
                    Axis::Y
                }
                None => Axis::Z,
            }
        })
    }

    /// Applies the lens options to the camera.
    fn applied(&self, view: View) -> anyhow::Result<View> {
        let view = match &self.fov {
            Some(angle) => {
                view::with_field_of_view(view, angle).map_err(|error| error.in_file("--fov"))?
            }
            None => view,
        };
        self.projected(view)
    }

    /// Applies the zoom or the orthographic projection of the options to the camera.
    fn projected(&self, view: View) -> anyhow::Result<View> {
        let view = match self.zoom {
            Some(factor) => view::zoomed(view, factor).map_err(|error| error.in_file("--zoom"))?,
            None => view,
        };
        match &self.orthographic {
            Some(width) => {
                Ok(view::with_width(view, width)
                    .map_err(|error| error.in_file("--orthographic"))?)
            }
            None => Ok(view),
        }
    }
}

/// Rejects a camera that is too far away for a mesh. `source` names the option that gave the camera.
fn check_eye(view: &View, shown: &Shown, source: &str) -> anyhow::Result<()> {
    let eyes = shown.stereo.map_or([*view; 2], |stereo| stereo.eyes(view));
    let far = eyes.iter().find(|eye| !eye.is_within(MAX_EYE));
    if let Some(eye) = far.filter(|_| shown.has_mesh) {
        let found = RenderError::Eye(eye.eye()).to_string();
        return Err(bad_value(source, "a camera", found).into());
    }
    Ok(())
}
