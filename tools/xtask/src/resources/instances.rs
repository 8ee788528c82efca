//! The cells of a block by instance, as a tree.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use serde::Deserialize;
use serde_json::{Value, json};

use super::number::number;

/// Cells of one instance, without those of the instances in it.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Instance {
    /// Names of the instances around it and its own, from the outermost.
    path: Vec<String>,
    /// Its cells.
    #[serde(flatten)]
    cells: Cells,
}

/// Numbers of cells.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
struct Cells {
    lut: u32,
    ff: u32,
    dsp48: u32,
    ramb36: f64,
}

/// An instance with all that is in it.
#[derive(Default)]
struct Node {
    cells: Cells,
    parts: BTreeMap<String, Node>,
}

impl Node {
    fn of(instances: &[Instance]) -> Self {
        let mut root = Self::default();
        for Instance { path, cells } in instances {
            let mut node = &mut root;
            node.add(cells);
            for name in path {
                node = node.parts.entry(name.clone()).or_default();
                node.add(cells);
            }
        }
        root
    }

    fn add(&mut self, cells: &Cells) {
        self.cells.lut += cells.lut;
        self.cells.ff += cells.ff;
        self.cells.dsp48 += cells.dsp48;
        self.cells.ramb36 += cells.ramb36;
    }

    /// The instances in this one, the largest first.
    fn sorted(&self) -> Vec<(&String, &Self)> {
        let mut parts: Vec<_> = self.parts.iter().collect();
        parts.sort_by_key(|(_, part)| std::cmp::Reverse((part.cells.lut, part.cells.ff)));
        parts
    }

    fn print(&self, name: &str, depth: usize, indent: usize, out: &mut String) {
        let Cells {
            lut,
            ff,
            dsp48,
            ramb36,
        } = self.cells;
        let [lut, ff, dsp48] = [lut, ff, dsp48].map(|count| number(count.into()));
        writeln!(
            out,
            "{lut:>8}{ff:>8}{dsp48:>6}{:>8}  {:indent$}{name}",
            number(ramb36),
            ""
        )
        .expect("writing to a string succeeds");
        if depth > 0 {
            for (name, part) in self.sorted() {
                part.print(name, depth - 1, indent + 2, out);
            }
        }
    }

    fn json(&self, name: &str, depth: usize) -> Value {
        let Cells {
            lut,
            ff,
            dsp48,
            ramb36,
        } = self.cells;
        let parts = if depth > 0 { self.sorted() } else { vec![] };
        let parts: Vec<_> = parts
            .into_iter()
            .map(|(name, part)| part.json(name, depth - 1))
            .collect();
        json!({"name": name, "lut": lut, "ff": ff, "dsp48": dsp48, "ramb36": ramb36, "parts": parts})
    }
}

/// The tree for a terminal, with the instances down to `depth`. The figures of an instance include its children.
pub fn text(name: &str, instances: &[Instance], depth: usize) -> String {
    let mut out = "     LUT      FF   DSP  RAMB36\n".to_owned();
    Node::of(instances).print(name, depth, 0, &mut out);
    out
}

/// The same for scripts.
pub fn json(name: &str, instances: &[Instance], depth: usize) -> Value {
    Node::of(instances).json(name, depth)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn instances() -> Vec<Instance> {
        let line = r#"[{"path": [], "lut": 1, "ff": 2, "dsp48": 0, "ramb36": 0},
            {"path": ["small"], "lut": 3, "ff": 0, "dsp48": 0, "ramb36": 0.5},
            {"path": ["big", "deep"], "lut": 1000, "ff": 9, "dsp48": 4, "ramb36": 1},
            {"path": ["big"], "lut": 10, "ff": 1, "dsp48": 0, "ramb36": 0}]"#;
        serde_json::from_str(line).unwrap()
    }

    #[test]
    fn an_instance_counts_what_is_in_it_and_the_largest_comes_first() {
        let text = text("block", &instances(), 1);
        let lines: Vec<_> = text.lines().collect();
        assert_eq!(
            lines,
            [
                "     LUT      FF   DSP  RAMB36",
                "   1,014      12     4     1.5  block",
                "   1,010      10     4       1    big",
                "       3       0     0     0.5    small",
            ]
        );
    }

    #[test]
    fn depth_limits_the_tree() {
        assert_eq!(text("block", &instances(), 0).lines().count(), 2);
        assert_eq!(text("block", &instances(), 3).lines().count(), 5);
        let json = json("block", &instances(), 2);
        assert_eq!(json["parts"][0]["parts"][0]["name"], "deep");
        assert_eq!(json["parts"][0]["ff"], 10);
    }
}
