//! Stiff cases of the camera's control: frames that do not show exactly one hand.

use glint_core::gesture::{Control, Doubt, Presence};
use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;

use super::frame::{Drawn, Frame, Noise, Shape};
use super::path::{AREA, angles, between};

/// Number of frames per second.
const RATE: f64 = 60.0;
/// Start and end times of the fault in seconds.
const FAULT: [f64; 2] = [2.0, 3.0];
/// End time of a case in seconds.
const END: f64 = 5.0;

/// Content of the frames during a case's fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// No pixel of the hand's colour.
    Nothing,
    /// All pixels of the hand's colour.
    Everything,
    /// One pixel of the hand's colour.
    OnePixel,
    /// The hand extends beyond the frame's border.
    Border,
    /// The hand leaves and returns at another position.
    Elsewhere,
    /// A second hand appears far away.
    SecondFar,
    /// A second hand appears beside the first hand, in its region.
    SecondNear,
    /// Two hands from the beginning; one leaves at the end of the fault.
    TwoAtStart,
    /// The light doubles, and the colour of a quarter of the hand's area leaves the colour windows.
    LightLittle,
    /// The light doubles, the hand's colour leaves the colour windows, and the exposure settles after 0.5 s.
    LightMuch,
    /// Faulty frames: VSYNC lost, lines too short or too long, bytes slipped.
    Faulty,
    /// No frames: the sensor's clock is stopped, or the sensor is unplugged.
    Stopped,
}

impl Fault {
    /// All faults.
    pub const ALL: [Self; 12] = [
        Self::Nothing,
        Self::OnePixel,
        Self::Everything,
        Self::Border,
        Self::Elsewhere,
        Self::SecondFar,
        Self::SecondNear,
        Self::TwoAtStart,
        Self::LightLittle,
        Self::LightMuch,
        Self::Faulty,
        Self::Stopped,
    ];

    /// Description of the fault for tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Nothing => "no pixel",
            Self::OnePixel => "one pixel",
            Self::Everything => "all pixels",
            Self::Border => "half of the hand beyond the border",
            Self::Elsewhere => "hand leaves and returns 150 pixels away",
            Self::SecondFar => "second hand, outside the region",
            Self::SecondNear => "second hand, in the region",
            Self::TwoAtStart => "two hands from the beginning, 190 pixels apart",
            Self::LightLittle => "light doubles, a quarter of the hand's area is lost",
            Self::LightMuch => "light doubles, all pixels are lost for 0.5 s",
            Self::Faulty => "faulty frames: VSYNC lost, lines too short or long, bytes slipped",
            Self::Stopped => "no frames: PCLK stopped, unplugged",
        }
    }
}

/// Outcome of a case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CaseResult {
    /// Presence of the hand half a second after the start of the fault.
    pub presence: Presence,
    /// Reason for not using the last frame of the fault; `None` if it was used, or if the fault has no frames.
    pub doubt: Option<Doubt>,
    /// Largest angle between a direction of the camera during the fault and its direction before the fault, in degrees.
    pub moved: f64,
    /// Time in ms from the end of the fault until the hand steers the camera again; 0 if the hand already steers the camera then.
    pub back: f64,
    /// Largest rotation of the camera between successive frames, from the fault's beginning on, in degrees.
    pub step: f64,
    /// Angle between the directions of the camera and of the hand at the end of the case, in degrees.
    pub end: f64,
}

/// Runs a case: a hand at rest with sensor noise, then a fault for one second, then the hand again.
pub fn outcome(fault: Fault) -> CaseResult {
    let mut random = Pcg64Mcg::seed_from_u64(5);
    let noise = Noise::SENSOR;
    let place = [100.0, 110.0];
    let hand = Drawn::new(Shape::Hand, place, AREA);
    let returned = match fault {
        Fault::Elsewhere => [250.0, 130.0],
        _ => place,
    };
    let camera = |control: &Control| {
        let pose = control.pose();
        [pose.theta, pose.phi].map(|angle| angle.to_signed_degrees().to_num::<f64>() / 360.0)
    };
    let mut control = Control::default();
    let (mut before, mut last) = ([0.0; 2], [0.0; 2]);
    let mut presence = Presence::Absent;
    let mut outcome = CaseResult {
        presence,
        doubt: None,
        moved: 0.0,
        back: 0.0,
        step: 0.0,
        end: 0.0,
    };
    let mut is_back = false;
    for number in 0..(END * RATE) as u32 {
        let seconds = f64::from(number) / RATE;
        let is_over = seconds >= FAULT[1];
        let is_faulty = seconds >= FAULT[0] && !is_over;
        if is_faulty && before == [0.0; 2] {
            before = camera(&control);
            last = before;
        }
        let setting = control.setting();
        let mut draw = |hands: &[Drawn], noise: &Noise| {
            Frame::draw(hands, noise, &mut random).statistics(setting)
        };
        let both = |way: [f64; 2]| [hand, hand.moved(way)];
        let shown = match fault {
            _ if is_over => {
                let way = [0, 1].map(|axis| returned[axis] - place[axis]);
                Some(draw(&[hand.moved(way)], &noise))
            }
            Fault::TwoAtStart => Some(draw(&both([190.0, 40.0]), &noise)),
            _ if !is_faulty => Some(draw(&[hand], &noise)),
            Fault::Nothing | Fault::Elsewhere => Some(draw(&[], &Noise::NONE)),
            Fault::OnePixel => Some(Frame::of([(100, 110)]).statistics(setting)),
            Fault::Everything => Some(Frame::full().statistics(setting)),
            Fault::Border => {
                // The hand moves to the border within half a second.
                let part = ((seconds - FAULT[0]) * 2.0).min(1.0);
                Some(draw(&[hand.moved([-100.0 * part, 0.0])], &noise))
            }
            Fault::SecondFar => Some(draw(&both([150.0, 60.0]), &noise)),
            Fault::SecondNear => Some(draw(&both([62.0, 0.0]), &noise)),
            Fault::LightLittle => {
                let left = Drawn::new(Shape::Hand, place, 0.75 * AREA);
                Some(draw(&[left], &noise))
            }
            Fault::LightMuch if seconds < FAULT[0] + 0.5 => Some(draw(&[], &noise)),
            Fault::LightMuch => Some(draw(&[hand], &noise)),
            Fault::Faulty => {
                let mut statistics = draw(&[hand.moved([40.0, 20.0])], &noise);
                statistics.is_whole = false;
                Some(statistics)
            }
            Fault::Stopped => None,
        };
        if let Some(statistics) = shown {
            let time = (seconds * 1e6).round() as u64;
            let seen = control.on_frame(time, &statistics);
            if is_faulty {
                outcome.doubt = seen.err();
            }
        }
        let now = camera(&control);
        presence = control.presence();
        if seconds < FAULT[0] + 0.5 {
            outcome.presence = presence;
        }
        if is_faulty {
            outcome.moved = outcome.moved.max(between(before, now));
        }
        if is_over && !is_back {
            is_back = presence == Presence::Tracked;
            outcome.back = if is_back && number as f64 / RATE - FAULT[1] < 0.5 / RATE {
                0.0
            } else {
                1e3 * (seconds - FAULT[1])
            };
        }
        if seconds >= FAULT[0] {
            outcome.step = outcome.step.max(between(last, now));
            last = now;
        }
    }
    outcome.end = between(camera(&control), angles(returned));
    outcome
}
