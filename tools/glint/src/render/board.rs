//! A renderer that draws frames on a board, by console commands.

use super::commands::{TEXTURE, commands, samples_command, size_command, view_command};
use super::rendered::{Error, Parts, Rendered};
use super::stats::{Stats, stats_of};
use crate::board::{Board, Route};
use crate::console::Console;
use crate::picture::Image;
use crate::scene;
use crate::transfer;
use crate::wireframe::Action;
use glint_core::camera::View;
use glint_core::mesh::Mesh;
use glint_core::picture::{Backend, Samples, Size};
use glint_model::{Frame, Subject};
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
    progress: Box<dyn FnMut(u64, u64) + 'b>,
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
            progress: Box::new(|_, _| {}),
        }
    }

    /// Sets the backend of all following frames, the soft core or the gateware; `None` leaves the choice to the board.
    #[must_use]
    pub fn with_backend(mut self, backend: impl Into<Option<Backend>>) -> Self {
        self.set_backend(backend);
        self
    }

    /// Draws a scene instead of the subjects of frames, with the frames' cameras and sizes; `None` draws the subjects.
    #[must_use]
    pub fn with_scene(self, scene: Option<SceneFile>) -> Self {
        Self { scene, ..self }
    }

    /// Sets the route of meshes and pictures. The default is the serial line.
    #[must_use]
    pub fn with_route(self, route: Route) -> Self {
        Self { route, ..self }
    }

    /// Calls `progress` with the number of transferred bytes and the total number of bytes of each transfer.
    #[must_use]
    pub fn with_progress(self, progress: impl FnMut(u64, u64) + 'b) -> Self {
        let progress = Box::new(progress);
        Self { progress, ..self }
    }

    /// Sets the backend of all following frames, like [`with_backend`](Self::with_backend).
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

    /// Draws a frame on the board: uploads its meshes and its replacement texture, if any, and waits until the frame is drawn. All objects of a
    /// frame use the options of the first object.
    ///
    /// # Errors
    /// The firmware refuses a command, or an upload fails.
    pub fn show(&mut self, frame: &Frame) -> Result<Stats, Error> {
        Ok(self.render(frame, Parts::NONE)?.stats)
    }

    /// Shows a frame on the board, as [`show`](Self::show), and downloads parts of it.
    ///
    /// # Errors
    /// The firmware refuses a command, or a transfer fails.
    pub fn render(&mut self, frame: &Frame, parts: Parts) -> Result<Rendered, Error> {
        let backend = self.backend.map(|backend| format!("backend {backend}"));
        // The board draws during uploads. In a larger size the soft core would need more time for this.
        let size = [size_command(frame.size), samples_command(frame.samples)];
        for command in size.iter().chain(&backend) {
            self.console.command(command)?;
        }
        let mut lines = match self.scene.clone() {
            Some(scene) => self.load_scene(&scene, frame)?,
            None => self.load_subject(frame)?,
        };
        // The scene may set another backend.
        lines.extend(backend);
        self.render_after(&lines, frame.size, parts)
    }

    /// Uploads the meshes and the replacement texture of a frame, and returns the commands that show it.
    fn load_subject(&mut self, frame: &Frame) -> Result<Vec<String>, Error> {
        const MESH: &str = "model";
        if let Some(subject) = frame.subject.mesh_part() {
            self.upload(subject.mesh.bytes(), Some(MESH))?;
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
                self.upload(mesh.bytes(), Some(&name(number)))?;
            }
        }
        if let Some(texture) = frame.replacement_texture {
            self.upload(texture.bytes(), Some(TEXTURE))?;
        }
        Ok(commands(frame, MESH, name)?)
    }

    /// Uploads the meshes of a scene that are not built into the firmware, its texture and its wireframe program. Returns the commands that show the scene
    /// with camera, quality, size and samples of `frame`, without motion.
    fn load_scene(&mut self, scene: &SceneFile, frame: &Frame) -> Result<Vec<String>, Error> {
        for name in scene.meshes() {
            if !scene::is_shape(name) {
                self.upload(&scene::mesh(name, scene.folder())?, Some(name))?;
            }
        }
        if let Some(name) = scene.texture() {
            self.upload(&scene::texture(name, scene.folder())?, Some(name))?;
        }
        if let Some(name) = scene.program() {
            self.upload_program(&scene::program(name, scene.folder())?, Some(name))?;
        }
        let mut lines = vec!["scene default".to_owned()];
        // The frame already has the camera that shows all meshes, and shows the start of an
        // animation.
        let is_left_out = |line: &String| {
            ["fit ", "animate "]
                .iter()
                .any(|name| line.starts_with(name))
        };
        let settings = scene.settings().iter();
        lines.extend(settings.filter(|line| !is_left_out(line)).cloned());
        let field = frame.subject.field_part();
        lines.extend(field.map(|field| format!("quality {}", field.quality)));
        lines.push(size_command(frame.size));
        lines.push(samples_command(frame.samples));
        // A wireframe program contains its eye, and a firmware for wireframes has no camera
        // commands.
        if !matches!(frame.subject, Subject::Wireframe(_)) {
            lines.push(view_command(&frame.view));
        }
        Ok(lines)
    }

    /// Draws a program of the wireframe simulator on the board in a picture of size `size` with `samples` samples a pixel, plays a script of
    /// keys, one key per frame, and draws the last frame again.
    ///
    /// # Errors
    /// The firmware refuses the program or a key, or the upload fails.
    pub fn play(
        &mut self,
        program: &[u8],
        script: &[Action],
        size: Size,
        samples: Samples,
    ) -> Result<Rendered, Error> {
        if let Some(backend) = self.backend {
            self.console.command(&format!("backend {backend}"))?;
        }
        self.console.command(&size_command(size))?;
        self.console.command(&samples_command(samples))?;
        self.upload_program(program, None)?;
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
        let image = self.image(size)?;
        Ok(Rendered { image, stats })
    }

    /// Uploads a mesh or a texture under a name, by default `model`, and draws it. Returns the notes of the board.
    ///
    /// # Errors
    /// The upload fails, or the board does not offer the route.
    pub fn upload(&mut self, bytes: &[u8], name: Option<&str>) -> Result<Vec<String>, Error> {
        let session = self.stage(bytes)?;
        let (console, progress) = (&mut self.console, &mut *self.progress);
        Ok(transfer::upload(console, bytes, name, session, progress)?)
    }

    /// Uploads a wireframe program under a name, by default `program`, and draws it. Returns the notes of the board.
    ///
    /// # Errors
    /// As for [`upload`](Self::upload).
    pub fn upload_program(
        &mut self,
        bytes: &[u8],
        name: Option<&str>,
    ) -> Result<Vec<String>, Error> {
        let session = self.stage(bytes)?;
        let (console, progress) = (&mut self.console, &mut *self.progress);
        Ok(transfer::upload_program(
            console, bytes, name, session, progress,
        )?)
    }

    /// Writes the data of an upload to the board's memory, if the route is the memory. Returns the
    /// number of the upload.
    fn stage(&mut self, data: &[u8]) -> Result<u8, Error> {
        if self.route == Route::Memory {
            transfer::stage(&mut self.console, data)?;
        }
        self.uploads = self.uploads.wrapping_add(1);
        Ok(self.uploads)
    }

    /// Moves the camera, and waits until the frame is drawn.
    ///
    /// # Errors
    /// The firmware refuses the command, or does not answer.
    pub fn look(&mut self, view: &View) -> Result<Stats, Error> {
        self.console.command(&view_command(view))?;
        self.redraw()
    }

    /// Downloads the colours of the last frame as an image without depths.
    ///
    /// # Errors
    /// As for [`colour`](Self::colour).
    pub fn image(&mut self, size: Size) -> Result<Image, Error> {
        Ok(Image {
            colour: self.colour(size)?,
            ..Image::empty(size)
        })
    }

    /// Downloads the colours of the last frame.
    ///
    /// # Errors
    /// The download fails, or the board does not offer the route.
    pub fn colour(&mut self, size: Size) -> Result<Vec<u16>, Error> {
        let bytes = self.download("frame", "frame", 2 * size.pixel_count())?;
        let pixels = bytes.as_chunks().0.iter();
        Ok(pixels.map(|pixel| u16::from_le_bytes(*pixel)).collect())
    }

    /// Downloads a part of the frame: through the memory from the address that `info` prints for
    /// `key`, or over the line by `command`.
    fn download(&mut self, key: &str, command: &str, length: usize) -> Result<Vec<u8>, Error> {
        let (console, progress) = (&mut self.console, &mut *self.progress);
        Ok(match self.route {
            Route::Serial => transfer::download(console, command, length, progress)?,
            Route::Memory => transfer::read_memory(console, key, 0, length)?,
        })
    }

    /// Draws the frame again, and reads its statistics.
    ///
    /// # Errors
    /// The firmware refuses the command, or does not answer.
    pub fn redraw(&mut self) -> Result<Stats, Error> {
        let lines = self.console.command("render")?;
        Ok(stats_of(&lines)?)
    }

    /// Sends commands that change the scene, draws one frame of the size `size`, and downloads the
    /// requested parts of it.
    ///
    /// # Errors
    /// The firmware refuses a command or does not answer, or a download fails.
    pub fn render_after(
        &mut self,
        commands: &[String],
        size: Size,
        parts: Parts,
    ) -> Result<Rendered, Error> {
        // The commands are sent in one write, so that the board draws no frame before `render` arrives.
        let lines = commands.iter().map(String::as_str).chain(["render"]);
        let text: String = lines.flat_map(|line| [line, "\r"]).collect();
        self.console.board().write(text.as_bytes())?;
        for command in commands {
            self.console.reply(command)?;
        }
        let stats = stats_of(&self.console.reply("render")?)?;
        let mut image = Image::empty(size);
        if parts.colour {
            image.colour = self.colour(size)?;
        }
        if parts.depth {
            // The gateware writes depth codes only on request. Over the serial line, `frame depth` requests them.
            if self.route == Route::Memory {
                self.console.command("render depth")?;
            }
            let bytes = self.download("depth", "frame depth", 4 * size.pixel_count())?;
            let words = bytes.as_chunks().0.iter();
            image.depth = words.map(|word| u32::from_le_bytes(*word)).collect();
        }
        Ok(Rendered { image, stats })
    }
}
