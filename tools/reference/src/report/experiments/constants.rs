//! Constants of the firmware, the gateware and the experiments that the text of the report's pages quotes.

use glint_core::quality::{Quality, Threshold};
use glint_model::raymarch::Tuning;
use glint_testbench::Raymarcher;
use serde::{Deserialize, Serialize};

use super::raymarch::requirements::{EXITS, EXITS_GOAL, LARGE_COST, MARCHING, SMALL_COST};
use super::{gesture, timeline};
use crate::imu::measure::LEFT_BIAS;

/// A constant: a line of `constants.csv`.
#[derive(Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Row {
    /// Name of the constant in the templates of the pages.
    pub name: String,
    /// Value, as displayed on the page.
    pub value: String,
}

/// All constants.
pub fn all() -> Vec<Row> {
    let mut rows = Vec::new();
    let mut add = |name: &str, value: String| {
        let name = name.to_owned();
        rows.push(Row { name, value });
    };
    let Threshold { base, footprint } = Quality::default().preset().threshold;
    add("threshold", base.to_string());
    add("footprint", footprint.to_string());
    add("step_limit", Tuning::default().cap.to_string());
    for (kind, level, bounds) in [
        ("exits", "", EXITS),
        ("exits", "_goal", EXITS_GOAL),
        ("marching", "", MARCHING),
    ] {
        add(&format!("{kind}_iou{level}"), bounds.iou.to_string());
        add(
            &format!("{kind}_median{level}"),
            format!("{:e}", bounds.median),
        );
        add(&format!("{kind}_p99{level}"), format!("{:e}", bounds.p99));
        add(&format!("{kind}_faces{level}"), percent(bounds.faces));
    }
    for (name, [required, goal]) in [("small_cost", SMALL_COST), ("large_cost", LARGE_COST)] {
        add(name, required.to_string());
        add(&format!("{name}_goal"), goal.to_string());
    }
    add("normals", MARCHING.normals.to_string());
    add("model_lanes", Raymarcher::LANES.to_string());
    add("timeline_lanes", timeline::LANES.to_string());
    add("camera_rate", gesture::RATE.to_string());
    add("left_bias", format!("{LEFT_BIAS:?}"));
    rows
}

/// A fraction as text in percent, rounded to hide the error of the binary product.
fn percent(part: f64) -> String {
    format!("{}", (part * 1e8).round() / 1e6)
}
