//! Tests of flash images: encoding, and detection of every kind of damage.

use glint_core::flash::{
    CONTENTS, Contents, DataLines, EncodeError, FIRMWARE, Image, Kind, MAX_BYTES, Piece,
    data_lines, encode,
};
use glint_core::wire::crc32;

fn piece(kind: Kind, name: &str, bytes: &[u8]) -> Piece {
    Piece {
        kind,
        name: name.to_owned(),
        bytes: bytes.to_vec(),
    }
}

fn pieces() -> Vec<Piece> {
    vec![
        piece(Kind::Mesh, "ring", &[7; 40]),
        piece(Kind::Scene, "lamp", b"size 640 360\nfield sphere:0.6\n"),
        piece(Kind::List, "demo", b"lamp\n"),
        piece(Kind::Texture, "wood", &[9; 33]),
        piece(Kind::Program, "ball.wfb", &[1; 48]),
    ]
}

fn bitstream() -> Vec<u8> {
    let mut bytes = vec![0xff; 64];
    bytes.extend([0xaa, 0x99, 0x55, 0x66, 1, 2, 3]);
    bytes
}

fn firmware() -> Vec<u8> {
    (0..1000_u32).map(|byte| (byte * 31) as u8).collect()
}

fn image() -> Vec<u8> {
    encode(&bitstream(), &firmware(), &pieces()).unwrap()
}

fn error(bytes: &[u8]) -> String {
    Image::new_checked(bytes).unwrap_err().to_string()
}

#[test]
fn an_image_has_its_parts_again() {
    let bytes = image();
    let image = Image::new_checked(&bytes).unwrap();
    assert_eq!(image.bitstream, Some(&bitstream()[..]));
    assert_eq!(image.firmware, firmware());
    let items: Vec<Piece> = image
        .contents
        .items()
        .map(|item| piece(item.kind, item.name, item.checked().unwrap()))
        .collect();
    assert_eq!(items, pieces());
    let lamp = image.contents.find(Kind::Scene, "lamp").unwrap();
    assert_eq!(lamp.text(), Ok("size 640 360\nfield sphere:0.6\n"));
    assert_eq!(image.contents.find(Kind::List, "lamp"), None);
    // A board reads the whole flash, which has erased bytes after the contents.
    let mut flash = bytes.clone();
    flash.resize(MAX_BYTES, 0xff);
    let contents = Contents::new_checked(&flash[CONTENTS..]).unwrap();
    assert_eq!(contents, image.contents);
}

/// The header before the firmware contains the length and the zlib CRC-32 that LiteX's BIOS checks.
#[test]
fn the_firmware_has_the_header_of_flash_boot() {
    let bytes = image();
    let word = |at: usize| u32::from_le_bytes(bytes[at..][..4].try_into().unwrap());
    assert_eq!(word(FIRMWARE), 1000);
    assert_eq!(word(FIRMWARE + 4), crc32(&firmware()));
    assert_eq!(crc32(b"123456789"), 0xcbf4_3926);
    assert_eq!(bytes[FIRMWARE + 8..][..1000], firmware());
}

#[test]
fn an_image_without_bitstream_and_items_is_valid() {
    let bytes = encode(&[], &firmware(), &[]).unwrap();
    let image = Image::new_checked(&bytes).unwrap();
    assert_eq!(image.bitstream, None);
    assert_eq!(image.contents.items().count(), 0);
}

#[test]
fn every_damaged_byte_outside_the_gaps_is_found() {
    let good = image();
    let length = good.len();
    let starts = [0..3, 64..68, FIRMWARE..FIRMWARE + 1008, CONTENTS..length];
    for place in starts.into_iter().flatten() {
        let mut bytes = good.clone();
        bytes[place] ^= 0x20;
        // The image has no checksum for the bitstream except its synchronisation word, because the FPGA checks the bitstream.
        let is_gap = place < 64 || bytes_between_items(&good, place);
        assert_eq!(Image::new_checked(&bytes).is_ok(), is_gap, "{place:#x}");
    }
}

/// Whether the byte is in the gap after an item.
fn bytes_between_items(good: &[u8], place: usize) -> bool {
    let mut start = CONTENTS + 16 + pieces().len() * 48;
    pieces().iter().any(|piece| {
        let end = start + piece.bytes.len();
        start = end.next_multiple_of(16);
        (end..start.min(good.len())).contains(&place)
    })
}

#[test]
fn a_truncated_image_is_refused() {
    let good = image();
    for length in (0..good.len())
        .step_by(100_003)
        .chain(good.len() - 300..good.len())
    {
        assert!(Image::new_checked(&good[..length]).is_err(), "{length}");
    }
}

#[test]
fn errors_name_place_and_expectation() {
    let damaged = |place: usize, new: &[u8]| {
        let mut bytes = image();
        bytes[place..][..new.len()].copy_from_slice(new);
        error(&bytes)
    };
    let crc = "expected the CRC-32 0x";
    let most = "expected at most 1048568 bytes of firmware, found 4294967295";
    let word = "expected an erased slot, or a bitstream with its word 0xaa995566, found 0xffffffff";
    for (place, new, at, message) in [
        (66, &[0][..], 0, word),
        (FIRMWARE, &[0xff; 4], FIRMWARE, most),
        (FIRMWARE + 8, &[1], FIRMWARE + 4, crc),
    ] {
        let message = format!("flash byte {at:#x}: {message}");
        let found = damaged(place, new);
        assert!(
            found == message || message.ends_with(crc) && found.starts_with(&message),
            "{found}"
        );
    }
}

#[test]
fn parts_that_the_format_refuses_are_not_encoded() {
    let one = |piece: Piece| encode(&[], &firmware(), &[piece]).unwrap_err().to_string();
    for name in [
        "",
        "a b",
        "a-name-of-25-characters-x",
        "a-name-of-more-than-32-characters-here",
    ] {
        let message = one(piece(Kind::List, name, b""));
        assert!(message.contains("expected a name of 1 to 24"), "{message}");
    }
    assert_eq!(
        encode(&vec![0; FIRMWARE + 1], &firmware(), &[]),
        Err(EncodeError::Long("bitstream", FIRMWARE, FIRMWARE + 1))
    );
    let large = piece(Kind::Mesh, "x", &vec![0; MAX_BYTES - CONTENTS]);
    assert!(one(large).contains("expected at most 16777216 bytes"));
}

/// The bytes as read over exchanged lines: line k of the reader is line `order[k]` of the flash, or is
/// constant for `None`. Only the bytes that the check reads are changed.
fn through_lines(bytes: &[u8], order: [Option<u32>; 4], constant: u8) -> Vec<u8> {
    let half = |half: u8| {
        (0..4).fold(0, |received, line| {
            let level = order[line].map_or(constant, |line| half >> line & 1);
            received | level << line
        })
    };
    let mut received = bytes[..CONTENTS + 4].to_vec();
    for place in (0..4096).chain(CONTENTS..CONTENTS + 4) {
        let byte = &mut received[place];
        *byte = half(*byte >> 4) << 4 | half(*byte & 0xf);
    }
    received
}

#[test]
fn known_bytes_show_the_order_of_the_data_lines() {
    let without_bitstream = encode(&[], &firmware(), &pieces()).unwrap();
    let mut vendors = vec![0xff; CONTENTS + 4];
    vendors[..bitstream().len()].copy_from_slice(&bitstream());
    for flash in [image(), without_bitstream, vendors] {
        assert_eq!(data_lines(&flash), DataLines::Right);
        for number in 1..256_u32 {
            // The permutations among all lists of four lines.
            let order = [0, 2, 4, 6].map(|bit| number >> bit & 3);
            let carries = |line| order.iter().position(|on| *on == line).map(|on| on as u8);
            let [Some(a), Some(b), Some(c), Some(d)] = [0, 1, 2, 3].map(carries) else {
                continue;
            };
            let received = through_lines(&flash, order.map(Some), 1);
            let expected = match [a, b, c, d] {
                [0, 1, 2, 3] => DataLines::Right,
                order => DataLines::Exchanged(order),
            };
            assert_eq!(data_lines(&received), expected);
        }
        for level in [0, 1] {
            let received = through_lines(&flash, [Some(0), Some(1), None, None], level);
            assert_eq!(data_lines(&received), DataLines::Two);
        }
    }
    assert_eq!(data_lines(&[0xff; CONTENTS + 4]), DataLines::Erased);
    assert_eq!(data_lines(&[]), DataLines::Erased);
    let other = data_lines(&[0x12; CONTENTS + 4]);
    assert_eq!(other, DataLines::Unknown(0x1212_1212));
    let texts = [DataLines::Exchanged([1, 0, 2, 3]), DataLines::Two, other];
    assert_eq!(
        texts.map(|lines| lines.to_string()),
        [
            "data of the lines 0 1 2 3 on the lines 1 0 2 3, expected the same order",
            "no data on the lines 2 and 3, expected the QE bit set",
            "0x12121212 at 0x400000, expected a bitstream or the contents of an image",
        ]
    );
}
