//! Cooperative tasks on one processor, which sleeps when all tasks wait.
//!
//! The code of a task that finds no work returns [`Turn::Wait`]; the condition to sleep is not repeated elsewhere. Two rules
//! prevent lost wake-ups. A task that has worked returns [`Turn::Again`], because another task may wait for the result. After an
//! interrupt during a pass over all tasks the processor does not sleep, because a task whose turn was already over may wait for
//! this interrupt.

/// Result of a task's turn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turn {
    /// The task has worked, or waits for an event without an interrupt: all tasks get another turn at once.
    Again,
    /// The task had nothing to do, and waits for an interrupt or for the work of another task.
    Wait,
}

impl Turn {
    /// The result of the turn of a task that has worked (`true`) or had no work (`false`).
    pub const fn worked(worked: bool) -> Self {
        if worked { Self::Again } else { Self::Wait }
    }
}

/// Gives each of the tasks a turn. The result is `Wait` if all tasks wait.
fn pass<T>(all: &mut T, tasks: &[fn(&mut T) -> Turn]) -> Turn {
    let mut turn = Turn::Wait;
    for task in tasks {
        if task(all) == Turn::Again {
            turn = Turn::Again;
        }
    }
    turn
}

/// Gives each of the tasks a turn, and sleeps if all tasks wait. `interrupts` returns the number of interrupts so far. `sleep`
/// receives the number that was read before the first turn, and must return at once if the number has
/// changed since.
pub fn step<T>(
    all: &mut T,
    tasks: &[fn(&mut T) -> Turn],
    interrupts: impl FnOnce() -> u32,
    sleep: impl FnOnce(u32),
) {
    let before = interrupts();
    if pass(all, tasks) == Turn::Wait {
        sleep(before);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TASKS: usize = 3;

    /// Tasks that pass on work items: in a turn task i processes one of its items, and passes the item to the task `next[i]`, if
    /// any.
    #[derive(Default)]
    struct World {
        work: [u32; TASKS],
        next: [Option<usize>; TASKS],
        turns: usize,
        /// The turn during which an interrupt brings an item to a task.
        interrupt: Option<(usize, usize)>,
        interrupts: u32,
        slept: bool,
    }

    impl World {
        fn turn(&mut self, task: usize) -> Turn {
            let has_work = self.work[task] > 0;
            if has_work {
                self.work[task] -= 1;
                if let Some(next) = self.next[task] {
                    self.work[next] += 1;
                }
            }
            // The interrupt comes after the task has checked for work.
            if let Some((_, to)) = self.interrupt.take_if(|(turn, _)| *turn == self.turns) {
                self.work[to] += 1;
                self.interrupts += 1;
            }
            self.turns += 1;
            Turn::worked(has_work)
        }
    }

    #[test]
    fn sleep_begins_only_when_no_task_has_work_left() {
        let tasks: [fn(&mut World) -> Turn; TASKS] =
            [|all| all.turn(0), |all| all.turn(1), |all| all.turn(2)];
        // Each task of a chain except the last passes its items to a task that is earlier or later in the order of the turns.
        for chain in [[0, 1, 2], [2, 1, 0], [1, 2, 0], [0, 2, 1]] {
            for first in 0..TASKS {
                for (turn, to) in (0..12).flat_map(|turn| (0..TASKS).map(move |to| (turn, to))) {
                    let mut world = World::default();
                    world.work[first] = 2;
                    world.next[chain[0]] = Some(chain[1]);
                    world.next[chain[1]] = Some(chain[2]);
                    world.interrupt = Some((turn, to));
                    while !world.slept {
                        let before = core::cell::Cell::new(None);
                        let interrupts = world.interrupts;
                        step(
                            &mut world,
                            &tasks,
                            || interrupts,
                            |at_start| before.set(Some(at_start)),
                        );
                        world.slept = before.get() == Some(world.interrupts);
                    }
                    assert_eq!(world.work, [0; TASKS], "{chain:?} {first} {turn} {to}");
                }
            }
        }
    }
}
