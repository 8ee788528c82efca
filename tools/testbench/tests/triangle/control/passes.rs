//! The two passes of the triangle engine: parameters, memory regions, and errors of refused requests.

pub const BASE: u64 = 0x4000_0000;
pub const MEMORY: u64 = 128 << 20;
/// Largest number of clocks from the request for a single pass to its start.
pub const LATENCY: u64 = 15;

pub const NONE: u64 = 0;
pub const SIZE: u64 = 1;
pub const ADDRESS: u64 = 2;
pub const BUSY: u64 = 3;
pub const MESH: u64 = 4;
pub const FULL: u64 = 5;
pub const LIST: u64 = 6;
pub const CANCELLED: u64 = 7;
pub const TRIANGLES: u64 = 8;
pub const LINES: u64 = 9;
pub const NO_GEOMETRY: u64 = 10;

/// Index of the geometry pass in arrays of both passes.
pub const GEOMETRY: usize = 0;
/// Index of the raster pass in arrays of both passes.
pub const RASTER: usize = 1;
pub const NAMES: [&str; 2] = ["geometry", "raster"];

/// Flags of a pass: picture size, and the switches by name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Flags {
    pub size: u64,
    pub others: Vec<(&'static str, bool)>,
}

impl Flags {
    pub fn is_set(&self, name: &str) -> bool {
        self.others.contains(&(name, true))
    }

    /// Sets the named switches and clears the others.
    pub fn choose(&mut self, names: &[&str]) {
        for (name, set) in &mut self.others {
            *set = names.contains(name);
        }
    }

    pub fn invert(&mut self) {
        self.size ^= 3;
        for (_, set) in &mut self.others {
            *set = !*set;
        }
    }

    /// Returns path and value of each member of the port `port` for these flags.
    pub fn members(&self, port: &str) -> Vec<(String, u64)> {
        let others = self.others.iter().map(|&(name, set)| (name, set.into()));
        let all = [("size", self.size)].into_iter().chain(others);
        all.map(|(name, value)| (format!("{port}.{name}"), value))
            .collect()
    }
}

/// Parameters of a pass: its flags, and the values of its ports by name.
#[derive(Clone, Debug)]
pub struct Pass {
    pub flags: Flags,
    pub ports: Vec<(&'static str, u64)>,
}

impl Pass {
    pub fn get(&self, name: &str) -> u64 {
        self.ports.iter().find(|(port, _)| *port == name).unwrap().1
    }

    pub fn set(&mut self, name: &str, value: u64) {
        let port = self.ports.iter_mut().find(|(port, _)| *port == name);
        port.unwrap().1 = value;
    }

    /// Makes valid parameters of the two passes.
    pub fn good() -> [Self; 2] {
        let geometry = [
            ("geometry.mesh", BASE + 0x10_0000),
            ("geometry.mesh_bytes", 0x1000),
            ("geometry.descriptors", BASE + 0x20_0000),
            ("geometry.descriptor_limit", 1000),
            ("geometry.lists", BASE + 0x40_0000),
            ("geometry.exceptions", BASE + 0x60_0000),
            ("geometry.exception_limit", 1000),
        ];
        let raster = [
            ("raster.frame", BASE + 0x100_0000),
            ("raster.depth", BASE + 0x200_0000),
            ("raster.lists[0]", BASE + 0x40_0000),
            ("raster.lists[1]", BASE + 0x60_0000),
            ("raster.descriptors[0]", BASE + 0x20_0000),
            ("raster.descriptors[1]", BASE + 0x30_0000),
            ("raster.count[0]", 1000),
            ("raster.count[1]", 1000),
        ];
        [
            Self {
                flags: Flags {
                    size: 1,
                    others: vec![
                        ("cull", true),
                        ("smooth", false),
                        ("append", false),
                        ("mirror", false),
                        ("recolour", false),
                        ("lines", false),
                    ],
                },
                ports: geometry.to_vec(),
            },
            Self {
                flags: Flags {
                    size: 0,
                    others: vec![
                        ("first", true),
                        ("second", true),
                        ("depth", true),
                        ("slot", false),
                        ("whole", false),
                    ],
                },
                ports: raster.to_vec(),
            },
        ]
    }

    pub fn size(&self) -> usize {
        self.flags.size as usize
    }
}

/// Returns the memory regions that the module checks for a pass: the port of the address, and the length in bytes.
pub fn regions(
    which: usize,
    pass: &Pass,
    list_shift: u64,
    descriptor: u64,
) -> Vec<(&'static str, u64)> {
    let size = pass.size();
    let bands = [4, 15, 60, 60][size];
    let lists = match list_shift {
        // The region has a table of lengths, followed by the lists with gaps between them.
        0..=17 => 16 * (16 + (bands << list_shift) + 128 * bands),
        _ => 1 << 60,
    };
    let pixels = (320 * 180) << (2 * size);
    let flag = |name| pass.flags.is_set(name);
    match which {
        GEOMETRY => vec![
            ("geometry.mesh", pass.get("geometry.mesh_bytes") & !15),
            (
                "geometry.descriptors",
                descriptor * pass.get("geometry.descriptor_limit"),
            ),
            ("geometry.lists", lists),
            (
                "geometry.exceptions",
                4 * pass.get("geometry.exception_limit"),
            ),
        ],
        _ => [
            (true, "raster.frame", 2 * pixels),
            (flag("depth"), "raster.depth", 4 * pixels),
            (flag("first"), "raster.lists[0]", lists),
            (flag("second"), "raster.lists[1]", lists),
            (
                flag("first"),
                "raster.descriptors[0]",
                descriptor * pass.get("raster.count[0]"),
            ),
            (
                flag("second"),
                "raster.descriptors[1]",
                descriptor * pass.get("raster.count[1]"),
            ),
        ]
        .into_iter()
        .filter_map(|(used, name, bytes)| used.then_some((name, bytes)))
        .collect(),
    }
}

/// Limits of a build of the module.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Number of bytes of memory.
    pub memory: u64,
    /// Number of picture sizes.
    pub sizes: usize,
    /// Whether the build draws triangles.
    pub triangles: bool,
    /// Whether the build draws lines.
    pub lines: bool,
    /// Whether the build has geometry passes.
    pub geometry: bool,
}

/// Returns the error code of the expected refusal of a pass, or `NONE`.
pub fn refusal(which: usize, pass: &Pass, list_shift: u64, descriptor: u64, limits: Limits) -> u64 {
    let misplaced = |&(port, bytes): &(&str, u64)| {
        let first = pass.get(port);
        !first.is_multiple_of(16)
            || !(BASE..BASE + limits.memory).contains(&first)
            || bytes.next_multiple_of(16) > BASE + limits.memory - first
    };
    let lists = || {
        ["first", "second"]
            .iter()
            .any(|name| pass.flags.is_set(name))
    };
    let of_lines = pass.flags.is_set("lines");
    let has_triangles = match which {
        GEOMETRY => !(limits.lines && of_lines),
        _ => !limits.lines && lists(),
    };
    if !limits.triangles && has_triangles {
        TRIANGLES
    } else if !limits.lines && of_lines {
        LINES
    } else if !limits.geometry && which == GEOMETRY {
        NO_GEOMETRY
    } else if pass.size() >= limits.sizes {
        SIZE
    } else if regions(which, pass, list_shift, descriptor)
        .iter()
        .any(misplaced)
    {
        ADDRESS
    } else {
        NONE
    }
}
