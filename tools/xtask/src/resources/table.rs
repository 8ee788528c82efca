//! Sizes and budgets as text, as a page of Markdown, and as JSON.

use std::fmt::Write as _;

use serde_json::{Value, json};

use super::blocks::{FLAT, FLAT_PARTS, OWN, SOC};
use super::budget::{Budget, Excess};
use super::size::{Resource, Size, number};

/// Notes on the method of measurement, for the page.
const NOTES: [&str; 7] = [
    "Yosys counts the cells of the mapped netlist; no cell is estimated. Placement and routing are not run: wires have no \
     delay, and no clock rate follows. Other tools give other counts. Yosys' own counts vary by a cell of path or a percent \
     of LUTs with irrelevant changes.",
    "LUT: LUT1 to LUT6 and inverters (logic), shift registers (SRL), and LUTs of LUT memories (LUTRAM: four for a RAM32M). \
     Two small LUTs that could share a LUT6 count as two. RAMB36: a RAMB18 counts as half.",
    "Path: number of cells on the longest path between two registers, or a register and a port: LUTs, inverters, four-bit \
     carry chains, wide multiplexers, reads of LUT memories. A multiplier or block RAM ends a path even without its \
     registers. Clock domains and false paths are ignored. The path is only an indication of timing.",
    "A block on its own keeps logic that is constant in the SoC, so the blocks do not add up to the SoC.",
    "`ring_lane` is a lane for the sponge up to depth 4 without cones, `ring_lane_all` a lane for every field with cones. \
     `raymarcher` is the build for all fields; `raymarcher_round`, `raymarcher_faces` and `raymarcher_sponge` are the builds \
     of `cargo xtask gateware --fields`. The budget of `ring_lane` allows three multipliers, for p = o + t·d: no other field \
     fits.",
    "The SoC is the Urbana's: VexRiscv with its caches, LiteDRAM with its PHY, ROM, SRAM, scan-out, triangle engine, \
     raymarcher. The ROM holds the BIOS of this build.",
    "The SoC's path is not limited: the soft core has longer paths than the own blocks.",
];

/// The rows of a table, all of equal length. The first row is the head.
type Rows = Vec<Vec<String>>;

/// Rows with the sizes of the blocks, and with the share of the device that the SoC takes.
fn sizes_rows(sizes: &[Size], budget: &Budget) -> Rows {
    let mut rows = vec![strings(&[
        "block", "LUT", "logic", "SRL", "LUTRAM", "FF", "DSP48", "RAMB36", "CARRY4", "path",
    ])];
    for size in sizes {
        let parts = [size.logic, size.srl, size.lutram].map(|part| number(part.into()));
        let mut row = vec![size.name.clone(), number(size.of(Resource::Lut))];
        row.extend(parts);
        row.extend(
            Resource::ALL[1..]
                .iter()
                .map(|resource| number(size.of(*resource))),
        );
        rows.push(row);
    }
    if let Some(soc) = sizes.iter().find(|size| size.name == SOC) {
        let share = |resource: Resource| {
            budget
                .device
                .get(&resource)
                .map_or_else(String::new, |has| {
                    format!("{:.0} %", soc.of(resource) / f64::from(*has) * 100.0)
                })
        };
        let mut row = vec!["of the device".to_owned(), share(Resource::Lut)];
        row.extend([const { String::new() }; 3]);
        row.extend(Resource::ALL[1..].iter().map(|resource| share(*resource)));
        rows.push(row);
    }
    rows
}

/// Rows with the limits of the blocks.
fn budget_rows(sizes: &[Size], budget: &Budget) -> Rows {
    let mut head = vec!["block".to_owned()];
    head.extend(Resource::ALL.map(|resource| resource.name().to_owned()));
    let mut rows = vec![head];
    for size in sizes {
        let limits = budget.limits(&size.name);
        let mut row = vec![size.name.clone()];
        row.extend(Resource::ALL.map(|resource| {
            limits
                .get(&resource)
                .map_or_else(String::new, |limit| number((*limit).into()))
        }));
        rows.push(row);
    }
    rows
}

/// Lists the SoC's cells that count as no resource, as text; `None` if the SoC was not measured.
fn others(sizes: &[Size]) -> Option<String> {
    let soc = sizes.iter().find(|size| size.name == SOC)?;
    let cells: Vec<String> = soc
        .others
        .iter()
        .map(|(cell, count)| format!("{count} {cell}"))
        .collect();
    Some(cells.join(", "))
}

fn yosys(sizes: &[Size]) -> &str {
    sizes.first().map_or("Yosys", |size| &size.yosys)
}

/// Formats the tables of the sizes and of the limits for a terminal.
pub fn text(sizes: &[Size], budget: &Budget) -> String {
    let mut out = aligned(&sizes_rows(sizes, budget));
    write!(out, "\nbudget\n{}\n", aligned(&budget_rows(sizes, budget)))
        .expect("writing to a string succeeds");
    if let Some(cells) = others(sizes) {
        writeln!(out, "other cells of the SoC: {cells}").expect("writing to a string succeeds");
    }
    writeln!(
        out,
        "Cells mapped by {}, synth_xilinx for the 7 series: no place and route, so no clock rate. See docs/resources.md.",
        yosys(sizes)
    )
    .expect("writing to a string succeeds");
    out
}

/// The page `docs/resources.md`.
pub fn page(sizes: &[Size], budget: &Budget) -> String {
    let mut out = format!(
        "<!-- Generated by `cargo xtask resources --write`. Do not edit. -->\n\n# Resources\n\nResources of the gateware on the \
         XC7S50, counted by {} (`synth_xilinx -family xc7`). `cargo xtask resources` repeats the measurement and fails\nabove the \
         budget in `gateware/budget.toml`; `cargo xtask resources setup` measures one block, `--json` prints JSON.\n\
         `cargo xtask test` checks these blocks: {}.\n\n{}\n",
        yosys(sizes),
        OWN.map(|block| format!("`{block}`")).join(", "),
        markdown(&sizes_rows(sizes, budget))
    );
    writeln!(
        out,
        "`{FLAT}` is {}.",
        FLAT_PARTS.map(|part| format!("`{part}`")).join(" + ")
    )
    .expect("writing to a string succeeds");
    if let Some(cells) = others(sizes) {
        writeln!(out, "Other cells of the SoC: {cells}.").expect("writing to a string succeeds");
    }
    write!(
        out,
        "\n## Budget\n\n{}\n## Method\n\n",
        markdown(&budget_rows(sizes, budget))
    )
    .expect("writing to a string succeeds");
    for note in NOTES {
        writeln!(out, "- {note}").expect("writing to a string succeeds");
    }
    out
}

/// JSON for scripts: all counts, sums and excesses.
pub fn json(sizes: &[Size], excesses: &[Excess]) -> Value {
    let blocks: Vec<Value> = sizes
        .iter()
        .map(|size| {
            json!({
                "name": size.name,
                "lut": size.logic + size.srl + size.lutram, "logic": size.logic, "srl": size.srl, "lutram": size.lutram,
                "ff": size.ff, "dsp48": size.dsp48, "ramb36": size.of(Resource::Ramb36), "carry4": size.carry4,
                "path": size.path, "others": size.others,
            })
        })
        .collect();
    json!({ "yosys": yosys(sizes), "blocks": blocks, "excesses": excesses })
}

fn strings(words: &[&str]) -> Vec<String> {
    words.iter().map(|word| (*word).to_owned()).collect()
}

/// Formats a table as text, with the first column aligned left and the others right.
fn aligned(rows: &Rows) -> String {
    let columns = rows[0].len();
    let widths: Vec<usize> = (0..columns)
        .map(|column| rows.iter().map(|row| row[column].len()).max().unwrap_or(0))
        .collect();
    let mut out = String::new();
    for row in rows {
        let mut line = format!("{:<1$}", row[0], widths[0]);
        for (cell, width) in row.iter().zip(&widths).skip(1) {
            write!(line, "  {cell:>width$}").expect("writing to a string succeeds");
        }
        out += line.trim_end();
        out.push('\n');
    }
    out
}

fn markdown(rows: &Rows) -> String {
    let line = |row: &[String]| format!("| {} |\n", row.join(" | "));
    let rule = format!("|---|{}\n", "---:|".repeat(rows[0].len() - 1));
    let body: String = rows[1..].iter().map(|row| line(row)).collect();
    line(&rows[0]) + &rule + &body
}

#[cfg(test)]
mod tests {
    use super::super::budget::Budget;
    use super::super::size::tests::size;
    use super::*;

    fn budget() -> Budget {
        toml::from_str(super::super::budget::tests::BUDGET).unwrap()
    }

    #[test]
    fn prints_a_table_that_lines_up() {
        let sizes = ["setup", SOC].map(size);
        let text = text(&sizes, &budget());
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(
            lines[..4],
            [
                "block            LUT  logic  SRL  LUTRAM     FF  DSP48  RAMB36  CARRY4  path",
                "setup          1,234  1,200   30       4  2,000      7     2.5      50     9",
                "soc            1,234  1,200   30       4  2,000      7     2.5      50     9",
                "of the device    4 %                        3 %    6 %     3 %",
            ]
        );
        assert!(text.contains("other cells of the SoC: 3 MUXF7\n"), "{text}");
    }

    #[test]
    fn the_page_is_marked_and_has_the_budgets() {
        let page = page(&["setup", SOC].map(size), &budget());
        assert!(page.starts_with("<!-- Generated by `cargo xtask resources --write`."));
        for line in [
            "| setup | 1,234 | 1,200 | 30 | 4 | 2,000 | 7 | 2.5 | 50 | 9 |",
            "| setup | 1,234 |  |  | 3 |  | 9 |",
            "| soc | 32,600 | 65,200 | 120 | 2 |  |  |",
        ] {
            assert!(page.contains(line), "expected `{line}` in:\n{page}");
        }
    }

    #[test]
    fn json_has_sums_and_excesses() {
        let sizes = [size(SOC)];
        let json = json(&sizes, &budget().excesses(&sizes));
        assert_eq!(json["blocks"][0]["lut"], 1234);
        assert_eq!(json["blocks"][0]["ramb36"], 2.5);
        assert_eq!(
            json["excesses"],
            json!([{"block": "soc", "resource": "ramb36", "budget": 2, "measured": 2.5}])
        );
    }
}
