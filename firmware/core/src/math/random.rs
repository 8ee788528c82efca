//! Random numbers for tests.

/// A sequence of random numbers of all lengths, by a linear congruential generator; the same for the same `seed`.
pub fn lengths(seed: u64) -> impl FnMut() -> u64 {
    let mut state = seed;
    move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        state.rotate_right(29) >> (state >> 58)
    }
}
