//! The page `imu.md`: errors of the orientation against the samples it takes, over time, and where it is hard.

use std::fmt::Write as _;
use std::path::PathBuf;

use anyhow::{Context, Result};
use glint::board::{SimulatedBoard, built_firmware};
use glint::console::Console;
use glint::imu::log::Entry;
use glint::imu::replay::{self, Options, Stage};
use glint::transfer::Route;
use glint_core::calibration::{RestBias, Units};
use glint_core::orientation::{Gain, Sample};
use glint_reference::imu::filter::Filter;
use glint_reference::imu::measure::{
    LEFT_BIAS, TAU, against_f64, calibrated, filter_inclination, inclination, method_error,
    tracker, yaw_drift,
};
use glint_reference::imu::method::Method;
use glint_reference::imu::motion::Motion;
use glint_reference::imu::quaternion::Quaternion;
use glint_reference::imu::sensor::Sensor;
use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;

use crate::cycles::{Cycles, Source};
use crate::in_workspace;
use crate::plot::{self, Diagram, Point};
use crate::table::{Provenance, write_csv};

#[derive(clap::Args)]
pub struct Arguments {
    /// Print the targets as JSON instead of a table
    #[arg(long)]
    json: bool,
    /// A tenth of each long motion, without the day (half a minute instead of ten)
    #[arg(long)]
    quick: bool,
    /// Folder for imu.md and its tables and diagrams [default: docs/report, or target/report with --quick]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    cycles: Source,
}

/// What a method is called on the soft core; two are not there.
fn kernel(method: Method) -> Option<&'static str> {
    match method {
        Method::Angles => Some("angles"),
        Method::FirstOrder => Some("first_order"),
        Method::Newest => Some("newest"),
        Method::Trapezoid => Some("trapezoid"),
        Method::Parabola => Some("parabola"),
        Method::Cubic => Some("cubic"),
        Method::Coning | Method::PlainCubic => None,
    }
}

/// Samples a second at which methods are compared.
const RATES: [f64; 5] = [50.0, 100.0, 200.0, 500.0, 1000.0];
const TUMBLE: Motion = Motion::Tumble(700.0);
const CONING: Motion = Motion::Coning {
    angle: 5.0,
    frequency: 10.0,
};
const SPIN: Motion = Motion::Spin([0.0, 0.0, 1990.0]);
const COUNT: Motion = Motion::Spin([1.0 / 16.4, 0.0, 0.0]);
/// The angle random walk of 0.1 °/s of noise at 1 kHz, in ° for the root of a second.
const WALK: f64 = 0.1 * 0.031_622_776_601_683_79;

/// Something that is asked: a line of `imu.csv`.
#[derive(Serialize)]
struct Target {
    what: String,
    unit: &'static str,
    at_least: f64,
    aim: f64,
    measured: f64,
    /// `aim`, `at least` or `missed`.
    reached: &'static str,
    commit: String,
}

/// A method at a rate: a line of `imu-methods.csv`.
#[derive(Serialize)]
struct Trial {
    motion: &'static str,
    method: &'static str,
    shipped: bool,
    rate: f64,
    /// In degrees, after 20 s.
    error: f64,
    /// By how many powers of the step the error fell from the rate before.
    order: Option<f64>,
    /// The median of a sample's on the soft core, where the method is there.
    cycles: Option<u64>,
    commit: String,
}

/// A way to hold the tilt: a line of `imu-filters.csv`. Degrees, RMS.
#[derive(Serialize)]
struct Tilted {
    filter: String,
    shipped: bool,
    rest: f64,
    hand: f64,
    nod: f64,
    walk: f64,
    commit: String,
}

/// Something that is hard: a line of `imu-stiff.csv`.
#[derive(Serialize)]
struct Stiff {
    case: String,
    /// What another way comes to.
    other: String,
    glint: String,
    outcome: String,
}

/// Errors at a time: a line of `imu-time.csv`. Degrees.
#[derive(Serialize)]
struct Moment {
    seconds: f64,
    numeric: f64,
    counts: f64,
    sensor: f64,
    floor: f64,
}

pub fn report(arguments: &Arguments) -> Result<()> {
    let provenance = Provenance::find();
    let commit = &provenance.commit;
    let part = if arguments.quick { 0.1 } else { 1.0 };
    let soft_core = soft_core(arguments, (100_000.0 * part) as u64)?;
    let bar = ProgressBar::new(5);
    bar.set_style(ProgressStyle::with_template(
        "{msg:28} {wide_bar} {pos}/{len}, {elapsed}",
    )?);
    let step = |what: &'static str| {
        bar.set_message(what);
        bar.tick();
    };
    step("targets");
    let targets = targets(part, commit);
    bar.inc(1);
    step("methods");
    let trials = methods(&soft_core.kernels, commit);
    bar.inc(1);
    step("filters");
    let filters = filters(part, commit);
    bar.inc(1);
    step("stiff cases");
    let stiff = stiff(part, !arguments.quick);
    bar.inc(1);
    step("error over time");
    let moments = moments(190.0 * part);
    bar.finish_and_clear();

    if arguments.json {
        println!("{}", serde_json::to_string_pretty(&targets)?);
    } else {
        print!("{}", target_table(&targets)?);
    }
    let out = match &arguments.out {
        Some(out) => out.clone(),
        None => in_workspace(if arguments.quick {
            "target/report"
        } else {
            "docs/report"
        }),
    };
    std::fs::create_dir_all(&out)
        .with_context(|| format!("cannot make the folder {}", out.display()))?;
    write_csv(&targets, &out.join("imu.csv"))?;
    write_csv(&trials, &out.join("imu-methods.csv"))?;
    write_csv(&filters, &out.join("imu-filters.csv"))?;
    write_csv(&stiff, &out.join("imu-stiff.csv"))?;
    write_csv(&moments, &out.join("imu-time.csv"))?;
    for motion in ["tumble", "coning"] {
        let diagram = Diagram {
            title: if motion == "tumble" {
                "Tumble of 700 °/s: error against cycles"
            } else {
                "Coning of 5° at 10 Hz: error against cycles"
            },
            across: "error after 20 s, in degrees",
            up: "cycles a second",
        };
        let points: Vec<Point> = trials
            .iter()
            .filter(|trial| trial.motion == motion)
            .map(|trial| Point {
                family: trial.method.to_owned(),
                label: format!("{} Hz", trial.rate),
                error: trial.error,
                cost: trial.cycles.map(|cycles| cycles as f64 * trial.rate),
                shipped: trial.shipped,
            })
            .collect();
        plot::write(&diagram, &points, &out.join(format!("imu-{motion}.svg")))?;
    }
    draw_moments(&moments, &out)?;
    let page = page(
        &targets,
        &soft_core,
        &trials,
        &filters,
        &stiff,
        part,
        &provenance,
    )?;
    std::fs::write(out.join("imu.md"), page)
        .with_context(|| format!("cannot write imu.md to {}", out.display()))?;
    eprintln!("wrote imu.md and its tables to {}", out.display());
    Ok(())
}

fn targets(part: f64, commit: &str) -> Vec<Target> {
    let mut rows = Vec::new();
    let mut norm = 0.0_f64;
    let mut add = |what: String, unit, [at_least, aim]: [f64; 2], measured: f64| {
        rows.push(Target {
            what,
            unit,
            at_least,
            aim,
            measured,
            reached: if measured <= aim {
                "aim"
            } else if measured <= at_least {
                "at least"
            } else {
                "missed"
            },
            commit: commit.to_owned(),
        });
    };
    let hour = 3600.0 * part;
    for (name, sensor, motion, seconds, limits) in [
        (
            "a hand's motion",
            Sensor::real(1000.0),
            Motion::Hand,
            190.0,
            [0.01, 0.001],
        ),
        (
            "a tumble of 500 °/s",
            Sensor::ideal(1000.0),
            Motion::Tumble(500.0),
            hour,
            [0.05, 0.002],
        ),
        (
            "1990 °/s about one axis",
            Sensor::ideal(1000.0),
            SPIN,
            hour,
            [0.2, 0.04],
        ),
        (
            "1 count about one axis",
            Sensor::ideal(1000.0),
            COUNT,
            24.0 * hour,
            [0.05, 1e-5],
        ),
    ] {
        let largest = against_f64(sensor, motion, seconds, false);
        norm = norm.max(largest.norm);
        let what =
            format!("the same method in f64 on the same counts: {name}, {seconds} s at 1 kHz");
        add(what, "°", limits, largest.angle);
    }
    let hand = against_f64(Sensor::real(200.0), Motion::Hand, 190.0, true);
    norm = norm.max(hand.norm);
    add(
        "the same with the accelerometer, 190 s at 200 Hz".into(),
        "°",
        [0.01, 0.001],
        hand.angle,
    );
    add("length, in all of these".into(), "", [1e-8, 2e-9], norm);
    for (name, motion, limits) in [
        ("a tumble of 700 °/s", TUMBLE, [0.1, 0.01]),
        ("coning of 5° at 10 Hz", CONING, [0.1, 0.05]),
    ] {
        let error = method_error(Method::Cubic, motion, 20.0, 200.0);
        add(
            format!("the method against the truth: {name}, 20 s at 200 Hz"),
            "°",
            limits,
            error,
        );
    }
    for (name, motion) in [
        ("a hand, mostly to the sides", Motion::Hand),
        ("a hand, mostly up and down", Motion::Nod),
        ("a walk", Motion::Walk),
    ] {
        let errors = inclination(Sensor::real(1000.0), motion, 60.0);
        add(
            format!("inclination, RMS: {name}, 60 s at 1 kHz"),
            "°",
            [2.0, 1.0],
            errors.rms(),
        );
    }
    if let Ok(found) = calibrated(Sensor::real(1000.0), Motion::Rest) {
        for (name, follow) in [("kept", false), ("followed", true)] {
            let drift = yaw_drift(Sensor::real(1000.0), &found, part, follow);
            add(
                format!("yaw at rest after calibration, {part} h, the bias {name}"),
                "°/h",
                [10.0, 10.0],
                drift.abs(),
            );
        }
    }
    rows
}

fn methods(cycles: &Cycles, commit: &str) -> Vec<Trial> {
    let mut trials = Vec::new();
    for (name, motion) in [("tumble", TUMBLE), ("coning", CONING)] {
        for method in Method::ALL {
            let mut before: Option<[f64; 2]> = None;
            for rate in RATES {
                let error = method_error(method, motion, 20.0, rate);
                let order = before.map(|[last, at]| (at / error).log2() / (rate / last).log2());
                before = Some([rate, error]);
                trials.push(Trial {
                    motion: name,
                    method: method.name(),
                    shipped: method == Method::Cubic,
                    rate,
                    error,
                    order,
                    cycles: kernel(method).and_then(|name| Some(cycles.get(name)?.median)),
                    commit: commit.to_owned(),
                });
            }
        }
    }
    trials
}

fn filters(part: f64, commit: &str) -> Vec<Tilted> {
    let seconds = (120.0 * part).max(30.0);
    let mahony = Filter::Mahony {
        proportional: 0.74,
        integral: 0.0012,
    };
    let gated = |low, high| Filter::Gated {
        tau: TAU,
        range: [low, high],
    };
    [
        Filter::None,
        Filter::Complementary(TAU),
        mahony,
        Filter::LowPass(TAU),
        Filter::Tilt(1.0),
        Filter::Tilt(TAU),
        Filter::Tilt(10.0),
        gated(0.5, 1.5),
        gated(0.9, 1.1),
    ]
    .map(|filter| {
        let rms = |motion| filter_inclination(filter, Sensor::real(200.0), motion, seconds).rms();
        Tilted {
            filter: filter.name(),
            shipped: filter == Filter::Tilt(TAU),
            rest: rms(Motion::Rest),
            hand: rms(Motion::Hand),
            nod: rms(Motion::Nod),
            walk: rms(Motion::Walk),
            commit: commit.to_owned(),
        }
    })
    .into()
}

fn stiff(part: f64, day: bool) -> Vec<Stiff> {
    let mut rows = gains();
    rows.extend(words(part));
    rows.push(rest_cycle());
    rows.extend(uneven());
    rows.push(saturation());
    rows.extend(squares());
    if day {
        for (name, motion) in [("1 count", COUNT), ("1990 °/s", SPIN)] {
            let largest = against_f64(Sensor::ideal(1000.0), motion, 86_400.0, false);
            rows.push(Stiff {
                case: format!("{name} about one axis for 24 h at 1 kHz"),
                other: String::new(),
                glint: format!(
                    "{:.1e}° from f64, length within {:.1e}",
                    largest.angle, largest.norm
                ),
                outcome: "bounded".into(),
            });
        }
    }
    rows
}

/// One step of a filter of first order, explicit and exact.
fn gains() -> Vec<Stiff> {
    [1e-4, 1e-3, 1e-2, 0.1, 0.5, 1.0, 1.9, 2.1, 5.0, 10.0]
        .map(|ratio: f64| {
            let step = 10_000;
            let time_constant = (f64::from(step) / ratio).round() as u32;
            let gain = f64::from(Gain::new(time_constant).of(step)) / 2f64.powi(32);
            // The time constant has whole microseconds.
            let ratio = f64::from(step) / f64::from(time_constant);
            let explicit = 1.0 - ratio;
            let outcome = match ratio {
                x if x > 2.0 => "explicit diverges, exact is monotone",
                x if x > 1.0 => "explicit oscillates, exact is monotone",
                _ => "both are monotone",
            };
            Stiff {
                case: format!("dt/τ = {ratio:.4}: what a step leaves of an error"),
                other: format!("explicit {explicit:.6}"),
                glint: format!(
                    "{:.9}, off by {:.1e}",
                    1.0 - gain,
                    (gain + (-ratio).exp_m1()).abs()
                ),
                outcome: outcome.into(),
            }
        })
        .into()
}

/// A bias of 1 LSB, learnt with a mean of so many fraction bits.
fn words(part: f64) -> Vec<Stiff> {
    [10, 100, 1000]
        .map(|time_constant: u32| {
            let gain = u64::from(Gain::new(time_constant * 1_000_000).of(1_000));
            let steps = (f64::from(5 * time_constant) * 1000.0 * part) as u64;
            let learnt = |bits: u32| {
                let one = 1_i64 << bits;
                let mut mean = 0_i64;
                for _ in 0..steps {
                    mean += (((one - mean) as u64 * gain + (1 << 31)) >> 32) as i64;
                }
                mean as f64 / one as f64
            };
            let exact = 1.0 - (-(steps as f64) * 1e-3 / f64::from(time_constant)).exp();
            let others: Vec<String> = [16, 20, 24, 28]
                .map(|bits| format!("{bits} bits {:.3}", learnt(bits)))
                .into();
            Stiff {
                case: format!(
                    "bias with τ = {time_constant} s at 1 kHz: learnt of 1 LSB after {:.0} s, exactly {exact:.5}",
                    steps as f64 * 1e-3
                ),
                other: others.join(", "),
                glint: format!("{:.5}", learnt(32)),
                outcome: "32 bits follow; short words stand still or run ahead".into(),
            }
        })
        .into()
}

/// The attitude at rest without noise, where a limit cycle would show.
fn rest_cycle() -> Stiff {
    let mut tracker = tracker(&Sensor::ideal(1000.0), true);
    let mut first: Option<Quaternion> = None;
    let mut moved = 0.0_f64;
    for i in 0..1_000_000_u32 {
        tracker.on_sample(&Sample {
            t_us: i * 1_000,
            accel: [713, -391, 4_011],
            gyro: [0; 3],
        });
        if i >= 500_000 {
            let attitude = Quaternion::from(tracker.attitude());
            moved = moved.max(first.get_or_insert(attitude).angle_to(attitude));
        }
    }
    Stiff {
        case:
            "tilted and at rest for 1000 s, no noise: how far the attitude moves in the second half"
                .into(),
        other: String::new(),
        glint: format!("{moved:.1e}°"),
        outcome: "no limit cycle".into(),
    }
}

/// Samples that are not where they should be, by their stamps and as if they were.
fn uneven() -> Vec<Stiff> {
    let even = Sensor::ideal(200.0);
    let error = |sensor: Sensor, stamped: bool| {
        let mut tracker = tracker(&sensor, false);
        let mut end = 0;
        for (i, mut sample) in sensor.samples(TUMBLE, 4_001, 5).enumerate() {
            end = sample.t_us;
            if !stamped {
                sample.t_us = i as u32 * 5_000;
            }
            tracker.on_sample(&sample);
        }
        let truth = TUMBLE.attitude_after(f64::from(end) * 1e-6, 200.0);
        truth.angle_to(tracker.attitude().into())
    };
    [
        ("even samples", even),
        (
            "jitter of ±30 %",
            Sensor {
                jitter: 0.3,
                ..even
            },
        ),
        ("1 % of the samples lost", Sensor { lost: 0.01, ..even }),
        (
            "both",
            Sensor {
                jitter: 0.3,
                lost: 0.01,
                ..even
            },
        ),
    ]
    .map(|(name, sensor)| Stiff {
        case: format!("a tumble of 700 °/s, 20 s at 200 Hz, {name}: error at the end"),
        other: format!("as if even {:.2e}°", error(sensor, false)),
        glint: format!("{:.2e}°", error(sensor, true)),
        outcome: "the stamps say where samples are".into(),
    })
    .into()
}

/// A gyroscope at the end of its range for 30 ms in a hand.
fn saturation() -> Stiff {
    let sensor = Sensor::real(1000.0);
    let mut tracker = tracker(&sensor, true);
    let mut errors = [0.0; 3];
    for (i, mut sample) in sensor.samples(Motion::Hand, 60_000, 6).enumerate() {
        if (20_000..20_030).contains(&i) {
            sample.gyro[0] = i16::MAX;
        }
        tracker.on_sample(&sample);
        let Some(truth) = Motion::Hand.attitude(f64::from(sample.t_us) * 1e-6) else {
            continue;
        };
        let error = truth.inclination_to(tracker.attitude().into());
        match i {
            20_029 => errors[0] = error,
            23_030 => errors[1] = error,
            30_030 => errors[2] = error,
            _ => {}
        }
    }
    Stiff {
        case: "saturation: x at its end for 30 ms in a hand's motion at 1 kHz: inclination when it ends, after 3 s, after 10 s".into(),
        other: String::new(),
        glint: format!("{:.1}°, {:.1}°, {:.2}°", errors[0], errors[1], errors[2]),
        outcome: format!("flagged {} times; the yaw of that time is lost", tracker.counts().saturated),
    }
}

/// Motion that has no mean.
fn squares() -> Vec<Stiff> {
    [(1500.0, 1.0), (1500.0, 0.1), (5.0, 0.1)]
        .map(|(rate, frequency)| {
            let motion = Motion::Square { rate, frequency };
            let sensor = Sensor {
                bias: [0.0; 3],
                ..Sensor::real(1000.0)
            };
            let mut tracker = tracker(&sensor, true);
            tracker.follow_bias(RestBias::new(Units::MPU_6050, [0; 3]));
            for sample in sensor.samples(motion, 60_000, 7) {
                tracker.on_sample(&sample);
            }
            let learnt = tracker.bias().iter().map(|x| x.abs()).max().unwrap_or(0);
            Stiff {
                case: format!("±{rate} °/s, square, {frequency} Hz, 60 s: learnt as bias"),
                other: String::new(),
                glint: format!("{:.3} LSB", f64::from(learnt) / 256.0),
                outcome: "not learnt".into(),
            }
        })
        .into()
}

/// Errors over time in a hand: by numbers, by counts, and by the noise of the sensor beside its floor.
fn moments(seconds: f64) -> Vec<Moment> {
    let motion = Motion::Hand;
    let ideal = Sensor::ideal(1000.0);
    let real = Sensor::real(1000.0);
    let count = (seconds * 1000.0) as u64 + 1;
    let start = motion.attitude(0.0).unwrap_or(Quaternion::IDENTITY);
    let mut trackers = [tracker(&ideal, false), tracker(&real, false)];
    let mut twin = glint_reference::imu::filter::Estimator::new(
        Method::Cubic,
        Filter::None,
        ideal.gyro_lsb,
        ideal.accel_lsb,
    );
    let mut moments = Vec::new();
    let mut due = 0.1;
    for (exact, noisy) in ideal
        .samples(motion, count, 8)
        .zip(real.samples(motion, count, 8))
    {
        trackers[0].on_sample(&exact);
        trackers[1].on_sample(&noisy);
        twin.on_sample(&exact);
        let seconds = f64::from(exact.t_us) * 1e-6;
        if seconds < due {
            continue;
        }
        due *= 1.05;
        let Some(truth) = motion.attitude(seconds) else {
            continue;
        };
        let truth = start.inverse().times(truth);
        let attitudes = trackers
            .each_ref()
            .map(|tracker| Quaternion::from(tracker.attitude()));
        moments.push(Moment {
            seconds,
            numeric: attitudes[0].angle_to(twin.attitude()),
            counts: attitudes[0].angle_to(truth),
            sensor: attitudes[1].angle_to(truth),
            floor: WALK * seconds.sqrt(),
        });
    }
    moments
}

fn draw_moments(moments: &[Moment], out: &std::path::Path) -> Result<()> {
    let series = |error: fn(&Moment) -> f64| -> Vec<(f64, f64)> {
        let point = |moment: &Moment| (moment.seconds, error(moment).max(1e-8));
        moments.iter().map(point).collect()
    };
    plot::write_lines(
        &Diagram {
            title: "A hand's motion at 1 kHz: errors over time",
            across: "seconds",
            up: "error in degrees",
        },
        &[
            ("firmware against f64", series(|moment| moment.numeric)),
            ("counts against truth", series(|moment| moment.counts)),
            ("with the sensor's noise", series(|moment| moment.sensor)),
        ],
        &plot::Band {
            name: "noise alone, one to three standard deviations",
            low: series(|moment| moment.floor),
            high: series(|moment| 3.0 * moment.floor),
        },
        &out.join("imu-time.svg"),
    )
}

/// A limit with the digits that it has.
fn plain(limit: f64) -> String {
    if limit < 1e-3 {
        format!("{limit:e}")
    } else {
        format!("{limit}")
    }
}

/// An error with two digits.
fn shown(error: f64) -> String {
    if error < 0.01 {
        format!("{error:.1e}")
    } else {
        format!("{error:.2}")
    }
}

fn target_table(targets: &[Target]) -> Result<String> {
    let mut text =
        String::from("| what | at least | aim | measured | reached |\n|---|---:|---:|---:|---|\n");
    for target in targets {
        writeln!(
            text,
            "| {} | {}{unit} | {}{unit} | {}{unit} | {} |",
            target.what,
            plain(target.at_least),
            plain(target.aim),
            shown(target.measured),
            target.reached,
            unit = target.unit,
        )?;
    }
    Ok(text)
}

/// What a sample takes as it is shipped.
fn cycles_table(cycles: &Cycles) -> Result<String> {
    let mut text = String::from(
        "| cycles a sample, as shipped | at least | aim | median | most |\n|---|---:|---:|---:|---:|\n",
    );
    for (name, what, at_least, aim) in [
        ("cubic", "integration, even steps", 800, 500),
        ("cubic_jitter", "integration, uneven steps", 800, 500),
        ("cubic_tilt", "with tilt, even steps", 2_000, 1_200),
        ("cubic_tilt_jitter", "with tilt, uneven steps", 2_000, 1_200),
    ] {
        let figures = cycles
            .get(name)
            .with_context(|| format!("`bench attitude` has no {name}"))?;
        writeln!(
            text,
            "| {what} | {at_least} | {aim} | {} | {} |",
            figures.median, figures.max
        )?;
    }
    text.push_str(
        "\nMeans of runs of 64 samples at 200 Hz; the median and the largest of 16 of them.\n",
    );
    Ok(text)
}

/// The soft core: what methods take, and its attitudes beside those of this machine, of the same counts.
struct SoftCore {
    kernels: Cycles,
    samples: u64,
    /// Those that are not the same, bit for bit.
    differing: usize,
    /// Of a sample, in the mean.
    cycles: u64,
}

/// Runs the methods on the virtual board, then a hand's motion at 1 kHz with everything that the firmware has.
fn soft_core(arguments: &Arguments, samples: u64) -> Result<SoftCore> {
    let kernels = arguments.cycles.measure("attitude")?;
    let counts = Sensor::real(1000.0).samples(Motion::Hand, samples, 1);
    let entries: Vec<Entry> = counts
        .map(|sample| Entry {
            line: 0,
            t_us: sample.t_us.into(),
            accel: sample.accel,
            gyro: sample.gyro,
            temp: None,
        })
        .collect();
    let options = Options {
        units: Units::MPU_6050,
        period: None,
        still: None,
        tilt: true,
        follow_bias: true,
    };
    let prepared = replay::prepare(&entries, &options)?;
    let firmware = built_firmware(Some(&arguments.cycles.firmware()))?;
    let mut board = SimulatedBoard::fast(&firmware)?;
    let mut console = Console::new(&mut board);
    console.greet()?;
    let bar = ProgressBar::new(samples).with_style(ProgressStyle::with_template(
        "the soft core {wide_bar} {pos}/{len} samples, {eta} left",
    )?);
    let by_board = replay::on_board(
        &prepared,
        &mut console,
        Route::Memory,
        &mut |stage, done, _| {
            if stage == Stage::Replay {
                bar.set_position(done);
            }
        },
    )?;
    bar.finish_and_clear();
    let by_model = replay::on_model(prepared)?;
    let pairs = by_board.attitudes.iter().zip(&by_model.attitudes);
    Ok(SoftCore {
        kernels,
        samples,
        differing: pairs.filter(|(board, model)| board != model).count(),
        cycles: by_board.cycles.context("a board tells its cycles")?,
    })
}

fn page(
    targets: &[Target],
    soft_core: &SoftCore,
    trials: &[Trial],
    filters: &[Tilted],
    stiff: &[Stiff],
    part: f64,
    provenance: &Provenance,
) -> Result<String> {
    let mut text = String::from(
        "# Orientation: errors of the attitude\n\n\
         Generated by `cargo xtask report imu`; the same numbers are in [imu.csv](imu.csv), [imu-methods.csv](imu-methods.csv), \
         [imu-filters.csv](imu-filters.csv), [imu-stiff.csv](imu-stiff.csv) and [imu-time.csv](imu-time.csv).\n\n\
         The firmware's integers are compared with the same method in f64 on the same counts, and that method with the truth: what is lost by \
         words of 32 and 64 bits is one thing, what is lost between samples another. Sensors have ±2000 °/s, ±8 g, and where noise is \
         said 0.1 °/s and 0.004 g of it in a sample and a bias of (4.5, 0.05, 1.1) °/s, of which ",
    );
    writeln!(
        text,
        "{LEFT_BIAS:?} °/s are left where the tilt is measured.\n\n## Targets\n"
    )?;
    text.push_str(&target_table(targets)?);
    if part < 1.0 {
        writeln!(text, "\nLong motions were {part} of their length.")?;
    }
    text.push_str(
        "\n## Methods\n\n\
         Errors after 20 s, in degrees, by samples a second, with the observed order between the last two. What the firmware \
         uses is ringed in the diagrams. Cycles are those of a sample on the soft core, without the accelerometer, one after the other on the \
         virtual board: the cubic's as it is shipped, from the memory beside the processor, the others' from main memory, where the instruction cache of 4 KiB \
         may be against them. Errors are those of the method in f64.\n\n\
         ![Error against cycles a second, a tumble](imu-tumble.svg)\n\n\
         ![Error against cycles a second, coning](imu-coning.svg)\n\n\
         | motion | method | cycles | 50 | 100 | 200 | 500 | 1000 | order |\n|---|---|---:|---:|---:|---:|---:|---:|---:|\n",
    );
    for rows in trials.chunks(RATES.len()) {
        let Some(last) = rows.last() else {
            continue;
        };
        let mark = if last.shipped { "**" } else { "" };
        let cycles = last
            .cycles
            .map_or_else(|| "–".into(), |cycles| cycles.to_string());
        write!(
            text,
            "| {} | {mark}{}{mark} | {cycles} |",
            last.motion, last.method
        )?;
        for row in rows {
            write!(text, " {:.1e} |", row.error)?;
        }
        writeln!(text, " {:.1} |", last.order.unwrap_or(f64::NAN))?;
    }
    text.push_str(
        "\nErrors near 180° are those of an attitude that is lost; an order says nothing there. Rates added to angles do not come nearer to the truth with more samples: \
         it is another equation. The cubic and the plain cubic differ in one coefficient, which makes the firmware's drift of coning a ninth \
         (see `glint_core::orientation`). \
         The plain cubic would take the same cycles, the trapezoid with coning some more than without; neither is on the soft core.\n\n",
    );
    let SoftCore {
        kernels,
        samples,
        differing,
        cycles,
    } = soft_core;
    text.push_str(&cycles_table(kernels)?);
    writeln!(
        text,
        "\nOf {samples} samples of a hand's motion at 1 kHz the soft core made {differing} attitudes that differ from this machine's in any bit, \
         with the tilt and a bias that is followed, in {cycles} cycles a sample."
    )?;
    text.push_str(
        "\n## Over time\n\n\
         ![Errors over time](imu-time.svg)\n\n\
         A hand's motion by the gyroscope alone, its bias known to 1/256 LSB. The band is what the noise of the rate alone adds up to.\n\n\
         ## The tilt\n\n\
         RMS of the inclination's error in degrees, after ten seconds, at 200 Hz, in f64.\n\n\
         | filter | rest | hand, to the sides | hand, up and down | walk |\n|---|---:|---:|---:|---:|\n",
    );
    for row in filters {
        let mark = if row.shipped { "**" } else { "" };
        writeln!(
            text,
            "| {mark}{}{mark} | {:.2} | {:.2} | {:.2} | {:.2} |",
            row.filter, row.rest, row.hand, row.nod, row.walk
        )?;
    }
    text.push_str(
        "\nRange gates make a walk worse and not better: they leave out one part of a movement and not the part that undoes it. The low pass of second \
         order, which is VQF's without its bias, is better still in a hand. It would take a second attitude and three filters; what is aimed at is reached without.\n\n\
         ## Stiff and extreme\n\n\
         | case | other ways | Glint | outcome |\n|---|---|---|---|\n",
    );
    for row in stiff {
        writeln!(
            text,
            "| {} | {} | {} | {} |",
            row.case, row.other, row.glint, row.outcome
        )?;
    }
    writeln!(
        text,
        "\n## Omissions\n\n\
         - Cycles of the filters that are not on the soft core.\n\
         - Optical ground truth: all motions here are made by formulas.\n\n\
         Made at commit {} with {}.",
        provenance.commit, provenance.tools
    )?;
    Ok(text)
}
