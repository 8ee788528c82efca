//! Parses the TOML of a scene file into keys, and values as arguments of console commands.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::error::{SceneError, Source, quote};
use crate::keys::names;

/// A value of the file, and its location.
type Value<'a> = Spanned<DeValue<'a>>;

/// The keys and values of a file.
pub struct File<'a> {
    pub source: Source<'a>,
    table: DeTable<'a>,
}

impl<'a> File<'a> {
    /// Reads a file, and checks the names of its keys.
    ///
    /// # Errors
    /// The text is not TOML, or contains an unknown key.
    pub fn read(source: Source<'a>) -> Result<Self, SceneError> {
        let table = DeTable::parse(source.text).map_err(|error| match error.span() {
            Some(span) => source.error(&span, error.message()),
            None => source.whole(error.message()),
        })?;
        let table = table.into_inner();
        match table
            .keys()
            .find(|key| names().all(|name| name != *key.get_ref()))
        {
            Some(key) => {
                let known = names().collect::<Vec<_>>().join(", ");
                let message = format!("{}: expected a key, one of {known}", quote(key.get_ref()));
                Err(source.error(&key.span(), message))
            }
            None => Ok(Self { source, table }),
        }
    }

    /// The value of a key.
    pub fn get(&self, key: &str) -> Option<&Value<'a>> {
        self.table.get(key)
    }

    /// Whether the file contains a key.
    pub fn has(&self, key: &str) -> bool {
        self.get(key).is_some()
    }

    /// The value of a key whose type is text.
    ///
    /// # Errors
    /// The value has another type.
    pub fn text(&self, key: &str) -> Result<Option<&str>, SceneError> {
        self.get(key)
            .map(|value| self.string(key, value))
            .transpose()
    }

    /// The value of a key whose type is a list of texts.
    ///
    /// # Errors
    /// The value has another type.
    pub fn texts(&self, key: &str) -> Result<Vec<(&str, Range<usize>)>, SceneError> {
        let Some(value) = self.get(key) else {
            return Ok(Vec::new());
        };
        let DeValue::Array(list) = value.get_ref() else {
            return Err(self.refuse(key, value, "a list of texts"));
        };
        let texts = list
            .iter()
            .map(|value| Ok((self.string(key, value)?, value.span())));
        texts.collect()
    }

    fn string<'v>(&self, key: &str, value: &'v Value) -> Result<&'v str, SceneError> {
        match value.get_ref() {
            DeValue::String(text) => Ok(text),
            _ => Err(self.refuse(key, value, "a text in quotation marks")),
        }
    }

    /// The value of a Boolean key.
    ///
    /// # Errors
    /// The value has another type.
    pub fn switch(&self, key: &str) -> Result<Option<bool>, SceneError> {
        let switch = |value: &Value| match value.get_ref() {
            DeValue::Boolean(on) => Ok(*on),
            _ => Err(self.refuse(key, value, "true or false")),
        };
        self.get(key).map(switch).transpose()
    }

    /// The value of a key whose type is a positive number.
    ///
    /// # Errors
    /// The value has another type.
    pub fn number(&self, key: &str) -> Result<Option<f64>, SceneError> {
        let number =
            |value| positive(value).ok_or_else(|| self.refuse(key, value, "a number above 0"));
        self.get(key).map(number).transpose()
    }

    /// The members of a key whose type is a table of positive numbers.
    ///
    /// # Errors
    /// The value or a member has another type, or a member has a name that is not in `known`.
    pub fn numbers(
        &self,
        key: &str,
        known: &[&'static str],
    ) -> Result<Vec<(&'static str, f64)>, SceneError> {
        let Some(value) = self.get(key) else {
            return Ok(Vec::new());
        };
        let DeValue::Table(table) = value.get_ref() else {
            return Err(self.refuse(key, value, "a table of numbers"));
        };
        let members = table.iter().map(|(name, value)| {
            let found = known
                .iter()
                .find(|known| **known == name.get_ref().as_ref());
            let found = found.ok_or_else(|| {
                let message = format!(
                    "{key}: {}: expected one of {}",
                    quote(name.get_ref()),
                    known.join(", ")
                );
                self.source.error(&name.span(), message)
            })?;
            let number = positive(value);
            let number = number
                .ok_or_else(|| self.refuse(&format!("{key}.{found}"), value, "a number above 0"))?;
            Ok((*found, number))
        });
        members.collect()
    }

    /// The arguments of a console command in a value, or in each member of a list.
    ///
    /// # Errors
    /// The value, or a member of a list, is not a valid argument or list of arguments.
    pub fn words(
        &self,
        key: &str,
        value: &Value,
        is_list: bool,
    ) -> Result<Vec<(String, Range<usize>)>, SceneError> {
        let expected = if is_list {
            "a text, or a list of texts"
        } else {
            "a text, a number, true or false"
        };
        let words = match value.get_ref() {
            DeValue::String(text) => text.split_ascii_whitespace().collect::<Vec<_>>().join(" "),
            DeValue::Integer(number) if number.radix() == 10 => number.as_str().to_owned(),
            DeValue::Float(number) => number.as_str().to_owned(),
            DeValue::Boolean(on) => glint_core::choice::switch_name(*on).to_owned(),
            DeValue::Array(list) if is_list => {
                let members = list.iter().map(|member| self.words(key, member, false));
                return Ok(members.collect::<Result<Vec<_>, _>>()?.concat());
            }
            _ => return Err(self.refuse(key, value, expected)),
        };
        if words.is_empty() {
            return Err(self.refuse(key, value, expected));
        }
        Ok(vec![(words, value.span())])
    }

    /// The error of a value that is not the `expected` one.
    pub fn refuse(&self, key: &str, value: &Value, expected: &str) -> SceneError {
        let found = self.source.text.get(value.span()).unwrap_or_default();
        let message = format!("{key}: {}: expected {expected}", quote(found));
        self.source.error(&value.span(), message)
    }
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
