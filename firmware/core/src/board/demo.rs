//! The demo of a board without a host: shows the scenes of a list in turn.

/// Time in milliseconds for which a scene is shown.
pub const TURN_MS: u64 = 10_000;

/// A step in the list of scenes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Move {
    /// Show the next scene; after the last scene, the first.
    Next,
    /// Show the previous scene; before the first scene, the last.
    Previous,
}

/// The current scene of a list, and the time at which it ends. Times are in milliseconds since the start.
#[derive(Clone, Copy, Debug, Default)]
pub struct Demo {
    /// Number of scenes; 0 while the demo is off.
    count: usize,
    /// Index of the current scene.
    number: usize,
    /// Whether the current scene must still be shown.
    is_due: bool,
    /// Time at which the current scene ends.
    end: u64,
    is_held: bool,
}

impl Demo {
    /// Starts with the first of `count` scenes; without scenes the demo is off.
    pub const fn start(&mut self, count: usize) {
        *self = Self {
            count,
            number: 0,
            is_due: true,
            end: 0,
            is_held: false,
        };
    }

    /// Stops the demo. The current scene remains on the screen.
    pub const fn stop(&mut self) {
        self.count = 0;
        self.is_held = false;
    }

    /// Whether the demo is on, held or not.
    pub const fn is_on(&self) -> bool {
        self.count > 0
    }

    /// Index of the current scene, from 0; `None` while the demo is off.
    pub fn number(&self) -> Option<usize> {
        self.is_on().then_some(self.number)
    }

    /// Number of scenes in the list.
    pub const fn count(&self) -> usize {
        self.count
    }

    /// Whether the demo holds the shown scene.
    pub const fn is_held(&self) -> bool {
        self.is_held
    }

    /// Starts or ends a hold of the shown scene. After a hold the scene is shown for another [`TURN_MS`].
    pub const fn hold(&mut self, now: u64, held: bool) {
        if self.is_held && !held {
            self.end = now.saturating_add(TURN_MS);
        }
        self.is_held = held;
    }

    /// Moves to another scene. A hold continues with that scene.
    pub fn go(&mut self, step: Move) {
        let last = self.count.saturating_sub(1);
        self.number = match step {
            Move::Next if self.number >= last => 0,
            Move::Next => self.number + 1,
            Move::Previous => self.number.checked_sub(1).unwrap_or(last),
        };
        self.is_due = true;
    }

    /// Whether [`poll`](Self::poll) has a scene to show.
    pub const fn is_ready(&self, now: u64) -> bool {
        self.is_on() && (self.is_due || !self.is_held && now >= self.end)
    }

    /// Index of the scene to show now; `None` if the picture need not change.
    pub fn poll(&mut self, now: u64) -> Option<usize> {
        if !self.is_ready(now) {
            return None;
        }
        if !self.is_due {
            self.go(Move::Next);
        }
        self.is_due = false;
        self.end = now.saturating_add(TURN_MS);
        Some(self.number)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn started(count: usize) -> Demo {
        let mut demo = Demo::default();
        assert!(!demo.is_on() && demo.poll(0).is_none() && demo.number().is_none());
        demo.start(count);
        demo
    }

    #[test]
    fn scenes_take_turns() {
        let mut demo = started(3);
        let mut shown = (0..10).map(|turn| demo.poll(turn * TURN_MS));
        assert!((0..10).all(|turn| shown.next().flatten() == Some(turn % 3)));
        assert_eq!(demo.poll(10 * TURN_MS - 1), None, "the scene stays");
        demo.stop();
        assert_eq!((demo.poll(u64::MAX), demo.number()), (None, None));
    }

    #[test]
    fn a_move_begins_a_turn_at_once() {
        let mut demo = started(3);
        assert_eq!(demo.poll(5), Some(0));
        demo.go(Move::Previous);
        assert_eq!(demo.poll(6), Some(2));
        demo.go(Move::Next);
        demo.go(Move::Next);
        assert_eq!((demo.poll(7), demo.poll(8)), (Some(1), None));
        assert_eq!(demo.poll(7 + TURN_MS), Some(2));
    }

    #[test]
    fn a_held_scene_stays_and_then_has_a_whole_turn() {
        let mut demo = started(2);
        assert_eq!(demo.poll(0), Some(0));
        demo.hold(1, true);
        assert_eq!(demo.poll(100 * TURN_MS), None);
        demo.go(Move::Next);
        assert_eq!(demo.poll(101 * TURN_MS), Some(1), "a hold allows moves");
        assert_eq!(demo.poll(200 * TURN_MS), None);
        demo.hold(200 * TURN_MS, false);
        assert_eq!(demo.poll(201 * TURN_MS - 1), None);
        assert_eq!(demo.poll(201 * TURN_MS), Some(0));
    }

    #[test]
    fn a_list_may_have_one_scene_or_none() {
        let mut demo = started(1);
        demo.go(Move::Previous);
        assert_eq!(demo.poll(0), Some(0));
        assert_eq!(demo.poll(TURN_MS), Some(0));
        let mut none = started(0);
        none.go(Move::Next);
        assert_eq!((none.is_on(), none.poll(u64::MAX)), (false, None));
    }
}
