//! Commands that upload meshes and wireframe programs and select what the scene shows: a mesh, a field, both, or a wireframe.

use glint_core::choice::switch_name;
use glint_core::console::{DemoAction, SceneCommands};
use glint_core::feature::{GESTURE, MESH, OBJECT, UPLOAD};
use glint_core::field::Field;
use glint_core::flash::Kind;
use glint_core::scene::{blocks, commands};
use glint_core::stereo::Stereo;
use glint_core::wire::Manifest;
use glint_core::wireframe::Key;

use super::{demo, upload};
use crate::error::CommandError;
use crate::format::OrOff;
use crate::job::{Job, Outcome, Reply};
use crate::machine::Machine;
use crate::models::{MAX_MESHES, MODEL, NameError};
use crate::scenes::{BuiltIn, DEFAULT, Found, SCENES, Shows};
use crate::shapes::CUBE;

impl<'l> SceneCommands<'l> for Machine {
    fn scene(&mut self, name: Option<&'l str>) -> Outcome<'l> {
        match name {
            Some(name) => show(self, name),
            None => {
                list(self);
                Ok(Reply::Done)
            }
        }
    }

    fn load(&mut self, upload: Manifest, name: Option<&'l str>) -> Outcome<'l> {
        let (name, length) = (name.unwrap_or(MODEL), upload.length as usize);
        let accepted = if name == DEFAULT || self.library.find(name).is_some() {
            Err(NameError::Scene)
        } else {
            self.models.check_name(name)
        };
        accepted.map_err(|error| CommandError::MeshName { name, error })?;
        upload::receive(self, "load", upload)?;
        let accepted = self.models.accept(name, length);
        accepted.map_err(CommandError::Mesh)?;
        self.models.show(name);
        self.scene.set_field(None);
        self.scene.touch();
        Ok(Reply::Done)
    }

    fn models(&mut self) -> Outcome<'l> {
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
        for item in library.items().filter(|item| item.kind == Kind::Mesh) {
            let (name, bytes) = (item.name, item.length());
            terminal.print(format_args!("flash {name} bytes {bytes}\n"));
        }
        for (name, mesh) in models.uploads() {
            let (vertices, triangles, bytes) = (
                mesh.vertex_count(),
                mesh.triangle_count(),
                mesh.bytes().len(),
            );
            terminal.print(format_args!(
                "mesh {name} vertices {vertices} triangles {triangles} bytes {bytes}\n"
            ));
        }
        if let Some(program) = models.uploaded_program() {
            let (segments, bytes) = (program.segment_count(), program.bytes().len());
            terminal.print(format_args!("program segments {segments} bytes {bytes}\n"));
        }
        let (count, free) = (models.uploads().count(), models.free());
        terminal.print(format_args!(
            "uploads {count} of {MAX_MESHES}\nfree {free} bytes\n"
        ));
        Ok(Reply::Done)
    }

    fn unload(&mut self, name: &'l str) -> Outcome<'l> {
        let removed = self.models.remove(name);
        removed.map_err(|error| CommandError::Unload { name, error })?;
        // The staging memory is another one from now on, and the other uploads may have moved.
        self.replay = None;
        self.renderer.edges.clear();
        self.scene.touch();
        Ok(Reply::Done)
    }

    fn program(&mut self, upload: Option<Manifest>) -> Outcome<'l> {
        let Some(upload) = upload else {
            self.scene.show_wireframe();
            return Ok(Reply::Done);
        };
        if !UPLOAD.is_built {
            return Err(CommandError::LeftOut(UPLOAD));
        }
        upload::receive(self, "program", upload)?;
        let length = upload.length as usize;
        let accepted = self.models.accept_program(length);
        accepted.map_err(CommandError::Program)?;
        self.scene.show_wireframe();
        Ok(Reply::Done)
    }

    fn press(&mut self, key: Key, rotate: bool) -> Outcome<'l> {
        if !self.scene.shows_wireframe() {
            return Err(CommandError::NoWireframe);
        }
        if !self.scene.move_wireframe(key.step(rotate)) {
            return Err(CommandError::Reach);
        }
        Ok(Reply::After(Job::Draw))
    }

    fn field(&mut self, field: Option<Option<Field>>) -> Outcome<'l> {
        match field {
            Some(field) => self.scene.set_field(field),
            None => {
                let field = OrOff(self.scene.field());
                self.terminal.print_entry("field", &field);
            }
        }
        Ok(Reply::Done)
    }

    fn mesh(&mut self, on: Option<bool>) -> Outcome<'l> {
        match on {
            Some(on) => self.scene.set_with_mesh(on),
            None => {
                let on = switch_name(self.scene.with_mesh());
                self.terminal.print_entry("mesh", &on);
            }
        }
        Ok(Reply::Done)
    }

    fn demo(&mut self, action: Option<DemoAction>) -> Outcome<'l> {
        demo::execute(self, action)
    }

    fn stereo(&mut self, eyes: Option<Option<Stereo>>) -> Outcome<'l> {
        match eyes {
            Some(eyes) => {
                if !self.scene.set_stereo(eyes) {
                    return Err(CommandError::StereoOfWireframe);
                }
            }
            None => {
                let eyes = OrOff(self.scene.stereo());
                self.terminal.print_entry("stereo", &eyes);
            }
        }
        Ok(Reply::Done)
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
    let shows_mesh = !scene.shows_wireframe()
        && !scene.shows_objects()
        && (scene.field().is_none() || scene.with_mesh());
    let mut print = |name: &str| {
        let state = if shows_mesh && name == models.shown() {
            "shown"
        } else {
            "there"
        };
        terminal.print(format_args!("scene {name} {state}\n"));
    };
    models.built_in().for_each(&mut print);
    models.uploads().for_each(|(name, _)| print(name));
    let loaded = |name: &str| models.has_upload(name);
    for item in library.items() {
        if item.kind != Kind::Mesh || !loaded(item.name) {
            terminal.print(format_args!("scene {} flash\n", item.name));
        }
    }
    for BuiltIn { name, .. } in &SCENES {
        if matches!(library.find(name), Some(Found::BuiltIn(_))) {
            terminal.print(format_args!("scene {name} there\n"));
        }
    }
    terminal.print(format_args!("scene {DEFAULT} there\n"));
}

/// Shows the scene at start; a scene, whose lines follow on the scene at start; the first scene of a list; or a mesh.
pub fn show<'l>(machine: &mut Machine, name: &'l str) -> Outcome<'l> {
    if name == DEFAULT {
        reset(machine)?;
        return Ok(Reply::Done);
    }
    let Some(found) = machine.library.find(name) else {
        show_mesh(machine, name)?;
        return Ok(Reply::Done);
    };
    let lines = match lines(name, &found)? {
        Shows::Lines(lines) => lines,
        Shows::Scenes(list) => {
            let first = list.name(0).unwrap_or_default();
            let found = machine.library.find(first);
            match lines(first, &found.ok_or(CommandError::Scene(first))?)? {
                Shows::Lines(lines) => lines,
                // A list of lists.
                Shows::Scenes(_) => return Err(CommandError::Scene(first)),
            }
        }
    };
    prepare(machine, name, lines)?;
    reset(machine)?;
    Ok(Reply::Lines(lines))
}

/// Content of a scene or list.
///
/// # Errors
/// The flash is damaged, or this build lacks parts of the firmware.
fn lines<'l>(name: &'l str, found: &Found) -> Result<Shows, CommandError<'l>> {
    if let Found::BuiltIn(built_in) = *found
        && built_in.lacks_features().next().is_some()
    {
        return Err(CommandError::Features { built_in });
    }
    let shows = found.shows();
    shows.map_err(|error| CommandError::Flash { name, error })
}

/// Checks the lines of the scene `name` and that the gateware has its blocks, and takes its meshes from the flash.
///
/// # Errors
/// The lines cannot be executed. The shown scene stays.
fn prepare<'l>(
    machine: &mut Machine,
    name: &'l str,
    lines: &'static str,
) -> Result<(), CommandError<'l>> {
    for command in commands(lines) {
        command.map_err(|error| CommandError::Line { name, error })?;
    }
    let commands = || commands(lines).flatten().map(|(_, command)| command);
    let lacks = blocks(commands()) & !machine.identity.blocks;
    if lacks != 0 {
        return Err(CommandError::Blocks { name, lacks });
    }
    for mesh in commands().filter_map(|command| command.mesh()) {
        if !upload::from_flash(machine, mesh)? && !machine.models.has(mesh) {
            return Err(CommandError::NoMesh { name, mesh });
        }
    }
    Ok(())
}

/// Sets everything except backend and overlay as at start.
///
/// # Errors
/// The camera at start is out of range.
pub fn reset(machine: &mut Machine) -> Result<(), CommandError<'static>> {
    let Machine {
        models,
        scene,
        imu,
        gesture,
        ..
    } = machine;
    imu.set_follow(None);
    if GESTURE.is_built
        && let Some(gesture) = gesture
    {
        gesture.stop();
    }
    if OBJECT.is_built {
        let removed = models.objects_mut().remove(None);
        removed.map_err(CommandError::Object)?;
    }
    scene.reset().map_err(CommandError::View)?;
    if MESH.is_built {
        models.show(CUBE);
    }
    Ok(())
}

/// Shows a mesh: an uploaded one, one of the flash, or a built-in one.
///
/// # Errors
/// There is no such mesh, or it cannot be taken from the flash.
pub fn show_mesh<'l>(machine: &mut Machine, name: &'l str) -> Result<(), CommandError<'l>> {
    if !MESH.is_built {
        return Err(CommandError::Scene(name));
    }
    upload::from_flash(machine, name)?;
    let Machine { models, scene, .. } = machine;
    let is_other = models.show(name).ok_or(CommandError::Scene(name))?;
    scene.set_field(None);
    if is_other {
        scene.touch();
    }
    Ok(())
}
