//! Markdown templates of pages, in which placeholders are replaced by figures and tables.

use std::path::Path;

use anyhow::{Context, Result, ensure};

/// Replaces each placeholder `{{name}}` of a template by the value with this name.
///
/// # Errors
/// When a value has no placeholder, or a placeholder has no value.
pub fn fill(template: &str, values: &[(&str, String)]) -> Result<String> {
    let mut text = template.to_owned();
    for (name, value) in values {
        let placeholder = format!("{{{{{name}}}}}");
        ensure!(text.contains(&placeholder), "no placeholder {placeholder}");
        text = text.replace(&placeholder, value.trim_end());
    }
    let open = text.split_once("{{").map(|(_, rest)| rest);
    let left = open.and_then(|rest| rest.split_once("}}"));
    ensure!(
        left.is_none(),
        "no value for the placeholder {:?}",
        left.map(|(name, _)| name)
    );
    Ok(text)
}

/// Writes the text of a page to a file.
///
/// # Errors
/// When the file cannot be written.
pub fn write(text: &str, path: &Path) -> Result<()> {
    std::fs::write(path, text).with_context(|| format!("cannot write {}", path.display()))
}

/// Returns the last line of a page, which names the commit and the tools with which its figures were measured.
pub fn made(commit: &str, tools: &str) -> String {
    format!("Made at commit {commit} with {tools}.")
}

#[cfg(test)]
mod tests {
    use super::fill;

    #[test]
    fn every_placeholder_needs_a_value_and_every_value_a_placeholder() {
        let value = |name: &'static str| [(name, "1\n".to_owned())];
        assert_eq!(
            fill("a {{b}} c", &value("b")).ok().as_deref(),
            Some("a 1 c")
        );
        assert!(fill("a {{b}} {{c}}", &value("b")).is_err());
        assert!(fill("a", &value("b")).is_err());
    }
}
