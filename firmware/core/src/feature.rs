//! Optional parts of the firmware, which a build for certain scenes leaves out.
//!
//! Each part is a Cargo feature of this crate, and the firmware crate has a feature of the same name. Code of a part is always
//! compiled and checked; the constant conditions of this module let the compiler remove the parts that a build leaves out.

use core::fmt;

/// A part of the firmware.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Feature {
    /// Name of the Cargo feature.
    pub name: &'static str,
    /// Whether this build has the part.
    pub is_built: bool,
}

impl Feature {
    /// Calls `write` if this build has the part, so that texts of missing parts are left out of the build.
    pub fn when_built(self, write: impl FnOnce() -> fmt::Result) -> fmt::Result {
        if self.is_built { write() } else { Ok(()) }
    }
}

/// Writes the error that this build lacks the part, and how to build a firmware with it.
impl fmt::Display for Feature {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let name = self.name;
        write!(
            f,
            "this firmware lacks the feature {name}, expected a build by `cargo xtask firmware`, or for scenes with `--features {name}`"
        )
    }
}

/// Defines the parts by the names of their Cargo features.
macro_rules! features {
    ($($(#[$doc:meta])* $feature:ident = $name:literal;)+) => {
        $(
            $(#[$doc])*
            pub const $feature: Feature = Feature {
                name: $name,
                is_built: cfg!(feature = $name),
            };
        )+

        /// All parts, in the order of their definitions.
        pub const ALL: [Feature; [$($name),+].len()] = [$($feature),+];
    };
}

features! {
    /// Camera, lens and background of meshes and fields.
    VIEW = "view";
    /// Meshes, and the options for triangles.
    MESH = "mesh";
    /// Several meshes in a picture, each with its own model matrix.
    OBJECT = "object";
    /// Textures of meshes.
    TEXTURE = "texture";
    /// A sky as background.
    SKY = "sky";
    /// Edges of a mesh.
    EDGES = "edges";
    /// Programs of the wireframe simulator and their upload, and board buttons as its keys.
    WIREFRAME = "wireframe";
    /// Cameras that show a whole mesh.
    FIT = "fit";
    /// Distance fields and their appearance.
    FIELD = "field";
    /// Spheres in a field, alone and in unions.
    SPHERES = "spheres";
    /// Fog on meshes and fields.
    FOG = "fog";
    /// A mesh in a field.
    MESH_IN_FIELD = "mesh-in-field";
    /// Clipping of the triangles that cross the near plane or reach far beyond the picture.
    CLIPPING = "clipping";
    /// Stereo pictures.
    STEREO = "stereo";
    /// Pictures with four samples a pixel.
    ANTIALIASING = "antialiasing";
    /// Lights other than the default lights.
    LIGHT = "light";
    /// Motion of the picture over time: `animate`.
    ANIMATE = "animate";
    /// The motion sensor.
    IMU = "imu";
    /// Replay of a log of the motion sensor.
    REPLAY = "replay";
    /// Steering by a hand in front of the image sensor.
    GESTURE = "gesture";
    /// Upload of meshes.
    UPLOAD = "upload";
    /// Drawing on the soft core, by the backend `cpu` or in place of the gateware.
    CPU = "cpu";
    /// Text over the picture.
    OVERLAY = "overlay";
    /// Demo, which shows scenes in turn without a host; scenes, lists and meshes from the flash.
    DEMO = "demo";
    /// The command `bench`, which measures clock cycles.
    BENCH = "bench";
}

/// The part that every build contains.
pub const BASE: Feature = Feature {
    name: "",
    is_built: true,
};
