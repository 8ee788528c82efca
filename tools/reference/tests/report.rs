//! `report sine --quick`: the files are written, the shipped kernels keep their promises, and the committed table is
//! what the code gives. So are those of `report raymarch`, as far as that is cheap, and of `report imu`.

use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use glint_core::field::Field;
use glint_core::stereo::Stereo;
use glint_model::raymarch::{FieldOptions, FieldSetup, Prepass};
use glint_reference::field::raymarched::{Measured, others, picture, rounds, sponges};
use glint_reference::field::verilated::Raymarcher;
use glint_reference::field::views;
use glint_reference::imu::measure::method_error;
use glint_reference::imu::method::Method;
use glint_reference::imu::motion::Motion;
use glint_reference::sine::subjects::subjects;
use glint_reference::sine::sweep::sweep;
use serde_json::Value;

/// Console lines as the firmware prints them, so that no board is needed.
const TRANSCRIPT: &str = "bench sin_cos_q14 min 1 median 2 max 3 cycles\nok\n";

fn folder() -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("report");
    fs::create_dir_all(&folder).expect("the build's own folder is writable");
    folder
}

fn quick(folder: &Path) -> Vec<Value> {
    let transcript = folder.join("transcript.txt");
    fs::write(&transcript, TRANSCRIPT).expect("writable");
    let output = Command::new(env!("CARGO_BIN_EXE_report"))
        .args(["sine", "--quick", "--json", "--out"])
        .arg(folder)
        .arg("--transcript")
        .arg(&transcript)
        .output()
        .expect("the report runs");
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    serde_json::from_slice(&output.stdout).expect("--json prints JSON")
}

#[test]
fn a_quick_report_is_written_and_the_shipped_kernels_keep_their_promises() {
    let folder = folder();
    let rows = quick(&folder);
    let shipped: Vec<&Value> = rows.iter().filter(|row| row["shipped"] == true).collect();
    assert_eq!(shipped.len(), 3);
    for row in shipped {
        let limit = if row["kernel"] == "sin_cos_q14" {
            1.0
        } else {
            2.0
        };
        assert!(
            row["max_ulp"].as_f64().is_some_and(|ulp| ulp <= limit),
            "{row:#}"
        );
        assert_eq!(row["asymmetric"], 0, "{row:#}");
    }
    assert_eq!(rows[0]["inputs"], "all 2^16 phases of 16 bits");
    assert_eq!(rows[0]["cycles_median"], 2);
    assert!(
        rows.iter()
            .all(|row| row["kernel"] == "sin_cos_q14" || row["cycles_median"].is_null())
    );

    let read = |name: &str| fs::read_to_string(folder.join(name)).expect("the report writes it");
    assert_eq!(read("sine.csv").lines().count(), rows.len() + 1);
    assert!(read("sine.svg").starts_with("<svg"));
    let page = read("sine.md");
    assert!(
        page.contains("| **sin_cos_q14** |")
            && page.contains("1 / 2 / 3")
            && page.contains("not measured")
    );
}

/// Recomputes the rows of docs/report/sine.csv that take less than a second.
#[test]
fn the_committed_table_is_not_stale() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/report/sine.csv");
    let mut table = csv::Reader::from_path(&path).expect("docs/report/sine.csv is committed");
    let header = table.headers().expect("a header").clone();
    let column = |name: &str| {
        header
            .iter()
            .position(|column| column == name)
            .expect("a column")
    };
    let [kernel, inputs, samples, max, rms] =
        ["kernel", "inputs", "samples", "max_err", "rms"].map(column);
    let rows: Vec<csv::StringRecord> = table.records().collect::<Result<_, _>>().expect("CSV");
    assert_eq!(
        rows.len(),
        subjects().len(),
        "run `cargo xtask report sine`: kernels have come or gone"
    );
    let mut recomputed = 0;
    for (row, subject) in rows.iter().zip(subjects()) {
        assert_eq!(
            (&row[kernel], &row[inputs]),
            (subject.kernel, subject.inputs),
            "run `cargo xtask report sine`"
        );
        if subject.steps() > 1 << 19 {
            continue;
        }
        let statistics = sweep(&subject, 1, &|_| ());
        let close = |column: usize, now: f64| {
            let committed: f64 = row[column].parse().expect("a number");
            assert!(
                (committed - now).abs() <= 1e-6 * now,
                "{}: {} is {committed:e} in the table and {now:e} now: run `cargo xtask report sine`",
                subject.kernel,
                &header[column],
            );
        };
        assert_eq!(row[samples], statistics.inputs.to_string());
        close(max, statistics.max);
        close(rms, statistics.rms());
        recomputed += 1;
    }
    assert!(recomputed >= 2);
}

/// The rows of a table of docs/report, by the names of their columns.
fn committed(name: &str) -> Vec<HashMap<String, String>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../docs/report")
        .join(name);
    let mut table = csv::Reader::from_path(&path).unwrap_or_else(|error| panic!("{name}: {error}"));
    table.deserialize().collect::<Result<_, _>>().expect("CSV")
}

/// Counts the evaluations of the sponge's small frames again, whose cycles are those of the whole SoC.
#[test]
fn the_committed_frames_a_second_are_of_these_frames() {
    let rows = committed("raymarch-rates.csv");
    let mut counted = 0;
    let cheap = |row: &&HashMap<_, _>| row["field"] == "menger:4" && row["width"] == "320";
    for row in rows.iter().filter(cheap) {
        let views = views::views().into_iter();
        let mut views = views.filter(|(name, ..)| *name == row["view"]);
        let (_, eye, target) = views.next().expect("a view");
        let angles = ["yaw", "pitch", "roll"].map(|name| row[name].parse().expect("an angle"));
        let view = views::camera(eye, target)
            .turned(angles)
            .view()
            .expect("a camera");
        let field = Field::parse(&row["field"]).expect("a field");
        let stereo = Some(row["stereo"].as_str()).filter(|eyes| !eyes.is_empty());
        let options = FieldOptions {
            stereo: stereo.map(|eyes| Stereo::parse(eyes).expect("two eyes")),
            ..FieldOptions::default()
        };
        let setup = FieldSetup::new(&field, &view, (320, 180), &options).expect("a size");
        let eyes = if stereo.is_some() { 2 } else { 1 };
        let rays = (0..eyes).flat_map(|eye| picture(&setup, eye));
        let evaluations: u64 = rays.map(|ray| u64::from(ray.steps)).sum();
        let committed: u64 = row["evaluations"].parse().expect("a number");
        assert_eq!(
            evaluations, committed,
            "{row:?}: evaluations now and in the table: run `cargo xtask report raymarch`"
        );
        counted += 1;
    }
    assert_eq!(counted, 4 * views::path().len());
}

/// Has the raymarcher draw what Glint uses again.
#[test]
fn the_committed_cycles_of_pictures_are_not_stale() {
    let size = (320, 180);
    let mut raymarcher = Raymarcher::new();
    let options = FieldOptions::default();
    let subjects = sponges(size);
    let clocks: u64 = subjects
        .iter()
        .map(|subject| raymarcher.draw(&subject.setup(&options)).clocks)
        .sum();
    let rows = committed("raymarch-cap.csv");
    let shipped = rows.iter().find(|row| row["shipped"] == "true");
    let cycles = &shipped.expect("what Glint uses")["cycles"];
    let cycles: f64 = cycles.parse().expect("cycles");
    let now = clocks as f64 / subjects.len() as f64;
    // Which lane has the first turn depends on what was drawn before, and moves a picture by a clock.
    assert!(
        (cycles - now).abs() <= 1.0,
        "raymarch-cap.csv: {cycles} cycles in the table and {now} now: run `cargo xtask report raymarch`"
    );
}

/// Draws the small pictures of docs/report/raymarch.csv again.
#[test]
fn the_committed_pictures_of_fields_are_not_stale() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/report/raymarch.csv");
    let mut table = csv::Reader::from_path(&path).expect("docs/report/raymarch.csv is committed");
    let header = table.headers().expect("a header").clone();
    let rows: Vec<csv::StringRecord> = table.records().collect::<Result<_, _>>().expect("CSV");
    let cell = |row: &csv::StringRecord, name: &str| {
        let column = header.iter().position(|column| column == name);
        row[column.expect("a column")].to_owned()
    };
    let size = (320, 180);
    let subjects: Vec<_> = [sponges(size), others(size), rounds(size)]
        .into_iter()
        .flatten()
        .collect();
    for (prepass, subject) in [None, Some(Prepass::Fitting)]
        .into_iter()
        .flat_map(|prepass| subjects.iter().map(move |subject| (prepass, subject)))
    {
        let row = rows.iter().find(|row| {
            (cell(row, "scene"), cell(row, "view")) == (subject.scene.clone(), subject.name.clone())
                && cell(row, "width") == "320"
                && (cell(row, "prepass") != "0") == prepass.is_some()
        });
        let row = row.expect("run `cargo xtask report raymarch`: pictures have come or gone");
        let picture = subject.picture(&FieldOptions {
            prepass,
            ..FieldOptions::of(&subject.parsed)
        });
        let measured = Measured::new(&subject.expected, &picture);
        let accuracy = measured.accuracy;
        let depth = accuracy.depth.expect("something to see");
        let coded = measured.coded.expect("something to see");
        for (name, now) in [
            ("iou", accuracy.iou),
            ("undecided", accuracy.undecided as f64),
            ("depth_median", depth.median),
            ("depth_p99", depth.p99),
            ("depth_max", depth.max),
            ("code_median", coded.median),
            ("code_p99", coded.p99),
            ("wrong_faces", accuracy.wrong_faces),
            ("evaluations", measured.cost()),
        ] {
            let committed: f64 = cell(row, name).parse().expect("a number");
            assert!(
                (committed - now).abs() <= 1e-6 * now,
                "{} {}: {name} is {committed:e} in the table and {now:e} now: run `cargo xtask report raymarch`",
                subject.scene,
                subject.name,
            );
        }
    }
}

/// Integrates the tumble and the coning of docs/report/imu-methods.csv again, where samples are few.
#[test]
fn the_committed_errors_of_attitudes_are_not_stale() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/report/imu-methods.csv");
    let mut table =
        csv::Reader::from_path(&path).expect("docs/report/imu-methods.csv is committed");
    let rows: Vec<csv::StringRecord> = table.records().collect::<Result<_, _>>().expect("CSV");
    let coning = Motion::Coning {
        angle: 5.0,
        frequency: 10.0,
    };
    for (name, motion) in [("tumble", Motion::Tumble(700.0)), ("coning", coning)] {
        for method in Method::ALL {
            for rate in ["50", "200"] {
                let row = rows.iter().find(|row| {
                    (&row[0], &row[1]) == (name, method.name())
                        && row[3].parse::<f64>() == rate.parse::<f64>()
                });
                let row = row.expect("run `cargo xtask report imu`: methods have come or gone");
                let committed: f64 = row[4].parse().expect("a number");
                let now = method_error(method, motion, 20.0, rate.parse().expect("a rate"));
                assert!(
                    (committed - now).abs() <= 1e-3 * now,
                    "{name}, {} at {rate}: {committed:e} in the table and {now:e} now: run `cargo xtask report imu`",
                    method.name(),
                );
            }
        }
    }
}
