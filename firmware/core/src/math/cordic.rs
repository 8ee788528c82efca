//! The length and the angle of a vector in the plane, by CORDIC in vectoring mode (Volder, 1959).
//!
//! Each of 36 steps turns the vector towards the positive first axis by an angle whose tangent is a power of two; the sum of
//! these angles is the result. The angle of a vector along an axis is exact. The angle of a vector of length 0 is 0.

use crate::fixed::Turns;
use crate::trig::PI_Q60;

/// Number of steps. After the last step the vector is within atan(2^−35) of the positive first axis.
const STEPS: usize = 36;
/// The angles of the steps: atan(2^−i) for i = 0…35, in units of 2^−48 turns, rounded to nearest.
static ANGLES: [u64; STEPS] = angles();
/// Factor that compensates the growth of the vector's length by all steps: ∏ cos(atan(2^−i)), with 32 fraction bits.
const SHORTENING: u64 = 0x9B74_EDA8;

/// Number of the highest bit of the larger component after scaling, which precedes the steps. The steps
/// enlarge a component by a factor of at most √2·1.6468, so all numbers fit 64 bits.
const LEAD: u32 = 60;

/// Computes the length of the vector (x, y) in the units of its components, and its angle from the first
/// axis towards the second axis.
///
/// The error of the angle is at most 0.53·2^−32 turns for lengths of at least 2^32 units; the error of the length is at most 1
/// unit plus 2^−31 of the length. Components saturate to ±2^61.
pub fn to_polar(x: i64, y: i64) -> (i64, Turns) {
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
            // A vector along the first axis needs no steps, and its length is exact.
            return ((x >> up) << down, Turns((angle >> 16) as u32));
        } else {
            // `SHORTENING` compensates the growth by all steps, so every step must run, even for a vector that already lies
            // on the axis.
            (x, y) = (x + turned, y - right);
            angle = angle.wrapping_add(step);
        }
    }
    // The product is computed in two parts, each of which fits 64 bits.
    let (upper, lower) = (x as u64 >> 32, x as u64 & u64::from(u32::MAX));
    let length = upper * SHORTENING + ((lower * SHORTENING) >> 32);
    (
        ((length >> up) << down) as i64,
        Turns((angle.wrapping_add(1 << 15) >> 16) as u32),
    )
}

/// Computes the table `ANGLES` by the Taylor series of the arctangent, with 60 fraction bits.
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
