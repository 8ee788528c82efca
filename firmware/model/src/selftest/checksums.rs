//! The checksums of the self-test's pictures, in the order of their definition.
// Written by `GLINT_UPDATE=1 cargo test -p glint-model --test model -- selftest`. Do not edit.

pub(super) const STORED: [u32; 11] = [
    0x8fcc3f78, 0x3f3155c5, 0xba324999, 0xcca0be9b, 0xfbf7f676, 0x8ec96a76, 0x2c106f0a, 0xe868d86a,
    0xfd0e1134, 0xad70c2c4, 0xc24dab98,
];
