//! Data for the staging memory: uploads of the host, and meshes of the flash.

use glint_core::feature::{DEMO, MESH};
use glint_core::wire::{Manifest, crc32};
use litex_pac::cpu;

use crate::error::CommandError;
use crate::machine::Machine;
use crate::models::Models;
use crate::renderer::Renderer;
use crate::replay::Replay;
use crate::transfer;

/// Receives the data that `manifest` announces into the staging memory, unless the memory already holds them, which the reply says
/// with the line `present`. `command` is the name of the command that uploads them.
///
/// # Errors
/// The upload is longer than the free memory, or the transfer fails.
pub fn receive<'m>(
    machine: &'m mut Machine,
    command: &'static str,
    manifest: Manifest,
) -> Result<&'m mut [u8], CommandError<'static>> {
    let Machine {
        terminal,
        models,
        renderer,
        replay,
        clock,
        uart,
        ..
    } = machine;
    let staging = staging(models, renderer, replay, command, manifest.length as usize)?;
    // The memory may hold the data already: a tool may have written it directly, bypassing the cache, or a transfer may
    // have been interrupted near its end.
    cpu::flush_data_cache();
    if crc32(staging) == manifest.crc32 {
        terminal.print(format_args!("present\n"));
    } else {
        terminal.print(format_args!("ready\n"));
        transfer::receive(uart, *clock, staging, manifest).map_err(CommandError::Transfer)?;
    }
    Ok(staging)
}

/// Copies the mesh of this name from the flash to the uploads, unless an upload has the name. Returns whether there is such a mesh.
///
/// # Errors
/// The mesh is damaged, or there is no room for it.
pub fn from_flash<'l>(machine: &mut Machine, name: &'l str) -> Result<bool, CommandError<'l>> {
    if !MESH.is_built || !DEMO.is_built {
        return Ok(false);
    }
    let Machine {
        models,
        renderer,
        replay,
        library,
        ..
    } = machine;
    if models.has_upload(name) {
        return Ok(true);
    }
    let Some(item) = library.mesh(name) else {
        return Ok(false);
    };
    let bytes = item.checked();
    let bytes = bytes.map_err(|error| CommandError::Flash { name, error })?;
    let accepted = models.check_name(name);
    accepted.map_err(|error| CommandError::MeshName { name, error })?;
    staging(models, renderer, replay, name, bytes.len())?.copy_from_slice(bytes);
    let accepted = models.accept(name, bytes.len());
    accepted.map_err(|error| CommandError::FlashMesh { name, error })?;
    Ok(true)
}

/// The staging memory for `length` bytes of the upload `name`.
///
/// # Errors
/// The free memory is shorter.
fn staging<'m, 'l>(
    models: &'m mut Models,
    renderer: &mut Renderer,
    replay: &mut Option<Replay>,
    name: &'l str,
    length: usize,
) -> Result<&'m mut [u8], CommandError<'l>> {
    // The upload overwrites the attitudes that an earlier replay has left in the staging memory.
    *replay = None;
    // Uploads may move, and another mesh may come to the place of the one whose edges the list has.
    renderer.edges.clear();
    let free = models.free();
    let staging = models.staging_of(length);
    staging.ok_or(CommandError::TooLong {
        name,
        bytes: length,
        free,
    })
}
