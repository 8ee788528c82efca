//! Logs as CSV: a header with `t_us,ax,ay,az,gx,gy,gz` and optionally `temp`, in any order, then one sample per line in raw
//! counts.

use crate::error::{FormatError, Location, quote};
use crate::formats::text::{Line, Lines};

/// One sample of a log.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Line of the sample in the file, counted from 1.
    pub line: usize,
    /// Time of the sample in µs.
    pub t_us: u64,
    /// Accelerometer x, y, z in raw counts.
    pub accel: [i16; 3],
    /// Gyroscope x, y, z in raw counts.
    pub gyro: [i16; 3],
    /// Thermometer in raw counts, if the log has this column.
    pub temp: Option<i16>,
}

const TIME: &str = "t_us";
const TEMPERATURE: &str = "temp";
const COLUMNS: [&str; 8] = [TIME, "ax", "ay", "az", "gx", "gy", "gz", TEMPERATURE];
/// Maximum number of columns in a header; real logs have fewer.
const MAX_COLUMNS: usize = 64;

/// The columns of a file.
struct Header {
    /// For each of [`COLUMNS`], its index among the columns of the file.
    places: [Option<usize>; COLUMNS.len()],
    /// Number of columns in the file.
    count: usize,
    /// Names of the ignored columns.
    ignored: Vec<String>,
}

/// A parsed log.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Log {
    /// The samples, at least one.
    pub entries: Vec<Entry>,
    /// Names of the columns that are ignored.
    pub ignored: Vec<String>,
}

/// Parses a log.
///
/// # Errors
/// The first violation of the format, with its line and column.
pub fn parse(text: &[u8]) -> Result<Log, FormatError> {
    let mut lines = Lines::new(text);
    let Some(first) = next_filled(&mut lines)? else {
        return Err(FormatError::whole(
            "a header t_us,ax,ay,az,gx,gy,gz",
            "an empty file",
        ));
    };
    let header = Header::parse(first)?;
    let mut entries = Vec::new();
    while let Some(line) = next_filled(&mut lines)? {
        entries.push(header.entry(line)?);
    }
    if entries.is_empty() {
        return Err(FormatError::whole("at least one sample", "none"));
    }
    Ok(Log {
        entries,
        ignored: header.ignored,
    })
}

/// The next non-blank line.
fn next_filled<'a>(lines: &mut Lines<'a>) -> Result<Option<Line<'a>>, FormatError> {
    while let Some(line) = lines.next_line()? {
        if !line.text.trim_ascii().is_empty() {
            return Ok(Some(line));
        }
    }
    Ok(None)
}

fn cells(line: Line<'_>) -> impl Iterator<Item = &[u8]> {
    line.text
        .split(|&byte| byte == b',')
        .map(<[u8]>::trim_ascii)
}

impl Header {
    fn parse(line: Line<'_>) -> Result<Self, FormatError> {
        let mut places = [None; COLUMNS.len()];
        let mut count = 0;
        let mut ignored = Vec::new();
        for cell in cells(line) {
            if count == MAX_COLUMNS {
                let expected = format!("at most {MAX_COLUMNS} columns");
                return Err(FormatError::new(line.place(), expected, "more"));
            }
            match COLUMNS.iter().position(|name| name.as_bytes() == cell) {
                None => ignored.push(quote(cell)),
                Some(column) => {
                    if places[column].replace(count).is_some() {
                        let expected = format!("one column {}", COLUMNS[column]);
                        return Err(FormatError::new(line.place(), expected, "two"));
                    }
                }
            }
            count += 1;
        }
        for (name, place) in COLUMNS.iter().zip(&places) {
            if place.is_none() && *name != TEMPERATURE {
                let expected = format!("a column {name}");
                return Err(FormatError::new(line.place(), expected, quote(line.text)));
            }
        }
        Ok(Self {
            places,
            count,
            ignored,
        })
    }

    fn entry(&self, line: Line<'_>) -> Result<Entry, FormatError> {
        let mut row = [&[][..]; MAX_COLUMNS];
        let mut found = 0;
        for cell in cells(line) {
            if let Some(place) = row.get_mut(found) {
                *place = cell;
            }
            found += 1;
        }
        if found != self.count {
            let expected = format!("{} columns as in the header", self.count);
            return Err(FormatError::new(line.place(), expected, found.to_string()));
        }
        let cell = |column: usize| {
            self.places[column]
                .and_then(|place| row.get(place))
                .copied()
        };
        let bad_cell = |column: usize, expected: &str| {
            let place = Location::Cell(line.number, COLUMNS[column]);
            FormatError::new(place, expected, quote(cell(column).unwrap_or_default()))
        };
        let number = |column: usize| std::str::from_utf8(cell(column).unwrap_or_default());
        let count = |column: usize| {
            let parsed = number(column).ok().and_then(|text| text.parse().ok());
            parsed.ok_or_else(|| bad_cell(column, "a whole number from -32768 to 32767"))
        };
        let t_us = number(0).ok().and_then(|text| text.parse().ok());
        Ok(Entry {
            line: line.number,
            t_us: t_us.ok_or_else(|| bad_cell(0, "a whole number of microseconds"))?,
            accel: [count(1)?, count(2)?, count(3)?],
            gyro: [count(4)?, count(5)?, count(6)?],
            temp: match cell(7) {
                Some(_) => Some(count(7)?),
                None => None,
            },
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_in_any_order() {
        let text = b"\xef\xbb\xbfmx,gz, t_us ,ax,ay,az,temp,gx,gy,\r\nx,-3,9323,4,5,6,-4880,1,+2,\r\n\r\n  \n,7,18446744073709551615,1,1,1,1,1,-32768,8";
        let Log { entries, ignored } = parse(text).unwrap();
        assert_eq!(ignored, ["'mx'", "''"]);
        let first = Entry {
            line: 2,
            t_us: 9323,
            accel: [4, 5, 6],
            gyro: [1, 2, -3],
            temp: Some(-4880),
        };
        assert_eq!(entries[0], first);
        assert_eq!(
            (entries[1].line, entries[1].t_us, entries[1].gyro),
            (5, u64::MAX, [1, i16::MIN, 7])
        );
        let bare = parse(b"t_us,ax,ay,az,gx,gy,gz\n1,2,3,4,5,6,7\n").unwrap();
        let bare = bare.entries;
        assert_eq!((bare[0].temp, bare[0].gyro), (None, [5, 6, 7]));
    }

    #[test]
    fn errors_name_their_place() {
        let header = "t_us,ax,ay,az,gx,gy,gz\n";
        let cases = "
            → expected a header t_us,ax,ay,az,gx,gy,gz, found an empty file
            ; ; → expected a header t_us,ax,ay,az,gx,gy,gz, found an empty file
            t_us,ax,ay,az,gx,gy,gz; → expected at least one sample, found none
            t_us,ax,ay,az,gx,gy; → line 1: expected a column gz, found 't_us,ax,ay,az,gx,gy'
            t_us,ax,ay,az,gx,gy,gz,ax; → line 1: expected one column ax, found two
            1,2,3,4,5,6,7; → line 1: expected a column t_us, found '1,2,3,4,5,6,7'
        ";
        for case in cases.lines().filter_map(|case| case.split_once('→')) {
            let (text, message) = (case.0.trim().replace(';', "\n"), case.1.trim());
            assert_eq!(parse(text.as_bytes()).unwrap_err().to_string(), message);
        }
        let rows = "
            1,2,3,4,5,6 → line 3: expected 7 columns as in the header, found 6
            1,2,3,4,5,6,7,8 → line 3: expected 7 columns as in the header, found 8
            1,2,3,4,5,6,32768 → line 3, column gz: expected a whole number from -32768 to 32767, found '32768'
            1,2,,4,5,6,7 → line 3, column ay: expected a whole number from -32768 to 32767, found ''
            1,2,3,4,5.5,6,7 → line 3, column gx: expected a whole number from -32768 to 32767, found '5.5'
            -1,2,3,4,5,6,7 → line 3, column t_us: expected a whole number of microseconds, found '-1'
        ";
        for row in rows.lines().filter_map(|row| row.split_once('→')) {
            let (row, message) = (row.0.trim(), row.1.trim());
            let text = format!("{header}0,0,0,0,0,0,0\n{row}\n");
            assert_eq!(parse(text.as_bytes()).unwrap_err().to_string(), message);
        }
    }
}
