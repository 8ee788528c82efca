//! Tests of textures in memory: encoding, decoding and error messages.

use glint_core::colour::Rgb565;
use glint_core::records::TextureHeader;
use glint_core::texture::{
    BLOCK_BYTES, Blend, Filter, Format, Sampler, Source, Texture, Wrap, checksum, encode,
};

/// A source whose texels differ, as far as the format has enough values.
fn source(format: Format, size_log2: [u8; 2], levels: u8) -> Source {
    let size = |level: u8| size_log2.map(|side| 1_usize << side.saturating_sub(level));
    Source {
        format,
        size_log2,
        sampler: Sampler {
            wrap: [Wrap::Mirror, Wrap::Clamp],
            filter: Filter::Bilinear,
        },
        key: Some(3),
        blend: Blend::Additive,
        palette: (0..format.colours() as u16)
            .map(|i| Rgb565(i * 257))
            .collect(),
        levels: (0..levels)
            .map(|level| {
                let [width, height] = size(level);
                let mask = (1_u32 << format.bits()) - 1;
                let value = |i: usize| ((i as u32 * 40_503 + u32::from(level)) & mask) as u16;
                (0..width * height).map(value).collect()
            })
            .collect(),
    }
}

#[test]
fn texels_are_read_as_they_were_encoded() {
    for format in Format::ALL {
        for (size_log2, levels) in [([3, 3], 4), ([3, 10], 11), ([10, 3], 1), ([5, 4], 6)] {
            let source = source(format, size_log2, levels);
            let bytes = encode(&source).unwrap();
            let texture = Texture::new_checked(&bytes).unwrap();
            assert_eq!(texture.sampler(), source.sampler);
            assert_eq!(texture.blend(), source.blend);
            assert_eq!(texture.levels(), u32::from(levels));
            assert_eq!(texture.size_log2(), size_log2.map(u32::from));
            for (level, texels) in (0..).zip(&source.levels) {
                let [width, height] = texture.level_log2(level).map(|side| 1_u32 << side);
                assert_eq!((width * height) as usize, texels.len());
                for (i, &expected) in (0..).zip(texels) {
                    let place = [i % width, i / width];
                    let name = format!("{format:?} {size_log2:?} level {level} {place:?}");
                    assert_eq!(texture.value(level, place), expected, "{name}");
                    let colour = match format {
                        _ if expected == 3 => None,
                        Format::Rgb565 => Some(Rgb565(expected)),
                        Format::Palette256 | Format::Palette16 => Some(Rgb565(expected * 257)),
                    };
                    assert_eq!(texture.colour(level, place), colour, "{name}");
                }
            }
            assert_eq!(texture.value(40, [5000, 5000]), 0);
        }
    }
}

/// The four neighbours that bilinear filtering averages are in different quarters of words, so that the
/// gateware reads them at once from four memories.
#[test]
fn neighbours_are_in_different_quarters() {
    for format in Format::ALL {
        let empty = source(format, [4, 4], 1);
        let at = |x: u32, y: u32| {
            let mut texels = vec![0; 256];
            texels[(16 * y + x) as usize] = u16::MAX;
            let bytes = encode(&Source {
                levels: vec![texels],
                ..empty.clone()
            })
            .unwrap();
            let body = &bytes[TextureHeader::BYTES + 2 * format.colours()..];
            let byte = body.iter().position(|&byte| byte != 0).unwrap();
            assert!(byte < body.len().next_multiple_of(BLOCK_BYTES));
            byte % 16 / 4
        };
        for (x, y) in [(0, 0), (1, 0), (7, 3), (3, 7), (14, 14)] {
            let mut quarters = [at(x, y), at(x + 1, y), at(x, y + 1), at(x + 1, y + 1)];
            quarters.sort_unstable();
            assert_eq!(quarters, [0, 1, 2, 3], "{format:?} {x} {y}");
        }
    }
}

#[test]
fn places_beyond_the_sides() {
    for (wrap, expected) in [
        (Wrap::Repeat, [7, 0, 7, 0, 1, 0]),
        (Wrap::Mirror, [0, 0, 7, 7, 6, 0]),
        (Wrap::Clamp, [0, 0, 7, 7, 7, 0]),
    ] {
        let found = [-1, 0, 7, 8, 9, i32::MIN].map(|place| wrap.place(place, 3));
        assert_eq!(found, expected, "{wrap:?}");
        assert_eq!(wrap.place(i32::MAX, 0), 0);
    }
}

#[test]
fn rubbish_is_refused_with_its_place() {
    let good = encode(&source(Format::Palette16, [3, 4], 5)).unwrap();
    let length = good.len();
    let text = |bytes: &[u8]| {
        let texture = Texture::new_checked(bytes);
        texture.map(drop).unwrap_err().to_string()
    };
    for (at, byte, place, expected) in [
        (0, b'X', 0, "\"GLT1\", found \"XLT1\""),
        (12, 11, 12, "3 to 10, the logarithm of a side, found 11"),
        (13, 2, 13, "3 to 10, the logarithm of a side, found 2"),
        (14, 2, 14, "1 or 5 mip levels, found 2"),
        (15, 3, 15, "at most 2 (format), found 3"),
        (17, 3, 17, "at most 2 (wrap), found 3"),
        (18, 2, 18, "at most 1 (filter), found 2"),
        (19, 2, 19, "at most 1 (cut-out), found 2"),
        (20, 16, 20, "at most 15 (key), found 16"),
        (22, 9, 22, "at most 8 (blend), found 9"),
        (31, 9, 23, "0 (reserved), found 9"),
    ] {
        let mut bytes = good.clone();
        bytes[at] = byte;
        let expected = format!("texture byte {place}: expected {expected}");
        assert_eq!(text(&bytes), expected);
    }
    for (end, expected) in [(9, 32), (length - 1, length)] {
        let expected = format!("texture byte 0: expected {expected} bytes, found {end}");
        assert_eq!(text(&good[..end]), expected);
    }
    // Bytes after the texture are not part of the texture.
    let longer = [&good[..], &[7; 5]].concat();
    assert_eq!(Texture::new_checked(&longer).unwrap().bytes(), good);
    let header = TextureHeader::from_bytes(good.first_chunk().unwrap());
    assert_eq!(header.checksum, checksum(&good));
    assert_eq!(checksum(&[]), 0);
}

#[test]
fn sizes_that_no_texture_has_are_not_encoded() {
    let good = source(Format::Rgb565, [3, 3], 1);
    for size_log2 in [[2, 3], [3, 11], [200, 200]] {
        let wrong = Source {
            size_log2,
            ..good.clone()
        };
        assert!(encode(&wrong).is_err());
    }
    let levels = vec![Vec::new(); 2];
    assert!(encode(&Source { levels, ..good }).is_err());
    // Missing texels are 0, and values of too many bits are truncated.
    let short = Source {
        levels: vec![vec![0x5E]],
        ..source(Format::Palette16, [3, 3], 1)
    };
    let bytes = encode(&short).unwrap();
    let texture = Texture::new_checked(&bytes).unwrap();
    assert_eq!([0, 1].map(|x| texture.value(0, [x, 0])), [0xE, 0]);
}

#[test]
fn numbers_of_blends() {
    for (number, blend) in (0..).zip(Blend::ALL) {
        assert_eq!(blend.number(), number);
        assert_eq!(blend == Blend::Opaque, number == 0);
        assert_eq!(blend == Blend::Additive, number == 8);
    }
}

/// Compares the blend of each channel with exact arithmetic, for all pairs of values.
#[test]
fn each_channel_is_blended_to_nearest() {
    for (number, blend) in (0_u8..).zip(Blend::ALL) {
        for source in 0..64_u16 {
            for behind in 0..64_u16 {
                // Red and blue have five bits.
                let grey = |value: u16| Rgb565((value >> 1) << 11 | value << 5 | value >> 1);
                let found = blend.over(grey(source), grey(behind)).channels();
                let exact = |source: u16, behind: u16, most: u16| match number {
                    0 => source,
                    8 => (source + behind).min(most),
                    _ => {
                        let share = f64::from(number) / 8.0;
                        let blended = f64::from(source) * share + f64::from(behind) * (1.0 - share);
                        (blended + 0.5).floor() as u16
                    }
                };
                let narrow = exact(source >> 1, behind >> 1, 31);
                let expected = [narrow, exact(source, behind, 63), narrow];
                assert_eq!(
                    found.map(u16::from),
                    expected,
                    "{number}: {source} {behind}"
                );
            }
        }
    }
}

/// Draws 255 layers of each share over each colour. Each layer is at most half a step from the exact blend, and a layer multiplies the
/// error of the layers below by 1 − share, so the sum of all errors is at most half a step divided by the share. The colour stops changing
/// as soon as a layer would change it by less than half a step.
#[test]
fn many_layers_stay_near_the_exact_colour() {
    for eighths in 1..=7_u8 {
        let blend = Blend::ALL[usize::from(eighths)];
        let share = f64::from(eighths) / 8.0;
        let (mut largest, mut last) = (0.0_f64, 0.0_f64);
        for source in 0..64_u16 {
            for behind in 0..64_u16 {
                let (mut found, mut exact) = (Rgb565(behind << 5), f64::from(behind));
                for _ in 0..255 {
                    found = blend.over(Rgb565(source << 5), found);
                    exact += (f64::from(source) - exact) * share;
                    largest = largest.max((f64::from(found.channels()[1]) - exact).abs());
                }
                last = last.max((f64::from(found.channels()[1]) - f64::from(source)).abs());
            }
        }
        println!("share {eighths}/8: errors of at most {largest} steps, {last} steps at the end");
        assert!(largest <= 0.5 / share, "{eighths}: {largest}");
        // The last layers change nothing: a share of the difference is at most half a step.
        assert!(last <= 0.5 / share, "{eighths}: {last}");
    }
}
