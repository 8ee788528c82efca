//! Tasks that take turns on one processor, which sleeps when all of them wait.
//!
//! A task states what it waits for by where it returns [`Turn::Wait`], and nowhere else: the code that finds no work is the condition to
//! sleep. Two rules make this sound. A task that has worked returns [`Turn::Again`], because another one may wait for its work. An interrupt
//! since the start of a pass forbids to sleep after it, because a task whose turn was over may wait for the interrupt.

/// The end of a task's turn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turn {
    /// The task has worked, or waits for something that raises no interrupt: all tasks get another turn at once.
    Again,
    /// The task had nothing to do, and waits for an interrupt or for the work of another task.
    Wait,
}

impl Turn {
    /// The turn of a task, from whether it has worked.
    pub const fn worked(worked: bool) -> Self {
        if worked { Self::Again } else { Self::Wait }
    }
}

/// Gives each of the tasks a turn. `Wait` if all of them wait.
fn pass<T>(all: &mut T, tasks: &[fn(&mut T) -> Turn]) -> Turn {
    let mut turn = Turn::Wait;
    for task in tasks {
        if task(all) == Turn::Again {
            turn = Turn::Again;
        }
    }
    turn
}

/// Gives each of the tasks a turn, and sleeps if all of them wait. `interrupts` counts interrupts; `sleep` gets the count before the first
/// turn, and must return at once if the count is another one by then.
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

    /// Tasks that pass work on: task i does one of its items in a turn, and gives it to the task `next[i]`, if there is one.
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
            // The interrupt comes after the task has looked for work.
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
        // Each task but the last of a chain gives its work to one that is before or after it in the order of the turns.
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
