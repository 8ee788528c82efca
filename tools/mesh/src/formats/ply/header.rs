//! Header of a PLY file: its elements and their properties.

use crate::error::{FormatError, Location, MAX_REMARKS, quote};
use crate::formats::text::{Line, Lines};

/// Maximum number of elements in a header and of properties in an element; real files have fewer.
const MAX_DECLARED: usize = 64;

/// Encoding of the values after the header.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// Text, one line per row of an element's table.
    Ascii,
    /// Binary, little-endian.
    LittleEndian,
    /// Binary, big-endian.
    BigEndian,
}

/// The type of one value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scalar {
    Int8,
    Uint8,
    Int16,
    Uint16,
    Int32,
    Uint32,
    Float32,
    Float64,
}

impl Scalar {
    fn parse(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"char" | b"int8" => Self::Int8,
            b"uchar" | b"uint8" => Self::Uint8,
            b"short" | b"int16" => Self::Int16,
            b"ushort" | b"uint16" => Self::Uint16,
            b"int" | b"int32" => Self::Int32,
            b"uint" | b"uint32" => Self::Uint32,
            b"float" | b"float32" => Self::Float32,
            b"double" | b"float64" => Self::Float64,
            _ => return None,
        })
    }

    /// Size in bytes of a binary value.
    pub fn size(self) -> usize {
        match self {
            Self::Int8 | Self::Uint8 => 1,
            Self::Int16 | Self::Uint16 => 2,
            Self::Int32 | Self::Uint32 | Self::Float32 => 4,
            Self::Float64 => 8,
        }
    }

    /// Decodes a value from the first [`size`](Self::size) bytes of `raw`, least significant byte first.
    pub fn decode(self, raw: [u8; 8]) -> f64 {
        let [a, b, c, d, ..] = raw;
        match self {
            Self::Int8 => f64::from(a as i8),
            Self::Uint8 => f64::from(a),
            Self::Int16 => f64::from(i16::from_le_bytes([a, b])),
            Self::Uint16 => f64::from(u16::from_le_bytes([a, b])),
            Self::Int32 => f64::from(i32::from_le_bytes([a, b, c, d])),
            Self::Uint32 => f64::from(u32::from_le_bytes([a, b, c, d])),
            Self::Float32 => f64::from(f32::from_le_bytes([a, b, c, d])),
            Self::Float64 => f64::from_le_bytes(raw),
        }
    }

    fn range(self) -> Option<(f64, f64)> {
        Some(match self {
            Self::Int8 => (f64::from(i8::MIN), f64::from(i8::MAX)),
            Self::Uint8 => (0.0, f64::from(u8::MAX)),
            Self::Int16 => (f64::from(i16::MIN), f64::from(i16::MAX)),
            Self::Uint16 => (0.0, f64::from(u16::MAX)),
            Self::Int32 => (f64::from(i32::MIN), f64::from(i32::MAX)),
            Self::Uint32 => (0.0, f64::from(u32::MAX)),
            Self::Float32 | Self::Float64 => return None,
        })
    }

    /// Whether the type can hold a value parsed from text.
    pub fn holds(self, value: f64) -> bool {
        self.range()
            .is_none_or(|(low, high)| (low..=high).contains(&value) && value.fract() == 0.0)
    }

    /// The value that means full intensity in a colour channel of this type.
    pub fn full_scale(self) -> f64 {
        self.range().map_or(1.0, |(_, high)| high)
    }

    /// Name of the type with an article, for messages.
    pub fn describe(self) -> &'static str {
        match self {
            Self::Int8 => "an int8",
            Self::Uint8 => "a uint8",
            Self::Int16 => "an int16",
            Self::Uint16 => "a uint16",
            Self::Int32 => "an int32",
            Self::Uint32 => "a uint32",
            Self::Float32 => "a float32",
            Self::Float64 => "a float64",
        }
    }
}

/// Type of a property: one value, or a list preceded by its length.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// One value.
    Scalar(Scalar),
    /// A list.
    List {
        /// Type of the list's length.
        count: Scalar,
        /// Type of the list's items.
        item: Scalar,
    },
}

/// A property of an element.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Property {
    /// Name of the property.
    pub name: Vec<u8>,
    /// Type of its values.
    pub kind: Kind,
}

/// An element of a PLY: a table in the file, such as the table of vertices, with one row (instance) for each item.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Element {
    /// Name of the element.
    pub name: Vec<u8>,
    /// Number of instances.
    pub count: u32,
    /// Properties of each instance.
    pub properties: Vec<Property>,
    /// Position of the element's declaration in the header.
    pub place: Location,
}

/// A whole header.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Header {
    /// Encoding of the values.
    pub encoding: Encoding,
    /// Elements in file order.
    pub elements: Vec<Element>,
    /// Remarks on skipped lines, which do not start with a keyword.
    pub remarks: Vec<String>,
}

impl Header {
    /// Parses the header up to and including the line `end_header`. After the call, `lines` starts at the values that follow the
    /// header.
    ///
    /// # Errors
    /// The first line that violates the format.
    pub fn parse(lines: &mut Lines) -> Result<Self, FormatError> {
        let mut encoding = None;
        let mut elements: Vec<Element> = Vec::new();
        let mut remarks = Vec::new();
        let mut number = 0;
        while let Some(line) = lines.next_line()? {
            number = line.number;
            let place = line.place();
            let mut words = [&b""[..]; 6];
            let mut count = 0;
            for word in line.words().take(words.len()) {
                words[count] = word;
                count += 1;
            }
            let refuse = |expected: &str| FormatError::new(place, expected, quote(line.text));
            match (&words[..count], number) {
                ([b"ply"], 1) => {}
                (_, 1) => return Err(refuse("ply")),
                ([b"format", name, b"1.0"], _) => {
                    encoding = Some(match *name {
                        b"ascii" => Encoding::Ascii,
                        b"binary_little_endian" => Encoding::LittleEndian,
                        b"binary_big_endian" => Encoding::BigEndian,
                        _ => {
                            return Err(refuse(
                                "format ascii, binary_little_endian or binary_big_endian 1.0",
                            ));
                        }
                    });
                }
                ([] | [b"comment" | b"obj_info", ..], _) => {}
                ([b"element", name, count], _) if elements.len() < MAX_DECLARED => {
                    let count = parse_count(count)
                        .ok_or_else(|| refuse("a count of elements up to 2^32 - 1"))?;
                    elements.push(Element {
                        name: name.to_vec(),
                        count,
                        properties: Vec::new(),
                        place,
                    });
                }
                ([b"property", kind @ .., name], _) => {
                    let element = elements
                        .last_mut()
                        .ok_or_else(|| refuse("element before the first property"))?;
                    let kind = parse_kind(kind).ok_or_else(|| {
                        refuse("property TYPE NAME or property list TYPE TYPE NAME")
                    })?;
                    if element.properties.len() == MAX_DECLARED {
                        return Err(refuse("at most 64 properties of an element"));
                    }
                    element.properties.push(Property {
                        name: name.to_vec(),
                        kind,
                    });
                }
                ([b"end_header"], _) => {
                    let encoding =
                        encoding.ok_or_else(|| refuse("a format line before end_header"))?;
                    return Ok(Self {
                        encoding,
                        elements,
                        remarks,
                    });
                }
                ([b"format" | b"element" | b"property" | b"end_header", ..], _) => {
                    return Err(header_line(line));
                }
                _ if remarks.len() < MAX_REMARKS => remarks.push(format!(
                    "{place}the header line {} is skipped",
                    quote(line.text)
                )),
                _ => {}
            }
        }
        Err(FormatError::new(
            Location::Line(number.max(1)),
            if number == 0 { "ply" } else { "end_header" },
            "the end of the file",
        ))
    }
}

fn header_line(line: Line) -> FormatError {
    FormatError::new(
        line.place(),
        "format, comment, element (at most 64), property or end_header",
        quote(line.text),
    )
}

fn parse_count(word: &[u8]) -> Option<u32> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

fn parse_kind(words: &[&[u8]]) -> Option<Kind> {
    match words {
        [scalar] => Scalar::parse(scalar).map(Kind::Scalar),
        [b"list", count, item] => {
            let count = Scalar::parse(count).filter(|count| count.range().is_some())?;
            Some(Kind::List {
                count,
                item: Scalar::parse(item)?,
            })
        }
        _ => None,
    }
}
