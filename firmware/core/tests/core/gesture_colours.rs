//! Tests of the calibration of a hand's colour.

use glint_core::gesture::{ColourError, Window, calibrate};

/// Samples of a picture of 40×30: the hand's colour in the middle, and another colour around it.
fn picture(hand: impl Fn(usize) -> [u8; 2], rest: impl Fn(usize) -> [u8; 2]) -> Vec<[u8; 2]> {
    (0..1_200)
        .map(|place| {
            let (x, y) = (place % 40, place / 40);
            if (12..28).contains(&x) && (8..22).contains(&y) {
                hand(place)
            } else {
                rest(place)
            }
        })
        .collect()
}

#[test]
fn a_shown_hand_gives_the_windows_of_its_colour() {
    let noise = |place: usize, most: usize| (place * 7919 % 101 % (2 * most + 1)) as u8;
    let hand = |place| [145 + noise(place, 6), 95 + noise(place + 3, 6)];
    let calibrated = calibrate(40, 30, picture(hand, |_| [128, 128]).into_iter()).expect("a hand");
    let [cr, cb] = calibrated.windows;
    assert!(
        (135..=146).contains(&cr.lower) && (156..=168).contains(&cr.upper),
        "{cr:?}"
    );
    assert!(
        (85..=96).contains(&cb.lower) && (106..=118).contains(&cb.upper),
        "{cb:?}"
    );
    assert_eq!(calibrated.inside, 100);
    // The hand is larger than the box.
    assert!(calibrated.outside < 20, "{calibrated:?}");
    // A single colour without noise gets the smallest window.
    let flat =
        calibrate(40, 30, picture(|_| [2, 254], |_| [128, 128]).into_iter()).expect("a hand");
    let window = |lower, upper| Window { lower, upper };
    assert_eq!(flat.windows, [window(0, 6), window(250, 255)]);
}

#[test]
fn pictures_without_a_hand_are_refused() {
    let grey = |_| [128, 128];
    let run =
        |samples: Vec<[u8; 2]>| calibrate(40, 30, samples.into_iter()).map(|found| found.windows);
    assert_eq!(run(picture(grey, grey)), Err(ColourError::Outside(100)));
    let half = |place: usize| {
        if place.is_multiple_of(2) {
            [100, 128]
        } else {
            [180, 128]
        }
    };
    assert_eq!(run(picture(half, grey)), Err(ColourError::Colours(80)));
    assert_eq!(run(vec![[128, 128]; 1_199]), Err(ColourError::Samples));
    assert_eq!(
        calibrate(8, 8, std::iter::repeat([0, 0])).map(|found| found.windows),
        Err(ColourError::Samples)
    );
    assert_eq!(
        calibrate(0, 0, std::iter::empty()).map(|found| found.windows),
        Err(ColourError::Samples)
    );
}

/// A picture with more than 2^16 samples in the box, and a picture with more than 2^32/100 samples outside the box.
#[test]
fn large_pictures_are_counted() {
    let calibrated = |columns: u16, rows: u16, rest: [u8; 2]| {
        let within = |number: u32, length: u16| {
            let length = u32::from(length);
            (length * 3 / 8..length * 5 / 8).contains(&number)
        };
        let places = (0..rows.into()).flat_map(|y| (0..columns.into()).map(move |x| (x, y)));
        let samples = places.map(move |(x, y)| match within(x, columns) && within(y, rows) {
            true => [200, 60],
            false => rest,
        });
        calibrate(columns, rows, samples).map(|found| [found.inside, found.outside])
    };
    assert_eq!(calibrated(2_048, 1_024, [0, 0]), Ok([100, 0]));
    assert_eq!(
        calibrated(8_192, 6_144, [200, 60]),
        Err(ColourError::Outside(100))
    );
}
