//! The subject of `glint render` and `glint orbit`: a model, a field, a model in a field, or a scene, with its camera.

use super::camera::{CameraArguments, CameraSubject};
use super::common::{PictureDefaults, SizeArguments, bad_value};
use super::convert::load;
use super::field::FieldArguments;
use super::heading;
use super::texture::{TexelArguments, load_texture};
use clap::Args;
use glint::convert::{Options, TextureOptions};
use glint::error::InputError;
use glint::model::Model;
use glint::object::Description;
use glint::scene;
use glint_core::camera::View;
use glint_core::mesh::Mesh;
use glint_core::object::{MAX_OBJECTS, Place};
use glint_core::picture::Samples;
use glint_core::texture::Texture;
use glint_scene::{Assets, Kind, Scene};
use glint_scene_file::SceneFile;
use std::path::PathBuf;

/// The subject of a picture, with its camera and size.
#[derive(Args)]
pub struct SubjectArguments {
    /// A mesh file, `-` for standard input, or a generator's name. With --field, the mesh is drawn in the field.
    pub model: Option<String>,
    /// A scene: the name of a built-in scene (`glint scene list`), a scene file (docs/scenes.md), or `-` for standard input. It
    /// sets camera, quality and size; the camera options, --quality and --size override them.
    #[arg(long, value_name = "NAME|FILE.toml", conflicts_with = "model", help_heading = heading::SUBJECT)]
    pub scene: Option<String>,
    #[command(flatten)]
    pub field: FieldArguments,
    /// Texture that replaces the texture of every textured face: a PNG, JPEG or .glt file.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["scene", "textures"], help_heading = heading::APPEARANCE)]
    texture: Option<PathBuf>,
    #[command(flatten, next_help_heading = heading::APPEARANCE)]
    texels: TexelArguments,
    #[command(flatten, next_help_heading = heading::CAMERA)]
    camera: CameraArguments,
    #[command(flatten, next_help_heading = heading::PICTURE)]
    size: SizeArguments,
}

impl SubjectArguments {
    /// Calls `draw` with the frame. `others` are objects in addition to the model; `instead` names
    /// the options that can replace the model, for an error message. `defaults` are the values of options that are not given.
    ///
    /// # Errors
    /// There is nothing to draw, a file cannot be read, or an option does not apply.
    pub fn with_frame<T>(
        &self,
        others: &[Description],
        keep_scale: bool,
        instead: &str,
        defaults: PictureDefaults,
        draw: impl FnOnce(&CameraSubject) -> anyhow::Result<T>,
    ) -> anyhow::Result<T> {
        let model = self.model.as_deref();
        if let Some(name) = &self.scene {
            self.texels.refuse("a model", "--scene")?;
            let file = super::scene::read(name)?;
            let scene = Some(&file);
            let mut changes = self.size.changes()?;
            if defaults.scene.samples == Samples::One && file.scene().fixed_samples.is_none() {
                changes.samples = changes.samples.or(Some(Samples::One));
            }
            return scene::draw(&file, &changes, |frame| {
                draw(&CameraSubject {
                    frame,
                    model,
                    scene,
                    textures: &[],
                })
            })?;
        }
        let mut scene = self.field.scene(&self.size, defaults.scene)?;
        if model.is_none() && others.is_empty() {
            self.texels.refuse("a model", "none")?;
            if self.texture.is_some() {
                return Err(bad_value("--texture", "a model", "none").into());
            }
        }
        let options = self.options(&scene, keep_scale)?;
        let texture = self.texture.as_deref();
        let texture = texture.map(|path| load_texture(path, &options.textures));
        let texture = texture.transpose()?;
        let loaded = model.map(|name| load(name, options)).transpose()?;
        let mesh = loaded.as_ref().map(|model| Mesh::new_checked(&model.mesh));
        let mesh = mesh.transpose()?;
        let models = others.iter().map(|object| load(&object.model, options));
        let models = models.collect::<anyhow::Result<Vec<_>>>()?;
        let mut shown = loaded.iter().chain(&models);
        if !self.field.options.has("shading") && shown.all(Model::is_smooth) {
            scene.options.shading = defaults.smooth_surfaces;
        }
        let colour = self.field.mesh_colour(&scene)?;
        let place = Place {
            colour,
            ..Place::default()
        };
        let model_object = mesh.filter(|_| !others.is_empty() || colour.is_some());
        let model_object = model_object.map(|mesh| scene.object(&place, mesh));
        let mut objects: Vec<_> = model_object.into_iter().collect();
        for (Description { place, .. }, model) in others.iter().zip(&models) {
            let place = Place {
                colour: place.colour.or(colour),
                ..*place
            };
            objects.push(scene.object(&place, Mesh::new_checked(&model.mesh)?));
        }
        if objects.is_empty() && mesh.is_none() && scene.field.is_none() {
            let expected =
                format!("a mesh file or a generator such as teapot, or {instead} in its place");
            return Err(bad_value("MODEL", &expected, "none").into());
        }
        if objects.len() > MAX_OBJECTS {
            let expected = format!("at most {MAX_OBJECTS} objects");
            return Err(bad_value("--object", &expected, objects.len().to_string()).into());
        }
        if !objects.is_empty() {
            scene.kind = Kind::Objects;
        }
        scene.with_mesh = mesh.is_some();
        let frame = scene.frame(Assets {
            mesh,
            objects: &objects,
            replacement_texture: match &texture {
                Some((bytes, _)) => Some(Texture::new_checked(bytes)?),
                None => None,
            },
            program: scene::built_in_program()?,
        });
        let textures = loaded.iter().chain(&models);
        let textures = textures.flat_map(Model::textures).cloned();
        let report = texture.as_ref().map(|(_, report)| report.clone());
        let textures: Vec<_> = textures.chain(report).collect();
        draw(&CameraSubject {
            frame: &frame,
            model,
            scene: None,
            textures: &textures,
        })
    }

    /// The options of the conversion of meshes for a scene.
    fn options(&self, scene: &Scene, keep_scale: bool) -> Result<Options, InputError> {
        let has_textures = scene.options.textures;
        if !has_textures {
            self.texels.refuse("textures", "--no-textures")?;
        }
        Ok(Options {
            keep_scale,
            textures: TextureOptions {
                left_out: !has_textures,
                ..self.texels.options()
            },
            ..Options::default()
        })
    }

    /// The camera of the subject, after the camera options.
    pub fn view(&self, shown: &CameraSubject) -> anyhow::Result<View> {
        self.camera.view(&self.field.options, shown)
    }

    /// The cameras of a full turn in `steps` steps, starting with the camera of
    /// [`view`](Self::view).
    pub fn turn(&self, shown: &CameraSubject, steps: u16) -> anyhow::Result<Vec<View>> {
        self.camera.turn(&self.field.options, shown, steps)
    }

    /// The files that the command reads. The list may contain names of generators.
    pub fn inputs(&self, scene: Option<&SceneFile>) -> Vec<PathBuf> {
        let names = [
            self.model.as_deref(),
            self.scene.as_deref(),
            self.field.file(),
        ];
        let names = names.into_iter().flatten().map(PathBuf::from);
        let meshes = scene.into_iter().flat_map(|scene| {
            let meshes = scene.meshes().iter();
            meshes.map(|name| scene::path(name, scene.folder()).into())
        });
        let of_scene = |name: Option<&str>| Some(scene?.folder().join(name?));
        let texture = of_scene(scene.and_then(SceneFile::texture));
        let program = of_scene(scene.and_then(SceneFile::program));
        let files = [self.texture.clone(), texture, program];
        let camera = self.camera.file().map(PathBuf::from);
        let files = files.into_iter().flatten();
        names.chain(meshes).chain(files).chain(camera).collect()
    }
}
