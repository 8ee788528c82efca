//! The work-precision diagram `sine.svg`.

use std::path::Path;

use anyhow::{Result, anyhow};
use plotters::prelude::*;

use crate::table::Row;

const SIZE: (u32, u32) = (960, 600);
/// The range of cycles where nothing was measured.
const EMPTY: (f64, f64) = (10.0, 100_000.0);

/// Colours of the families, dark enough for thin text.
const COLOURS: [RGBColor; 6] = [
    RGBColor(176, 24, 48),
    RGBColor(24, 120, 48),
    RGBColor(24, 88, 168),
    RGBColor(160, 88, 0),
    RGBColor(112, 32, 144),
    RGBColor(72, 72, 72),
];

/// Writes the diagram: largest error across, median cycles up, one line a family, what Glint uses ringed. A kernel without
/// cycles is a dashed line at its error.
pub fn write(rows: &[Row], path: &Path) -> Result<()> {
    draw(rows, path).map_err(|error| anyhow!("cannot draw {}: {error}", path.display()))
}

/// A point of the diagram.
struct Point<'a> {
    row: &'a Row,
    error: f64,
    cycles: Option<f64>,
}

fn draw(rows: &[Row], path: &Path) -> Result<(), Box<dyn std::error::Error>> {
    // One point a kernel: over the more inputs, where there are two rows.
    let mut points: Vec<Point> = Vec::new();
    for row in rows {
        points.retain(|point| point.row.kernel != row.kernel);
        points.push(Point {
            row,
            error: row.max_err,
            cycles: row.cycles_median.map(|cycles| cycles as f64),
        });
    }
    let errors = span(points.iter().map(|point| point.error)).unwrap_or((1e-10, 1.0));
    let cycles = span(points.iter().filter_map(|point| point.cycles)).unwrap_or(EMPTY);

    let root = SVGBackend::new(path, SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&root)
        .caption(
            "Sine and cosine: cycles against largest error",
            ("sans-serif", 22),
        )
        .margin(16)
        .x_label_area_size(44)
        .y_label_area_size(70)
        .build_cartesian_2d(
            (errors.0..errors.1).log_scale(),
            (cycles.0..cycles.1).log_scale(),
        )?;
    chart
        .configure_mesh()
        .x_desc("largest absolute error, over all inputs")
        .y_desc("median cycles of a call on the SoC")
        .x_label_formatter(&|error| format!("{error:.0e}"))
        .y_label_formatter(&|cycles| format!("{cycles}"))
        .light_line_style(BLACK.mix(0.04))
        .draw()?;

    for (family, colour) in families(&points).into_iter().zip(COLOURS.iter().cycle()) {
        let mut measured: Vec<&Point> = points
            .iter()
            .filter(|point| point.row.family == family && point.cycles.is_some())
            .collect();
        measured.sort_by(|a, b| a.error.total_cmp(&b.error));
        let at = |point: &Point| point.cycles.map(|cycles| (point.error, cycles));
        chart
            .draw_series(LineSeries::new(
                measured.iter().filter_map(|point| at(point)),
                colour.stroke_width(2),
            ))?
            .label(family)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], colour.stroke_width(2)));
        for point in points.iter().filter(|point| point.row.family == family) {
            let label = format!("{} {}", point.row.kernel, point.row.word_length);
            let Some(place) = at(point) else {
                let dashes = [(point.error, cycles.0), (point.error, cycles.1)];
                chart.draw_series(DashedLineSeries::new(dashes, 3, 5, colour.stroke_width(1)))?;
                let text = Text::new(
                    format!("{} (not measured)", point.row.kernel),
                    (point.error, cycles.1),
                    ("sans-serif", 11)
                        .into_font()
                        .transform(FontTransform::Rotate90)
                        .color(&colour),
                );
                chart.draw_series([text])?;
                continue;
            };
            chart.draw_series([Circle::new(place, 4, colour.filled())])?;
            if point.row.shipped {
                chart.draw_series([Circle::new(place, 9, BLACK.stroke_width(2))])?;
            }
            let name = EmptyElement::at(place) + Text::new(label, (12, -6), ("sans-serif", 13));
            chart.draw_series([name])?;
        }
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::LowerLeft)
        .background_style(WHITE.mix(0.8))
        .border_style(BLACK.mix(0.3))
        .draw()?;
    root.present()?;
    Ok(())
}

fn families<'a>(points: &[Point<'a>]) -> Vec<&'a str> {
    let mut found = Vec::new();
    for point in points {
        if !found.contains(&point.row.family) {
            found.push(point.row.family);
        }
    }
    found
}

/// Whole decades around some positive values, with room to write beside them.
fn span(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    let range = values.fold(None, |range: Option<(f64, f64)>, value| match range {
        None => Some((value, value)),
        Some((low, high)) => Some((low.min(value), high.max(value))),
    })?;
    Some((
        10f64.powf((range.0 / 1.5).log10().floor()),
        10f64.powf((range.1 * 1.5).log10().ceil()),
    ))
}
