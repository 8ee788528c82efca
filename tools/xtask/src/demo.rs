//! `cargo xtask demo` and `cargo xtask report`: build the prerequisites, then run the program.

use std::process::Command;

use anyhow::Result;

use crate::gateware::{self, Board, Library};
use crate::{bootstrap, firmware, paths, run};

/// Builds everything and runs `glint demo` with `arguments`.
///
/// # Errors
/// A build or the demo fails.
pub fn demo(arguments: &[String]) -> Result<()> {
    bootstrap::bootstrap()?;
    gateware::build(Board::Virtual)?;
    firmware::build(Board::Virtual, &[])?;
    // The usual folder is the demo's own.
    let mut arguments = arguments.to_vec();
    if !arguments
        .iter()
        .any(|argument| argument.starts_with("--out"))
    {
        arguments.push("--force".to_owned());
    }
    tool("glint", "glint", "demo", &arguments)
}

/// Builds everything, makes the measurements of the report's page `name`, and writes the page. For the page `raymarch` it also
/// builds the SoC whose raymarcher evaluates the field four times a clock, and the raymarcher without a SoC, for the page `gouraud` the
/// rasterizer. With `pages` as name it writes all pages from the tables of earlier measurements, with `stiff` it needs the
/// firmware alone, and with `--help` as an argument it lists the options of the page. For pages and help it builds only the report program.
///
/// # Errors
/// A build or a measurement fails.
pub fn report(name: &str, arguments: &[String]) -> Result<()> {
    let asks_for_help = || arguments.iter().any(|argument| argument == "--help");
    if name == "pages" || asks_for_help() {
        return tool("glint-reference", "report", name, arguments);
    }
    bootstrap::bootstrap()?;
    if name == "stiff" {
        firmware::build(Board::Virtual, &[])?;
        return tool("glint-reference", "report", name, arguments);
    }
    gateware::build(Board::Virtual)?;
    if name == "raymarch" {
        let sponge = "sponge";
        gateware::build_beside(sponge, &["--fields", sponge], Library::Profiled)?;
        model("raymarcher")?;
    }
    if name == "gouraud" {
        model("triangle_raster")?;
    }
    firmware::build(Board::Virtual, &["peers"])?;
    tool("glint-reference", "report", name, arguments)
}

/// Builds the verilated models of a module, without a SoC.
fn model(module: &str) -> Result<()> {
    run::step(
        &format!("models of {module}"),
        Command::new(paths::venv_program("python"))
            .args(["gateware/tests/run.py", "--models", module])
            .current_dir(paths::root()),
    )
}

/// Builds a program of the workspace as a step, then runs it on this terminal.
fn tool(package: &str, program: &str, subcommand: &str, arguments: &[String]) -> Result<()> {
    let select = ["--package", package, "--bin", program];
    run::build_program(package, program)?;
    run::foreground(
        &format!("{program} {subcommand}"),
        Command::new("cargo")
            .args(["run", "--quiet"])
            .args(select)
            .args(["--", subcommand])
            .args(arguments)
            .current_dir(paths::root()),
    )
}
