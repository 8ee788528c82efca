//! The state of the source and the versions of the tools with which figures were measured.

use std::process::Command;

use super::workspace;

/// Commit and tools of a measurement, for its rows.
pub struct Provenance {
    /// The last commit that touched the measured source, followed by `-dirty` if there are uncommitted changes.
    pub commit: String,
    /// Versions of the compiler and of the libraries that are compared.
    pub tools: String,
}

impl Provenance {
    /// Reads both fields from git, the compiler and the lock file. A value that cannot be read is `unknown`.
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
    const MEASURED: [&str; 4] = ["Cargo.lock", "firmware", "gateware", "tools/reference"];
    let git = |arguments: &[&str]| output("git", &[arguments, &["--"], &MEASURED].concat());
    let changed = !git(&["status", "--porcelain"]).is_empty();
    git(&["log", "-1", "--format=%h", "--abbrev=12"]) + if changed { "-dirty" } else { "" }
}

/// A program's standard output, or `unknown` if the program fails.
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
