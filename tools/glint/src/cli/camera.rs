//! The camera options of the command line: options of the console's table, and options that only
//! the host has.

use super::common::{bad_value, named};
use super::messages::note;
use super::options::OptionArguments;
use anyhow::Context;
use clap::Args;
use glint::convert::TextureReport;
use glint::error::InputError;
use glint::render::Frame;
use glint::view;
use glint_core::camera::{View, is_within};
use glint_core::fixed::Turns;
use glint_core::framing::{self, BoundingSphere, FramingError};
use glint_core::matrix::{Axis, Matrix};
use glint_core::mesh::Mesh;
use glint_model::{MAX_EYE, RenderError};
use glint_scene_file::{SceneFile, upright};
use std::path::{Path, PathBuf};

/// Default camera, if neither the subject nor an option determines it.
const DEFAULT: &str = "4,30,60";

/// Camera options that are not in the console's table.
#[derive(Args)]
pub struct CameraArguments {
    /// A camera at the point E. It looks along +y, turned to the right by YAW, down by PITCH, and
    /// about its direction of view by ROLL, in degrees.
    #[arg(
        long,
        value_name = "EX,EY,EZ,YAW,PITCH[,ROLL]",
        conflicts_with_all = ["view", "camera", "lookat", "up"],
        allow_hyphen_values = true
    )]
    look: Option<String>,
    /// A camera from a file: {"eye":[x,y,z],"u":[..],"v":[..],"n":[..],"half_width":h,"near":z,"projection":"perspective","half_height":h,"middle":[x,y]}.
    #[arg(long, value_name = "VIEW.json", conflicts_with_all = ["camera", "lookat", "up"])]
    view: Option<PathBuf>,
    /// The axis of the model that points up on the screen if no camera is given [default: y for .obj, .gltf and .glb, otherwise
    /// z].
    #[arg(long, value_parser = named(Axis::ALL, Axis::name), conflicts_with_all = ["camera", "lookat"])]
    up: Option<Axis>,
}

/// A frame for which a camera is computed. The frame of a scene already has the scene's camera.
#[derive(Clone, Copy)]
pub struct CameraSubject<'a> {
    pub frame: &'a Frame<'a>,
    /// The name of the model's file or generator, if any.
    pub model: Option<&'a str>,
    /// The scene of the frame, if any.
    pub scene: Option<&'a SceneFile>,
    /// Reports on the textures that were converted for the frame.
    pub textures: &'a [TextureReport],
}

impl CameraArguments {
    /// Whether an option gives a camera; lens options alone do not.
    fn is_given(&self, options: &OptionArguments) -> bool {
        let is_of_host = self.look.is_some() || self.view.is_some();
        is_of_host || options.has("camera") || options.has("look-at")
    }

    /// The file of the camera, if any.
    pub fn file(&self) -> Option<&Path> {
        self.view.as_deref()
    }

    /// The camera. The lens options also apply to the camera of a scene.
    pub fn view(&self, options: &OptionArguments, shown: &CameraSubject) -> anyhow::Result<View> {
        if shown.scene.is_some() && self.up.is_some() {
            return Err(bad_value("--up", "a model", "a --scene").into());
        }
        if shown.scene.is_some() && options.has_far_plane() {
            return Err(bad_value("--projection", "no far plane with --scene", "FAR").into());
        }
        if self.is_free(options, shown) {
            let up = self.up_of(shown.model);
            let views = framed(options, shown, up, angles(1))?;
            return views.first().copied().context("expected a camera");
        }
        let (view, source) = match (&self.view, &self.look) {
            (Some(path), _) => (view::read(path)?, path.display().to_string()),
            (_, Some(text)) => {
                let view = view::look(text).map_err(|error| error.in_file("--look"))?;
                (view, "--look".to_owned())
            }
            _ if shown.scene.is_some() && !self.is_given(options) => {
                return options.camera(shown.frame.view);
            }
            _ => {
                let view = view::spherical(DEFAULT).map_err(|error| error.in_file("camera"))?;
                (view, "--look-at".to_owned())
            }
        };
        let view = options.camera(view)?;
        check_eye(&view, shown, &source)?;
        Ok(view)
    }

    /// Whether the meshes determine the camera, because no option gives one.
    fn is_free(&self, options: &OptionArguments, shown: &CameraSubject) -> bool {
        let has_meshes = shown.frame.subject.placed_meshes().next().is_some();
        has_meshes && shown.scene.is_none() && !self.is_given(options)
    }

    /// The cameras of a full turn in `steps` steps, starting with the camera of
    /// [`view`](Self::view). An automatic camera, which shows the whole model, turns around the
    /// model about the up axis; any other camera turns around the origin about z.
    pub fn turn(
        &self,
        options: &OptionArguments,
        shown: &CameraSubject,
        steps: u16,
    ) -> anyhow::Result<Vec<View>> {
        if self.is_free(options, shown) {
            return framed(options, shown, self.up_of(shown.model), angles(steps));
        }
        let fit = shown.scene.and_then(SceneFile::fit);
        match fit.filter(|_| !self.is_given(options)) {
            Some((up, angle)) => {
                let refuse = |error| no_camera("--scene", &error);
                let meshes = || shown.frame.subject.placed_meshes();
                let still = whole(meshes(), up, angles(1), angle).map_err(refuse)?;
                let mut views = whole(meshes(), up, angles(steps), angle).map_err(refuse)?;
                let first = self.view(options, shown)?;
                // Keeps a lens that was set by an option or by the scene.
                if still != [first] {
                    for view in &mut views {
                        *view = view.with_lens_of(&first);
                    }
                }
                Ok(views)
            }
            None => turn(&self.view(options, shown)?, steps),
        }
    }

    /// The up axis from the option or from the format of the model; prints a note in the second case.
    fn up_of(&self, model: Option<&str>) -> Axis {
        self.up.unwrap_or_else(|| {
            let Some((up, extension)) = model.and_then(upright) else {
                return Axis::Z;
            };
            note(format_args!(
                "{} is up, as usual in .{extension}; --up z changes it",
                up.name()
            ));
            up
        })
    }
}

/// The cameras that show all meshes, turned about the axis `up`, with the given options for the lens.
fn framed(
    options: &OptionArguments,
    shown: &CameraSubject,
    up: Axis,
    turned: impl Iterator<Item = Turns>,
) -> anyhow::Result<Vec<View>> {
    let meshes = shown.frame.subject.placed_meshes();
    let views = whole(meshes, up, turned, options.field_of_view()?);
    let name = shown.model.unwrap_or("--object");
    let views = views.map_err(|error| no_camera(name, &error))?;
    views.into_iter().map(|view| options.camera(view)).collect()
}

/// The cameras that show placed meshes, turned about the axis `up`; none without a mesh. Without a field of view, the meshes fill the
/// pictures.
pub fn whole<'a>(
    meshes: impl Iterator<Item = (Mesh<'a>, Matrix)> + Clone,
    up: Axis,
    turned: impl Iterator<Item = Turns>,
    field_of_view: Option<Turns>,
) -> Result<Vec<View>, FramingError> {
    let Some(sphere) = BoundingSphere::around(meshes.clone()) else {
        return Ok(Vec::new());
    };
    let views = turned.map(|turned| sphere.framed(up, turned, field_of_view));
    let mut views = views.collect::<Result<Vec<_>, _>>()?;
    if field_of_view.is_none() {
        framing::fill(&mut views, meshes).map_err(FramingError::View)?;
    }
    Ok(views)
}

/// The error for meshes that no camera can show completely.
fn no_camera(name: &str, error: &FramingError) -> InputError {
    bad_value(name, "a camera", error.to_string())
}

/// The angles of a full turn in `steps` steps, starting with 0.
pub fn angles(steps: u16) -> impl Iterator<Item = Turns> {
    (0..steps).map(move |step| Turns(((u64::from(step) << 32) / u64::from(steps)) as u32))
}

/// The cameras of a full turn about the z axis in `steps` steps, starting with `first`.
fn turn(first: &View, steps: u16) -> anyhow::Result<Vec<View>> {
    let turned = |angle| Ok(view::turned(first, angle).map_err(|error| error.in_file("camera"))?);
    angles(steps).map(turned).collect()
}

/// Rejects a camera that is too far away for a mesh. `source` names the option that gave the camera.
fn check_eye(view: &View, shown: &CameraSubject, source: &str) -> anyhow::Result<()> {
    let eyes = shown.frame.stereo;
    let eyes = eyes.map_or([*view; 2], |stereo| stereo.eyes(view));
    let mut eyes = eyes.iter().map(View::eye_of_middle);
    let far = eyes.find(|eye| !is_within(*eye, MAX_EYE));
    let has_mesh = shown.scene.is_none() && shown.frame.subject.meshes().next().is_some();
    if let Some(eye) = far.filter(|_| has_mesh) {
        let found = RenderError::Eye(eye).to_string();
        return Err(bad_value(source, "a camera", found).into());
    }
    Ok(())
}
