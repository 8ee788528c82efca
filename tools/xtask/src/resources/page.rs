//! The page `docs/resources.md`.

use super::blocks::{FLAT, FLAT_PARTS, OWN};
use super::budget::Budget;
use super::table::{
    Measured, Rows, budget_rows, others, placement_rows, rates_rows, sizes_rows, tools,
};

/// Notes on the measurement of cells, for the page.
const NOTES: [&str; 11] = [
    "Yosys counts the cells of the mapped netlist; no cell is estimated. Other tools give other counts. Yosys' own counts vary \
     by a cell of path or a percent of LUTs with irrelevant changes.",
    "LUT: LUT1 to LUT6 and inverters (logic), shift registers (SRL), and LUTs of LUT memories (LUTRAM: four for a RAM32M). \
     Two small LUTs that could share a LUT6 count as two. RAMB36: a RAMB18 counts as half.",
    "Path: number of cells on the longest path between two registers, or a register and a port: LUTs, inverters, four-bit \
     carry chains, wide multiplexers, reads of LUT memories. A multiplier or block RAM ends a path even without its \
     registers. Clock domains and false paths are ignored. The path is only an indication of timing.",
    "Control sets: the flip-flops of a slice of the 7 series share clock, enable, and set or reset. A control set is one \
     combination of these nets; a pin at a constant has none. An enable or a synchronous reset of fewer than five flip-flops \
     becomes logic instead, and is counted there, as in the Urbana's bitstream (`CONTROL_PIN_LOADS` in \
     `gateware/glint_soc/urbana_platform.py`). Flip-flops in small sets are in sets of fewer than eight, and leave part of a \
     slice empty.",
    "Slices: a lower bound, since nothing is placed. A slice has four LUTs, eight flip-flops and a CARRY4. The bound is the \
     largest of three: a quarter of the LUTs; the slices of each control set, an eighth of its flip-flops rounded up, summed; \
     the CARRY4. A placed design takes more: LUTs and flip-flops rarely all find room beside each other, and LUT memories and \
     shift registers fit only some slices. Two small LUTs that share a LUT6 could lower the first of the three.",
    "Largest fan-outs: the nets with the most inputs of cells, except clocks. A net without a name in the source code is \
     described by a register that it controls.",
    "A block on its own keeps logic that is constant in the SoC, so the blocks do not add up to the SoC.",
    "`cargo xtask resources --tree` attributes each cell to one instance: a cell with a name in the source code to the instance \
     around it, any other to the instance of the net that it drives. A LUT that drives a net without a name belongs to the \
     instance of most of its loads, so logic that several instances share counts for one. LiteX writes one flat module: there \
     the words of a net's name stand for instances.",
    "`ring_lane` is a lane for the sponge up to depth 4 without cones, `ring_lane_all` a lane for every field with cones. \
     `raymarcher` is the build for all fields; `raymarcher_round`, `raymarcher_faces` and `raymarcher_sponge` are the builds \
     of `cargo xtask gateware --fields`. The budget of `ring_lane` allows three multipliers, for p = o + t·d: no other field \
     fits.",
    "The SoC is the Urbana's: VexRiscv with its caches, LiteDRAM with its PHY, ROM, SRAM, scan-out, triangle engine, \
     raymarcher. The ROM holds the BIOS of this build.",
    "The SoC's path is not limited: the soft core has longer paths than the own blocks.",
];

/// Notes on the clock rates, for the page.
const ROUTE_NOTES: [&str; 7] = [
    "Yosys maps a block for the ECP5, and nextpnr places and routes it alone on an LFE5U-85F of speed grade 6, the slowest: \
     tools from PyPI, pinned, which run on any machine. 100 MHz are asked. Every port of the block is a flip-flop, so paths to \
     and from ports count. Of a block with several clocks, the slowest counts; paths between two clocks do not.",
    "Trust the ratio, not the MHz. The rate is that of another family by another tool than the vendor's, for a block with the \
     chip to itself. VexRiscv, the soft core in the SoC's variant, is measured in the same run by the same tools: a block with \
     a ratio above 1 limits the SoC's clock less than the soft core does.",
    "Wires make the difference between chips: placed on the XC7S50 by an open tool, the worst paths of these blocks are wire \
     for 85 to 90 % of their delay. No vendor tool has confirmed a rate.",
    "A block RAM without its output register takes 5.6 ns from clock to output on this ECP5, so a path from such a RAM weighs \
     more here than on the 7 series.",
    "An ECP5 multiplies 18 by 18 bits, a DSP48E1 of the 7 series 25 by 18. Wider products get a register between the \
     multipliers and their sum for this measurement, as they would in a pipeline made for the family: paths in such a product \
     do not count.",
    "The placer starts from a seed. Three seeds give three rates, and the median counts. Rates of one netlist differ by 5 to \
     10 % between seeds, and a median has moved by 4 % when only comments changed. So a difference between two ratios below 0.05 \
     says nothing, and the least ratios of the budget leave as much room.",
    "Worst path: of the median, from register to register; `port` is the flip-flop of a port. A level is a LUT with its \
     multiplexers, or a whole carry chain. Logic has the delays of the registers too.",
];

/// Formats the page `docs/resources.md`.
pub fn page(measured: &Measured, budget: &Budget) -> String {
    let sizes = &measured.sizes;
    let own = OWN.map(|block| format!("`{block}`")).join(", ");
    let routed = budget.routed().into_iter();
    let routed: Vec<_> = routed.map(|block| format!("`{block}`")).collect();
    let mut out = format!(
        "<!-- Generated by `cargo xtask resources --write --route`. Do not edit. -->\n\n# Resources\n\n{}\n\n\
         `cargo xtask resources` repeats the count of cells and fails beyond the limits in `gateware/budget.toml`;\n\
         `cargo xtask resources setup` measures one block, `--json` prints JSON. `cargo xtask resources --route` places and routes\n\
         the own blocks, about two minutes each, and prints clock rates beside VexRiscv's; `--route setup` does it for one.\n\
         `cargo xtask resources --tree` prints the cells of the SoC by instance, `--tree setup` those of one block.\n\
         `cargo xtask test` counts the cells of {own},\nand checks the clock rate of {}.\n\n{}\n",
        tools(measured),
        if routed.is_empty() {
            "no block".to_owned()
        } else {
            routed.join(" and ")
        },
        markdown(&sizes_rows(sizes, budget), 0)
    );
    let parts = FLAT_PARTS.map(|part| format!("`{part}`")).join(" + ");
    out += &format!("`{FLAT}` is {parts}.\n");
    if let Some(cells) = others(sizes) {
        out += &format!("Other cells of the SoC: {cells}.\n");
    }
    let placement = markdown(&placement_rows(measured, budget), 1);
    out += &format!("\n## Place and fit\n\n{placement}\n");
    if let Some(rates) = &measured.rates {
        let rates = markdown(&rates_rows(rates), 2);
        out += &format!("## Clock rates on an ECP5\n\n{rates}\n");
    }
    let limits = markdown(&budget_rows(sizes, budget), 0);
    out += &format!("## Budget\n\n{limits}\n## Method\n\n");
    out.extend(NOTES.map(|note| format!("- {note}\n")));
    if measured.rates.is_some() {
        out += "\n## How far to trust a clock rate\n\n";
        out.extend(ROUTE_NOTES.map(|note| format!("- {note}\n")));
    }
    out
}

/// Formats a table in Markdown, with the first column and the last `texts` columns aligned left and the others right.
fn markdown(rows: &Rows, texts: usize) -> String {
    let line = |row: &[String]| format!("| {} |\n", row.join(" | "));
    let numbers = rows[0].len() - 1 - texts;
    let rule = format!("|---|{}{}\n", "---:|".repeat(numbers), "---|".repeat(texts));
    let body: String = rows[1..].iter().map(|row| line(row)).collect();
    line(&rows[0]) + &rule + &body
}

#[cfg(test)]
mod tests {
    use super::super::route::tests::rates;
    use super::super::table::tests::{budget, measured};
    use super::*;

    #[test]
    fn the_page_is_marked_and_has_rates_and_budgets() {
        let page = page(&measured(Some(rates())), &budget());
        assert!(page.starts_with("<!-- Generated by `cargo xtask resources --write --route`."));
        for line in [
            "| setup | 1,234 | 1,200 | 30 | 4 | 2,000 | 7 | 2.5 | 50 | 9 |",
            "|---|---:|---:|---:|---:|---:|---|",
            "| setup | 21 | 17 | 400 | 100.0 | 1.25 | `enable` 348, `first[0]` 99 |",
            "| soc | 21 | 17 | 400 |  |  | `enable` 348, `first[0]` 99 |",
            "| vexriscv | 80.0 | 90.0 70.5 81.0 | 1.00 | 2 | 2.0 | 7.2 | `port a` | `part.sum[1]` |",
            "| setup | 1,234 |  |  | 3 |  | 9 |  |  | 1.25 |",
            "| soc | 32,600 | 65,200 | 120 | 2 |  |  | 21 | 8,150 |  |",
        ] {
            assert!(page.contains(line), "expected `{line}` in:\n{page}");
        }
    }
}
