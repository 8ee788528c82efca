//! The command `replay`: receives a log of sensor samples, computes the attitude after each sample, and sends the
//! attitudes to the host.

use core::task::Poll;

use glint_core::orientation::log;
use glint_core::wire::Manifest;

use super::upload;
use crate::error::CommandError;
use crate::job::{Job, JobResult, Outcome, Reply};
use crate::machine::Machine;
use crate::replay::Replay;

/// Number of samples between two reports of progress.
const PROGRESS: usize = 1_024;

/// Receives a log and begins its replay.
pub fn begin<'l>(machine: &mut Machine, manifest: Manifest) -> Outcome<'l> {
    let staged = upload::receive(machine, "replay", manifest)?;
    let (setup, records) = log::open(staged).map_err(CommandError::Log)?;
    let replay = Replay::new(setup.tracker(), records.len());
    machine.replay = Some(replay);
    Ok(Reply::After(Job::Replay))
}

/// Continues the replay of the log by a slice of its samples.
pub fn poll(machine: &mut Machine) -> JobResult {
    let Machine {
        terminal,
        models,
        replay,
        uart,
        ..
    } = machine;
    let Some(replay) = replay else {
        return Poll::Ready(Err(CommandError::NoReplay));
    };
    replay.advance(models.staging());
    if !replay.is_done() {
        // Reports only when all text has been sent: a slow line gets fewer reports.
        if replay.unreported() >= PROGRESS && uart.has_sent() {
            terminal.print_entry("replaying", &replay.report());
        }
        return Poll::Pending;
    }
    let counts = replay.counts();
    for (key, value) in [
        ("samples", replay.samples() as u64),
        ("steps", counts.steps),
        ("stale", counts.stale),
        ("gaps", counts.gaps),
        ("saturated", counts.saturated),
        ("rejected", counts.rejected),
        ("cycles_per_sample", replay.cycles_per_sample()),
    ] {
        terminal.print_entry(key, &value);
    }
    Poll::Ready(Ok(()))
}

/// Sends the attitudes that the replay of the last log has computed.
pub fn send<'l>(machine: &mut Machine) -> Outcome<'l> {
    let Machine {
        terminal,
        models,
        replay,
        downloads,
        ..
    } = machine;
    let replay = replay.as_ref().filter(|replay| replay.is_done());
    let attitudes = replay
        .ok_or(CommandError::NoReplay)?
        .records(models.staging());
    downloads
        .send(terminal, attitudes)
        .map_err(CommandError::Transfer)?;
    Ok(Reply::Done)
}
