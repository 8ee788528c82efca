//! Kinds of cases.

use anyhow::{Context, Result};
use serde::de::DeserializeOwned;

use super::outcome::Outcome;

/// A kind of cases: its name in the catalogue, and the function that runs a case on its input.
pub struct Kind {
    /// Name in the catalogue.
    pub name: &'static str,
    run: Box<dyn Fn(toml::Value) -> Result<Outcome> + Send + Sync>,
}

impl Kind {
    /// Makes a kind for inputs of the type `I`.
    pub fn new<I: DeserializeOwned + 'static>(
        name: &'static str,
        run: fn(I) -> Result<Outcome>,
    ) -> Self {
        Self {
            name,
            run: Box::new(move |input| run(input.try_into().context("input")?)),
        }
    }

    /// Runs a case.
    ///
    /// # Errors
    /// The input does not have the form of this kind, or the case cannot be run.
    pub fn run(&self, input: toml::Value) -> Result<Outcome> {
        (self.run)(input)
    }
}
