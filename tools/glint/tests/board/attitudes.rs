//! Tests that a board and the model compute bit-identical attitudes from logs.

use crate::common::{assert_has, console, emulator, mesh, running_board};
use glint::fuzz::Random;
use glint::imu::log::Entry;
use glint::imu::replay::{self, Options, Replayed, Stage};
use glint::render::Route;
use glint::transfer;
use glint_core::orientation::{Counts, Units};

/// A log with every kind of event: rest, tumbling, coning, saturation of both sensors, shocks, and
/// time stamps with jitter, repetitions, backward steps and a gap.
fn eventful_log(samples: usize) -> Vec<Entry> {
    let mut random = Random::new(1, 0);
    let mut t_us = 4_294_000_000;
    let entry = |i: usize| {
        let time = i as f64 * 0.002;
        let wave = |amplitude: f64, hertz: f64, phase: f64| {
            (amplitude * (std::f64::consts::TAU * (hertz * time + phase)).sin()) as i16
        };
        let mut noise = || random.below(5) as i16 - 2;
        let [mut gyro, mut accel] = [[20, -7, 3], [-90, 40, 4_080]].map(|v| v.map(|x| x + noise()));
        match i / 500 % 4 {
            1 => {
                gyro = [
                    wave(9_000.0, 1.1, 0.0),
                    wave(12_000.0, 0.7, 0.2),
                    wave(7_000.0, 1.7, 0.4),
                ]
            }
            2 => gyro = [wave(5_000.0, 9.0, 0.0), wave(5_000.0, 9.0, 0.25), 600],
            3 => {
                gyro = [wave(60_000.0, 0.9, 0.0), 3_000, wave(60_000.0, 2.0, 0.3)];
                accel = [
                    wave(9_000.0, 1.0, 0.1),
                    wave(5_000.0, 2.0, 0.0),
                    wave(40_000.0, 0.5, 0.0),
                ];
            }
            _ => {}
        }
        t_us += match random.below(40) {
            0 if i > 500 => 0,
            1 => 6_000 + random.below(30_000) as u64,
            2..10 => 1_000 + random.below(2_000) as u64,
            _ => 2_000,
        };
        if i == 3_700 {
            t_us += 700_000;
        }
        Entry {
            line: i + 2,
            t_us: if i % 997 == 400 { t_us - 3_000 } else { t_us },
            accel,
            gyro,
            temp: None,
        }
    };
    (0..samples).map(entry).collect()
}

const EVERYTHING: Options = Options {
    units: Units::MPU_6050,
    period: None,
    still: Some(900_000),
    tilt: true,
    follow_bias: true,
};

const MOVING: Options = Options {
    still: None,
    ..EVERYTHING
};

/// Replays a log on the model and, over `route`, on the board; checks that the attitudes are equal.
fn replayed_by_both(entries: &[Entry], options: &Options, route: Route) -> [Replayed; 2] {
    let prepared = replay::prepare(entries, options).unwrap();
    let mut board = emulator();
    let mut console = console(&mut board);
    let mut reported = 0;
    let by_board = replay::on_board(&prepared, &mut console, route, &mut |stage, done, _| {
        reported = if stage == Stage::Replay {
            done
        } else {
            reported
        };
    });
    let by_board = by_board.unwrap();
    let has_progress = entries.len() > 2_048;
    assert_eq!(reported > 0, has_progress, "progress up to {reported}");
    let by_model = replay::on_model(prepared).unwrap();
    assert_eq!(by_board.counts, by_model.counts);
    assert_eq!(by_board.attitudes.len(), entries.len());
    assert!(by_board.attitudes == by_model.attitudes);
    [by_model, by_board]
}

#[test]
fn attitudes_of_a_log_are_the_models() {
    let entries = eventful_log(5_000);
    let [_, board] = replayed_by_both(&entries, &EVERYTHING, Route::Memory);
    let Counts {
        steps,
        stale,
        gaps,
        saturated,
        rejected,
    } = board.counts;
    println!("{:?}, {:?} cycles a sample", board.counts, board.cycles);
    // The log contains more than 50 samples of each of these kinds, and one gap, so every counter is tested.
    assert!([stale, saturated, rejected].iter().all(|&count| count > 50));
    assert!(steps > 4_000 && gaps == 1);
}

#[test]
fn attitudes_of_a_log_come_over_the_line() {
    let entries = eventful_log(600);
    let options = Options {
        tilt: false,
        follow_bias: false,
        ..MOVING
    };
    replayed_by_both(&entries, &options, Route::Serial);
}

#[test]
fn a_bad_log_is_refused_and_no_attitudes_are_left() {
    let prepared = replay::prepare(&eventful_log(70), &MOVING).unwrap();
    let mut board = running_board();
    let mut console = console(&mut board);
    let quiet: &mut dyn FnMut(Stage, u64, u64) = &mut |_, _, _| {};
    replay::on_board(&prepared, &mut console, Route::Memory, quiet).unwrap();
    let mesh = mesh("cube");
    let refused = transfer::upload_for(
        &mut console,
        "replay",
        &mesh,
        1,
        &mut |_, _| {},
        &mut |_| {},
    );
    let refused = refused.unwrap_err().to_string();
    assert_has(&refused, "replay: log: expected \"GIMU\" at the start");
    let refused = console.command("replay").unwrap_err().to_string();
    assert_has(&refused, "expected an upload of a log first");
}
