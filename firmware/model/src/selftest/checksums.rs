//! The checksums of the self-test's pictures, in the order of their definition.
// Written by `GLINT_UPDATE=1 cargo test -p glint-model --test model -- selftest`. Do not edit.

pub(super) const STORED: [u32; 10] = [
    0x8fcc3f78, 0x7251a3e0, 0xcca0be9b, 0xfbf7f676, 0xa29810d4, 0x03666682, 0x22e00cdf, 0xfd0e1134,
    0xad70c2c4, 0x0080c5f9,
];
