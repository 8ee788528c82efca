//! Example files for tests and fuzzing.

use crate::picture::Picture;
use image::codecs::jpeg::JpegEncoder;
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};

/// A PNG file of 8×8 with transparent texels.
pub fn small_png() -> Vec<u8> {
    let texels = (0..64).map(|i| [4 * i, 255 - i, 7, if i % 5 == 0 { 0 } else { 255 }]);
    let picture = Picture {
        size: [8, 8],
        texels: texels.collect(),
    };
    picture.png().unwrap_or_default()
}

/// Small files of several kinds: PNG of each number of channels with 8 and 16 bits, and JPEG in grey and in colour.
pub fn files() -> Vec<Vec<u8>> {
    let [width, height] = [9, 13];
    let bytes: Vec<u8> = (0..8 * width * height).map(|i| (i % 251) as u8).collect();
    let pngs = [
        (ExtendedColorType::L8, 1),
        (ExtendedColorType::La8, 2),
        (ExtendedColorType::Rgb8, 3),
        (ExtendedColorType::Rgba8, 4),
        (ExtendedColorType::L16, 2),
        (ExtendedColorType::La16, 4),
        (ExtendedColorType::Rgb16, 6),
        (ExtendedColorType::Rgba16, 8),
    ];
    let png = pngs.into_iter().filter_map(|(kind, size)| {
        let mut file = Vec::new();
        let bytes = bytes.get(..(size * width * height) as usize)?;
        let encoder = PngEncoder::new(&mut file);
        encoder.write_image(bytes, width, height, kind).ok()?;
        Some(file)
    });
    let jpegs = [(ExtendedColorType::L8, 1), (ExtendedColorType::Rgb8, 3)];
    let jpeg = jpegs.into_iter().filter_map(|(kind, size)| {
        let mut file = Vec::new();
        let bytes = bytes.get(..(size * width * height) as usize)?;
        let encoder = JpegEncoder::new(&mut file);
        encoder.write_image(bytes, width, height, kind).ok()?;
        Some(file)
    });
    png.chain(jpeg).chain([small_png()]).collect()
}

/// Corrects the checksums of the chunks of a PNG file, as far as its lengths are correct.
pub fn repair_png(file: &mut [u8]) {
    let mut at = 8;
    while let Some(&length) = file.get(at..).and_then(<[u8]>::first_chunk) {
        let length = u32::from_be_bytes(length) as usize;
        let Some(chunk) = file
            .get(at + 4..)
            .and_then(|rest| rest.get(..length.checked_add(4)?))
        else {
            return;
        };
        let sum = crc(chunk).to_be_bytes();
        let place = at + 8 + length;
        if let Some(stated) = file.get_mut(place..place + 4) {
            stated.copy_from_slice(&sum);
        }
        at = place + 4;
    }
}

/// The CRC-32 of a PNG's chunk.
fn crc(bytes: &[u8]) -> u32 {
    let sum = bytes.iter().fold(u32::MAX, |sum, &byte| {
        (0..8).fold(sum ^ u32::from(byte), |sum, _| {
            sum >> 1 ^ if sum & 1 == 1 { 0xedb8_8320 } else { 0 }
        })
    });
    !sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_files_are_pictures() {
        let files = files();
        assert_eq!(files.len(), 11);
        for mut file in files {
            let picture = Picture::decode(&file).unwrap();
            assert!([[9, 13], [8, 8]].contains(&picture.size));
            let before = file.clone();
            if file.starts_with(b"\x89PNG") {
                repair_png(&mut file);
            }
            assert!(file == before);
        }
    }
}
