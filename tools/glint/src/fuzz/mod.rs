//! Fuzzing without a compiler of its own: seeds made by code, a small mutator, and for each input only its number.
//!
//! Input `i` of a seed is always the same bytes, whatever thread makes it, so a run can be spread and a finding repeated.

mod corpus;
mod mutate;
mod targets;

pub use mutate::MAX_INPUT;
pub use targets::{Outcome, Target};

use mutate::{Random, mutate};

/// The inputs of one target.
pub struct Inputs {
    target: Target,
    seed: u64,
    corpus: Vec<Vec<u8>>,
}

impl Inputs {
    /// Makes the corpus of a target.
    pub fn new(target: Target, seed: u64) -> Self {
        Self {
            target,
            seed,
            corpus: corpus::of(target),
        }
    }

    /// The input of a number, at most [`MAX_INPUT`] bytes.
    pub fn input(&self, number: u64) -> Vec<u8> {
        let mut random = Random::new(self.seed, number);
        let mut input = mutate(&self.corpus, self.target.words(), &mut random);
        // Checksums stop nearly every mutation at the door; half of the inputs get theirs put right.
        if random.below(2) == 0 {
            self.target.repair(&mut input);
        }
        input.truncate(MAX_INPUT);
        input
    }

    /// Makes the input of a number and gives it to the target. A panic is the caller's to catch.
    pub fn run(&self, number: u64) -> Outcome {
        self.target.run(&self.input(number))
    }
}
