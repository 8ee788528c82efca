//! Parses the TOML of a scene file: its keys, and its values as arguments of console commands.

use std::cell::RefCell;
use std::ops::Range;

use glint_core::console::Row;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::error::{SceneError, Source, Violation, quote, resembled, unknown};
use crate::keys::names;

/// Maximum number of violations in a report. An additional line states how many more exist.
const MAX_VIOLATIONS: usize = 20;

/// A value of the file, and its location.
pub type Value<'a> = Spanned<DeValue<'a>>;

/// The keys and values of a file, with the violations found so far. A value that violates the format counts as missing.
pub struct File<'a> {
    pub source: Source<'a>,
    table: DeTable<'a>,
    /// The known keys that the misspelt keys of the file resemble.
    meant: Vec<&'static str>,
    /// Lines that are not TOML.
    damaged: Vec<Option<usize>>,
    violations: RefCell<Vec<Violation>>,
}

impl<'a> File<'a> {
    /// Reads a file, and checks the names of its keys.
    pub fn read(source: Source<'a>) -> Self {
        let (table, errors) = DeTable::parse_recoverable(source.text);
        let mut violations: Vec<_> = errors
            .iter()
            .map(|error| source.violation(error.span().as_ref(), error.message()))
            .collect();
        // One damaged line may cause several errors.
        violations.dedup_by_key(|violation| violation.line);
        let damaged = violations.iter().map(|violation| violation.line).collect();
        let mut file = Self {
            source,
            table: table.into_inner(),
            meant: Vec::new(),
            damaged,
            violations: RefCell::new(violations),
        };
        for key in file.table.keys() {
            if names().all(|name| name != *key.get_ref()) {
                file.meant.extend(resembled(key.get_ref(), names()));
                file.add(
                    &key.span(),
                    unknown(key.get_ref(), "a key", names().collect::<Vec<_>>()),
                );
            }
        }
        file
    }

    /// Adds a violation at a position of the file.
    pub fn add(&self, span: &Range<usize>, message: impl Into<String>) {
        let violation = self.source.violation(Some(span), message);
        // A damaged line already has a violation.
        if !self.damaged.contains(&violation.line) {
            self.violations.borrow_mut().push(violation);
        }
    }

    /// Adds a violation for a missing key, unless the file has a misspelt key or a damaged line,
    /// which may be the missing key.
    pub fn add_missing(&self, message: &str) {
        if self.damaged.is_empty() && self.meant.is_empty() {
            let violation = self.source.violation(None, message);
            self.violations.borrow_mut().push(violation);
        }
    }

    /// Adds a violation for a value; `expected` describes the allowed values.
    pub fn refuse(&self, key: &str, value: &Value, expected: &str) {
        let found = self.source.text.get(value.span()).unwrap_or_default();
        let message = format!("{key}: {}: expected {expected}", quote(found));
        self.add(&value.span(), message);
    }

    /// Checks that the file has no violations.
    ///
    /// # Errors
    /// All violations, in the order of the file.
    pub fn check(self) -> Result<(), SceneError> {
        let mut violations = self.violations.into_inner();
        if violations.is_empty() {
            return Ok(());
        }
        violations.sort_by_key(|violation| violation.line);
        let further = violations.len().saturating_sub(MAX_VIOLATIONS);
        if further > 0 {
            violations.truncate(MAX_VIOLATIONS);
            violations.push(
                self.source
                    .violation(None, format!("{further} further errors")),
            );
        }
        let file = self.source.file.to_owned();
        Err(SceneError { file, violations })
    }

    /// The value of a key.
    pub fn get(&self, key: &str) -> Option<&Value<'a>> {
        self.table.get(key)
    }

    /// Whether the file contains a key, or a misspelt form of it.
    pub fn has(&self, key: &str) -> bool {
        self.get(key).is_some() || self.meant.contains(&key)
    }

    /// Whether the file contains one of these keys.
    pub fn has_any(&self, keys: &[&str]) -> bool {
        keys.iter().any(|key| self.has(key))
    }

    /// The value of a key whose type is text.
    pub fn text(&self, key: &str) -> Option<&str> {
        self.string(key, self.get(key)?)
    }

    /// The value of a key whose type is a list of texts.
    pub fn texts(&self, key: &str) -> Vec<(&str, Range<usize>)> {
        let Some(value) = self.get(key) else {
            return Vec::new();
        };
        let DeValue::Array(list) = value.get_ref() else {
            self.refuse(key, value, "a list of texts");
            return Vec::new();
        };
        let texts = list.iter();
        let texts = texts.filter_map(|value| Some((self.string(key, value)?, value.span())));
        texts.collect()
    }

    fn string<'v>(&self, key: &str, value: &'v Value) -> Option<&'v str> {
        match value.get_ref() {
            DeValue::String(text) => Some(text),
            _ => {
                self.refuse(key, value, "a text in quotation marks");
                None
            }
        }
    }

    /// The value of a Boolean key.
    pub fn switch(&self, key: &str) -> Option<bool> {
        let value = self.get(key)?;
        match value.get_ref() {
            DeValue::Boolean(on) => Some(*on),
            _ => {
                self.refuse(key, value, "true or false");
                None
            }
        }
    }

    /// The value of a key whose type is a positive number.
    pub fn number(&self, key: &str) -> Option<f64> {
        self.positive(key, self.get(key)?)
    }

    fn positive(&self, key: &str, value: &Value) -> Option<f64> {
        let number = positive(value);
        if number.is_none() {
            self.refuse(key, value, "a number above 0");
        }
        number
    }

    /// The members of a key whose type is a table of positive numbers with names from `known`.
    pub fn numbers(&self, key: &str, known: &[&'static str]) -> Vec<(&'static str, f64)> {
        let Some(value) = self.get(key) else {
            return Vec::new();
        };
        let DeValue::Table(table) = value.get_ref() else {
            self.refuse(key, value, "a table of numbers");
            return Vec::new();
        };
        let members = table.iter().filter_map(|(name, value)| {
            let mut found = known.iter();
            let Some(&found) = found.find(|known| **known == name.get_ref().as_ref()) else {
                let known = known.iter().copied();
                let message = unknown(name.get_ref(), "a limit", known);
                self.add(&name.span(), format!("{key}: {message}"));
                return None;
            };
            Some((found, self.positive(&format!("{key}.{found}"), value)?))
        });
        members.collect()
    }

    /// The command arguments in the value of a key; if the value is a list, those of each member.
    pub fn words(&self, row: &Row) -> Vec<(String, Range<usize>)> {
        let (key, is_list) = (row.key(), row.forms.is_list);
        let Some(value) = self.get(key) else {
            return Vec::new();
        };
        const ONE: &str = "a text, a number, true or false";
        let (members, expected): (Vec<&Value>, _) = match value.get_ref() {
            DeValue::Array(list) if is_list => (list.iter().collect(), ONE),
            _ if is_list => (vec![value], "a text, or a list of texts"),
            _ => (vec![value], ONE),
        };
        let words = members.into_iter().filter_map(|member| {
            let words = words(member);
            if words.is_none() {
                self.refuse(key, member, &format!("{expected}{}", such_as(row)));
            }
            Some((words?, member.span()))
        });
        words.collect()
    }

    /// The command arguments in the value of a key. A wrong value adds no violation.
    pub fn peek(&self, row: &Row) -> Option<String> {
        words(self.get(row.key())?)
    }
}

/// Converts a value to the arguments of a console command.
fn words(value: &Value) -> Option<String> {
    let words = match value.get_ref() {
        DeValue::String(text) => text.split_ascii_whitespace().collect::<Vec<_>>().join(" "),
        DeValue::Integer(number) if number.radix() == 10 => number.as_str().to_owned(),
        DeValue::Float(number) => number.as_str().to_owned(),
        DeValue::Boolean(on) => glint_core::choice::switch_name(*on).to_owned(),
        _ => return None,
    };
    Some(words).filter(|words| !words.is_empty())
}

/// An example of a key's value, for messages.
pub fn such_as(row: &Row) -> String {
    let example = row.forms.example;
    let is_number = example.parse::<f64>().is_ok();
    let marks = if is_number { "" } else { "\"" };
    format!(", such as {} = {marks}{example}{marks}", row.key())
}

fn positive(value: &Value) -> Option<f64> {
    let text = match value.get_ref() {
        DeValue::Integer(number) if number.radix() == 10 => number.as_str(),
        DeValue::Float(number) => number.as_str(),
        _ => return None,
    };
    let number: f64 = text.parse().ok()?;
    (number.is_finite() && number > 0.0).then_some(number)
}
