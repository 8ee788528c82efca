//! Layout of packed types as resolved by Verilator: the bits of each member.

use std::collections::BTreeMap;
use std::sync::Arc;

use serde::Deserialize;
use thiserror::Error;

/// A packed type: a vector, an enumeration, an array or a structure. Cheap to clone.
#[derive(Clone, Debug, Deserialize)]
#[serde(from = "Shape")]
pub struct Layout {
    shape: Arc<Shape>,
    width: usize,
}

/// A type in the JSON description that `gateware/verilate/description.py` writes.
#[derive(Debug, Deserialize)]
#[serde(untagged)]
enum Shape {
    Array {
        count: usize,
        /// Lowest index; the element with this index is in the lowest bits.
        lowest: usize,
        element: Layout,
    },
    Structure {
        name: String,
        /// Names and types of the members, the member in the highest bits first.
        members: Vec<(String, Layout)>,
    },
    Enumeration {
        name: String,
        width: usize,
        values: BTreeMap<String, u64>,
    },
    Vector {
        width: usize,
        signed: bool,
    },
}

impl From<Shape> for Layout {
    fn from(shape: Shape) -> Self {
        let width = match &shape {
            Shape::Array { count, element, .. } => count * element.width,
            Shape::Structure { members, .. } => {
                members.iter().map(|(_, member)| member.width).sum()
            }
            Shape::Enumeration { width, .. } | Shape::Vector { width, .. } => *width,
        };
        let shape = Arc::new(shape);
        Self { shape, width }
    }
}

/// Part of a value of a packed type: the bits from `low` on, which have the type `layout`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Part<'a> {
    pub low: usize,
    pub layout: &'a Layout,
}

/// Error of an access to a part of a packed value: the path names no part, or the value does not fit the part.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum LayoutError {
    /// A name that is not a member of a structure.
    #[error("{path}: no member `{member}` in {structure}; its members: {}", members.join(", "))]
    Member {
        /// The whole path.
        path: String,
        /// The unknown name.
        member: String,
        /// Name of the structure's type.
        structure: String,
        /// Names of the structure's members.
        members: Vec<String>,
    },
    /// An index outside of an array.
    #[error("{path}: index {index} outside of {lowest}..={highest}")]
    Index {
        /// The whole path.
        path: String,
        /// The index in the path.
        index: String,
        /// The lowest index.
        lowest: usize,
        /// The highest index.
        highest: usize,
    },
    /// A path that continues with a member or an index where the type has none.
    #[error("{path}: no `{rest}` in {found}")]
    Leaf {
        /// The whole path.
        path: String,
        /// Rest of the path, which names no part of the type `found`.
        rest: String,
        /// Description of the type that the path has reached before `rest`.
        found: String,
    },
    /// A value that does not fit the bits of its part.
    #[error("{path}: {value} does not fit {width} bits")]
    Value {
        /// The path.
        path: String,
        /// The value.
        value: String,
        /// Number of bits of the part.
        width: usize,
    },
    /// A name that is not a value of an enumeration.
    #[error("{path}: no value `{name}` in {found}; its values: {}", values.join(", "))]
    Name {
        /// The path.
        path: String,
        /// The unknown name.
        name: String,
        /// Description of the part's type.
        found: String,
        /// Names of that type's values; empty if the type is not an enumeration.
        values: Vec<String>,
    },
    /// A list of values whose length differs from the length of the array that they are for.
    #[error("{path}: {found} values for {found_in}")]
    Length {
        /// The path.
        path: String,
        /// Number of values in the list.
        found: usize,
        /// Description of the part's type.
        found_in: String,
    },
}

impl Layout {
    /// Number of bits of the type.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Returns the type of the part at `path`.
    ///
    /// # Errors
    /// When the path names no part.
    pub fn part(&self, path: &str) -> Result<Self, LayoutError> {
        self.find(path).map(|part| part.layout.clone())
    }

    /// Whether a value of this type is a two's complement number.
    pub(crate) fn is_signed(&self) -> bool {
        matches!(*self.shape, Shape::Vector { signed: true, .. })
    }

    /// Finds a part by its path: names of members, each after a `.`, and indices in `[]`, as in `place.line` or
    /// `[1].half[2]`. The empty path is the whole type.
    pub(crate) fn find(&self, path: &str) -> Result<Part<'_>, LayoutError> {
        let mut part = Part {
            low: 0,
            layout: self,
        };
        let mut rest = path;
        while !rest.is_empty() {
            rest = part.enter(path, rest)?;
        }
        Ok(part)
    }

    /// Names of a structure's members, the member in the highest bits first; empty for any other type.
    pub(crate) fn member_names(&self) -> Vec<String> {
        match &*self.shape {
            Shape::Structure { members, .. } => {
                members.iter().map(|(name, _)| name.clone()).collect()
            }
            _ => Vec::new(),
        }
    }

    /// Number of elements of an array, and the type of its elements; `None` for any other type.
    pub(crate) fn elements(&self) -> Option<(usize, &Self)> {
        match &*self.shape {
            Shape::Array { count, element, .. } => Some((*count, element)),
            _ => None,
        }
    }

    /// Names and values of an enumeration; `None` for any other type.
    pub(crate) fn values(&self) -> Option<&BTreeMap<String, u64>> {
        match &*self.shape {
            Shape::Enumeration { values, .. } => Some(values),
            _ => None,
        }
    }

    /// Describes the type for error messages.
    pub(crate) fn describe(&self) -> String {
        match &*self.shape {
            Shape::Array { count, element, .. } => {
                format!("an array of {count}, each {}", element.describe())
            }
            Shape::Structure { name, .. } | Shape::Enumeration { name, .. } => name.clone(),
            Shape::Vector { width, .. } => format!("a vector of {width} bits"),
        }
    }
}

impl Part<'_> {
    /// Narrows this part to the member or element at the start of `rest`, and returns the remaining path. `path` is the
    /// whole path, for errors.
    fn enter<'p>(&mut self, path: &str, rest: &'p str) -> Result<&'p str, LayoutError> {
        match (&*self.layout.shape, rest.strip_prefix('[')) {
            (
                Shape::Array {
                    count,
                    lowest,
                    element,
                },
                Some(inside),
            ) => {
                let (index, rest) = inside.split_once(']').unwrap_or((inside, ""));
                let number = index.parse::<usize>().ok();
                let number = number
                    .and_then(|number| number.checked_sub(*lowest))
                    .filter(|number| number < count)
                    .ok_or_else(|| LayoutError::Index {
                        path: path.to_owned(),
                        index: index.to_owned(),
                        lowest: *lowest,
                        highest: lowest + count - 1,
                    })?;
                self.low += number * element.width;
                self.layout = element;
                Ok(rest)
            }
            (Shape::Structure { name, members }, None) => {
                let rest = rest.strip_prefix('.').unwrap_or(rest);
                let (member, rest) = rest.split_at(rest.find(['.', '[']).unwrap_or(rest.len()));
                let position = members
                    .iter()
                    .position(|(name, _)| name == member)
                    .ok_or_else(|| LayoutError::Member {
                        path: path.to_owned(),
                        member: member.to_owned(),
                        structure: name.clone(),
                        members: members.iter().map(|(name, _)| name.clone()).collect(),
                    })?;
                self.low += members[position + 1..]
                    .iter()
                    .map(|(_, member)| member.width)
                    .sum::<usize>();
                self.layout = &members[position].1;
                Ok(rest)
            }
            _ => Err(LayoutError::Leaf {
                path: path.to_owned(),
                rest: rest.to_owned(),
                found: self.layout.describe(),
            }),
        }
    }
}
