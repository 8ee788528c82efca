//! Paths of a hand, and the noisy targets that the control computes from frames along a path.

use glint_core::fixed::Q4_28;
use glint_core::gesture::{Control, Presence, target};
use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;

use super::frame::{Drawn, Frame, Noise, SIZE, Shape};

/// Area of the hand in pixels.
pub const AREA: f64 = 2_000.0;

/// A path of the hand's centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Path {
    /// Rest at a position off the pixel grid.
    Rest,
    /// A steady motion to the right over 200 pixels, at this speed in pixels per second, then a jump back to the start.
    Sweep(f64),
    /// Reaches: minimum-jerk motions, as of an arm, of 0.5 s each between positions, followed by rests of 0.3 s.
    Reaches,
}

/// The positions of [`Path::Reaches`], in pixels.
const PLACES: [[f64; 2]; 8] = [
    [160.0, 120.0],
    [90.0, 100.0],
    [230.0, 140.0],
    [200.0, 90.0],
    [190.0, 95.0],
    [80.0, 150.0],
    [120.0, 80.0],
    [240.0, 120.0],
];

impl Path {
    /// The position of the hand's centre, in pixels, after `time` seconds.
    pub fn at(self, time: f64) -> [f64; 2] {
        match self {
            Self::Rest => [160.37, 120.21],
            Self::Sweep(speed) => [60.0 + (speed * time) % 200.0, 120.0],
            Self::Reaches => {
                let number = (time / 0.8).floor();
                let [from, to] = [0, 1].map(|next| PLACES[(number as usize + next) % PLACES.len()]);
                let part = ((time - 0.8 * number) / 0.5).min(1.0);
                // Minimum jerk (Flash and Hogan, 1985): 10p³ − 15p⁴ + 6p⁵.
                let way = part.powi(3) * (10.0 - 15.0 * part + 6.0 * part * part);
                [0, 1].map(|axis| from[axis] + way * (to[axis] - from[axis]))
            }
        }
    }
}

/// A camera frame along a path.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// Azimuth and polar angle in turns for the true centre.
    pub truth: [f64; 2],
    /// Azimuth and polar angle in turns from the control, before its filters.
    pub target: [Q4_28; 2],
    /// Azimuth and polar angle in turns of the camera itself.
    pub camera: [f64; 2],
}

/// Azimuth and polar angle in turns for a position in pixels.
pub fn angles([x, y]: [f64; 2]) -> [f64; 2] {
    [
        (x + 0.5) / f64::from(SIZE[0]) - 0.5,
        (y + 0.5) / f64::from(SIZE[1]) / 2.0,
    ]
}

/// Runs the control on the frames along a path, after two seconds at its start in which the control detects the hand.
///
/// # Panics
/// When the control loses the hand.
pub fn record(path: Path, noise: &Noise, rate: f64, seconds: f64) -> Vec<Sample> {
    let mut random = Pcg64Mcg::seed_from_u64(3);
    let start = Drawn::new(Shape::Hand, [0.0; 2], AREA);
    let mut control = Control::default();
    let gap = (1e6 / rate).round() as u64;
    let mut now = 0;
    let mut frame = |time: f64| {
        let place = path.at(time);
        let statistics =
            Frame::draw(&[start.moved(place)], noise, &mut random).statistics(control.setting());
        now += gap;
        let blob = control
            .on_frame(now, &statistics)
            .expect("the hand is in the frame");
        let [theta, phi, _] = target(&blob, SIZE);
        let pose = control.pose();
        Sample {
            truth: angles(place),
            target: [theta, phi],
            camera: [pose.theta, pose.phi]
                .map(|angle| angle.to_signed_degrees().to_num::<f64>() / 360.0),
        }
    };
    let lead = (2.0 * rate) as u32;
    for _ in 0..lead {
        frame(0.0);
    }
    let samples = (0..(seconds * rate) as u32)
        .map(|number| frame(f64::from(number) / rate))
        .collect();
    assert_eq!(control.presence(), Presence::Tracked);
    samples
}

/// Returns the angle, in degrees, between two directions. Each direction is an azimuth and a polar angle in turns.
pub fn between(a: [f64; 2], b: [f64; 2]) -> f64 {
    let direction = |[theta, phi]: [f64; 2]| {
        let [theta, phi] = [theta, phi].map(|turns| turns * std::f64::consts::TAU);
        [phi.sin() * theta.cos(), phi.sin() * theta.sin(), phi.cos()]
    };
    let [a, b] = [direction(a), direction(b)];
    let across = [0, 1, 2].map(|i| (a[i] - b[i]).powi(2));
    let half = across.iter().sum::<f64>().sqrt() / 2.0;
    2.0 * half.min(1.0).asin().to_degrees()
}
