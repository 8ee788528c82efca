//! Mutator of bytes and text.

/// Maximum length of an input in bytes.
pub const MAX_INPUT: usize = 4096;

/// Random numbers from SplitMix64 (Steele, Lea and Flood, 2014): any seed is valid, and neighbouring numbers give unrelated
/// streams.
pub struct Random(u64);

impl Random {
    /// The random stream of a seed and a number.
    pub fn new(seed: u64, number: u64) -> Self {
        let mut random = Self(seed);
        let start = random.next() ^ number.wrapping_mul(0xd134_2543_de82_ef95);
        Self(start)
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number below `limit`; 0 if `limit` is 0.
    pub fn below(&mut self, limit: usize) -> usize {
        (self.next() % (limit as u64).max(1)) as usize
    }

    fn pick<'a, T>(&mut self, items: &'a [T]) -> Option<&'a T> {
        items.get(self.below(items.len()))
    }
}

/// Texts of numbers near the limits of types, infinity and NaN.
const WORDS: &str = "0 1 -1 2 255 256 65535 65536 2147483647 2147483648 4294967295 4294967296 -2147483649 9223372036854775808 nan inf \
                     1e300 -1e-320 1e30 0.5";
const BYTES: [u8; 10] = [0, 1, 0x0a, 0x0d, 0x1b, 0x20, 0x7f, 0x80, 0xfe, 0xff];

/// Returns a random element of the corpus with one to eight mutations.
pub fn mutate(corpus: &[Vec<u8>], words: &[&str], random: &mut Random) -> Vec<u8> {
    let numbers: Vec<&str> = WORDS.split(' ').collect();
    let mut input = random.pick(corpus).cloned().unwrap_or_default();
    for _ in 0..=random.below(8) {
        match random.below(12) {
            0 => replace_range(&mut input, random, |_, _| Vec::new()),
            1 => insert_copy(&mut input, random),
            2 => {
                let other = random.pick(corpus).cloned().unwrap_or_default();
                let part = range(other.len(), random);
                replace_range(&mut input, random, |_, _| other[part].to_vec());
            }
            3 => {
                let length = random.below(input.len() + 1);
                input.truncate(length);
            }
            4 => replace_range(&mut input, random, |_, random| {
                random.next().to_le_bytes().to_vec()
            }),
            5 | 6 => replace_word(&mut input, random, &numbers),
            7 | 8 => replace_word(&mut input, random, words),
            9 => change_byte(&mut input, random, |_, random| {
                random.pick(&BYTES).copied().unwrap_or(0)
            }),
            10 => change_byte(&mut input, random, |byte, random| {
                byte.wrapping_add(random.below(7) as u8).wrapping_sub(3)
            }),
            _ => change_byte(&mut input, random, |byte, random| {
                byte ^ 1 << random.below(8)
            }),
        }
        input.truncate(MAX_INPUT);
    }
    input
}

/// Returns a random, mostly short range within `length` bytes.
fn range(length: usize, random: &mut Random) -> std::ops::Range<usize> {
    let start = random.below(length + 1);
    let longest = if random.below(4) == 0 {
        length - start
    } else {
        (length - start).min(16)
    };
    start..start + random.below(longest + 1)
}

fn replace_range(
    input: &mut Vec<u8>,
    random: &mut Random,
    by: impl FnOnce(&[u8], &mut Random) -> Vec<u8>,
) {
    let range = range(input.len(), random);
    let new = by(&input[range.clone()], random);
    input.splice(range, new);
}

fn insert_copy(input: &mut Vec<u8>, random: &mut Random) {
    let part = input[range(input.len(), random)].to_vec();
    let at = random.below(input.len() + 1);
    let times = 1 + random.below(8);
    input.splice(at..at, part.repeat(times));
}

fn change_byte(input: &mut [u8], random: &mut Random, to: impl FnOnce(u8, &mut Random) -> u8) {
    let at = random.below(input.len());
    if let Some(byte) = input.get_mut(at) {
        *byte = to(*byte, random);
    }
}

/// Replaces the token at a random position of the input by a random token of `words`. A token longer than 64 bytes is not
/// replaced.
fn replace_word(input: &mut Vec<u8>, random: &mut Random, words: &[&str]) {
    let Some(word) = random.pick(words) else {
        return;
    };
    let is_break = |byte: &u8| byte.is_ascii_whitespace() || matches!(*byte, b'/' | b',');
    let at = random.below(input.len());
    let start = input[..at]
        .iter()
        .rposition(is_break)
        .map_or(0, |before| before + 1);
    let end = input[at..]
        .iter()
        .position(is_break)
        .map_or(input.len(), |length| at + length);
    if end - start.min(end) <= 64 {
        input.splice(start.min(end)..end, word.bytes());
    }
}
