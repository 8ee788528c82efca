//! Control of the camera by the hand: presence of the hand, filters, hold and return.

use core::fmt;

use super::blob::{Blob, Doubt, LEAST_CONFIDENCE, Region, Statistics};
use super::filter::{Backlash, OneEuro, TimeStep, Tuning, low_pass_gain, towards};
use super::target::{DISTANCES, POLARS, target};
use crate::camera::{View, ViewError};
use crate::fixed::{Q4_28, Q32_32, Turns, U16_16, U20_12};

/// Smallest run of pixels that the engine counts in the whole frame. With 5 % of noise pixels, one of 1,000 frames of 320×240 has
/// a noise run of this length.
pub const RUN_SEARCHING: u8 = 6;
/// Smallest run that counts in the region around a hand in motion. This run is shorter, because the region contains less noise than the
/// whole frame, and because narrow parts of the hand must count.
pub const RUN_MOVING: u8 = 4;
/// Smallest run that counts in the smaller region around a hand at rest, so that fingertips 5 pixels wide count.
pub const RUN_RESTING: u8 = 3;
/// Time in µs for which only the region of a lost hand is searched. Afterwards the whole frame is searched. This time is
/// also the longest pause between two frames after which tracking continues.
pub const PATIENCE: u32 = 250_000;
/// Number of successive frames that must show a hand before it moves the camera.
const FRAMES: u8 = 3;

/// Filter parameters for azimuth and polar angle, in turns.
pub const ANGLE: Tuning = Tuning {
    cutoff: U16_16::lit("1"),
    slope: U16_16::lit("120"),
    speed_cutoff: U16_16::lit("4"),
};
/// Filter parameters for the distance, in world units. The whole range is 3 units, so the slope is smaller than for the angles.
pub const DISTANCE: Tuning = Tuning {
    cutoff: U16_16::lit("1"),
    slope: U16_16::lit("8"),
    speed_cutoff: U16_16::lit("2"),
};
/// Filter parameters and dead zones of azimuth, polar angle and distance. The zones are 0.06° and 1/256 world unit.
pub const CHANNELS: [(Tuning, Q4_28); 3] = [
    (ANGLE, Q4_28::lit("0.000166")),
    (ANGLE, Q4_28::lit("0.000166")),
    (DISTANCE, Q4_28::lit("0.00390625")),
];
/// Corner frequency in Hz of both low passes that fade the offset after a hand returns; the time constant is 0.16 s.
const RETURN: U16_16 = U16_16::lit("1");

/// A position of the camera on a sphere about the origin, for [`View::spherical`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pose {
    /// Azimuth, about the z axis.
    pub theta: Turns,
    /// Polar angle, at least [`POLE`](super::POLE) away from 0 and from half a turn.
    pub phi: Turns,
    /// Distance from the origin in world units, in [2, 5].
    pub r: Q32_32,
}

impl Pose {
    /// Makes the camera at this position.
    ///
    /// # Errors
    /// A number is out of range, which does not occur for values from a [`Control`].
    pub fn view(&self) -> Result<View, ViewError> {
        View::spherical(self.r, self.theta, self.phi)
    }
}

/// Whether a hand steers the camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Presence {
    /// No hand: the whole frame is searched, and the camera does not move.
    Absent,
    /// A hand was seen in one or two frames; the camera does not move.
    Appearing,
    /// The hand steers the camera.
    Tracked,
    /// The hand was lost recently, and its region is searched; the camera does not move.
    Held,
}

impl fmt::Display for Presence {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            Self::Absent => "absent",
            Self::Appearing => "appearing",
            Self::Tracked => "tracked",
            Self::Held => "held",
        })
    }
}

/// Settings of the engine for the next frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EngineSetting {
    /// Region of the frame; pixels outside do not count.
    pub region: Region,
    /// Minimum run: shorter runs of pixels in a line do not count.
    pub least_run: u8,
}

impl EngineSetting {
    /// The setting that searches the whole frame.
    pub const SEARCHING: Self = Self {
        region: Region::WHOLE,
        least_run: RUN_SEARCHING,
    };

    /// The setting around a hand in motion with the given bounds. The margin on each side is an eighth of the frame, the path of
    /// a fast hand in two frames.
    pub const fn moving(bounds: &Region, size: [u16; 2]) -> Self {
        Self {
            region: bounds.grown([size[0] / 8, size[1] / 8]),
            least_run: RUN_MOVING,
        }
    }

    /// The setting around a hand at rest, which may begin to move: the margin is a thirty-second of the frame. A larger region
    /// would contain a noise run in most frames, which would enlarge the bounds and therefore the next region.
    pub const fn resting(bounds: &Region, size: [u16; 2]) -> Self {
        Self {
            region: bounds.grown([size[0] / 32, size[1] / 32]),
            least_run: RUN_RESTING,
        }
    }
}

/// Area and position of the hand in the last frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Last {
    /// Number of the hand's pixels; 0 if the frame was counted with a larger minimum run.
    count: u32,
    /// Coordinates x and y of the hand's centre.
    centre: [U20_12; 2],
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    Absent,
    /// The hand of the last frame, and the number of successive frames with this hand.
    Appearing(Blob, u8),
    /// The hand of the last frame.
    Tracked(Last),
    /// Number of the hand's pixels in the last frame that showed the hand, 0 if unknown, and the time in µs since the first
    /// frame without the hand.
    Held(u32, u32),
}

/// Filters of one controlled value: azimuth, polar angle or distance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Channel {
    filter: OneEuro,
    zone: Backlash,
    /// Remaining offset from the hand's new position to the camera's held position. The offset fades through two low passes in
    /// series, so that the camera also starts smoothly.
    offsets: [Q4_28; 2],
    output: Q4_28,
}

impl Channel {
    const fn at(output: Q4_28) -> Self {
        Self {
            filter: OneEuro::new(output),
            zone: Backlash::new(output),
            offsets: [Q4_28::ZERO; 2],
            output,
        }
    }

    /// Filters the target with the gain `speed` of the low pass for the speed, and lets the offsets fade with the gain `back`. A
    /// single function for all channels, because the instruction cache is small.
    #[inline(never)]
    fn steer(
        &mut self,
        target: Q4_28,
        (tuning, zone): &(Tuning, Q4_28),
        step: TimeStep,
        [speed, back]: [u32; 2],
    ) {
        let filtered = self.filter.next_with(target, tuning, step, speed);
        let [first, second] = self.offsets.map(Q4_28::to_bits);
        let first = towards(first, 0, back);
        let second = towards(second, first, back);
        self.offsets = [first, second].map(Q4_28::from_bits);
        self.output = self
            .zone
            .next(filtered, *zone)
            .saturating_add(Q4_28::from_bits(second));
    }
}

/// The control of the camera by the hand: takes the statistics of each camera frame, and returns the camera's position and the
/// engine's setting for the next frame.
#[derive(Clone, Copy, Debug)]
pub struct Control {
    state: State,
    setting: EngineSetting,
    /// Time in µs at which the last frame ended.
    ended: Option<u64>,
    /// Result of the last frame: the hand, or the reason why the frame shows no hand.
    seen: Result<Blob, Doubt>,
    /// Azimuth, polar angle and distance.
    channels: [Channel; 3],
}

impl Default for Control {
    /// Without a hand the camera is at azimuth 0, in the plane of the equator, at the distance 3.5.
    fn default() -> Self {
        let start = [Q4_28::ZERO, Q4_28::lit("0.25"), Q4_28::lit("3.5")];
        Self {
            state: State::Absent,
            setting: EngineSetting::SEARCHING,
            ended: None,
            seen: Err(Doubt::Missing),
            channels: start.map(Channel::at),
        }
    }
}

impl Control {
    /// The camera's position.
    pub fn pose(&self) -> Pose {
        let [theta, phi, r] = self.channels.map(|channel| channel.output.to_bits());
        Pose {
            // The shift drops whole turns.
            theta: Turns((theta as u32) << 4),
            phi: Turns((phi as u32) << 4),
            r: Q32_32::from_bits(i64::from(r) << 4),
        }
    }

    /// Settings of the engine for the next frame.
    pub const fn setting(&self) -> EngineSetting {
        self.setting
    }

    /// Whether a hand steers the camera.
    pub const fn presence(&self) -> Presence {
        match self.state {
            State::Absent => Presence::Absent,
            State::Appearing(..) => Presence::Appearing,
            State::Tracked(_) => Presence::Tracked,
            State::Held(..) => Presence::Held,
        }
    }

    /// Result of the last frame: the hand, or the reason why the frame shows no hand.
    ///
    /// # Errors
    /// The last frame did not show the hand.
    pub const fn seen(&self) -> Result<Blob, Doubt> {
        self.seen
    }

    /// Takes the statistics of a new camera frame, and returns the hand that it shows. `time` is the time in µs at which the frame ended,
    /// from an arbitrary origin; it must not decrease. After a pause of more than [`PATIENCE`] the search starts again.
    ///
    /// A hand appears when three successive frames show a hand with sufficient confidence and nearly constant area and position.
    /// The camera then moves to the hand's position within some tenths of a second, along the shorter arc. A hand that returns
    /// to its region has the same effect.
    ///
    /// # Errors
    /// The frame does not show the hand; the camera does not move.
    #[inline]
    pub fn on_frame(&mut self, time: u64, statistics: &Statistics) -> Result<Blob, Doubt> {
        let before = self.ended.replace(time);
        // The first frame counts as following a pause of the maximum length.
        let gap = before.and_then(|before| u32::try_from(time.saturating_sub(before)).ok());
        self.take(gap.unwrap_or(u32::MAX), statistics);
        // A separate copy: if the caller ignores the result, the compiler removes the copy after inlining.
        self.seen
    }

    /// Takes a frame, `gap` µs after the previous frame. Every frame with a hand runs all of this code, which must fit the
    /// instruction cache, so rare cases are in other functions.
    #[inline(never)]
    fn take(&mut self, gap: u32, statistics: &Statistics) {
        self.seen = statistics.blob();
        let size = statistics.size;
        let (State::Tracked(last), Ok(blob)) = (self.state, self.seen) else {
            return self.seek(gap, size);
        };
        if gap > PATIENCE || !is_like(last.count, &blob) {
            return self.seek(gap, size);
        }
        self.state = State::Tracked(Last {
            count: blob.count,
            centre: blob.centre,
        });
        // A hand at rest moves by at most 1/64 of the frame.
        let rests = |axis: usize| {
            let moved = last.centre[axis].abs_diff(blob.centre[axis]);
            moved.to_bits() <= u32::from(size[axis]) << (12 - 6)
        };
        self.setting = if rests(0) && rests(1) {
            EngineSetting::resting(&blob.bounds, size)
        } else {
            EngineSetting::moving(&blob.bounds, size)
        };
        self.steer(target(&blob, size), TimeStep::new(gap));
    }

    /// Takes a frame that does not continue a tracked hand, `gap` µs after the previous frame.
    #[cold]
    #[inline(never)]
    fn seek(&mut self, gap: u32, size: [u16; 2]) {
        let mut waited = gap;
        if let State::Held(_, since) = &mut self.state {
            *since = since.saturating_add(gap);
            waited = *since;
        }
        if waited > PATIENCE && self.state != State::Absent {
            // The statistics of this frame may cover only the hand's region, so the search begins with the next frame.
            self.search();
        }
        match self.state {
            State::Tracked(Last { count, .. }) | State::Held(count, _) => self.hold(count, size),
            State::Absent | State::Appearing(..) => self.seen = self.appear(size),
        }
    }

    /// Begins to search the whole frame.
    fn search(&mut self) {
        self.state = State::Absent;
        self.setting = EngineSetting::SEARCHING;
    }

    /// Searches for a hand in three successive frames.
    fn appear(&mut self, size: [u16; 2]) -> Result<Blob, Doubt> {
        let before = self.state;
        self.search();
        let blob = self.seen?;
        if blob.confidence(size) < LEAST_CONFIDENCE {
            return Err(Doubt::Scattered);
        }
        let frames = match before {
            State::Appearing(before, frames) if is_near(&before, &blob, size) => frames + 1,
            State::Absent | State::Appearing(..) | State::Tracked(_) | State::Held(..) => 1,
        };
        self.state = State::Appearing(blob, frames);
        if frames == FRAMES {
            self.enter(&blob, size);
        }
        Ok(blob)
    }

    /// Searches for a lost hand in its region, from the first frame without the hand on. The region becomes larger, because a
    /// hand that suddenly moves fast leaves the region of a hand at rest.
    fn hold(&mut self, count: u32, size: [u16; 2]) {
        match self.seen {
            Ok(blob) if is_like(count, &blob) => return self.enter(&blob, size),
            Ok(_) => self.seen = Err(Doubt::Jump),
            Err(_) => {}
        }
        if !matches!(self.state, State::Held(..)) {
            self.state = State::Held(count, 0);
            self.setting = EngineSetting::moving(&self.setting.region, size);
        }
    }

    /// Begins to follow a hand: the filters start at the hand's position, and the difference from the camera's position becomes
    /// the offset.
    fn enter(&mut self, blob: &Blob, size: [u16; 2]) {
        // The next frame counts shorter runs, so its area may be larger.
        self.state = State::Tracked(Last {
            count: 0,
            centre: blob.centre,
        });
        self.setting = EngineSetting::moving(&blob.bounds, size);
        for (channel, target) in self.channels.iter_mut().zip(target(blob, size)) {
            let offset = channel.output.saturating_sub(target);
            *channel = Channel {
                offsets: [offset; 2],
                output: channel.output,
                ..Channel::at(target)
            };
        }
        // The azimuth takes the shorter arc: whole turns are removed from the difference of two azimuths.
        let [azimuth, ..] = &mut self.channels;
        azimuth.offsets = azimuth.offsets.map(within_a_turn);
    }

    /// Moves the camera towards the position of the hand.
    fn steer(&mut self, target: [Q4_28; 3], step: TimeStep) {
        let [theta, phi, r] = target;
        let [azimuth, polar, distance] = &mut self.channels;
        let [angle, span, back] = [ANGLE.speed_cutoff, DISTANCE.speed_cutoff, RETURN]
            .map(|cutoff| low_pass_gain(cutoff, step));
        azimuth.steer(theta, &CHANNELS[0], step, [angle, back]);
        polar.steer(phi, &CHANNELS[1], step, [angle, back]);
        distance.steer(r, &CHANNELS[2], step, [span, back]);
        azimuth.output = within_a_turn(azimuth.output);
        polar.output = polar.output.clamp(POLARS[0], POLARS[1]);
        distance.output = distance.output.clamp(DISTANCES[0], DISTANCES[1]);
    }
}

/// Drops the whole turns of an angle: the result is in [−1/2, 1/2).
const fn within_a_turn(angle: Q4_28) -> Q4_28 {
    Q4_28::from_bits((angle.to_bits() << 4) >> 4)
}

/// Whether an area differs by at most a factor of 1.5 from the hand's area in an earlier frame; an earlier area of 0 means
/// unknown. Areas are below 2^20 pixels.
const fn is_like(count: u32, blob: &Blob) -> bool {
    count == 0 || (2 * blob.count <= 3 * count && 2 * count <= 3 * blob.count)
}

/// Whether a hand may be the hand of the previous frame: its area is nearly equal, and its centre at most an eighth of the frame
/// away.
fn is_near(before: &Blob, blob: &Blob, size: [u16; 2]) -> bool {
    let moved = |axis: usize| {
        before.centre[axis]
            .abs_diff(blob.centre[axis])
            .to_num::<u32>()
    };
    is_like(before.count, blob)
        && [0, 1]
            .iter()
            .all(|&axis| moved(axis) <= u32::from(size[axis] / 8))
}
