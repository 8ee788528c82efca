//! Data in the staging memory: uploads from the host, and meshes, textures and wireframe programs of the flash.

use glint_core::feature::{DEMO, MESH, WIREFRAME};
use glint_core::flash::Kind;
use glint_core::wire::Manifest;
use glint_program::sensor;
use litex_pac::cpu;

use super::replay;
use crate::arena::Loan;
use crate::error::CommandError;
use crate::job::{CommandResult, Job, Reply};
use crate::machine::Machine;
use crate::models::PROGRAM;
use crate::transfer::{Purpose, Transfer};

/// Begins to receive the data that `manifest` announces into the staging memory. The reply has the line `ready`, or `present` if the memory
/// already contains the data. `command` is the name of the command for the upload.
///
/// # Errors
/// The upload is longer than the free memory.
pub fn begin<'l>(
    machine: &mut Machine,
    command: &'static str,
    purpose: Purpose,
    manifest: Manifest,
) -> CommandResult<'l> {
    let memory = lend(machine, command, manifest.length as usize)?;
    // A tool may have written the data directly to memory, bypassing the cache.
    cpu::flush_data_cache();
    let transfer = Transfer::upload(purpose, manifest, memory, &mut machine.terminal);
    Ok(Reply::After(Job::Transfer(transfer)))
}

/// Applies the data of a completed transfer. No frame may be in progress.
///
/// # Errors
/// The transfer has failed, or the data are not valid for the command.
pub fn finish(machine: &mut Machine, transfer: &mut Transfer) -> CommandResult<'static> {
    let Some((memory, result)) = transfer.take_result() else {
        return Ok(Reply::Done);
    };
    machine.terminal.lend(false);
    if let Err(failure) = result {
        machine.give_back(memory);
        return Err(CommandError::Transfer(failure));
    }
    let reply = match &transfer.purpose {
        Purpose::Download => {
            machine.give_back(memory);
            return Ok(Reply::Done);
        }
        Purpose::Upload(name) => {
            let accepted = machine
                .models
                .accept(name, None, memory, &mut machine.scene);
            accepted.map_err(CommandError::Upload)?;
            if machine.models.has_texture(name) {
                machine.scene.texture = Some(name.clone());
                machine.note_texture();
            } else {
                machine.scene.show_mesh(name);
            }
            Reply::Done
        }
        Purpose::Program(name) => {
            let Machine {
                models,
                scene,
                terminal,
                ..
            } = machine;
            let accepted = models.accept(name, Some(Kind::Program), memory, scene);
            accepted.map_err(CommandError::Program)?;
            scene.program = Some(name.clone()).filter(|name| name != PROGRAM);
            scene.show_wireframe();
            let mut programs = models.programs();
            let ignored = programs.find(|(known, _)| known == name);
            let ignored = ignored.map_or(0, |(_, program)| program.ignored());
            if ignored > 0 {
                terminal.print(format_args!(
                    "note: {ignored} bytes after the end are ignored\n"
                ));
            }
            Reply::Done
        }
        Purpose::Log => replay::begin(machine, memory)?,
    };
    machine.demo.stop();
    Ok(reply)
}

/// Copies the mesh, texture or wireframe program with this name from the flash to the uploads, unless an upload has this name. Returns
/// whether the item exists.
///
/// # Errors
/// The item is damaged, an upload of another kind has its name, or the free memory is too small.
pub fn from_flash<'l>(
    machine: &mut Machine,
    kind: Kind,
    name: &'l str,
) -> Result<bool, CommandError<'l>> {
    let is_built = match kind {
        Kind::Program => WIREFRAME.is_built,
        Kind::Mesh | Kind::Texture | Kind::Scene | Kind::List => MESH.is_built,
    };
    if !is_built || !DEMO.is_built {
        return Ok(false);
    }
    if machine.models.has_upload(kind, name) {
        return Ok(true);
    }
    let Some(item) = machine.library.item(kind, name) else {
        return Ok(false);
    };
    let bytes = item.checked();
    let bytes = bytes.map_err(|error| CommandError::Flash(name, error))?;
    let accepted = machine.models.check_copy(name);
    accepted.map_err(|error| CommandError::UploadName(name, error))?;
    let mut memory = lend(machine, name, bytes.len())?;
    memory.as_mut().copy_from_slice(bytes);
    let accepted = machine
        .models
        .accept(name, Some(kind), memory, &mut machine.scene);
    accepted.map_err(|error| CommandError::FlashItem(kind, name, error))?;
    // Empties the queue of sensor events, because copying and checking a large item is slow, and several items may follow.
    sensor::deliver(&mut machine.imu);
    Ok(true)
}

/// Lends `length` bytes of the staging memory for the upload `name`.
///
/// # Errors
/// The free memory is smaller.
fn lend<'l>(machine: &mut Machine, name: &'l str, length: usize) -> Result<Loan, CommandError<'l>> {
    // The upload overwrites the attitudes of an earlier replay in the staging memory.
    machine.replay.take_if(|replay| replay.is_done());
    // Uploads may move, so another mesh may get the address of the mesh in the edge list.
    machine.renderer.edges.clear();
    let memory = machine.models.lend(length);
    memory.ok_or(CommandError::TooLong {
        name,
        bytes: length,
        free: machine.models.free(),
    })
}
