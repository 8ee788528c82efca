//! Fuzzing without compiler instrumentation: generated seeds, a small mutator, numbered inputs.
//!
//! The seed and the number of an input determine its bytes in any thread, so runs can be split and findings repeated.

mod corpus;
mod firmware;
mod flash;
mod gltf;
mod host;
mod mutate;
mod targets;
mod transfer;

pub use mutate::{MAX_INPUT, Random};
pub use targets::Target;

use mutate::mutate;

/// The inputs of one target.
pub struct Inputs {
    target: Target,
    seed: u64,
    corpus: Vec<Vec<u8>>,
    words: Vec<&'static str>,
}

impl Inputs {
    /// Creates the inputs of a target from its corpus; `seed` selects the mutations.
    pub fn new(target: Target, seed: u64) -> Self {
        Self {
            target,
            seed,
            corpus: corpus::of(target),
            words: target.words(),
        }
    }

    /// The input `number`, with at most [`MAX_INPUT`] bytes.
    pub fn input(&self, number: u64) -> Vec<u8> {
        let mut random = Random::new(self.seed, number);
        let mut input = mutate(&self.corpus, &self.words, &mut random);
        // Without a correct checksum nearly every mutation is rejected, so half of the inputs get one.
        if random.below(2) == 0 {
            self.target.repair(&mut input);
        }
        input.truncate(MAX_INPUT);
        input
    }

    /// Runs the target on the input with a number, and returns whether it has accepted the input. The caller catches panics.
    pub fn run(&self, number: u64) -> bool {
        self.target.run(&self.input(number))
    }
}
