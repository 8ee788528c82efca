//! Bit layout of packed types, as resolved by Verilator.

use std::collections::BTreeMap;
use std::sync::Arc;

use serde::Deserialize;

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
        /// Lowest index, the index of the element in the lowest bits.
        lowest: usize,
        element: Layout,
    },
    Structure {
        name: String,
        /// Names and types of the members, from the highest bits down.
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

/// Part of a value of a packed type: the bits from `low` up, of the type `layout`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Member<'a> {
    pub low: usize,
    pub layout: &'a Layout,
}

impl Layout {
    /// Number of bits of the type.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Whether the type is signed (two's complement).
    pub(crate) fn is_signed(&self) -> bool {
        matches!(*self.shape, Shape::Vector { signed: true, .. })
    }

    /// Finds a part by its path of member names and indices, such as `place.line` or `[1].half[2]`. The empty path names the whole value.
    ///
    /// # Errors
    /// When the path names no part; the message lists the valid names.
    pub(crate) fn find(&self, path: &str) -> Result<Member<'_>, String> {
        let mut part = Member {
            low: 0,
            layout: self,
        };
        let mut rest = path;
        while !rest.is_empty() {
            rest = part
                .enter(rest)
                .map_err(|error| format!("{path}: {error}"))?;
        }
        Ok(part)
    }

    /// Names of a structure's members, from the highest bits down; empty for any other type.
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

    /// Describes the type in error messages.
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

impl Member<'_> {
    /// Narrows this part to the member or element at the start of `rest`, and returns the remaining path.
    fn enter<'p>(&mut self, rest: &'p str) -> Result<&'p str, String> {
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
                let highest = lowest + count - 1;
                let number = index
                    .parse::<usize>()
                    .ok()
                    .filter(|number| (*lowest..=highest).contains(number))
                    .ok_or_else(|| format!("index {index} outside of {lowest}..={highest}"))?;
                self.low += (number - lowest) * element.width;
                self.layout = element;
                Ok(rest)
            }
            (Shape::Structure { name, members }, None) => {
                let rest = rest.strip_prefix('.').unwrap_or(rest);
                let (member, rest) = rest.split_at(rest.find(['.', '[']).unwrap_or(rest.len()));
                let position = members
                    .iter()
                    .position(|(name, _)| name == member)
                    .ok_or_else(|| {
                        let members = self.layout.member_names().join(", ");
                        format!("no member `{member}` in {name}; its members: {members}")
                    })?;
                self.low += members[position + 1..]
                    .iter()
                    .map(|(_, member)| member.width)
                    .sum::<usize>();
                self.layout = &members[position].1;
                Ok(rest)
            }
            _ => Err(format!("no `{rest}` in {}", self.layout.describe())),
        }
    }
}
