//! The provenance of measurements: state of the source and versions of the tools.

use std::process::Command;

use serde::Serialize;

use super::workspace;

/// The commit with which rows were measured: the last column of the rows' table.
#[derive(Serialize)]
pub struct Commit {
    /// The commit, see [`Provenance::commit`].
    pub commit: String,
}

/// Commit and tools with which rows were measured: the last columns of the rows' table.
#[derive(Clone, Serialize)]
pub struct Provenance {
    /// The last commit that changed the measured source. `-dirty` is appended if the source has uncommitted changes.
    pub commit: String,
    /// Versions of the compiler and of the compared libraries.
    pub tools: String,
}

impl Provenance {
    /// Determines the commit with git, the compiler's version by running the compiler, and the libraries' versions from `Cargo.lock`. A
    /// value that cannot be determined is `unknown`.
    pub fn find() -> Self {
        let lock = std::fs::read_to_string(workspace::path("Cargo.lock")).unwrap_or_default();
        let mut tools = vec![output("rustc", &["--version"])];
        for name in ["idsp", "cordic", "micromath", "libm"] {
            let start = format!("name = \"{name}\"\nversion = \"");
            let version = lock
                .split_once(&start)
                .and_then(|(_, rest)| rest.split_once('"'));
            tools.push(format!(
                "{name} {}",
                version.map_or("unknown", |(version, _)| version)
            ));
        }
        Self {
            commit: commit(),
            tools: tools.join(", "),
        }
    }
}

fn commit() -> String {
    const MEASURED: [&str; 11] = [
        "Cargo.lock",
        "Cargo.toml",
        "build.rs",
        "memory.x",
        "firmware",
        "gateware",
        "tools/emulated-board",
        "tools/virtual-image-sensor",
        "tools/virtual-mpu6050",
        "tools/reference",
        "tools/virtual-i2c-device",
    ];
    let git = |arguments: &[&str]| output("git", &[arguments, &["--"], &MEASURED].concat());
    let changed = !git(&["status", "--porcelain"]).is_empty();
    git(&["log", "-1", "--format=%h", "--abbrev=12"]) + if changed { "-dirty" } else { "" }
}

/// Runs a program in the workspace and returns its standard output, or `unknown` if the program fails.
fn output(program: &str, arguments: &[&str]) -> String {
    let run = Command::new(program)
        .args(arguments)
        .current_dir(workspace::path(""))
        .output();
    match run {
        Ok(output) if output.status.success() => {
            String::from_utf8_lossy(&output.stdout).trim().to_owned()
        }
        _ => "unknown".to_owned(),
    }
}
