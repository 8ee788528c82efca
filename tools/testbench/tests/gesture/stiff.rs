//! The difficult cases: for each row of the table in docs/gesture.md, a function computes the
//! outcome.

use std::collections::BTreeMap;

use glint_core::colour::Rgb565;
use glint_core::gesture::{Region, Window};
use glint_model::gesture::{Channel, Polarity, Settings};

use crate::bench::{Bench, Clocks, HASTY, settings};
use crate::camera::{End, Picture};

const PAGE: &str = include_str!("../../../../docs/gesture.md");

const SIZE: [u16; 2] = [64, 48];
const SKIN: [u8; 3] = [200, 140, 110];
const RADIUS: i32 = 10;

/// A case: its name in the table, and the function that computes its outcome.
type Case = (&'static str, fn() -> String);

const CASES: [Case; 23] = [
    ("no pixel of the hand's colour", || frames(&[&[]])),
    ("all pixels", || picture(|_, _| SKIN)),
    ("one pixel", || {
        picture(|x, y| if (x, y) == (9, 40) { SKIN } else { GREY })
    }),
    ("hand at the border", || frames(&[&[[0, 24]]])),
    ("hand leaving and returning", || {
        frames(&[&[[20, 24]], &[], &[[20, 24]]])
    }),
    ("two hands", || frames(&[&[[16, 24], [48, 24]]])),
    ("two hands, the region around one of them", || {
        let mut asked = asked();
        asked.region = Region {
            first: [32, 0],
            last: [63, 47],
        };
        send(asked, &[hands(&[[16, 24], [48, 24]], 1)])
    }),
    ("hand and single pixels of its colour, runs of 4", || {
        let mut asked = asked();
        asked.least_run = 4;
        let picture = Picture::new(SIZE, |x, y| {
            colour(if (7 * x + 3 * y) % 11 == 0 || is_in([20, 24], x, y) {
                SKIN
            } else {
                GREY
            })
        });
        send(asked, &[picture])
    }),
    ("light stepping by 2", || {
        let pictures = [1, 2].map(|dark| hands(&[[20, 24]], dark));
        send(asked(), &pictures)
    }),
    ("VSYNC lost", || spoilt(|_| End::Lost)),
    ("VSYNC inside a line", || spoilt(|_| End::Cut)),
    ("line too short by a pixel", || {
        spoilt_lines(|lines| lines[5].truncate(126))
    }),
    ("line too long by a pixel", || {
        spoilt_lines(|lines| lines[5].extend([0, 0]))
    }),
    ("line missing", || spoilt_lines(|lines| _ = lines.remove(5))),
    ("line too many", || {
        spoilt_lines(|lines| lines.insert(5, vec![0; 128]))
    }),
    ("byte lost", || spoilt_lines(|lines| _ = lines[5].remove(7))),
    ("byte too many", || {
        spoilt_lines(|lines| lines[5].insert(7, 0))
    }),
    ("PCLK stopped inside a frame", || {
        let mut bench = bench(asked(), Polarity::default());
        let hand = hands(&[[20, 24]], 1);
        let pins = bench.camera.send(&mut bench.random, &hand, End::Vsync);
        bench.send(&pins[..2000]);
        bench.stop(200);
        let stopped = told(&mut bench);
        bench.send(&pins[2000..]);
        bench.frame(&hand, End::Vsync);
        format!("{stopped}; then {}", told(&mut bench))
    }),
    ("PCLK never started", || {
        let bench = Bench::silent(HASTY);
        let [running, waiting] =
            ["running", "waiting"].map(|name| bench.module.read(&format!("status.{name}")));
        format!("no frame: `running` {running}, `waiting` {waiting}")
    }),
    ("PCLK too fast for the engine, by 2.5", || {
        let clocks = Clocks {
            sys: 10_000,
            camera: 2_000,
        };
        let size = [400, 4];
        // Does not compare with the model, which has no notion of clocks.
        let mut bench = Bench::usual(clocks, settings(size), 1);
        let picture = Picture::new(size, |x, _| x);
        let pins = bench.camera.send(&mut bench.random, &picture, End::Vsync);
        bench.send(&pins);
        bench.idle(60);
        assert_eq!(bench.latches, 0);
        told(&mut bench)
    }),
    ("wrong polarity of VSYNC", || {
        wrong(|pins| pins.vsync_low = true)
    }),
    ("wrong polarity of HREF", || {
        wrong(|pins| pins.href_low = true)
    }),
    ("wrong order of bytes", || wrong(|pins| pins.swap = true)),
];

const GREY: [u8; 3] = [90, 95, 90];

fn colour(rgb: [u8; 3]) -> u16 {
    Rgb565::from_rgb888(rgb).0
}

fn is_in([x, y]: [i32; 2], column: u16, line: u16) -> bool {
    (i32::from(column) - x).pow(2) + (i32::from(line) - y).pow(2) <= RADIUS * RADIUS
}

/// A picture with discs of the hand's colour. All channels are divided by `dark`.
fn hands(places: &[[i32; 2]], dark: u8) -> Picture {
    Picture::new(SIZE, |x, y| {
        let is_hand = places.iter().any(|&place| is_in(place, x, y));
        colour((if is_hand { SKIN } else { GREY }).map(|channel| channel / dark))
    })
}

/// Windows of Cr from 140 to 175 and of Cb from 95 to 118.
fn asked() -> Settings {
    let [cr, cb] = [(140, 175), (95, 118)].map(|(lower, upper)| Window { lower, upper });
    Settings {
        windows: [(Channel::Cr, cr), (Channel::Cb, cb)],
        ..settings(SIZE)
    }
}

fn bench(asked: Settings, polarity: Polarity) -> Bench {
    let mut bench = Bench::new(HASTY, Clocks::URBANA, polarity, false, asked, 1);
    bench.begin();
    bench
}

/// Describes the result of the last frame from the registers.
fn told(bench: &mut Bench) -> String {
    const FAULTS: [&str; 7] = ["none", "pixels", "byte", "lines", "cut", "lost", "stopped"];
    let fault = bench.module.read("status.fault") as usize;
    if fault != 0 {
        return format!("dropped, `{}`", FAULTS[fault]);
    }
    let [count, x, y] = ["count", "sum_x", "sum_y"]
        .map(|name| bench.module.read(&format!("results.{name}")) as f64);
    if count == 0.0 {
        return "0 pixels".into();
    }
    let plural = if count == 1.0 { "" } else { "s" };
    format!(
        "{count} pixel{plural} about ({:.1}, {:.1})",
        x / count,
        y / count
    )
}

/// Sends pictures, one frame each, and describes the results.
fn send(asked: Settings, pictures: &[Picture]) -> String {
    let mut bench = bench(asked, Polarity::default());
    let told = pictures.iter().map(|picture| {
        bench.frame(picture, End::Vsync);
        told(&mut bench)
    });
    told.collect::<Vec<_>>().join("; then ")
}

fn frames(hands_of_frames: &[&[[i32; 2]]]) -> String {
    let pictures: Vec<_> = hands_of_frames
        .iter()
        .map(|places| hands(places, 1))
        .collect();
    send(asked(), &pictures)
}

fn picture(pixel: impl Fn(u16, u16) -> [u8; 3]) -> String {
    send(asked(), &[Picture::new(SIZE, |x, y| colour(pixel(x, y)))])
}

/// Sends a correct frame, a faulty frame, and then correct frames until a frame is complete.
fn spoilt(spoil: impl Fn(&mut Picture) -> End) -> String {
    let mut bench = bench(asked(), Polarity::default());
    let hand = hands(&[[20, 24]], 1);
    bench.frame(&hand, End::Vsync);
    let kept = bench.module.read("results.sum_x");
    let mut sent = hands(&[[40, 24]], 1);
    let end = spoil(&mut sent);
    bench.frame(&sent, end);
    if end == End::Lost {
        bench.frame(&hand, End::Vsync);
    }
    let fault = told(&mut bench);
    assert_eq!(
        bench.module.read("results.sum_x"),
        kept,
        "the results must not change"
    );
    bench.frame(&hand, End::Vsync);
    format!("{fault}; then {}", told(&mut bench))
}

/// Like [`spoilt`], with a fault in the lines of the frame.
fn spoilt_lines(spoil: fn(&mut Vec<Vec<u8>>)) -> String {
    spoilt(|picture| {
        spoil(&mut picture.lines);
        End::Vsync
    })
}

/// Sends frames to an engine that expects another polarity or byte order than the image sensor's.
fn wrong(change: fn(&mut Polarity)) -> String {
    let mut expected = Polarity::default();
    change(&mut expected);
    let mut bench = bench(asked(), expected);
    bench.camera.polarity = Polarity::default();
    bench.camera.is_noisy = false;
    for _ in 0..3 {
        bench.frame(&hands(&[[20, 24]], 1), End::Vsync);
    }
    told(&mut bench)
}

/// The table's rows without its header: case and outcome.
fn rows() -> BTreeMap<&'static str, &'static str> {
    let rows = PAGE
        .lines()
        .skip_while(|line| *line != "| case | outcome |")
        .skip(2)
        .take_while(|line| line.starts_with("| "));
    rows.filter_map(|row| {
        row.strip_prefix("| ")?
            .strip_suffix(" |")?
            .split_once(" | ")
    })
    .collect()
}

#[test]
fn each_row_has_a_case_with_its_outcome() {
    let computed = CASES.map(|(name, outcome)| (name, outcome()));
    for (name, outcome) in &computed {
        println!("| {name} | {outcome} |");
    }
    let computed: BTreeMap<_, _> = computed
        .iter()
        .map(|(name, outcome)| (*name, outcome.as_str()))
        .collect();
    assert_eq!(rows(), computed, "rows of docs/gesture.md, and outcomes");
}
