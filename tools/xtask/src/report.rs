//! `cargo xtask report`: builds and measures a page of the report, or the whole report as a workflow of independent jobs.

use std::fs::{self, File};
use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result, ensure};
use litex_pac::variant::VARIANTS;

use crate::gateware::{self, Board, Library};
use crate::{bootstrap, firmware, paths, run};

/// The Snakemake description of the workflow.
const WORKFLOW: &str = "tools/reference/workflow/Snakefile";

/// File with the checksums of all files that the jobs execute.
const STAMP: &str = "inputs.sha256";

/// Builds everything, makes the measurements of the report's page `name`, and writes the page. The name `pages` writes all pages from the
/// tables of earlier measurements; the argument `--help` lists the options of the page. These two build only the report program.
///
/// # Errors
/// A build or a measurement fails.
pub fn page(name: &str, arguments: &[String]) -> Result<()> {
    if name == "pages" {
        bootstrap::python_environment()?;
    }
    let asks_for_help = || arguments.iter().any(|argument| argument == "--help");
    if name == "pages" || asks_for_help() {
        return run::program("glint-reference", "report", name, arguments);
    }
    bootstrap::bootstrap()?;
    if name == "stiff" || name == "long" {
        if arguments.iter().any(|argument| argument == "--virtual") {
            gateware::build(Board::Virtual)?;
        }
        firmware::build(Board::Virtual, &[])?;
        return run::program("glint-reference", "report", name, arguments);
    }
    gateware::build(Board::Virtual)?;
    build_parts(name)?;
    firmware::build(Board::Virtual, &["peers"])?;
    run::program("glint-reference", "report", name, arguments)
}

/// Builds the gateware that the page `name` needs in addition to the virtual board. `raymarch`: a SoC with four lanes for lattices, and the
/// raymarcher without a SoC. `gouraud`: the rasterizer. `quality` and `timeline`: the SoC with smooth shading. `antialiasing`: the SoC with
/// smooth shading, and the SoC with textures and fog. `textures`: the SoC with textures. `cpu`: the SoC with each variant of the CPU, and
/// the firmware of each.
fn build_parts(name: &str) -> Result<()> {
    match name {
        "raymarch" => {
            let lattice = ["--fields", "lattice,normals,stereo", "--lanes", "4"];
            gateware::build_beside("lattice-4", &lattice, Library::Quick)?;
            model("raymarcher")
        }
        "gouraud" => model("triangle_raster"),
        "textures" => gateware::build_beside("texture", &["--texture"], Library::Quick).map(|_| ()),
        "antialiasing" => {
            build_parts("quality")?;
            let options = ["--texture", "--fog"];
            gateware::build_beside("texture-fog", &options, Library::Quick).map(|_| ())
        }
        "quality" | "timeline" => {
            gateware::build_beside("smooth", &["--smooth"], Library::Quick).map(|_| ())
        }
        "cpu" => {
            for variant in &VARIANTS {
                firmware::build(Board::Virtual, variant.features)?;
            }
            // The virtual board has the first variant.
            for variant in &VARIANTS[1..] {
                let options = ["--cpu", variant.name];
                gateware::build_beside(&format!("cpu-{}", variant.name), &options, Library::Quick)?;
            }
            Ok(())
        }
        _ => Ok(()),
    }
}

/// Builds the verilated models of a module, without a SoC.
fn model(module: &str) -> Result<()> {
    run::step(
        &format!("models of {module}"),
        run::python(&["-m", "pytest", "gateware/tests/test_modules.py"])
            .args(["-k", &format!("test_model and {module}")]),
    )
}

/// Builds everything and runs the whole report with `workers` jobs at a time, into docs/report; `quick` measures samples only,
/// into target/report/quick/pages. Jobs finished by an interrupted run are skipped, unless a file that the jobs execute has changed.
/// `arguments`, such as other targets, are passed to Snakemake. If there are arguments, docs/report does not change.
///
/// # Errors
/// A build or a job fails, or another report is running.
pub fn whole(quick: bool, workers: u32, arguments: &[String]) -> Result<()> {
    bootstrap::bootstrap()?;
    gateware::build(Board::Virtual)?;
    build_parts("gouraud")?;
    if !quick {
        build_parts("raymarch")?;
        build_parts("antialiasing")?;
        build_parts("textures")?;
        build_parts("cpu")?;
    }
    firmware::build(Board::Virtual, &[])?;
    firmware::build(Board::Virtual, &["peers"])?;
    run::build_program("glint-reference", "report")?;
    let folder = paths::target().join("report");
    let folder = folder.join(if quick { "quick" } else { "whole" });
    fs::create_dir_all(&folder).with_context(|| format!("creating {}", folder.display()))?;
    // A separate lock, because a killed Snakemake leaves its own lock behind.
    let lock = File::create(folder.join("lock")).context("creating the lock of the report")?;
    ensure!(
        lock.try_lock().is_ok(),
        "{}: another report is running",
        folder.display()
    );
    write_stamp(&folder, quick)?;
    run::foreground(
        "the report",
        Command::new(paths::venv_program("snakemake"))
            .arg("--snakefile")
            .arg(paths::root().join(WORKFLOW))
            .arg("--directory")
            .arg(&folder)
            .args(["--cores", &workers.to_string()])
            .args(["--nolock", "--rerun-incomplete"])
            .args(arguments)
            .args(["--quiet", "rules", "--config"])
            .args([
                format!("root={}", paths::root().display()),
                format!("report={}", paths::target().join("debug/report").display()),
                format!("stamp={STAMP}"),
                format!("quick={}", u8::from(quick)),
            ]),
    )?;
    let pages = folder.join("pages");
    if quick || !arguments.is_empty() {
        run::print_progress(&format!("wrote {}", folder.display()));
        return Ok(());
    }
    let committed = paths::root().join("docs/report");
    for file in fs::read_dir(&pages).with_context(|| format!("reading {}", pages.display()))? {
        let file = file?;
        // Snakemake leaves a timestamp file in the folder.
        if file.file_name().as_encoded_bytes().starts_with(b".") {
            continue;
        }
        fs::copy(file.path(), committed.join(file.file_name()))
            .with_context(|| format!("copying {}", file.path().display()))?;
    }
    run::print_progress("wrote docs/report");
    Ok(())
}

/// Writes the checksums of all files that the jobs execute to a file that is an input of each job, so that a new build makes the jobs
/// run again.
fn write_stamp(folder: &Path, quick: bool) -> Result<()> {
    let target = paths::target();
    let mut files = vec![
        "debug/report",
        "firmware/glint.bin",
        "firmware/glint-peers.bin",
        "gateware/virtual/libglint_soc.so",
        "gateware/models/triangle_raster.so",
        "gateware/models/triangle_raster_smooth.so",
    ];
    if !quick {
        files.extend([
            "gateware/virtual-lattice-4/libglint_soc.so",
            "gateware/virtual-smooth/libglint_soc.so",
            "gateware/virtual-texture/libglint_soc.so",
            "gateware/models/raymarcher.so",
        ]);
    }
    let mut files: Vec<_> = files.into_iter().map(str::to_owned).collect();
    if !quick {
        for variant in &VARIANTS[1..] {
            files.push(format!(
                "gateware/virtual-cpu-{}/libglint_soc.so",
                variant.name
            ));
            let firmware = [&["glint"], variant.features].concat().join("-");
            files.push(format!("firmware/{firmware}.bin"));
        }
    }
    let files = files.iter().map(|file| target.join(file));
    let output = Command::new("sha256sum").args(files).output()?;
    ensure!(
        output.status.success(),
        "sha256sum: {}",
        String::from_utf8_lossy(&output.stderr)
    );
    let stamp = folder.join(STAMP);
    if fs::read(&stamp).is_ok_and(|earlier| earlier == output.stdout) {
        return Ok(());
    }
    fs::write(&stamp, output.stdout).with_context(|| format!("writing {}", stamp.display()))
}
