//! STL, ASCII and binary.
//!
//! This parser replaces `stl_io`, whose errors state neither line nor offset. It also skips the
//! colours in the attribute word, and treats a binary file as ASCII if its header starts with
//! `solid`.

use super::text::{BYTE_ORDER_MARK, Words, any_number, coordinate, finite, vector};
use crate::error::{FormatError, Location, MAX_TRIANGLES, quote};
use crate::polygons::{Corner, Polygons, Rgb8, Vector};

const HEADER: usize = 84;
const RECORD: usize = 50;

/// Parses an STL. A file is binary if it is long enough for the triangle count in its header: ASCII
/// text at this position would be a count that is too large for any file. Any other file that
/// starts with `solid` is ASCII. Bytes after the last triangle are skipped with a remark. Normals
/// are ignored, because the winding states the same direction more reliably.
///
/// # Errors
/// The first violation of the format, with its line or offset.
pub fn parse(file: &[u8]) -> Result<Polygons, FormatError> {
    let count = file
        .get(80..HEADER)
        .and_then(|b| b.try_into().ok())
        .map(u32::from_le_bytes);
    let length = count.map(|count| HEADER as u64 + RECORD as u64 * u64::from(count));
    let starts_as_text = file
        .strip_prefix(BYTE_ORDER_MARK)
        .unwrap_or(file)
        .trim_ascii_start()
        .get(..5)
        .is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    let mut polygons = match (count, length) {
        (Some(count), Some(length)) if length <= file.len() as u64 => parse_binary(file, count)?,
        _ if starts_as_text => parse_ascii(file)?,
        (Some(count), Some(length)) => {
            return Err(FormatError::whole(
                format!(
                    "a binary STL of {count} triangles to be {length} bytes (or an ASCII one to start with solid)"
                ),
                format!("{}", file.len()),
            ));
        }
        _ => {
            return Err(FormatError::whole(
                "an STL (solid …, or a binary header of 84 bytes)",
                quote(file),
            ));
        }
    };
    polygons.finish()?;
    Ok(polygons)
}

/// Encoding of a colour in the attribute word of a binary record. Each channel has five bits.
#[derive(Clone, Copy)]
enum Colours {
    /// The encoding of VisCAM and SolidView: bit 15 is set in a face with a colour; red is in the
    /// highest bits.
    VisCam,
    /// The encoding of Materialise Magics: the header has a default colour, and bit 15 is clear in
    /// a face with its own colour; blue is in the highest bits.
    Magics(Rgb8),
}

impl Colours {
    fn of_header(header: &[u8]) -> Self {
        let key = b"COLOR=";
        match header
            .windows(key.len() + 3)
            .find(|window| window.starts_with(key))
        {
            Some([.., r, g, b]) => Self::Magics(Rgb8([*r, *g, *b])),
            _ => Self::VisCam,
        }
    }

    fn of_face(self, attribute: u16) -> Option<Rgb8> {
        let channel = |shift: u16| {
            let c = attribute >> shift & 31;
            (c << 3 | c >> 2) as u8
        };
        let own = attribute & 0x8000 != 0;
        match self {
            Self::VisCam => own.then(|| Rgb8([channel(10), channel(5), channel(0)])),
            Self::Magics(_) if !own => Some(Rgb8([channel(0), channel(5), channel(10)])),
            Self::Magics(whole) => Some(whole),
        }
    }
}

fn parse_binary(file: &[u8], count: u32) -> Result<Polygons, FormatError> {
    let (header, records) = file.split_at(HEADER);
    if count as usize > MAX_TRIANGLES {
        return Err(FormatError::new(
            Location::Byte(80),
            format!("at most {MAX_TRIANGLES} triangles"),
            format!("{count}"),
        ));
    }
    let colours = Colours::of_header(&header[..80]);
    let mut polygons = Polygons::default();
    let (records, rest) = records
        .split_at_checked(RECORD * count as usize)
        .unwrap_or((records, &[]));
    if !rest.is_empty() {
        polygons.remark(format!(
            "{} bytes after the last triangle are skipped",
            rest.len()
        ));
    }
    for (record, offset) in records.chunks_exact(RECORD).zip((HEADER..).step_by(RECORD)) {
        let mut corners = [Corner::at(0); 3];
        for (i, corner) in corners.iter_mut().enumerate() {
            let start = 12 + 12 * i;
            let mut point: Vector = [0.0; 3];
            for (j, c) in point.iter_mut().enumerate() {
                let at = start + 4 * j;
                let bytes = [record[at], record[at + 1], record[at + 2], record[at + 3]];
                *c = finite(
                    f64::from(f32::from_le_bytes(bytes)),
                    Location::Byte(offset + at),
                )?;
            }
            corner.point = polygons.add_point(point, Location::Byte(offset + start))?;
        }
        let colour = colours.of_face(u16::from_le_bytes([record[48], record[49]]));
        polygons.add_face(&corners, colour, Location::Byte(offset))?;
    }
    Ok(polygons)
}

/// Parses an ASCII STL, including variants that programs write: any division into lines, `end
/// facet` for `endfacet`, facets without a normal, and a missing last `endsolid`.
fn parse_ascii(file: &[u8]) -> Result<Polygons, FormatError> {
    let mut polygons = Polygons::default();
    let mut words = Words::new(file);
    let mut is_open = false;
    while let Some(word) = words.next() {
        let place = words.place();
        if is(word, "facet") {
            add_facet(&mut polygons, &mut words, place)?;
        } else if is(word, "solid") {
            is_open = true;
            skip_name(&mut words);
        } else if ends(word, &mut words, "solid") {
            is_open = false;
            skip_name(&mut words);
        } else {
            return Err(FormatError::new(place, "facet, or endsolid", quote(word)));
        }
    }
    if is_open {
        polygons.remark("endsolid is missing at the end: the file may be cut off");
    }
    Ok(polygons)
}

fn is(word: &[u8], keyword: &str) -> bool {
    word.eq_ignore_ascii_case(keyword.as_bytes())
}

/// Whether a word starts the end of `keyword`, such as `endfacet` or `end facet`. A name may follow
/// without a space, as in `endsolidNAME`.
fn ends(word: &[u8], words: &mut Words, keyword: &str) -> bool {
    if is(word, "end") {
        let mut ahead = words.clone();
        let ends = ahead.next().is_some_and(|word| is(word, keyword));
        if ends {
            *words = ahead;
        }
        return ends;
    }
    let start = word.get(..3 + keyword.len());
    start.is_some_and(|start| is(&start[..3], "end") && is(&start[3..], keyword))
}

/// Skips the name of a solid: the rest of the line, up to a facet on the same line.
fn skip_name(words: &mut Words) {
    while words.has_more_on_line() {
        let mut ahead = words.clone();
        let is_facet = ahead.next().is_some_and(|word| is(word, "facet"))
            && ahead
                .clone()
                .next()
                .is_some_and(|word| is(word, "normal") || is(word, "outer"));
        if is_facet {
            return;
        }
        *words = ahead;
    }
}

/// Adds a facet whose first word, at `place`, is already read.
fn add_facet(
    polygons: &mut Polygons,
    words: &mut Words,
    place: Location,
) -> Result<(), FormatError> {
    skip_normal(words);
    expect(words, "outer loop", |word, words| {
        is(word, "outer") && words.next().is_some_and(|word| is(word, "loop"))
    })?;
    let mut corners = [Corner::at(0); 3];
    for corner in &mut corners {
        expect(words, "vertex x y z", |word, _| is(word, "vertex"))?;
        let place = words.place();
        let point = vector(words, "vertex", place, coordinate)?;
        corner.point = polygons.add_point(point, place)?;
    }
    expect(words, "endloop", |word, words| ends(word, words, "loop"))?;
    expect(words, "endfacet", |word, words| ends(word, words, "facet"))?;
    polygons.add_face(&corners, None, place)
}

/// Skips the normal of a facet, if it has one.
fn skip_normal(words: &mut Words) {
    let mut ahead = words.clone();
    if ahead.next().is_some_and(|word| is(word, "normal")) {
        *words = ahead;
        for _ in 0..3 {
            let mut ahead = words.clone();
            if ahead.next().and_then(any_number).is_some() {
                *words = ahead;
            }
        }
    }
}

fn expect(
    words: &mut Words,
    expected: &str,
    is_expected: impl Fn(&[u8], &mut Words) -> bool,
) -> Result<(), FormatError> {
    let word = words.next();
    let place = words.place();
    match word {
        Some(word) if is_expected(word, words) => Ok(()),
        Some(word) => Err(FormatError::new(place, expected, quote(word))),
        None => Err(FormatError::new(place, expected, "the end of the file")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::text::rows;

    const FACET: &str = "facet normal nan 0 1\n outer loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1e-3 0\nendloop\nendfacet\n";

    fn binary(header: &[u8], count: u32, triangles: &[([f32; 9], u16)]) -> Vec<u8> {
        let mut file = vec![0; 80];
        file[..header.len()].copy_from_slice(header);
        file.extend(count.to_le_bytes());
        for (corners, attribute) in triangles {
            file.extend([0; 12]);
            corners.iter().for_each(|c| file.extend(c.to_le_bytes()));
            file.extend(attribute.to_le_bytes());
        }
        file
    }

    const CORNERS: [f32; 9] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];

    #[test]
    fn ascii() {
        let text = format!(
            "solid facet of a name\r\n{FACET}\n{FACET}endsolid\nSOLID\n{FACET}endsolid x\n"
        );
        let polygons = parse(text.as_bytes()).unwrap();
        assert_eq!((polygons.faces.len(), polygons.points.len()), (3, 9));
        assert_eq!(polygons.points[8], [0.0, 1e-3, 0.0]);
    }

    #[test]
    fn ascii_as_programs_write_it() {
        let text = format!("solid a\n{FACET}{FACET}endsolid a\n");
        let variants = [
            text.replace("endloop", "end loop"),
            text.replace("endfacet", "end facet"),
            text.replace("endsolid a", "end solid"),
            text.replace("endsolid a", "end solid a\nsolid b\nendsolid"),
            text.replace("endsolid a", "endsolida"),
            text.replace("facet normal nan 0 1", "facet"),
            text.replace("facet normal nan 0 1", "facet normal"),
            text.replace("nan 0 1", "-nan(ind) -1.#IND 1.#QNAN"),
            text.replace('\n', " "),
            text.replace('\n', " ").replace("normal nan 0 1", ""),
            text.replace('\n', "\r"),
            text.to_ascii_uppercase(),
        ];
        for text in variants {
            let polygons = parse(text.as_bytes()).unwrap_or_else(|error| panic!("{text}: {error}"));
            assert_eq!(polygons.faces.len(), 2, "{text}");
            assert!(polygons.remarks.is_empty(), "{text}");
        }
        let long = format!("solid {}", FACET.replace('\n', " ").repeat(2000));
        let polygons = parse(long.as_bytes()).unwrap();
        assert_eq!(polygons.faces.len(), 2000);
        let remark = "endsolid is missing at the end: the file may be cut off";
        assert_eq!(polygons.remarks, [remark]);
        let unclosed = format!("solid a\n{FACET}solid b\n{FACET}endsolid b\n");
        assert_eq!(parse(unclosed.as_bytes()).unwrap().faces.len(), 2);
    }

    #[test]
    fn binary_that_calls_itself_solid() {
        let triangles = [(CORNERS, 0), (CORNERS, 0x7fff)];
        let polygons = parse(&binary(b"solid really", 2, &triangles)).unwrap();
        assert_eq!(polygons.faces.len(), 2);
        assert_eq!(polygons.faces[1].colour, None);
    }

    #[test]
    fn colours() {
        let red_high = parse(&binary(b"", 1, &[(CORNERS, 0x8000 | 31 << 10 | 16)])).unwrap();
        assert_eq!(red_high.faces[0].colour, Some(Rgb8([255, 0, 132])));
        let triangles = [(CORNERS, 31), (CORNERS, 0x8000)];
        let magics = parse(&binary(b"COLOR=\x01\x02\x03\xff", 2, &triangles)).unwrap();
        assert_eq!(magics.faces[0].colour, Some(Rgb8([255, 0, 0])));
        assert_eq!(magics.faces[1].colour, Some(Rgb8([1, 2, 3])));
    }

    #[test]
    fn errors_name_their_place() {
        let mut nan = CORNERS;
        nan[4] = f32::NAN;
        let binaries = [
            (
                binary(b"", 1 << 31, &[(CORNERS, 0)]),
                "expected a binary STL of 2147483648 triangles to be 107374182484 bytes (or an ASCII one to start with solid), found 134",
            ),
            (
                binary(b"", 0, &[]),
                "expected at least one face, found none",
            ),
            (
                binary(b"", 1, &[(nan, 0)]),
                "byte 112: expected a finite number, found NaN",
            ),
        ];
        for (file, message) in binaries {
            assert_eq!(parse(&file).unwrap_err().to_string(), message);
        }
        // The lines of a file, separated by `;`, and the expected error.
        let cases = "
            → expected an STL (solid …, or a binary header of 84 bytes), found ''
            solid; → expected at least one face, found none
            solid; facet normal 0 0; → line 2: expected outer loop, found the end of the file
            solid; facet normal 0 0 1; outer loop; vertex 1 2; → line 4: expected three numbers of a vertex, found 2
            solid; facet normal 0 0 1; outer loop; vertex 1 2 3 4; → line 4: expected vertex x y z, found '4'
            solid; endsolid; facet → line 3: expected outer loop, found the end of the file
            solid; facet normal x y z → line 2: expected outer loop, found 'x'
            solid; facets → line 2: expected facet, or endsolid, found 'facets'
            solid; facet outer loop vertex 0 0 0 vertex 0 0 0 vertex 0 0 0 end facet → line 2: expected endloop, found 'end'
        ";
        for [text, message] in rows(cases) {
            let error = parse(text.replace(';', "\n").as_bytes()).unwrap_err();
            assert_eq!(error.to_string(), message);
        }
    }
}
