//! Tests of the buffers in `gateware/rtl/common`: skid buffer and FIFO.

use glint_testbench::{Bits, Module, Sink, Source, Stalls, step};

/// Sends numbers through a buffer with stalls on both sides, and expects all of them in order. Returns the number of clocks.
fn passes_all_in_order(name: &str, source_stalls: f64, sink_stalls: f64) -> u64 {
    const COUNT: u64 = 500;
    let mut module = Module::new(name, 1);
    let mut source = Source::new(&module, "in", &["data"], Stalls::new(1, source_stalls));
    let mut sink = Sink::new(&module, "out", &["data"], Stalls::new(2, sink_stalls));
    for number in 0..COUNT {
        source.push(vec![Bits::from(number * 7 % 256)]);
    }
    while sink.items().len() < COUNT as usize {
        assert!(module.cycles() < 100 * COUNT, "{name} stalls");
        step(&mut module, &mut [&mut source], &mut [&mut sink]);
    }
    for (number, item) in (0..).zip(sink.items()) {
        assert_eq!(
            item[0],
            Bits::from(number * 7 % 256),
            "item {number} of {name}"
        );
    }
    module.cycles() - COUNT
}

#[test]
fn the_skid_buffer_keeps_order_and_passes_an_item_a_clock() {
    for (source_stalls, sink_stalls) in [(0.5, 0.5), (0.1, 0.9), (0.9, 0.1)] {
        passes_all_in_order("skid_buffer", source_stalls, sink_stalls);
    }
    let waited = passes_all_in_order("skid_buffer", 0.0, 0.0);
    assert!(waited <= 4, "{waited} clocks without an item");
}

#[test]
fn the_fifo_keeps_order_and_passes_an_item_a_clock() {
    for (name, latency) in [("fifo", 2), ("fifo_2", 2), ("fifo_block", 3)] {
        for (source_stalls, sink_stalls) in [(0.5, 0.5), (0.1, 0.9), (0.9, 0.1)] {
            passes_all_in_order(name, source_stalls, sink_stalls);
        }
        let waited = passes_all_in_order(name, 0.0, 0.0);
        assert!(
            waited <= latency + 2,
            "{name}: {waited} clocks without an item"
        );
    }
}

/// Returns the number of items that a buffer accepts while its output is blocked.
fn capacity(name: &str) -> usize {
    const MORE_THAN_FITS: usize = 50;
    let mut module = Module::new(name, 1);
    let mut source = Source::new(&module, "in", &["data"], Stalls::new(1, 0.0));
    let mut sink = Sink::new(&module, "out", &["data"], Stalls::new(2, 1.0));
    for _ in 0..MORE_THAN_FITS {
        source.push(vec![Bits::from(1)]);
    }
    for _ in 0..2 * MORE_THAN_FITS {
        step(&mut module, &mut [&mut source], &mut [&mut sink]);
    }
    MORE_THAN_FITS - source.len()
}

#[test]
fn buffers_have_the_places_they_state() {
    let places = ["skid_buffer", "fifo_2", "fifo", "fifo_block"].map(capacity);
    assert_eq!(places, [2, 3, 17, 18]);
}
