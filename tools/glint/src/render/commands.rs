//! The console commands that make a board draw a frame.

use crate::error::{FormatError, InputError};
use glint_core::appearance::Appearance;
use glint_core::camera::View;
use glint_core::colour::Rounding;
use glint_core::light::{Background, MeshLighting};
use glint_core::object::Place;
use glint_core::picture::{Samples, Size};
use glint_model::{Frame, MeshOptions, Object, Subject};
use glint_scene::{Defaults, Kind, Name, PlacedMesh, Scene};

/// Name of a frame's texture on the board.
pub const TEXTURE: &str = "texture";

/// The console command that sets the picture's size.
pub fn size_command(size: Size) -> String {
    format!("size {} {}", size.width(), size.height())
}

/// The console command that sets the samples of a pixel.
pub fn samples_command(samples: Samples) -> String {
    format!("aa {samples}")
}

/// The console command that sets a camera. Its decimal numbers are exact, so the board reads
/// identical fixed-point numbers.
pub fn view_command(view: &View) -> String {
    format!("view {view}")
}

/// The console commands that make a board draw a frame; the frame's mesh has the name `mesh` on the board, the mesh of object number
/// `n` the name `object(n)`, and the texture the name `texture`. All objects use the options of the first object. For a wireframe,
/// the commands draw the board's current program without its motion.
///
/// # Errors
/// The initial camera is out of range.
pub fn commands(
    frame: &Frame,
    mesh: &str,
    object: impl Fn(usize) -> String,
) -> Result<Vec<String>, InputError> {
    // A board has its own initial size and number of samples. Therefore the commands set both: the size below, the samples in `scene_of`.
    let start = Scene::new(Defaults {
        size: frame.size,
        ..Defaults::GATEWARE
    });
    let start = start.map_err(|error| {
        FormatError::whole("a camera", error.to_string()).in_file("scene at start")
    })?;
    let mut text = format!("scene default\n{}\n", size_command(frame.size));
    // Writing to a `String` does not fail.
    let _ = scene_of(frame, mesh, object, &start).write_lines(&start, &mut text);
    Ok(text.lines().map(str::to_owned).collect())
}

fn scene_of(frame: &Frame, mesh: &str, object: impl Fn(usize) -> String, start: &Scene) -> Scene {
    let name = |name: &str| Name::try_from(name).unwrap_or_default();
    let mut scene = Scene {
        view: frame.view,
        size: frame.size,
        fixed_samples: Some(frame.samples),
        dither: frame.rounding == Rounding::Dithered,
        stereo: frame.stereo,
        texture: frame.replacement_texture.map(|_| name(TEXTURE)),
        ..start.clone()
    };
    if let Some(options) = frame.subject.meshes().next() {
        scene.options = MeshOptions {
            cull: options.cull,
            shading: options.shading,
            clip: options.clip,
            winding: options.winding,
            textures: options.textures,
        };
        scene.appearance = appearance(frame);
    }
    if let Some(field) = frame.subject.field_part() {
        scene.field = Some(*field.field);
        scene.appearance = field.appearance.clone();
        scene.quality = field.quality;
        scene.with_mesh = frame.subject.mesh_part().is_some();
    }
    if frame.subject.mesh_part().is_some() {
        scene.mesh = name(mesh);
    }
    match frame.subject {
        Subject::Mesh(_) | Subject::Field(_) | Subject::MeshInField(..) => {}
        Subject::Edges(_, edges) => scene.edges = Some(edges),
        Subject::Objects(objects) => {
            let placed = objects.iter().enumerate();
            scene.objects = placed
                .map(
                    |(
                        number,
                        Object {
                            placement, colour, ..
                        },
                    )| {
                        let place = Place {
                            matrix: *placement.matrix(),
                            colour: *colour,
                        };
                        PlacedMesh::new(name(&object(number)), place)
                    },
                )
                .collect();
            scene.kind = Kind::Objects;
        }
        Subject::Wireframe(_) => scene.show_wireframe(),
    }
    scene
}

/// The appearance with the light, background and fog of a frame's meshes.
fn appearance(frame: &Frame) -> Appearance {
    let background = match frame.sky {
        Some(gradient) if gradient.is_fixed => Background::Gradient,
        Some(_) => Background::Sky,
        None => Background::Colour(frame.clear.to_rgb888()),
    };
    let mut appearance = Appearance {
        background: Some(background),
        fog: frame.fog,
        ..Appearance::default()
    };
    if frame.lighting != MeshLighting::CAMERA {
        appearance.ambient = Some(frame.lighting.ambient);
        // The list is empty, so it has space for the light.
        let _ = appearance.lights.push(frame.lighting.light);
    }
    appearance
}
