//! A renderer that draws frames on a board, by console commands.

use super::commands::{commands, size_command, view_command};
use super::renderer::{Error, Parts, Rendered, Renderer};
use super::stats::{Stats, stats_of};
use crate::board::{Board, Route};
use crate::console::{self, Console};
use crate::picture::Image;
use crate::scene;
use crate::transfer::{self, Progress};
use crate::wireframe::Action;
use glint_core::camera::View;
use glint_core::mesh::Mesh;
use glint_core::picture::{Backend, Size};
use glint_model::Frame;
use glint_scene_file::SceneFile;

/// A renderer that draws frames on a board.
pub struct BoardRenderer<'b, B: ?Sized = dyn Board> {
    console: Console<'b, B>,
    /// Number of uploads so far, modulo 256. It is the session number of each upload, so two successive uploads have different
    /// numbers.
    uploads: u8,
    backend: Option<Backend>,
    route: Route,
    /// The scene that is drawn instead of the subjects of frames.
    scene: Option<SceneFile>,
}

impl<'b, B: Board + ?Sized> BoardRenderer<'b, B> {
    /// Creates a renderer on a board whose firmware is running.
    pub fn new(console: Console<'b, B>) -> Self {
        Self {
            console,
            uploads: 0,
            backend: None,
            route: Route::Serial,
            scene: None,
        }
    }

    /// Sets the backend of all following frames, the soft core or the gateware; `None` leaves the choice to the board.
    #[must_use]
    pub fn with_backend(self, backend: impl Into<Option<Backend>>) -> Self {
        let backend = backend.into();
        Self { backend, ..self }
    }

    /// Draws a scene instead of the subjects of frames, with the frames' cameras and sizes; `None` draws the subjects.
    #[must_use]
    pub fn with_scene(self, scene: Option<SceneFile>) -> Self {
        Self { scene, ..self }
    }

    /// Sets the route by which [`render`](Renderer::render) transfers meshes and pictures. The default is the serial line.
    #[must_use]
    pub fn with_route(self, route: Route) -> Self {
        Self { route, ..self }
    }

    /// Sets the backend of all following frames, the soft core or the gateware; `None` leaves the choice to the board.
    pub fn set_backend(&mut self, backend: impl Into<Option<Backend>>) {
        self.backend = backend.into();
    }

    /// The board that draws the frames.
    pub fn board(&mut self) -> &mut B {
        self.console.board()
    }

    /// The board's console.
    pub fn console(&mut self) -> &mut Console<'b, B> {
        &mut self.console
    }

    /// Draws a frame on the board: uploads its meshes, if any, and waits until the frame is drawn. All objects of a frame use the
    /// options of the first object.
    ///
    /// # Errors
    /// The firmware refuses a command, or an upload fails.
    pub fn show(
        &mut self,
        frame: &Frame,
        route: Route,
        progress: &mut Progress,
    ) -> Result<Stats, Error> {
        if let Some(backend) = self.backend {
            self.console.command(&format!("backend {backend}"))?;
        }
        if let Some(scene) = self.scene.take() {
            let stats = self.show_scene(&scene, frame, route, progress);
            self.scene = Some(scene);
            return stats;
        }
        const MESH: &str = "model";
        if let Some(subject) = frame.subject.mesh_part() {
            self.upload(subject.mesh.bytes(), Some(MESH), route, progress)?;
        }
        // A mesh of several objects is uploaded once.
        let objects = frame.subject.objects().unwrap_or_default().iter();
        let objects: Vec<&Mesh> = objects.map(|object| &object.subject.mesh).collect();
        let first = |number: usize| {
            let mesh = objects.get(number);
            let first = objects.iter().position(|first| Some(first) == mesh);
            first.unwrap_or(number)
        };
        let name = |number| format!("object{}", first(number) + 1);
        for (number, mesh) in objects.iter().enumerate() {
            if first(number) == number {
                self.upload(mesh.bytes(), Some(&name(number)), route, progress)?;
            }
        }
        for line in commands(frame, MESH, name)? {
            self.console.command(&line)?;
        }
        self.redraw()
    }

    /// Draws a scene with the camera, quality and size of `frame`; commands of the scene that move the camera are left out. Each
    /// mesh that is not built into the firmware is uploaded.
    fn show_scene(
        &mut self,
        scene: &SceneFile,
        frame: &Frame,
        route: Route,
        progress: &mut Progress,
    ) -> Result<Stats, Error> {
        for name in scene.meshes() {
            if !scene::is_shape(name) {
                let mesh = scene::mesh(name)?;
                self.upload(&mesh, Some(name), route, progress)?;
            }
        }
        self.console.command("scene default")?;
        for line in scene.settings() {
            self.console.command(line)?;
        }
        let backend = self.backend.map(|backend| format!("backend {backend}"));
        let field = frame.subject.field_part();
        let quality = field.map(|field| format!("quality {}", field.quality));
        let last = backend.into_iter().chain(quality);
        let last = last.chain([size_command(frame.size), view_command(&frame.view)]);
        let last: Vec<_> = last.collect();
        self.render_after(&last.iter().map(String::as_str).collect::<Vec<_>>())
    }

    /// Draws a program of the wireframe simulator on the board in a picture of size `size`, plays a script of keys, one key per
    /// frame, and draws the last frame again.
    ///
    /// # Errors
    /// The firmware refuses the program or a key, or the upload fails.
    pub fn play(
        &mut self,
        program: &[u8],
        script: &[Action],
        size: Size,
        progress: &mut Progress,
    ) -> Result<Rendered, Error> {
        if let Some(backend) = self.backend {
            self.console.command(&format!("backend {backend}"))?;
        }
        self.console.command(&size_command(size))?;
        if self.route == Route::Memory {
            transfer::stage(&mut self.console, program)?;
        }
        self.uploads = self.uploads.wrapping_add(1);
        let (console, session) = (&mut self.console, self.uploads);
        transfer::upload_for(console, "program", program, session, progress, &mut |_| {})?;
        let mut rotate = "";
        for action in script {
            match action {
                Action::Rotate(on) => rotate = if *on { " rotate" } else { "" },
                Action::Press(key) => {
                    let command = format!("press {}{rotate}", key.name());
                    self.console.command(&command)?;
                }
            }
        }
        let stats = self.redraw()?;
        let image = Image {
            colour: self.colour(size, self.route, progress)?,
            ..Image::empty(size)
        };
        Ok(Rendered { image, stats })
    }

    /// Uploads a mesh under a name, by default `model`, and draws it.
    ///
    /// # Errors
    /// The upload fails, or the board does not offer `route`.
    pub fn upload(
        &mut self,
        mesh: &[u8],
        name: Option<&str>,
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
            name,
            self.uploads,
            progress,
        )?)
    }

    /// Moves the camera, and waits until the frame is drawn.
    ///
    /// # Errors
    /// The firmware refuses the command, or does not answer.
    pub fn look(&mut self, view: &View) -> Result<Stats, Error> {
        self.console.command(&view_command(view))?;
        self.redraw()
    }

    /// Downloads the colours of the last frame.
    ///
    /// # Errors
    /// The download fails, or the board does not offer `route`.
    pub fn colour(
        &mut self,
        size: Size,
        route: Route,
        progress: &mut Progress,
    ) -> Result<Vec<u16>, Error> {
        let bytes = self.frame("frame", 2, size, route, progress)?;
        Ok(bytes
            .chunks_exact(2)
            .map(|pixel| u16::from_le_bytes([pixel[0], pixel[1]]))
            .collect())
    }

    /// Downloads the depth codes of the current scene.
    ///
    /// # Errors
    /// The download fails, or the board does not offer `route`.
    pub fn depth(
        &mut self,
        size: Size,
        route: Route,
        progress: &mut Progress,
    ) -> Result<Vec<u32>, Error> {
        // The gateware writes depth codes only on request. Over the serial line, `frame depth` requests them; for a direct read
        // from memory, `render depth` must request them.
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
        size: Size,
        route: Route,
        progress: &mut Progress,
    ) -> Result<Vec<u8>, Error> {
        let length = pixel_bytes * size.pixel_count();
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

    /// Draws the frame again, and reads its statistics.
    ///
    /// # Errors
    /// The firmware refuses the command, or does not answer.
    pub fn redraw(&mut self) -> Result<Stats, Error> {
        let lines = self.console.command("render")?;
        Ok(stats_of(&lines)?)
    }

    /// Sends commands that change the scene, draws one frame, and reads its statistics.
    ///
    /// # Errors
    /// The firmware refuses the command, or does not answer.
    pub fn render_after(&mut self, commands: &[&str]) -> Result<Stats, Error> {
        // The commands are sent in one write, so that the board draws no frame before `render` arrives.
        let text = format!("{}\rrender\r", commands.join("\r"));
        self.console.board().write(text.as_bytes())?;
        for command in commands {
            self.console.reply(command)?;
        }
        let lines = self.console.reply("render")?;
        Ok(stats_of(&lines)?)
    }
}

impl<B: Board + ?Sized> Renderer for BoardRenderer<'_, B> {
    fn render(
        &mut self,
        frame: &Frame,
        parts: Parts,
        progress: &mut Progress,
    ) -> Result<Rendered, Error> {
        let (size, route) = (frame.size, self.route);
        let stats = self.show(frame, route, progress)?;
        let mut image = Image::empty(size);
        if parts.colour {
            image.colour = self.colour(size, route, progress)?;
        }
        if parts.depth {
            image.depth = self.depth(size, route, progress)?;
        }
        Ok(Rendered { image, stats })
    }
}
