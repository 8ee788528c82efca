//! What a scene shows, as text.

use core::fmt;

use crate::models::Models;
use crate::objects::OBJECTS;
use crate::scene::Scene;
use crate::wireframe::WIREFRAME;

/// Displays what the scene shows: the name of a mesh, a field, or both.
pub struct Shown<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// The models, one of which it may show.
    pub models: &'a Models,
}

impl fmt::Display for Shown<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let (scene, model) = (self.scene, self.models.shown());
        match scene.field() {
            _ if scene.shows_wireframe() => f.write_str(WIREFRAME),
            _ if scene.shows_objects() => f.write_str(OBJECTS),
            Some(field) if scene.with_mesh() => write!(f, "{field} with {model}"),
            Some(field) => field.fmt(f),
            None => f.write_str(model),
        }
    }
}
