//! Tests of overflows of the board's counters: commands while a counter wraps, pauses whose duration in 32 bits seems short, and counters
//! of the engines.

use anyhow::{Context, Result, ensure};
use glint::board::{Board, Simulation, Uart};
use glint::console::Console;
use glint::gesture::{image_sensor, moving_hand};
use glint::transfer::upload;
use glint_core::wire::{MAX_FRAME, Manifest, Sender, Timing};
use glint_vectors::Model;
use indicatif::ProgressBar;
use serde::{Deserialize, Serialize};
use virtual_board::virtual_image_sensor::{Frame, Source as Pictures};
use virtual_board::virtual_mpu6050::{Chip, Imperfections, Source, State, Wires};

use crate::emulated::{Emulated, command, cycles, start, value, view};
use crate::report::progress::bar;

/// A query to the board, with the expected and the measured reply: a line of `long-uptime.csv`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Row {
    /// Time of the query.
    pub when: String,
    /// The query.
    pub what: String,
    /// The expected reply.
    pub expected: String,
    /// The measured reply.
    pub measured: String,
}

/// Commands whose replies must not change, and for each command the keys of the compared lines. Without keys all lines are compared.
const QUESTIONS: [(&str, &[&str]); 7] = [
    ("echo still", &[]),
    ("info", &["firmware_id", "scene", "size", "uart_lost"]),
    (
        "render",
        &["triangles_in", "triangles_drawn", "pixels_drawn"],
    ),
    ("view", &[]),
    ("imu", &["sensor", "failure", "saturated"]),
    ("models", &[]),
    ("selftest", &[]),
];

/// 2^32: the number of values of the counters' low words.
const WRAP: u64 = 1 << 32;
/// A pause in ms that does not interrupt the tracking of a hand.
const SHORT: u64 = 100;

/// The board and the results.
struct Bench {
    board: Emulated,
    rows: Vec<Row>,
    /// Progress in seconds of the board's time.
    bar: ProgressBar,
}

/// Makes all queries; `quick` skips the queries that need a multiple of 2^32 cycles.
///
/// # Errors
/// The firmware has not been built, or does not answer.
pub fn measure(quick: bool) -> Result<Vec<Row>> {
    let hours = if quick { 0 } else { 24 };
    let seconds = if quick { 160 } else { hours * 3600 };
    let mut bench = Bench {
        board: start()?,
        rows: Vec::new(),
        bar: bar(seconds)?.with_message("uptime"),
    };
    bench.board.inner().plug(resting_sensor());
    bench.run(1_000);
    command(&mut bench.board, "scene cube")?;
    let answers = bench.answers()?;
    bench.across("camera after an orbit of 12 frames", 100, |board| {
        let before = view(board)?;
        command(board, "orbit 12")?;
        Ok(match view(board)? == before {
            true => "back at its start".to_owned(),
            false => "elsewhere".to_owned(),
        })
    })?;
    bench.same_answers("after 2^32 cycles", &answers)?;
    bench.across("samples of a calibration", 100, |board| {
        value(board, "imu calibrate 256", "calibrated")
    })?;
    if !quick {
        bench.across("stream of 200 samples", 100, stream)?;
        bench.across("counts of an uploaded mesh", 20, upload_mesh)?;
        bench.across("counts of a frame by the soft core", 5, |board| {
            command(board, "backend cpu")?;
            let lines = command(board, "render")?;
            command(board, "backend gateware")?;
            Ok(picked(lines, &["triangles_drawn", "pixels_drawn"]))
        })?;
        bench.sensor_is_off()?;
        bench.engine_counters()?;
        // No sensor is plugged in here: the emulation of its transfers would take most of the host's time.
        let wait = hours * 3_600_000 - bench.milliseconds();
        bench.run(wait);
        bench.board.inner().plug(resting_sensor());
        bench.run(1_000);
        bench.same_answers("after 24 h", &answers)?;
        bench.clock("after 24 h", "uptime_ms", Bench::milliseconds)?;
        bench.clock("after 24 h", "video_frames", |bench| {
            bench.board.inner().blankings() & u64::from(u32::MAX)
        })?;
        bench.hand()?;
    }
    bench.bar.finish_and_clear();
    Ok(bench.rows)
}

impl Bench {
    /// The board's time in ms.
    fn milliseconds(&mut self) -> u64 {
        self.board.inner().cycles() / cycles(&mut self.board, 1)
    }

    fn run(&mut self, milliseconds: u64) {
        let end = self.board.inner().cycles() + cycles(&mut self.board, milliseconds);
        self.run_to(end);
    }

    fn run_to(&mut self, end: u64) {
        let second = cycles(&mut self.board, 1_000);
        while self.board.inner().cycles() < end {
            let board = self.board.inner();
            board.run(second.min(end - board.cycles()));
            let now = self.milliseconds();
            self.bar.set_position(now / 1_000);
        }
    }

    fn note(&mut self, when: &str, what: &str, expected: String, measured: String) {
        let [when, what] = [when, what].map(str::to_owned);
        self.rows.push(Row {
            when,
            what,
            expected,
            measured,
        });
    }

    /// Makes a query now, and again so that the cycle counter reaches a multiple of 2^32 `lead` ms after the start of the query. The
    /// replies must be equal.
    fn across(
        &mut self,
        what: &str,
        lead: u64,
        ask: impl Fn(&mut Emulated) -> Result<String>,
    ) -> Result<()> {
        let expected = ask(&mut self.board)?;
        let multiple = (self.board.inner().cycles() / WRAP + 1) * WRAP;
        let lead = cycles(&mut self.board, lead);
        self.run_to(multiple - lead);
        let measured = ask(&mut self.board)?;
        let end = self.board.inner().cycles();
        ensure!(end > multiple, "{what} took less than {lead} cycles");
        self.note("while 2^32 cycles pass", what, expected, measured);
        Ok(())
    }

    /// Returns the replies to [`QUESTIONS`].
    fn answers(&mut self) -> Result<Vec<String>> {
        let ask = |(question, words): (&str, &[&str])| {
            Ok(picked(command(&mut self.board, question)?, words))
        };
        QUESTIONS.into_iter().map(ask).collect()
    }

    fn same_answers(&mut self, when: &str, expected: &[String]) -> Result<()> {
        let found = self.answers()?;
        let names = QUESTIONS.map(|(question, _)| question);
        let answers = expected.iter().zip(&found).zip(names);
        let others = answers.filter(|((expected, found), _)| expected != found);
        let others: Vec<_> = others
            .map(|((expected, found), name)| format!("{name}: expected {expected}, found {found}"))
            .collect();
        let what = format!("replies to {}", names.join(", "));
        let same = format!("the {} of the start", QUESTIONS.len());
        let measured = if others.is_empty() {
            same.clone()
        } else {
            others.join("; ")
        };
        self.note(when, &what, same, measured);
        Ok(())
    }

    /// Tests a hand in front of the image sensor while an upload blocks the main loop for slightly more than 2^32 cycles.
    fn hand(&mut self) -> Result<()> {
        let mut sensor = image_sensor(moving_hand([320, 240]));
        let still = sensor.source.frame(0.0);
        sensor.source = Box::new(Still(still));
        // 20 frames per second with few clock periods per frame, which takes less time on the host.
        sensor.timing.clock = 4_000_000;
        sensor.timing.blank = [3, 20, 20];
        self.board.inner().plug_image_sensor(sensor);
        command(&mut self.board, "gesture on")?;
        self.run(1_000);
        let tracked: String = value(&mut self.board, "gesture", "hand")?;
        ensure!(tracked == "tracked", "the hand is {tracked}");
        let end = self.board.inner().cycles() + WRAP + cycles(&mut self.board, SHORT);
        self.hold_transfer(end)?;
        let found = value(&mut self.board, "gesture", "hand")?;
        let what = "hand that was tracked before";
        let when = "2^32 cycles and 0.1 s after the last frame";
        self.note(when, what, "appearing".to_owned(), found);
        command(&mut self.board, "gesture off")?;
        Ok(())
    }

    /// Begins an upload, and cancels it so that it ends at the cycle `end`.
    fn hold_transfer(&mut self, end: u64) -> Result<()> {
        // Number of cycles from Ctrl-C to the end of the upload.
        let effect = cycles(&mut self.board, 60);
        let mesh = cube();
        let Manifest { length, crc32 } = Manifest::of(&mesh);
        let line = format!("load {length} {crc32:08x}");
        let board = &mut self.board;
        let mut console = Console::new(board);
        console.command_with_transfer(&line, &mut |_| {})?;
        let now = board.now_ms();
        let mut frame = [0; MAX_FRAME];
        let length = Sender::new(&mesh, 1, Timing::HOST, now).poll(now, &mut frame);
        let mut said = Vec::new();
        loop {
            // Repeated opening frames prevent a time-out of the upload.
            self.board.write(&frame[..length])?;
            let left = (end - effect).saturating_sub(self.board.inner().cycles());
            let span = cycles(&mut self.board, 800);
            self.board.inner().run(left.min(span));
            if left <= span {
                break;
            }
        }
        self.board.write(b"\x03")?;
        self.run_to(end);
        self.board.inner().uart_read(&mut said);
        Ok(())
    }

    /// Tests a turning sensor that is unplugged for slightly more than 2^32 µs and plugged in again; then tests samples whose time stamps
    /// pass a multiple of 2^32 µs.
    fn sensor_is_off(&mut self) -> Result<()> {
        let attitude = |bench: &mut Self| value::<String>(&mut bench.board, "imu", "angles");
        let gaps = |bench: &mut Self| value::<u64>(&mut bench.board, "imu", "gaps");
        self.board.inner().plug(turning_sensor());
        self.run(1_000);
        let sensor = self.board.inner().unplug().context("no sensor")?;
        self.run(100);
        let (before, gaps_before) = (attitude(self)?, gaps(self)?);
        let micros = |board: &mut Emulated, micros: u64| cycles(board, 1_000) * micros / 1_000_000;
        let pause = micros(&mut self.board, WRAP) + cycles(&mut self.board, 100);
        let end = self.board.inner().cycles() + pause;
        self.run_to(end);
        self.board.inner().plug(sensor);
        while gaps(self)? == gaps_before && self.board.inner().cycles() < end + WRAP {
            self.run(1);
        }
        let when = "2^32 µs and 0.2 s after the last sample";
        let pauses = (gaps(self)? - gaps_before).to_string();
        self.note(when, "gaps in the samples", "1".to_owned(), pauses);
        let turned = attitude(self)?;
        let what = "yaw of a sensor that turns at 100 °/s, in °";
        let yaw = |angles: &str| -> Result<f64> {
            Ok(angles.split(' ').next().context("angles")?.parse()?)
        };
        // The samples after the gap change yaw by only a few tenths of a degree.
        let moved = (yaw(&turned)? - yaw(&before)? + 180.0).rem_euclid(360.0) - 180.0;
        let is_kept = moved.abs() < 1.0;
        let kept = "within 1 of that before the pause".to_owned();
        let measured = if is_kept { kept.clone() } else { turned };
        self.note(when, what, kept, measured);

        self.board.inner().unplug();
        let period = micros(&mut self.board, WRAP);
        let next = (self.board.inner().cycles() / period + 1) * period;
        let lead = cycles(&mut self.board, 100);
        self.run_to(next - 10 * lead);
        self.board.inner().plug(resting_sensor());
        self.run_to(next - lead);
        let measured = stream(&mut self.board)?;
        let when = "while 2^32 µs pass";
        self.note(when, "stream of 200 samples", STREAM.to_owned(), measured);
        self.board.inner().unplug();
        Ok(())
    }

    /// Draws frames of a field until the engines have been busy for 2^32 cycles, and compares the statistics of all frames.
    fn engine_counters(&mut self) -> Result<()> {
        const WORDS: [&str; 5] = [
            "evaluations",
            "hits",
            "misses",
            "cycles_busy",
            "pixels_drawn",
        ];
        command(&mut self.board, "field menger:4")?;
        let ask = |board: &mut Emulated| {
            Ok::<_, anyhow::Error>(picked(command(board, "render")?, &WORDS))
        };
        let expected = ask(&mut self.board)?;
        let busy: u64 = value(&mut self.board, "stats", "cycles_busy")?;
        let frames = WRAP / busy + 2;
        let mut others = Vec::new();
        for _ in 0..frames {
            let found = ask(&mut self.board)?;
            if found != expected {
                others.push(found);
            }
            let now = self.milliseconds();
            self.bar.set_position(now / 1_000);
        }
        let measured = others.pop().unwrap_or_else(|| expected.clone());
        let when = format!("in {frames} frames, {busy} cycles of the engines each");
        self.note(&when, "statistics of each frame", expected, measured);
        command(&mut self.board, "scene cube")?;
        Ok(())
    }

    /// Compares a clock of the firmware, printed by `info KEY`, with the clock `exact` of the emulated board.
    fn clock(&mut self, when: &str, key: &str, exact: fn(&mut Self) -> u64) -> Result<()> {
        let shown: u64 = value(&mut self.board, &format!("info {key}"), key)?;
        let exact = exact(self);
        // The clock may have advanced since the reply.
        let measured = match exact.abs_diff(shown) {
            0 | 1 => exact,
            _ => shown,
        };
        self.note(when, key, exact.to_string(), measured.to_string());
        Ok(())
    }
}

/// Returns the lines of a reply whose key is in `words`, or all lines if `words` is empty.
fn picked(lines: Vec<String>, words: &[&str]) -> String {
    let counts = |line: &String| {
        let word = line.split(' ').next().unwrap_or_default();
        words.is_empty() || words.contains(&word)
    };
    lines
        .into_iter()
        .filter(counts)
        .collect::<Vec<_>>()
        .join("; ")
}

const STREAM: &str = "200 samples, each at most 1.2 ms after the one before";

/// Streams samples, and reports whether the times of successive samples differ by a sample period.
fn stream(board: &mut Emulated) -> Result<String> {
    const COMMAND: &str = "imu stream 200";
    let lines = command(board, COMMAND)?;
    let time = |line: &String| line.split(',').next()?.parse::<u64>().ok();
    let times: Vec<u64> = lines.iter().filter_map(time).collect();
    let steps = times.windows(2).map(|pair| pair[1].wrapping_sub(pair[0]));
    let is_even = steps.clone().all(|step| (800..=1_200).contains(&step));
    Ok(match (is_even, times.len()) {
        (true, 200) => STREAM.to_owned(),
        (_, count) => format!("{count} samples, {:?} µs apart", steps.max()),
    })
}

/// Uploads a mesh, and reports the board's mesh statistics.
fn upload_mesh(board: &mut Emulated) -> Result<String> {
    let (mesh, _) = glint::convert::convert(
        &glint::generate::named("icosphere:5")?,
        glint::convert::Options::default(),
    )?;
    let send = |board: &mut Emulated, mesh: &[u8]| -> Result<Vec<String>> {
        upload(&mut Console::new(board), mesh, None, 1, &mut |_, _| {})?;
        let lines = command(board, "info")?;
        command(board, "unload model")?;
        Ok(lines)
    };
    let lines = send(board, &mesh)?;
    // Uploads another mesh first, because data that are already on the board would not be sent again.
    send(board, &cube())?;
    command(board, "scene cube")?;
    Ok(picked(lines, &["vertices", "triangles"]))
}

fn cube() -> Vec<u8> {
    Model::cube(8_192).encoded()
}

/// An image sensor with a constant picture.
struct Still(Frame);

impl Pictures for Still {
    fn frame(&mut self, _: f64) -> Frame {
        self.0.clone()
    }
}

fn resting_sensor() -> Wires {
    sensor(|_| State::default())
}

fn turning_sensor() -> Wires {
    sensor(|_| State {
        rate: [0.0, 0.0, 100.0],
        ..State::default()
    })
}

fn sensor(state: impl Fn(f64) -> State + Send + 'static) -> Wires {
    let imperfections = Imperfections {
        noise: 0.005,
        accel_noise: 0.0004,
        ..Imperfections::NONE
    };
    Wires::new(Chip::new(Source::Motion(Box::new(state)), imperfections, 1))
}
