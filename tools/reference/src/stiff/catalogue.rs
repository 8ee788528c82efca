//! Reading of the catalogue.

use std::path::Path;

use anyhow::{Context, Result, bail, ensure};
use serde::Deserialize;

use super::outcome::Expected;

/// A file of the catalogue with the cases of a subject.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Subject {
    /// Title of the subject's section in the report.
    pub title: String,
    /// Whether the cases need the virtual board.
    #[serde(default)]
    pub on_virtual_board: bool,
    /// The cases.
    #[serde(rename = "case")]
    pub cases: Vec<Case>,
}

/// A case. The outcome is one of `exact`, `at_most` and `refused`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Case {
    /// Unique name.
    pub name: String,
    /// Name of the case's kind.
    pub kind: String,
    /// Input, in the form of the kind.
    pub input: toml::Value,
    /// Explanation of the input's difficulty or of the outcome.
    pub why: String,
    exact: Option<String>,
    at_most: Option<f64>,
    refused: Option<String>,
}

impl Case {
    /// The expected outcome.
    ///
    /// # Errors
    /// The case has no outcome, or several.
    pub fn expected(&self) -> Result<Expected> {
        match (&self.exact, self.at_most, &self.refused) {
            (Some(text), None, None) => Ok(Expected::Exact(text.clone())),
            (None, Some(bound), None) => Ok(Expected::AtMost(bound)),
            (None, None, Some(message)) => Ok(Expected::Refused(message.clone())),
            _ => bail!("{}: expected one of exact, at_most and refused", self.name),
        }
    }
}

/// Reads all files of a folder, in the order of their names.
///
/// # Errors
/// A file does not have the form of the catalogue, or a case has no explanation or the name of another case.
pub fn read(folder: &Path) -> Result<Vec<Subject>> {
    let entries =
        std::fs::read_dir(folder).with_context(|| format!("cannot read {}", folder.display()))?;
    let mut paths = entries
        .map(|entry| Ok(entry?.path()))
        .collect::<Result<Vec<_>>>()?;
    paths.sort();
    let subject = |path: &std::path::PathBuf| {
        let text = std::fs::read_to_string(path)?;
        parse(&text)
    };
    let subjects = paths
        .iter()
        .map(|path| subject(path).with_context(|| path.display().to_string()))
        .collect::<Result<Vec<_>>>()?;
    let mut names = std::collections::BTreeSet::new();
    for case in subjects.iter().flat_map(|subject| &subject.cases) {
        ensure!(names.insert(&case.name), "two cases named {:?}", case.name);
    }
    Ok(subjects)
}

fn parse(text: &str) -> Result<Subject> {
    let subject: Subject = toml::from_str(text)?;
    for case in &subject.cases {
        ensure!(
            !case.why.is_empty(),
            "{}: expected a non-empty `why`",
            case.name
        );
        case.expected()?;
    }
    Ok(subject)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_case_is_explained_and_has_one_expectation() {
        let read = |why: &str, outcome: &str| {
            let case = format!("[[case]]\nname = 'a'\nkind = 'b'\ninput = 1\nwhy = '{why}'\n");
            parse(&format!("title = 'x'\n{case}{outcome}"))
        };
        assert!(read("because", "exact = '1'").is_ok());
        assert!(read("", "exact = '1'").is_err());
        assert!(read("because", "").is_err());
        assert!(read("because", "exact = '1'\nrefused = '2'").is_err());
        assert!(read("because", "exact = '1'\nmore = 2").is_err());
    }
}
