//! Tests of the camera's control by a hand, with synthetic frames.

use glint_core::gesture::{Doubt, Presence};
use glint_reference::gesture::cases::{Fault, outcome};
use glint_reference::gesture::filters::{Filter, motion, quality};
use glint_reference::report::experiments::gesture::{centres, recordings};

#[test]
fn the_centre_of_a_noisy_hand_is_within_a_tenth_of_a_pixel() {
    let rows = centres(40, true);
    let rms = |hand: &str| {
        let row = rows.iter().find(|row| row.shipped && row.hand == hand);
        row.expect("a row").rms
    };
    for hand in ["disc, 500 pixels", "hand, 500 pixels", "hand, 2000 pixels"] {
        let rms = rms(hand);
        assert!(rms < 0.1, "{hand}: {rms} pixels");
    }
}

#[test]
fn a_still_hand_holds_the_camera_still_and_a_moving_one_is_followed() {
    let recordings = recordings();
    let camera: Vec<_> = recordings.rest.iter().map(|sample| sample.camera).collect();
    let still = motion(&camera);
    assert!(still < 0.1, "{still}°");
    let shipped = quality(Filter::Shipped, &recordings);
    assert!(
        (0.0..8.0).contains(&shipped.lag) && shipped.tracking < 1.0,
        "{shipped:?}"
    );
    // The alternative filters have more noise or a larger error.
    for other in [
        Filter::None,
        Filter::Average(2),
        Filter::LowPass(8.0),
        Filter::AlphaBeta(0.3),
    ] {
        let other = quality(other, &recordings);
        assert!(other.rest > shipped.rest || other.tracking > shipped.tracking);
    }
}

#[test]
fn stiff_cases_have_their_stated_outcomes() {
    use Presence::{Absent, Tracked};
    // For each case: presence after half a second, reason for not using frames, and the camera's largest rotation in degrees
    // during the case and per frame.
    for (fault, presence, doubt, moved, step) in [
        (Fault::Nothing, Absent, Some(Doubt::Few), 0.0, 0.1),
        (Fault::OnePixel, Absent, Some(Doubt::Few), 0.0, 0.1),
        (Fault::Everything, Absent, Some(Doubt::Most), 0.0, 0.1),
        (Fault::Border, Tracked, None, 112.0, 7.0),
        (Fault::Elsewhere, Absent, Some(Doubt::Few), 0.0, 7.0),
        (Fault::SecondFar, Tracked, None, 0.1, 0.1),
        (Fault::SecondNear, Tracked, None, 40.0, 16.0),
        (Fault::TwoAtStart, Absent, Some(Doubt::Scattered), 0.0, 4.0),
        (Fault::LightLittle, Tracked, None, 0.1, 0.1),
        (Fault::LightMuch, Absent, None, 0.1, 0.1),
        (Fault::Faulty, Absent, Some(Doubt::Faulty), 0.0, 0.1),
        (Fault::Stopped, Tracked, None, 0.0, 0.1),
    ] {
        let outcome = outcome(fault);
        assert_eq!(
            (outcome.presence, outcome.doubt),
            (presence, doubt),
            "{fault:?}"
        );
        assert!(
            outcome.moved <= moved && outcome.step <= step,
            "{fault:?}: {outcome:?}"
        );
        assert!(
            outcome.back < 400.0 && outcome.end < 0.2,
            "{fault:?}: {outcome:?}"
        );
    }
}
