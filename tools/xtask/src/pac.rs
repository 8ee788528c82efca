//! `cargo xtask pac`: writes the register access crate and the register map's page from the SoC's own description.
//!
//! LiteX exports a SoC in two incomplete files: `soc.svd` has fields and interrupts, `csr.json` has access rights, constants and
//! memories. `description.json` (`gateware/glint_soc/description.py`) adds the enumerated values, counters and constants of the
//! blocks. [`soc::Soc`] joins the three files and refuses contradictions; [`rust`] and [`markdown`] print the result. The output
//! does not depend on the time, the machine or the order in which LiteX collects the parts: the same SoC gives the same bytes.

mod description;
mod machine;
mod markdown;
mod rust;
mod soc;

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, bail};

use crate::paths;
use soc::Soc;

/// Generates `firmware/litex-pac/src/generated.rs`, `firmware/core/src/machine.rs` and `docs/registers.md` from the virtual board's SoC.
/// With `check` nothing is written: the files must equal the generated text.
///
/// # Errors
/// When the SoC has not been built, its descriptions disagree, or (with `check`) a file is stale.
pub fn generate(check: bool) -> Result<()> {
    let built = paths::target().join("gateware/virtual");
    let soc = Soc::read(
        &read(&built.join("soc.svd"))?,
        &read(&built.join("csr.json"))?,
        &read(&built.join("description.json"))?,
    )
    .with_context(|| format!("joining the SoC's descriptions in {}", built.display()))?;
    let outputs = [
        ("firmware/litex-pac/src/generated.rs", rust::print(&soc)?),
        ("firmware/core/src/machine.rs", machine::print(&soc.machine)),
        ("docs/registers.md", markdown::print(&soc)),
    ];
    for (path, text) in &outputs {
        let absolute = paths::root().join(path);
        if check {
            let committed = read(&absolute)?;
            if let Some(difference) = first_difference(&committed, text) {
                bail!("{path} is stale: {difference}; run `cargo xtask pac` and commit the files");
            }
        } else {
            fs::write(&absolute, text)
                .with_context(|| format!("writing {}", absolute.display()))?;
            println!("wrote {path}");
        }
    }
    Ok(())
}

fn read(path: &Path) -> Result<String> {
    fs::read_to_string(path).with_context(|| {
        format!(
            "reading {} (`cargo xtask gateware` makes the SoC's description)",
            path.display()
        )
    })
}

/// Describes the first line in which the text `have` differs from `want`; `None` when they are equal.
fn first_difference(have: &str, want: &str) -> Option<String> {
    if have == want {
        return None;
    }
    let (mut have, mut want) = (have.lines(), want.lines());
    let mut line = 1;
    loop {
        match (have.next(), want.next()) {
            (Some(a), Some(b)) if a == b => line += 1,
            (None, None) => return Some("it differs in its line ends".to_owned()),
            (a, b) => {
                let shown = |side: Option<&str>| {
                    side.map_or("the end".to_owned(), |text| format!("`{text}`"))
                };
                return Some(format!(
                    "line {line} is {}, expected {}",
                    shown(a),
                    shown(b)
                ));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::first_difference;

    #[test]
    fn names_the_first_line_that_differs() {
        assert_eq!(first_difference("a\nb\n", "a\nb\n"), None);
        assert_eq!(
            first_difference("a\nb\n", "a\nc\n").unwrap(),
            "line 2 is `b`, expected `c`"
        );
        assert_eq!(
            first_difference("a\n", "a\nc\n").unwrap(),
            "line 2 is the end, expected `c`"
        );
        assert_eq!(
            first_difference("a", "a\n").unwrap(),
            "it differs in its line ends"
        );
    }
}
