//! The scenes of the folder `scenes`, which are built into the programs that use this crate. `cargo xtask scenes` writes them for the
//! firmware.

/// Defines the built-in scenes by their names.
macro_rules! built_in {
    ($($name:literal),+ $(,)?) => {
        /// Names of the built-in scenes: the files of the folder `scenes`, without their extension.
        pub const NAMES: [&str; [$($name),+].len()] = [$($name),+];

        /// The texts of the built-in scenes, sorted by name.
        pub const TEXTS: [&str; NAMES.len()] = [$(include_str!(concat!("../../../scenes/", $name, ".toml"))),+];
    };
}

built_in!(
    "cubes",
    "demo",
    "holoforge",
    "holoforge-textured",
    "menger",
    "mesh-in-field",
    "objects",
    "poor-mans-vr",
    "room",
    "simplegpu",
    "spheres",
    "wireframe",
);
