//! Diagrams of the studies of raymarching, and the sections on them in the page `raymarch.md`.

use std::path::{Path, PathBuf};

use anyhow::Result;

use crate::report::experiments::raymarch::trials::Trial;
use crate::report::plot::{self, Diagram, Point};
use crate::report::table::{Table, optional, read_optional_csv};

/// The diagram and the text that present a study.
pub struct Study {
    /// Name of the study, as it occurs in the names of the study's files.
    name: &'static str,
    diagram: Diagram,
    /// Description of the varied parameter and of its effect.
    text: &'static str,
    error: fn(&Trial) -> f64,
    cost: fn(&Trial) -> Option<f64>,
}

const DEPTH_P99: &str = "99th percentile of the depth's error, in world units";
const DEPTH_MEDIAN: &str = "median error of the depth, in world units";
const EVALUATIONS: &str = "evaluations a ray";
const CYCLES: &str = "cycles a picture, two lanes";

/// The studies and how they are presented, in their order on the page.
pub const STUDIES: [Study; 8] = [
    Study {
        name: "fraction",
        diagram: Diagram {
            title: "Fraction bits of field units",
            across: DEPTH_MEDIAN,
            up: EVALUATIONS,
        },
        text: "Fraction bits of coordinates and distances, with a threshold of the same length and one of the same number of steps.\n\
               Directions keep their 17 bits. At the same threshold, more than 12 bits change the median of the depth by a few millionths\n\
               and nothing else: errors at edges depend on the threshold, and a smaller one costs evaluations at any word length.",
        error: |trial| trial.depth_median.unwrap_or(0.0),
        cost: evaluations,
    },
    Study {
        name: "cap",
        diagram: Diagram {
            title: "Step limit of a ray",
            across: "part of the masks not in common",
            up: CYCLES,
        },
        text: "An undecided ray counts as a miss. The last rays to end run along faces: a smaller limit leaves more of them undecided\n\
               and saves few evaluations.",
        error: |trial| 1.0 - trial.iou,
        cost: cycles,
    },
    Study {
        name: "threshold",
        diagram: Diagram {
            title: "Thresholds of a hit",
            across: DEPTH_P99,
            up: CYCLES,
        },
        text: "The threshold in steps of 2^−12 field units, and the footprint: the part of t added to it.",
        error: p99,
        cost: cycles,
    },
    Study {
        name: "norm",
        diagram: Diagram {
            title: "Norms of distances and of rays",
            across: DEPTH_P99,
            up: EVALUATIONS,
        },
        text: "In f64 except for the model, by threshold, from the model's starts of rays: distances in the maximum norm with rays of\n\
               length 1 in the same norm (Glint), the same with rays of Euclidean length 1, and Euclidean distances. Rays of Euclidean\n\
               length 1 take a fifth more evaluations without smaller errors. The model lies where its f64 variant does.",
        error: p99,
        cost: evaluations,
    },
    Study {
        name: "end",
        diagram: Diagram {
            title: "Starts and ends of rays",
            across: DEPTH_P99,
            up: EVALUATIONS,
        },
        text: "In f64, by threshold, from the model's starts of rays. Glint's rays are doubling and corrected, *plain* is a march with\n\
               neither. *Corrected*: the last step is the distance divided by the direction's component along the normal where the ray\n\
               goes towards the face, so depths on faces are exact. *Doubling* and *quadrupling*: the threshold grows by that factor\n\
               after each 64 evaluations. Quadrupling decides the last rays at a threshold of 6, but far from the camera it ends rays\n\
               along faces at faces that they would pass. *Exact entry*: rays start exactly at the cube around the sponge; the model's\n\
               start before it by the error of a ten-bit reciprocal. Errors below 1e-6, the resolution of field units, are drawn as\n\
               1e-6.",
        error: |trial| p99(trial).max(1e-6),
        cost: evaluations,
    },
    Study {
        name: "prepass",
        diagram: Diagram {
            title: "Cones before the rays",
            across: "part of wrong faces",
            up: CYCLES,
        },
        text: "By threshold of rays and cones: without a prepass, and with a cone for each block of 4×4 pixels, the gateware's blocks\n\
               for pictures of this size. Blocks of 8×8 and 16×16 pixels, in software only, are in the table. Cones of smaller blocks\n\
               reach farther, so the sum of evaluations falls although there are more cones.",
        error: |trial| trial.wrong_faces,
        cost: cycles,
    },
    Study {
        name: "block",
        diagram: Diagram {
            title: "Blocks of cones at 1280×720",
            across: "part of wrong faces",
            up: EVALUATIONS,
        },
        text: "The tunnel, the slowest view, at 1280×720 in software, by threshold of rays and cones. A frame of 921,600 rays at 60 frames\n\
               a second and 81.25 MHz leaves two lanes 2.94 evaluations a ray, with those of the cones, and four lanes 5.88. No size\n\
               of blocks comes near 2.94 at a threshold that meets the requirements.",
        error: |trial| trial.wrong_faces,
        cost: evaluations,
    },
    Study {
        name: "normal",
        diagram: Diagram {
            title: "Methods for the normal",
            across: "part of wrong faces",
            up: EVALUATIONS,
        },
        text: "At the model's hits: the face of the last distance (Glint), which needs no evaluation, or the axis of the largest slope by\n\
               f64 distances a step beside the hit, in field units. Forward differences count the distance at the hit as one of four\n\
               evaluations. Slopes correct less than a tenth of the wrong faces: the others are at rays that end in a wrong place.",
        error: |trial| trial.wrong_faces,
        cost: evaluations,
    },
];

fn evaluations(trial: &Trial) -> Option<f64> {
    Some(trial.evaluations)
}

fn cycles(trial: &Trial) -> Option<f64> {
    trial.cycles
}

fn p99(trial: &Trial) -> f64 {
    trial.depth_p99.unwrap_or(0.0)
}

/// Formats an error with two digits, or as `none`.
pub fn error(error: Option<f64>) -> String {
    error.map_or("none".to_owned(), |error| format!("{error:.1e}"))
}

impl Study {
    fn file(&self, folder: &Path, extension: &str) -> PathBuf {
        folder.join(format!("raymarch-{}.{extension}", self.name))
    }

    /// Reads the study's trials from its CSV file. Returns no trials if the file is missing.
    ///
    /// # Errors
    /// When a line does not have the columns of a trial.
    pub fn read(&self, folder: &Path) -> Result<Vec<Trial>> {
        read_optional_csv(&self.file(folder, "csv"))
    }

    /// Writes the diagram of the study's trials.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn draw(&self, trials: &[Trial], folder: &Path) -> Result<()> {
        let points: Vec<Point> = trials
            .iter()
            .map(|trial| Point {
                family: trial.family.clone(),
                label: trial.config.clone(),
                error: (self.error)(trial),
                cost: (self.cost)(trial),
                shipped: trial.shipped,
            })
            .collect();
        plot::write(&self.diagram, &points, &self.file(folder, "svg"))
    }

    /// Formats the section on the study as Markdown.
    pub fn section(&self, trials: &[Trial]) -> String {
        let (name, title) = (self.name, self.diagram.title);
        format!(
            "### {title}\n\n![{title}](raymarch-{name}.svg)\n\n{}\nAll trials: [raymarch-{name}.csv](raymarch-{name}.csv).\n\n{}\n",
            self.text,
            misses(trials)
        )
    }
}

/// Formats the list of the trials that miss a requirement as Markdown.
/// Each trial has the names of the requirements that it misses.
fn misses(trials: &[Trial]) -> String {
    let failed = trials.iter().filter(|trial| !trial.failed.is_empty());
    let failed: Vec<&Trial> = failed.collect();
    if failed.is_empty() {
        return "Every configuration meets the requirements.\n".to_owned();
    }
    let mut table = Table::new([
        "family",
        "configuration",
        "IoU",
        "undecided",
        "depth: median, p99",
        "wrong faces",
        "evaluations a ray",
        "cycles",
        "missed",
    ]);
    for trial in failed {
        table.row([
            trial.family.clone(),
            trial.config.clone(),
            format!("{:.6}", trial.iou),
            trial.undecided.to_string(),
            format!("{}, {}", error(trial.depth_median), error(trial.depth_p99)),
            format!("{:.2} %", 100.0 * trial.wrong_faces),
            format!("{:.2}", trial.evaluations),
            optional(trial.cycles.map(|cycles| format!("{cycles:.0}"))),
            trial.failed.clone(),
        ]);
    }
    format!(
        "Configurations that miss a requirement:\n\n{}",
        table.finish()
    )
}
