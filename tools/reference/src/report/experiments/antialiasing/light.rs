//! Averages of samples in linear light.

use serde::{Deserialize, Serialize};

use super::compared::{Compared, FourSamples, mean};
use crate::camera::Vector;
use crate::picture::averaged::Averaged;

/// Differences between averages of four samples in linear light and averages of their sRGB values, in f64: a line of
/// `antialiasing-light.csv`. Differences are of a channel in steps of 1/255.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct LightRow {
    /// Name of the scene.
    pub scene: String,
    /// RMS over all pixels.
    pub rms: f64,
    /// RMS over the pixels whose 64 samples show more than one surface.
    pub edges: f64,
    /// Largest difference.
    pub largest: f64,
}

/// The light of an sRGB value from 0 to 255; 1 is white.
fn to_light(value: f64) -> f64 {
    match value / 255.0 {
        dark @ ..=0.04045 => dark / 12.92,
        value => ((value + 0.055) / 1.055).powf(2.4),
    }
}

/// The sRGB value of a light.
fn from_light(light: f64) -> f64 {
    255.0
        * match light {
            dark @ ..=0.003_130_8 => 12.92 * dark,
            light => 1.055 * light.powf(1.0 / 2.4) - 0.055,
        }
}

/// The mean of four samples in linear light.
fn mean_light(samples: &FourSamples, pixel: usize) -> Vector {
    [0, 1, 2].map(|i: usize| {
        let light = samples.iter().map(|sample| to_light(sample[pixel][i]));
        from_light(light.sum::<f64>() / samples.len() as f64)
    })
}

/// Compares averages of four samples in linear light with averages of their values.
pub fn measure(scene: &str, samples: &FourSamples, edges: &[bool]) -> LightRow {
    let averages = Averaged {
        colours: (0..edges.len()).map(|pixel| mean(samples, pixel)).collect(),
        edges: edges.to_vec(),
    };
    let light = (0..edges.len()).map(|pixel| mean_light(samples, pixel));
    let compared = Compared::new(light, &averages);
    LightRow {
        scene: scene.to_owned(),
        rms: compared.all.rms(),
        edges: compared.edges.rms(),
        largest: compared.all.max,
    }
}
