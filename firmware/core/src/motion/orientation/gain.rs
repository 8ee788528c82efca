//! The gain 1 − exp(−dt/τ) of a first-order filter with the time constant τ, for a step dt of any length.

/// The shortest time constant, in µs.
pub const SHORTEST: u32 = 1_000;

/// Computes the gains of a filter with a given time constant, for steps of different lengths.
#[derive(Clone, Copy, Debug)]
pub struct Gain {
    time_constant: u32,
    /// 2^48 divided by the time constant.
    inverse: u64,
    /// The length of the last step in µs, and its gain. Storing them saves the computation, because most steps have the same
    /// length.
    last: (u32, u32),
}

impl Gain {
    /// Prepares the gains for a time constant in µs; values below [`SHORTEST`] saturate.
    pub fn new(time_constant: u32) -> Self {
        let time_constant = time_constant.max(SHORTEST);
        Self {
            time_constant,
            inverse: inverse(time_constant),
            last: (0, 0),
        }
    }

    /// The time constant in µs.
    pub const fn time_constant(&self) -> u32 {
        self.time_constant
    }

    /// Computes the gain of a step of `step` µs, which saturates to 2^19. The gain has 32 fraction bits; its error is at most 4
    /// units plus 2^−16 of the gain for τ up to 1000 s. A gain that would round to 1 is 1 − 2^−32.
    pub fn of(&mut self, step: u32) -> u32 {
        if step != self.last.0 {
            self.last = (step, self.fresh(step));
        }
        self.last.1
    }

    /// Computes the gain of a step whose length differs from that of the last step.
    #[inline(never)]
    fn fresh(&self, step: u32) -> u32 {
        // `self.inverse` is below 2^39, so the product fits 64 bits.
        let part = (u64::from(step.min(1 << 19)) * self.inverse + (1 << 15)) >> 16;
        match u32::try_from(part) {
            Ok(part) if part < SMALL => series(part),
            _ => approach(part),
        }
    }
}

/// Computes 2^48 divided by a time constant, rounded down. Below 2^24 µs (16.8 s) a few 32-bit divisions replace
/// the slow 64-bit division.
fn inverse(time_constant: u32) -> u64 {
    if time_constant >= 1 << 24 {
        return (1 << 48) / u64::from(time_constant);
    }
    let mut quotient = u64::from((1 << 31) / time_constant);
    let mut rest = (1 << 31) % time_constant;
    // Long division appends 8, 8 and 1 bits to the quotient. The remainder is below 2^24, so the shifted remainder fits 32 bits.
    for bits in [8, 8, 1] {
        let number = rest << bits;
        quotient = quotient << bits | u64::from(number / time_constant);
        rest = number % time_constant;
    }
    quotient
}

/// Arguments of `series` are below this limit: 1/16 with 32 fraction bits.
const SMALL: u32 = 1 << 28;

/// Computes 1 − exp(−x) for any x; argument and result have 32 fraction bits.
#[cold]
#[inline(never)]
fn approach(x: u64) -> u32 {
    // x is halved until it is below 1/16, where a series of five terms suffices. With y = 1 − exp(−x), the result for 2x is then
    // 1 − (1 − y)² = 2y − y²; this step undoes each halving.
    let halvings = x.checked_ilog2().map_or(0, |lead| lead.saturating_sub(27));
    if halvings > 9 {
        return u32::MAX;
    }
    let mut y = u64::from(series((x >> halvings) as u32));
    for _ in 0..halvings {
        y = 2 * y - ((y * y) >> 32);
    }
    y.min(u32::MAX.into()) as u32
}

/// Computes 1 − exp(−x) for x < 1/16 as x·(1 − x/2·(1 − x/3·(1 − x/4·(1 − x/5)))). Argument and result have 32 fraction bits. The
/// first omitted term is below 2^−33.
fn series(x: u32) -> u32 {
    let times = |a: u32, b: u32| ((u64::from(a) * u64::from(b)) >> 32) as u32;
    let part = |n: u32| times(x, ((1 << 32) / u64::from(n)) as u32);
    // Evaluates a bracket of the series, from the innermost bracket outwards: part·(1 − deficit), rounded down, where `deficit` is 1
    // minus the inner bracket.
    let less = |part: u32, deficit: u32| {
        part - ((u64::from(part) * u64::from(deficit) + u64::from(u32::MAX)) >> 32) as u32
    };
    let deficit = less(part(4), part(5));
    let deficit = less(part(3), deficit);
    let deficit = less(part(2), deficit);
    // The result x·(1 − deficit) is rounded to nearest.
    let taken = u64::from(x) * u64::from(deficit);
    x - ((taken + (1 << 31) - 1) >> 32) as u32
}
