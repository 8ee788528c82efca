//! The page `raymarch.md`: how far the raymarcher's pictures are from exact hits, how many of them there are a second, and what
//! both depend on.

use std::cell::RefCell;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use glint_model::raymarch::{
    DEFAULT_TUNING, FieldOptions, FieldSetup, Prepass, ROUND_TUNING, Tuning,
};
use glint_reference::camera::{Ray, Size};
use glint_reference::field::Field;
use glint_reference::field::metrics::{Accuracy, Expected, Outcome};
use glint_reference::field::raymarched::{self, Marched, Measured, Subject};
use glint_reference::field::variant::{Method, Norm, Taps, entry};
use glint_reference::field::verilated::Raymarcher;
use indicatif::ProgressBar;
use serde::Serialize;

use crate::fixed_point::{FixedPoint, MODEL_FRACTION};
use crate::plot::{self, Diagram, Point};
use crate::table::{Provenance, write_csv};
use crate::{in_workspace, progress_bar, rates, soc};

#[derive(clap::Args)]
pub struct Arguments {
    /// Print the rows as JSON instead of a table
    #[arg(long)]
    json: bool,
    /// Only the errors of pictures of 320x180: neither frames a second nor diagrams (seconds instead of some minutes)
    #[arg(long)]
    quick: bool,
    /// Folder for raymarch.md and its tables and diagrams [default: docs/report, or target/report with --quick]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

const SMALL: (u32, u32) = (320, 180);
const LARGE: (u32, u32) = (1280, 720);

/// Least part of the masks in common, and what is aimed at.
const IOU: [f64; 2] = [0.999, 0.9999];
/// Most error of the depth in world units, half of the pixels.
const MEDIAN: [f64; 2] = [3e-4, 2e-4];
/// Likewise, 99 of 100.
const P99: [f64; 2] = [3e-3, 5e-4];
/// Most wrong faces, of all that both show.
const FACES: [f64; 2] = [0.01, 0.003];
/// Most angle between normals in degrees, of 99 of 100 pixels, of what is round.
const NORMALS: f64 = 0.3;
/// Most evaluations a ray at 320 × 180: 60 frames a second for two eyes, from two lanes at 81.25 MHz.
const SMALL_COST: [f64; 2] = [23.5, 11.7];
/// Likewise at 1280 × 720.
const LARGE_COST: [f64; 2] = [14.4, 11.5];

/// What a picture misses of what is asked or aimed at, cost apart.
fn missed(accuracy: &Accuracy, level: usize) -> Vec<&'static str> {
    let depth = accuracy.depth;
    let checks = [
        (accuracy.iou >= IOU[level], "IoU"),
        (depth.is_none_or(|d| d.median <= MEDIAN[level]), "median"),
        (depth.is_none_or(|d| d.p99 <= P99[level]), "p99"),
        (accuracy.wrong_faces <= FACES[level], "faces"),
        (accuracy.undecided == 0, "undecided"),
        (accuracy.normal.is_none_or(|d| d.p99 <= NORMALS), "normals"),
    ];
    let failed = checks.into_iter().filter(|(met, _)| !met);
    failed.map(|(_, name)| name).collect()
}

/// A picture: a line of `raymarch.csv`. Depths are in world units along n.
#[derive(Serialize)]
struct Row {
    scene: String,
    view: String,
    width: u32,
    height: u32,
    /// The side of the blocks of pixels that have a cone; 0: none.
    prepass: u32,
    iou: f64,
    false_hits: usize,
    false_misses: usize,
    undecided: usize,
    depth_median: Option<f64>,
    depth_p99: Option<f64>,
    depth_max: Option<f64>,
    code_median: Option<f64>,
    code_p99: Option<f64>,
    code_max: Option<f64>,
    wrong_faces: f64,
    /// In degrees, of what is round.
    normal_p99: Option<f64>,
    /// The part of the pixels beside an edge, where little decides.
    unstable: f64,
    /// By rays and cones.
    evaluations: f64,
    /// By the cones alone.
    evaluations_cones: f64,
    evaluations_max: u32,
    /// What is asked of the sponge and not met.
    missed: String,
    /// What is aimed at and not met.
    not_reached: String,
    commit: String,
}

impl Row {
    fn new(subject: &Subject, setup: &FieldSetup, measured: &Measured, commit: &str) -> Self {
        let &Measured {
            accuracy, coded, ..
        } = measured;
        let (width, height) = subject.size;
        let cost = if width == SMALL.0 {
            SMALL_COST
        } else {
            LARGE_COST
        };
        // Of the sponge and of what is round something is asked, of the sponge more is aimed at.
        let list = |level: usize| {
            let sponge = matches!(subject.field, Field::Menger { .. });
            let mut missed = if sponge || subject.parsed.is_round() && level == 0 {
                missed(&accuracy, level)
            } else {
                vec![]
            };
            if sponge && measured.cost() > cost[level] {
                missed.push("evaluations");
            }
            missed.join(" ")
        };
        Self {
            scene: subject.scene.clone(),
            view: subject.name.clone(),
            width,
            height,
            prepass: setup.cones.map_or(0, |cones| 1 << cones.block),
            iou: accuracy.iou,
            false_hits: accuracy.false_hit,
            false_misses: accuracy.false_miss,
            undecided: accuracy.undecided,
            depth_median: accuracy.depth.map(|depth| depth.median),
            depth_p99: accuracy.depth.map(|depth| depth.p99),
            depth_max: accuracy.depth.map(|depth| depth.max),
            code_median: coded.map(|depth| depth.median),
            code_p99: coded.map(|depth| depth.p99),
            code_max: coded.map(|depth| depth.max),
            wrong_faces: accuracy.wrong_faces,
            normal_p99: accuracy.normal.map(|normal| normal.p99),
            unstable: accuracy.unstable,
            evaluations: measured.cost(),
            evaluations_cones: measured.cones as f64 / accuracy.rays.max(1) as f64,
            evaluations_max: measured.most,
            missed: list(0),
            not_reached: list(1),
            commit: commit.to_owned(),
        }
    }
}

/// A configuration, over the sponge's four views at 320 × 180: a line of a diagram's CSV.
#[derive(Serialize)]
struct Trial {
    family: String,
    config: String,
    /// Whether Glint uses it.
    shipped: bool,
    iou: f64,
    undecided: usize,
    depth_median: Option<f64>,
    depth_p99: Option<f64>,
    depth_max: Option<f64>,
    wrong_faces: f64,
    evaluations: f64,
    /// Of the raymarcher's clock, a picture; nothing where only software draws so.
    cycles: Option<f64>,
    /// What is asked and not met.
    failed: String,
    commit: String,
}

impl Trial {
    /// Evaluations a clock and lane of the raymarcher, if it drew.
    fn rate(&self) -> Option<f64> {
        let rays = f64::from(SMALL.0 * SMALL.1);
        self.cycles
            .map(|cycles| self.evaluations * rays / cycles / f64::from(Raymarcher::LANES))
    }
}

/// A diagram with its table.
struct Study {
    name: &'static str,
    diagram: Diagram,
    /// What is varied, and what it shows.
    text: &'static str,
    error: fn(&Trial) -> f64,
    cost: fn(&Trial) -> Option<f64>,
    trials: Vec<Trial>,
}

/// The pictures that every trial draws.
struct Bench<'a> {
    subjects: &'a [Subject],
    expected: Vec<Expected>,
    raymarcher: RefCell<Raymarcher>,
    bar: ProgressBar,
    commit: &'a str,
}

impl<'a> Bench<'a> {
    fn new(subjects: &'a [Subject], bar: ProgressBar, commit: &'a str) -> Self {
        let expected = subjects.iter().flat_map(|subject| &subject.expected);
        Self {
            subjects,
            expected: expected.copied().collect(),
            raymarcher: RefCell::default(),
            bar,
            commit,
        }
    }

    /// Draws all views in one way. `added` are evaluations of a hit that the pictures do not count.
    fn trial(
        &self,
        family: &str,
        config: String,
        added: u32,
        draw: impl Fn(&Subject) -> Vec<Marched>,
    ) -> Trial {
        self.bar.set_message(format!("{family}, {config}"));
        let found: Vec<Marched> = self.subjects.iter().flat_map(draw).collect();
        let measured = Measured::new(&self.expected, &found);
        let accuracy = measured.accuracy;
        let hit = |ray: &&Marched| matches!(ray.outcome, Outcome::Hit { .. });
        let hits = found.iter().filter(hit).count();
        Trial {
            family: family.to_owned(),
            config,
            shipped: false,
            iou: accuracy.iou,
            undecided: accuracy.undecided,
            depth_median: accuracy.depth.map(|depth| depth.median),
            depth_p99: accuracy.depth.map(|depth| depth.p99),
            depth_max: accuracy.depth.map(|depth| depth.max),
            wrong_faces: accuracy.wrong_faces,
            evaluations: measured.cost() + (hits as f64 * f64::from(added)) / found.len() as f64,
            cycles: None,
            failed: missed(&accuracy, 0).join(" "),
            commit: self.commit.to_owned(),
        }
    }

    /// Draws them by the model, and by the raymarcher if it can.
    fn model(&self, family: &str, config: String, options: &FieldOptions) -> Trial {
        let mut trial = self.trial(family, config, 0, |subject| subject.picture(options));
        trial.shipped = *options == FieldOptions::default();
        let mut raymarcher = self.raymarcher.borrow_mut();
        let pictures = self.subjects.iter();
        let clocks: Option<u64> = pictures
            .map(|subject| {
                let setup = subject.setup(options);
                let built = setup.cones.is_none_or(|cones| cones.is_fitting(&setup));
                built.then(|| raymarcher.draw(&setup).clocks)
            })
            .sum();
        trial.cycles = clocks.map(|clocks| clocks as f64 / self.subjects.len() as f64);
        trial
    }

    /// Draws them in f64, from where the model's rays begin or exactly where they come to the cube around the sponge.
    fn variant(&self, family: &str, config: String, method: &Method, exact_entry: bool) -> Trial {
        self.trial(family, config, 0, |subject| {
            let Field::Menger { depth } = subject.field else {
                unreachable!("trials draw the sponge");
            };
            let setup = subject.setup(&FieldOptions::default());
            pixels(subject)
                .map(|(x, y, ray)| {
                    let begin = if exact_entry {
                        entry(&ray).max(subject.camera.near)
                    } else {
                        let ray = setup.ray(0, x, y);
                        raymarched::depth(&setup, &ray, ray.start)
                    };
                    method.march(depth, &ray, begin)
                })
                .collect()
        })
    }
}

/// A subject's pixels with their rays, row by row.
fn pixels(subject: &Subject) -> impl Iterator<Item = (u32, u32, Ray)> {
    let (width, height) = subject.size;
    let size = Size { width, height };
    let camera = subject.camera;
    (0..width * height).map(move |i| {
        let (x, y) = (i % width, i / width);
        (x, y, camera.ray([x, y].map(f64::from), size))
    })
}

fn tuned(tuning: Tuning) -> FieldOptions {
    FieldOptions {
        tuning,
        ..FieldOptions::default()
    }
}

/// The sponge's field units in a world unit.
const UNITS: f64 = 40.5;

/// Glint's march in f64, with another threshold.
fn in_f64(threshold: u32) -> Method {
    Method {
        distance: Norm::Maximum,
        rays: Norm::Maximum,
        threshold: f64::from(threshold) / 4096.0 / UNITS,
        footprint: (-f64::from(DEFAULT_TUNING.footprint)).exp2(),
        cap: DEFAULT_TUNING.cap,
        relax: None,
        correct: false,
    }
}

const DEPTH_P99: &str = "error of the depth that 1 of 100 exceeds, in world units";
const DEPTH_MEDIAN: &str = "error of the depth that 1 of 2 exceeds, in world units";
const EVALUATIONS: &str = "evaluations a ray";
const CYCLES: &str = "cycles a picture, two lanes";

fn evaluations(trial: &Trial) -> Option<f64> {
    Some(trial.evaluations)
}

fn p99(trial: &Trial) -> f64 {
    trial.depth_p99.unwrap_or(0.0)
}

fn fractions(bench: &Bench) -> Study {
    let trial = |family: &str, fraction, threshold| {
        let shipped = (fraction, threshold) == (MODEL_FRACTION, DEFAULT_TUNING.threshold);
        if shipped {
            let options = FieldOptions::default();
            return bench.model(family, format!("{fraction} bits"), &options);
        }
        bench.trial(family, format!("{fraction} bits"), 0, |subject| {
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
    Study {
        name: "fraction",
        diagram: Diagram {
            title: "Fraction bits of field units",
            across: DEPTH_MEDIAN,
            up: EVALUATIONS,
        },
        text: "Fraction bits of coordinates and distances, with the threshold as long as it is and with one of as many steps. \
               Directions keep their 17 bits. With the same threshold more than 12 bits change the median of the depth, by a few millionths, \
               and nothing else: what is wrong at edges is the threshold's doing, and a finer one costs evaluations whatever the bits.",
        error: |trial| trial.depth_median.unwrap_or(0.0),
        cost: evaluations,
        trials: same.chain(fitting).collect(),
    }
}

fn caps(bench: &Bench) -> Study {
    let trials = [8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 255].map(|cap| {
        let options = tuned(Tuning {
            cap,
            ..DEFAULT_TUNING
        });
        bench.model("cap", format!("{cap}"), &options)
    });
    Study {
        name: "cap",
        diagram: Diagram {
            title: "Evaluations after which a ray is given up",
            across: "part of the masks not in common",
            up: CYCLES,
        },
        text: "What is given up counts as no hit. The last rays to end run along faces: a smaller cap gives up more of them and saves \
               hardly any evaluations.",
        error: |trial| 1.0 - trial.iou,
        cost: |trial| trial.cycles,
        trials: trials.into(),
    }
}

fn thresholds(bench: &Bench) -> Study {
    let footprints = [10, 12, 13, 14, 15];
    let trials = footprints.into_iter().flat_map(|footprint| {
        [4, 8, 16, DEFAULT_TUNING.threshold, 40, 80, 160, 320].map(|threshold| {
            let options = tuned(Tuning {
                threshold,
                footprint,
                ..DEFAULT_TUNING
            });
            bench.model(
                &format!("t/2^{footprint}"),
                format!("{threshold}"),
                &options,
            )
        })
    });
    Study {
        name: "threshold",
        diagram: Diagram {
            title: "Thresholds at which a ray ends",
            across: DEPTH_P99,
            up: CYCLES,
        },
        text: "The threshold in steps of 2^−12 field units, and the part of the distance gone that is added to it.",
        error: p99,
        cost: |trial| trial.cycles,
        trials: trials.collect(),
    }
}

fn norms(bench: &Bench) -> Study {
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
            [6, 12, 24, 48, 96].map(|threshold| {
                let method = Method {
                    distance,
                    rays,
                    ..in_f64(threshold)
                };
                bench.variant(family, format!("{threshold}"), &method, false)
            })
        })
        .collect();
    let config = format!("Glint, {}", DEFAULT_TUNING.threshold);
    trials.push(bench.model("the model", config, &FieldOptions::default()));
    Study {
        name: "norm",
        diagram: Diagram {
            title: "Norms of distances and of rays",
            across: DEPTH_P99,
            up: EVALUATIONS,
        },
        text: "In f64 but for the model, by threshold, from where the model's rays begin: distances in the maximum norm with rays of \
               length 1 in the same norm, which is what Glint does, the same with rays of Euclidean length 1, and Euclidean \
               distances. Rays of Euclidean length 1 take a fifth more evaluations and are no better for it, and the model is \
               where its f64 twin is.",
        error: p99,
        cost: evaluations,
        trials,
    }
}

fn ends(bench: &Bench) -> Study {
    let families = [
        ("as it is", None, false, false),
        ("corrected", None, true, false),
        ("relaxed", Some(64), false, false),
        ("relaxed and corrected", Some(64), true, false),
        ("exact entry", None, false, true),
    ];
    let trials = families
        .into_iter()
        .flat_map(|(family, relax, correct, exact_entry)| {
            [6, 12, 24, 48, 96].map(|threshold| {
                let method = Method {
                    relax,
                    correct,
                    ..in_f64(threshold)
                };
                bench.variant(family, format!("{threshold}"), &method, exact_entry)
            })
        });
    Study {
        name: "end",
        diagram: Diagram {
            title: "Beginnings and ends of rays",
            across: DEPTH_P99,
            up: EVALUATIONS,
        },
        text: "In f64, by threshold, from where the model's rays begin; Glint ends its rays relaxed and corrected, and *as it is* is a march without either. *Corrected*: the last step is the distance over the \
               direction's part along the normal where the ray goes to the face, so that depths are right where faces are. \
               *Relaxed*: the threshold is twice as large after each 64 evaluations. *Exact entry*: rays begin where they come to the \
               cube around the sponge, and not before it by what ten bits of a reciprocal leave. Errors below 1e-6, which field units \
               do not resolve, are drawn as 1e-6.",
        error: |trial| p99(trial).max(1e-6),
        cost: evaluations,
        trials: trials.collect(),
    }
}

fn prepasses(bench: &Bench) -> Study {
    let families = [
        ("no prepass", None),
        ("blocks of 4", Some(Prepass::Blocks(2))),
        ("blocks of 8", Some(Prepass::Blocks(3))),
        ("blocks of 16", Some(Prepass::Blocks(4))),
    ];
    let trials = families.into_iter().flat_map(|(family, prepass)| {
        [7, 14, 28, 56, 112].map(|threshold| {
            let options = FieldOptions {
                prepass,
                ..tuned(Tuning {
                    threshold,
                    ..DEFAULT_TUNING
                })
            };
            bench.model(family, format!("{threshold}"), &options)
        })
    });
    Study {
        name: "prepass",
        diagram: Diagram {
            title: "Cones before the rays",
            across: "part of the faces that is wrong",
            up: CYCLES,
        },
        text: "By threshold, of rays and of the cones before them: without a prepass, and with a cone for each block of 4 pixels each way, \
               which is what the gateware has for pictures of this size. Cones of 8 and of 16 pixels, which only software has here, are \
               in the table: the smaller the blocks, the farther their cones come, and the fewer evaluations there are in all, though there are more cones.",
        error: |trial| trial.wrong_faces,
        cost: |trial| trial.cycles,
        trials: trials.collect(),
    }
}

fn normals(bench: &Bench) -> Study {
    let options = FieldOptions::default();
    let mut trials = vec![bench.model("the nearest face's", "active term".into(), &options)];
    for (family, taps) in [
        ("forward differences", Taps::Forward),
        ("tetrahedron", Taps::Tetrahedron),
    ] {
        for bits in 8..=12 {
            let step = (-f64::from(bits)).exp2() / UNITS;
            trials.push(
                bench.trial(family, format!("2^-{bits}"), Taps::COUNT, |subject| {
                    let picture = subject.picture(&options);
                    picture
                        .into_iter()
                        .zip(pixels(subject))
                        .map(|(mut marched, (_, _, ray))| {
                            if let Outcome::Hit { t, face, .. } = &mut marched.outcome {
                                *face = taps.face(&subject.field, ray.at(*t), step);
                            }
                            marched
                        })
                        .collect()
                }),
            );
        }
    }
    Study {
        name: "normal",
        diagram: Diagram {
            title: "Ways to the normal",
            across: "part of the faces that is wrong",
            up: EVALUATIONS,
        },
        text: "At the model's hits: the face that the last distance was to, which Glint takes and which costs nothing, or the \
               largest slope by distances in f64 a step beside the hit, in field units. The distance at the hit counts as one of the \
               four of forward differences. They put right less than a tenth of the wrong faces: the others are where the ray has ended in \
               the wrong place.",
        error: |trial| trial.wrong_faces,
        cost: evaluations,
        trials,
    }
}

pub fn report(arguments: &Arguments) -> Result<()> {
    let provenance = Provenance::find();
    let out = match &arguments.out {
        Some(out) => out.clone(),
        None => in_workspace(if arguments.quick {
            "target/report"
        } else {
            "docs/report"
        }),
    };
    std::fs::create_dir_all(&out)
        .with_context(|| format!("cannot make the folder {}", out.display()))?;
    let small = raymarched::sponges(SMALL);
    let mut rows: Vec<Row> = Vec::new();
    let mut add = |subjects: &[Subject], prepass| {
        rows.extend(subjects.iter().map(|subject| {
            let options = FieldOptions {
                prepass,
                ..FieldOptions::of(&subject.parsed)
            };
            let setup = subject.setup(&options);
            let measured = Measured::new(&subject.expected, &raymarched::picture(&setup, 0));
            Row::new(subject, &setup, &measured, &provenance.commit)
        }));
    };
    let others = raymarched::others(SMALL);
    let rounds = raymarched::rounds(SMALL);
    for prepass in [None, Some(Prepass::Fitting)] {
        add(&small, prepass);
        add(&others, prepass);
        add(&rounds, prepass);
    }
    if !arguments.quick {
        let large = raymarched::sponges(LARGE);
        add(&large, None);
        add(&large, Some(Prepass::Fitting));
    }
    if arguments.json {
        println!("{}", serde_json::to_string_pretty(&rows)?);
    } else {
        print!("{}", table(&rows)?);
    }
    // What takes long is written as soon as it is there.
    write_csv(&rows, &out.join("raymarch.csv"))?;
    let (mut rates, mut studies) = (vec![], vec![]);
    if !arguments.quick {
        rates = rates::measure(&provenance.commit)?;
        write_csv(&rates, &out.join("raymarch-rates.csv"))?;
        if !arguments.json {
            print!("\n{}", rates::table(&rates)?);
        }
        let all: [fn(&Bench) -> Study; 7] =
            [fractions, caps, thresholds, norms, ends, prepasses, normals];
        let bar = progress_bar(all.len() as u64)?;
        studies = soc::two_at_a_time(&all, |study| {
            let studied = study(&Bench::new(&small, bar.clone(), &provenance.commit));
            write(&studied, &out)?;
            bar.inc(1);
            Ok(studied)
        })?;
        bar.finish_and_clear();
    }
    let page = page(&rows, &rates, &studies, &provenance)?;
    std::fs::write(out.join("raymarch.md"), page)
        .with_context(|| format!("cannot write raymarch.md to {}", out.display()))?;
    eprintln!("wrote raymarch.md and its tables to {}", out.display());
    Ok(())
}

/// Writes the table and the diagram of a study.
fn write(study: &Study, out: &Path) -> Result<()> {
    let points: Vec<Point> = study
        .trials
        .iter()
        .map(|trial| Point {
            family: trial.family.clone(),
            label: trial.config.clone(),
            error: (study.error)(trial),
            cost: (study.cost)(trial),
            shipped: trial.shipped,
        })
        .collect();
    let file = |extension: &str| out.join(format!("raymarch-{}.{extension}", study.name));
    write_csv(&study.trials, &file("csv"))?;
    plot::write(&study.diagram, &points, &file("svg"))
}

/// An error as tables show it.
fn shown(error: Option<f64>) -> String {
    error.map_or("none".to_owned(), |error| format!("{error:.1e}"))
}

fn table(rows: &[Row]) -> Result<String> {
    let mut text = String::from(
        "| field | view | size | prepass | IoU | false hits, misses | undecided | depth: median, p99, max | by code | wrong faces | normals, p99 | evaluations a ray: mean, of that cones, max of a ray | asked and missed | aimed at and not reached |\n\
         |---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
    );
    for row in rows {
        writeln!(
            text,
            "| {} | {} | {}×{} | {} | {:.6} | {}, {} | {} | {}, {}, {} | {}, {}, {} | {:.2} % | {} | {:.2}, {:.2}, {} | {} | {} |",
            row.scene,
            row.view,
            row.width,
            row.height,
            match row.prepass {
                0 => String::new(),
                side => format!("{side}×{side}"),
            },
            row.iou,
            row.false_hits,
            row.false_misses,
            row.undecided,
            shown(row.depth_median),
            shown(row.depth_p99),
            shown(row.depth_max),
            shown(row.code_median),
            shown(row.code_p99),
            shown(row.code_max),
            100.0 * row.wrong_faces,
            row.normal_p99
                .map_or(String::new(), |angle| format!("{angle:.2}°")),
            row.evaluations,
            row.evaluations_cones,
            row.evaluations_max,
            row.missed,
            row.not_reached,
        )?;
    }
    Ok(text)
}

fn page(
    rows: &[Row],
    rates: &[rates::Row],
    studies: &[Study],
    provenance: &Provenance,
) -> Result<String> {
    let Tuning {
        threshold,
        footprint,
        cap,
        ..
    } = DEFAULT_TUNING;
    let mut text = format!(
        "# Distance fields: error against evaluations\n\n\
         Generated by `cargo xtask report raymarch`; the same numbers are in [raymarch.csv](raymarch.csv).\n\n\
         Pictures of the model, which the gateware equals bit for bit, against exact hits of the same pixels' rays in f64. A ray \
         ends where the distance is below {threshold}·2^−12 field units and 2^−{footprint} of the way gone, or after {cap} evaluations of the field; \
         where anything is round, below {}·2^−12 and 2^−{} of the way, or after {} evaluations. \
         IoU is the part of the pixels where both hit among those where either does, and what is undecided is no hit; depths are \
         in world units along the direction of view, from t and from the 18-bit code; a face is wrong where both hit and the \
         normals differ. All pixels count, those along edges too. The views of the sponge are outside of it, close to a face, in the \
         largest tunnel, and grazing a face. With a prepass a cone of a block of so many pixels comes before its rays.\n\n\
         Of the sponge it is asked (aimed at): IoU {} ({}), depth median {:.0e} ({:.0e}), p99 {:.0e} ({:.0e}), wrong faces {} % ({} %), \
         nothing undecided, evaluations a ray {} ({}) at 320×180 and {} ({}) at 1280×720. Of what is round the same is asked but for evaluations, and \
         normals within {NORMALS}°, p99; a lattice goes on to the horizon, where its spheres are smaller than a pixel.\n\n",
        ROUND_TUNING.threshold,
        ROUND_TUNING.footprint,
        4 * ROUND_TUNING.cap,
        IOU[0],
        IOU[1],
        MEDIAN[0],
        MEDIAN[1],
        P99[0],
        P99[1],
        100.0 * FACES[0],
        100.0 * FACES[1],
        SMALL_COST[0],
        SMALL_COST[1],
        LARGE_COST[0],
        LARGE_COST[1],
    );
    text.push_str(&table(rows)?);
    text.push_str(
        "\nLarge errors of the depth are at edges, where a ray ends although it would pass: all false hits and most wrong faces are of \
         this kind. Smaller ones are on faces that a ray meets flat, where it ends the threshold before them. Undecided are rays that run along a face, whose steps are as short as the face is near: few where the sponge is \
         looked at, many towards the horizon of fields without end.\n",
    );
    if !rates.is_empty() {
        writeln!(
            text,
            "\n## Frames a second\n\n\
             The whole SoC by its counters, with LiteDRAM and the scan-out at work, at the very setting of the errors above and in the same \
             views; each picture was compared with the model's, bit for bit. A frame *alone* counts everything from the first register that the \
             firmware writes to the end that it sees, *back to back* means frames that follow each other without a wait for the screen, as which the \
             slowest pose of each view was drawn: frames a second, and evaluations, are of these. With two eyes (0.03 beside the camera, which see \
             the same at 1.5) the camera turns about its place as a head that looks around, in the poses of \
             [look-around.csv](../../tools/reference/src/field/look-around.csv), which were written by hand. Two lanes are the default gateware, four that \
             of `cargo xtask gateware --fields sponge`. What was asked and is not met is bold. All poses are in [raymarch-rates.csv](raymarch-rates.csv).\n\n{}\n\
             Evaluations a clock and lane are over whole frames, with their beginnings and ends and what the program does between them. There is one ray a \
             clock, so lanes wait where rays take fewer evaluations than there are lanes.",
            rates::table(rates)?
        )?;
    }
    if !studies.is_empty() {
        let trials = studies.iter().flat_map(|study| &study.trials);
        let rates: Vec<f64> = trials.filter_map(Trial::rate).collect();
        writeln!(
            text,
            "\n## What it depends on\n\n\
             Each configuration draws the sponge in the four views at 320×180, of which the figures are taken together. What Glint uses \
             is ringed. Cycles are those of a picture, the mean of the four, on the verilated raymarcher alone, with {} lanes; \
             its pixels were compared with the model's, bit for bit, and the errors are those of the same pictures. What only software \
             draws so has evaluations and no cycles: in the {} configurations that the raymarcher drew it made {:.2} to {:.2} \
             evaluations a clock and lane.",
            Raymarcher::LANES,
            rates.len(),
            rates.iter().copied().fold(f64::INFINITY, f64::min),
            rates.iter().copied().fold(0.0, f64::max),
        )?;
    }
    for study in studies {
        writeln!(
            text,
            "\n### {}\n\n![{}](raymarch-{}.svg)\n\n{} All of it is in [raymarch-{}.csv](raymarch-{}.csv).\n",
            study.diagram.title,
            study.diagram.title,
            study.name,
            study.text,
            study.name,
            study.name,
        )?;
        text.push_str(&failures(study)?);
    }
    writeln!(
        text,
        "\nMade at commit {} with {}.",
        provenance.commit, provenance.tools
    )?;
    Ok(text)
}

/// The configurations that do not give what is asked, with the reasons.
fn failures(study: &Study) -> Result<String> {
    let failed: Vec<&Trial> = study
        .trials
        .iter()
        .filter(|trial| !trial.failed.is_empty())
        .collect();
    if failed.is_empty() {
        return Ok("No configuration misses what is asked.\n".to_owned());
    }
    let mut text = String::from(
        "Those that miss something that is asked:\n\n\
         | | | IoU | undecided | depth: median, p99 | wrong faces | evaluations a ray | cycles | missed |\n|---|---|---|---|---|---|---|---|---|\n",
    );
    for trial in failed {
        writeln!(
            text,
            "| {} | {} | {:.6} | {} | {}, {} | {:.2} % | {:.2} | {} | {} |",
            trial.family,
            trial.config,
            trial.iou,
            trial.undecided,
            shown(trial.depth_median),
            shown(trial.depth_p99),
            100.0 * trial.wrong_faces,
            trial.evaluations,
            trial
                .cycles
                .map_or(String::new(), |cycles| format!("{cycles:.0}")),
            trial.failed,
        )?;
    }
    Ok(text)
}
