//! Tests of loads and stores at unused addresses: the emulated board counts bus errors and waits
//! like the verilated SoC.

use emulated_board::EmulatedBoard;
use litex_pac::ctrl;
use litex_pac::memories::MAIN_RAM;
use virtual_board::{Simulation, Uart};
use virtual_board::{Start, VirtualBoard};

use crate::program::assemble;

/// Address of the program's results.
const RESULTS: u32 = MAIN_RAM.base + 0x1000;
/// Number of accesses.
const ACCESSES: usize = 4;
/// Number of words of results: two before the first access, two after each access, and one at the end.
const WORDS: usize = 2 * ACCESSES + 3;

/// Clock cycles until the bus answers an access.
const TIMEOUT: u32 = 1_000_000;
/// Number of cycles between two polls of the results.
const SLICE: u64 = 500_000;
/// Maximum number of cycles until the results are complete.
const LIMIT: u64 = 40_000_000;

/// For each access, the bus's count of errors, and the duration in time-outs. `run` runs a board for some cycles and
/// reads the results.
fn counts(mut run: impl FnMut(u64, &mut [u8])) -> Vec<[u32; 2]> {
    let mut bytes = [0; 4 * WORDS];
    for _ in 0..LIMIT / SLICE {
        run(SLICE, &mut bytes);
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
    let expected = counts(|cycles, bytes| {
        emulated.run(cycles);
        emulated.read_memory(RESULTS, bytes).expect("main memory");
    });
    assert_eq!(expected.len(), ACCESSES);
    let start = Start::Fast { firmware: &image };
    let mut verilated = VirtualBoard::builder()
        .start(start)
        .build()
        .expect("a virtual board");
    let found = counts(|cycles, bytes| {
        verilated.run(cycles);
        verilated.ddr_read(RESULTS, bytes).expect("main memory");
    });
    assert_eq!(found, expected);
}
