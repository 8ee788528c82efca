//! Calibration of the hand's colour: finds its ranges of chroma from a small picture of a hand in the middle of the frame.

use core::fmt;

/// The accepted range (window) of a chroma channel, including both ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// The smallest value.
    pub lower: u8,
    /// The largest value.
    pub upper: u8,
}

impl Window {
    /// Whether the value is in the window.
    pub const fn holds(self, value: u8) -> bool {
        self.lower <= value && value <= self.upper
    }
}

/// The result of a calibration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Calibrated {
    /// The windows of Cr and Cb.
    pub windows: [Window; 2],
    /// Share of the samples in the box that are in both windows, in percent.
    pub inside: u8,
    /// Share of the samples outside the box that are in both windows, in percent.
    pub outside: u8,
}

/// Reason why a calibration failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColourError {
    /// The picture has fewer samples than its size requires, or the box has fewer than [`LEAST_SAMPLES`].
    Samples,
    /// The box shows several colours: the middle 80 % of a channel's values span more than [`WIDEST`]. The value is this span.
    Colours(u8),
    /// The share of the box's samples in both windows, in percent, is too small: the box shows several colours.
    Inside(u8),
    /// The share of samples outside the box with the hand's colour, in percent, is too large.
    Outside(u8),
}

impl fmt::Display for ColourError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Samples => write!(
                f,
                "the picture is too small: expected at least {LEAST_SAMPLES} samples in its middle"
            ),
            Self::Colours(span) => write!(
                f,
                "the chroma in the middle spans {span} levels: expected at most {WIDEST}; fill the middle of the frame with the hand"
            ),
            Self::Inside(percent) => write!(
                f,
                "{percent} % of the middle have the hand's colour: expected at least {LEAST_INSIDE} %; fill the middle of the frame with the hand"
            ),
            Self::Outside(percent) => write!(
                f,
                "{percent} % of the background have the hand's colour: expected at most {MOST_OUTSIDE} %; change background or light"
            ),
        }
    }
}

/// Smallest number of samples in the box.
pub const LEAST_SAMPLES: u32 = 16;
/// Largest span of the middle 80 % of a channel's values in the box.
pub const WIDEST: u8 = 48;
/// Smallest accepted share of the box's samples in both windows, in percent.
const LEAST_INSIDE: u8 = 70;
/// Largest accepted share of the samples outside the box in both windows, in percent.
const MOST_OUTSIDE: u8 = 25;
/// Smallest margin of the window beyond the middle 80 % of the values.
const MARGIN: u8 = 4;

/// Finds the windows of Cr and Cb of a hand that covers the box in the middle of the frame. The box has a quarter of the frame's
/// width and height.
///
/// `samples` are Cr and Cb of a picture of `columns` times `rows` samples, line by line from the top left; the iterator is read
/// twice. For each channel, the window is the range of the box's values without the lowest and highest tenth, widened on
/// both sides by half of this range's span, but at least by 4. The values in the lowest and highest tenth are edges of the hand,
/// highlights and noise.
///
/// # Errors
/// The box shows several colours, or much of the background has the hand's colour too.
pub fn calibrate(
    columns: u16,
    rows: u16,
    samples: impl Iterator<Item = [u8; 2]> + Clone,
) -> Result<Calibrated, ColourError> {
    let size = [u32::from(columns), u32::from(rows)];
    let within = |number: u32, length: u32| (length * 3 / 8..length * 5 / 8).contains(&number);
    let total = size[0] * size[1];
    let placed = || {
        let places = (0..rows.into()).flat_map(|y| (0..columns.into()).map(move |x| (x, y)));
        places
            .map(|(x, y)| within(x, size[0]) && within(y, size[1]))
            .zip(samples.clone())
    };

    let mut histograms = [[0_u32; 256]; 2];
    let (mut taken, mut boxed) = (0, 0);
    for (is_boxed, sample) in placed() {
        taken += 1;
        if is_boxed {
            boxed += 1;
            for (histogram, value) in histograms.iter_mut().zip(sample) {
                histogram[usize::from(value)] += 1;
            }
        }
    }
    if taken < total || boxed < LEAST_SAMPLES {
        return Err(ColourError::Samples);
    }
    let [cr, cb] = histograms.map(|histogram| window(&histogram, boxed / 10));
    let windows = [cr?, cb?];

    let [mut inside, mut outside] = [0_u32; 2];
    for (is_boxed, sample) in placed() {
        if core::iter::zip(windows, sample).all(|(window, value)| window.holds(value)) {
            *(if is_boxed { &mut inside } else { &mut outside }) += 1;
        }
    }
    // The box is at most a fourth of a picture of at least 16 samples, so some samples are outside the box.
    let percent = |part: u32, whole: u32| (u64::from(part) * 100 / u64::from(whole.max(1))) as u8;
    let found = Calibrated {
        windows,
        inside: percent(inside, boxed),
        outside: percent(outside, total - boxed),
    };
    if found.inside < LEAST_INSIDE {
        return Err(ColourError::Inside(found.inside));
    }
    if found.outside > MOST_OUTSIDE {
        return Err(ColourError::Outside(found.outside));
    }
    Ok(found)
}

/// Returns the window of a channel from the histogram of its values. `tail` is the number of values to leave out at each end.
fn window(histogram: &[u32; 256], tail: u32) -> Result<Window, ColourError> {
    let lower = end((0..=255).zip(histogram), tail);
    let upper = end((0..=255).zip(histogram).rev(), tail);
    let span = upper.saturating_sub(lower);
    if span > WIDEST {
        return Err(ColourError::Colours(span));
    }
    let margin = (span / 2).max(MARGIN);
    Ok(Window {
        lower: lower.saturating_sub(margin),
        upper: upper.saturating_add(margin),
    })
}

/// Returns the first value of a histogram after `tail` values were left out.
fn end<'h>(bins: impl Iterator<Item = (u8, &'h u32)>, tail: u32) -> u8 {
    let mut left = tail;
    for (value, &count) in bins {
        match left.checked_sub(count) {
            Some(rest) => left = rest,
            None => return value,
        }
    }
    // Not reached: the histogram has more values than the tail.
    0
}
