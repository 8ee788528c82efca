//! The catalogue of stiff cases: inputs at which systems of this kind fail, why each is hard, and the expected outcome.
//!
//! A file of `tools/reference/stiff` holds the cases of a subject; [`catalogue`] reads it. A case names a kind, and [`kinds`] has
//! a function for each kind, which runs the code on the case's input. The report's experiment `stiff` runs all cases.

pub mod catalogue;
pub mod kind;
pub mod kinds;
pub mod outcome;
