//! Tests of the bit fields of records, compared with single bits of values.

use glint_core::bits::Bits;

/// Each field of 1 to 34 bits that begins in three words is set to the lowest bits of a value, and is read back. A field may end beyond
/// the words.
#[test]
fn fields_have_the_lowest_bits_of_a_value() {
    for (at, width) in (0..96).flat_map(|at| (1..=34).map(move |width| (at, width))) {
        let field = Bits::new(at, width, width);
        for value in [-1, 0x2_5A5A_C3C3, i64::MIN, 1 << (width - 1)] {
            let bit = |number: usize| value >> number & 1 != 0;
            let mut expected = [0_u32; 3];
            for number in 0..width.min(96 - at) {
                expected[(at + number) / 32] |= u32::from(bit(number)) << ((at + number) % 32);
            }
            let mut words = [0; 3];
            field.put(&mut words, value);
            assert_eq!(words, expected, "{value:#x} in {field:?}");
            let kept = value & ((1 << width.min(96 - at)) - 1);
            assert_eq!(field.get(&words), kept as u64, "{value:#x} in {field:?}");
        }
    }
}
