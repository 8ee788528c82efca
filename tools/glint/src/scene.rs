//! Frames of scene files, as the console commands of the scene make them on a board.

use crate::convert::Options;
use crate::error::{FormatError, InputError};
use crate::model;
use glint_core::appearance::Appearance;
use glint_core::camera::View;
use glint_core::colour::Shading;
use glint_core::console::{Command, ObjectAction};
use glint_core::field::Field;
use glint_core::fixed::{Q32_32, Turns};
use glint_core::light::MAX_LIGHTS;
use glint_core::mesh::Mesh;
use glint_core::object::Place;
use glint_core::picture::{Edges, Size};
use glint_core::quality::Quality;
use glint_core::shape::{MAX_BYTES, Shape};
use glint_core::stereo::Stereo;
use glint_core::wireframe::{CUBE, Motion, Program};
use glint_model::{
    Clip, FieldSubject, Frame, MeshOptions, Object, Placement, Subject, WireframeSubject,
};
use glint_scene::Scene;
use std::fmt::Display;

/// The error for a scene that no board shows, for this reason.
fn refuse(reason: impl Display) -> FormatError {
    FormatError::whole("a scene that boards can show", reason.to_string())
}

/// Settings of a frame that override those of its scene.
#[derive(Clone, Copy, Default)]
pub struct Changes {
    /// Shading of meshes.
    pub shading: Option<Shading>,
    /// Quality of the picture, with its size.
    pub quality: Option<Quality>,
    /// Size of the picture, instead of that of the quality.
    pub size: Option<Size>,
}

/// Whether boards have the mesh with this name built in.
pub fn is_shape(name: &str) -> bool {
    Shape::NAMES.contains(&name)
}

/// The mesh of a scene by its name: that of a shape which boards have built in, or of a file or generator.
///
/// # Errors
/// As [`model::load`].
pub fn mesh(name: &str) -> Result<Vec<u8>, InputError> {
    match Shape::ALL.into_iter().find(|shape| shape.name() == name) {
        Some(shape) => {
            let mut bytes = vec![0; MAX_BYTES];
            let length = shape.write(&mut bytes).unwrap_or(0);
            bytes.truncate(length);
            Ok(bytes)
        }
        None => Ok(model::load(name, Options::default())?.mesh),
    }
}

/// The state that the commands of a scene set, from the state at start on.
struct State<'s> {
    model: Option<&'s str>,
    objects: Vec<(&'s str, Place)>,
    program: bool,
    field: Option<Field>,
    stereo: Option<Stereo>,
    appearance: Appearance,
    quality: Quality,
    prepass: bool,
    edges: Option<Edges>,
    view: View,
    size: Size,
    options: MeshOptions,
}

impl<'s> State<'s> {
    fn of(scene: &'s Scene) -> Result<Self, FormatError> {
        let degrees = |degrees| Turns::from_degrees(Q32_32::const_from_int(degrees));
        let mut state = Self {
            model: None,
            objects: Vec::new(),
            program: false,
            field: None,
            stereo: None,
            appearance: Appearance::default(),
            quality: Quality::default(),
            prepass: false,
            edges: None,
            // Every scene states its camera; this one has the default field of view and near plane.
            view: View::spherical(Q32_32::lit("2.5"), degrees(40), degrees(65)).map_err(refuse)?,
            size: Size::default(),
            options: MeshOptions::default(),
        };
        for command in scene.commands() {
            state.apply(command)?;
        }
        Ok(state)
    }

    fn apply(&mut self, command: Command<'s>) -> Result<(), FormatError> {
        let appearance = &mut self.appearance;
        let lens = self.view;
        match command {
            Command::Scene { name } => self.model = name,
            Command::Object {
                action: Some(ObjectAction::Add { mesh, place }),
            } => self.objects.push((mesh, place)),
            Command::Program { .. } => self.program = true,
            Command::Field { field } => self.field = field.flatten(),
            Command::Stereo { eyes } => self.stereo = eyes.flatten(),
            Command::Prepass { on } => self.prepass = on,
            Command::Edges { edges } => self.edges = edges.flatten(),
            Command::Quality {
                quality: Some(quality),
            } => {
                (self.quality, self.size) = (quality, quality.size());
            }
            Command::Size { size } => self.size = size,
            Command::Camera { r, theta, phi } => {
                let view = View::spherical(r, theta, phi).map_err(refuse)?;
                self.view = view.with_lens_of(&lens);
            }
            Command::LookAt { view } => self.view = view.with_lens_of(&lens),
            Command::View { view } => self.view = view.unwrap_or(lens),
            Command::FieldOfView { angle } => {
                self.view = lens.with_field_of_view(angle).map_err(refuse)?
            }
            Command::Orthographic { width } => {
                self.view = lens.with_width(width).map_err(refuse)?
            }
            Command::Cull { on } => self.options.cull = on,
            Command::Clip { far } => {
                self.options.clip = far.map_or(Clip::Guard, |far| Clip::View { far });
            }
            Command::Winding { rule } => self.options.winding = rule,
            Command::Shading { shading } => {
                self.options.shading = shading.unwrap_or(self.options.shading);
            }
            Command::Material { material } => appearance.material = material.unwrap_or_default(),
            Command::Light { light } => match light.flatten() {
                Some(light) => {
                    let added = appearance.lights.push(light);
                    added.map_err(|_| refuse(format_args!("more than {MAX_LIGHTS} lights")))?;
                }
                None => appearance.lights.clear(),
            },
            Command::Ambient { colour } => appearance.ambient = colour.flatten(),
            Command::Background { background } => {
                appearance.background = background.flatten();
            }
            Command::Fog { density } => {
                appearance.fog = density.flatten().unwrap_or_default();
            }
            Command::Occlusion { on } => appearance.occlusion = on.unwrap_or_default(),
            Command::Undecided { on } => appearance.undecided = on.unwrap_or_default(),
            // The frame follows from its subject, and the model has no backends.
            _ => {}
        }
        Ok(())
    }
}

/// Names of the meshes of a scene, each once.
pub fn meshes(scene: &Scene) -> Vec<&str> {
    let mut names = Vec::new();
    for mesh in scene.commands().filter_map(|command| command.mesh()) {
        if !names.contains(&mesh) {
            names.push(mesh);
        }
    }
    names
}

/// Calls `draw` with the frame of a scene, with `changes`.
///
/// # Errors
/// A mesh cannot be read, or a setting is out of range.
pub fn draw<T>(
    scene: &Scene,
    changes: &Changes,
    draw: impl FnOnce(&Frame) -> T,
) -> Result<T, InputError> {
    let in_scene = |error: FormatError| error.in_file(scene.name());
    let mut state = State::of(scene).map_err(in_scene)?;
    state.options.shading = changes.shading.unwrap_or(state.options.shading);
    if let Some(quality) = changes.quality {
        (state.quality, state.size) = (quality, quality.size());
    }
    let options = state.options;
    let names = meshes(scene);
    let meshes = names.iter().map(|name| mesh(name));
    let meshes = meshes.collect::<Result<Vec<_>, _>>()?;
    let mesh = |name: &str| {
        let known = names.iter().position(|known| *known == name);
        let bytes = known.and_then(|known| meshes.get(known));
        let bytes = bytes.map_or(&[][..], Vec::as_slice);
        let mesh = Mesh::new_checked(bytes).map_err(|error| in_scene(refuse(error)))?;
        Ok::<_, InputError>(options.subject(mesh))
    };
    let objects = state.objects.iter().map(|(name, place)| {
        Ok(Object {
            subject: mesh(name)?,
            placement: Placement::new(place.matrix),
            colour: place.colour,
        })
    });
    let objects = objects.collect::<Result<Vec<_>, InputError>>()?;
    let field = state.field.as_ref().map(|field| FieldSubject {
        field,
        appearance: &state.appearance,
        quality: state.quality,
        prepass: state.prepass,
    });
    let model = state.model.map(mesh).transpose()?;
    let subject = match (model, field, state.edges) {
        _ if state.program => Subject::Wireframe(WireframeSubject {
            program: Program::new_checked(CUBE.as_flattened())
                .map_err(|error| in_scene(refuse(error)))?,
            pose: Motion::default().pose(),
        }),
        (None, None, _) => Subject::Objects(&objects),
        (Some(mesh), Some(field), _) => Subject::MeshInField(mesh, field),
        (None, Some(field), _) => Subject::Field(field),
        (Some(mesh), None, Some(edges)) => Subject::edges(mesh, edges),
        (Some(mesh), None, None) => Subject::Mesh(mesh),
    };
    let size = changes.size.unwrap_or(state.size);
    Ok(draw(&Frame {
        stereo: state.stereo,
        ..Frame::in_appearance(subject, state.view, size, &state.appearance)
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render;
    use glint_scene::{NAMES, built_in};

    #[test]
    fn every_scene_has_its_content() {
        let stats = |name: &str| {
            let scene = built_in(name).unwrap();
            let changes = Changes {
                size: Some(Size::W320),
                ..Changes::default()
            };
            draw(&scene, &changes, |frame| render::on_model(frame).unwrap())
                .unwrap()
                .stats
        };
        let objects = stats("objects");
        let counts = objects.triangles();
        assert_eq!(counts.triangles_in, 5 * 1024);
        assert!(counts.triangles_drawn > 2000, "{counts:?}");
        let simple = stats("simplegpu");
        let counts = simple.triangles();
        assert_eq!((counts.triangles_in, counts.triangles_culled), (6, 0));
        assert!(counts.triangles_clipped >= 3, "{counts:?}");
        let wireframe = stats("wireframe").wireframe.unwrap();
        assert_eq!((wireframe.segments, wireframe.lines), (12, 12));
        let torus = stats("mesh-in-field");
        assert!(torus.triangles().triangles_drawn > 300);
        for name in NAMES {
            let stats = stats(name);
            // The picture of a field shows more than its background.
            assert!(
                stats
                    .rays
                    .is_none_or(|rays| rays.hits * 9 > rays.rays && rays.undecided == 0),
                "{name}"
            );
        }
    }
}
