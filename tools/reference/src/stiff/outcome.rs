//! Outcomes of cases: expected and measured.

use std::fmt;

/// Measured outcome of a case.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// A reproducible result.
    Exact(String),
    /// An error against the exact result, and its unit.
    Error(f64, &'static str),
    /// A refusal of the input with this message.
    Refused(String),
}

impl Outcome {
    /// Converts the result of a function that may refuse its input. `text` formats an accepted result.
    pub fn of<T, E: ToString>(result: Result<T, E>, text: impl FnOnce(T) -> String) -> Self {
        match result {
            Ok(value) => Self::Exact(text(value)),
            Err(error) => Self::Refused(error.to_string()),
        }
    }

    /// The result `text`.
    pub fn exact(text: impl Into<String>) -> Self {
        Self::Exact(text.into())
    }
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Exact(text) => f.write_str(text),
            Self::Error(error, "") => write!(f, "{}", Figures(*error)),
            Self::Error(error, unit) => write!(f, "{} {unit}", Figures(*error)),
            Self::Refused(message) => write!(f, "refused: {message}"),
        }
    }
}

/// Expected outcome of a case.
#[derive(Clone, Debug, PartialEq)]
pub enum Expected {
    /// This result.
    Exact(String),
    /// An error of at most this number.
    AtMost(f64),
    /// A refusal with this message.
    Refused(String),
}

impl Expected {
    /// Whether an outcome meets the expectation.
    pub fn holds(&self, outcome: &Outcome) -> bool {
        match (self, outcome) {
            (Self::Exact(expected), Outcome::Exact(found))
            | (Self::Refused(expected), Outcome::Refused(found)) => expected == found,
            (Self::AtMost(bound), Outcome::Error(error, _)) => error <= bound,
            _ => false,
        }
    }
}

/// A number with three significant figures.
struct Figures(f64);

impl fmt::Display for Figures {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self.0.abs() {
            0.0 => f.write_str("0"),
            x if (0.01..1000.0).contains(&x) => {
                let places = 2 - x.log10().floor() as i32;
                write!(f, "{:.*}", places.max(0) as usize, self.0)
            }
            _ => write!(f, "{:.2e}", self.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_outcome_must_be_of_the_expected_form() {
        let exact = |text: &str| Outcome::exact(text);
        assert!(Expected::Exact("a".into()).holds(&exact("a")));
        assert!(!Expected::Exact("a".into()).holds(&exact("b")));
        assert!(!Expected::Exact("a".into()).holds(&Outcome::Refused("a".into())));
        assert!(!Expected::Refused("a".into()).holds(&exact("a")));
        assert!(Expected::AtMost(1.0).holds(&Outcome::Error(1.0, "")));
        assert!(!Expected::AtMost(1.0).holds(&Outcome::Error(1.1, "")));
        assert!(!Expected::AtMost(1.0).holds(&Outcome::Error(f64::NAN, "")));
        assert!(!Expected::AtMost(1.0).holds(&exact("0")));
    }

    #[test]
    fn errors_have_three_figures() {
        let shown = |x| Outcome::Error(x, "pixel").to_string();
        assert_eq!(shown(0.0), "0 pixel");
        assert_eq!(shown(0.123_45), "0.123 pixel");
        assert_eq!(shown(123.45), "123 pixel");
        assert_eq!(shown(1.234e-9), "1.23e-9 pixel");
    }
}
