//! A pass of an engine: the results are computed at the start of the pass, and the pass ends after its estimated time.

/// The increments of a block's counters, in the order of the registers.
pub type Growth<const N: usize> = [u32; N];

/// A running pass.
#[derive(Clone, Copy, Debug)]
pub struct Pass<const N: usize> {
    /// The cycle in which the pass started.
    pub start: u64,
    /// The cycle in which the pass ends.
    pub end: u64,
    /// Increments of the block's counters.
    pub growth: Growth<N>,
}

impl<const N: usize> Pass<N> {
    /// The increments of the counters up to the cycle `now`. Counters increase evenly during the pass.
    pub fn grown(&self, now: u64) -> Growth<N> {
        let (done, whole) = (now.saturating_sub(self.start), self.end - self.start);
        if done >= whole {
            return self.growth;
        }
        // The product does not overflow: an increment has 32 bits, and a pass takes less than 2^32
        // cycles.
        self.growth
            .map(|growth| (u64::from(growth) * done / whole) as u32)
    }
}

/// Adds increments to counters, modulo 2^32.
pub fn add<const N: usize>(counters: &mut Growth<N>, growth: &Growth<N>) {
    for (counter, growth) in counters.iter_mut().zip(growth) {
        *counter = counter.wrapping_add(*growth);
    }
}
