//! Build script: passes the memory map of the firmware to the linker.

use std::path::Path;
use std::{env, fs};

/// Size of the board's main memory in MB, which `cargo xtask firmware --board` sets; by default the virtual board's.
const MAIN_RAM: &str = "GLINT_MAIN_RAM_MB";

fn main() {
    println!("cargo::rerun-if-changed=memory.x");
    println!("cargo::rerun-if-changed=firmware/windows");
    println!("cargo::rerun-if-env-changed={MAIN_RAM}");
    // On a host the firmware is only type-checked, not linked, so its memory map is not needed.
    if env::var("CARGO_CFG_TARGET_ARCH").as_deref() == Ok("riscv32") {
        let root = env::var("CARGO_MANIFEST_DIR").expect("cargo sets it");
        let size = env::var(MAIN_RAM).unwrap_or_else(|_| "128".to_owned());
        let windows = Path::new(&root).join(format!("firmware/windows/{size}.x"));
        let out = env::var("OUT_DIR").expect("cargo sets it");
        fs::copy(&windows, Path::new(&out).join("windows.x"))
            .unwrap_or_else(|error| panic!("{}: {error}", windows.display()));
        println!("cargo::rustc-link-search={root}");
        println!("cargo::rustc-link-search={out}");
        // link.x, the linker script of riscv-rt, needs the symbols that memory.x defines.
        println!("cargo::rustc-link-arg-bins=-Tmemory.x");
        println!("cargo::rustc-link-arg-bins=-Tlink.x");
    }
}
