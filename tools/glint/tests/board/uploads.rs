//! Uploads of meshes over a faulty line, of invalid meshes, and of textures.

use crate::common::{
    address, console, emulator, emulator_with, info, mesh, read, renderer, running_board, small,
};
use glint::board::{Board, BoardError};
use glint::console::{Console, ConsoleError};
use glint::fuzz::Random;
use glint::transfer::{self, TransferError};
use glint_core::colour::Shading;
use glint_core::mesh::{IndexedTriangle, Vertex, encode};
use glint_core::texture::{self, Source};
use glint_core::wire::{Failure, Manifest, Reason};

/// A faulty line: in both directions it drops, flips or repeats one byte in a hundred.
struct BadLine<'b> {
    board: &'b mut dyn Board,
    random: Random,
    hit: u32,
}

impl BadLine<'_> {
    fn pass(&mut self, bytes: &[u8]) -> Vec<u8> {
        let mut passed = Vec::with_capacity(bytes.len());
        for &byte in bytes {
            let draw = self.random.below(300);
            self.hit += u32::from(draw < 3);
            match draw {
                0 => {}
                1 => passed.push(byte ^ 1 << self.random.below(8)),
                2 => passed.extend([byte, byte]),
                _ => passed.push(byte),
            }
        }
        passed
    }
}

impl Board for BadLine<'_> {
    fn write(&mut self, bytes: &[u8]) -> Result<(), BoardError> {
        let bytes = self.pass(bytes);
        self.board.write(&bytes)
    }

    fn read(&mut self, bytes: &mut Vec<u8>, wait_ms: u64) -> Result<(), BoardError> {
        let mut read = Vec::new();
        self.board.read(&mut read, wait_ms)?;
        bytes.extend(self.pass(&read));
        Ok(())
    }

    fn now_ms(&self) -> u64 {
        self.board.now_ms()
    }
}

#[test]
fn an_upload_over_a_bad_line_arrives_bit_for_bit() {
    let mesh = mesh("icosphere:4");
    let Manifest { length, crc32 } = Manifest::of(&mesh);
    let mut board = running_board();
    let mut console = console(&mut board);
    let staging = address(&mut console, "staging");
    let command = format!("load {length} {crc32:08x}");
    console
        .command_with_transfer(&command, &mut |_| {})
        .unwrap();
    {
        let (board, pending) = console.line();
        let mut line = BadLine {
            board,
            random: Random::new(1, 0),
            hit: 0,
        };
        transfer::send(&mut line, pending, &mesh, 1, &mut |_, _| {}).unwrap();
        assert!(line.hit > 100, "{} bytes were hit", line.hit);
    }
    console.reply(&command).unwrap();
    assert_eq!(info::<String>(&mut console, "scene"), "model");
    assert!(read(&mut console, staging, mesh.len()) == mesh);
}

/// Number of points along a side of the mesh of [`many`].
const SIDE: u32 = 256;

/// A square with `count` triangles of some pixels each. Half of the triangles face away.
fn many(count: u32) -> Vec<u8> {
    let places = (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| [x, y]));
    let vertices: Vec<_> = places
        .map(|place| {
            let [x, y] = place.map(|place| (place as i16 - SIDE as i16 / 2) << 7);
            Vertex {
                position: [x, y, 0],
                ..Vertex::default()
            }
        })
        .collect();
    let at = |x: u32, y: u32| y.min(SIDE - 1) * SIDE + x.min(SIDE - 1);
    let triangles: Vec<_> = (0..count)
        .map(|number| {
            let (x, y) = (number / 2 % SIDE, number / 2 / SIDE % SIDE);
            let [a, b, c] = [at(x, y), at(x + 12, y), at(x, y + 12)];
            IndexedTriangle {
                indices: if number % 2 == 0 {
                    [a, b, c]
                } else {
                    [a, c, b]
                },
                ..IndexedTriangle::default()
            }
        })
        .collect();
    encode(&vertices, &triangles).unwrap()
}

/// A board accepts a mesh if the memory of a frame has space for half of its triangles, whose
/// descriptors are twice as long for smooth shading. The host refuses a larger mesh before it sends
/// a byte.
#[test]
fn a_mesh_has_at_most_the_triangles_that_the_board_can_draw() {
    most_triangles(Shading::Flat, 131_072);
    most_triangles(Shading::Smooth, 65_536);
}

fn most_triangles(capability: Shading, most: u32) {
    let mut board = emulator_with(capability);
    let mut renderer = renderer(&mut board);
    renderer.upload(&many(most), None).unwrap();
    renderer.console().command("size 320 180").unwrap();
    let stats = renderer.console().command("render").unwrap();
    assert!(stats.contains(&"backend gateware".to_owned()), "{stats:?}");
    assert!(stats.contains(&format!("triangles_in {most}")), "{stats:?}");

    let large = many(most + 1);
    let refused = renderer.upload(&large, None).unwrap_err();
    let found = most + 1;
    let expected =
        format!("mesh of {found} triangles: expected at most {most}, which this board can draw");
    assert_eq!(refused.to_string(), expected);
    // If the host does not check the limit, the board refuses the mesh.
    let console = renderer.console();
    transfer::stage(console, &large).unwrap();
    let Manifest { length, crc32 } = Manifest::of(&large);
    let refused = console
        .command(&format!("load {length} {crc32:08x}"))
        .unwrap_err();
    let expected =
        format!("expected at most {most} triangles, which this board can draw, found {found}");
    assert!(refused.to_string().contains(&expected), "{refused}");
    assert_eq!(info::<u32>(console, "triangles"), most);
}

/// Draws the scene, and reads the colours of its frame of 320×180 pixels from memory.
fn frame(console: &mut Console<impl Board>) -> Vec<u8> {
    console.command("render").unwrap();
    let address = address(console, "frame");
    read(console, address, 2 * 320 * 180)
}

#[test]
fn a_bad_upload_leaves_the_old_model() {
    let (good, other) = (mesh("cube"), mesh("icosphere:1"));
    let mut board = emulator();
    let mut console = small(&mut board);
    let quiet: &mut transfer::Progress = &mut |_, _| {};
    transfer::upload(&mut console, &good, None, 1, quiet).unwrap();
    let shown = frame(&mut console);

    // The announced CRC-32 does not match the mesh that is sent.
    let Manifest { length, crc32 } = Manifest::of(&good);
    let command = format!("load {length} {:08x}", !crc32);
    console
        .command_with_transfer(&command, &mut |_| {})
        .unwrap();
    let (line, pending) = console.line();
    let refused = transfer::send(line, pending, &other, 2, quiet).unwrap_err();
    assert!(
        matches!(
            refused,
            TransferError::Failed(Failure::AbortedByPeer(Reason::Unannounced))
        ),
        "{refused}"
    );
    assert!(matches!(
        console.reply(&command),
        Err(ConsoleError::Refused { .. })
    ));

    // These bytes arrive undamaged, but are not a valid mesh: a reserved byte of a chunk's header
    // is not 0, or an index exceeds the number of vertices.
    let last_triangle = other.len() - 16;
    for (number, at) in [(3, 40), (4, last_triangle + 1)] {
        let mut damaged = other.clone();
        damaged[at] ^= 0x80;
        let refused = transfer::upload(&mut console, &damaged, None, number, quiet);
        let refused = refused.unwrap_err().to_string();
        assert!(
            refused.contains("refused, previous uploads kept"),
            "byte {at}: {refused}"
        );
    }
    assert_eq!(info::<u32>(&mut console, "triangles"), 12);
    assert!(frame(&mut console) == shown);

    // A valid upload still succeeds.
    transfer::upload(&mut console, &other, None, 5, quiet).unwrap();
    assert_eq!(info::<u32>(&mut console, "triangles"), 20);
    assert!(frame(&mut console) != shown);
}

/// A texture of 8×8 texels of a colour.
fn texture(colour: u16) -> Vec<u8> {
    let texture = texture::encode(&Source {
        size_log2: [3, 3],
        levels: vec![vec![colour; 64]],
        ..Source::default()
    });
    texture.unwrap()
}

/// Uploads textures under names. The selected texture replaces the textures of the shown meshes until another texture is selected, or
/// until it is removed.
#[test]
fn a_texture_is_uploaded_under_a_name() {
    let mut board = emulator();
    let mut console = small(&mut board);
    let quiet: &mut transfer::Progress = &mut |_, _| {};
    let mut session = 0;
    let mut upload = |console: &mut Console<_>, bytes: &[u8], name| {
        session += 1;
        transfer::upload(console, bytes, Some(name), session, quiet)
    };
    let said = |console: &mut Console<_>, line: &str| match console.command(line) {
        Ok(lines) => lines.join("\n"),
        Err(error) => error.to_string(),
    };
    // The cube has no textures.
    let note = "texture: no shown mesh has faces with a texture, so the picture does not change; `scene crate` shows a mesh that has some";
    assert_eq!(
        upload(&mut console, &texture(0xF800), "red").unwrap(),
        [note]
    );
    assert_eq!(said(&mut console, "texture red"), format!("note: {note}"));
    assert_eq!(said(&mut console, "texture own"), "");
    console.command("scene crate").unwrap();
    let own = frame(&mut console);
    assert_eq!(said(&mut console, "texture red"), "");
    let red = frame(&mut console);
    assert!(red != own);
    console.command("textures off").unwrap();
    let off =
        "note: texture: textures are off, so the picture does not change, expected `textures on`";
    assert_eq!(said(&mut console, "texture red"), off);
    console.command("textures on").unwrap();
    let green = upload(&mut console, &texture(0x07E0), "green").unwrap();
    assert!(green.is_empty(), "{green:?}");
    assert_eq!(said(&mut console, "texture"), "texture green");
    let green = frame(&mut console);
    assert!(green != own && green != red);
    let models = said(&mut console, "models");
    for line in [
        "texture red size 8 8 bytes 160",
        "texture green size 8 8 bytes 160",
        "uploads 2 of 18",
    ] {
        assert!(models.contains(line), "{models}");
    }
    // A command for meshes does not accept the name of a texture, and a command for textures does not accept the name
    // of a mesh.
    for (line, error) in [
        ("scene red", "scene `red`: expected cube or "),
        ("object add red", "object add `red`: expected a mesh"),
        (
            "texture crate",
            "texture `crate`: expected own or an uploaded texture",
        ),
        (
            "load 160 0 own",
            "upload `own`: the keyword for a mesh's own textures, expected another name",
        ),
    ] {
        let found = said(&mut console, line);
        assert!(found.contains(error), "{found}");
    }
    // An invalid texture is refused, and the picture stays.
    let good = texture(0xFFFF);
    let long = [&good[..], &[0; 16]].concat();
    let mut damaged = good.clone();
    damaged[12] = 0;
    for (bytes, error) in [
        (&good[..20], "texture byte 0: expected 32 bytes, found 20"),
        (&good[..96], "texture byte 0: expected 160 bytes, found 96"),
        (
            &long,
            "texture byte 0: expected 160 bytes in all, found 176",
        ),
        (
            &damaged,
            "texture byte 12: expected 3 to 10, the logarithm of a side, found 0",
        ),
        (
            b"GLT2 is no texture, and no mesh.",
            "mesh byte 0: expected \"GLM2\", found \"GLT2\"",
        ),
    ] {
        let refused = upload(&mut console, bytes, "red").unwrap_err().to_string();
        let expected = format!("load: refused, previous uploads kept: {error}");
        assert!(refused.contains(&expected), "{refused}");
    }
    assert_eq!(said(&mut console, "texture"), "texture green");
    assert!(frame(&mut console) == green);

    // The removal of another upload moves the shown texture in memory.
    console.command("unload red").unwrap();
    assert!(frame(&mut console) == green);
    console.command("unload green").unwrap();
    assert_eq!(said(&mut console, "texture"), "texture own");
    assert!(frame(&mut console) == own);
    // A texture can have the name of a built-in mesh, even of the shown mesh.
    upload(&mut console, &texture(0xFFFF), "crate").unwrap();
    assert!(frame(&mut console) != own);
    console.command("unload crate").unwrap();
    assert!(frame(&mut console) == own);
}

/// A mesh replaces a texture with the same name, and a texture replaces a mesh, unless an object uses the mesh. The scene then shows the
/// cube, or the own textures of the meshes.
#[test]
fn an_upload_replaces_one_of_the_other_kind() {
    let mut board = emulator();
    let mut console = console(&mut board);
    let quiet: &mut transfer::Progress = &mut |_, _| {};
    let mut session = 0;
    let mut upload = |console: &mut Console<_>, bytes: &[u8]| {
        session += 1;
        transfer::upload(console, bytes, None, session, quiet)
    };
    let (texture, mesh) = (texture(0xF800), mesh("icosphere:1"));
    upload(&mut console, &texture).unwrap();
    upload(&mut console, &mesh).unwrap();
    assert_eq!(console.command("texture").unwrap(), ["texture own"]);
    assert_eq!(info::<u32>(&mut console, "triangles"), 20);
    console.command("object add model").unwrap();
    let refused = upload(&mut console, &texture).unwrap_err().to_string();
    let error = "load: refused, previous uploads kept: object 1 shows this mesh, expected `object remove 1` first";
    assert!(refused.contains(error), "{refused}");
    console.command("object show").unwrap();
    assert_eq!(info::<u32>(&mut console, "triangles"), 20);
    console.command("object remove 1").unwrap();
    assert_eq!(info::<String>(&mut console, "scene"), "model");
    upload(&mut console, &texture).unwrap();
    assert_eq!(console.command("texture").unwrap(), ["texture model"]);
    assert_eq!(info::<String>(&mut console, "scene"), "cube");
    let models = console.command("models").unwrap();
    assert!(models.contains(&"uploads 1 of 18".to_owned()), "{models:?}");
}
