//! The last picture: contents, statistics, and whether a new picture is needed.

use core::fmt;
use core::mem::{self, Discriminant};

use glint_core::colour::Winding;
use glint_program::drawn::{DrawError, Drawn};
use glint_program::gateware::Fallback;
use glint_program::marker::Marker;
use glint_scene::Scene;

use crate::models::Models;

/// A hint that most triangles of the meshes are not drawn.
#[derive(Clone, Copy)]
pub struct Hint {
    drawn: u32,
    all: u32,
}

impl Hint {
    /// Returns the hint if fewer than one in 64 triangles of the frame are drawn. Meshes with more than one triangle per four pixels of the
    /// picture get no hint, because most of their triangles are too small to cover a pixel.
    fn of(drawn: &Drawn, scene: &Scene) -> Option<Self> {
        let mesh = drawn.stats.mesh.as_ref()?;
        let culls = scene.options.cull && scene.options.winding == Winding::Mesh;
        let (drawn, all) = (mesh.drawn, mesh.triangles_in);
        let is_fine = all as usize > scene.size.pixel_count() / 4;
        (culls && !is_fine && drawn < all.div_ceil(64)).then_some(Self { drawn, all })
    }
}

impl fmt::Display for Hint {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { drawn, all } = self;
        write!(
            f,
            "{drawn} of {all} triangles are drawn, the others face away or lie outside of the picture: `cull off` draws back faces, \
             `fit` shows the whole mesh"
        )
    }
}

/// A note on a frame, for the user.
#[derive(Clone, Copy)]
pub enum Note {
    /// The CPU drew the frame in place of the gateware, for this reason.
    Fallback(Fallback),
    /// Most triangles are not drawn.
    Hint(Hint),
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Fallback(reason) => write!(f, "drawn by the soft core: {reason}"),
            Self::Hint(hint) => hint.fmt(f),
        }
    }
}

/// What a picture shows.
#[derive(PartialEq)]
struct Content {
    scene: Scene,
    /// The value of [`Models::revision`] when the picture was drawn.
    models: u32,
    marker: Option<Marker>,
}

/// The last picture, and requests for the next picture.
#[derive(Default)]
pub struct Picture {
    /// The contents of the last picture; `None` if a new picture was requested.
    content: Option<Content>,
    drawn: Option<Result<Drawn, DrawError>>,
    hint: Option<Hint>,
    /// Whether a note may be printed: set by each command that may change the picture, and cleared by a note.
    pub may_note: bool,
    /// The kind of the last printed note; `None` after a frame without a note.
    noted: Option<Discriminant<Note>>,
    /// Whether the next frame needs depth codes in memory. The gateware only writes them on request.
    pub wants_depth: bool,
    /// The marker of the hand's position, if it is drawn.
    pub marker: Option<Marker>,
}

impl Picture {
    /// Whether a new frame is needed: the last frame shows another scene or other models, or does not have requested depth codes.
    pub fn is_outdated(&self, scene: &Scene, models: &Models) -> bool {
        let lacks_depth = matches!(&self.drawn, Some(Ok(drawn)) if !drawn.has_depth);
        self.wants_depth && lacks_depth && scene.has_depths()
            || self.content.as_ref().is_none_or(|content| {
                content.marker != self.marker
                    || content.models != models.revision()
                    || content.scene != *scene
            })
    }

    /// Requests a new frame even if the scene has not changed.
    pub fn request(&mut self) {
        self.content = None;
    }

    /// Statistics of the last frame, or the error if the drawing failed; `None` before the first frame.
    pub const fn drawn(&self) -> Option<Result<Drawn, DrawError>> {
        self.drawn
    }

    /// The hint about the last frame, if most of its triangles are not drawn.
    pub const fn hint(&self) -> Option<Hint> {
        self.hint
    }

    /// The note on the last frame, if it must be printed now: at most one note after a command that may change the picture.
    pub fn take_note(&mut self) -> Option<Note> {
        let note = match self.drawn {
            Some(Ok(drawn)) => drawn.fallback().map(Note::Fallback),
            Some(Err(_)) | None => None,
        };
        let note = note.or(self.hint.map(Note::Hint));
        let kind = note.as_ref().map(mem::discriminant);
        if kind == self.noted {
            return None;
        }
        if kind.is_some() && !mem::take(&mut self.may_note) {
            return None;
        }
        self.noted = kind;
        note
    }

    /// Stores the statistics of the current scene's frame, or the error if the drawing failed.
    #[inline(never)]
    pub fn set_drawn(&mut self, drawn: Result<Drawn, DrawError>, scene: &Scene, models: &Models) {
        self.hint = drawn.as_ref().ok().and_then(|drawn| Hint::of(drawn, scene));
        self.drawn = Some(drawn);
        self.content = Some(Content {
            scene: scene.clone(),
            models: models.revision(),
            marker: self.marker,
        });
    }
}
