//! Constants of the firmware, the gateware and the experiments that the text of the report's pages quotes.

use glint_model::raymarch::{DEFAULT_TUNING, ROUND_TUNING};
use glint_testbench::Raymarcher;
use serde::{Deserialize, Serialize};

use super::raymarch::requirements::{EXITS, LARGE_COST, MARCHING, SMALL_COST};
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
    for (kind, tuning, laps) in [("", DEFAULT_TUNING, 1), ("round_", ROUND_TUNING, 4)] {
        add(&format!("{kind}threshold"), tuning.threshold.to_string());
        add(&format!("{kind}footprint"), tuning.footprint.to_string());
        add(
            &format!("{kind}step_limit"),
            (laps * tuning.cap).to_string(),
        );
    }
    for (kind, bounds) in [("exits", EXITS), ("marching", MARCHING)] {
        for (name, [required, goal]) in [
            ("iou", bounds.iou.map(|part| part.to_string())),
            ("median", bounds.median.map(|error| format!("{error:e}"))),
            ("p99", bounds.p99.map(|error| format!("{error:e}"))),
            ("faces", bounds.faces.map(percent)),
        ] {
            add(&format!("{kind}_{name}"), required);
            add(&format!("{kind}_{name}_goal"), goal);
        }
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

/// A part as text in percent, without the binary rounding of its product.
fn percent(part: f64) -> String {
    format!("{}", (part * 1e8).round() / 1e6)
}
