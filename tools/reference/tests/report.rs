//! `report sine --quick`: the files are written, the shipped kernels keep their promises, and the committed table is
//! what the code gives. So is that of `report raymarch`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use glint_model::march::FieldOptions;
use glint_reference::field::marched::{Measured, others, sponges};
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
    for subject in sponges(size).into_iter().chain(others(size)) {
        let row = rows.iter().find(|row| {
            (cell(row, "scene"), cell(row, "view")) == (subject.scene.clone(), subject.name.clone())
                && cell(row, "width") == "320"
        });
        let row = row.expect("run `cargo xtask report raymarch`: pictures have come or gone");
        let picture = subject.picture(&FieldOptions::default());
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
