//! Build script: puts the memory map of programs, memory.x and windows.x, on the linker's search path.

use std::path::Path;
use std::{env, fs};

/// Size of the board's main memory in MB, which `cargo xtask firmware --board` sets. The default is that of the virtual board.
const MAIN_RAM: &str = "GLINT_MAIN_RAM_MB";

fn main() {
    let root = Path::new(&env::var("CARGO_MANIFEST_DIR").expect("cargo sets it")).join("../..");
    let map = root.join("memory.x");
    println!("cargo::rerun-if-changed={}", map.display());
    println!("cargo::rerun-if-changed=../windows");
    println!("cargo::rerun-if-env-changed={MAIN_RAM}");
    // A program on a host needs no memory map.
    if env::var("CARGO_CFG_TARGET_ARCH").as_deref() != Ok("riscv32") {
        return;
    }
    let size = env::var(MAIN_RAM).unwrap_or_else(|_| "128".to_owned());
    let windows = root.join(format!("firmware/windows/{size}.x"));
    let out = env::var("OUT_DIR").expect("cargo sets it");
    for (from, name) in [(map, "memory.x"), (windows, "windows.x")] {
        fs::copy(&from, Path::new(&out).join(name))
            .unwrap_or_else(|error| panic!("{}: {error}", from.display()));
    }
    println!("cargo::rustc-link-search={out}");
    // The build script of a program in another package must pass these arguments itself.
    println!("cargo::rustc-link-arg-examples=-Tmemory.x");
    println!("cargo::rustc-link-arg-examples=-Tlink.x");
}
