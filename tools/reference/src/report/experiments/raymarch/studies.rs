//! Experiments: each study varies one parameter of marching rays, and measures errors, evaluations and clocks.

use anyhow::{Result, bail};
use glint_core::quality::{Quality, Threshold};
use glint_model::raymarch::{DEFAULT_TUNING, FieldOptions, Tuning};

use super::fixed_point::{FixedPoint, MODEL_FRACTION};
use super::requirements::SMALL;
use super::trials::{Trial, Views, pixels};
use crate::raymarch::metrics::RayOutcome;
use crate::raymarch::raymarched::{self, marching};
use crate::raymarch::variant::{Method, Norm, Taps};
use crate::report::{progress, soc};

/// Function that draws all configurations of a study and returns the trials.
type Study = fn(&Views) -> Vec<Trial>;

/// Name and function of each study, in the order on the report's page. The file of a study is `raymarch-NAME.csv`.
const STUDIES: [(&str, Study); 7] = [
    ("form", forms),
    ("fraction", fractions),
    ("cap", caps),
    ("threshold", thresholds),
    ("norm", norms),
    ("end", ends),
    ("normal", normals),
];

/// Names of the studies.
pub fn names() -> impl Iterator<Item = &'static str> {
    STUDIES.into_iter().map(|(name, _)| name)
}

/// Runs all studies, or only the study `only`. Calls `finished` with the name and trials of each completed study.
///
/// # Errors
/// When no study has the name `only`, or `finished` fails.
pub fn measure(
    only: Option<&str>,
    finished: impl Fn(&str, &[Trial]) -> Result<()> + Sync,
) -> Result<()> {
    let selected = |(name, _): &&(&str, Study)| only.is_none_or(|only| *name == only);
    let studies: Vec<_> = STUDIES.iter().filter(selected).copied().collect();
    if studies.is_empty() {
        let names = STUDIES.map(|(name, _)| name).join(" ");
        bail!(
            "unknown study {}: expected one of {names}",
            only.unwrap_or_default()
        );
    }
    let bar = progress::bar(studies.len() as u64)?;
    let subjects = raymarched::sponges(SMALL);
    soc::two_at_a_time(&studies, |(name, study)| {
        finished(name, &study(&Views::new(&subjects, bar.clone())))?;
        bar.inc(1);
        Ok(())
    })?;
    bar.finish_and_clear();
    Ok(())
}

fn tuned(tuning: Tuning) -> FieldOptions {
    FieldOptions {
        tuning,
        ..marching()
    }
}

/// Number of field units in one world unit, for the sponge.
const UNITS: f64 = 40.5;

/// Returns Glint's marching method in f64. `threshold` is in field units with 12 fraction bits.
fn in_f64(threshold: u32) -> Method {
    Method {
        distance: Norm::Maximum,
        rays: Norm::Maximum,
        threshold: f64::from(threshold) / 4096.0 / UNITS,
        footprint: (-f64::from(DEFAULT_TUNING.footprint)).exp2(),
        cap: DEFAULT_TUNING.cap,
        growth: 1.0,
        correct: false,
    }
}

/// Rays by exits, and marching rays with the thresholds of each quality.
fn forms(views: &Views) -> Vec<Trial> {
    let mut exits = views.model("exits", "exits".into(), &FieldOptions::default());
    exits.shipped = true;
    let marching = Quality::ALL.map(|quality| {
        let Threshold { base, footprint } = quality.preset().faces;
        let options = tuned(Tuning {
            threshold: base,
            footprint,
            ..DEFAULT_TUNING
        });
        let mut trial = views.model("marching", quality.name().to_owned(), &options);
        trial.shipped = false;
        trial
    });
    let mut trials = vec![exits];
    trials.extend(marching);
    trials
}

fn fractions(views: &Views) -> Vec<Trial> {
    let trial = |family: &str, fraction, threshold| {
        let shipped = (fraction, threshold) == (MODEL_FRACTION, DEFAULT_TUNING.threshold);
        if shipped {
            let options = marching();
            return views.model(family, format!("{fraction} bits"), &options);
        }
        views.trial(family, format!("{fraction} bits"), 0, |subject| {
            FixedPoint::new(subject, fraction, threshold).picture()
        })
    };
    let same =
        (8..=16).map(|fraction| trial("the same threshold", fraction, DEFAULT_TUNING.threshold));
    let fitting = (8..=15).map(|fraction| {
        let threshold = (DEFAULT_TUNING.threshold << MODEL_FRACTION) >> fraction;
        let family = format!("a threshold of {} steps", DEFAULT_TUNING.threshold);
        trial(&family, fraction, threshold)
    });
    same.chain(fitting).collect()
}

fn caps(views: &Views) -> Vec<Trial> {
    let trials = [8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 255].map(|cap| {
        let options = tuned(Tuning {
            cap,
            ..DEFAULT_TUNING
        });
        views.model("cap", format!("{cap}"), &options)
    });
    trials.into()
}

fn thresholds(views: &Views) -> Vec<Trial> {
    let footprints = [10, 12, 13, 14, 15];
    let trials = footprints.into_iter().flat_map(|footprint| {
        [4, 6, 8, 16, DEFAULT_TUNING.threshold, 40, 80, 160, 320].map(|threshold| {
            let options = tuned(Tuning {
                threshold,
                footprint,
                ..DEFAULT_TUNING
            });
            views.model(
                &format!("t/2^{footprint}"),
                format!("{threshold}"),
                &options,
            )
        })
    });
    trials.collect()
}

/// Runs a family of trials, each with another threshold. `change` converts Glint's method in f64 to the family's method. `Views::variant`
/// explains `exact_entry`.
fn by_threshold(
    views: &Views,
    family: &str,
    exact_entry: bool,
    change: impl Fn(Method) -> Method,
) -> [Trial; 5] {
    [6, 12, 24, 48, 96].map(|threshold| {
        let method = change(in_f64(threshold));
        views.variant(family, format!("{threshold}"), &method, exact_entry)
    })
}

fn norms(views: &Views) -> Vec<Trial> {
    let families = [
        ("maximum norm, its rays", Norm::Maximum, Norm::Maximum),
        ("maximum norm, unit rays", Norm::Maximum, Norm::Euclidean),
        (
            "Euclidean norm, unit rays",
            Norm::Euclidean,
            Norm::Euclidean,
        ),
    ];
    let mut trials: Vec<_> = families
        .into_iter()
        .flat_map(|(family, distance, rays)| {
            by_threshold(views, family, false, |method| Method {
                distance,
                rays,
                ..method
            })
        })
        .collect();
    let config = format!("Glint, {}", DEFAULT_TUNING.threshold);
    trials.push(views.model("the model", config, &marching()));
    trials
}

fn ends(views: &Views) -> Vec<Trial> {
    let families = [
        ("plain", 1.0, false, false),
        ("corrected", 1.0, true, false),
        ("doubling", 2.0, false, false),
        ("doubling and corrected", 2.0, true, false),
        ("quadrupling", 4.0, false, false),
        ("exact entry", 1.0, false, true),
    ];
    let trials = families
        .into_iter()
        .flat_map(|(family, growth, correct, exact_entry)| {
            by_threshold(views, family, exact_entry, |method| Method {
                growth,
                correct,
                ..method
            })
        });
    trials.collect()
}

fn normals(views: &Views) -> Vec<Trial> {
    let options = marching();
    let mut trials = vec![views.model("the nearest face's", "active term".into(), &options)];
    for (family, taps) in [
        ("forward differences", Taps::Forward),
        ("tetrahedron", Taps::Tetrahedron),
    ] {
        for bits in 8..=12 {
            let step = (-f64::from(bits)).exp2() / UNITS;
            trials.push(
                views.trial(family, format!("2^-{bits}"), Taps::COUNT, |subject| {
                    let picture = subject.picture(&options);
                    picture
                        .into_iter()
                        .zip(pixels(subject))
                        .map(|(mut rendered, (_, _, ray))| {
                            if let RayOutcome::Hit { t, face, .. } = &mut rendered.outcome {
                                *face = taps.face(&subject.field, ray.at(*t), step);
                            }
                            rendered
                        })
                        .collect()
                }),
            );
        }
    }
    trials
}
