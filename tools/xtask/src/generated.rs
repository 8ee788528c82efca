//! Generated files that are committed.

use std::fs;

use anyhow::{Context, Result, bail};

use crate::paths;

/// Writes generated files, each given by its path from the root of the checkout and its text. With `check`, writes nothing and compares
/// the files with the texts. The error message names `command`, the command line that writes the files.
///
/// # Errors
/// A file cannot be written, or (with `check`) is stale.
pub fn write(files: &[(&str, String)], command: &str, check: bool) -> Result<()> {
    for (path, text) in files {
        let absolute = paths::root().join(path);
        if check {
            let committed = fs::read_to_string(&absolute).with_context(|| {
                format!("reading {} (`{command}` writes it)", absolute.display())
            })?;
            if let Some(difference) = first_difference(&committed, text) {
                bail!("{path} is stale: {difference}; run `{command}` and commit the files");
            }
        } else {
            fs::write(&absolute, text)
                .with_context(|| format!("writing {}", absolute.display()))?;
            println!("wrote {path}");
        }
    }
    Ok(())
}

/// Describes the first line in which the text `have` differs from `want`; `None` when they are equal.
fn first_difference(have: &str, want: &str) -> Option<String> {
    if have == want {
        return None;
    }
    let (mut have, mut want) = (have.lines(), want.lines());
    let mut line = 1;
    loop {
        match (have.next(), want.next()) {
            (Some(a), Some(b)) if a == b => line += 1,
            (None, None) => return Some("it differs in its line ends".to_owned()),
            (a, b) => {
                let shown = |side: Option<&str>| {
                    side.map_or("the end".to_owned(), |text| format!("`{text}`"))
                };
                return Some(format!(
                    "line {line} is {}, expected {}",
                    shown(a),
                    shown(b)
                ));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::first_difference;

    #[test]
    fn names_the_first_line_that_differs() {
        assert_eq!(first_difference("a\nb\n", "a\nb\n"), None);
        assert_eq!(
            first_difference("a\nb\n", "a\nc\n").unwrap(),
            "line 2 is `b`, expected `c`"
        );
        assert_eq!(
            first_difference("a\n", "a\nc\n").unwrap(),
            "line 2 is the end, expected `c`"
        );
        assert_eq!(
            first_difference("a", "a\n").unwrap(),
            "it differs in its line ends"
        );
    }
}
