//! Program files of the wireframe simulator, and programs that draw the edges of a mesh
//! (docs/wireframe.md).

use crate::convert::{self, Options};
use crate::error::{FormatError, InputError, Location, quote};
use crate::formats::{STDIN, read_file};
use crate::polygons::Polygons;
use glint_core::fixed::Q5_11;
use glint_core::wireframe::text::{assemble, lines_after_end};
use glint_core::wireframe::{
    self, EXTENSIONS, Instruction, Key, MAX_SEGMENTS, Motion, Point, Pose, Program, ProgramError,
    Segment, Viewing, Window, accumulate, unique_edges,
};
use std::fmt::Write;
use std::path::Path;

/// The form of a program file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// The text form: one instruction per line.
    Text,
    /// The binary form: 16 bytes per word.
    Binary,
}

impl Form {
    /// Returns the form for a file's extension.
    ///
    /// # Errors
    /// The extension is not wft or wfb.
    pub fn of(path: &Path) -> Result<Self, InputError> {
        let extension = path
            .extension()
            .map(|extension| extension.to_string_lossy().to_ascii_lowercase());
        let [text, binary] = EXTENSIONS;
        match extension.as_deref() {
            Some(extension) if extension == text => Ok(Self::Text),
            Some(extension) if extension == binary => Ok(Self::Binary),
            other => {
                let found = other.map_or("no extension".into(), |other| {
                    format!("'.{}'", other.escape_default())
                });
                let expected = "a name that ends in .wft (text) or .wfb (binary)";
                Err(FormatError::whole(expected, found).in_path(path))
            }
        }
    }

    /// Encodes a program in this form.
    pub fn encode(self, program: &Program) -> Vec<u8> {
        match self {
            Self::Text => text(program).into_bytes(),
            Self::Binary => program.bytes().to_vec(),
        }
    }
}

/// A program that was read.
#[derive(Debug)]
pub struct Source {
    /// The binary form, up to the end of the program.
    pub bytes: Vec<u8>,
    /// Text of a warning about ignored data after the end; `None` if there are no such data.
    pub ignored: Option<String>,
}

/// Reads a program in either form. `-` is standard input, whose form is detected from its contents.
///
/// # Errors
/// The file cannot be read, or violates its format.
pub fn read(path: &Path) -> Result<Source, InputError> {
    let (form, bytes) = match path == Path::new(STDIN) {
        true => {
            let bytes = read_file(path)?;
            // The three highest bytes of every binary word are 0, and text contains no zero bytes.
            let form = if bytes.contains(&0) {
                Form::Binary
            } else {
                Form::Text
            };
            (form, bytes)
        }
        false => (Form::of(path)?, read_file(path)?),
    };
    parse(form, bytes).map_err(|error| error.in_path(path))
}

/// Parses a program in either form.
///
/// # Errors
/// The first violation of the format, with its line or word.
pub fn parse(form: Form, mut bytes: Vec<u8>) -> Result<Source, FormatError> {
    let (count, unit);
    match form {
        Form::Text => {
            let text = String::from_utf8_lossy(&bytes);
            let assembled = assemble(&text).map_err(|error| format_error(&error))?;
            (count, unit) = (lines_after_end(&text), "line");
            bytes = assembled;
        }
        Form::Binary => {
            (count, unit) = (check(&bytes)?.ignored(), "byte");
            bytes.truncate(bytes.len() - count);
        }
    }
    let ignored = match count {
        0 => None,
        1 => Some(format!("1 {unit} after the end is ignored")),
        _ => Some(format!("{count} {unit}s after the end are ignored")),
    };
    Ok(Source { bytes, ignored })
}

/// Checks the binary form of a program.
///
/// # Errors
/// The first violation of the format, with its word.
pub fn check(bytes: &[u8]) -> Result<Program<'_>, FormatError> {
    Program::new_checked(bytes).map_err(|error| format_error(&error))
}

fn format_error(error: &ProgramError) -> FormatError {
    let place = match error.place {
        wireframe::Location::Line(number) => Location::Line(number),
        wireframe::Location::Word(number) => Location::Word(number),
    };
    let violation = error.violation;
    FormatError::new(
        place,
        violation.expected.to_string(),
        violation.found.to_string(),
    )
}

/// Returns the text form of a program.
pub fn text(program: &Program) -> String {
    program
        .instructions()
        .fold(String::new(), |mut text, instruction| {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "{instruction}");
            text
        })
}

/// A program that draws the edges of a mesh.
pub struct Made {
    /// The binary form.
    pub bytes: Vec<u8>,
    /// Number of segments.
    pub segments: usize,
    /// Number of dropped edges, whose length is 0 in Q5.11.
    pub dropped: usize,
}

/// Makes a program that draws each undirected edge of the polygons once. Edges between equal
/// positions in Q5.11 count as one edge, so polygons need not share vertices.
///
/// The mesh is scaled to a box with the side `extent` about the origin, or keeps its coordinates if `extent` is `None`. Its z
/// axis, which points up, becomes y, and its y axis points away from the viewer.
///
/// # Errors
/// The mesh has no extent, a coordinate is out of the range of Q5.11, there are more than 65,535 edges, or the viewing parameters
/// are invalid.
pub fn make(
    mut polygons: Polygons,
    extent: Option<f64>,
    viewing: &Viewing,
) -> Result<Made, FormatError> {
    let keep_scale = extent.is_none();
    let options = Options {
        keep_scale,
        ..Options::default()
    };
    convert::place(&mut polygons, options)?;
    let scale = extent.unwrap_or(1.0);
    let points = polygons
        .points
        .iter()
        .map(|&[x, y, z]| rounded([x, z, -y].map(|x| x * scale)))
        .collect::<Result<Vec<Point>, _>>()?;
    let mut edges = edges(&polygons, &points);
    let dropped = edges.iter().filter(|[a, b]| a == b).count();
    let segments = unique_edges(&mut edges);
    if segments.len() > MAX_SEGMENTS as usize {
        return Err(FormatError::whole(
            format!("a mesh of at most {MAX_SEGMENTS} edges"),
            segments.len().to_string(),
        ));
    }
    let head = [
        Instruction::Eye(viewing.eye),
        Instruction::Plane(viewing.plane),
        Instruction::Window(viewing.window),
    ];
    let segments_of = segments.iter().copied().map(Instruction::Segment);
    let words = head
        .into_iter()
        .chain(segments_of)
        .chain([Instruction::End]);
    let bytes: Vec<u8> = words.flat_map(Instruction::encode).collect();
    check(&bytes).map_err(|error| FormatError::whole(error.expected, error.found))?;
    Ok(Made {
        bytes,
        segments: segments.len(),
        dropped,
    })
}

/// The edges of all polygons as pairs of end points. An edge of two polygons occurs twice.
fn edges(polygons: &Polygons, points: &[Point]) -> Vec<[Point; 2]> {
    let of_face = |face| {
        let corners = polygons
            .corners_of(face)
            .iter()
            .map(|corner| points[corner.point as usize]);
        corners.clone().zip(corners.cycle().skip(1))
    };
    polygons
        .faces
        .iter()
        .flat_map(of_face)
        .map(|(a, b)| [a, b])
        .collect()
}

/// Rounds a position to the nearest Q5.11 values.
fn rounded(position: [f64; 3]) -> Result<Point, FormatError> {
    let mut point = Point::default();
    for (to, x) in point.iter_mut().zip(position) {
        *to = Q5_11::checked_from_num(x).ok_or_else(|| {
            FormatError::whole(
                format!("coordinates from {} to {}", Q5_11::MIN, Q5_11::MAX),
                format!("{x}"),
            )
        })?;
    }
    Ok(point)
}

/// Parses `COUNT` comma-separated numbers in Q5.11.
///
/// # Errors
/// The text does not have the form that `form` describes.
pub fn numbers<const COUNT: usize>(text: &str, form: &str) -> Result<[Q5_11; COUNT], FormatError> {
    let refuse = || {
        let range = format!("{form}, each from {} to {}", Q5_11::MIN, Q5_11::MAX);
        FormatError::whole(range, quote(text.as_bytes()))
    };
    let words: Vec<&str> = text.split(',').collect();
    let words: [&str; COUNT] = words.try_into().map_err(|_| refuse())?;
    let mut numbers = [Q5_11::ZERO; COUNT];
    for (number, word) in numbers.iter_mut().zip(words) {
        *number = word.trim().parse().map_err(|_| refuse())?;
    }
    Ok(numbers)
}

/// Parses the window `XL,YL,XH,YH`.
///
/// # Errors
/// The text is not four numbers.
pub fn window(text: &str) -> Result<Window, FormatError> {
    let [xl, yl, xh, yh] = numbers(text, "a window XL,YL,XH,YH")?;
    Ok(Window {
        low: [xl, yl],
        high: [xh, yh],
    })
}

/// An action of a script of keys.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// Presses a key for one frame.
    Press(Key),
    /// Sets switch 0, which selects whether the arrow keys rotate or pan.
    Rotate(bool),
}

/// Parses a script of keys: `up`, `down`, `left`, `right`, `zoom-in`, `zoom-out`, optionally with a count as in `up:20`, and
/// `rotate` and `pan`, which set the switch for the following arrow keys.
///
/// # Errors
/// An action has another form, or there are more than 100,000 actions.
pub fn script(text: &str) -> Result<Vec<Action>, FormatError> {
    const MOST: usize = 100_000;
    let mut actions = Vec::new();
    for word in text.split(',').map(str::trim) {
        let refuse = |expected: String| FormatError::whole(expected, quote(word.as_bytes()));
        let (name, count) = match word.split_once(':') {
            Some((name, count)) => (name, count.parse::<usize>().ok()),
            None => (word, Some(1)),
        };
        let key = Key::ALL.into_iter().find(|key| key.name() == name);
        match (name, key, count) {
            ("rotate" | "pan", _, Some(1)) => actions.push(Action::Rotate(name == "rotate")),
            (_, Some(key), Some(count)) if count <= MOST - actions.len().min(MOST) => {
                actions.extend(std::iter::repeat_n(Action::Press(key), count));
            }
            (_, Some(_), _) => {
                return Err(refuse(format!("a count, at most {MOST} actions in all")));
            }
            _ => {
                let keys = Key::NAMES.join(", ");
                return Err(refuse(format!("{keys} (or KEY:COUNT), rotate or pan")));
            }
        }
    }
    Ok(actions)
}

/// The arithmetic of the motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MotionForm {
    /// Each frame transforms the original points of the program.
    #[default]
    DriftFree,
    /// The motion of the original design: each step rounds the end points.
    Accumulated,
}

impl MotionForm {
    /// All forms.
    pub const ALL: [Self; 2] = [Self::DriftFree, Self::Accumulated];

    /// Name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::DriftFree => "drift-free",
            Self::Accumulated => "accumulated",
        }
    }
}

/// The state of a program after a script of keys.
pub struct Played {
    /// The binary form of the program. With accumulated motion, its segments are already
    /// transformed.
    pub bytes: Vec<u8>,
    /// The remaining transformation of the segments in `bytes`.
    pub pose: Pose,
    /// Number of rejected steps, which would have moved segments out of the range of Q5.11.
    pub refused: usize,
}

/// Plays a script of keys: each key press is a step of one frame.
pub fn play(program: &Program, script: &[Action], form: MotionForm) -> Played {
    let mut segments: Vec<Segment> = program.segments().collect();
    let mut motion = Motion::default();
    let (mut rotate, mut refused) = (false, 0);
    for &action in script {
        let step = match action {
            Action::Rotate(on) => {
                rotate = on;
                continue;
            }
            Action::Press(key) => key.step(rotate),
        };
        let possible = match form {
            MotionForm::DriftFree => motion.apply(step),
            MotionForm::Accumulated => accumulate::apply(&mut segments, step),
        };
        refused += usize::from(!possible);
    }
    let mut moved = segments.into_iter();
    let instructions = program
        .instructions()
        .map(|instruction| match instruction.segment() {
            Some(segment) => Instruction::Segment(moved.next().unwrap_or(segment)),
            None => instruction,
        });
    Played {
        bytes: instructions.flat_map(Instruction::encode).collect(),
        pose: motion.pose(),
        refused,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate;

    fn usual() -> Viewing {
        Viewing {
            eye: numbers("0,0,8", "").unwrap(),
            plane: Q5_11::lit("4"),
            window: window("-4,-2.25,4,2.25").unwrap(),
        }
    }

    #[test]
    fn the_edges_of_models() {
        // A closed mesh of F triangles has 3·F/2 edges, and a cube has 12.
        for (name, edges) in [("cube", 12), ("icosphere:1", 30), ("icosphere:4", 480)] {
            let polygons = generate::named(name).unwrap();
            let made = make(polygons, Some(4.0), &usual()).unwrap();
            assert_eq!((made.segments, made.dropped), (edges, 0), "{name}");
            let program = check(&made.bytes).unwrap();
            assert_eq!(program.segment_count() as usize, edges);
            assert_eq!(*program.viewing(), usual());
        }
    }

    #[test]
    fn a_cube_is_where_it_should_be() {
        let made = make(generate::named("cube").unwrap(), Some(4.0), &usual()).unwrap();
        let program = check(&made.bytes).unwrap();
        assert!(program.segments().flatten().flatten().all(|x| x.abs() == 2));
        let lengths = program
            .segments()
            .map(|[a, b]| (0..3).filter(|&i| a[i] != b[i]).count());
        assert!(lengths.into_iter().all(|axes| axes == 1));
    }

    #[test]
    fn up_is_up() {
        let mut polygons = Polygons::default();
        let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 2.0, 3.0]].map(|point| {
            crate::polygons::Corner::at(polygons.add_point(point, Location::Whole).unwrap())
        });
        polygons.add_face(&corners, None, Location::Whole).unwrap();
        let made = make(polygons, None, &usual()).unwrap();
        let program = check(&made.bytes).unwrap();
        let point = |x: i16, y: i16, z: i16| [x, y, z].map(Q5_11::from_num);
        let mut ends = program.segments().flatten();
        assert!(ends.any(|end| end == point(0, 3, -2)));
    }

    #[test]
    fn refused_programs_of_meshes() {
        let refused = |name: &str, extent: f64, viewing: &Viewing| {
            let made = make(generate::named(name).unwrap(), Some(extent), viewing);
            made.err().unwrap().to_string()
        };
        let low = Viewing {
            plane: Q5_11::lit("8"),
            ..usual()
        };
        let edges = "expected a mesh of at most 65535 edges, found 122880";
        assert_eq!(refused("icosphere:64", 4.0, &usual()), edges);
        let range = "expected coordinates from -16 to 15.9995, found 16";
        assert_eq!(refused("cube", 32.0, &usual()), range);
        let plane = "expected a z of the eye above that of the view plane, 8, found 8";
        assert_eq!(refused("cube", 4.0, &low), plane);
    }

    #[test]
    fn both_forms_of_the_motion() {
        let made = make(generate::named("cube").unwrap(), Some(4.0), &usual()).unwrap();
        let program = check(&made.bytes).unwrap();
        let end = |script_text: &str, form| {
            let Played {
                bytes,
                pose,
                refused,
            } = play(&program, &script(script_text).unwrap(), form);
            let program = check(&bytes).unwrap();
            let ends = program.segments().flat_map(|segment| pose.segment(segment));
            let ends: Vec<[f64; 3]> = ends.map(|end| end.map(f64::from)).collect();
            (ends, refused)
        };
        let [exact, accumulated] =
            MotionForm::ALL.map(|form| end("rotate,up:5,left:3,zoom-out,pan,right:2", form));
        assert_eq!((exact.1, accumulated.1), (0, 0));
        let distance = |a: &f64, b: &f64| (a - b).abs();
        let pairs = exact
            .0
            .as_flattened()
            .iter()
            .zip(accumulated.0.as_flattened());
        let largest = pairs.map(|(a, b)| distance(a, b)).fold(0.0, f64::max);
        assert!(largest > 0.0 && largest < 8.0 / 2048.0, "{largest}");
        // The cube's sides at ±2 reach the limit of Q5.11 after 223 pans. The displacement reaches
        // its own limit after 256 pans.
        assert_eq!(end("right:300", MotionForm::Accumulated).1, 300 - 223);
        assert_eq!(end("right:300", MotionForm::DriftFree).1, 300 - 256);
    }

    #[test]
    fn scripts() {
        use Action::{Press, Rotate};
        assert_eq!(
            script("up, rotate,left:2,zoom-in,pan,down:0").unwrap(),
            [
                Press(Key::Up),
                Rotate(true),
                Press(Key::Left),
                Press(Key::Left),
                Press(Key::ZoomIn),
                Rotate(false)
            ]
        );
        assert_eq!(script("up:100000").unwrap().len(), 100_000);
        for text in " up, jump up:x up:-1 rotate:2 up:100001 up,up:100000".split(' ') {
            let error = script(text).unwrap_err().to_string();
            let is_line = error.starts_with("expected ") && error.contains(", found '");
            assert!(is_line, "{error}");
        }
    }
}
