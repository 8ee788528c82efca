//! Constants of the firmware, the gateware and the experiments that the text of the report's pages quotes.

use glint_model::raymarch::{DEFAULT_TUNING, ROUND_TUNING};
use glint_testbench::Raymarcher;
use serde::{Deserialize, Serialize};

use super::raymarch::requirements::{FACES, IOU, LARGE_COST, MEDIAN, NORMALS, P99, SMALL_COST};
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
    for (name, [required, goal]) in [
        ("iou", IOU.map(|part| part.to_string())),
        ("median", MEDIAN.map(|error| format!("{error:e}"))),
        ("p99", P99.map(|error| format!("{error:e}"))),
        ("faces", FACES.map(|part| (100.0 * part).to_string())),
        ("small_cost", SMALL_COST.map(|cost| cost.to_string())),
        ("large_cost", LARGE_COST.map(|cost| cost.to_string())),
    ] {
        add(name, required);
        add(&format!("{name}_goal"), goal);
    }
    add("normals", NORMALS.to_string());
    add("model_lanes", Raymarcher::LANES.to_string());
    add("timeline_lanes", timeline::LANES.to_string());
    add("camera_rate", gesture::RATE.to_string());
    add("left_bias", format!("{LEFT_BIAS:?}"));
    rows
}
