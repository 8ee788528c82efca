//! Frames of the sensor, also from files.

use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};

/// Errors of picture files.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The file or folder cannot be read.
    #[error("{}: cannot be read: {source}", .path.display())]
    Read {
        /// Path of the file or folder.
        path: PathBuf,
        /// Error of the operating system.
        source: std::io::Error,
    },
    /// The file is not a PNG picture.
    #[error("{}: expected a PNG picture, found {source}", .path.display())]
    Decode {
        /// Path of the file.
        path: PathBuf,
        /// Error of the PNG decoder.
        source: png::DecodingError,
    },
    /// A folder without pictures.
    #[error("{}: expected a folder with PNG pictures, found none", .path.display())]
    Empty {
        /// Path of the folder.
        path: PathBuf,
    },
    /// Pictures of different sizes.
    #[error("{}: expected the size {}x{} of the first picture, found {}x{}", .path.display(), .expected[0], .expected[1], .found[0], .found[1])]
    Size {
        /// Path of the file.
        path: PathBuf,
        /// Width and height of the first picture.
        expected: [usize; 2],
        /// Width and height of this picture.
        found: [usize; 2],
    },
}

/// A frame of the sensor.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Frame {
    /// Number of pixels of a line.
    pub width: usize,
    /// The pixels in RGB565, line by line from the top left.
    pub pixels: Vec<u16>,
}

impl Frame {
    /// Number of lines.
    #[must_use]
    pub fn height(&self) -> usize {
        self.pixels.len() / self.width.max(1)
    }

    /// Reads a PNG picture. Transparency is ignored.
    ///
    /// # Errors
    /// The file cannot be read, or is not a PNG picture.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let file = File::open(path).map_err(|source| Error::Read {
            path: path.to_owned(),
            source,
        })?;
        let broken = |source| Error::Decode {
            path: path.to_owned(),
            source,
        };
        let mut decoder = png::Decoder::new(BufReader::new(file));
        decoder.set_transformations(png::Transformations::normalize_to_color8());
        let mut reader = decoder.read_info().map_err(broken)?;
        let mut bytes = vec![0; reader.output_buffer_size().unwrap_or_default()];
        let info = reader.next_frame(&mut bytes).map_err(broken)?;
        let samples = info.color_type.samples();
        let channels = |pixel: &[u8]| match *pixel {
            [r, g, b, ..] => [r, g, b],
            [grey, ..] => [grey; 3],
            [] => [0; 3],
        };
        Ok(Self {
            width: info.width as usize,
            pixels: bytes[..info.buffer_size()]
                .chunks_exact(samples)
                .map(|pixel| rgb565(channels(pixel)))
                .collect(),
        })
    }
}

/// Converts 8-bit channels red, green and blue to RGB565 by dropping their lower bits.
#[must_use]
pub fn rgb565([r, g, b]: [u8; 3]) -> u16 {
    u16::from(r >> 3) << 11 | u16::from(g >> 2) << 5 | u16::from(b >> 3)
}

/// A source of frames: the view of the sensor.
pub trait Source: Send {
    /// Returns the frame exposed at `time`, in s. All frames have the same size.
    fn frame(&mut self, time: f64) -> Frame;
}

impl Source for Box<dyn Source> {
    fn frame(&mut self, time: f64) -> Frame {
        self.as_mut().frame(time)
    }
}

/// Pictures that are sent one after another, one per frame, in a loop.
pub struct Images {
    frames: Vec<Frame>,
    next: usize,
}

impl Images {
    /// Reads all PNG pictures of a folder, in the order of their names.
    ///
    /// # Errors
    /// The folder or a file cannot be read, a file is not a PNG picture, there is no picture, or the sizes differ.
    pub fn read(folder: &Path) -> Result<Self, Error> {
        let unreadable = |source| Error::Read {
            path: folder.to_owned(),
            source,
        };
        let mut paths = Vec::new();
        for entry in std::fs::read_dir(folder).map_err(unreadable)? {
            let path = entry.map_err(unreadable)?.path();
            if path.extension().is_some_and(|extension| extension == "png") {
                paths.push(path);
            }
        }
        paths.sort();
        let mut frames: Vec<Frame> = Vec::new();
        for path in paths {
            let frame = Frame::read(&path)?;
            let size = |frame: &Frame| [frame.width, frame.height()];
            if let Some(first) = frames.first()
                && size(first) != size(&frame)
            {
                return Err(Error::Size {
                    path,
                    expected: size(first),
                    found: size(&frame),
                });
            }
            frames.push(frame);
        }
        if frames.is_empty() {
            return Err(Error::Empty {
                path: folder.to_owned(),
            });
        }
        Ok(Self { frames, next: 0 })
    }
}

impl Source for Images {
    fn frame(&mut self, _: f64) -> Frame {
        let frame = self.frames[self.next].clone();
        self.next = (self.next + 1) % self.frames.len();
        frame
    }
}
