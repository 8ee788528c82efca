//! The kernels of the index, read from the tables of the pages.

use std::path::Path;

use anyhow::Result;

use crate::report::experiments::geometry::precision;
use crate::report::experiments::gouraud::{clocks, engines, forms};
use crate::report::experiments::raymarch::trials::Trial;
use crate::report::experiments::{gesture, imu, kernels, sine};
use crate::report::pages::gouraud::variants;
use crate::report::pages::kernels::of;
use crate::report::table::{read_csv, read_optional_csv};

/// A kernel: its name, its page, its units, and its configurations.
pub struct Entry {
    /// Name of the kernel.
    pub name: &'static str,
    /// Page with all figures, relative to docs/report.
    pub page: &'static str,
    /// Unit of errors.
    pub error_unit: &'static str,
    /// Unit of costs.
    pub cost_unit: &'static str,
    /// Block of the gateware that contains a configuration, and a part of this configuration's name.
    pub block: Option<Block>,
    /// Whether the diagram of the index shows the kernel.
    pub in_overview: bool,
    /// All configurations.
    pub choices: Vec<Choice>,
}

/// A configuration of a kernel, with its error and its cost in the units of the kernel's entry.
pub struct Choice {
    /// Word length and method.
    pub config: String,
    /// Whether Glint uses the configuration.
    pub shipped: bool,
    /// Largest error.
    pub error: f64,
    /// Root of the mean of the squared errors.
    pub rms: Option<f64>,
    /// Cycles or another cost.
    pub cost: Option<f64>,
}

/// Name of a block, and a part of the name of the configuration that it contains.
pub type Block = (&'static str, &'static str);

/// Family in `kernels.csv`, name, page, unit of errors and block of small kernels.
const SMALL: [(&str, &str, &str, &str, Option<Block>); 6] = [
    (
        "reciprocal",
        "1/x",
        "kernels.md#reciprocal",
        "",
        Some(("vertex_stage", "of vertices")),
    ),
    (
        "inverse root",
        "1/√x",
        "kernels.md#reciprocal-square-root",
        "",
        Some(("ray_generator", "of each ray")),
    ),
    ("root", "√x", "kernels.md#square-root", "", None),
    (
        "division",
        "a/b",
        "kernels.md#division",
        "",
        Some(("vertex_stage", "of vertices")),
    ),
    (
        "length",
        "length",
        "kernels.md#length-of-a-vector",
        "",
        Some(("field_sphere", "of spheres")),
    ),
    (
        "unit",
        "unit vector",
        "kernels.md#vector-of-length-1",
        "",
        None,
    ),
];

/// Kernel in `kernels.csv` and name of the words of the pipeline.
const WORDS: [(&str, &str, &str); 6] = [
    ("vertex", "word of a vertex", "px"),
    ("basis", "word of the camera's axes", "px"),
    ("inverse", "word of 1/z", "px"),
    ("snap", "word of a position", "px"),
    ("normal", "word of a normal", "/255"),
    ("intensity", "word of an intensity", "/255"),
];

/// Family in `geometry-precision.csv`, name, page and unit of errors.
const GEOMETRY: [(&str, &str, &str, &str); 3] = [
    (
        "matrix",
        "product of matrices",
        "geometry.md#model-matrices",
        "",
    ),
    ("normal", "turned normal", "geometry.md#normals", ""),
    (
        "projection",
        "projection",
        "geometry.md#projection",
        "/256 px",
    ),
];

/// Study of the raymarcher, name, unit of errors, error and cost.
type Study = (
    &'static str,
    &'static str,
    &'static str,
    fn(&Trial) -> f64,
    fn(&Trial) -> Option<f64>,
    &'static str,
);
const STUDIES: [Study; 4] = [
    (
        "threshold",
        "ray: threshold of a hit",
        "world units, p99 of depths",
        |trial| trial.depth_p99.unwrap_or(0.0),
        |trial| trial.cycles,
        "cycles a picture",
    ),
    (
        "cap",
        "ray: step limit",
        "of the masks",
        |trial| 1.0 - trial.iou,
        |trial| trial.cycles,
        "cycles a picture",
    ),
    (
        "fraction",
        "ray: fraction bits",
        "world units, median of depths",
        |trial| trial.depth_median.unwrap_or(0.0),
        |trial| Some(trial.evaluations),
        "evaluations a ray",
    ),
    (
        "prepass",
        "ray: cones before the rays",
        "wrong faces",
        |trial| trial.wrong_faces,
        |trial| trial.cycles,
        "cycles a picture",
    ),
];

/// Reads the tables of all pages.
///
/// # Errors
/// When a table is missing.
pub fn read(folder: &Path) -> Result<Vec<Entry>> {
    let mut entries = vec![sines(folder)?];
    entries.extend(small(folder)?);
    entries.extend(geometry(folder)?);
    entries.push(shading(folder)?);
    entries.extend(rays(folder)?);
    entries.push(attitudes(folder)?);
    entries.push(filters(folder)?);
    Ok(entries)
}

fn sines(folder: &Path) -> Result<Entry> {
    let rows: Vec<sine::Row> = read_csv(&folder.join("sine.csv"))?;
    // The last row of a kernel has the most inputs.
    let is_last = |at: usize| {
        rows[at + 1..]
            .iter()
            .all(|row| row.kernel != rows[at].kernel)
    };
    let last = rows.iter().enumerate().filter(|(at, _)| is_last(*at));
    Ok(Entry {
        name: "sine, cosine",
        page: "sine.md",
        error_unit: "",
        cost_unit: "cycles",
        block: None,
        in_overview: true,
        choices: last
            .map(|(_, row)| Choice {
                config: format!("{}, {}", row.kernel, row.word_length),
                shipped: row.shipped,
                error: row.max_err,
                rms: Some(row.rms),
                cost: row.cycles_median.map(|cycles| cycles as f64),
            })
            .collect(),
    })
}

fn small(folder: &Path) -> Result<Vec<Entry>> {
    let rows: Vec<kernels::Row> = read_csv(&folder.join("kernels.csv"))?;
    let choice = |row: &kernels::Row| Choice {
        config: row.config.clone(),
        shipped: row.shipped,
        error: row.max_err,
        rms: Some(row.rms),
        cost: row
            .bits
            .map(f64::from)
            .or(row.cycles_median.map(|cycles| cycles as f64)),
    };
    let all = |family| of(&rows, family).iter().map(choice).collect();
    let mut entries: Vec<Entry> = SMALL
        .into_iter()
        .map(|(family, name, page, error_unit, block)| Entry {
            name,
            page,
            error_unit,
            cost_unit: "cycles",
            block,
            in_overview: true,
            choices: all(family),
        })
        .collect();
    let stored = [
        (
            "depth",
            "stored depth",
            "kernels.md#stored-depth",
            "of the depth",
        ),
        (
            "colour",
            "stored colour",
            "kernels.md#stored-colour",
            "/255",
        ),
    ];
    for (family, name, page, error_unit) in stored {
        entries.push(Entry {
            name,
            page,
            error_unit,
            cost_unit: "bits",
            block: None,
            in_overview: false,
            choices: all(family),
        });
    }
    for (kernel, name, error_unit) in WORDS {
        entries.push(Entry {
            name,
            page: "kernels.md#number-formats-of-the-pipeline",
            error_unit,
            cost_unit: "bits",
            block: None,
            in_overview: false,
            choices: rows
                .iter()
                .filter(|row| row.kernel == kernel)
                .map(choice)
                .collect(),
        });
    }
    Ok(entries)
}

fn geometry(folder: &Path) -> Result<Vec<Entry>> {
    let rows: Vec<precision::Row> = read_csv(&folder.join("geometry-precision.csv"))?;
    let entry = |(family, name, page, error_unit): (&str, _, _, _)| Entry {
        name,
        page,
        error_unit,
        cost_unit: "cycles",
        block: (family == "projection").then_some(("vertex_stage", "")),
        in_overview: false,
        choices: rows
            .iter()
            .filter(|row| row.family == family)
            .map(|row| Choice {
                config: row.config.clone(),
                shipped: row.shipped,
                error: row.max_err,
                rms: Some(row.rms),
                cost: row.cycles_median.map(|cycles| cycles as f64),
            })
            .collect(),
    };
    Ok(GEOMETRY.into_iter().map(entry).collect())
}

fn shading(folder: &Path) -> Result<Entry> {
    let forms: Vec<forms::Row> = read_csv(&folder.join("gouraud-forms.csv"))?;
    let clocks: Vec<clocks::Row> = read_csv(&folder.join("gouraud-clocks.csv"))?;
    let costs: Vec<engines::Cost> = read_optional_csv(&folder.join("gouraud-cost.csv"))?;
    let variants = variants::read(&forms, &clocks, &costs);
    let choice = |variant: &variants::Variant| {
        let point = variant.point(variant.clocks(variants::CLOCKS_SCENE));
        Choice {
            config: format!("{} ({})", point.family, point.label),
            shipped: point.shipped,
            error: variant.largest_error(),
            rms: Some(point.error),
            cost: point.cost,
        }
    };
    Ok(Entry {
        name: "smooth shading",
        page: "gouraud.md",
        error_unit: "steps of a channel",
        cost_unit: "clocks a pixel",
        block: Some(("triangle_engine_smooth", "")),
        in_overview: false,
        choices: variants.iter().map(choice).collect(),
    })
}

fn rays(folder: &Path) -> Result<Vec<Entry>> {
    let entry = |(study, name, error_unit, error, cost, cost_unit): Study| {
        let trials: Vec<Trial> = read_csv(&folder.join(format!("raymarch-{study}.csv")))?;
        let choice = |trial: &Trial| Choice {
            config: format!("{}: {}", trial.family, trial.config),
            shipped: trial.shipped,
            error: error(trial),
            rms: None,
            cost: cost(trial),
        };
        Ok(Entry {
            name,
            page: "raymarch.md",
            error_unit,
            cost_unit,
            block: Some(("raymarcher", "")),
            in_overview: false,
            choices: trials.iter().map(choice).collect(),
        })
    };
    STUDIES.into_iter().map(entry).collect()
}

fn attitudes(folder: &Path) -> Result<Entry> {
    let trials: Vec<imu::methods::Trial> = read_csv(&folder.join("imu-methods.csv"))?;
    let tumble = trials
        .iter()
        .filter(|trial| trial.motion == "tumble" && trial.rate == 200.0);
    Ok(Entry {
        name: "attitude, a sample",
        page: "imu.md",
        error_unit: "° after 20 s of tumbling, 200 Hz",
        cost_unit: "cycles",
        block: None,
        in_overview: false,
        choices: tumble
            .map(|trial| Choice {
                config: trial.method.clone(),
                shipped: trial.shipped,
                error: trial.error,
                rms: None,
                cost: trial.cycles.map(|cycles| cycles as f64),
            })
            .collect(),
    })
}

fn filters(folder: &Path) -> Result<Entry> {
    let rows: Vec<gesture::Row> = read_csv(&folder.join("gesture-filters.csv"))?;
    Ok(Entry {
        name: "filter of a hand",
        page: "gesture.md",
        error_unit: "° at rest, RMS",
        cost_unit: "cycles",
        block: None,
        in_overview: false,
        choices: rows
            .iter()
            .map(|row| Choice {
                config: [row.filter.as_str(), &row.parameters]
                    .join(" ")
                    .trim_end()
                    .to_owned(),
                shipped: row.shipped,
                error: row.rest,
                rms: None,
                cost: row.cycles.map(|cycles| cycles as f64),
            })
            .collect(),
    })
}
