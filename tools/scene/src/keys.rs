//! The keys of scene files, and which of them go together.

/// A key that is a console command.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// Name of the key.
    pub name: &'static str,
    /// The console command before the value.
    pub command: &'static str,
    /// Whether the value may be a list, with a command for each of its members.
    pub is_list: bool,
    /// Keys of which the file needs one; empty if it needs none.
    pub with: &'static [&'static str],
    /// Keys that exclude it.
    pub without: &'static [&'static str],
}

const fn key(name: &'static str) -> Key {
    Key {
        name,
        command: name,
        is_list: false,
        with: &[],
        without: &[],
    }
}

impl Key {
    const fn command(self, command: &'static str) -> Self {
        Self { command, ..self }
    }

    const fn list(self) -> Self {
        Self {
            is_list: true,
            ..self
        }
    }

    const fn with(self, with: &'static [&'static str]) -> Self {
        Self { with, ..self }
    }

    const fn without(self, without: &'static [&'static str]) -> Self {
        Self { without, ..self }
    }
}

const MESHES: &[&str] = &["model", "object"];
const FIELD: &[&str] = &["field"];
const LIT: &[&str] = &["model", "object", "field"];

/// The keys that are console commands, in the order of the commands. What takes the longest to draw comes last.
pub const COMMANDS: [Key; 25] = [
    key("quality"),
    key("size"),
    key("backend"),
    key("view").with(LIT).without(&["camera", "lookat"]),
    key("camera").with(LIT).without(&["lookat"]),
    key("lookat").with(LIT),
    key("fov").with(LIT).without(&["orthographic"]),
    key("orthographic").with(MESHES).without(FIELD),
    key("shading").with(MESHES),
    key("cull").with(MESHES),
    key("clip").with(MESHES),
    key("winding").with(MESHES),
    key("edges").with(&["model"]).without(FIELD),
    key("material").with(FIELD),
    key("light").list().with(LIT),
    key("ambient").with(LIT),
    key("background").with(LIT),
    key("fog").with(FIELD),
    key("occlusion").with(FIELD),
    key("prepass").with(FIELD),
    key("stereo").with(LIT).without(&["orthographic"]),
    key("model")
        .command("scene")
        .without(&["object", "program"]),
    key("object")
        .command("object add")
        .list()
        .without(&["field", "program"]),
    key("field").without(&["program"]),
    key("program"),
];

/// The keys that are not console commands.
pub const OTHERS: [&str; 7] = [
    "title", "steer", "scenes", "depth", "lanes", "clock", "budget",
];

/// The members of the key `budget`.
pub const BUDGET: [&str; 7] = ["lut", "ff", "dsp", "ramb36", "firmware", "cycles", "fps"];

/// The names of all keys.
pub fn names() -> impl Iterator<Item = &'static str> {
    OTHERS
        .into_iter()
        .chain(COMMANDS.iter().map(|key| key.name))
}
