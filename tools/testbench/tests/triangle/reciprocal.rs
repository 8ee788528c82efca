//! Compares the reciprocal of the triangle setup with the model.

use glint_model::triangle::reciprocal::recip;
use glint_testbench::Module;

#[test]
fn reciprocals() {
    let (first, last) = (1u32 << 23, (1 << 24) - 1);
    let ends = (0..256).flat_map(|i| {
        let from = first + (i << 15);
        [from, from + 1, from + (1 << 15) - 1]
    });
    let numbers: Vec<u32> = (first..=last).step_by(509).chain(ends).collect();
    let mut module = Module::new("reciprocal", 1);
    let [in_valid, in_ready, in_m, out_valid, out_y] =
        ["in_valid", "in_ready", "in_m", "out_valid", "out_y"].map(|name| module.port(name));
    let mut left = numbers.iter();
    let mut next = left.next();
    let mut found = Vec::new();
    while found.len() < numbers.len() {
        let cycles = module.cycles();
        assert!(cycles < 10 * numbers.len() as u64 + 20, "{cycles} clocks");
        module.set(in_valid, u64::from(next.is_some()));
        module.set(in_m, u64::from(next.copied().unwrap_or(0)));
        module.settle();
        if module.is_high(in_ready) {
            next = left.next();
        }
        if module.is_high(out_valid) {
            found.push(module.value(out_y));
        }
        module.clock();
    }
    for (&m, y) in numbers.iter().zip(found) {
        assert_eq!(y, u64::from(recip(m)), "reciprocal of {m:#x}");
    }
}
