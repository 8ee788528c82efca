//! Tests of keys, requests and contact bounce.

use glint_core::wireframe::{DEBOUNCE_MS, Debouncer, Key, Requests, Step};

#[test]
fn a_request_waits_for_its_frame() {
    let mut requests = Requests::default();
    assert_eq!(requests.take(), None);
    requests.press(Key::Left);
    assert!(!requests.is_empty());
    assert_eq!(requests.take(), Some(Key::Left));
    assert_eq!(requests.take(), None);
}

#[test]
fn one_request_a_frame_and_keys_take_turns() {
    let mut requests = Requests::default();
    // Two keys in one frame move the segments in two frames; a second press of a key with a pending request has no effect.
    for key in [Key::Right, Key::Up, Key::Right] {
        requests.press(key);
    }
    assert_eq!(
        [(); 3].map(|()| requests.take()),
        [Some(Key::Up), Some(Key::Right), None]
    );
    // A key that is pressed before every frame does not block other keys.
    requests.press(Key::ZoomOut);
    let mut waited = 0;
    loop {
        requests.press(Key::Up);
        requests.press(Key::Right);
        match requests.take() {
            Some(Key::ZoomOut) => break,
            _ => waited += 1,
        }
    }
    assert!(waited < 6, "{waited}");
}

#[test]
fn steps() {
    assert_eq!(Key::Up.step(false), Step::Pan([0, 1, 0]));
    assert_eq!(Key::Up.step(true), Step::AboutX { forwards: false });
    assert_eq!(Key::Right.step(true), Step::AboutY { forwards: true });
    assert_eq!(Key::ZoomIn.step(false), Key::ZoomIn.step(true));
}

/// Takes one sample per millisecond, and returns the times of the accepted presses of button 0.
fn presses(levels: &str) -> Vec<u32> {
    let mut debouncer = Debouncer::default();
    // The clock wraps during the samples.
    let start = u32::MAX - 7;
    (0..)
        .zip(levels.bytes())
        .filter(|&(ms, level)| {
            debouncer.sample(start.wrapping_add(ms), u8::from(level == b'1')) != 0
        })
        .map(|(ms, _)| ms)
        .collect()
}

#[test]
fn bounces_do_not_count() {
    assert_eq!(DEBOUNCE_MS, 5);
    assert_eq!(presses("0011111111110000000000"), [7]);
    assert_eq!(presses("0010110101111111111100"), [14]);
    // Bounces at the release do not cause a second press.
    assert_eq!(presses("0111111111001011010000000000"), [6]);
    assert_eq!(presses("0111111001111111111"), [6]);
    assert!(presses("0111110000001111100000").is_empty());
    assert_eq!(presses("0111111000000111111"), [6, 18]);
}

#[test]
fn sparse_samples_need_two_that_agree() {
    let mut debouncer = Debouncer::default();
    let mut sample = |ms, level| debouncer.sample(ms, level);
    assert_eq!([sample(0, 0), sample(17, 1), sample(34, 0)], [0; 3]);
    assert_eq!([sample(51, 1), sample(68, 1), sample(85, 1)], [0, 1, 0]);
}

#[test]
fn each_button_has_its_own_time() {
    let mut debouncer = Debouncer::default();
    let samples: Vec<u8> = (0..20)
        .map(|ms| debouncer.sample(ms, 1 | (ms as u8 / 3 % 2) << 1 | u8::from(ms > 2) << 3))
        .collect();
    assert_eq!(samples[5], 0b0001);
    assert_eq!(samples[8], 0b1000);
    assert!(samples.iter().all(|pressed| pressed & 0b0010 == 0));
}
