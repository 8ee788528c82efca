//! The command `replay`: receives a log of sensor samples, computes the attitude after each sample, and sends the
//! attitudes to the host.

use core::task::Poll;

use glint_core::feature::REPLAY;
use glint_core::orientation::log;

use crate::arena::Loan;
use crate::error::CommandError;
use crate::job::{CommandResult, Job, JobResult, Reply};
use crate::machine::Machine;
use crate::replay::Replay;

/// Number of samples between two reports of progress.
const PROGRESS: usize = 1_024;

/// Begins the replay of an uploaded log.
///
/// # Errors
/// The upload is not a log. Its memory is then given back.
pub fn begin(machine: &mut Machine, mut memory: Loan) -> CommandResult<'static> {
    let opened = log::open(memory.as_mut()).map(|(setup, records)| {
        let tracker = setup.tracker();
        Replay::new(tracker, records.len())
    });
    match opened {
        Ok(replay) => {
            machine.replay = Some(replay);
            Ok(Reply::After(Job::Replay(memory)))
        }
        Err(error) => {
            machine.give_back(memory);
            Err(CommandError::Log(error))
        }
    }
}

/// Replays the next samples of the log in `memory`.
pub fn poll(machine: &mut Machine, memory: &mut Loan) -> JobResult {
    let Machine {
        terminal,
        replay,
        uart,
        ..
    } = machine;
    let Some(replay) = replay.as_mut().filter(|_| REPLAY.is_built) else {
        return Poll::Ready(Err(CommandError::NoReplay));
    };
    replay.advance(memory.as_mut());
    if !replay.is_done() {
        // Reports progress only after all text has been sent, so that a slow serial line gets fewer reports.
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
    Poll::Ready(Ok(Reply::Done))
}

/// Begins to send the attitudes of the last replayed log, which are in the staging memory.
pub fn send<'l>(machine: &mut Machine) -> CommandResult<'l> {
    let Machine {
        terminal,
        models,
        replay,
        downloads,
        ..
    } = machine;
    let replay = replay.as_ref().filter(|replay| replay.is_done());
    let attitudes = replay.ok_or(CommandError::NoReplay)?.range();
    let mut memory = models.lend(attitudes.end).ok_or(CommandError::NoReplay)?;
    memory.narrow(attitudes);
    let transfer = downloads.send(memory, terminal);
    Ok(Reply::After(Job::Transfer(transfer)))
}
