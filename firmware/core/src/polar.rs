//! The length and the angle of a vector of two numbers, by CORDIC in vectoring mode (Volder, 1959).
//!
//! Each of 36 steps turns the vector towards the positive first axis by an angle whose tangent is a power of two, and
//! adds up the angles. There is no singularity: the angle of a vector along an axis is exact, and that of a vector of
//! length 0 is 0.

use crate::fixed::Turns;
use crate::trig::PI_Q60;

/// Steps; after them the vector is within atan(2^−35) of the axis.
const STEPS: usize = 36;
/// atan(2^−i) for i = 0…35, in units of 2^−48 turns, to the nearest.
static ANGLES: [u64; STEPS] = angles();
/// Factor that undoes the lengthening by the steps, ∏ cos(atan(2^−i)), with 32 fraction bits.
const SHORTENING: u64 = 0x9B74_EDA8;

/// The bit that the larger of the two numbers has in front of the steps. They lengthen the vector, by at most
/// √2·1.6468, so nothing leaves 64 bits.
const LEAD: u32 = 60;

/// The length of (x, y), in its units, and the angle from the first axis towards the second.
///
/// The angle is at most 0.53 units (2^−32 turns) off, as long as the vector is at least 2^32 units long; the length 1 unit
/// and 2^−31 of it. Numbers beyond ±2^61 count as ±2^61.
pub fn polar(x: i64, y: i64) -> (i64, Turns) {
    const LIMIT: i64 = 1 << 61;
    let [x, y] = [x, y].map(|number| number.clamp(-LIMIT, LIMIT));
    let Some(lead) = (x.unsigned_abs() | y.unsigned_abs()).checked_ilog2() else {
        return (0, Turns(0));
    };
    let up = LEAD.saturating_sub(lead);
    let down = lead.saturating_sub(LEAD);
    let [mut x, mut y] = [x, y].map(|number| (number >> down) << up);
    let mut angle: u64 = 0;
    if x < 0 {
        (x, y) = (-x, -y);
        angle = 1 << 47;
    }
    for (i, &step) in ANGLES.iter().enumerate() {
        let (right, turned) = (x >> i, y >> i);
        if y > 0 {
            (x, y) = (x + turned, y - right);
            angle = angle.wrapping_add(step);
        } else if y < 0 {
            (x, y) = (x - turned, y + right);
            angle = angle.wrapping_sub(step);
        } else if i == 0 {
            // A vector along the axis is neither turned nor lengthened.
            return ((x >> up) << down, Turns((angle >> 16) as u32));
        } else {
            // The lengths of the steps have to be those of SHORTENING; the last of them are too short to matter.
            (x, y) = (x + turned, y - right);
            angle = angle.wrapping_add(step);
        }
    }
    // In two products, of which none leaves 64 bits.
    let (upper, lower) = (x as u64 >> 32, x as u64 & u64::from(u32::MAX));
    let length = upper * SHORTENING + ((lower * SHORTENING) >> 32);
    (
        ((length >> up) << down) as i64,
        Turns((angle.wrapping_add(1 << 15) >> 16) as u32),
    )
}

/// The table, by the Taylor series of the arcus tangent with 60 fraction bits.
const fn angles() -> [u64; STEPS] {
    let mut table = [1 << 45; STEPS];
    let mut i = 1;
    while i < STEPS {
        let (mut sum, mut n) = (0_i128, 1);
        let mut sign = 1;
        while i as u32 * n <= 60 {
            sum += sign * ((1_i128 << (60 - i as u32 * n)) / n as i128);
            sign = -sign;
            n += 2;
        }
        let turn = 2 * PI_Q60;
        table[i] = (((sum as u128) << 48) + turn / 2).div_euclid(turn) as u64;
        i += 1;
    }
    table
}
