//! Cones before the rays: their blocks and constants.

/// Entries of the table of depths.
const CONES: u32 = 1 << 14;

/// The constants of a frame's cones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cones {
    /// Blocks are of 2^this pixels each way: 2, 3, 4.
    pub block: u32,
    /// What D grows by from a block's first pixel to its middle, 30 fraction bits.
    pub offset: [i32; 3],
    /// The most by which D differs from the middle's anywhere in a block, in the norm of the rays, u0.18, 14 bits, rounded up.
    pub spread: u32,
}

impl Cones {
    /// The cones of blocks of 2^`block` pixels each way, 2 to 4. `steps` is the change of D for a pixel to the right and one down.
    pub fn new(block: u32, round: bool, steps: &[[i32; 3]; 2]) -> Self {
        let block = block.clamp(2, 4);
        let [across, down] = steps.map(|step| step.map(i64::from));
        let half = |sum: i64| (sum * ((1 << block) - 1)) >> 1;
        let diagonals = [1, -1]
            .map(|sign| [0, 1, 2].map(|i: usize| half((across[i] + sign * down[i]).abs()) as u64));
        let widest = diagonals.map(|diagonal| {
            if round {
                diagonal.map(|part| part * part).iter().sum::<u64>().isqrt()
            } else {
                diagonal.into_iter().fold(0, u64::max)
            }
        });
        Self {
            block,
            offset: [0, 1, 2].map(|i: usize| half(across[i] + down[i]) as i32),
            // D is cut to 24 bits, both that of the middle and that of a pixel; halves are cut too.
            spread: (widest[0].max(widest[1]) >> 12) as u32 + 2,
        }
    }

    /// What the entry of a cone's length is larger by than that of its middle: no direction in its block gets longer than 1.
    pub(super) const fn margin(&self, round: bool) -> u32 {
        if round {
            // (|D| + s)² − |D|² is at most 2·s + s², of which s is at most 2^−4.
            (self.spread >> 7) + (self.spread >> 12) + 2
        } else {
            (self.spread >> 8) + 1
        }
    }
}

/// Blocks of a picture: the smallest whose cones for all eyes fit the table, 2^this pixels each way.
pub(super) const fn block_for((width, height): (u32, u32), eyes: u32) -> u32 {
    let mut block = 2;
    while block < 4 && eyes * (width >> block) * (height >> block) > CONES {
        block += 1;
    }
    block
}
