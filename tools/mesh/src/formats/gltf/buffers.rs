//! Buffers of a glTF, and their values.

use crate::error::{FormatError, MAX_FILE, quote};
use crate::polygons::Vector;
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use gltf::accessor::{DataType, Dimensions};
use gltf::{Accessor, Document};
use std::borrow::Cow;

/// Reads a file in the folder of the glTF; `None` if it cannot be read.
pub type Beside<'a> = &'a mut dyn FnMut(&str) -> Option<Vec<u8>>;

/// The buffers of a file.
pub struct Buffers<'a>(Vec<Cow<'a, [u8]>>);

impl<'a> Buffers<'a> {
    /// Reads all buffers. `binary` is the binary chunk of a `.glb`; `beside` reads a file in the same folder.
    ///
    /// # Errors
    /// A buffer cannot be read or is too short, or all buffers together are longer than [`MAX_FILE`].
    pub fn read(
        document: &Document,
        binary: &'a [u8],
        beside: Beside,
    ) -> Result<Self, FormatError> {
        let mut buffers = Vec::new();
        let mut total = 0;
        for buffer in document.buffers() {
            let bytes = match buffer.source() {
                gltf::buffer::Source::Bin => Cow::Borrowed(binary),
                gltf::buffer::Source::Uri(uri) => Cow::Owned(load(uri, beside)?),
            };
            if bytes.len() < buffer.length() {
                return Err(FormatError::whole(
                    format!("{} bytes in buffer {}", buffer.length(), buffer.index()),
                    bytes.len().to_string(),
                ));
            }
            total += bytes.len();
            if total > MAX_FILE {
                let expected = format!("buffers of at most {MAX_FILE} bytes together");
                return Err(FormatError::whole(expected, "more"));
            }
            buffers.push(bytes);
        }
        Ok(Self(buffers))
    }

    /// The values of an accessor, which must have one of these dimensions, and `count` values if given.
    ///
    /// # Errors
    /// The values have another type or count, are sparse, or are not within their buffer.
    pub fn values(
        &self,
        accessor: &Accessor,
        dimensions: &[Dimensions],
        count: Option<usize>,
    ) -> Result<Values<'_>, FormatError> {
        let refuse = |expected: &str, found: String| {
            FormatError::whole(format!("accessor {} {expected}", accessor.index()), found)
        };
        if !dimensions.contains(&accessor.dimensions()) {
            return Err(refuse(
                &format!("of {dimensions:?}"),
                format!("{:?}", accessor.dimensions()),
            ));
        }
        if let Some(count) = count.filter(|count| *count != accessor.count()) {
            let expected = format!("of {count} values, as many as positions");
            return Err(refuse(&expected, accessor.count().to_string()));
        }
        let (Some(view), None) = (accessor.view(), accessor.sparse()) else {
            let found = "a sparse one, or one without data".into();
            return Err(refuse("with all its values in a buffer", found));
        };
        let size = accessor.size();
        let stride = view.stride().unwrap_or(size);
        if stride < size {
            return Err(refuse(
                &format!("with a stride of at least {size}"),
                stride.to_string(),
            ));
        }
        let length = match accessor.count().checked_sub(1) {
            None => Some(0),
            Some(last) => last
                .checked_mul(stride)
                .and_then(|start| start.checked_add(size)),
        };
        let bytes = self.0.get(view.buffer().index()).and_then(|buffer| {
            let view = buffer.get(view.offset()..)?.get(..view.length())?;
            view.get(accessor.offset()..)?.get(..length?)
        });
        let bytes = bytes.ok_or_else(|| {
            let found = format!("{} values that end outside of it", accessor.count());
            refuse("within its buffer", found)
        })?;
        Ok(Values {
            bytes,
            stride,
            size,
            count: accessor.count(),
            kind: accessor.data_type(),
            normalised: accessor.normalized(),
        })
    }
}

/// Reads a buffer by its URI: data within the file, or a file in the same folder.
fn load(uri: &str, beside: Beside) -> Result<Vec<u8>, FormatError> {
    let refuse = |expected: &str| FormatError::whole(expected, quote(uri.as_bytes()));
    match uri.strip_prefix("data:") {
        Some(data) => {
            let text = data.split_once(";base64,").map(|(_, text)| text);
            let bytes = text.and_then(|text| BASE64_STANDARD.decode(text).ok());
            bytes.ok_or_else(|| refuse("data of a buffer in base64"))
        }
        None => {
            let name = urlencoding::decode(uri).ok();
            let bytes = name.and_then(|name| beside(&name));
            bytes.ok_or_else(|| refuse("the file of a buffer in the folder of the glTF"))
        }
    }
}

/// The values of an accessor, each of one to 16 numbers.
pub struct Values<'a> {
    bytes: &'a [u8],
    stride: usize,
    size: usize,
    /// Number of values.
    pub count: usize,
    kind: DataType,
    /// Whether integers are fractions of their type's largest value.
    pub normalised: bool,
}

impl Values<'_> {
    fn numbers(&self, index: usize) -> impl Iterator<Item = f64> {
        let value = &self.bytes[index * self.stride..][..self.size];
        value
            .chunks_exact(self.kind.size())
            .map(|bytes| number(bytes, self.kind, self.normalised))
    }

    /// The first three numbers of an existing value.
    pub fn vector(&self, index: usize) -> Vector {
        let mut vector = [0.0; 3];
        for (c, number) in vector.iter_mut().zip(self.numbers(index)) {
            *c = number;
        }
        vector
    }

    /// The first number of an existing value, as an index.
    pub fn index(&self, index: usize) -> usize {
        self.numbers(index).next().unwrap_or(0.0) as usize
    }
}

/// Reads a number. A normalised integer is divided by its type's largest value.
fn number(bytes: &[u8], kind: DataType, normalised: bool) -> f64 {
    let (value, largest) = match (kind, bytes) {
        (DataType::I8, &[a]) => (f64::from(a as i8), 127.0),
        (DataType::U8, &[a]) => (f64::from(a), 255.0),
        (DataType::I16, &[a, b]) => (f64::from(i16::from_le_bytes([a, b])), 32_767.0),
        (DataType::U16, &[a, b]) => (f64::from(u16::from_le_bytes([a, b])), 65_535.0),
        (DataType::U32, &[a, b, c, d]) => (f64::from(u32::from_le_bytes([a, b, c, d])), 1.0),
        (DataType::F32, &[a, b, c, d]) => (f64::from(f32::from_le_bytes([a, b, c, d])), 1.0),
        _ => (0.0, 1.0),
    };
    if normalised {
        (value / largest).max(-1.0)
    } else {
        value
    }
}
