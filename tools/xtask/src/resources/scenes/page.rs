//! The tables of the builds for scenes, and the page docs/scene-builds.md.

use super::super::budget::Limits;
use super::super::number::number;
use super::super::size::{Resource, Size};
use super::row::{ALL, COLUMNS, Row};
use crate::gateware::Cells;

/// The rows as tables in Markdown: gateware, firmware and frames. `device` has the limits of the XC7S50, `ulx3s` the cells of the build
/// for all scenes on the ULX3S, and `full` is the length of the firmware with all parts.
pub fn tables(rows: &[Row], device: &Limits, ulx3s: &Cells, full: f64) -> String {
    format!(
        "## Gateware\n\n{}\n{}\n## Firmware\n\n{}\n## Frames\n\n{}",
        gateware(rows, device, ulx3s),
        on_ulx3s(ulx3s),
        firmware(rows, full),
        frames(rows)
    )
}

fn gateware(rows: &[Row], device: &Limits, ulx3s: &Cells) -> String {
    let all = rows.iter().find(|row| row.name == ALL);
    let mut out = "| scene | LUT | of all | FF | DSP48 | RAMB36 | slices | fits the XC7S50 | the ULX3S | build |\n\
                   |---|---:|---:|---:|---:|---:|---:|---|---|---|\n"
        .to_owned();
    for row in rows {
        let lut = row.size.of(Resource::Lut);
        let share = all.map_or(0.0, |all| 100.0 * lut / all.size.of(Resource::Lut));
        let cells = [
            Resource::Ff,
            Resource::Dsp48,
            Resource::Ramb36,
            Resource::Slices,
        ];
        let cells = cells.map(|resource| number(row.size.of(resource)));
        out += &format!(
            "| `{}` | {} | {share:.0} % | {} | {} | {} | `{}` |\n",
            row.name,
            number(lut),
            cells.join(" | "),
            fits(&row.size, device),
            fits_ulx3s(row, all, ulx3s),
            row.options.join(" ")
        );
    }
    out
}

fn firmware(rows: &[Row], full: f64) -> String {
    let mut out = "| scene | image | of full | code | constants | variables | stack |\n|---|---:|---:|---:|---:|---:|---:|\n".to_owned();
    for row in rows {
        let image = &row.firmware.image;
        let length = image.length as f64;
        let parts = [image.code, image.constants, image.variables];
        let parts = parts.map(|bytes| number(bytes as f64));
        let stack = row.firmware.stack.map(|bytes| number(bytes as f64));
        out += &format!(
            "| `{}` | {} | {:.0} % | {} | {} |\n",
            row.name,
            number(length),
            100.0 * length / full,
            parts.join(" | "),
            stack.unwrap_or_default()
        );
    }
    out
}

fn frames(rows: &[Row]) -> String {
    let mut out = "| scene | cycles | soft core | geometry passes | raster pass | of these waiting for memory | frames a second | MB a second |\n\
                   |---|---:|---:|---:|---:|---:|---:|---:|\n"
        .to_owned();
    for row in rows {
        let Some(frame) = &row.frame else {
            continue;
        };
        let stats = &frame.stats;
        let cycles = [
            stats.cycles,
            stats.cycles_soft_core,
            stats.cycles_geometry,
            stats.cycles_raster,
            stats.cycles_stalled,
        ];
        let cycles = cycles.map(|cycles| number(cycles as f64));
        let rates = [frame.rate, frame.memory].map(|rate| number(rate.floor()));
        out += &format!(
            "| `{}` | {} | {} |\n",
            row.name,
            cycles.join(" | "),
            rates.join(" | ")
        );
    }
    out
}

/// Whether a build fits a device: "yes", or what it has too much of.
fn fits(size: &Size, device: &Limits) -> String {
    let beyond = device.iter().filter_map(|(resource, limit)| {
        let share = size.of(*resource) / f64::from(*limit) * 100.0;
        (share > 100.0).then(|| format!("{} {share:.0} %", resource.name()))
    });
    let beyond: Vec<_> = beyond.collect();
    if beyond.is_empty() {
        "yes".to_owned()
    } else {
        format!("no: {}", beyond.join(", "))
    }
}

/// Whether a build fits the ULX3S. Only the build for all scenes is measured there: a build that takes no more of any resource fits if that
/// one does.
fn fits_ulx3s(row: &Row, all: Option<&Row>, ulx3s: &Cells) -> &'static str {
    let is_smaller = |all: &Row| {
        let mut resources = COLUMNS.iter().map(|(resource, _)| *resource);
        resources.all(|resource| row.size.of(resource) <= all.size.of(resource))
    };
    if all.is_some_and(is_smaller) && ulx3s.values().all(|[used, available]| used <= available) {
        "yes"
    } else {
        "not measured"
    }
}

/// Sentences about the cells of the build for all scenes on the ULX3S.
fn on_ulx3s(cells: &Cells) -> String {
    let cells = cells.iter().map(|(name, [used, available])| {
        let share = 100.0 * *used as f64 / *available as f64;
        format!("{} {name} ({share:.0} %)", number(*used as f64))
    });
    let cells = cells.collect::<Vec<_>>().join(", ");
    format!(
        "The build for `{ALL}` scenes takes {cells} of the ULX3S's LFE5U-85F, by Yosys and nextpnr's packing, without place and route.\n\
         A build that takes no more of any resource fits where it does.\n"
    )
}

pub fn page(tables: &str) -> String {
    format!(
        "<!-- Generated by `cargo xtask resources --scenes --write`. Do not edit. -->

# Builds for scenes

What the builds for each [scene](scenes.md) take, and that for `{ALL}` scenes.

- Gateware: the cells of the Urbana's SoC, by Yosys as in [resources.md](resources.md); slices are the lower bound. The last column has the
  options of `cargo xtask gateware`.
- Firmware: bytes. `of full` is the share of the image with all parts, at most half for a single scene. Variables are not in the image.
  The stack is what the self-test and the scene's picture use of it on the emulated board, which has no smooth shading.
- Frames: those of the scene in its size, on the virtual board with all blocks and two lanes, which has no smooth shading; `objects` on its
  own build. The engines and the soft core do not work at the same time. A list has the frame of its first scene. Frames a second are as
  many as can be drawn one after the other. The last column has what the engines then move in main memory, and scan-out at 60 Hz, without
  the soft core; [boards.md](boards.md) has what the memory of a board moves at most.

{tables}"
    )
}

#[cfg(test)]
mod tests {
    use super::super::row::tests::row;
    use super::*;

    #[test]
    fn tables_have_a_row_for_each_build() {
        let device = Limits::from([(Resource::Lut, 1_234), (Resource::Ramb36, 2)]);
        let ulx3s = |used| Cells::from([("LUT4".to_owned(), [used, 83_640])]);
        let rows = [row(ALL), row("lamp")];
        let text = tables(&rows, &device, &ulx3s(60_710), 108_642.0);
        for expected in [
            "| `lamp` | 1,234 | 100 % | 2,000 | 7 | 2.5 | 400 | no: RAMB36 125 % | yes | `--blocks scanout` |\n",
            "takes 60,710 LUT4 (73 %) of the ULX3S's LFE5U-85F",
            "| `lamp` | 54,321 | 50 % | 40,000 | 14,000 | 20,502 | 97,000 |\n",
            "| `lamp` | 1,354,166 | 66 | 4,100 | 1,350,000 | 12 | 60 | 55 |\n",
        ] {
            assert!(text.contains(expected), "{text}");
        }
        let beyond = tables(&rows, &device, &ulx3s(83_641), 108_642.0);
        assert_eq!(beyond.matches("| not measured |").count(), 2);
    }
}
