//! The catalogue of stiff cases: inputs on which such systems typically fail, each with an explanation and the expected outcome.
//!
//! Each file of `tools/reference/stiff` has the cases of a subject; [`catalogue`] reads the files. A case names its kind; [`kinds`] has a
//! function for each kind, which runs the code on the case's input. The report's experiment `stiff` runs all cases.

pub mod catalogue;
pub mod kind;
pub mod kinds;
pub mod outcome;
