//! Forms of smooth shading with the rate of their pixels: errors, clocks and FPGA resources in the tables of the report.

use crate::report::experiments::gouraud::engines::{Cost, GROUP, PIXEL, PLANES, TODAY};
use crate::report::experiments::gouraud::{clocks, forms};
use crate::report::plot::Point;
use crate::report::table::bold;

/// The scene whose clocks the diagram shows.
pub const CLOCKS_SCENE: &str = "icosphere:6 from 2";

/// Form, rate and label in the diagrams of each variant, and the function that returns its resources.
type Described = (
    &'static str,
    &'static str,
    &'static str,
    Option<fn(&Engines) -> Resources>,
);

const VARIANTS: [Described; 12] = [
    (
        forms::AFFINE,
        clocks::GROUPS,
        "affine",
        Some(|engines| engines.group(0)),
    ),
    (
        "first and last lane",
        clocks::GROUPS,
        "lanes",
        Some(|engines| engines.group(2)),
    ),
    (
        "first and last covered pixel",
        clocks::GROUPS,
        "covered",
        Some(|engines| engines.group(2)),
    ),
    (
        "first and last covered pixel",
        clocks::ENDS,
        "covered",
        Some(|engines| engines.group(1)),
    ),
    (
        forms::SHIPPED,
        clocks::GROUPS,
        "1024",
        Some(|engines| engines.group(8)),
    ),
    (
        forms::SHIPPED,
        clocks::PAIRS,
        "1024",
        Some(|engines| engines.pairs()),
    ),
    ("16 entries of 11 bits", clocks::SHIPPED, "16", None),
    ("64 entries of 13 bits", clocks::SHIPPED, "64", None),
    ("256 entries of 15 bits", clocks::SHIPPED, "256", None),
    (
        forms::SHIPPED,
        clocks::SHIPPED,
        "1024",
        Some(|engines| engines.today()),
    ),
    ("4096 entries of 19 bits", clocks::SHIPPED, "4096", None),
    (
        "64 entries and a Newton step",
        clocks::SHIPPED,
        "Newton",
        None,
    ),
];

/// LUTs and DSP48 slices that smooth shading adds to an engine with flat shading.
#[derive(Clone, Copy)]
pub struct Resources {
    lut: f64,
    dsp: f64,
    /// Whether an engine of this form was measured.
    measured: bool,
}

/// A form of smooth shading with the rate of its pixels.
pub struct Variant<'a> {
    rate: &'static str,
    label: &'static str,
    /// Resources, if they are known.
    pub resources: Option<Resources>,
    /// Errors in all scenes.
    errors: Vec<&'a forms::Row>,
    /// Clocks of the pictures.
    clocks: Vec<&'a clocks::Row>,
}

/// Combines the variants' rows of the tables.
pub fn read<'a>(
    forms: &'a [forms::Row],
    clocks: &'a [clocks::Row],
    costs: &[Cost],
) -> Vec<Variant<'a>> {
    let engines = Engines(costs);
    let is_measured = |computed: &clocks::Row| {
        let mut measured = clocks.iter().filter(|row| row.measured);
        measured.any(|row| (&row.rate, &row.scene) == (&computed.rate, &computed.scene))
    };
    let variants = VARIANTS
        .iter()
        .map(|&(form, rate, label, resources)| Variant {
            rate,
            label,
            resources: resources
                .filter(|_| !costs.is_empty())
                .map(|of| of(&engines)),
            errors: forms.iter().filter(|row| row.form == form).collect(),
            clocks: clocks
                .iter()
                .filter(|row| row.rate == rate && (row.measured || !is_measured(row)))
                .collect(),
        });
    variants.collect()
}

impl Variant<'_> {
    /// Whether Glint uses the variant.
    fn is_shipped(&self) -> bool {
        self.rate == clocks::SHIPPED && self.errors.iter().all(|row| row.shipped)
    }

    /// Returns the clocks for a pixel of a scene; measured ones if there are any.
    pub fn clocks(&self, scene: &str) -> Option<f64> {
        let row = self.clocks.iter().find(|row| row.scene == scene)?;
        Some(row.clocks as f64 / row.pixels as f64)
    }

    /// Returns the number of LUTs.
    pub fn luts(&self) -> Option<f64> {
        self.resources.map(|resources| resources.lut)
    }

    /// Returns the largest error in all scenes.
    pub fn largest_error(&self) -> f64 {
        self.errors
            .iter()
            .map(|row| row.max_err)
            .fold(0.0, f64::max)
    }

    /// Returns the point of a diagram with this cost. Its error is the RMS in the worst scene.
    pub fn point(&self, cost: Option<f64>) -> Point {
        let errors = self.errors.iter().map(|row| row.rms);
        let family = self.errors.first().map_or("", |row| &row.family);
        Point {
            family: format!("{family}, {}", self.rate),
            label: self.label.to_owned(),
            error: errors.fold(0.0, f64::max),
            cost,
            shipped: self.is_shipped(),
        }
    }

    /// Returns the cells of the variant's line in the table.
    pub fn cells(&self) -> [String; 8] {
        let name = self
            .errors
            .first()
            .map_or_else(String::new, |row| format!("{}: {}", row.family, row.form));
        let of = |stiff| self.errors.iter().filter(move |row| row.stiff == stiff);
        let pair = |value: &dyn Fn(bool) -> String| [false, true].map(value).join(", ");
        let largest = |stiff| {
            let errors = of(stiff).map(|row| row.max_err);
            format!("{:.3}", errors.fold(0.0, f64::max))
        };
        let steps = |stiff| {
            of(stiff)
                .map(|row| row.steps)
                .max()
                .unwrap_or(0)
                .to_string()
        };
        let differing = |stiff| {
            let pixels: f64 = of(stiff).map(|row| row.pixels as f64).sum();
            let off: f64 = of(stiff).map(|row| row.differing * row.pixels as f64).sum();
            format!("{:.2} %", 100.0 * off / pixels)
        };
        let clocks = self.clocks.iter().map(|row| {
            let clocks = format!("{:.2}", row.clocks as f64 / row.pixels as f64);
            italic(clocks, !row.measured)
        });
        let number = |value: fn(&Resources) -> f64| {
            self.resources.map_or_else(String::new, |resources| {
                italic(format!("{:.0}", value(&resources)), !resources.measured)
            })
        };
        [
            bold(name, self.is_shipped()),
            self.rate.to_owned(),
            pair(&largest),
            pair(&steps),
            pair(&differing),
            clocks.collect::<Vec<_>>().join(", "),
            number(|resources| resources.lut),
            number(|resources| resources.dsp),
        ]
    }
}

/// Formats `text` as Markdown, in italics if `italic` is set.
pub fn italic(text: impl std::fmt::Display, italic: bool) -> String {
    let mark = if italic { "*" } else { "" };
    format!("{mark}{text}{mark}")
}

/// The resources of all measured engines.
struct Engines<'a>(&'a [Cost]);

impl Engines<'_> {
    /// Returns what smooth shading adds to an engine.
    fn added(&self, engine: &str) -> Resources {
        let sum = |value: fn(&Cost) -> u32| -> f64 {
            let costs = self.0.iter().filter(|cost| cost.engine == engine);
            let signed = costs.map(|cost| match cost.shading.as_str() {
                "flat" => -f64::from(value(cost)),
                _ => f64::from(value(cost)),
            });
            signed.sum()
        };
        Resources {
            lut: sum(|cost| cost.lut),
            dsp: sum(|cost| cost.dsp),
            measured: true,
        }
    }

    /// Returns the resources of the divisions of an engine.
    fn divisions(&self, engine: &str) -> Resources {
        let mut costs = self.0.iter().filter(|cost| cost.engine == engine);
        let cost = costs.find(|cost| cost.division_dsp != 0);
        Resources {
            lut: cost.map_or(0.0, |cost| cost.division_lut.into()),
            dsp: cost.map_or(0.0, |cost| cost.division_dsp.into()),
            measured: true,
        }
    }

    fn today(&self) -> Resources {
        self.added(TODAY)
    }

    /// The engine that shades a group in a clock, with `divisions` of its eight, and with the planes of the channels one after the
    /// other.
    fn group(&self, divisions: u32) -> Resources {
        let all = self.divisions(GROUP);
        let left = f64::from(8 - divisions) / 8.0;
        let sum = |value: fn(&Resources) -> f64| {
            let [group, pixel, planes] =
                [GROUP, PIXEL, PLANES].map(|name| value(&self.added(name)));
            group - (pixel - planes) - left * value(&all)
        };
        Resources {
            lut: sum(|resources| resources.lut),
            dsp: sum(|resources| resources.dsp),
            measured: false,
        }
    }

    /// Today's engine with its divisions twice.
    fn pairs(&self) -> Resources {
        let (today, again) = (self.today(), self.divisions(TODAY));
        Resources {
            lut: today.lut + again.lut,
            dsp: today.dsp + again.dsp,
            measured: false,
        }
    }
}
