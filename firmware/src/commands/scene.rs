//! Commands that upload meshes and wireframe programs and select what the scene shows: a mesh, a field, both, or a wireframe.

use glint_core::choice::switch_name;
use glint_core::console::SceneCommands;
use glint_core::field::Field;
use glint_core::image_sensor::FrameSize;
use glint_core::picture::Size;
use glint_core::stereo::Stereo;
use glint_core::wire::Manifest;
use glint_core::wireframe::Key;
use glint_model::scenes::{self, Settings};

use super::{gesture, upload};
use crate::error::CommandError;
use crate::format::OrOff;
use crate::job::{Job, Outcome, Reply};
use crate::machine::Machine;
use crate::models::{FIELDS, HOLOFORGE, MAX_MESHES, MODEL, SIMPLEGPU};
use crate::objects::OBJECTS;
use crate::wireframe::WIREFRAME;

impl<'l> SceneCommands<'l> for Machine {
    fn scene(&mut self, name: Option<&'l str>) -> Outcome<'l> {
        match name {
            Some(name) => show(self, name)?,
            None => list(self),
        }
        Ok(Reply::Done)
    }

    fn load(&mut self, upload: Manifest, name: Option<&'l str>) -> Outcome<'l> {
        let (name, length) = (name.unwrap_or(MODEL), upload.length as usize);
        let accepted = self.models.check_name(name);
        accepted.map_err(|error| CommandError::MeshName { name, error })?;
        upload::receive(self, "load", upload)?;
        let accepted = self.models.accept(name, length);
        accepted.map_err(CommandError::Mesh)?;
        self.scene.set_field(None);
        self.scene.touch();
        Ok(Reply::Done)
    }

    fn models(&mut self) -> Outcome<'l> {
        let Self {
            terminal, models, ..
        } = self;
        terminal.print(format_args!("built-in"));
        for name in models.built_in() {
            terminal.print(format_args!(" {name}"));
        }
        terminal.print(format_args!("\n"));
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

    fn program(&mut self, upload: Manifest) -> Outcome<'l> {
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
            Some(true) if self.scene.stereo().is_some() => return Err(CommandError::MeshInStereo),
            Some(on) => self.scene.set_with_mesh(on),
            None => {
                let on = switch_name(self.scene.with_mesh());
                self.terminal.print_entry("mesh", &on);
            }
        }
        Ok(Reply::Done)
    }

    fn stereo(&mut self, eyes: Option<Option<Stereo>>) -> Outcome<'l> {
        match eyes {
            Some(Some(_)) if self.scene.with_mesh() => return Err(CommandError::StereoOfMesh),
            Some(eyes) => self.scene.set_stereo(eyes),
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
        ..
    } = machine;
    let (wireframe, objects) = (scene.shows_wireframe(), scene.shows_objects());
    let instead = wireframe || objects;
    let field = scene.field();
    let mut print = |name: &str| {
        let shown = !instead && (field.is_none() || scene.with_mesh()) && name == models.shown();
        let state = if shown { "shown" } else { "there" };
        terminal.print(format_args!("scene {name} {state}\n"));
    };
    models.built_in().for_each(&mut print);
    models.uploads().for_each(|(name, _)| print(name));
    for (name, named) in FIELDS {
        let shown = !instead && field == Some(&named);
        let state = if shown { "shown" } else { "there" };
        terminal.print(format_args!("scene {name} {state}\n"));
    }
    let state = if objects { "shown" } else { "there" };
    terminal.print(format_args!(
        "scene {OBJECTS} {state}\nscene {SIMPLEGPU} there\nscene {HOLOFORGE} there\n"
    ));
    let state = if wireframe { "shown" } else { "there" };
    terminal.print(format_args!("scene {WIREFRAME} {state}\n"));
}

fn show<'l>(machine: &mut Machine, name: &'l str) -> Result<(), CommandError<'l>> {
    let Machine { models, scene, .. } = machine;
    if name == WIREFRAME {
        scene.show_wireframe();
        return Ok(());
    }
    if name == OBJECTS {
        if models.objects().all().is_empty() {
            let settings = Settings::objects().map_err(CommandError::View)?;
            for (shape, place) in scenes::objects() {
                let added = models.add_shape(shape, &place);
                added.map_err(CommandError::Object)?;
            }
            scene.set_all(&settings);
        }
        scene.show_objects();
        return Ok(());
    }
    if name == SIMPLEGPU {
        let settings = Settings::simplegpu().map_err(CommandError::View)?;
        models.show_shape(scenes::SIMPLEGPU);
        scene.set_all(&settings);
        scene.set_field(None);
        scene.touch();
        return Ok(());
    }
    if name == HOLOFORGE {
        // The uploaded mesh, or the one that was shown last.
        let is_other = models.show(MODEL).unwrap_or(false);
        scene.set_field(None);
        scene.set_size(Size::W320);
        scene.set_cull(true);
        if is_other {
            scene.touch();
        }
        let gesture = machine.gesture.as_mut().ok_or(CommandError::NoGesture)?;
        return match gesture.sensor() {
            Some(Ok(_)) => Ok(()),
            _ => gesture::start(gesture, FrameSize::Qvga),
        };
    }
    if let Some((_, field)) = FIELDS.iter().find(|(field, _)| *field == name) {
        scene.set_field(Some(*field));
        return Ok(());
    }
    let is_other = models.show(name).ok_or(CommandError::Scene(name))?;
    scene.set_field(None);
    if is_other {
        scene.touch();
    }
    Ok(())
}
