//! Check of the four data lines of a flash by bytes with known values.

use core::array;
use core::fmt;

use super::{CONTENTS, MAGIC, SYNC, SYNC_WITHIN};

/// Number of data lines.
const LINES: usize = 4;

/// State of the data lines of a flash, as shown by bytes that were read from it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DataLines {
    /// All lines carry their data.
    Right,
    /// All bits were read as 1: the flash is erased or does not answer.
    Erased,
    /// The lines are exchanged: entry k is the number of the line that carries the data of line k.
    Exchanged([u8; LINES]),
    /// Lines 2 and 3 carry no data.
    Two,
    /// No known word was read. The value is the word at the start of the contents, with the first byte in
    /// the highest bits.
    Unknown(u32),
}

impl fmt::Display for DataLines {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Right => f.write_str("all data lines carry their data"),
            Self::Erased => f.write_str("all bits read as 1: erased, or no answer"),
            Self::Exchanged([a, b, c, d]) => write!(
                f,
                "data of the lines 0 1 2 3 on the lines {a} {b} {c} {d}, expected the same order"
            ),
            Self::Two => f.write_str("no data on the lines 2 and 3, expected the QE bit set"),
            Self::Unknown(word) => write!(
                f,
                "{word:#010x} at {CONTENTS:#x}, expected a bitstream or the contents of an image"
            ),
        }
    }
}

/// Compares the `bytes` of a flash with the words that a bitstream and the contents of an image begin with.
pub fn data_lines(bytes: &[u8]) -> DataLines {
    let slot = bytes.get(..SYNC_WITHIN).unwrap_or(bytes);
    let contents: &[u8; 4] = (bytes.get(CONTENTS..))
        .and_then(<[u8]>::first_chunk)
        .unwrap_or(&[0xff; 4]);
    let words = slot.windows(SYNC.len()).filter_map(<[u8]>::first_chunk);
    let words = words.map(|word| (word, SYNC));
    let words = words.chain([(contents, MAGIC)]);
    let is_erased = slot.iter().chain(contents).all(|byte| *byte == 0xff);
    let unknown = if is_erased {
        DataLines::Erased
    } else {
        DataLines::Unknown(u32::from_be_bytes(*contents))
    };
    let mut result = unknown;
    for (found, known) in words {
        match compare(found, known) {
            Some(DataLines::Right) => return DataLines::Right,
            Some(fault) if result == unknown => result = fault,
            _ => {}
        }
    }
    result
}

/// State of the data lines that explains why `found` was read in place of `known`; `None` if no state
/// does.
fn compare(found: &[u8; 4], known: [u8; 4]) -> Option<DataLines> {
    let (found, known) = (carried(found), carried(&known));
    if found == known {
        return Some(DataLines::Right);
    }
    let [a, b, c, d] = known.map(|bits| found.iter().position(|line| *line == bits));
    if let (Some(a), Some(b), Some(c), Some(d)) = (a, b, c, d) {
        return Some(DataLines::Exchanged([a, b, c, d].map(|line| line as u8)));
    }
    let ([a, b, rest @ ..], [c, d, ..]) = (found, known);
    let is_constant = |bits: u8| matches!(bits, 0 | 0xff);
    (a == c && b == d && rest.into_iter().all(is_constant)).then_some(DataLines::Two)
}

/// The bits that each line carries for a word. Line k carries the bits k + 4 and k of a byte.
fn carried(word: &[u8; 4]) -> [u8; LINES] {
    array::from_fn(|line| {
        word.iter().fold(0, |bits, byte| {
            bits << 2 | (byte >> (line + 4) & 1) << 1 | byte >> line & 1
        })
    })
}
