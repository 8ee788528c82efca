//! The time of a scene's animation.

use core::mem;

use glint_core::animation::Animation;
use glint_core::fixed::U32_32;

use crate::scene::Scene;

/// Moves a scene by its animation. Times are those of a board, in seconds, and may wrap.
#[derive(Clone, Copy, Debug, Default)]
pub struct Animator {
    animation: Animation,
    /// Time of the board at which the animation started.
    start: U32_32,
    /// Time since the start to which the scene has moved.
    last: U32_32,
}

impl Animator {
    /// Moves `scene` to its state at the time that `now` returns. An animation starts at the first call after it was set.
    /// The camera moves only with `moves_camera`.
    pub fn advance(&mut self, scene: &mut Scene, now: impl FnOnce() -> U32_32, moves_camera: bool) {
        let animation = scene.animation;
        if animation.is_off() {
            self.animation = animation;
            return;
        }
        let now = now();
        if animation != self.animation {
            *self = Self {
                animation,
                start: now,
                last: U32_32::ZERO,
            };
        }
        let time = now.wrapping_sub(self.start);
        let from = mem::replace(&mut self.last, time);
        scene.animate(from, time, moves_camera);
    }
}
