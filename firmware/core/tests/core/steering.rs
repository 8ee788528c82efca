//! Tests of cameras steered by an attitude: their directions, and the continuity of their motion.

use glint_core::camera::{View, ViewError};
use glint_core::choice::Choice;
use glint_core::fixed::{Q2_23, Q32_32, Turns};
use glint_core::orientation::{Angles, Quaternion};
use glint_core::steering::{Direction, Mounting, NATURAL, Steering, free_look, orbit};

const ORIGIN: [Q32_32; 3] = [Q32_32::ZERO; 3];

fn degrees(angle: f64) -> Turns {
    Turns::from_degrees(Q32_32::from_num(angle))
}

fn attitude(yaw: f64, pitch: f64, roll: f64) -> Quaternion {
    let [yaw, pitch, roll] = [yaw, pitch, roll].map(degrees);
    Quaternion::from_angles(Angles { yaw, pitch, roll })
}

fn basis(view: &View) -> [[f64; 3]; 3] {
    [view.u(), view.v(), view.n()].map(|row| row.map(Q2_23::to_num))
}

/// Returns the largest difference between the components of the eyes and basis vectors of two cameras.
fn apart(a: &View, b: &View) -> f64 {
    let eyes = [a, b].map(|view| view.eye().map(Q32_32::to_num::<f64>));
    let rows = [basis(a), basis(b)];
    let pairs = eyes[0].iter().zip(&eyes[1]);
    let pairs = pairs.chain(rows[0].as_flattened().iter().zip(rows[1].as_flattened()));
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn free_look_is_look_where_the_angles_are_the_same() {
    let mounting = Mounting::default();
    let level = free_look(ORIGIN, Quaternion::IDENTITY, mounting).expect("near");
    let zero = View::look(ORIGIN, Turns(0), Turns(0), Turns(0)).expect("near");
    assert_eq!(level, zero);
    for yaw in [-170.0, -30.0, 15.5, 90.0] {
        // A positive rotation about the up axis turns left; a positive yaw of `look` turns right.
        let seen = free_look(ORIGIN, attitude(yaw, 0.0, 0.0), mounting).expect("near");
        let look = View::look(ORIGIN, degrees(-yaw), Turns(0), Turns(0)).expect("near");
        assert!(apart(&seen, &look) < 3e-7);
    }
    for angle in [-80.0, 25.0, 60.0] {
        // A positive rotation about the right axis x turns up; a positive pitch of `look` turns down.
        let seen = free_look(ORIGIN, attitude(0.0, 0.0, angle), mounting).expect("near");
        let look = View::look(ORIGIN, Turns(0), degrees(-angle), Turns(0)).expect("near");
        assert!(apart(&seen, &look) < 3e-7);
    }
}

#[test]
fn every_mounting_is_right_handed_and_orthonormal() {
    let mut found = 0;
    for forward in Direction::ALL {
        for up in Direction::ALL {
            let Some(mounting) = Mounting::new(forward, up) else {
                continue;
            };
            found += 1;
            for (yaw, pitch, roll) in [(0.0, 0.0, 0.0), (33.0, -72.0, 140.0), (5.0, 90.0, 0.0)] {
                let view = free_look(ORIGIN, attitude(yaw, pitch, roll), mounting).expect("near");
                let rows = basis(&view);
                let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
                for i in 0..3 {
                    for j in 0..3 {
                        let expected = if i == j { 1.0 } else { 0.0 };
                        assert!((dot(rows[i], rows[j]) - expected).abs() < 2f64.powi(-20));
                    }
                }
            }
        }
    }
    assert_eq!(found, 24);
    assert_eq!(Direction::from_word("-y"), Some(Direction::MinusY));
    assert_eq!(Direction::from_word("w"), None);
    assert_eq!(Direction::from_word("--x"), None);
}

/// The sensor's pitch passes −90° and +90°, without and with yaw and roll, and some of the cameras pass the zenith and the nadir.
/// A step of 0.01° changes each number of a camera by little more than the arc length of the step.
#[test]
fn the_camera_never_jumps() {
    let step = 0.01_f64;
    let arc = step.to_radians();
    for mounting in [
        Mounting::default(),
        Mounting::new(Direction::X, Direction::MinusY).expect("perpendicular"),
    ] {
        for (yaw, roll) in [(0.0, 0.0), (40.0, 20.0), (-120.0, 90.0)] {
            let mut before: Option<[View; 3]> = None;
            let mut steerings = [Steering::new(2 * NATURAL), Steering::default()];
            steerings[1].follow(attitude(yaw, -100.0, roll));
            steerings[1].recentre();
            for i in 0..20_000 {
                let at = attitude(yaw, -100.0 + step * f64::from(i), roll);
                let twice = steerings[0].follow(at);
                let centred = steerings[1].follow(at);
                let views = [
                    free_look(ORIGIN, centred, mounting).expect("near"),
                    orbit(Q32_32::from_num(5), at, mounting).expect("in range"),
                    free_look(ORIGIN, twice, mounting).expect("near"),
                ];
                if let Some(before) = &before {
                    for (k, most) in [1.01, 5.05, 2.02].into_iter().enumerate() {
                        let moved = apart(&before[k], &views[k]);
                        assert!(moved <= most * arc + 3e-7, "{k} {i}: {moved} of {arc}");
                    }
                }
                before = Some(views);
            }
        }
    }
}

#[test]
fn orbit_looks_at_the_origin() {
    let r = Q32_32::from_num(3);
    for (yaw, pitch, roll) in [(0.0, 0.0, 0.0), (50.0, 20.0, -70.0), (0.0, 90.0, 10.0)] {
        let view = orbit(r, attitude(yaw, pitch, roll), Mounting::default()).expect("in range");
        for (eye, n) in view.eye().iter().zip(basis(&view)[2]) {
            assert!((eye.to_num::<f64>() + 3.0 * n).abs() < 5e-7);
        }
    }
    let near = orbit(Q32_32::ONE, Quaternion::IDENTITY, Mounting::default());
    assert_eq!(near, Err(ViewError::Radius(Q32_32::ONE)));
}

#[test]
fn recentring_takes_the_heading_and_leaves_the_horizon() {
    let mut steering = Steering::default();
    let tilted = attitude(70.0, 10.0, -20.0);
    steering.follow(tilted);
    steering.recentre();
    let camera = steering.follow(tilted);
    assert!((camera.heading().0 as i32).abs() < 64);
    let up = |attitude: Quaternion| attitude.inverse().axes()[2];
    for (a, b) in up(camera).iter().zip(up(tilted)) {
        assert!((a - b).abs() < 16, "{a} {b}");
    }
    // The heading is also defined for a camera that looks straight up.
    let mut steering = Steering::default();
    steering.follow(attitude(0.0, 90.0, 40.0));
    steering.recentre();
    assert!((steering.follow(attitude(0.0, 90.0, 40.0)).heading().0 as i32).abs() < 64);
    steering.level();
    assert_eq!(
        steering.follow(attitude(0.0, 90.0, 40.0)),
        Quaternion::IDENTITY
    );
}

#[test]
fn sensitivity_scales_a_turn() {
    for sensitivity in [32, 64, 512, 2_048_u16] {
        let mut steering = Steering::new(sensitivity);
        steering.follow(Quaternion::IDENTITY);
        let mut camera = Quaternion::IDENTITY;
        for i in 1..=100 {
            camera = steering.follow(attitude(0.2 * f64::from(i), 0.0, 0.0));
        }
        let yaw: f64 = camera.angles().yaw.to_signed_degrees().to_num();
        let expected = 20.0 * f64::from(sensitivity) / 256.0;
        assert!((yaw - expected).abs() < 1e-4, "{sensitivity}: {yaw}");
    }
    // The camera does not move when the sensitivity changes back to 1.
    let mut steering = Steering::new(512);
    steering.follow(Quaternion::IDENTITY);
    let before = steering.follow(attitude(10.0, 0.0, 0.0));
    steering.set_sensitivity(NATURAL);
    let after = steering.follow(attitude(10.0, 0.0, 0.0));
    let yaw = |camera: Quaternion| -> f64 { camera.angles().yaw.to_signed_degrees().to_num() };
    assert!((yaw(before) - 20.0).abs() < 1e-5 && (yaw(after) - 20.0).abs() < 1e-5);
}
