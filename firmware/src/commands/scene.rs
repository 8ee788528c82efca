//! Commands that upload meshes, textures and wireframe programs, or select what the scene shows: a mesh, a field, both, or a wireframe.

use glint_core::block::Block;
use glint_core::console::{Command, OWN, OrbitCommands, ProgramAction, SceneCommands, Setting};
use glint_core::feature::{GESTURE, MESH};
use glint_core::flash::Kind;
use glint_core::picture::Backend;
use glint_core::wire::Manifest;
use glint_core::wireframe::Key;
use glint_scene::{Line, Name, lines};

use super::{options, upload};
use crate::arena::MAX_UPLOADS;
use crate::error::CommandError;
use crate::job::{CommandResult, Job, Orbit, Reply};
use crate::machine::Machine;
use crate::models::{MODEL, NameError, PROGRAM};
use crate::scenes::{BuiltIn, Content, DEFAULT, SCENES, SceneItem};
use crate::transfer::Purpose;

impl<'l> SceneCommands<'l> for Machine {
    fn scene(&mut self, name: Option<&'l str>) -> CommandResult<'l> {
        match name {
            Some(name) => show(self, name),
            None => {
                list(self);
                Ok(Reply::Done)
            }
        }
    }

    fn load(&mut self, upload: Manifest, name: Option<&'l str>) -> CommandResult<'l> {
        let name = upload_name(self, name.unwrap_or(MODEL))?;
        upload::begin(self, "load", Purpose::Upload(name), upload)
    }

    fn models(&mut self) -> CommandResult<'l> {
        let Self {
            terminal,
            models,
            library,
            ..
        } = self;
        terminal.print(format_args!("built-in"));
        for name in models.built_in() {
            terminal.print(format_args!(" {name}"));
        }
        terminal.print(format_args!("\n"));
        for item in library.items() {
            let kind = match item.kind {
                Kind::Mesh => "",
                Kind::Texture => "texture ",
                Kind::Program => "program ",
                Kind::Scene | Kind::List => continue,
            };
            let (name, bytes) = (item.name, item.length());
            terminal.print(format_args!("flash {kind}{name} bytes {bytes}\n"));
        }
        for (name, mesh) in models.meshes() {
            let (vertices, triangles, bytes) = (
                mesh.vertex_count(),
                mesh.triangle_count(),
                mesh.bytes().len(),
            );
            terminal.print(format_args!(
                "mesh {name} vertices {vertices} triangles {triangles} bytes {bytes}\n"
            ));
        }
        for (name, texture) in models.textures() {
            let [width, height] = texture.size_log2().map(|side| 1 << side);
            let bytes = texture.bytes().len();
            terminal.print(format_args!(
                "texture {name} size {width} {height} bytes {bytes}\n"
            ));
        }
        for (name, program) in models.programs() {
            let (segments, bytes) = (program.segment_count(), program.bytes().len());
            terminal.print(format_args!(
                "program {name} segments {segments} bytes {bytes}\n"
            ));
        }
        let (count, free) = (models.upload_count(), models.free());
        terminal.print(format_args!(
            "uploads {count} of {MAX_UPLOADS}\nfree {free} bytes\n"
        ));
        Ok(Reply::Done)
    }

    fn unload(&mut self, name: &'l str) -> CommandResult<'l> {
        let object = self.models.object_of(name, &self.scene);
        if object.is_some() || !self.models.remove(name, &mut self.scene) {
            return Err(CommandError::Unload(name, object));
        }
        // The staging memory is now at another address, and the other uploads may have moved.
        self.replay = None;
        self.renderer.edges.clear();
        Ok(Reply::Done)
    }

    fn program(&mut self, action: Option<ProgramAction<'l>>) -> CommandResult<'l> {
        let name = match action {
            Some(ProgramAction::Upload { manifest, name }) => {
                let name = upload_name(self, name.unwrap_or(PROGRAM))?;
                return upload::begin(self, "program", Purpose::Program(name), manifest);
            }
            Some(ProgramAction::Show(name)) => Some(name),
            None => None,
        };
        if let Some(name) = name {
            upload::from_flash(self, Kind::Program, name)?;
        }
        let Self {
            scene,
            renderer,
            models,
            ..
        } = self;
        scene.show_program(name, &options::board(renderer, models))?;
        Ok(Reply::Done)
    }

    fn press(&mut self, key: Key, rotate: bool) -> CommandResult<'l> {
        if self.scene.wireframe().is_none() {
            return Err(CommandError::NoWireframe);
        }
        if !self.scene.move_wireframe(key.step(rotate)) {
            return Err(CommandError::Reach);
        }
        Ok(Reply::After(Job::Draw))
    }
}

/// Checks that something can be uploaded under a name.
///
/// # Errors
/// A scene has this name, the name is a keyword, or the list of uploads is full.
fn upload_name<'l>(machine: &Machine, name: &'l str) -> Result<Name, CommandError<'l>> {
    let accepted = if name == DEFAULT || machine.library.find(name).is_some() {
        Err(NameError::Scene)
    } else if name == OWN {
        Err(NameError::Own)
    } else {
        machine.models.check_capacity(name)
    };
    accepted.map_err(|error| CommandError::UploadName(name, error))?;
    // The parser limits names to the string's capacity, so the conversion does not fail.
    Ok(Name::try_from(name).unwrap_or_default())
}

impl<'l> OrbitCommands<'l> for Machine {
    fn orbit(&mut self, frames: Option<u32>) -> CommandResult<'l> {
        let orbit = Orbit::new(self.scene.sphere, frames);
        Ok(Reply::After(Job::Orbit(orbit)))
    }
}

fn list(machine: &mut Machine) {
    let Machine {
        terminal,
        models,
        scene,
        library,
        ..
    } = machine;
    let mut print = |name: &str| {
        let state = if scene.shown_mesh() == Some(name) {
            "shown"
        } else {
            "there"
        };
        terminal.print(format_args!("scene {name} {state}\n"));
    };
    models.built_in().for_each(&mut print);
    models.meshes().for_each(|(name, _)| print(name));
    for item in library.items() {
        let is_listed = match item.kind {
            Kind::Mesh => !models.has_mesh(item.name),
            Kind::Scene | Kind::List => true,
            Kind::Texture | Kind::Program => false,
        };
        if is_listed {
            terminal.print(format_args!("scene {} flash\n", item.name));
        }
    }
    for BuiltIn { name, .. } in &SCENES {
        if matches!(library.find(name), Some(SceneItem::BuiltIn(_))) {
            terminal.print(format_args!("scene {name} there\n"));
        }
    }
    terminal.print(format_args!("scene {DEFAULT} there\n"));
}

/// Shows the default scene, a named scene, the first scene of a list, or a mesh.
///
/// # Errors
/// The scene cannot be shown; the current scene is then unchanged. If only a sensor is missing, the scene is shown without motion.
#[inline(never)]
pub fn show<'l>(machine: &mut Machine, name: &'l str) -> CommandResult<'l> {
    if name == DEFAULT {
        release_camera(machine);
        machine.scene.reset()?;
        return Ok(Reply::Done);
    }
    let Some(found) = machine.library.find(name) else {
        show_mesh(machine, name)?;
        return Ok(Reply::Done);
    };
    let lines = match content(name, &found)? {
        Content::Lines(lines) => lines,
        Content::Scenes(list) => {
            let first = list.name(0).unwrap_or_default();
            let found = machine.library.find(first);
            match content(first, &found.ok_or(CommandError::Scene(first))?)? {
                Content::Lines(lines) => lines,
                // The first item of the list is itself a list, and lists do not nest.
                Content::Scenes(_) => return Err(CommandError::Scene(first)),
            }
        }
    };
    let before = machine.scene.clone();
    let shown = show_lines(machine, name, lines);
    if shown.as_ref().is_err_and(|error| !error.is_of_sensor()) {
        machine.scene = before;
    }
    shown
}

/// The content of a scene or list.
///
/// # Errors
/// The flash is damaged, or this build lacks parts of the firmware.
fn content<'l>(name: &'l str, found: &SceneItem) -> Result<Content, CommandError<'l>> {
    if let SceneItem::BuiltIn(built_in) = *found
        && built_in.lacks_features().next().is_some()
    {
        return Err(CommandError::Features(built_in));
    }
    let content = found.content();
    content.map_err(|error| CommandError::Flash(name, error))
}

/// Resets the scene to the default scene, and executes the lines of the scene `name`. A camera motion starts when its line is executed.
///
/// # Errors
/// A line is not a scene command or fails, a mesh is missing, or the gateware lacks a block.
fn show_lines<'l>(machine: &mut Machine, name: &'l str, text: &'static str) -> CommandResult<'l> {
    let backend = machine.scene.backend;
    machine.scene.reset()?;
    // The gateware must have the blocks that draw the scene, unless the scene sets the backend.
    machine.scene.backend = Backend::Gateware;
    let (mut is_stated, mut motion) = (false, None);
    for line in lines(text) {
        let (_, line) = line.map_err(|error| CommandError::Line(name, error))?;
        if let Some(mesh) = line.mesh() {
            let is_there =
                upload::from_flash(machine, Kind::Mesh, mesh)? || machine.models.has(mesh);
            if !is_there || !MESH.is_built || !machine.models.prepare(mesh) {
                return Err(CommandError::NoMesh { name, mesh });
            }
        }
        if let Some(texture) = line.texture() {
            upload::from_flash(machine, Kind::Texture, texture)?;
        }
        if let Some(program) = line.program() {
            upload::from_flash(machine, Kind::Program, program)?;
        }
        is_stated |= matches!(line, Line::Option(Setting::Backend { .. }));
        line.apply(
            &mut machine.scene,
            &mut options::board(&machine.renderer, &mut machine.models),
        )?;
        if let Line::Motion(command) = line {
            check_blocks(machine, name, matches!(command, Command::Gesture { .. }))?;
            if motion.is_none() {
                release_camera(machine);
            }
            let started = command.execute(machine);
            if started.is_err() && !is_stated {
                // If a sensor is missing, the scene is still shown.
                machine.scene.backend = backend;
            }
            motion = Some(started?);
        }
    }
    check_blocks(machine, name, false)?;
    if !is_stated {
        machine.scene.backend = backend;
    }
    if motion.is_none() {
        release_camera(machine);
    }
    Ok(motion.unwrap_or(Reply::Done))
}

/// Checks that the gateware has the blocks that draw the scene `name`, and the gesture engine if a hand steers the camera.
fn check_blocks<'l>(
    machine: &Machine,
    name: &'l str,
    has_hand: bool,
) -> Result<(), CommandError<'l>> {
    let hand = if has_hand { Block::Gesture.bit() } else { 0 };
    match (machine.scene.blocks() | hand) & !machine.identity.blocks {
        0 => Ok(()),
        lacks => Err(CommandError::Blocks(name, lacks)),
    }
}

/// Stops all camera motion.
fn release_camera(machine: &mut Machine) {
    machine.imu.set_follow(None);
    if GESTURE.is_built
        && let Some(gesture) = &mut machine.gesture
    {
        gesture.stop();
    }
}

/// Shows an uploaded mesh, a mesh of the flash, or a built-in mesh.
///
/// # Errors
/// There is no such mesh, or it cannot be copied from the flash.
fn show_mesh<'l>(machine: &mut Machine, name: &'l str) -> Result<(), CommandError<'l>> {
    if !MESH.is_built {
        return Err(CommandError::Scene(name));
    }
    upload::from_flash(machine, Kind::Mesh, name)?;
    if !machine.models.prepare(name) {
        return Err(CommandError::Scene(name));
    }
    machine.scene.show_mesh(name);
    Ok(())
}
