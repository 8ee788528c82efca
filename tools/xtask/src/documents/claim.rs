//! Claims of accuracy, speed or cost in a text: numbers with a unit that only measurements have.
//!
//! Specified numbers have other units: Hz for frequencies, s, ms or µs for time-outs and periods, fractions of a pixel for
//! positions, clocks for limits of a circuit, units of the format for rounding bounds.

use std::sync::LazyLock;

use regex_lite::Regex;

/// A number, with optional thousands separators.
const NUMBER: &str = r"\b\d[\d,]*(?:\.\d+)?";

/// Units of claims.
const UNITS: [&str; 11] = [
    // Speed: of the soft core and of frames, by counters; of a circuit, as a mean or a rate.
    r"(?: million)? cycles",
    r"(?: million)? (?:\w+ )?(?:frames|pictures|instructions) (?:a|per) second",
    r" fps",
    r" clocks (?:a|an|per|for each) \w+",
    r" million clocks",
    // Run time of a command.
    r"(?: (?:minutes|seconds|s of (?:CPU|processor) time)\b|(?: \w+)+, m?s\b)",
    // Cost in cells of an FPGA.
    r" (?:more |fewer |other )?(?:LUT4?s?|FFs?|flip-flops|DSP48\w*|MULT18\w*|RAMB36\w*|block RAMs|DP16KD|slices|control sets)\b",
    // Accuracy.
    r" ULP\b",
    r" °/h",
    r" (?:pixels? off|wrong pixels|wrong faces)",
    // Ratios.
    r"(?:(?: ?%| times|×|x) (?:fewer|less|more|faster|slower|smaller|larger|longer|shorter|as \w+)\b|x speed-up)",
];

/// Units that make a claim only after a decimal number: a mean of clocks, and an error in pixels.
const DECIMALS: &str = r"\b\d+\.\d+ clocks\b|\b\d\.\d+(?:/256)? (?:pixels?|px)\b";

/// A decimal number after a form of the verb "measure".
const MEASURED: &str = r"\bmeasures?\b[^.;:]{0,20} \d+\.\d";

static CLAIM: LazyLock<Regex> = LazyLock::new(|| {
    let units = UNITS.join("|");
    Regex::new(&format!("{NUMBER}(?:{units})|{DECIMALS}|{MEASURED}")).expect("a pattern")
});

/// The first claim in a text.
pub fn find(text: &str) -> Option<&str> {
    CLAIM.find(text).map(|found| found.as_str())
}

#[test]
fn figures_of_measurements_are_claims() {
    for claim in [
        "a frame of icosphere:6 takes 29,373 cycles",
        "copies take 34 million cycles once",
        "101 frames a second at 1280×720",
        "57.5 fps",
        "235 camera frames a second",
        "it takes 11 clocks a triangle",
        "3.53 clocks with a FIFO of 128",
        "a fresh clone takes 5 minutes",
        "this saves 88 flip-flops",
        "19 LUTs and a register",
        "takes 3 DSP48",
        "4.5 block RAMs",
        "errors of 0.673 ULP",
        "drifts by 4 °/h",
        "its centre is then 2 pixels off",
        "within 0.08 pixels",
        "the test measures 0.58/256 pixel",
        "runs 420 million instructions a second",
        "43 s of CPU time",
        "56.2 virtual board, s",
        "4.9 % fewer clocks",
        "20 times as frequent",
        "128x speed-up",
    ] {
        assert!(find(claim).is_some(), "{claim}");
    }
}

#[test]
fn figures_of_a_specification_are_no_claims() {
    for specification in [
        "`sys` is 81.25 MHz, and the screen shows 1280×720 at 60 Hz",
        "a cache of 512 vertices of 40 bits",
        "after 250 ms without a frame, or 4,096 clocks",
        "a FIFO of 32 words, 4 KiB",
        "128 MB of DDR3, 16 bits at 650 MT/s",
        "exact at any end point in 1/256 pixel",
        "a field of view of 150°",
        "the guard band of ±2047.5 px",
        "at most 16 objects",
    ] {
        assert_eq!(find(specification), None, "{specification}");
    }
}
