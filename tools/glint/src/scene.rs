//! The built-in scenes, which the firmware has too.

use glint_core::camera::View;
use glint_core::colour::Shading;
use glint_core::mesh::Mesh;
use glint_core::picture::Size;
use glint_core::shape::{MAX_BYTES, Shape};
use glint_core::wireframe::{CUBE, Motion, Program};
use glint_model::scenes::{self, Settings};
use glint_model::{Frame, Object, Placement, Subject, WireframeSubject};

/// A built-in scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scene {
    /// The 3D accelerator: five objects with Gouraud shading and a coloured light.
    Objects,
    /// SimpleGPU: six polygons, a field of view of 150°, clipping to the view volume and winding by the screen.
    SimpleGpu,
    /// The wireframe simulator: a cube.
    Wireframe,
}

/// Reason why a scene has no frame. A test makes all frames.
pub type SceneError = Box<dyn std::error::Error + Send + Sync>;

impl Scene {
    /// All scenes.
    pub const ALL: [Self; 3] = [Self::Objects, Self::SimpleGpu, Self::Wireframe];

    /// The name on the board's console and on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Objects => "objects",
            Self::SimpleGpu => "simplegpu",
            Self::Wireframe => "wireframe",
        }
    }

    /// Calls `draw` with the frame of the scene, seen by its camera or from `view`, with the shading of the scene or with `shading`.
    ///
    /// # Errors
    /// None for the built-in scenes.
    pub fn draw<T>(
        self,
        view: Option<View>,
        shading: Option<Shading>,
        size: Size,
        draw: impl FnOnce(&Frame) -> T,
    ) -> Result<T, SceneError> {
        let mut settings = match self {
            Self::Objects | Self::Wireframe => Settings::objects()?,
            Self::SimpleGpu => Settings::simplegpu()?,
        };
        let options = &mut settings.options;
        options.shading = shading.unwrap_or(options.shading);
        let frame = |subject| Frame {
            lighting: settings.lighting,
            ..Frame::new(subject, view.unwrap_or(settings.view), size)
        };
        Ok(match self {
            Self::Objects => {
                let objects: Vec<_> = scenes::objects().collect();
                let meshes: Vec<_> = objects.iter().map(|(shape, _)| bytes(*shape)).collect();
                let objects = objects.iter().zip(&meshes).map(|((_, place), mesh)| {
                    Ok(Object {
                        subject: settings.options.subject(Mesh::new_checked(mesh)?),
                        placement: Placement::new(place.matrix),
                        colour: place.colour,
                    })
                });
                let objects = objects.collect::<Result<Vec<_>, SceneError>>()?;
                draw(&frame(Subject::Objects(&objects)))
            }
            Self::SimpleGpu => {
                let mesh = bytes(scenes::SIMPLEGPU);
                let subject = settings.options.subject(Mesh::new_checked(&mesh)?);
                draw(&frame(Subject::Mesh(subject)))
            }
            Self::Wireframe => {
                let program = Program::new_checked(CUBE.as_flattened())?;
                let pose = Motion::default().pose();
                draw(&frame(Subject::Wireframe(WireframeSubject {
                    program,
                    pose,
                })))
            }
        })
    }
}

/// The mesh of a shape; empty if it were longer than every shape.
fn bytes(shape: Shape) -> Vec<u8> {
    let mut bytes = vec![0; MAX_BYTES];
    let length = shape.write(&mut bytes).unwrap_or(0);
    bytes.truncate(length);
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render;

    #[test]
    fn every_scene_has_its_content() {
        let stats = |scene: Scene| {
            let drawn = scene.draw(None, None, Size::W320, |frame| {
                render::on_model(frame).unwrap()
            });
            drawn.unwrap().stats
        };
        let objects = stats(Scene::Objects);
        let counts = objects.triangles();
        assert_eq!(counts.triangles_in, 5 * 1024);
        assert!(counts.triangles_drawn > 2000, "{counts:?}");
        let simple = stats(Scene::SimpleGpu);
        let counts = simple.triangles();
        assert_eq!((counts.triangles_in, counts.triangles_culled), (6, 0));
        assert!(counts.triangles_clipped >= 3, "{counts:?}");
        let wireframe = stats(Scene::Wireframe).wireframe.unwrap();
        assert_eq!((wireframe.segments, wireframe.lines), (12, 12));
    }
}
