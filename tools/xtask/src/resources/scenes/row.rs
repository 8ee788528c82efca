//! A row of the tables of docs/scene-builds.md.

use serde::Deserialize;

use super::super::size::{Resource, Size};
use crate::firmware::Image;

/// Name of the build for all scenes.
pub const ALL: &str = "all";

/// The resources of a build in the columns of the table, with the names of their limits in a scene file.
pub const COLUMNS: [(Resource, &str); 4] = [
    (Resource::Lut, "lut"),
    (Resource::Ff, "ff"),
    (Resource::Dsp48, "dsp"),
    (Resource::Ramb36, "ramb36"),
];

/// The statistics of a frame from `glint render --stats`, as far as the page has them: clock cycles, the clock in Hz, and words.
#[derive(Clone, Debug, Default, Deserialize)]
pub struct Stats {
    pub cycles: u64,
    pub cycles_soft_core: u64,
    pub cycles_geometry: u64,
    pub cycles_raster: u64,
    pub cycles_stalled: u64,
    pub clock: u64,
    pub words_read: u64,
    pub words_written: u64,
}

/// What a scene's frame takes.
pub struct Frame {
    pub stats: Stats,
    /// Number of frames per second, when one follows the other.
    pub rate: f64,
    /// Megabytes a second of main memory: the engines' at this rate, and scan-out's.
    pub memory: f64,
}

/// What the firmware for a scene takes, in bytes.
pub struct Firmware {
    pub image: Image,
    /// The stack that the self-test and the scene's picture use; `None` for the firmware for all scenes, and with smooth shading.
    pub stack: Option<u64>,
}

/// A build and its measurements.
pub struct Row {
    pub name: String,
    pub options: Vec<String>,
    pub size: Size,
    pub firmware: Firmware,
    /// Whether the build is for a single picture, neither for a list of scenes nor for all.
    pub is_single: bool,
    /// `None` for the build for all scenes.
    pub frame: Option<Frame>,
    pub budget: Vec<(&'static str, f64)>,
}

#[cfg(test)]
pub mod tests {
    use super::super::super::table::tests::measured;
    use super::*;

    /// The row of a single scene.
    pub fn row(name: &str) -> Row {
        let mut size = measured(None).sizes.remove(0);
        size.name = name.into();
        Row {
            name: name.into(),
            options: vec!["--blocks".into(), "scanout".into()],
            size,
            firmware: Firmware {
                image: Image {
                    length: 54_321,
                    code: 40_000,
                    constants: 14_000,
                    variables: 20_502,
                    stack: 0x4004_0000..0x40F0_0000,
                },
                stack: Some(97_000),
            },
            is_single: true,
            frame: Some(Frame {
                stats: Stats {
                    cycles: 1_354_166,
                    cycles_soft_core: 66,
                    cycles_geometry: 4_100,
                    cycles_raster: 1_350_000,
                    cycles_stalled: 12,
                    ..Stats::default()
                },
                rate: 60.0,
                memory: 55.3,
            }),
            budget: vec![],
        }
    }
}
