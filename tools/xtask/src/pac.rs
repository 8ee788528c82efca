//! `cargo xtask pac`: writes the register access crate and the register map's page from the SoC's own description.
//!
//! LiteX exports a SoC in two incomplete files: `soc.svd` has fields and interrupts, `csr.json` has access rights, constants and
//! memories. `description.json` (`gateware/glint_soc/description.py`) adds the enumerated values, counters and constants of the
//! blocks. [`soc::Soc`] joins the three files and refuses contradictions; [`rust`] and [`markdown`] print the result. The output
//! does not depend on the time, the machine or the order in which LiteX collects the parts: the same SoC gives the same bytes.

mod description;
mod markdown;
mod rust;
mod soc;

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};

use crate::{generated, paths};
use soc::Soc;

/// Generates `firmware/litex-pac/src/generated.rs` and `docs/registers.md` from the virtual board's SoC.
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
        ("docs/registers.md", markdown::print(&soc)),
    ];
    generated::write(&outputs, "cargo xtask pac", check)
}

fn read(path: &Path) -> Result<String> {
    fs::read_to_string(path).with_context(|| {
        format!(
            "reading {} (`cargo xtask gateware` makes the SoC's description)",
            path.display()
        )
    })
}
