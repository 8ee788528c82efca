//! The prepass: blocks of pixels, and the constants of their cones.

/// Largest number of cones, the number of depths in the gateware's table.
const CONES: u32 = 1 << 14;

/// The constants of a frame's cones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cones {
    /// Exponent of the block size, 2, 3 or 4: blocks have 2^`block` by 2^`block` pixels.
    pub block: u32,
    /// Change of the unscaled ray direction D (docs/formats/raymarch.md, "Rays") from a block's first pixel to its
    /// middle, 30 fraction bits.
    pub offset: [i32; 3],
    /// Largest difference of D between the middle and any pixel of a block, in the maximum norm, or in the Euclidean
    /// norm for round fields: u0.18, 14 bits, rounded up.
    pub spread: u32,
}

impl Cones {
    /// The constants for blocks of 2^`block` by 2^`block` pixels, where `block` is 2 to 4. `round` selects the
    /// Euclidean norm, and `steps` is the change of D per pixel to the right and per pixel down.
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
            // Adds 2, because D is truncated to 24 bits for the middle and for a pixel, and the results of `half` are
            // truncated too.
            spread: (widest[0].max(widest[1]) >> 12) as u32 + 2,
        }
    }

    /// Amount added to the length index (see `Ray::length`) of the ray through a block's middle to get the cone's, so that every direction
    /// in the block has length 1 or less.
    pub(super) const fn margin(&self, round: bool) -> u32 {
        if round {
            // With s for the spread, (|D| + s)² − |D|² is at most 2·s + s², and s is at most 2^−4.
            (self.spread >> 7) + (self.spread >> 12) + 2
        } else {
            (self.spread >> 8) + 1
        }
    }
}

/// Exponent of the block size of a picture, 2 to 4: blocks are squares of 2^exponent pixels, the smallest for which the cones of all eyes
/// fit the table.
pub const fn block_for((width, height): (u32, u32), eyes: u32) -> u32 {
    let mut block = 2;
    while block < 4 && eyes * (width >> block) * (height >> block) > CONES {
        block += 1;
    }
    block
}
