//! Drift of the wireframe simulator's motions over 10,000 steps and more.

use glint_reference::wireframe::{Form, Session, drift};

const STEPS: u32 = 10_000;

/// The error after any number of steps is the error of one rounding: half a unit of 2^−20 in each of three coordinates.
#[test]
fn the_motion_is_free_of_drift() {
    for session in Session::ALL {
        for error in drift(Form::DriftFree, session, &[1, 100, STEPS, 10 * STEPS]) {
            assert!(
                error.distance < 1e-6 && error.growth.abs() < 3e-7,
                "{session:?}: {error:?}"
            );
        }
    }
}

#[test]
fn the_motion_in_place_drifts() {
    let last = |form, session| drift(form, session, &[STEPS])[0];
    for session in Session::ALL {
        let error = last(Form::Nearest, session);
        // Each step adds an error of at most half a unit of 2^−11 in two coordinates. The errors have different directions, so their sum
        // stays far below 10,000 times this error.
        assert!(error.distance < 0.2, "{session:?}: {error:?}");
        let error = last(Form::Truncated, session);
        assert!(error.distance > 0.2, "{session:?}: {error:?}");
    }
    assert!(last(Form::Nearest, Session::Wandering).distance > 0.01);
}
