//! Variants of the CPU, VexRiscv, and the features that the firmware must not use in each variant.

/// A variant that a gateware may have: `cargo xtask gateware --cpu NAME`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Variant {
    /// Name of the variant.
    pub name: &'static str,
    /// The Cargo features that the firmware needs for it: `uptime` without a cycle counter in the CPU, `uncached` without a data cache.
    pub features: &'static [&'static str],
}

/// All variants that execute the firmware's instruction set, rv32im; the default variant first.
pub const VARIANTS: [Variant; 7] = [
    Variant::new("full", &[]),
    Variant::new("lite", &["uptime", "uncached"]),
    Variant::new("standard", &["uptime"]),
    Variant::new("imac", &[]),
    Variant::new("linux", &["uptime"]),
    Variant::new("linux+no-dsp", &["uptime"]),
    Variant::new("secure", &[]),
];

impl Variant {
    const fn new(name: &'static str, features: &'static [&'static str]) -> Self {
        Self { name, features }
    }
}
