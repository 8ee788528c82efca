//! Reception of the data that the host uploads with a command.

use glint_core::wire::{Manifest, crc32};
use litex_pac::cpu;

use crate::error::CommandError;
use crate::machine::Machine;
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
    // The upload overwrites the attitudes that an earlier replay has left in the staging memory.
    *replay = None;
    // Uploads may move, and another mesh may come to the place of the one whose edges the list has.
    renderer.edges.clear();
    let length = manifest.length as usize;
    let free = models.free();
    let staging = models.staging_of(length).ok_or(CommandError::TooLong {
        command,
        bytes: manifest.length,
        free,
    })?;
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
