//! Diagrams of the report, as SVG files. In a work-precision diagram the error is on the horizontal axis and the cost on the
//! vertical axis. An axis is logarithmic unless its values stay within a decade.

use std::path::Path;

use anyhow::{Result, anyhow};
use plotters::coord::ranged1d::ValueFormatter;
use plotters::prelude::*;

const SIZE: (u32, u32) = (960, 600);
/// Range of the cost axis if no point has a cost.
const EMPTY: Span = Span(10.0, 100_000.0);

/// Colours of the families of points. All are dark enough for thin text.
const COLOURS: [RGBColor; 8] = [
    RGBColor(176, 24, 48),
    RGBColor(24, 120, 48),
    RGBColor(24, 88, 168),
    RGBColor(160, 88, 0),
    RGBColor(112, 32, 144),
    RGBColor(72, 72, 72),
    RGBColor(0, 128, 136),
    RGBColor(136, 104, 56),
];

/// Title and axis labels of a diagram.
pub struct Diagram {
    /// Title above the diagram.
    pub title: &'static str,
    /// Label of the horizontal axis, which shows an error.
    pub across: &'static str,
    /// Label of the vertical axis, which shows a cost.
    pub up: &'static str,
}

/// A point of the diagram: a configuration with its error and cost.
pub struct Point {
    /// Name of the family. A line joins the points of a family.
    pub family: String,
    /// Text beside the point.
    pub label: String,
    /// Position on the horizontal axis: the error of the configuration.
    pub error: f64,
    /// Position on the vertical axis: the cost. A point without a cost is drawn as a vertical dashed line at its error.
    pub cost: Option<f64>,
    /// Whether Glint uses the configuration. A point of such a configuration is marked by a ring.
    pub shipped: bool,
}

/// Writes a work-precision diagram with one line for each family of points.
///
/// # Errors
/// When the file cannot be written.
pub fn write(diagram: &Diagram, points: &[Point], path: &Path) -> Result<()> {
    draw(diagram, points, path).map_err(|error| anyhow!("cannot draw {}: {error}", path.display()))
}

fn draw(
    diagram: &Diagram,
    points: &[Point],
    path: &Path,
) -> Result<(), Box<dyn std::error::Error>> {
    let errors = Span::new(points.iter().map(|point| point.error)).unwrap_or(Span(1e-10, 1.0));
    let costs = Span::new(points.iter().filter_map(|point| point.cost)).unwrap_or(EMPTY);
    let (Span(left, right), Span(bottom, top)) = (errors, costs);
    let legend = legend(points, errors, costs);

    let root = SVGBackend::new(path, SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&root);
    chart
        .caption(diagram.title, ("sans-serif", 22))
        .margin(16)
        .x_label_area_size(44)
        .y_label_area_size(70);
    let (across, up) = (left..right, bottom..top);
    match (errors.is_narrow(), costs.is_narrow()) {
        (false, false) => {
            let chart = chart.build_cartesian_2d(across.log_scale(), up.log_scale())?;
            fill(chart, diagram, points, (costs, legend))?;
        }
        (false, true) => {
            let chart = chart.build_cartesian_2d(across.log_scale(), up)?;
            fill(chart, diagram, points, (costs, legend))?;
        }
        (true, false) => {
            let chart = chart.build_cartesian_2d(across, up.log_scale())?;
            fill(chart, diagram, points, (costs, legend))?;
        }
        (true, true) => {
            let chart = chart.build_cartesian_2d(across, up)?;
            fill(chart, diagram, points, (costs, legend))?;
        }
    }
    root.present()?;
    Ok(())
}

/// The area between two lines of a diagram.
pub struct Band {
    /// Name of the band in the legend.
    pub name: &'static str,
    /// Points of the lower edge.
    pub low: Vec<(f64, f64)>,
    /// Points of the upper edge.
    pub high: Vec<(f64, f64)>,
}

/// A line of a diagram: its name in the legend and its points.
pub type Line = (&'static str, Vec<(f64, f64)>);

/// Writes a diagram with lines in front of a band. The two axes are logarithmic.
///
/// # Errors
/// When there are no points or the file cannot be written.
pub fn write_lines(diagram: &Diagram, lines: &[Line], band: &Band, path: &Path) -> Result<()> {
    draw_lines(diagram, lines, band, path)
        .map_err(|error| anyhow!("cannot draw {}: {error}", path.display()))
}

fn draw_lines(
    diagram: &Diagram,
    lines: &[Line],
    band: &Band,
    path: &Path,
) -> Result<(), Box<dyn std::error::Error>> {
    let points = || lines.iter().flat_map(|(_, line)| line).chain(&band.high);
    let across = Span::new(points().map(|point| point.0));
    let up = Span::new(points().map(|point| point.1));
    let (Some(Span(left, right)), Some(Span(bottom, top))) = (across, up) else {
        return Err("no points".into());
    };
    let root = SVGBackend::new(path, SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&root)
        .caption(diagram.title, ("sans-serif", 22))
        .margin(16)
        .x_label_area_size(44)
        .y_label_area_size(70)
        .build_cartesian_2d((left..right).log_scale(), (bottom..top).log_scale())?;
    chart
        .configure_mesh()
        .x_desc(diagram.across)
        .y_desc(diagram.up)
        .y_label_formatter(&number)
        .light_line_style(BLACK.mix(0.04))
        .draw()?;
    let grey = BLACK.mix(0.15);
    let outline = band.low.iter().chain(band.high.iter().rev());
    chart
        .draw_series([Polygon::new(
            outline.copied().collect::<Vec<_>>(),
            grey.filled(),
        )])?
        .label(band.name)
        .legend(move |(x, y)| Rectangle::new([(x, y - 5), (x + 18, y + 5)], grey.filled()));
    for ((name, line), colour) in lines.iter().zip(COLOURS) {
        chart
            .draw_series(LineSeries::new(
                line.iter().copied(),
                colour.stroke_width(2),
            ))?
            .label(*name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], colour.stroke_width(2)));
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperLeft)
        .background_style(WHITE.mix(0.8))
        .border_style(BLACK.mix(0.3))
        .draw()?;
    root.present()?;
    Ok(())
}

/// A part of a track, with its ends on the horizontal axis.
pub struct Part {
    /// Name in the legend. Parts of the same name have the same colour.
    pub name: &'static str,
    /// Where it begins.
    pub from: f64,
    /// Where it ends.
    pub to: f64,
}

/// Two opposite corners of a rectangle.
type Corners = [(f64, f64); 2];

/// A group of tracks, one below the other, with a label at its side.
pub struct Bar {
    /// Text beside the tracks.
    pub label: String,
    /// Parts of each track.
    pub tracks: Vec<Vec<Part>>,
}

/// Writes a diagram of horizontal bars, the first at the top, over an axis from 0 to 100.
///
/// # Errors
/// When the file cannot be written.
pub fn write_bars(title: &str, across: &str, bars: &[Bar], path: &Path) -> Result<()> {
    draw_bars(title, across, bars, path)
        .map_err(|error| anyhow!("cannot draw {}: {error}", path.display()))
}

fn draw_bars(
    title: &str,
    across: &str,
    bars: &[Bar],
    path: &Path,
) -> Result<(), Box<dyn std::error::Error>> {
    let root = SVGBackend::new(path, SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    let count = bars.len() as f64;
    let mut chart = ChartBuilder::on(&root)
        .caption(title, ("sans-serif", 22))
        .margin(16)
        .margin_right(30)
        .x_label_area_size(44)
        .y_label_area_size(200)
        // Room for the legend is below the bars.
        .build_cartesian_2d(0.0..100.0, count + 2.0..0.0)?;
    chart
        .configure_mesh()
        .disable_y_mesh()
        .y_labels(0)
        .x_desc(across)
        .x_label_formatter(&|place| format!("{place:.0}"))
        .light_line_style(BLACK.mix(0.04))
        .draw()?;
    let mut shapes: Vec<(&str, Vec<Corners>)> = Vec::new();
    for (bar, top) in bars.iter().zip(0..) {
        let height = 0.8 / bar.tracks.len() as f64;
        for (track, number) in bar.tracks.iter().zip(0..) {
            let above = f64::from(top) + 0.1 + f64::from(number) * height;
            for part in track {
                let shape = [(part.from, above), (part.to, above + height)];
                match shapes.iter_mut().find(|(name, _)| *name == part.name) {
                    Some((_, shapes)) => shapes.push(shape),
                    None => shapes.push((part.name, vec![shape])),
                }
            }
        }
        let place = EmptyElement::at((0.0, f64::from(top) + 0.5));
        let text = Text::new(bar.label.clone(), (-200, -7), ("sans-serif", 13));
        chart.plotting_area().draw(&(place + text))?;
    }
    for ((name, shapes), colour) in shapes.into_iter().zip(COLOURS) {
        let shapes = shapes.into_iter();
        chart
            .draw_series(shapes.map(|shape| Rectangle::new(shape, colour.filled())))?
            .label(name)
            .legend(move |(x, y)| Rectangle::new([(x, y - 5), (x + 18, y + 5)], colour.filled()));
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::LowerRight)
        .background_style(WHITE.mix(0.9))
        .border_style(BLACK.mix(0.3))
        .draw()?;
    root.present()?;
    Ok(())
}

/// Draws the axes, the points and the legend of a chart.
fn fill<'a, X, Y>(
    mut chart: ChartContext<'a, SVGBackend<'a>, Cartesian2d<X, Y>>,
    diagram: &Diagram,
    points: &[Point],
    (costs, legend): (Span, SeriesLabelPosition),
) -> Result<(), Box<dyn std::error::Error>>
where
    X: Ranged<ValueType = f64> + ValueFormatter<f64>,
    Y: Ranged<ValueType = f64> + ValueFormatter<f64>,
{
    chart
        .configure_mesh()
        .x_desc(diagram.across)
        .y_desc(diagram.up)
        .x_label_formatter(&number)
        .y_label_formatter(&|cost| format!("{}", (cost * 1e6).round() / 1e6))
        .light_line_style(BLACK.mix(0.04))
        .draw()?;

    for (family, colour) in families(points).into_iter().zip(COLOURS.iter().cycle()) {
        let mut measured: Vec<&Point> = points
            .iter()
            .filter(|point| point.family == family && point.cost.is_some())
            .collect();
        measured.sort_by(|a, b| a.error.total_cmp(&b.error));
        let at = |point: &Point| point.cost.map(|cost| (point.error, cost));
        chart
            .draw_series(LineSeries::new(
                measured.iter().filter_map(|point| at(point)),
                colour.stroke_width(2),
            ))?
            .label(family)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], colour.stroke_width(2)));
        for point in points.iter().filter(|point| point.family == family) {
            let Some(place) = at(point) else {
                let dashes = [(point.error, costs.0), (point.error, costs.1)];
                chart.draw_series(DashedLineSeries::new(dashes, 3, 5, colour.stroke_width(1)))?;
                let text = Text::new(
                    format!("{} (not measured)", point.label),
                    (point.error, costs.1),
                    ("sans-serif", 11)
                        .into_font()
                        .transform(FontTransform::Rotate90)
                        .color(&colour),
                );
                chart.draw_series([text])?;
                continue;
            };
            chart.draw_series([Circle::new(place, 4, colour.filled())])?;
            if point.shipped {
                chart.draw_series([Circle::new(place, 9, BLACK.stroke_width(2))])?;
            }
            let name = EmptyElement::at(place)
                + Text::new(point.label.clone(), (12, -6), ("sans-serif", 13));
            chart.draw_series([name])?;
        }
    }
    chart
        .configure_series_labels()
        .position(legend)
        .background_style(WHITE.mix(0.8))
        .border_style(BLACK.mix(0.3))
        .draw()?;
    Ok(())
}

/// Formats a number in scientific notation: with one digit if that is exact, otherwise with three digits.
fn number(error: &f64) -> String {
    let short = format!("{error:.0e}");
    if short
        .parse()
        .is_ok_and(|near: f64| (near - error).abs() < 1e-6 * error)
    {
        short
    } else {
        format!("{error:.2e}")
    }
}

/// Chooses the corner of the legend: the lower left one, or the upper right one if fewer points are in that quarter.
fn legend(points: &[Point], errors: Span, costs: Span) -> SeriesLabelPosition {
    let places = points
        .iter()
        .filter_map(|point| Some((errors.part(point.error), costs.part(point.cost?))));
    let (mut lower_left, mut upper_right) = (0, 0);
    for (across, up) in places {
        lower_left += u32::from(across < 0.5 && up < 0.5);
        upper_right += u32::from(across > 0.5 && up > 0.5);
    }
    match upper_right < lower_left {
        true => SeriesLabelPosition::UpperRight,
        false => SeriesLabelPosition::LowerLeft,
    }
}

fn families(points: &[Point]) -> Vec<&str> {
    let mut found = Vec::new();
    for point in points {
        if !found.contains(&point.family.as_str()) {
            found.push(point.family.as_str());
        }
    }
    found
}

/// Range of an axis: its lowest and its highest value.
#[derive(Clone, Copy)]
struct Span(f64, f64);

impl Span {
    /// Computes the range of an axis for positive values, with a margin for labels; `None` if there are no values. The range
    /// extends to whole decades, unless all values are within one decade.
    fn new(values: impl Iterator<Item = f64>) -> Option<Self> {
        let range = values.fold(None, |range: Option<(f64, f64)>, value| match range {
            None => Some((value, value)),
            Some((low, high)) => Some((low.min(value), high.max(value))),
        })?;
        if range.1 < 10.0 * range.0 {
            let room = 0.1 * (range.1 - range.0).max(0.1 * range.1);
            return Some(Self(range.0 - room, range.1 + room));
        }
        Some(Self(
            10f64.powf((range.0 / 1.5).log10().floor()),
            10f64.powf((range.1 * 1.5).log10().ceil()),
        ))
    }

    /// Returns the position of a value on the axis, from 0 to 1.
    fn part(self, value: f64) -> f64 {
        let place = |value: f64| {
            if self.is_narrow() {
                value
            } else {
                value.log10()
            }
        };
        (place(value) - place(self.0)) / (place(self.1) - place(self.0))
    }

    /// Whether the range is less than a decade, so that a logarithmic axis would have no numbers.
    fn is_narrow(self) -> bool {
        self.1 < 10.0 * self.0
    }
}
