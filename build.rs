//! Build script: passes the linker scripts of the firmware to the linker.

use std::env;

fn main() {
    // On a host the firmware is only type-checked, not linked. The build script of glint-program has put memory.x and link.x on the
    // search path.
    if env::var("CARGO_CFG_TARGET_ARCH").as_deref() == Ok("riscv32") {
        println!("cargo::rustc-link-arg-bins=-Tmemory.x");
        println!("cargo::rustc-link-arg-bins=-Tlink.x");
    }
}
