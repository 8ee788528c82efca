//! Fuzzing without compiler instrumentation: generated seeds, a small mutator, numbered inputs.
//!
//! The bytes of an input depend only on its seed and its number, so runs can be divided among
//! threads, and findings can be repeated.

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
        // Nearly every mutation is rejected because of its checksum, so the checksums of half of
        // the inputs are corrected.
        if random.below(2) == 0 {
            self.target.repair(&mut input);
        }
        input.truncate(MAX_INPUT);
        input
    }

    /// Runs the target on the input `number`, and returns whether the target has accepted the
    /// input. The caller catches panics.
    pub fn run(&self, number: u64) -> bool {
        self.target.run(&self.input(number))
    }
}
