//! Counters of an accelerator, identified by name, so that a new counter in the gateware requires
//! no change of the host program.

use std::fmt;

use serde::de::{IgnoredAny, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Names and values of an accelerator's counters, in the order in which the board prints them. Empty for a frame that was drawn
/// without an accelerator.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Counters(Vec<(String, u64)>);

/// Error for a counter that the board did not print: the counter's name, and the printed names.
#[derive(Debug, thiserror::Error)]
#[error("expected the counter `{0}` in the board's statistics, found {1}")]
pub struct MissingCounter(String, String);

impl Counters {
    /// Whether there are no counters.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The value of a counter.
    ///
    /// # Errors
    /// No counter has this name.
    pub fn get(&self, name: &str) -> Result<u64, MissingCounter> {
        let found = self.0.iter().find(|(known, _)| known == name);
        found.map(|(_, value)| *value).ok_or_else(|| {
            let names: Vec<_> = self.0.iter().map(|(name, _)| name.as_str()).collect();
            MissingCounter(name.to_owned(), names.join(", "))
        })
    }
}

impl Serialize for Counters {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(name, value)| (name, value)))
    }
}

/// A value in the board's statistics. Only numbers are counters; texts are skipped.
#[derive(Deserialize)]
#[serde(untagged)]
enum Entry {
    Count(u64),
    Other(IgnoredAny),
}

impl<'de> Deserialize<'de> for Counters {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Pairs;

        impl<'de> Visitor<'de> for Pairs {
            type Value = Counters;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("numbers by name")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Counters, A::Error> {
                let mut pairs = Vec::new();
                while let Some((name, entry)) = map.next_entry()? {
                    if let Entry::Count(value) = entry {
                        pairs.push((name, value));
                    }
                }
                Ok(Counters(pairs))
            }
        }

        deserializer.deserialize_map(Pairs)
    }
}

#[cfg(test)]
mod tests {
    use super::Counters;

    #[test]
    fn counters_keep_their_order() {
        let text = r#"{"cycles_busy":7,"any_other":1,"cycles":9}"#;
        let with_text = text.replace("}", r#","fallback":"too many"}"#);
        let counters: Counters = serde_json::from_str(&with_text).unwrap();
        assert_eq!(counters.get("any_other").unwrap(), 1);
        assert_eq!(serde_json::to_string(&counters).unwrap(), text);
        let missing = counters.get("items").unwrap_err().to_string();
        assert!(missing.contains("`items`") && missing.contains("cycles_busy, any_other"));
    }
}
