//! Converts names, numbers and texts of the SoC's description to Rust's notation.

/// Keywords of Rust among the names in the gateware: they cannot be names of functions.
const KEYWORDS: [&str; 5] = ["in", "loop", "mod", "type", "use"];

/// Converts a name to Rust's form for types: `ev_pending` becomes `EvPending`.
pub fn camel(name: &str) -> String {
    name.split('_')
        .map(|part| {
            let mut letters = part.chars();
            letters.next().map_or(String::new(), |first| {
                first.to_ascii_uppercase().to_string() + letters.as_str()
            })
        })
        .collect()
}

/// Returns `name`, or `name_` if `name` is a keyword of Rust.
pub fn identifier(name: &str) -> String {
    if KEYWORDS.contains(&name) {
        format!("{name}_")
    } else {
        name.to_owned()
    }
}

/// Formats a number like `0x4000_0000`.
pub fn hex(value: u32) -> String {
    if value >> 16 == 0 {
        format!("{value:#x}")
    } else {
        format!("{:#06x}_{:04x}", value >> 16, value & 0xffff)
    }
}

/// Formats a number like `81_250_000`.
pub fn decimal(value: u32) -> String {
    let digits = value.to_string();
    let groups: Vec<_> = digits
        .as_bytes()
        .rchunks(3)
        .rev()
        .map(String::from_utf8_lossy)
        .collect();
    groups.join("_")
}

/// Escapes a description for rustdoc, which would read brackets outside code as links and tags.
pub fn documented(description: &str) -> String {
    let parts = description.split('`').enumerate().map(|(index, part)| {
        if index % 2 == 1 {
            return part.to_owned();
        }
        part.replace('[', "\\[")
            .replace(']', "\\]")
            .replace('<', "\\<")
            .replace('>', "\\>")
    });
    parts.collect::<Vec<_>>().join("`")
}

/// Turns a phrase into a sentence: `no error` becomes `No error.`.
pub fn sentence(text: &str) -> String {
    let mut letters = text.trim_end_matches('.').chars();
    letters.next().map_or(String::new(), |first| {
        format!("{}{}.", first.to_uppercase(), letters.as_str())
    })
}
