//! Test that the stored checksums of the self-test are those of the model's pictures.

use glint_core::mesh::Mesh;
use glint_core::shape::MAX_BYTES;
use glint_core::wire::crc32;
use glint_model::Frame;
use glint_model::selftest::{MESH_SHAPE, TestPicture};
use glint_vectors::Picture;

/// Returns the contents of the file `checksums.rs` for these checksums.
fn file(checksums: &[u32]) -> String {
    let lines: String = checksums
        .iter()
        .map(|checksum| format!("    {checksum:#010x},\n"))
        .collect();
    format!(
        "//! The checksums of the self-test's pictures, in the order of their definition.
// Written by `GLINT_UPDATE=1 cargo test -p glint-model --test model -- selftest`. Do not edit.

pub(super) const STORED: [u32; {}] = [
{lines}];
",
        checksums.len()
    )
}

/// Draws the picture of a frame, or of both eyes. For two eyes, returns the counts of the left eye.
fn drawn(frame: &Frame) -> Picture {
    let Some(eyes) = frame.eyes().unwrap() else {
        let mut picture = Picture::of_frame(frame);
        let mut colour = vec![0; frame.size.pixel_count()];
        frame.average(&picture.colour, &mut colour, &mut || {});
        picture.colour = colour;
        return picture;
    };
    let [mut left, right] = [eyes.left, eyes.right].map(|eye| Picture::of_frame(&eye));
    let words = |colour: &[u16]| {
        let pairs = colour.as_chunks().0.iter();
        let words = pairs.map(|&[a, b]| u32::from(a) | u32::from(b) << 16);
        words.collect::<Vec<_>>()
    };
    let mut both = words(&left.colour);
    eyes.compose(&mut both, &words(&right.colour), &mut || {});
    let pixels = both
        .iter()
        .flat_map(|word| [*word as u16, (word >> 16) as u16]);
    left.colour = pixels.collect();
    left
}

/// Draws every picture, and compares the picture's checksum with the stored checksum. With the environment variable `GLINT_UPDATE`, stores
/// the checksums instead.
#[test]
fn the_stored_checksums_are_those_of_the_model() {
    #[repr(align(16))]
    struct Aligned([u8; MAX_BYTES]);
    let mut memory = Box::new(Aligned([0; MAX_BYTES]));
    let length = MESH_SHAPE.write(&mut memory.0).unwrap();
    let mesh = Mesh::new_checked(&memory.0[..length]).unwrap();
    let mut seen = Vec::new();
    for picture in TestPicture::ALL {
        let mut draw = |frame: &Frame| {
            let Picture { colour, stats, .. } = drawn(frame);
            // Rectangles are drawn after clipped triangles, so the picture must contain some.
            assert!(picture != TestPicture::Texture || stats.clipped > 0);
            let bytes = colour.iter().flat_map(|colour| colour.to_le_bytes());
            seen.push(crc32(&bytes.collect::<Vec<_>>()));
        };
        picture.describe(Some(mesh), &mut draw).unwrap();
    }
    // No two checksums are equal, so all pictures differ.
    let mut distinct = seen.clone();
    distinct.sort_unstable();
    distinct.dedup();
    assert_eq!(distinct.len(), TestPicture::ALL.len());
    if std::env::var_os("GLINT_UPDATE").is_some() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/src/selftest/checksums.rs");
        std::fs::write(path, file(&seen)).unwrap();
        return;
    }
    for (picture, checksum) in TestPicture::ALL.into_iter().zip(seen) {
        assert_eq!(
            picture.stored(),
            checksum,
            "{}: `GLINT_UPDATE=1 cargo test -p glint-model --test model -- selftest` stores the checksums",
            picture.name()
        );
    }
}
