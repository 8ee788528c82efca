//! Makes and checks images for a board's SPI flash: a bitstream, a firmware and scenes.

use crate::error::{FormatError, InputError, Location, quote};
use crate::formats::glm;
use crate::scene;
use crate::texture;
use crate::wireframe;
use glint_core::deviation::Deviation;
use glint_core::flash::{Contents, EncodeError, Image, Item, Kind, Piece, encode};
use glint_core::mesh::{Mesh, is_name};
use glint_core::picture::Size;
use glint_core::wireframe::CUBE_NAME;
use glint_scene::{Board, Defaults, LineError, Reason, Scene, lines};
use glint_scene_file::SceneFile;
use std::borrow::Cow;
use std::collections::{HashMap, HashSet};
use std::path::Path;

/// Name of the list of scenes in an image; the board shows its first scene after power-up.
pub const START: &str = "start";
/// Maximum number of commands of a scene, which a board executes before the first picture. A scene
/// with all options and the maximum numbers of objects and lights has fewer than a hundred
/// commands.
pub const MAX_COMMANDS: usize = 1_000;
/// Name of the built-in cube, which is not in the list of shapes.
const CUBE: &str = "cube";

/// The configuration data of a bitstream file: all bytes of a raw file, or the bytes after the
/// header of a `.bit` file.
///
/// # Errors
/// The header is damaged.
pub fn bitstream(file: &[u8]) -> Result<&[u8], FormatError> {
    // The start of the header: a field of nine bytes and a field of one byte. A raw bitstream does
    // not contain them.
    const HEADER: [u8; 13] = [
        0, 9, 0x0f, 0xf0, 0x0f, 0xf0, 0x0f, 0xf0, 0x0f, 0xf0, 0, 0, 1,
    ];
    let Some(mut rest) = file.strip_prefix(&HEADER) else {
        return Ok(file);
    };
    let damaged = |rest: &[u8], expected: &str| {
        let place = Location::Byte(file.len() - rest.len());
        FormatError::new(place, expected, quote(rest.get(..8).unwrap_or(rest)))
    };
    // Fields of the design, the part, the date and the time.
    for key in *b"abcd" {
        let field = rest
            .split_first_chunk()
            .and_then(|(&[found, high, low], rest)| {
                (found == key).then_some(())?;
                rest.get(usize::from(u16::from_be_bytes([high, low]))..)
            });
        let expected = format!("the field {} of a bitstream's header", key.escape_ascii());
        rest = field.ok_or_else(|| damaged(rest, &expected))?;
    }
    let data = rest
        .split_first_chunk()
        .and_then(|(&[key, length @ ..], data): (&[u8; 5], _)| {
            let is_whole = data.len() == u32::from_be_bytes(length) as usize;
            (key == b'e' && is_whole).then_some(data)
        });
    data.ok_or_else(|| damaged(rest, "the field e with all bytes up to the end of the file"))
}

/// The items of an image for these scenes: each mesh that is not built into the firmware, each texture, each wireframe program, each
/// scene, and the list of all scenes.
///
/// # Errors
/// A mesh, a texture or a program cannot be read, two different ones have the same name, or a name is invalid.
pub fn pieces(scenes: &[SceneFile]) -> Result<Vec<Piece>, InputError> {
    let of = |scene: &SceneFile| match scene.scenes() {
        [] => vec![scene.clone()],
        parts => parts.to_vec(),
    };
    let mut uploads: Vec<Piece> = Vec::new();
    let (mut all, mut list): (Vec<Piece>, String) = Default::default();
    for scene in scenes.iter().flat_map(of) {
        let folder = scene.folder();
        for name in scene.meshes().iter().filter(|name| !is_built_in(name)) {
            add(&mut uploads, Kind::Mesh, name, || scene::mesh(name, folder))?;
        }
        if let Some(name) = scene.texture() {
            add(&mut uploads, Kind::Texture, name, || {
                scene::texture(name, folder)
            })?;
        }
        if let Some(name) = scene.program() {
            add(&mut uploads, Kind::Program, name, || {
                scene::program(name, folder)
            })?;
        }
        list += &format!("{}\n", scene.name());
        if all.iter().all(|known| known.name != scene.name()) {
            check_name(scene.name())?;
            let lines: String = scene.lines().map(|line| format!("{line}\n")).collect();
            all.push(piece(Kind::Scene, scene.name(), lines.into_bytes()));
        }
    }
    uploads.extend(all);
    if !list.is_empty() {
        uploads.push(piece(Kind::List, START, list.into_bytes()));
    }
    Ok(uploads)
}

/// Adds the item that `read` returns, unless the same item has been added already.
fn add(
    pieces: &mut Vec<Piece>,
    kind: Kind,
    name: &str,
    read: impl FnOnce() -> Result<Vec<u8>, InputError>,
) -> Result<(), InputError> {
    check_name(name)?;
    let bytes = read()?;
    let is_known = |known: &&Piece| known.kind == kind && known.name == name;
    match pieces.iter().find(is_known) {
        None => pieces.push(piece(kind, name, bytes)),
        Some(known) if known.bytes == bytes => {}
        Some(_) => {
            let expected = "one file of each name; rename one of the files";
            let found = format!(
                "two different files {} of scenes in two folders",
                quote(name.as_bytes())
            );
            return Err(FormatError::whole(expected, found).in_file("image"));
        }
    }
    Ok(())
}

fn piece(kind: Kind, name: &str, bytes: Vec<u8>) -> Piece {
    Piece {
        kind,
        name: name.to_owned(),
        bytes,
    }
}

fn check_name(name: &str) -> Result<(), InputError> {
    if is_name(name) {
        return Ok(());
    }
    let expected = "a name of 1 to 24 visible characters of ASCII";
    Err(FormatError::whole(expected, quote(name.as_bytes())).in_file("image"))
}

fn is_built_in(mesh: &str) -> bool {
    mesh == CUBE || scene::is_shape(mesh)
}

/// Makes an image, and checks it.
///
/// # Errors
/// A part is too long, or violates its format.
pub fn make(bitstream: &[u8], firmware: &[u8], pieces: &[Piece]) -> Result<Vec<u8>, FormatError> {
    let image = encode(bitstream, firmware, pieces).map_err(|error| match error {
        EncodeError::Part(error) => format_error(error),
        EncodeError::Long(part, limit, found) => FormatError::whole(
            format!("at most {limit} bytes of {part}"),
            found.to_string(),
        ),
        EncodeError::Items(limit, found) => {
            FormatError::whole(format!("at most {limit} items"), found.to_string())
        }
    })?;
    check(&image)?;
    Ok(image)
}

/// Checks an image: its parts, its checksums, the names of its items, its meshes, textures and wireframe programs, the commands of its
/// scenes, and the names in its lists.
///
/// # Errors
/// The first violation.
pub fn check(bytes: &[u8]) -> Result<Image<'_>, FormatError> {
    let image = Image::new_checked(bytes).map_err(format_error)?;
    check_contents(&image.contents)?;
    Ok(image)
}

/// Checks the contents of an image.
///
/// # Errors
/// The first violation.
pub fn check_contents(contents: &Contents) -> Result<(), FormatError> {
    let mut names = HashSet::new();
    for item in contents.items() {
        let list = match item.kind {
            // A board copies them to its uploads, which have one list of names.
            Kind::Mesh | Kind::Texture | Kind::Program => "upload",
            Kind::Scene | Kind::List => item.kind.name(),
        };
        if !names.insert((list, item.name)) {
            let found = match list {
                "upload" => "two meshes, textures or programs of this name",
                _ => "two items of this kind and name",
            };
            let error = FormatError::whole("names that differ", found);
            return Err(in_item(&item, error));
        }
        match item.kind {
            Kind::Mesh => {
                let bytes = item.checked().map_err(format_error)?;
                glm::check(bytes).map_err(|error| in_item(&item, error))?;
            }
            Kind::Texture => {
                let bytes = item.checked().map_err(format_error)?;
                texture::checked(bytes).map_err(|error| in_item(&item, error))?;
            }
            Kind::Program => {
                let bytes = item.checked().map_err(format_error)?;
                wireframe::check(bytes).map_err(|error| in_item(&item, error))?;
            }
            Kind::Scene => {
                let text = item.text().map_err(format_error)?;
                check_scene(contents, text).map_err(|error| in_item(&item, error))?;
            }
            Kind::List => {
                let names = item.text().map_err(format_error)?.lines();
                for (number, name) in names.enumerate() {
                    if contents.find(Kind::Scene, name).is_none() {
                        let (place, found) = (Location::Line(number + 1), quote(name.as_bytes()));
                        let error = FormatError::new(place, "a scene of the image", found);
                        return Err(in_item(&item, error));
                    }
                }
            }
        }
    }
    Ok(())
}

/// The meshes, textures and wireframe programs of an image, and those of its firmware.
struct ImageBoard<'i> {
    contents: &'i Contents<'i>,
    /// The meshes that the scene uses.
    meshes: HashMap<String, Cow<'i, [u8]>>,
}

impl Board for ImageBoard<'_> {
    fn has_size(&self, _: Size) -> bool {
        true
    }

    fn has_engine(&self) -> bool {
        true
    }

    fn has_mesh(&mut self, name: &str) -> bool {
        if self.meshes.contains_key(name) {
            return true;
        }
        let bytes = match self.contents.find(Kind::Mesh, name) {
            Some(item) => item.checked().ok().map(Cow::Borrowed),
            None if is_built_in(name) => scene::mesh(name, Path::new("")).ok().map(Cow::Owned),
            None => None,
        };
        let bytes = bytes.map(|bytes| self.meshes.insert(name.to_owned(), bytes));
        bytes.is_some()
    }

    fn mesh(&self, name: &str) -> Option<Mesh<'_>> {
        Mesh::new_checked(self.meshes.get(name)?).ok()
    }

    fn has_texture(&self, name: &str) -> bool {
        self.contents.find(Kind::Texture, name).is_some()
    }

    fn has_program(&self, name: &str) -> bool {
        name == CUBE_NAME || self.contents.find(Kind::Program, name).is_some()
    }
}

/// Checks that a board can execute the commands of a scene, and that its meshes exist.
fn check_scene(contents: &Contents, text: &str) -> Result<(), FormatError> {
    let count = text.lines().count();
    if count > MAX_COMMANDS {
        let expected = format!("at most {MAX_COMMANDS} commands");
        return Err(FormatError::whole(expected, count.to_string()));
    }
    let mut board = ImageBoard {
        contents,
        meshes: HashMap::new(),
    };
    let scene = Scene::new(Defaults::GATEWARE);
    let mut scene = scene
        .map_err(|error| FormatError::whole("a scene that boards can show", error.to_string()))?;
    let quoted = |line: usize| quote(text.lines().nth(line - 1).unwrap_or("").as_bytes());
    let error = |line, expected| FormatError::new(Location::Line(line), expected, quoted(line));
    for parsed in lines(text) {
        let (line, parsed) = parsed.map_err(|LineError { line, reason }| {
            let expected = match reason {
                Reason::Parse(reason) => format!("a command ({reason})"),
                Reason::Effect => "a command that sets the picture".to_owned(),
            };
            error(line, expected)
        })?;
        if let Some(mesh) = parsed.mesh()
            && !board.has_mesh(mesh)
        {
            return Err(error(
                line,
                "a mesh of the image or a built-in one".to_owned(),
            ));
        }
        let applied = parsed.apply(&mut scene, &mut board);
        applied
            .map_err(|reason| error(line, format!("a command that boards execute ({reason})")))?;
    }
    Ok(())
}

/// Adds the item's kind and name to an error in the item.
fn in_item(item: &Item, error: FormatError) -> FormatError {
    let Item { kind, name, .. } = item;
    let FormatError {
        place,
        expected,
        found,
    } = error;
    FormatError::whole(format!("{} {name}: {place}{expected}", kind.name()), found)
}

fn format_error(error: Deviation) -> FormatError {
    let mut found = String::new();
    // Writing to a `String` does not fail.
    let _ = error.write_found(&mut found);
    FormatError::new(
        Location::Byte(error.offset as usize),
        error.expected.to_string(),
        found,
    )
}
