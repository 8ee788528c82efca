//! 1 − exp(−dt/τ): what a first-order filter takes of a new value after a time dt, however long it was.

/// The shortest time constant, in µs.
pub const SHORTEST: u32 = 1_000;

/// The gains of a time constant.
#[derive(Clone, Copy, Debug)]
pub struct Gain {
    time_constant: u32,
    /// 2^48 over the time constant.
    inverse: u64,
    /// The last step and its gain, since most steps are alike.
    last: (u32, u32),
}

impl Gain {
    /// Of a time constant in µs; those below [`SHORTEST`] count as that.
    pub fn new(time_constant: u32) -> Self {
        let time_constant = time_constant.max(SHORTEST);
        let inverse = (1 << 48) / u64::from(time_constant);
        Self {
            time_constant,
            inverse,
            last: (0, 0),
        }
    }

    /// The time constant in µs.
    pub const fn time_constant(&self) -> u32 {
        self.time_constant
    }

    /// The gain of a step in µs, of which those beyond 2^19 count as that: 32 fraction bits, within 4 units and 2^−16 of it where τ is at most 1000 s. A gain
    /// that would round to 1 is 1 − 2^−32.
    pub fn of(&mut self, step: u32) -> u32 {
        let step = step.min(1 << 19);
        if step != self.last.0 {
            // The inverse is below 2^39.
            let part = (u64::from(step) * self.inverse + (1 << 15)) >> 16;
            self.last = (step, approach(part));
        }
        self.last.1
    }
}

/// 1 − exp(−x), both with 32 fraction bits.
fn approach(x: u64) -> u32 {
    // Below 1/16 the series has five terms; beyond, as often as x was halved, 1 − (1 − y)² = 2y − y² doubles it.
    let halvings = x.checked_ilog2().map_or(0, |lead| lead.saturating_sub(27));
    if halvings > 9 {
        return u32::MAX;
    }
    let mut y = series((x >> halvings) as u32);
    for _ in 0..halvings {
        y = 2 * y - ((y * y) >> 32);
    }
    y.min(u32::MAX.into()) as u32
}

/// 1 − exp(−x) for x < 1/16: x·(1 − x/2·(1 − x/3·(1 − x/4·(1 − x/5)))), of which the next term is below 2^−33.
fn series(x: u32) -> u64 {
    let x = u64::from(x);
    let part = |n: u64| (x * ((1 << 32) / n)) >> 32;
    let inner = (1 << 32) - part(5);
    let inner = (1 << 32) - ((part(4) * inner) >> 32);
    let inner = (1 << 32) - ((part(3) * inner) >> 32);
    let inner = (1 << 32) - ((part(2) * inner) >> 32);
    (x * inner + (1 << 31)) >> 32
}
