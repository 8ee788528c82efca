//! Tests of loads and stores at unused addresses: the emulated board counts bus errors and waits
//! like the verilated SoC.

use emulated_board::EmulatedBoard;
use litex_pac::ctrl;
use litex_pac::memories::MAIN_RAM;
use virtual_board::Simulation;

use crate::firmware::preloaded;
use crate::program::assemble;

/// Address of the program's results.
const RESULTS: u32 = MAIN_RAM.base + 0x1000;
/// Number of accesses to unused addresses.
const ACCESSES: usize = 4;
/// Number of words of results: two before the first access, two after each access, and one at the end.
const WORDS: usize = 2 * ACCESSES + 3;

/// Clock cycles until the bus answers an access.
const TIMEOUT: u32 = 1_000_000;
/// Number of cycles between two polls of the results.
const SLICE: u64 = 500_000;
/// Maximum number of cycles until the results are complete.
const LIMIT: u64 = 40_000_000;

/// Runs the program on a board. Returns for each access the increment of the count of bus errors,
/// and the duration in time-outs.
fn counts(board: &mut impl Simulation) -> Vec<[u32; 2]> {
    let mut bytes = [0; 4 * WORDS];
    for _ in 0..LIMIT / SLICE {
        board.run(SLICE);
        board.read_memory(RESULTS, &mut bytes).expect("main RAM");
        let (words, _) = bytes.as_chunks();
        let words: Vec<u32> = words.iter().map(|&word| u32::from_le_bytes(word)).collect();
        if words[WORDS - 1] != 0 {
            let pairs = words.as_chunks::<2>().0.windows(2);
            return pairs
                .map(|pair| [0, 1].map(|place| pair[1][place] - pair[0][place]))
                .map(|[count, cycles]| [count, cycles / TIMEOUT])
                .collect();
        }
    }
    panic!("no results within {LIMIT} cycles");
}

#[test]
fn accesses_to_unused_addresses_count_and_wait_alike() {
    let image = assemble(
        "unused",
        &[
            (
                "BUS_ERRORS",
                ctrl::Ctrl::BASE as u32 + ctrl::offset::BUS_ERRORS,
            ),
            ("RESULTS", RESULTS),
            // The first of these addresses is in the data cache, the second is not.
            ("UNUSED", 0x2000_0000),
            ("UNUSED_IO", 0x9000_0000),
        ],
    );
    let mut emulated = EmulatedBoard::fast(&image).expect("an image that fits");
    let expected = counts(&mut emulated);
    assert_eq!(expected.len(), ACCESSES);
    assert_eq!(counts(&mut preloaded(&image)), expected);
}
