//! The rows of the report, as a table on the terminal and as CSV.

use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result};
use glint_reference::sine::statistics::Statistics;
use glint_reference::sine::subjects::Subject;
use serde::Serialize;

use crate::cycles::Figures;
use crate::in_workspace;
use crate::plot::{Diagram, Point};

/// One kernel in one configuration: a line of the CSV. Errors are absolute.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    pub kernel: &'static str,
    #[serde(skip)]
    pub family: &'static str,
    pub config: &'static str,
    pub word_length: &'static str,
    /// Whether Glint uses it.
    pub shipped: bool,
    pub inputs: String,
    pub samples: u64,
    pub max_err: f64,
    pub max_ulp: f64,
    pub rms: f64,
    pub p99: f64,
    /// Mean error of the magnitude.
    pub bias: f64,
    pub argmax: String,
    /// Largest |sin² + cos² − 1|.
    pub max_norm: f64,
    /// Inputs where a symmetry of the circle does not hold bit for bit; only phases are checked.
    pub asymmetric: Option<u64>,
    pub cycles_min: Option<u64>,
    pub cycles_median: Option<u64>,
    pub cycles_max: Option<u64>,
    /// Columns that all kernels of the report share; those of hardware stay empty for software.
    pub instr: Option<u64>,
    #[serde(rename = "LUT")]
    pub lut: Option<u64>,
    #[serde(rename = "FF")]
    pub ff: Option<u64>,
    #[serde(rename = "DSP")]
    pub dsp: Option<u64>,
    #[serde(rename = "BRAM")]
    pub bram: Option<u64>,
    pub fmax: Option<f64>,
    pub commit: String,
    pub tools: String,
}

impl Row {
    /// The row of a subject of which every `stride`-th step was measured.
    pub fn new(
        subject: &Subject,
        stride: u64,
        statistics: &Statistics,
        cycles: Option<Figures>,
        provenance: &Provenance,
    ) -> Self {
        Self {
            kernel: subject.kernel,
            family: subject.family,
            config: subject.config,
            word_length: subject.format,
            shipped: subject.shipped,
            inputs: match stride {
                1 => subject.inputs.to_owned(),
                _ => format!("a sample of {}", subject.inputs),
            },
            samples: statistics.inputs,
            max_err: statistics.max,
            max_ulp: statistics.max / subject.ulp,
            rms: statistics.rms(),
            p99: statistics.p99(),
            bias: statistics.bias(),
            argmax: format!(
                "{} of {}",
                statistics.worst_function,
                subject.show_input(statistics.worst_input)
            ),
            max_norm: statistics.max_norm,
            asymmetric: subject.by_phase.then_some(statistics.asymmetric),
            cycles_min: cycles.map(|cycles| cycles.min),
            cycles_median: cycles.map(|cycles| cycles.median),
            cycles_max: cycles.map(|cycles| cycles.max),
            instr: None,
            lut: None,
            ff: None,
            dsp: None,
            bram: None,
            fmax: None,
            commit: provenance.commit.clone(),
            tools: provenance.tools.clone(),
        }
    }

    /// Good bits after the point: −log2 of the largest error.
    pub fn bits(&self) -> f64 {
        -self.max_err.log2()
    }

    /// Cycles as "min / median / max".
    pub fn cycles(&self) -> String {
        match (self.cycles_min, self.cycles_median, self.cycles_max) {
            (Some(min), Some(median), Some(max)) => format!("{min} / {median} / {max}"),
            _ => "not measured".to_owned(),
        }
    }
}

/// What the figures were made from.
pub struct Provenance {
    pub commit: String,
    pub tools: String,
}

impl Provenance {
    /// Asks git, the compiler and the lock file.
    pub fn find() -> Self {
        let lock = std::fs::read_to_string(in_workspace("Cargo.lock")).unwrap_or_default();
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

/// The last commit that touched what is measured, marked when there are changes since.
fn commit() -> String {
    const MEASURED: [&str; 4] = ["Cargo.lock", "firmware", "gateware", "tools/reference"];
    let git = |arguments: &[&str]| output("git", &[arguments, &["--"], &MEASURED].concat());
    let changed = !git(&["status", "--porcelain"]).is_empty();
    git(&["log", "-1", "--format=%h", "--abbrev=12"]) + if changed { "-dirty" } else { "" }
}

/// What a program prints, or "unknown" where it is not there.
fn output(program: &str, arguments: &[&str]) -> String {
    let run = Command::new(program)
        .args(arguments)
        .current_dir(in_workspace(""))
        .output();
    match run {
        Ok(output) if output.status.success() => {
            String::from_utf8_lossy(&output.stdout).trim().to_owned()
        }
        _ => "unknown".to_owned(),
    }
}

/// What `sine.svg` shows.
pub const DIAGRAM: Diagram = Diagram {
    title: "Sine and cosine: cycles against largest error",
    across: "largest absolute error, over all inputs",
    up: "median cycles of a call on the SoC",
};

/// The points of the diagram, one a kernel: over the more inputs, where there are two rows.
pub fn points(rows: &[Row]) -> Vec<Point> {
    let mut last: Vec<&Row> = Vec::new();
    for row in rows {
        last.retain(|other| other.kernel != row.kernel);
        last.push(row);
    }
    last.into_iter()
        .map(|row| Point {
            family: row.family.to_owned(),
            label: match row.cycles_median {
                Some(_) => format!("{} {}", row.kernel, row.word_length),
                None => row.kernel.to_owned(),
            },
            error: row.max_err,
            cost: row.cycles_median.map(|cycles| cycles as f64),
            shipped: row.shipped,
        })
        .collect()
}

/// Writes the rows as CSV.
pub fn write_csv<T: Serialize>(rows: &[T], path: &Path) -> Result<()> {
    let mut writer =
        csv::Writer::from_path(path).with_context(|| format!("cannot write {}", path.display()))?;
    for row in rows {
        writer.serialize(row)?;
    }
    writer.flush()?;
    Ok(())
}

/// The rows for the terminal.
pub fn terminal(rows: &[Row]) -> String {
    let mut cells = vec![
        [
            "", "kernel", "config", "format", "max", "ULP", "bits", "rms", "bias", "cycles",
            "worst at",
        ]
        .map(String::from),
    ];
    cells.extend(rows.iter().map(|row| {
        [
            if row.shipped { "*" } else { "" }.to_owned(),
            row.kernel.to_owned(),
            row.config.to_owned(),
            row.word_length.to_owned(),
            format!("{:.2e}", row.max_err),
            format!("{:.3}", row.max_ulp),
            format!("{:.1}", row.bits()),
            format!("{:.2e}", row.rms),
            format!("{:+.1e}", row.bias),
            row.cycles(),
            format!("{}; {}", row.argmax, row.inputs),
        ]
    }));
    let widths: Vec<usize> = (0..cells[0].len())
        .map(|column| {
            cells
                .iter()
                .map(|row| row[column].chars().count())
                .max()
                .unwrap_or(0)
        })
        .collect();
    let mut text = String::new();
    for row in &cells {
        let line: Vec<String> = row
            .iter()
            .zip(&widths)
            .map(|(cell, &width)| format!("{cell:width$}"))
            .collect();
        let _ = writeln!(text, "{}", line.join("  ").trim_end());
    }
    text.push_str(
        "* used by Glint; cycles are min / median / max of a sine and a cosine together\n",
    );
    text
}
