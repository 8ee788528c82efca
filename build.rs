//! Build script: passes the memory map of the firmware to the linker.

use std::env;

fn main() {
    println!("cargo::rerun-if-changed=memory.x");
    // On a host the firmware is only type-checked, not linked, so its memory map is not needed.
    if env::var("CARGO_CFG_TARGET_ARCH").as_deref() == Ok("riscv32") {
        let root = env::var("CARGO_MANIFEST_DIR").expect("cargo sets it");
        println!("cargo::rustc-link-search={root}");
        // link.x, the linker script of riscv-rt, needs the symbols that memory.x defines.
        println!("cargo::rustc-link-arg-bins=-Tmemory.x");
        println!("cargo::rustc-link-arg-bins=-Tlink.x");
    }
}
