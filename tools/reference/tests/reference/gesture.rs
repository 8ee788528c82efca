//! Tests of the camera's control by a hand, with synthetic frames.

use glint_reference::gesture::filters::{Filter, motion, quality};
use glint_reference::report::experiments::gesture::{Stiff, centres, recordings, stiff};
use glint_reference::report::table::read_csv;
use glint_reference::report::workspace;

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
fn stiff_cases_have_their_committed_outcomes() {
    let path = workspace::path("docs/report/gesture-stiff.csv");
    let committed: Vec<Stiff> = read_csv(&path).expect("a table");
    assert_eq!(stiff(), committed, "run `cargo xtask report gesture`");
}
