//! Tests of programs: text form, binary form, and every error.

use glint_core::fixed::Q5_11;
use glint_core::wireframe::text::{assemble, lines_after_end, parse_line};
use glint_core::wireframe::{Instruction, Program, WORD_BYTES, Window};
use proptest::prelude::*;

use super::{point, q, viewing};

const TEXT: &str = "\
# a triangle
eye 0 0 8
plane 4
window -4 -2.25 4 2.25   # 16:9

segment -1 -1 0  1 -1 0
segment 1 -1 0  0 1 0
segment 0 1 0  -1 -1 0
end
";

fn word(opcode: u128, fields: [u16; 6]) -> [u8; WORD_BYTES] {
    let bits = fields
        .iter()
        .fold(opcode, |bits, &field| bits << 16 | u128::from(field));
    bits.to_le_bytes()
}

#[test]
fn a_program_has_the_same_meaning_in_both_forms() {
    let bytes = assemble(TEXT).expect("a good program");
    let program = Program::new_checked(&bytes).expect("a good program");
    assert_eq!(
        *program.viewing(),
        viewing([0.0, 0.0, 8.0], 4.0, [-4.0, -2.25, 4.0, 2.25])
    );
    assert_eq!(program.segment_count(), 3);
    let corners = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]].map(point);
    assert!(
        program
            .segments()
            .eq((0..3).map(|i| [corners[i], corners[(i + 1) % 3]]))
    );
    assert_eq!(program.bytes(), bytes);
    let text: String = program
        .instructions()
        .map(|line| format!("{line}\n"))
        .collect();
    assert_eq!(assemble(&text), Ok(bytes));
}

#[test]
fn the_fields_are_at_the_bits_of_the_original() {
    let one = 0x0800;
    let two = 0x1000;
    let minus = 0xFFFF;
    let cases = [
        (
            word(0b000, [one, two, minus, 0, 0, 0]),
            Instruction::Eye([q(1.0), q(2.0), Q5_11::from_bits(-1)]),
        ),
        (
            word(0b001, [minus, 0, 0, 0, 0, 0]),
            Instruction::Plane(Q5_11::from_bits(-1)),
        ),
        (
            word(0b010, [minus, 0, one, two, 0, 0]),
            Instruction::Window(Window {
                low: [Q5_11::from_bits(-1), q(0.0)],
                high: [q(1.0), q(2.0)],
            }),
        ),
        (
            word(0b100, [1, 2, 3, 4, 5, 6]),
            Instruction::Segment([[1, 2, 3], [4, 5, 6]].map(|ends| ends.map(Q5_11::from_bits))),
        ),
        (word(0b111, [u16::MAX; 6]), Instruction::End),
    ];
    for (word, instruction) in cases {
        assert_eq!(Instruction::decode(&word), Ok(instruction));
        assert_eq!(instruction.encode(), word);
    }
    // A word of 99 ones is an end; the opcode of a segment with 96 ones is a segment.
    assert_eq!(
        Instruction::End.encode(),
        ((1_u128 << 99) - 1).to_le_bytes()
    );
    assert_eq!(
        Instruction::decode(&word(0b100, [u16::MAX; 6])),
        Ok(Instruction::Segment([[Q5_11::from_bits(-1); 3]; 2]))
    );
    assert_eq!(
        Instruction::decode(&word(0b111, [0; 6])),
        Ok(Instruction::End)
    );
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2_000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn segments_come_back_from_both_forms(bits in any::<[i16; 6]>()) {
        let [a, b, c, d, e, f] = bits.map(Q5_11::from_bits);
        let segment = Instruction::Segment([[a, b, c], [d, e, f]]);
        prop_assert_eq!(Instruction::decode(&segment.encode()), Ok(segment));
        let line = segment.to_string();
        prop_assert_eq!(parse_line(&line), Ok(Some(segment)));
    }

    #[test]
    fn every_accepted_word_is_the_word_of_its_instruction(bits in any::<u128>(), zeros in any::<[bool; 6]>()) {
        let masked = zeros.iter().fold(0, |mask: u128, &zero| mask << 16 | if zero { 0 } else { 0xFFFF });
        let word = (bits & (masked | 7 << 96)).to_le_bytes();
        if let Ok(instruction) = Instruction::decode(&word) && instruction != Instruction::End {
            prop_assert_eq!(instruction.encode(), word);
        }
    }

    #[test]
    fn no_text_upsets_the_parser(text in "(eye|plane|window|segment|end|#|[-+0-9.e ]{0,8}|\n| ){0,40}") {
        if let Err(error) = assemble(&text) {
            let error = error.to_string();
            prop_assert!(error.contains("expected ") && !error.contains('\n'), "{}", error);
        }
    }
}

/// Texts, with `|` in place of line feeds, and their errors.
const MISTAKES: &str = r#"
 => line 1: expected end, found the end of the input
eye 0 0 8||# no end| => line 4: expected end, found the end of the input
camera 0 0 8| => line 1: expected eye, plane, window, segment or end, found "camera" (column 1)
|eye 0 0| => line 2: expected 3 numbers after eye, found 2
plane| => line 1: expected 1 number after plane, found 0
plane 1 2| => line 1: expected the end of the line, found "2" (column 9)
eye 0 0 16| => line 1: expected a number from -16 to 15.9995, found "16" (column 9)
eye 0 nan 1| => line 1: expected a number from -16 to 15.9995, found "nan" (column 7)
eye 0 0 -0.001| => line 1: expected a z of the eye of at least 0, found -0.001
plane 2|eye 0 0 2| => line 2: expected a z of the eye above that of the view plane, 2, found 2
eye 0 0 1|plane 2| => line 2: expected a z of the eye above that of the view plane, 2, found 1
window 1 0 1 1| => line 1: expected x of the window's lower corner below 1, found 1
window 0 2 1 1.5| => line 1: expected y of the window's lower corner below 1.5, found 2
eye 0 0 1|eye 0 0 1| => line 2: expected one eye in the program, found a second one
eye 0 0 1|plane 0|end| => line 3: expected one window in the program, found none
"#;

#[test]
fn refused_texts() {
    for (text, message) in MISTAKES.lines().filter_map(|line| line.split_once(" => ")) {
        let text = text.replace('|', "\n");
        let error = assemble(&text).expect_err(&text).to_string();
        assert_eq!(error, format!("wireframe program, {message}"), "{text:?}");
    }
}

#[test]
fn what_follows_the_end_is_ignored() {
    let good = assemble(TEXT).expect("a good program");
    let program = Program::new_checked(&good).expect("a good program");
    assert_eq!(program.ignored(), 0);
    for surplus in [&[0; 5][..], &[0xff; 16], &good] {
        let bytes = [&good[..], surplus].concat();
        let longer = Program::new_checked(&bytes).expect("the same program");
        assert_eq!(longer.ignored(), surplus.len());
        assert_eq!(longer.bytes(), good);
        assert_eq!(longer.word_count(), program.word_count());
    }
    assert_eq!(lines_after_end(TEXT), 0);
    let longer = format!("{TEXT}\n# comment\n\nno instruction\nend\n");
    assert_eq!(assemble(&longer).as_deref(), Ok(&good[..]));
    assert_eq!(lines_after_end(&longer), 2);
}

#[test]
fn refused_words() {
    let good = assemble(TEXT).expect("a good program");
    let with = |index: usize, word: [u8; WORD_BYTES]| {
        let mut bytes = good.clone();
        bytes[WORD_BYTES * index..][..WORD_BYTES].copy_from_slice(&word);
        bytes
    };
    let cases: Vec<(Vec<u8>, &str)> = vec![
        (vec![], "word 1: expected end, found the end of the input"),
        (
            good[..80].to_vec(),
            "word 6: expected end, found the end of the input",
        ),
        (
            good[..85].to_vec(),
            "word 6: expected a word of 16 bytes, found 5 bytes",
        ),
        (
            with(3, word(0b011, [0; 6])),
            "word 4: expected an opcode (bits 98 to 96) of 000, 001, 010, 100 or 111, found 011",
        ),
        (
            with(3, word(0b1100, [0; 6])),
            "word 4: expected zeros in bits 127 to 99, found 0x1",
        ),
        (
            with(0, word(0b000, [0, 0, 0x4000, 0, 7, 0])),
            "word 1: expected zeros in the unused bits 31 to 16 of eye, found 0x7",
        ),
        (
            with(6, word(0b111, [u16::MAX, u16::MAX, 0, 0, 0, 0])),
            "word 7: expected zeros in the unused bits 95 to 80 of end, or ones in bits 95 to 0, found 0xffff",
        ),
        (
            with(1, word(0b001, [0x4000, 0, 0, 0, 0, 0])),
            "word 2: expected a z of the eye above that of the view plane, 8, found 8",
        ),
        (
            with(0, word(0b000, [0, 0, 0x8000, 0, 0, 0])),
            "word 1: expected a z of the eye of at least 0, found -16",
        ),
        (
            with(2, word(0b010, [0x8000, 0, 0x8000, 1, 0, 0])),
            "word 3: expected x of the window's lower corner below -16, found -16",
        ),
        (
            with(3, word(0b010, [0, 0, 1, 1, 0, 0])),
            "word 4: expected one window in the program, found a second one",
        ),
        (
            with(2, word(0b100, [0; 6])),
            "word 7: expected one window in the program, found none",
        ),
    ];
    for (bytes, message) in cases {
        let error = Program::new_checked(&bytes).expect_err(message).to_string();
        assert_eq!(error, format!("wireframe program, {message}"));
    }
}
