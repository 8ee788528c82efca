"""Records in memory that gateware, firmware and host share: meshes, segments, descriptors, flash images.

`cargo xtask pac` writes them as the SystemVerilog package `records_pkg`, as the module `records` of glint-core, and
as docs/formats/records.md. All three name the fields, so no offset or width is written anywhere else.

To add an optional attribute of a mesh's vertices, add its element to `ATTRIBUTES`.
"""

import re
from dataclasses import dataclass

from migen import Signal

from .constants import LIST_GAP_WORDS, LIST_TABLE_WORDS, LISTS, SIZES
from .packed import Struct, generated, package
from .rtl import CORE, ROOT, RTL


@dataclass(frozen=True)
class Field:
    """A field of a record: `count` neighbouring elements of `bits` bits each, which may be records.

    `rust` is the type of glint-core that wraps the number in Rust, for a field of whole bytes. Fields named `reserved` are 0.
    """

    name: str
    bits: int
    text: str = ""
    count: int = 1
    signed: bool = False
    rust: str = ""
    record: "Record | None" = None

    @property
    def width(self):
        """Size of all elements in bits."""
        return self.bits * self.count


@dataclass(frozen=True)
class Record:
    """A record: its fields, the lowest bits first.

    A record with `bytes` consists of whole bytes and becomes a struct in Rust; for any other record, Rust has a constant for each
    field. `rtl` is the name of the record's type in SystemVerilog, if the gateware reads it.
    """

    name: str
    text: str
    fields: tuple
    rtl: str = ""
    bytes: bool = True

    @property
    def bits(self):
        """Size of the record in bits."""
        return sum(field.width for field in self.fields)

    @property
    def size(self):
        """Size of the record in bytes."""
        return self.bits // 8

    def places(self):
        """Yields each field with the number of its first bit."""
        at = 0
        for field in self.fields:
            yield at, field
            at += field.width


def _vector(name, text):
    return Field(name, 16, f"{text}, s2.14", count=3, signed=True)


def _reserved(bits, count=1):
    return Field("reserved", bits, "0", count=count)


_COLOUR = Field("colour", 16, "RGB565", rust="Rgb565")

HEADER = Record("MeshHeader", "Header of a mesh.", (
    Field("magic", 8, "`GLM2`", count=4),
    Field("length", 32, "length of the whole mesh in bytes"),
    Field("chunks", 32, "number of chunks, at least 1"),
    Field("vertices", 32, "number of vertices in all chunks"),
    Field("triangles", 32, "number of triangles in all chunks"),
    Field("radius", 32, "radius about the origin, u.14, rounded up"),
    Field("checksum", 32, "CRC-32 of all other bytes"),
    Field("attributes", 32, "a bit for each optional attribute that the mesh has"),
))

CHUNK = Record("ChunkHeader", "Header of a chunk of a mesh.", (
    Field("vertices", 32, "number of vertices, 1 to 65,535"),
    Field("triangles", 32, "number of triangles"),
    _reserved(32, count=2),
), rtl="chunk_t")

VERTEX = Record("Vertex", "Vertex of a mesh.", (
    _vector("position", "place"), _vector("normal", "normal of the surface"),
    Field("colour", 16, "the highest 5, 6 and 5 bits of red, green and blue: RGB565", rust="Rgb565"),
    Field("fine", 8, "the lowest 3, 2 and 3 bits of red, green and blue, XOR the highest bits of the channel; 0 for a colour of RGB565"),
    _reserved(8),
), rtl="vertex_t")

TRIANGLE = Record("Triangle", "Triangle of a mesh.", (
    Field("indices", 16, "numbers of the vertices in the chunk, counter-clockwise seen from outside", count=3),
    _COLOUR, _vector("normal", "normal of the face"),
    Field("texture", 8, "number of its texture in the mesh, from 1; 0: none"), _reserved(8),
), rtl="triangle_t")

TEXTURE = Record("TextureHeader", "Header of a texture.", (
    Field("magic", 8, "`GLT1`", count=4),
    Field("length", 32, "length of the whole texture in bytes"),
    Field("checksum", 32, "CRC-32 of all other bytes"),
    Field("width_log2", 8, "base-2 logarithm of the width, 3 to 10"),
    Field("height_log2", 8, "base-2 logarithm of the height, 3 to 10"),
    Field("levels", 8, "number of mip levels: 1, or down to a side of 1 in both directions"),
    Field("format", 8, "texels: 0 RGB565, 1 indices of 256 colours, 2 indices of 16 colours"),
    Field("wrap", 8, "wrapping across and down: 0 repeat, 1 mirror, 2 clamp", count=2),
    Field("filter", 8, "0: the nearest texel; 1: bilinear"),
    Field("cut_out", 8, "1: texels with the value of `key` are transparent"),
    Field("key", 16, "value of a transparent texel: a colour or an index"),
    Field("blend", 8, "0 opaque; 1 to 7 opacity in eighths; 8 added to the picture behind it"),
    _reserved(8, count=9),
), rtl="texture_header_t")

ATTRIBUTES = (
    Record("TextureCoordinates", "Texture coordinates of a vertex.", (
        Field("s", 32, "across, 1 is the width of the texture, s16.16", signed=True),
        Field("t", 32, "down, 1 is the height of the texture, s16.16", signed=True),
    )),
)
"""Elements of the optional attributes of a mesh's vertices, in the order of their bits in the mesh's header."""

FIRST_ATTRIBUTE = 4
"""Number of the bit of the first optional attribute. The lower bits are 0; they belong to attributes that every mesh has in its
records: positions, faces, normals and colours."""

TEXTURES_BIT = 31
"""Number of the bit of `attributes` that is set in a mesh with textures. The textures follow the arrays of its attributes."""

SEGMENT_END = Record("segment_end", "End point of a segment.", (
    Field("x", 20, "x, s12.8"), _reserved(12), Field("y", 20, "y, s12.8"), _reserved(12),
    Field("w", 24, "depth code before its rounding, u18.6"), _reserved(8),
    Field("side", 16, "colour, RGB565, in the first end; bias in the second end"), _reserved(16),
), rtl="segment_end_t", bytes=False)

STEPS = Record("steps", "Increments of an edge function.", (
    Field("x", 21, "increment of E' for one pixel to the right, s21"), Field("y", 21, "increment of E' for one pixel down, s21"),
), rtl="steps_t", bytes=False)

PLANE = Record("plane", "Plane of a depth or of a channel of light.", (
    Field("start", 32, "accumulator at the start of the triangle, 18.14, modulo 2^32"),
    Field("step_x", 32, "its increment for one pixel to the right"),
    Field("step_y", 32, "its increment for one pixel down"),
), rtl="plane_t", bytes=False)

DESCRIPTOR = Record("descriptor", "Triangle after the setup, three words of 16 bytes.", (
    Field("start", 34, "E' of each edge at the start, s34", count=3),
    Field("depth_start", 32, "depth accumulator at the start, 18.14, modulo 2^32"),
    Field("depth_step_x", 32, "Gx: its increment for one pixel to the right"),
    Field("depth_step_y", 32, "Gy: its increment for one pixel down"),
    Field("steps", STEPS.bits, "of each edge", count=3, record=STEPS),
    Field("top", 10, "first row"),
    Field("bottom", 10, "one past the last row"),
    Field("group_left", 8, "first group of eight columns in the bounds"),
    Field("group_right", 8, "last group in the bounds"),
    Field("group_start", 8, "group of the start"),
    Field("colour", 16, "colour, RGB565, after shading"),
), rtl="descriptor_t", bytes=False)

PLANES = Record("planes", "Planes of light of a triangle, in the three words after its descriptor.", (
    Field("light", PLANE.bits, "of red, green and blue", count=3, record=PLANE),
    Field("smooth", 1, "1: smooth; 0: flat, in the colour of the descriptor"),
), rtl="planes_t", bytes=False)

TEXTURE_PLANES = Record("texture_planes", "Texture of a triangle, in the two words after its descriptor.", (
    Field("planes", PLANE.bits, "of s and t", count=2, record=PLANE),
    Field("light", 8, "of red, green and blue under flat shading, u0.8", count=3),
    Field("range", 4, "base-2 logarithms of the ranges of s and t, in repeats", count=2),
    Field("periods", 4, "base of clamped coordinates s and t, s4, in units of two repeats", count=2),
    Field("texture", 8, "number of its texture in the frame's table, from 1; 0: none"),
    Field("linear", 1, "1: orthographic projection"),
), rtl="texture_planes_t", bytes=False)

PIECE = Record("piece", "Piece of a line.", (
    Field("x_major", 1, "1: a pixel in each column, otherwise in each row"),
    Field("left", 1, "towards lower columns"),
    Field("up", 1, "towards lower rows"),
    Field("column", 11, "column of the first pixel"),
    Field("row", 10, "row of the first pixel"),
    Field("count", 12, "pixels to the end of the line"),
    Field("error", 21, "error of the second pixel, s21; if at least 0, the step to this pixel also moves along the minor axis"),
    Field("minor", 20, "increment of the error for a pixel without a step along the minor axis"),
    Field("fall", 21, "increment of the error for a pixel with such a step, s21: minor − major"),
    Field("depth", 34, "depth accumulator of the first pixel, with the bias and half a code, s20.14"),
    Field("depth_step", 34, "increment of the depth for one pixel, s20.14"),
    _COLOUR,
), rtl="piece_t", bytes=False)

STORED_PIECE = Record("stored_piece", "Piece in memory, in the place of a descriptor.", (
    Field("repeats", 128, "bits 0 to 127 of the piece again"),
    Field("low", 128, "bits 0 to 127 of the piece"),
    Field("repeats_low", 64, "bits 0 to 63 of the piece again"),
    Field("high", 38, "bits 128 to 165 of the piece"),
    _reserved(8),
    Field("mark", 2, "3; in a triangle at most 2, because no picture has 192 groups of columns"),
    _COLOUR,
), rtl="stored_piece_t", bytes=False)

FLASH_HEADER = Record("FlashHeader", "Header of the contents of a flash image.", (
    Field("magic", 8, "`GFC1`", count=4),
    Field("length", 32, "length of the contents in bytes"),
    Field("items", 32, "number of items"),
    Field("checksum", 32, "CRC-32 of header and list, without this word"),
))

FLASH_ENTRY = Record("FlashEntry", "Entry of the list of items of a flash image.", (
    Field("kind", 32, "kind: 1 mesh, 2 scene, 3 list, 4 texture, 5 program"),
    Field("length", 32, "length of the item in bytes"),
    Field("checksum", 32, "CRC-32 of the item"),
    _reserved(32),
    Field("name", 8, "name: 1 to 24 visible characters of ASCII, then zeros", count=32),
))

FIRMWARE_HEADER = Record("FirmwareHeader", "Header of the firmware in a flash image: that of LiteX's flash boot.", (
    Field("length", 32, "length of the program in bytes"),
    Field("checksum", 32, "CRC-32 of the program"),
))

RECORDS = (HEADER, CHUNK, VERTEX, TRIANGLE, *ATTRIBUTES, TEXTURE, SEGMENT_END, STEPS, DESCRIPTOR, PLANE, PLANES,
           TEXTURE_PLANES, PIECE, STORED_PIECE, FLASH_HEADER, FLASH_ENTRY, FIRMWARE_HEADER)

LIGHT_BYTES = -(-PLANES.bits // 128) * 16
"""Size in bytes of the planes of light after a descriptor."""

TEXTURE_BYTES = -(-TEXTURE_PLANES.bits // 128) * 16
"""Size in bytes of the texture after a descriptor."""

PIECE_MARK = 3

WORD_BYTES = 16


def files():
    """Returns the texts of the generated files by path."""
    return {
        RTL / "common" / "records_pkg.sv": _package(),
        CORE / "records.rs": _rust(),
        ROOT / "docs" / "formats" / "records.md": _page(),
    }


def _package():
    return package("records_pkg", "records.py", "Records in memory. docs/formats/records.md explains the fields.", [
        f"    // Value of the field `mark` of a stored_piece_t.\n    localparam logic [1:0] PIECE_MARK = 2'd{PIECE_MARK};",
        *(_struct(record).typedef() for record in RECORDS if record.rtl),
    ])


def _struct(record):
    """Returns the type of a record. Nested records become vectors, because Yosys reads an array of structs as a narrower type,
    without a warning."""
    members = {}
    for at, field in reversed(list(record.places())):
        name = f"reserved_{at}" if field.name == "reserved" else field.name
        members[name] = Signal(field.bits) if field.count == 1 else [Signal(field.bits) for _ in range(field.count)]
    return Struct(record.rtl, record.text, members)


def _rust():
    parts = [_rust_struct(record) if record.bytes else _rust_fields(record) for record in RECORDS]
    names = [record.name for record in ATTRIBUTES]
    variants = "\n".join(f"    /// {record.text}\n    {record.name} = {bit}," for bit, record in enumerate(ATTRIBUTES, FIRST_ATTRIBUTE))
    sizes = "\n".join(f"            Self::{name} => {name}::BYTES," for name in names)
    return f"""//! Records in memory (docs/formats/records.md).
{generated("//", "records.py")}

use core::ops::Range;

use crate::bits::Bits;
use crate::colour::Rgb565;

/// Size of a memory word in bytes. Every record begins at a multiple of this size, or of its own size if that is smaller.
pub const WORD: usize = {WORD_BYTES};

/// Value of `mark` in a piece of a line, which is stored in place of a descriptor.
pub const PIECE_MARK: u64 = {PIECE_MARK};

/// The bit in [`MeshHeader::attributes`] of a mesh with textures, which follow the arrays of its attributes.
pub const TEXTURES: u32 = 1 << {TEXTURES_BIT};

/// An optional attribute of a mesh's vertices. The discriminant is the number of its bit in [`MeshHeader::attributes`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Attribute {{
{variants}
}}

impl Attribute {{
    /// All attributes, by their numbers.
    pub const ALL: [Self; {len(names)}] = [{", ".join(f"Self::{name}" for name in names)}];

    /// Returns the attribute's bit in the header, as a mask.
    pub const fn bit(self) -> u32 {{
        1 << self as u32
    }}

    /// Returns the size in bytes of an element, the attribute of one vertex.
    pub const fn bytes(self) -> usize {{
        match self {{
{sizes}
        }}
    }}
}}

/// Returns the bytes of the field at byte `at` of a record.
// Reads an array, because the compiler generates more instructions for single bytes.
const fn field<const N: usize>(record: &[u8], at: usize) -> [u8; N] {{
    match record.split_at(at).1.first_chunk() {{
        Some(bytes) => *bytes,
        None => [0; N],
    }}
}}

""" + "\n".join(parts)


def _rust_struct(record):
    """Returns the Rust struct of a record with `bytes`, with functions to read and write it, and with the byte ranges of its fields."""
    fields, places, reads, writes, used = [], [], [], [], set()
    for at, field in record.places():
        start, size, end = at // 8, field.bits // 8, (at + field.width) // 8
        places.append(f"    /// Byte range of the field `{field.name}`.\n"
                      f"    pub const {field.name.upper()}: Range<usize> = {start}..{end};")
        if field.name == "reserved":
            continue
        number = f"{'i' if field.signed else 'u'}{field.bits}"
        kind = field.rust or number
        fields.append(f"    /// {_sentence(field.text)}\n    pub {field.name}: {kind if field.count == 1 else f'[{kind}; {field.count}]'},")
        elements = [[f"b{start + size * i + byte}" for byte in range(size)] for i in range(field.count)]
        used.update(name for names in elements for name in names)
        values = [f"{number}::from_le_bytes(field(bytes, {start + size * i}))" for i in range(field.count)]
        values = [f"{field.rust}({value})" if field.rust else value for value in values]
        value = values[0] if field.count == 1 else f"field(bytes, {start})" if size == 1 else f"[{', '.join(values)}]"
        reads.append(f"            {field.name}: {value},")
        for i, names in enumerate(elements):
            value = f"self.{field.name}{'' if field.count == 1 else f'[{i}]'}{'.0' if field.rust else ''}"
            writes.append(f"        let [{', '.join(names)}] = {value}.to_le_bytes();" if size > 1 else f"        let {names[0]} = {value};")
    made = ", ".join(f"b{byte}" if f"b{byte}" in used else "0" for byte in range(record.size))
    lines = "\n".join
    default = "Default, " if record.size <= 32 else ""
    return f"""/// {record.text}
#[derive(Clone, Copy, Debug, {default}PartialEq, Eq)]
pub struct {record.name} {{
{lines(fields)}
}}

impl {record.name} {{
    /// Size of the record in bytes.
    pub const BYTES: usize = {record.size};
{lines(places)}

    /// Returns the record with these bytes in memory.
    pub const fn from_bytes(bytes: &[u8; Self::BYTES]) -> Self {{
        Self {{
{lines(reads)}
        }}
    }}

    /// Returns the bytes of the record in memory.
    pub const fn to_bytes(self) -> [u8; Self::BYTES] {{
{lines(writes)}
        [{made}]
    }}
}}
"""


def _rust_fields(record):
    """Returns a Rust module with the bit positions of the fields of a record without `bytes`."""
    constants = [f"    /// Size of the record in bits.\n    pub const BITS: usize = {record.bits};"]
    for at, field in record.places():
        inner = list(field.record.places()) if field.record else [(0, field)]
        for offset, part in inner:
            name = f"{field.name}_{part.name}" if field.record else field.name
            text = f"{part.text}, {field.text}" if field.record else field.text
            if name != "reserved":
                constants.append(f"    /// {_sentence(text)}\n"
                                 f"    pub const {name.upper()}: Bits = Bits::new({at + offset}, {part.bits}, {field.bits});")
    return f"""/// {record.text}
pub mod {record.name} {{
    use super::Bits;

{chr(10).join(constants)}
}}
"""


def _sentence(text):
    return f"{text[:1].upper()}{text[1:]}."


def _page():
    sections = []
    for record in RECORDS:
        unit = 8 if record.bytes else 1
        size = f"{record.bits // unit} {'bytes' if record.bytes else 'bits'}"
        title = re.sub(r"(?<=[a-z])(?=[A-Z])|_", " ", record.name).capitalize()
        sections.append("\n".join([
            f"## {title}", "", f"{record.text} {size}.", "", f"| {'bytes' if record.bytes else 'bits'} | field | content |",
            "|---|---|---|", *(_row(at, field, unit) for at, field in record.places()), ""]))
    attributes = [f"| {bit} | {record.name} | {record.text} {record.size} bytes |" for bit, record in enumerate(ATTRIBUTES, FIRST_ATTRIBUTE)]
    sizes = [f"| {size.text} | {size.band_lines} | {size.bands} |" for size in SIZES]
    return "\n".join([
        generated("<!--", "records.py") + " -->", "",
        "# Records", "",
        "The fields of the records that gateware, firmware and host exchange in memory and in files. All fields are little-endian: bit 0 is the",
        "lowest bit of the first byte. RTL uses the fields by name from `records_pkg`, Rust from `glint_core::records`.",
        "The other [pages](README.md) explain the values and how records follow each other.", "",
        "\n".join(sections),
        "## Optional attributes", "",
        "Attributes of the vertices of a mesh, with their bits in the field `attributes` of the mesh's header.", "",
        "| bit | attribute | element |", "|---|---|---|",
        f"| 0–{FIRST_ATTRIBUTE - 1} | positions, faces, normals, colours | in the records of every mesh; the bits are 0 |", *attributes,
        f"| {TEXTURES_BIT} | textures | [those of the mesh](texture.md), after the arrays of the attributes |", "",
        "## Bands", "",
        "A picture is drawn in horizontal strips, the bands.", "",
        "| picture | lines of a band | bands |", "|---|---|---|", *sizes, "",
        f"A set of band lists begins with a table of {LIST_TABLE_WORDS} words of 16 bytes: the lengths of {LISTS} lists. {LIST_GAP_WORDS} "
        "words are between two lists.", "",
    ])


def _row(at, field, unit):
    first, last = at // unit, (at + field.width) // unit - 1
    parts = "" if field.record is None else f"`{field.record.name}` "
    count = f"{field.count} × " if field.count > 1 else ""
    kind = f"{'s' if field.signed else 'u'}{field.bits}: " if unit == 8 else ""
    return f"| {first if first == last else f'{first}–{last}'} | {field.name} | {count}{kind}{parts}{field.text} |"
