//! Tests of the buffers in `gateware/rtl/common`: skid buffer and FIFO.

use glint_testbench::{Bits, Pipe};

/// Sends numbers through a buffer with stalls on both sides, and checks that all numbers arrive in
/// order. Returns the number of clocks.
fn passes_all_in_order(name: &str, stalls: [f64; 2]) -> u64 {
    const COUNT: u64 = 500;
    let mut pipe = Pipe::new(name, 1, ("in", &["data"]), ("out", &["data"]), stalls);
    for number in 0..COUNT {
        pipe.source.push(vec![Bits::from(number * 7 % 256)]);
    }
    let is_done = |pipe: &Pipe| pipe.sink.items().len() == COUNT as usize;
    let clocks = pipe.run(100 * COUNT, is_done);
    for (number, item) in (0..).zip(pipe.sink.items()) {
        let expected = Bits::from(number * 7 % 256);
        assert_eq!(item[0], expected, "item {number} of {name}");
    }
    clocks - COUNT
}

#[test]
fn the_skid_buffer_keeps_order_and_passes_an_item_a_clock() {
    for stalls in [[0.5, 0.5], [0.1, 0.9], [0.9, 0.1]] {
        passes_all_in_order("skid_buffer", stalls);
    }
    let waited = passes_all_in_order("skid_buffer", [0.0; 2]);
    assert!(waited <= 4, "{waited} clocks without an item");
}

#[test]
fn the_fifo_keeps_order_and_passes_an_item_a_clock() {
    for (name, latency) in [("fifo", 2), ("fifo_2", 2), ("fifo_block", 3)] {
        for stalls in [[0.5, 0.5], [0.1, 0.9], [0.9, 0.1]] {
            passes_all_in_order(name, stalls);
        }
        let waited = passes_all_in_order(name, [0.0; 2]);
        assert!(
            waited <= latency + 2,
            "{name}: {waited} clocks without an item"
        );
    }
}

/// Returns the number of items accepted by a buffer with a blocked output.
fn capacity(name: &str) -> usize {
    const MORE_THAN_FITS: usize = 50;
    let mut pipe = Pipe::new(name, 1, ("in", &["data"]), ("out", &["data"]), [0.0, 1.0]);
    for _ in 0..MORE_THAN_FITS {
        pipe.source.push(vec![Bits::from(1)]);
    }
    let end = pipe.module.cycles() + 2 * MORE_THAN_FITS as u64;
    pipe.run(u64::MAX, |pipe| pipe.module.cycles() == end);
    MORE_THAN_FITS - pipe.source.len()
}

#[test]
fn buffers_have_the_places_they_state() {
    let places = ["skid_buffer", "fifo_2", "fifo", "fifo_block"].map(capacity);
    assert_eq!(places, [2, 3, 17, 18]);
}
