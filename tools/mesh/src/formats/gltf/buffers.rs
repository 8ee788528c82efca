//! The buffers of a glTF, and access to the values in them.

use super::json::{Accessor, Dimensions, Index, Root, item};
use crate::error::{FormatError, MAX_FILE, MAX_POINTS, quote};
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use std::borrow::Cow;

/// Reads a file in the folder of the glTF; `None` if it cannot be read.
pub type Beside<'a> = &'a mut dyn FnMut(&str) -> Option<Vec<u8>>;

/// The buffers of a file.
pub struct Buffers<'a> {
    root: &'a Root,
    bytes: Vec<Cow<'a, [u8]>>,
}

impl<'a> Buffers<'a> {
    /// Reads all buffers. `binary` is the binary chunk of a `.glb`; `beside` reads a file in the same folder.
    ///
    /// # Errors
    /// A buffer cannot be read or is too short, or the total length of the buffers exceeds
    /// [`MAX_FILE`].
    pub fn read(root: &'a Root, binary: &'a [u8], beside: Beside) -> Result<Self, FormatError> {
        let mut buffers = Vec::new();
        let mut total = 0;
        for (index, buffer) in root.buffers.iter().enumerate() {
            let bytes = match &buffer.uri {
                None => Cow::Borrowed(binary),
                Some(uri) => Cow::Owned(load(uri, "a buffer", beside)?),
            };
            if bytes.len() < buffer.byte_length {
                return Err(FormatError::whole(
                    format!("{} bytes in buffer {index}", buffer.byte_length),
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
        Ok(Self {
            root,
            bytes: buffers,
        })
    }

    /// The values of an accessor. It must have one of the given dimensions and, if `count` is
    /// given, this number of values.
    ///
    /// # Errors
    /// The accessor does not exist, its values have another type or count, or exceed their buffer.
    pub fn values(
        &self,
        index: Index,
        dimensions: &[Dimensions],
        count: Option<usize>,
    ) -> Result<Values<'_>, FormatError> {
        let accessor = item(&self.root.accessors, index, "accessors")?;
        let refuse = |expected: String, found: String| {
            FormatError::whole(format!("accessor {index} {expected}"), found)
        };
        let components = match accessor.dimensions {
            found if !dimensions.contains(&found) => {
                return Err(refuse(format!("of {dimensions:?}"), format!("{found:?}")));
            }
            Dimensions::Vec2 => 2,
            Dimensions::Vec3 => 3,
            Dimensions::Vec4 => 4,
            Dimensions::Scalar | Dimensions::Other => 1,
        };
        if let Some(count) = count.filter(|count| *count != accessor.count) {
            let expected = format!("of {count} values, as many as positions");
            return Err(refuse(expected, accessor.count.to_string()));
        }
        let kind = Kind::of(accessor.component_type).ok_or_else(|| {
            let expected = "of the component type 5120 to 5126, except 5124".into();
            refuse(expected, accessor.component_type.to_string())
        })?;
        let size = components * kind.size();
        let (bytes, stride) = match accessor.buffer_view {
            Some(view) => {
                let place = (view, accessor.byte_offset);
                self.slice(index, place, accessor.count, size)?
            }
            None if accessor.sparse.is_none() => {
                let expected = "with values in a buffer".into();
                return Err(refuse(expected, "one without data".into()));
            }
            None if accessor.count > MAX_POINTS => {
                let expected = format!("of at most {MAX_POINTS} values");
                return Err(refuse(expected, accessor.count.to_string()));
            }
            None => (Cow::Owned(vec![0; accessor.count * size]), size),
        };
        let mut values = Values {
            bytes,
            stride,
            size,
            count: accessor.count,
            kind,
            normalised: accessor.normalized,
        };
        self.replace_sparse(&mut values, index, accessor)?;
        Ok(values)
    }

    /// The bytes of a view; `None` if it is not within its buffer.
    pub fn view(&self, index: Index) -> Option<&[u8]> {
        let view = self.root.buffer_views.get(index as usize)?;
        let buffer = self.bytes.get(view.buffer as usize)?;
        buffer.get(view.byte_offset..)?.get(..view.byte_length)
    }

    /// The bytes of `count` values of `size` bytes each, starting at an offset in a view, and the
    /// stride of the values in bytes.
    fn slice(
        &self,
        accessor: Index,
        (view, offset): (Index, usize),
        count: usize,
        size: usize,
    ) -> Result<(Cow<'_, [u8]>, usize), FormatError> {
        let view = item(&self.root.buffer_views, view, "buffer views")?;
        let stride = match view.byte_stride {
            0 => size,
            stride => stride,
        };
        if stride < size {
            return Err(FormatError::whole(
                format!("accessor {accessor} with a stride of at least {size}"),
                stride.to_string(),
            ));
        }
        let length = match count.checked_sub(1) {
            None => Some(0),
            Some(last) => last
                .checked_mul(stride)
                .and_then(|start| start.checked_add(size)),
        };
        let bytes = self.bytes.get(view.buffer as usize).and_then(|buffer| {
            let view = buffer.get(view.byte_offset..)?.get(..view.byte_length)?;
            view.get(offset..)?.get(..length?)
        });
        let bytes = bytes.ok_or_else(|| {
            FormatError::whole(
                format!("accessor {accessor} within its buffer"),
                format!("{count} values that end outside of it"),
            )
        })?;
        Ok((Cow::Borrowed(bytes), stride))
    }

    /// Replaces the values that are listed by a sparse accessor.
    fn replace_sparse(
        &self,
        values: &mut Values,
        index: Index,
        accessor: &Accessor,
    ) -> Result<(), FormatError> {
        let Some(sparse) = &accessor.sparse else {
            return Ok(());
        };
        let kind = Kind::of(sparse.indices.component_type).unwrap_or(Kind::U32);
        let place = (sparse.indices.buffer_view, sparse.indices.byte_offset);
        let (bytes, stride) = self.slice(index, place, sparse.count, kind.size())?;
        let indices = Values {
            bytes,
            stride,
            size: kind.size(),
            count: sparse.count,
            kind,
            normalised: false,
        };
        let place = (sparse.values.buffer_view, sparse.values.byte_offset);
        let (new, stride) = self.slice(index, place, sparse.count, values.size)?;
        let bytes = values.bytes.to_mut();
        for i in 0..sparse.count {
            let at = indices.index(i);
            if at >= values.count {
                return Err(FormatError::whole(
                    format!(
                        "accessor {index} with sparse indices below {}",
                        values.count
                    ),
                    at.to_string(),
                ));
            }
            bytes[at * values.stride..][..values.size]
                .copy_from_slice(&new[i * stride..][..values.size]);
        }
        Ok(())
    }
}

/// Reads the data of a URI, which contains the data or names a file in the same folder. `what`
/// names the part of the glTF in errors.
///
/// # Errors
/// The data are not in base64, or the file cannot be read.
pub fn load(uri: &str, what: &str, beside: Beside) -> Result<Vec<u8>, FormatError> {
    let refuse = |expected: String| FormatError::whole(expected, quote(uri.as_bytes()));
    match uri.strip_prefix("data:") {
        Some(data) => {
            let text = data.split_once(";base64,").map(|(_, text)| text);
            let bytes = text.and_then(|text| BASE64_STANDARD.decode(text).ok());
            bytes.ok_or_else(|| refuse(format!("data of {what} in base64")))
        }
        None => {
            let name = urlencoding::decode(uri).ok();
            let bytes = name.and_then(|name| beside(&name));
            bytes.ok_or_else(|| refuse(format!("the file of {what} in the folder of the glTF")))
        }
    }
}

/// Component type of an accessor.
#[derive(Clone, Copy)]
enum Kind {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Kind {
    fn of(component_type: u32) -> Option<Self> {
        Some(match component_type {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            _ => return None,
        })
    }

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }
}

/// The values of an accessor, each of one to four numbers.
pub struct Values<'a> {
    bytes: Cow<'a, [u8]>,
    stride: usize,
    size: usize,
    /// Number of values.
    pub count: usize,
    kind: Kind,
    /// Whether an integer is a fraction whose denominator is the largest value of its type.
    pub normalised: bool,
}

impl Values<'_> {
    fn numbers(&self, index: usize) -> impl Iterator<Item = f64> {
        let value = &self.bytes[index * self.stride..][..self.size];
        value
            .chunks_exact(self.kind.size())
            .map(|bytes| number(bytes, self.kind, self.normalised))
    }

    /// The first N numbers of the value at `index`, which must exist; missing numbers are 0.
    pub fn vector<const N: usize>(&self, index: usize) -> [f64; N] {
        let mut vector = [0.0; N];
        for (c, number) in vector.iter_mut().zip(self.numbers(index)) {
            *c = number;
        }
        vector
    }

    /// The first number of the value at `index`, which must exist, as an index.
    pub fn index(&self, index: usize) -> usize {
        self.numbers(index).next().unwrap_or(0.0) as usize
    }
}

/// Reads a number. A normalised integer is divided by its type's largest value.
fn number(bytes: &[u8], kind: Kind, normalised: bool) -> f64 {
    let (value, largest) = match (kind, bytes) {
        (Kind::I8, &[a]) => (f64::from(a as i8), 127.0),
        (Kind::U8, &[a]) => (f64::from(a), 255.0),
        (Kind::I16, &[a, b]) => (f64::from(i16::from_le_bytes([a, b])), 32_767.0),
        (Kind::U16, &[a, b]) => (f64::from(u16::from_le_bytes([a, b])), 65_535.0),
        (Kind::U32, &[a, b, c, d]) => (f64::from(u32::from_le_bytes([a, b, c, d])), 1.0),
        (Kind::F32, &[a, b, c, d]) => (f64::from(f32::from_le_bytes([a, b, c, d])), 1.0),
        _ => (0.0, 1.0),
    };
    if normalised {
        (value / largest).max(-1.0)
    } else {
        value
    }
}
