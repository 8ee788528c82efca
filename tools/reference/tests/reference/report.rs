//! Tests of the report. The tests check that a quick run writes its files, that the committed tables agree with the current code
//! (where the check is cheap), and that the committed pages agree with the committed tables.

use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use glint::render::{self, FieldSubject, Frame, Subject};
use glint::scene::{self, Changes};
use glint_core::appearance::Appearance;
use glint_core::field::Field;
use glint_core::picture::Size;
use glint_core::quality::Quality;
use glint_core::stereo::Stereo;
use glint_reference::imu::measure::method_error;
use glint_reference::imu::method::Method;
use glint_reference::imu::motion::Motion;
use glint_reference::raymarch::raymarched::sponges;
use glint_reference::raymarch::views;
use glint_reference::report::cycles::Cycles;
use glint_reference::report::experiments::antialiasing;
use glint_reference::report::experiments::geometry::precision;
use glint_reference::report::experiments::gouraud::forms;
use glint_reference::report::experiments::imu::methods::Trial as MethodTrial;
use glint_reference::report::experiments::kernels as small_kernels;
use glint_reference::report::experiments::raymarch::pictures;
use glint_reference::report::experiments::raymarch::pictures::Form::{self, Exits, Marching};
use glint_reference::report::experiments::raymarch::rates;
use glint_reference::report::experiments::raymarch::requirements::SMALL;
use glint_reference::report::experiments::{quality, sine, timeline};
use glint_reference::report::table::read_csv;
use glint_reference::report::workspace;
use glint_reference::sine::kernels::kernels;
use glint_reference::sine::sweep::sweep;
use glint_reference::triangle::smooth::scenes;
use glint_testbench::Raymarcher;
use serde::de::DeserializeOwned;

use crate::{TRANSCRIPT, folder};

/// Runs a program to its end.
fn succeed(command: &mut Command) {
    let output = command.output().expect("the program starts");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
}

#[test]
fn a_quick_report_is_written_and_shipped_kernels_keep_their_bounds() {
    let folder = folder("report");
    let transcript = folder.join("transcript.txt");
    fs::write(&transcript, TRANSCRIPT).expect("writable");
    succeed(
        Command::new(env!("CARGO_BIN_EXE_report"))
            .args(["sine", "--quick", "--out"])
            .arg(&folder)
            .arg("--transcript")
            .arg(&transcript),
    );
    let rows: Vec<sine::Row> =
        read_csv(&folder.join("sine.csv")).expect("the report writes the file");
    let shipped: Vec<_> = rows.iter().filter(|row| row.shipped).collect();
    assert_eq!(shipped.len(), 2);
    for row in shipped {
        assert!(row.max_ulp <= 1.0, "{row:#?}");
        assert_eq!(row.asymmetric, Some(0), "{row:#?}");
    }
    assert_eq!(rows[0].inputs, "all 2^16 phases of 16 bits");
    assert_eq!(rows[0].cycles_median, Some(2));
    assert!(
        rows.iter()
            .all(|row| row.kernel == "sin_cos_q30" || row.cycles_median.is_none())
    );

    let read =
        |name: &str| fs::read_to_string(folder.join(name)).expect("the report writes the file");
    assert!(read("sine.svg").contains("<svg"));
    let page = read("sine.md");
    assert!(
        page.contains("| **sin_cos_q30** |")
            && page.contains("1 / 2 / 3")
            && page.contains("not measured")
    );
}

/// Reads the rows of a committed table in docs/report.
fn committed<T: DeserializeOwned>(name: &str) -> Vec<T> {
    read_csv(&workspace::path("docs/report").join(name)).expect("a committed table")
}

/// Checks that the figures `committed` and `now` are equal up to a relative error of `tolerance`.
fn assert_close(committed: f64, now: f64, tolerance: f64, what: &str) {
    assert!(
        (committed - now).abs() <= tolerance * now,
        "{what} is {committed:e} in the table and {now:e} now: measure the page again with `cargo xtask report`"
    );
}

/// The output of git in the checkout, or `None` if it fails.
fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git")
        .args(arguments)
        .current_dir(workspace::path(""))
        .output();
    let output = output.ok().filter(|output| output.status.success())?;
    Some(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

/// Whether git has all commits of the history. Says so if it has not.
fn has_history() -> bool {
    // The prefix is empty unless the checkout is a folder of another repository.
    let state = git(&["rev-parse", "--is-shallow-repository", "--show-prefix"]);
    let complete = state.is_some_and(|state| state == "false");
    if !complete {
        println!("not tested: the checkout has no complete history");
    }
    complete
}

#[test]
fn the_committed_tables_name_commits_of_the_history() {
    if !has_history() {
        return;
    }
    for file in fs::read_dir(workspace::path("docs/report")).expect("docs/report exists") {
        let path = file.expect("an entry").path();
        if path.extension().is_none_or(|extension| extension != "csv") {
            continue;
        }
        let rows: Vec<BTreeMap<String, String>> = read_csv(&path).expect("a committed table");
        let commits = rows.iter().filter_map(|row| row.get("commit"));
        for commit in commits.collect::<BTreeSet<_>>() {
            assert!(
                git(&["merge-base", "--is-ancestor", commit, "HEAD"]).is_some(),
                "{}: expected a commit of the history, found {commit}: measure the table again",
                path.display()
            );
        }
    }
}

#[test]
fn the_page_of_states_names_the_tables_that_are_older_than_their_sources() {
    if !has_history() {
        return;
    }
    let folder = folder("state");
    succeed(
        Command::new(workspace::path(".venv/bin/python"))
            .arg(workspace::path("tools/reference/pages"))
            .arg("--out")
            .args([&folder, Path::new("state")]),
    );
    let read = |folder: &Path| fs::read_to_string(folder.join("state.md")).expect("readable");
    let (made, committed) = (read(&folder), read(&workspace::path("docs/report")));
    let stated: BTreeSet<_> = committed.lines().collect();
    let is_changed = |line: &&str| line.starts_with("| table") || !stated.contains(line);
    let changed: Vec<_> = made.lines().filter(is_changed).collect();
    assert!(
        made == committed,
        "docs/report/state.md is no longer true: `cargo xtask report pages` states what follows, \
         the command in a line measures its table again\n{}",
        changed.join("\n")
    );
}

#[test]
fn the_committed_pages_are_those_of_the_committed_tables() {
    let committed = workspace::path("docs/report");
    let folder = folder("pages");
    succeed(
        Command::new(env!("CARGO_BIN_EXE_report"))
            .args(["pages", "--out"])
            .arg(&folder),
    );
    let names = |folder: &Path| -> BTreeSet<_> {
        let files = fs::read_dir(folder)
            .expect("a folder")
            .map(|file| file.expect("a file").path());
        let made = |path: &PathBuf| {
            path.extension()
                .is_some_and(|kind| kind == "md" || kind == "svg")
        };
        files
            .filter(made)
            .filter_map(|path| path.file_name().map(ToOwned::to_owned))
            .collect()
    };
    let mut made = names(&folder);
    assert_eq!(names(&committed), made, "files were added or removed");
    made.insert("constants.csv".into());
    // Depends on the history, and has its own test.
    made.remove(OsStr::new("state.md"));
    for name in made {
        let read = |folder: &Path| fs::read(folder.join(&name)).expect("readable");
        assert!(
            read(&folder) == read(&committed),
            "{}: run `cargo xtask report pages`",
            name.display()
        );
    }
}

#[test]
fn what_the_pages_compute_is_right() {
    succeed(
        Command::new(workspace::path(".venv/bin/python"))
            .args(["-m", "unittest", "tests"])
            .current_dir(workspace::path("tools/reference/pages")),
    );
}

/// Headings of every page of measurements. The index and the state of the tables have no such headings.
const SECTIONS: [&str; 4] = [
    "What",
    "Reference",
    "Stiff cases",
    "What a user should know",
];

#[test]
fn every_page_has_the_same_sections() {
    let files = fs::read_dir(workspace::path("docs/report")).expect("docs/report exists");
    let paths = files.map(|file| file.expect("an entry").path());
    let is_page = |path: &PathBuf| {
        path.extension().is_some_and(|found| found == "md")
            && !path.ends_with("README.md")
            && !path.ends_with("state.md")
    };
    for path in paths.filter(is_page) {
        let page = fs::read_to_string(&path).expect("readable");
        let headings: Vec<_> = page
            .lines()
            .filter_map(|line| line.strip_prefix("## "))
            .collect();
        for section in SECTIONS {
            assert!(
                headings.contains(&section),
                "{}: expected the section {section:?}, found {headings:?}",
                path.display()
            );
        }
        assert!(page.contains("\n|---"), "{}: no table", path.display());
    }
}

/// Repeats the measurements of sine.csv that take less than a second, and compares the errors with the committed errors.
#[test]
fn the_committed_errors_of_sines_hold() {
    let rows: Vec<sine::Row> = committed("sine.csv");
    assert_eq!(rows.len(), kernels().len(), "kernels were added or removed");
    let mut recomputed = 0;
    for (row, kernel) in rows.iter().zip(kernels()) {
        assert_eq!(
            (row.kernel.as_str(), row.inputs.as_str()),
            (kernel.name, kernel.inputs)
        );
        if kernel.steps > 1 << 19 {
            continue;
        }
        let statistics = sweep(&kernel, 1, &|_| ());
        assert_eq!(row.samples, statistics.inputs);
        let name = |column| format!("sine.csv: {} of {}", column, kernel.name);
        assert_close(row.max_err, statistics.max, 1e-6, &name("max_err"));
        assert_close(row.rms, statistics.rms(), 1e-6, &name("rms"));
        recomputed += 1;
    }
    assert!(recomputed >= 2);
}

/// Repeats the measurements of geometry-precision.csv, and compares the errors with the committed errors.
#[test]
fn the_committed_errors_of_geometry_hold() {
    let rows: Vec<precision::Row> = committed("geometry-precision.csv");
    let now = precision::measure(&Cycles::new());
    assert_eq!(rows.len(), now.len(), "kernels were added or removed");
    for (row, now) in rows.iter().zip(now) {
        assert_eq!((&row.kernel, row.samples), (&now.kernel, now.samples));
        let name = |column| format!("geometry-precision.csv: {} of {}", column, row.kernel);
        assert_close(row.max_err, now.max_err, 1e-6, &name("max_err"));
        assert_close(row.rms, now.rms, 1e-6, &name("rms"));
    }
}

/// Repeats the measurements of kernels.csv, and compares the errors with the committed errors.
#[test]
fn the_committed_errors_of_small_kernels_hold() {
    let rows: Vec<small_kernels::Row> = committed("kernels.csv");
    let now = small_kernels::measure(1, &Cycles::new()).expect("cameras are accepted");
    assert_eq!(rows.len(), now.len(), "kernels were added or removed");
    for (row, now) in rows.iter().zip(now) {
        assert_eq!((&row.config, row.samples), (&now.config, now.samples));
        let name = |column| format!("kernels.csv: {} of {}", column, row.config);
        assert_close(row.max_err, now.max_err, 1e-6, &name("max_err"));
        assert_close(row.rms, now.rms, 1e-6, &name("rms"));
    }
    let in_cycles = rows.iter().filter(|row| row.bits.is_none());
    let missing: Vec<_> = in_cycles
        .filter(|row| row.cycles_median.is_none())
        .collect();
    assert!(missing.is_empty(), "no cycles: {missing:?}");
}

/// Repeats the measurements of gouraud-forms.csv in common scenes, and compares the errors with the committed errors.
#[test]
fn the_committed_errors_of_smooth_shading_hold() {
    let rows: Vec<forms::Row> = committed("gouraud-forms.csv");
    let scenes = scenes();
    assert_eq!(
        rows.len(),
        scenes.len() * forms::FORMS.len(),
        "scenes or forms were added or removed"
    );
    for scene in scenes.iter().filter(|scene| !scene.stiff) {
        let committed = rows.iter().filter(|row| row.scene == scene.name);
        for (row, now) in committed.zip(forms::measure_scene(scene)) {
            assert_eq!((&row.form, row.pixels), (&now.form, now.pixels));
            let name = |column| format!("gouraud-forms.csv: {} of {}", column, row.form);
            assert_close(row.max_err, now.max_err, 1e-6, &name("max_err"));
            assert_close(row.rms, now.rms, 1e-6, &name("rms"));
        }
    }
}

/// Draws the frames of timeline.csv on the model, and compares the evaluations with the committed evaluations. Also checks that
/// the parts of a frame add up to the frame.
#[test]
fn the_committed_parts_are_of_the_frames_of_all_scenes() {
    let rows: Vec<timeline::Row> = committed("timeline.csv");
    let scenes: Vec<_> = quality::scenes("").collect();
    assert_eq!(rows.len(), scenes.len(), "scenes were added or removed");
    for (row, scene) in rows.iter().zip(&scenes) {
        let picture = (row.scene.as_str(), row.width);
        assert_eq!(picture, (scene.name(), scene.size().width()));
        let parts = row.soft_core + row.geometry + row.raster;
        assert_eq!(
            row.cycles, parts,
            "{}: expected the frame's cycles as the sum of the parts",
            row.scene
        );
        if row.evaluations.is_some() {
            let drawn = scene::draw(scene, &Changes::default(), render::on_model);
            let drawn = drawn.expect("a scene").expect("a picture");
            let now = drawn.stats.rays.map(|rays| rays.evaluations);
            assert_eq!(
                row.evaluations, now,
                "{}: the evaluations differ from the table: run `cargo xtask report timeline`",
                row.scene
            );
        }
    }
}

/// Counts the distance evaluations of the sponge's small frames in raymarch-rates.csv, and compares them with the committed
/// numbers. The cycles are not measured, because they need the whole SoC.
#[test]
fn the_committed_frames_a_second_are_of_these_frames() {
    let rows: Vec<rates::Row> = committed("raymarch-rates.csv");
    let mut counted = 0;
    let cheap = |row: &&rates::Row| row.field == "menger:4" && row.width == 320;
    for row in rows.iter().filter(cheap) {
        let views = views::views().into_iter();
        let mut views = views.filter(|(name, ..)| *name == row.view);
        let (_, eye, target) = views.next().expect("a view");
        let view = views::camera(eye, target)
            .turned([row.yaw, row.pitch, row.roll])
            .view()
            .expect("a camera");
        let field = Field::parse(&row.field).expect("a field");
        let subject = FieldSubject {
            field: &field,
            appearance: &Appearance::default(),
            quality: Quality::default(),
        };
        let size = Size::of(row.width, row.height).expect("a size");
        let stereo = row.stereo.as_deref();
        let frame = Frame {
            stereo: stereo.map(|eyes| Stereo::parse(eyes).expect("two eyes")),
            ..Frame::new(Subject::Field(subject), view, size)
        };
        let drawn = render::on_model(&frame).expect("a picture");
        let evaluations = drawn.stats.rays.map(|rays| rays.evaluations);
        assert_eq!(
            evaluations,
            Some(row.evaluations),
            "{} turned by {}, {}, {}: the evaluations differ from the table: run `cargo xtask report raymarch`",
            row.view,
            row.yaw,
            row.pitch,
            row.roll
        );
        counted += 1;
    }
    assert_eq!(counted, 4 * views::path().len());
    for case in &rates::CASES {
        let mut of_case = rows.iter().filter(|row| case.contains(row)).peekable();
        assert!(of_case.peek().is_some(), "{}: no row", case.field);
        let required = |row: &rates::Row| (row.clock, row.at_least, row.aim);
        assert!(
            of_case.all(|row| required(row) == (case.clock, case.at_least, case.aim)),
            "{}: other requirements",
            case.field
        );
    }
}

/// Draws the views of the sponge on the verilated raymarcher, and compares the clocks with raymarch.csv.
#[test]
fn the_committed_clocks_of_pictures_hold() {
    let rows: Vec<pictures::Row> = committed("raymarch.csv");
    let mut raymarcher = Raymarcher::new("raymarcher", 1);
    for subject in sponges(SMALL) {
        let now = pictures::Row::measure(&subject, Some(&mut raymarcher));
        let row = rows.iter().find(|row| row.shows_the_same_as(&now));
        let clocks = |row: &pictures::Row| row.cycles.expect("clocks") as f64;
        let what = format!("raymarch.csv: clocks of {} {}", now.scene, now.view);
        // A change of the gateware may move the clocks by the length of its pipelines.
        assert_close(clocks(row.expect("a row")), clocks(&now), 0.01, &what);
    }
}

/// Bounds of the pictures, by form of rays and start of the field's text: false hits and misses, undecided rays, the median and the 99th
/// percentile of the depth's error in world units, the fraction of wrong faces, the 99th percentile of the normal's error in degrees, and
/// evaluations per ray. The first matching line applies.
const BOUNDS: [(Form, &str, [f64; 7]); 9] = [
    // Exact masks, and errors of depths by the rounding of the eye.
    (Exits, "menger", [0.0, 0.0, 4e-7, 2e-6, 2e-4, 0.0, 1.9]),
    (Exits, "box:", [0.0, 0.0, 3e-7, 2e-6, 0.0, 0.0, 0.6]),
    (Exits, "cubes:0.25", [0.0, 0.0, 7e-7, 3e-6, 2e-4, 0.0, 1.6]),
    (Exits, "planes:12", [0.0, 0.0, 6e-6, 2e-5, 0.0, 0.0, 0.6]),
    (Exits, "cubes:2", [0.0, 0.0, 5e-7, 2e-5, 2e-4, 0.0, 2.3]),
    (Exits, "planes:0.5", [0.0, 0.0, 4e-7, 8e-5, 0.0, 0.0, 1.0]),
    (Exits, "lattice", [0.0, 0.0, 2e-6, 2e-5, 0.0, 0.06, 4.2]),
    (Exits, "", [0.0, 0.0, 5e-6, 2e-5, 0.0, 0.02, 1.5]),
    (
        Marching,
        "",
        [40.0, 0.0, 3e-4, 3e-3, 0.01, 0.3, f64::INFINITY],
    ),
];

/// Draws the small pictures of raymarch.csv again, compares their errors with the committed errors, and checks the bounds of the
/// pictures.
#[test]
fn the_committed_pictures_of_fields_hold() {
    let rows: Vec<pictures::Row> = committed("raymarch.csv");
    for subject in pictures::small() {
        let now = pictures::Row::measure(&subject, None);
        let row = rows.iter().find(|row| row.shows_the_same_as(&now));
        let row = row.expect("pictures were added or removed: run `cargo xtask report raymarch`");
        let what = format!("{:?}, {} {}", now.form, now.scene, now.view);
        let mut bounds = BOUNDS.into_iter();
        let bounds =
            bounds.find(|(form, start, _)| *form == now.form && now.scene.starts_with(start));
        let (_, _, bounds) = bounds.unwrap_or_else(|| panic!("{what}: no bounds"));
        let found = [
            (now.false_hits + now.false_misses) as f64,
            now.undecided as f64,
            now.depth_median.expect("a visible field"),
            now.depth_p99.expect("a visible field"),
            now.wrong_faces,
            // Some views show only flat faces, without normals of round surfaces to compare.
            now.normal_p99.unwrap_or(0.0),
            now.evaluations,
        ];
        assert!(
            found.iter().zip(bounds).all(|(&found, most)| found <= most),
            "{what}: {found:?}, expected at most {bounds:?}"
        );
        for (name, committed, now) in [
            ("iou", Some(row.iou), Some(now.iou)),
            (
                "undecided",
                Some(row.undecided as f64),
                Some(now.undecided as f64),
            ),
            ("depth_median", row.depth_median, now.depth_median),
            ("depth_p99", row.depth_p99, now.depth_p99),
            ("depth_max", row.depth_max, now.depth_max),
            ("code_median", row.code_median, now.code_median),
            ("code_p99", row.code_p99, now.code_p99),
            ("wrong_faces", Some(row.wrong_faces), Some(now.wrong_faces)),
            ("evaluations", Some(row.evaluations), Some(now.evaluations)),
        ] {
            let number = |figure: Option<f64>| figure.expect("a visible field");
            let what = format!("raymarch.csv: {name} of {what}");
            assert_close(number(committed), number(now), 1e-6, &what);
        }
    }
}

/// Draws the frames of two scenes of quality.csv again, and compares their errors with the committed errors. Frames of the exact quality
/// differ from the reference only along edges, and by the rounding of colours.
#[test]
fn the_committed_errors_of_qualities_hold() {
    let rows: Vec<quality::Row> = committed("quality.csv");
    assert_eq!(rows.len(), 3 * quality::scenes("").count());
    for now in ["simplegpu", "wireframe"].into_iter().flat_map(|scene| {
        let now = quality::errors(scene, |_| true);
        now.expect("a built-in scene")
    }) {
        let same = |row: &&quality::Row| (&row.scene, row.width) == (&now.scene, now.width);
        let row = rows.iter().find(same).expect("a committed row");
        let name = |column| format!("quality.csv: {column} of {} {}", row.scene, row.width);
        assert_close(row.wrong, now.wrong, 1e-6, &name("wrong"));
        assert_close(row.colour, now.colour, 1e-6, &name("colour"));
        if row.quality == "exact" {
            assert!(now.wrong < 0.01 && now.colour < 6.0, "{now:?}");
        }
    }
}

/// Draws the frames of a scene of antialiasing.csv again, and compares their errors with the committed errors.
#[test]
fn the_committed_errors_of_samples_hold() {
    let rows: Vec<antialiasing::errors::Row> = committed("antialiasing.csv");
    assert_eq!(rows.len(), 6 * quality::scenes("").count());
    let scene = quality::scenes("simplegpu").next().expect("a scene");
    let now = scene::draw(&scene, &Changes::default(), |frame| {
        let exact = antialiasing::errors::reference(frame)?;
        antialiasing::errors::of_engine(scene.name(), frame, &exact)
    });
    let now = now.expect("a scene").expect("a picture");
    let rows = rows.iter().filter(|row| row.scene == scene.name());
    for (row, now) in rows.zip(now) {
        assert_eq!((row.samples, row.dithered), (now.samples, now.dithered));
        let name = |column| format!("antialiasing.csv: {column} of {} samples", row.samples);
        assert_close(row.colour, now.colour, 1e-6, &name("colour"));
        assert_close(row.edges, now.edges, 1e-6, &name("edges"));
        assert_close(row.share, now.share, 1e-6, &name("share"));
    }
}

/// Integrates the motions of imu-methods.csv (tumble and coning) at two low sample rates, and compares the attitude errors with
/// the committed errors.
#[test]
fn the_committed_errors_of_attitudes_hold() {
    let rows: Vec<MethodTrial> = committed("imu-methods.csv");
    let coning = Motion::Coning {
        angle: 5.0,
        frequency: 10.0,
    };
    for (name, motion) in [("tumble", Motion::Tumble(700.0)), ("coning", coning)] {
        for method in Method::ALL {
            for rate in [50.0, 200.0] {
                let row = rows.iter().find(|row| {
                    (row.motion.as_str(), row.method.as_str()) == (name, method.name())
                        && row.rate == rate
                });
                let row = row.expect("methods were added or removed: run `cargo xtask report imu`");
                let now = method_error(method, motion, 20.0, rate);
                let what = format!("imu-methods.csv: {name}, {} at {rate}", method.name());
                assert_close(row.error, now, 1e-3, &what);
            }
        }
    }
}
