//! Rendering a mesh, a field, or a mesh in a field, by the model on this machine or by a board.

use crate::board::{Board, BoardError};
use crate::console::{self, Console, ConsoleError};
use crate::picture::Frame;
pub use crate::transfer::Route;
use crate::transfer::{self, Progress, TransferError};
use glint_core::appearance::Appearance;
use glint_core::camera::View;
use glint_core::field::Field;
use glint_core::light::Hexadecimal;
use glint_core::mesh::{Mesh, MeshError};
use glint_core::picture::Backend;
use glint_core::stereo::Stereo;
use glint_core::wire::crc32;
use glint_model::raymarch::{FieldOptions, FieldSetup, Prepass, render_field};
use glint_model::{
    DepthScale, FrameBuffer, MeshSetup, Options, Projected, RenderError, Shading, mesh_in_field,
    trace_frame,
};
use serde::{Deserialize, Serialize};

/// A mesh, and what only a mesh is told.
#[derive(Clone, Copy, Debug)]
pub struct MeshSubject<'s> {
    /// As it lies in memory.
    pub bytes: &'s [u8],
    /// Whether back faces are left out.
    pub cull: bool,
    /// Where colours come from.
    pub shading: Shading,
}

/// A distance field, and what only a field is told.
#[derive(Clone, Copy, Debug)]
pub struct FieldSubject<'s> {
    /// Which.
    pub field: &'s Field,
    /// How it looks.
    pub appearance: &'s Appearance,
    /// Two eyes, or one. There is one where a mesh is in the field.
    pub stereo: Option<Stereo>,
    /// Whether cones go before the rays, as far as faces are all there is.
    pub prepass: bool,
}

impl FieldSubject<'_> {
    fn options(&self) -> FieldOptions {
        FieldOptions {
            prepass: self.prepass.then_some(Prepass::Fitting),
            ..FieldOptions::new(self.field, self.appearance, self.stereo)
        }
    }
}

/// What is to be seen.
#[derive(Clone, Copy, Debug)]
pub enum Subject<'s> {
    /// A mesh.
    Mesh(MeshSubject<'s>),
    /// A distance field.
    Field(FieldSubject<'s>),
    /// A mesh in a distance field.
    Both(MeshSubject<'s>, FieldSubject<'s>),
}

impl<'s> Subject<'s> {
    /// A mesh in flat colours, without its back faces.
    pub const fn mesh(bytes: &'s [u8]) -> Self {
        Self::Mesh(MeshSubject {
            bytes,
            cull: true,
            shading: Shading::Flat,
        })
    }
}

/// What is to be rendered, and how.
#[derive(Clone, Debug)]
pub struct Scene<'s> {
    /// What is to be seen.
    pub subject: Subject<'s>,
    /// The camera.
    pub view: View,
    /// Width and height in pixels, one of [`glint_model::SIZES`].
    pub size: (u32, u32),
    /// Who renders on a board; the board's own choice unless told: its engine if it has one.
    pub backend: Option<Backend>,
}

/// What a frame took, as the file of `--stats` has it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Stats {
    /// Cycles of the board's clock; nothing from the model, which has no clock.
    pub cycles: Option<u64>,
    /// What was counted of a mesh.
    #[serde(flatten)]
    pub mesh: Option<TriangleCounts>,
    /// What was counted of a field.
    #[serde(flatten)]
    pub rays: Option<RayCounts>,
    /// The board's clock in Hz.
    pub clock: Option<u64>,
    /// Who rendered on a board: `cpu` or `gateware`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub backend: Option<String>,
    /// What the triangle engine counted, if it rendered.
    #[serde(flatten)]
    pub engine: Option<EngineStats>,
}

/// What was counted of a mesh's frame.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct TriangleCounts {
    /// Triangles in the mesh.
    pub triangles_in: u32,
    /// Those of them that did not reach the walker.
    pub triangles_culled: u32,
    /// Those that went through the clipper.
    pub triangles_clipped: u32,
    /// Those that reached the walker.
    pub triangles_drawn: u32,
    /// Pixels that the walker came to: an engine's comes to eight at a time.
    pub pixels_tested: u64,
    /// Pixels covered by a triangle, each as often as it is.
    pub pixels_covered: u64,
    /// Pixels written; not told of a mesh in a field, whose pixels an engine counts with them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pixels_drawn: Option<u64>,
}

/// What was counted of a field's frame.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RayCounts {
    /// Rays: one a pixel and eye.
    pub rays: u32,
    /// Evaluations of the field.
    pub evaluations: u64,
    /// Rays that came to a surface.
    pub hits: u32,
    /// Rays that went by.
    pub misses: u32,
    /// Rays that were given up.
    pub undecided: u32,
}

impl RayCounts {
    /// Evaluations of the field for a ray.
    pub fn evaluations_per_ray(&self) -> f64 {
        self.evaluations as f64 / f64::from(self.rays)
    }
}

impl Stats {
    /// What was counted of a mesh; nothing but zeros where there is none.
    pub fn triangles(&self) -> TriangleCounts {
        self.mesh.clone().unwrap_or_default()
    }
}

/// What the triangle engine counted for a frame: cycles, and words of 16 bytes.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct EngineStats {
    /// Cycles in which a pass ran.
    pub cycles_busy: u64,
    /// Cycles in which memory did not take a command.
    pub cycles_stalled: u64,
    /// Cycles in which memory did not take a read.
    pub stalled_reads: u64,
    /// Cycles in which memory did not take a write of the geometry pass.
    pub stalled_lists: u64,
    /// Cycles in which memory did not take a write of the raster pass.
    pub stalled_frame: u64,
    /// Words read from memory.
    pub words_read: u64,
    /// Words written to memory.
    pub words_written: u64,
    /// Cycles of the geometry pass.
    pub cycles_geometry: u64,
    /// Vertices transformed.
    pub vertices: u64,
    /// Cycles of the raster pass.
    pub cycles_raster: u64,
    /// Cycles in which a triangle was walked over.
    pub cycles_walking: u64,
    /// Those of them without a pixel.
    pub cycles_empty: u64,
    /// Groups of eight pixels of which some were covered.
    pub groups: u64,
    /// Cycles in which a group waited for the one before it.
    pub cycles_held: u64,
    /// Cycles in which the flush of a band waited for memory.
    pub cycles_memory: u64,
    /// Cycles in which a drawn band waited for the flush of the one before it.
    pub cycles_flush: u64,
}

/// A frame and what it took.
#[derive(Clone, Debug)]
pub struct Rendered {
    /// The frame.
    pub frame: Frame,
    /// What it took.
    pub stats: Stats,
}

/// Why there is no frame.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The mesh is damaged.
    #[error("{0}")]
    Mesh(MeshError),
    /// The model refuses.
    #[error("{0}")]
    Render(RenderError),
    /// The board cannot be talked to.
    #[error(transparent)]
    Board(#[from] BoardError),
    /// The board's console says no, or nothing.
    #[error(transparent)]
    Console(#[from] ConsoleError),
    /// An upload or a download failed.
    #[error(transparent)]
    Transfer(#[from] TransferError),
}

/// What relates a scene's depth codes to distances.
///
/// # Errors
/// The mesh is damaged or seen from too far, or the size is none of [`glint_model::SIZES`].
pub fn depth_scale(scene: &Scene) -> Result<DepthScale, Error> {
    match Constants::new(scene)? {
        Constants::Mesh(_, frame) | Constants::Both(_, frame, _) => Ok(frame.depth),
        Constants::Field(setup) => Ok(setup.world_depth),
    }
}

/// What a scene is drawn by.
enum Constants<'s> {
    Mesh(Mesh<'s>, MeshSetup),
    Field(FieldSetup),
    Both(Mesh<'s>, MeshSetup, FieldSetup),
}

impl<'s> Constants<'s> {
    fn new(scene: &Scene<'s>) -> Result<Self, Error> {
        let (view, size) = (&scene.view, scene.size);
        let checked = |mesh: MeshSubject<'s>| Mesh::new_checked(mesh.bytes).map_err(Error::Mesh);
        match scene.subject {
            Subject::Mesh(mesh) => {
                let mesh = checked(mesh)?;
                let frame = MeshSetup::new(view, size.0, size.1, mesh.radius());
                frame.map(|frame| Self::Mesh(mesh, frame))
            }
            Subject::Field(subject) => {
                FieldSetup::new(subject.field, view, size, &subject.options()).map(Self::Field)
            }
            Subject::Both(mesh, subject) => {
                let (mesh, options) = (checked(mesh)?, subject.options());
                mesh_in_field::constants(view, size, mesh.radius(), subject.field, &options)
                    .map(|(frame, setup)| Self::Both(mesh, frame, setup))
            }
        }
        .map_err(Error::Render)
    }
}

/// Renders with the model.
///
/// # Errors
/// The mesh is damaged or seen from too far or with two eyes, or the size is none of [`glint_model::SIZES`].
pub fn on_model(scene: &Scene) -> Result<Rendered, Error> {
    let (width, height) = scene.size;
    let pixels = width as usize * height as usize;
    let mut frame = Frame {
        width,
        height,
        colour: vec![0; pixels],
        depth: vec![0; pixels],
    };
    let mut target = FrameBuffer {
        width,
        height,
        colour: &mut frame.colour,
        depth: &mut frame.depth,
    };
    let (mut mesh, mut rays) = (None, None);
    let constants = Constants::new(scene)?;
    if let Subject::Mesh(subject) | Subject::Both(subject, _) = scene.subject
        && let Constants::Mesh(checked, frame) | Constants::Both(checked, frame, _) = &constants
    {
        mesh = Some(draw_mesh(&subject, checked, *frame, &mut target)?);
    }
    if let Subject::Field(subject) | Subject::Both(_, subject) = scene.subject
        && let Constants::Field(setup) | Constants::Both(_, _, setup) = &constants
    {
        rays = Some(draw_field(&subject, setup, &mut target)?);
    }
    // As boards tell it.
    if let (Some(counts), Some(_)) = (&mut mesh, &rays) {
        counts.pixels_drawn = None;
    }
    let stats = Stats {
        cycles: None,
        mesh,
        rays,
        clock: None,
        backend: None,
        engine: None,
    };
    Ok(Rendered { frame, stats })
}

fn draw_mesh(
    subject: &MeshSubject,
    mesh: &Mesh,
    frame: MeshSetup,
    target: &mut FrameBuffer,
) -> Result<TriangleCounts, Error> {
    let vertices = mesh
        .chunks()
        .map(|chunk| chunk.vertex_count())
        .max()
        .unwrap_or(0);
    let mut scratch = vec![Projected::Behind; vertices];
    let options = Options {
        cull: subject.cull,
        shading: subject.shading,
        ..Options::default()
    };
    let stats = trace_frame(mesh, frame, target, &mut scratch, &options, |_| {});
    let stats = stats.map_err(Error::Render)?;
    Ok(TriangleCounts {
        triangles_in: stats.triangles_in,
        triangles_culled: stats.culled,
        triangles_clipped: stats.clipped,
        triangles_drawn: stats.drawn,
        pixels_tested: stats.pixels_tested,
        pixels_covered: stats.pixels_covered,
        pixels_drawn: Some(stats.pixels_drawn),
    })
}

fn draw_field(
    subject: &FieldSubject,
    setup: &FieldSetup,
    target: &mut FrameBuffer,
) -> Result<RayCounts, Error> {
    let palette = subject.options().palette_for(setup);
    let stats = render_field(setup, &palette, target, &mut |_, _, _, _| {});
    let stats = stats.map_err(Error::Render)?;
    Ok(RayCounts {
        rays: stats.rays,
        evaluations: stats.evaluations,
        hits: stats.hits,
        misses: stats.misses,
        undecided: stats.undecided,
    })
}

/// A board that renders.
pub struct Renderer<'b, B: ?Sized = dyn Board> {
    console: Console<'b, B>,
    /// Uploads so far: each is to have another number than the one before.
    uploads: u8,
}

impl<'b, B: Board + ?Sized> Renderer<'b, B> {
    /// Renders on a board whose firmware runs.
    pub fn new(console: Console<'b, B>) -> Self {
        Self {
            console,
            uploads: 0,
        }
    }

    /// The board itself.
    pub fn board(&mut self) -> &mut B {
        self.console.board()
    }

    /// The board's console.
    pub fn console(&mut self) -> &mut Console<'b, B> {
        &mut self.console
    }

    /// Makes the scene the one that is shown, uploads its mesh if it has one, and waits for its frame.
    ///
    /// # Errors
    /// The firmware refuses, or the upload fails.
    pub fn show(
        &mut self,
        scene: &Scene,
        route: Route,
        progress: &mut Progress,
    ) -> Result<Stats, Error> {
        if let Some(backend) = scene.backend {
            self.console.command(&format!("backend {backend}"))?;
        }
        // Every change is drawn at once; what is cheap to draw goes first, so the mesh or the field comes last.
        self.console
            .command(&format!("size {} {}", scene.size.0, scene.size.1))?;
        self.console.command(&view_command(&scene.view))?;
        if let Subject::Mesh(mesh) | Subject::Both(mesh, _) = scene.subject {
            self.console
                .command(if mesh.cull { "cull on" } else { "cull off" })?;
            self.console.command(&format!("shading {}", mesh.shading))?;
            self.upload(mesh.bytes, route, progress)?;
        }
        if let Subject::Field(field) | Subject::Both(_, field) = scene.subject {
            let with_mesh = matches!(scene.subject, Subject::Both(..));
            for command in field_commands(&field, with_mesh) {
                self.console.command(&command)?;
            }
        }
        self.render()
    }

    /// Uploads a mesh and makes it the one that is shown.
    ///
    /// # Errors
    /// The upload fails, or there is no such route.
    pub fn upload(
        &mut self,
        mesh: &[u8],
        route: Route,
        progress: &mut Progress,
    ) -> Result<(), Error> {
        if route == Route::Memory {
            transfer::stage(&mut self.console, mesh)?;
        }
        self.uploads = self.uploads.wrapping_add(1);
        Ok(transfer::upload(
            &mut self.console,
            mesh,
            self.uploads,
            progress,
        )?)
    }

    /// Moves the camera and waits for the frame.
    ///
    /// # Errors
    /// The firmware refuses.
    pub fn look(&mut self, view: &View) -> Result<Stats, Error> {
        self.console.command(&view_command(view))?;
        self.render()
    }

    /// The colours of the last frame.
    ///
    /// # Errors
    /// The download fails, or there is no such route.
    pub fn colour(
        &mut self,
        size: (u32, u32),
        route: Route,
        progress: &mut Progress,
    ) -> Result<Vec<u16>, Error> {
        let bytes = self.frame("frame", 2, size, route, progress)?;
        Ok(bytes
            .chunks_exact(2)
            .map(|pixel| u16::from_le_bytes([pixel[0], pixel[1]]))
            .collect())
    }

    /// The depth codes of the scene that is shown.
    ///
    /// # Errors
    /// The download fails, or there is no such route.
    pub fn depth(
        &mut self,
        size: (u32, u32),
        route: Route,
        progress: &mut Progress,
    ) -> Result<Vec<u32>, Error> {
        // An engine leaves them out unless told; over the line it is told by the command.
        if route == Route::Memory {
            let lines = self.console.command("stats")?;
            if console::value::<String>("stats", &lines, "backend")? == Backend::Gateware.name() {
                self.console.command("render depth")?;
            }
        }
        let bytes = self.frame("depth", 4, size, route, progress)?;
        let word = |pixel: &[u8]| u32::from_le_bytes([pixel[0], pixel[1], pixel[2], pixel[3]]);
        Ok(bytes.chunks_exact(4).map(word).collect())
    }

    fn frame(
        &mut self,
        kind: &str,
        pixel_bytes: usize,
        (width, height): (u32, u32),
        route: Route,
        progress: &mut Progress,
    ) -> Result<Vec<u8>, Error> {
        let length = pixel_bytes * width as usize * height as usize;
        match route {
            Route::Serial => {
                let command = if kind == "depth" {
                    "frame depth"
                } else {
                    "frame"
                };
                Ok(transfer::download(
                    &mut self.console,
                    command,
                    length,
                    progress,
                )?)
            }
            Route::Memory => Ok(transfer::read_memory(&mut self.console, kind, 0, length)?),
        }
    }

    /// Has the frame drawn again, and reads what it took: lines of a key and its value.
    ///
    /// # Errors
    /// The firmware refuses.
    pub fn render(&mut self) -> Result<Stats, Error> {
        let lines = self.console.command("render")?;
        stats_of(&lines)
    }

    /// Sends a command that changes the scene, has the frame drawn once, and reads what it took.
    ///
    /// # Errors
    /// The firmware refuses.
    pub fn render_after(&mut self, command: &str) -> Result<Stats, Error> {
        // At once, so that the change is not drawn before it is asked for.
        let text = format!("{command}\rrender\r");
        self.console.board().write(text.as_bytes())?;
        self.console.reply(command)?;
        let lines = self.console.reply("render")?;
        stats_of(&lines)
    }
}

/// What a frame took, of lines of a key and its value.
fn stats_of(lines: &[String]) -> Result<Stats, Error> {
    let values = lines
        .iter()
        .filter_map(|line| line.split_once(' '))
        .map(|(key, value)| {
            let number = value.parse::<u64>().map(serde_json::Value::from);
            (key.to_owned(), number.unwrap_or_else(|_| value.into()))
        })
        .collect();
    serde_json::from_value(serde_json::Value::Object(values)).map_err(|error| {
        Error::Console(ConsoleError::Reply {
            command: "render".to_owned(),
            expected: format!("what the frame took ({error})"),
            found: lines.join(", "),
        })
    })
}

/// The console's command for a view. Its decimals are those of the fixed-point numbers, so none is rounded again.
pub fn view_command(view: &View) -> String {
    let mut command = "view".to_owned();
    let mut put = |number: &dyn std::fmt::Display| command.push_str(&format!(" {number}"));
    view.eye().iter().for_each(|c| put(c));
    for row in [view.u(), view.v(), view.n()] {
        row.iter().for_each(|c| put(c));
    }
    put(&view.half_width());
    put(&view.near());
    command
}

/// The console's commands that show a field, alone or with the mesh that is shown before. The last one has it drawn.
pub fn field_commands(subject: &FieldSubject, with_mesh: bool) -> Vec<String> {
    let Appearance {
        material,
        lights,
        ambient,
        background,
        fog,
        occlusion,
    } = subject.appearance;
    let switch = |on| if on { "on" } else { "off" };
    let ambient = ambient.map(|ambient| Hexadecimal(ambient).to_string());
    let mut commands = vec![
        // Nothing of what follows is drawn before the last.
        "field off".to_owned(),
        format!("material {}", material.name()),
        "light default".to_owned(),
    ];
    commands.extend(lights.iter().map(|light| format!("light {light}")));
    commands.extend([
        format!("ambient {}", ambient.as_deref().unwrap_or("default")),
        format!("background {}", background.name()),
        format!("fog {fog}"),
        format!("occlusion {}", switch(*occlusion)),
        // Two eyes and a mesh exclude each other.
        "stereo off".to_owned(),
        format!("mesh {}", switch(with_mesh)),
        format!("prepass {}", switch(subject.prepass)),
    ]);
    commands.extend(subject.stereo.map(|stereo| format!("stereo {stereo}")));
    commands.push(format!("field {}", subject.field));
    commands
}

/// A mesh's CRC-32 as the firmware and the wire have it.
pub fn checksum(mesh: &[u8]) -> u32 {
    crc32(mesh)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::convert;
    use crate::generate;
    use crate::view;

    #[test]
    fn the_cube_from_the_front() {
        let (mesh, _) = convert::convert(
            &generate::named("cube").unwrap(),
            convert::Options::default(),
        )
        .unwrap();
        let scene = Scene {
            subject: Subject::mesh(&mesh),
            view: view::spherical("2.5,0,90").unwrap(),
            size: (320, 180),
            backend: None,
        };
        let Rendered { frame, stats } = on_model(&scene).unwrap();
        let triangles = stats.triangles();
        assert_eq!((triangles.triangles_in, triangles.triangles_drawn), (12, 2));
        // The near side is a square at depth 2 in the middle: 0.5/2 of a half width of 0.9 at 160 pixels.
        let half = (160.0 * 0.25 / 0.9) as usize;
        let depth = |x: usize, y: usize| {
            depth_scale(&scene)
                .unwrap()
                .distance(frame.depth[y * 320 + x])
        };
        assert!((depth(160, 90).unwrap().to_num::<f64>() - 2.0).abs() < 1e-4);
        assert!(depth(160 + half - 1, 90).is_some() && depth(160 + half + 1, 90).is_none());
        assert_eq!(
            triangles.pixels_drawn.unwrap(),
            frame.depth.iter().filter(|&&code| code > 0).count() as u64
        );
    }

    #[test]
    fn a_view_survives_the_console() {
        let view = view::spherical("3.3,33.3,66.6").unwrap();
        let command = view_command(&view);
        assert!(command.len() < glint_core::console::LINE_MAX);
        let parsed = glint_core::console::Command::parse(&command).unwrap();
        assert_eq!(parsed, glint_core::console::Command::View(Some(view)));
    }
}
