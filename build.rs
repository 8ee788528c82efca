//! Where the linker finds the memory map of the firmware.

use std::env;

fn main() {
    println!("cargo::rerun-if-changed=memory.x");
    // On a host the program is only checked.
    if env::var("CARGO_CFG_TARGET_ARCH").as_deref() == Ok("riscv32") {
        let root = env::var("CARGO_MANIFEST_DIR").expect("cargo sets it");
        println!("cargo::rustc-link-search={root}");
        // riscv-rt's own script, link.x, needs what memory.x defines.
        println!("cargo::rustc-link-arg-bins=-Tmemory.x");
        println!("cargo::rustc-link-arg-bins=-Tlink.x");
    }
}
