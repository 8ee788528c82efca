//! Values of packed types, with access to their members.

use std::fmt;

use crate::Bits;
use crate::bits::holds;
use crate::layout::{Layout, Member};

/// A value of a packed type. A path names a part of the value, such as `place.line`, `half[2]` or `[1][0]`; `""` names the whole value.
///
/// Every method with a path panics when the type has no such part; the message lists the valid names.
/// Methods that write panic when the value does not fit the part, and methods that read panic when
/// the part does not fit the result.
#[derive(Clone)]
pub struct Record {
    layout: Layout,
    bits: Bits,
}

impl Layout {
    /// Makes an all-zero record of this type.
    #[must_use]
    pub fn record(&self) -> Record {
        self.record_of(Bits::default())
    }

    /// Makes a record of this type from its bits. Bits above the width of the type must be 0.
    #[must_use]
    pub fn record_of(&self, bits: Bits) -> Record {
        Record::new(self.clone(), bits)
    }
}

impl Record {
    pub(crate) fn new(layout: Layout, bits: Bits) -> Self {
        assert!(
            bits.fits(layout.width()),
            "{bits:?} in {}",
            layout.describe()
        );
        Self { layout, bits }
    }

    /// The type.
    #[must_use]
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// All bits.
    #[must_use]
    pub fn bits(&self) -> Bits {
        self.bits
    }

    /// Returns the record with a part set to a signed or unsigned number.
    #[must_use]
    pub fn with(mut self, path: &str, value: impl Into<i128>) -> Self {
        self.set(path, value);
        self
    }

    /// Sets a part to a signed or unsigned number.
    pub fn set(&mut self, path: &str, value: impl Into<i128>) {
        let Member { low, layout } = self.find(path);
        self.bits = with_number(self.bits, path, low, layout, value.into());
    }

    /// Sets an array to numbers in the order of its indices, one for each element.
    pub fn set_all(&mut self, path: &str, values: impl IntoIterator<Item: Into<i128>>) {
        let Member { low, layout } = self.find(path);
        let (mut bits, mut found) = (self.bits, 0);
        for value in values {
            if let Some((count, element)) = layout.elements()
                && found < count
            {
                let low = low + found * element.width();
                bits = with_number(bits, path, low, element, value.into());
            }
            found += 1;
        }
        let is_all = layout.elements().is_some_and(|(count, _)| count == found);
        assert!(is_all, "{path}: {found} values for {}", layout.describe());
        self.bits = bits;
    }

    /// Sets an enumeration to its value of this name.
    pub fn set_name(&mut self, path: &str, name: &str) {
        let Member { low, layout } = self.find(path);
        let values = layout.values();
        let value = values.and_then(|values| values.get(name)).copied();
        let value = value.unwrap_or_else(|| {
            let names: Vec<_> = values
                .into_iter()
                .flatten()
                .map(|(name, _)| name.as_str())
                .collect();
            let (found, names) = (layout.describe(), names.join(", "));
            panic!("{path}: no value `{name}` in {found}; its values: {names}")
        });
        self.bits = with_number(self.bits, path, low, layout, value.into());
    }

    /// Sets a part to bits, such as those of another record.
    pub fn set_bits(&mut self, path: &str, bits: impl Into<Bits>) {
        let (part, bits) = (self.find(path), bits.into());
        let (low, width) = (part.low, part.layout.width());
        assert!(
            bits.fits(width),
            "{path}: {bits:?} does not fit {width} bits"
        );
        self.bits = self.bits.with_slice(low, width, bits);
    }

    /// Returns a part of at most 64 bits as an unsigned number.
    #[must_use]
    pub fn get(&self, path: &str) -> u64 {
        let part = self.find(path);
        self.bits.field(part.low, part.layout.width())
    }

    /// Returns a part of at most 64 bits as a two's complement number.
    #[must_use]
    pub fn signed(&self, path: &str) -> i64 {
        let part = self.find(path);
        self.bits.signed(part.low, part.layout.width())
    }

    /// Whether a one-bit part is set.
    #[must_use]
    pub fn is_set(&self, path: &str) -> bool {
        let part = self.find(path);
        assert_eq!(part.layout.width(), 1, "{path}: {}", part.layout.describe());
        self.bits.field(part.low, 1) != 0
    }

    /// Returns the name of an enumeration's value; `None` for a number without a name.
    #[must_use]
    pub fn name(&self, path: &str) -> Option<&str> {
        let part = self.find(path);
        let values = part.layout.values();
        let values = values.unwrap_or_else(|| panic!("{path}: {}", part.layout.describe()));
        let value = self.bits.field(part.low, part.layout.width());
        let found = values.iter().find(|&(_, &number)| number == value);
        found.map(|(name, _)| name.as_str())
    }

    /// Returns a part as a separate record.
    #[must_use]
    pub fn part(&self, path: &str) -> Self {
        let part = self.find(path);
        Self {
            layout: part.layout.clone(),
            bits: self.bits.slice(part.low, part.layout.width()),
        }
    }

    fn find(&self, path: &str) -> Member<'_> {
        let part = self.layout.find(path);
        part.unwrap_or_else(|error| panic!("{error}"))
    }
}

/// Returns `bits` with `value` in the part of the type `layout` from bit `low` up. `path` is used in errors only.
fn with_number(bits: Bits, path: &str, low: usize, layout: &Layout, value: i128) -> Bits {
    let width = layout.width();
    let fits = fits(value, width, layout.is_signed());
    assert!(fits, "{path}: {value} does not fit {width} bits");
    bits.with(low, width, value)
}

/// Whether a number fits a part of `width` bits. A part that is not declared signed accepts signed and unsigned numbers.
fn fits(value: i128, width: usize, signed: bool) -> bool {
    holds(width, value) && !(signed && value >= 1 << (width - 1).min(126))
}

impl From<Record> for Bits {
    fn from(record: Record) -> Self {
        record.bits
    }
}

impl fmt::Debug for Record {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{} {:?}", self.layout.describe(), self.bits)
    }
}

#[cfg(test)]
mod tests {
    use super::Record;
    use crate::layout::Layout;

    fn layout() -> Layout {
        serde_json::from_str(
            r#"{"name": "solid_t", "members": [
                ["half", {"count": 3, "lowest": 0, "element": {"width": 22, "signed": false}}],
                ["place", {"name": "place_t", "members": [
                    ["line", {"width": 6, "signed": false}], ["column", {"width": 11, "signed": true}]]}],
                ["state", {"name": "state_t", "width": 2, "values": {"MISS": 0, "HIT": 1}}]]}"#,
        )
        .unwrap()
    }

    fn error(change: impl FnOnce(&mut Record) + std::panic::UnwindSafe) -> String {
        let panic = std::panic::catch_unwind(|| change(&mut layout().record()));
        *panic.unwrap_err().downcast::<String>().unwrap()
    }

    #[test]
    fn members_have_the_bits_of_the_declaration() {
        let mut record: Record = layout().record();
        record.set("place.column", -5);
        record.set("place.line", 63);
        record.set_all("half", [1, -2, 3]);
        record.set_name("state", "HIT");
        assert_eq!(record.layout().width(), 3 * 22 + 17 + 2);
        assert_eq!(record.bits().field(0, 2), 1);
        assert_eq!(record.bits().signed(2, 11), -5);
        assert_eq!(record.bits().field(13, 6), 63);
        assert_eq!(record.bits().signed(19 + 22, 22), -2);
        assert_eq!((record.get("half[2]"), record.signed("half[1]")), (3, -2));
        assert_eq!(record.name("state"), Some("HIT"));
        assert_eq!(record.part("place").get("line"), 63);
        let other = layout().record_of(record.bits());
        assert_eq!(other.signed("place.column"), -5);
    }

    #[test]
    fn errors_list_the_parts() {
        for (path, value, expected) in [
            (
                "place.row",
                1,
                "no member `row` in place_t; its members: line, column",
            ),
            ("half[3]", 1, "index 3 outside of 0..=2"),
            ("state.high", 1, "no `.high` in state_t"),
            ("place.line", 64, "64 does not fit 6 bits"),
            ("place.column", 1024, "1024 does not fit 11 bits"),
        ] {
            assert_eq!(
                error(|record| record.set(path, value)),
                format!("{path}: {expected}")
            );
        }
        assert_eq!(
            error(|record| record.set_name("state", "LOST")),
            "state: no value `LOST` in state_t; its values: HIT, MISS"
        );
        assert_eq!(
            error(|record| record.set_all("half", [0; 4])),
            "half: 4 values for an array of 3, each a vector of 22 bits"
        );
    }
}
