//! Build script: the linker arguments of programs, as in the build script of `glint-program`.

use std::env;

fn main() {
    if env::var("CARGO_CFG_TARGET_ARCH").as_deref() == Ok("riscv32") {
        println!("cargo::rustc-link-arg-examples=-Tmemory.x");
        println!("cargo::rustc-link-arg-examples=-Tlink.x");
    }
}
