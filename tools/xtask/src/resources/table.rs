//! Sizes and budgets as text, as a page of Markdown, and as JSON.

use std::fmt::Write as _;

use serde_json::{Value, json};

use super::blocks::{FLAT, FLAT_PARTS, OWN, SOC};
use super::budget::{Budget, Excess};
use super::size::{Resource, Size, number};

/// Notes on the method.
const NOTES: [&str; 7] = [
    "Cells are those of the netlist that Yosys maps: none is estimated. Nothing is placed or routed, so wires have no delay and \
     no clock rate follows. Another tool maps to other counts; Yosys' own move by a cell of path or a percent of LUTs with \
     what should not matter.",
    "LUT: LUT1 to LUT6 and inverters (logic), shift registers (SRL), and the LUTs that LUT memories take (LUTRAM: four for a \
     RAM32M). Two small ones that could share one LUT6 count as two. RAMB36: a RAMB18 is half of one.",
    "Path: the cells between two registers, or a register and a port, on the longest such path: LUTs, inverters, carry chains \
     of four bits, wide multiplexers, reads of LUT memories. A multiplier or block RAM ends a path even where its registers \
     are not used. Clock domains and false paths are not known. It stands for timing, and is no more than a stand-in.",
    "A block alone keeps what the SoC may find to be constant, so blocks do not add up to the SoC.",
    "`ring_lane` is a lane of the raymarcher for the sponge up to depth 4 and no cones, `ring_lane_all` one for every field and for cones. \
     `raymarcher` is the build for all fields, the others are what `cargo xtask gateware --fields` calls `round`, `faces` and `sponge`. The \
     budget leaves a lane for the sponge three multipliers, which are those of p = o + t·d: no other field is in it.",
    "The SoC is the Urbana's: VexRiscv with its caches, LiteDRAM with its PHY, ROM, SRAM, scan-out, triangle engine, raymarcher. The ROM \
     holds the BIOS of this build.",
    "The SoC's path is shown and not limited: the soft core has longer ones than the own blocks.",
];

/// Rows of equal length; the first is the head.
type Rows = Vec<Vec<String>>;

/// Sizes of the blocks, and the SoC's share of the device.
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

/// Limits of the blocks.
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

/// Cells of the SoC that count as no resource.
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

/// Tables for a terminal.
pub fn text(sizes: &[Size], budget: &Budget) -> String {
    let mut out = aligned(&sizes_rows(sizes, budget));
    write!(out, "\nat most\n{}\n", aligned(&budget_rows(sizes, budget)))
        .expect("a string takes all");
    if let Some(cells) = others(sizes) {
        writeln!(out, "in the SoC too: {cells}").expect("a string takes all");
    }
    writeln!(
        out,
        "Cells mapped by {}, synth_xilinx for the 7 series: no place and route, so no clock rate. docs/resources.md says more.",
        yosys(sizes)
    )
    .expect("a string takes all");
    out
}

/// The page `docs/resources.md`.
pub fn page(sizes: &[Size], budget: &Budget) -> String {
    let mut out = format!(
        "<!-- Generated by `cargo xtask resources --write`. Do not edit. -->\n\n# Resources\n\nWhat the gateware takes of the \
         XC7S50, as {} counts it (`synth_xilinx -family xc7`). `cargo xtask resources` measures it anew and fails\nbeyond the \
         budget in `gateware/budget.toml`; `cargo xtask resources setup` measures one block, `--json` is for scripts.\n\
         `cargo xtask test` holds these to the budget: {}.\n\n{}\n",
        yosys(sizes),
        OWN.map(|block| format!("`{block}`")).join(", "),
        markdown(&sizes_rows(sizes, budget))
    );
    writeln!(
        out,
        "`{FLAT}` is {}.",
        FLAT_PARTS.map(|part| format!("`{part}`")).join(" + ")
    )
    .expect("a string takes all");
    if let Some(cells) = others(sizes) {
        writeln!(out, "The SoC has besides: {cells}.").expect("a string takes all");
    }
    write!(
        out,
        "\n## At most\n\n{}\n## What it says, and what not\n\n",
        markdown(&budget_rows(sizes, budget))
    )
    .expect("a string takes all");
    for note in NOTES {
        writeln!(out, "- {note}").expect("a string takes all");
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

/// Aligns the first column left, the others right.
fn aligned(rows: &Rows) -> String {
    let columns = rows[0].len();
    let widths: Vec<usize> = (0..columns)
        .map(|column| rows.iter().map(|row| row[column].len()).max().unwrap_or(0))
        .collect();
    let mut out = String::new();
    for row in rows {
        let mut line = format!("{:<1$}", row[0], widths[0]);
        for (cell, width) in row.iter().zip(&widths).skip(1) {
            write!(line, "  {cell:>width$}").expect("a string takes all");
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
        assert!(text.contains("in the SoC too: 3 MUXF7\n"), "{text}");
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
