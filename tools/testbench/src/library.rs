//! The shared library of a verilated design: a safe interface to the functions of `tools/testbench/harness/interface.h`.

use std::collections::BTreeMap;
use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::fmt;
use std::path::{Path, PathBuf};
use std::ptr::NonNull;
use std::slice;

use libloading::Library;
use serde::Deserialize;
use thiserror::Error;

use crate::bits::parts;
use crate::{Bits, Layout};

/// Version of the C interface that this file implements.
const VERSION: u32 = 1;

/// Error of loading a library.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum LoadError {
    /// The file is missing or is not a library, or a function of the interface is missing.
    #[error("{}: {source}", path.display())]
    Library {
        /// The file.
        path: PathBuf,
        /// The loader's message.
        source: libloading::Error,
    },
    /// The library's harness, which implements the C interface, has another version.
    #[error("{}: expected version {expected} of the harness, found {found}", path.display())]
    Version {
        /// The file.
        path: PathBuf,
        /// Expected version.
        expected: u32,
        /// The library's version.
        found: u32,
    },
    /// The library's description of its ports cannot be parsed.
    #[error("{}: cannot parse the description of the ports: {source}", path.display())]
    Description {
        /// The file.
        path: PathBuf,
        /// The parser's message.
        source: serde_json::Error,
    },
}

/// A port's name, type and direction.
#[derive(Clone, Debug, Deserialize)]
pub(crate) struct PortDescription {
    pub name: String,
    pub output: bool,
    #[serde(rename = "type")]
    pub layout: Layout,
}

/// Ports and types of a design.
#[derive(Clone, Debug, Deserialize)]
pub(crate) struct Description {
    pub ports: Vec<PortDescription>,
    /// The types of all SystemVerilog packages, by their names `package::type`.
    pub types: BTreeMap<String, Layout>,
}

/// Storage of a port in the verilated model.
#[derive(Clone, Copy)]
struct Slot {
    address: NonNull<u8>,
    bytes: usize,
    width: usize,
    output: bool,
}

impl Slot {
    fn new(address: NonNull<u8>, described: &PortDescription) -> Self {
        let width = described.layout.width();
        Self {
            address,
            // Verilator stores a port in the smallest integer type that fits, or above 64 bits in an array of 32-bit words.
            bytes: match width {
                0..=8 => 1,
                9..=16 => 2,
                17..=32 => 4,
                33..=64 => 8,
                wide => 4 * wide.div_ceil(32),
            },
            width,
            output: described.output,
        }
    }
}

/// One instance of a verilated design, with access to ports by number.
pub struct Instance {
    handle: NonNull<c_void>,
    ports: Vec<Slot>,
    description: Description,
    free: unsafe extern "C" fn(*mut c_void),
    eval: unsafe extern "C" fn(*mut c_void),
    path: PathBuf,
    // Must be the last field: the other fields point into the library and must be dropped before it
    // is unloaded.
    library: Library,
}

// SAFETY: an instance may move between threads as long as only one thread uses it at a time (interface.h).
unsafe impl Send for Instance {}

impl Instance {
    /// Loads a library and creates an instance of its design without evaluating it.
    ///
    /// # Errors
    /// When the file is missing, or is not a library with this version of the C interface.
    pub fn load(path: &Path, seed: u32) -> Result<Self, LoadError> {
        let error = |source| LoadError::Library {
            path: path.to_owned(),
            source,
        };
        // SAFETY: the initializers of libstdc++ and Verilator have no preconditions.
        let library = unsafe { Library::new(path) }.map_err(error)?;
        // SAFETY: names and types match interface.h, and the version check confirms that the library implements it.
        let (description, handle, free, eval, port) = unsafe {
            let version: unsafe extern "C" fn() -> u32 =
                *library.get(b"harness_version").map_err(error)?;
            let found = version();
            if found != VERSION {
                return Err(LoadError::Version {
                    path: path.to_owned(),
                    expected: VERSION,
                    found,
                });
            }
            let text: unsafe extern "C" fn() -> *const c_char =
                *library.get(b"harness_description").map_err(error)?;
            let new: unsafe extern "C" fn(u32) -> *mut c_void =
                *library.get(b"harness_new").map_err(error)?;
            let free = *library.get(b"harness_free").map_err(error)?;
            let eval = *library.get(b"harness_eval").map_err(error)?;
            let port: unsafe extern "C" fn(*mut c_void, usize) -> *mut c_void =
                *library.get(b"harness_port").map_err(error)?;
            let description: Description =
                serde_json::from_slice(CStr::from_ptr(text()).to_bytes()).map_err(|source| {
                    LoadError::Description {
                        path: path.to_owned(),
                        source,
                    }
                })?;
            let handle = NonNull::new(new(seed)).expect("harness_new returns an instance");
            (description, handle, free, eval, port)
        };
        let ports = (0..)
            .zip(&description.ports)
            .map(|(number, described)| {
                // SAFETY: the handle belongs to an instance, and the number to one of its ports.
                let address = unsafe { port(handle.as_ptr(), number) };
                let address = NonNull::new(address.cast()).expect("every port has an address");
                Slot::new(address, described)
            })
            .collect();
        Ok(Self {
            handle,
            ports,
            description,
            free,
            eval,
            path: path.to_owned(),
            library,
        })
    }

    /// The instance handle, an argument of functions from [`symbol`](Self::symbol).
    #[must_use]
    pub fn handle(&self) -> *mut c_void {
        self.handle.as_ptr()
    }

    /// Looks up a function of the library that is not in the common interface.
    ///
    /// # Errors
    /// When the library has no function of that name.
    ///
    /// # Safety
    /// `T` must be the function's type, and the function must not be called after the instance has been dropped.
    pub unsafe fn symbol<T: Copy>(&self, name: &str) -> Result<T, LoadError> {
        // SAFETY: guaranteed by the caller.
        let symbol = unsafe { self.library.get::<T>(name.as_bytes()) };
        symbol
            .map(|symbol| *symbol)
            .map_err(|source| LoadError::Library {
                path: self.path.clone(),
                source,
            })
    }

    pub(crate) fn description(&self) -> &Description {
        &self.description
    }

    pub(crate) fn port(&self, port: usize) -> &PortDescription {
        &self.description.ports[port]
    }

    /// Returns the number of the port `name`.
    ///
    /// # Panics
    /// When there is no such port; the message lists the names of all ports.
    #[must_use]
    pub fn find(&self, name: &str) -> usize {
        let ports = &self.description.ports;
        let found = ports.iter().position(|port| port.name == name);
        found.unwrap_or_else(|| {
            let names: Vec<_> = ports.iter().map(|port| port.name.as_str()).collect();
            panic!("no port {name:?}; the ports: {}", names.join(", "))
        })
    }

    /// Returns the value of a port of at most 64 bits after the last evaluation.
    ///
    /// # Panics
    /// When there is no such port, or the port has more than 64 bits.
    #[must_use]
    pub fn value(&self, port: usize) -> u64 {
        self.field(port, 0, self.ports[port].width)
    }

    /// Drives an input of at most 64 bits.
    ///
    /// # Panics
    /// When there is no such input, it has more than 64 bits, or the value does not fit.
    pub fn set_value(&mut self, port: usize, value: u64) {
        self.set_field(port, 0, self.ports[port].width, value);
    }

    /// Returns the field of at most 64 bits of a port from bit `low` up, after the last evaluation.
    ///
    /// # Panics
    /// When there is no such port, the field is not within it, or it has more than 64 bits.
    #[must_use]
    pub fn field(&self, port: usize, low: usize, width: usize) -> u64 {
        assert!(width <= 64 && low + width <= self.ports[port].width);
        parts(low, width).fold(0, |value, part| {
            let found = self.word(port, part.word) >> part.shift & part.mask;
            value | u64::from(found) << part.done
        })
    }

    /// Drives the field of at most 64 bits of an input from bit `low` up.
    ///
    /// # Panics
    /// When there is no such input, the field is not within it, it has more than 64 bits, or the value does not fit.
    pub fn set_field(&mut self, port: usize, low: usize, width: usize, value: u64) {
        assert!(width <= 64 && low + width <= self.ports[port].width);
        self.check_input(port, width == 64 || value >> width == 0, value);
        for part in parts(low, width) {
            let kept = self.word(port, part.word) & !(part.mask << part.shift);
            let set = (value >> part.done) as u32 & part.mask;
            self.set_word(port, part.word, kept | set << part.shift);
        }
    }

    /// Returns the field of `width` bits of a port from bit `low` up, after the last evaluation.
    ///
    /// # Panics
    /// When there is no such port, or the field is not within it.
    #[must_use]
    pub fn bits(&self, port: usize, low: usize, width: usize) -> Bits {
        let mut bits = Bits::default();
        let words = &mut bits.words_mut()[..width.div_ceil(32)];
        for (to, done) in words.iter_mut().zip((0..).step_by(32)) {
            *to = self.field(port, low + done, (width - done).min(32)) as u32;
        }
        bits
    }

    /// Drives the field of `width` bits of an input from bit `low` up.
    ///
    /// # Panics
    /// When there is no such input, the field is not within it, or the value does not fit.
    pub fn set_bits(&mut self, port: usize, low: usize, width: usize, value: Bits) {
        self.check_input(port, value.fits(width), value);
        let words = &value.words()[..width.div_ceil(32)];
        for (&from, done) in words.iter().zip((0..).step_by(32)) {
            self.set_field(port, low + done, (width - done).min(32), from.into());
        }
    }

    fn check_input(&self, port: usize, fits: bool, value: impl fmt::Debug) {
        let Slot { width, output, .. } = self.ports[port];
        let name = || &self.port(port).name;
        assert!(!output, "{} is an output", name());
        assert!(
            fits,
            "{value:?} does not fit the {width} bits of {}",
            name()
        );
    }

    /// Evaluates the design for its current inputs, clocks included.
    pub fn eval(&mut self) {
        // SAFETY: the handle belongs to an instance.
        unsafe { (self.eval)(self.handle.as_ptr()) }
    }

    /// Starts writing waveforms to a file; call it before the first evaluation. Returns `false` if
    /// the library was built without waveforms, or the file cannot be written.
    ///
    /// # Errors
    /// When the function is missing in the library.
    pub fn write_waveforms(&mut self, path: &Path) -> Result<bool, LoadError> {
        let Ok(path) = CString::new(path.as_os_str().as_encoded_bytes()) else {
            return Ok(false);
        };
        // SAFETY: the function has the type that interface.h declares. The handle belongs to an instance, and the path is
        // read during the call only.
        unsafe {
            let start: unsafe extern "C" fn(*mut c_void, *const c_char) -> c_int =
                self.symbol("harness_waveforms")?;
            Ok(start(self.handle.as_ptr(), path.as_ptr()) != 0)
        }
    }

    /// Returns word `index` of the bits of a port; 0 beyond the port.
    fn word(&self, port: usize, index: usize) -> u32 {
        match *self.bytes(port) {
            [byte] if index == 0 => byte.into(),
            [a, b] if index == 0 => u16::from_le_bytes([a, b]).into(),
            ref bytes => {
                let (words, _) = bytes.as_chunks();
                words.get(index).map_or(0, |&word| u32::from_le_bytes(word))
            }
        }
    }

    /// Sets word `index` of the bits of a port.
    fn set_word(&mut self, port: usize, index: usize, word: u32) {
        let word = word.to_le_bytes();
        match self.bytes_mut(port) {
            [byte] => *byte = word[0],
            [a, b] => [*a, *b] = [word[0], word[1]],
            bytes => bytes.as_chunks_mut().0[index] = word,
        }
    }

    /// Returns the bytes of a port in the model, little-endian.
    fn bytes(&self, port: usize) -> &[u8] {
        let Slot { address, bytes, .. } = self.ports[port];
        // SAFETY: the address is valid for this many bytes as long as the instance lives, and writes need `&mut self`.
        unsafe { slice::from_raw_parts(address.as_ptr(), bytes) }
    }

    /// Returns the mutable bytes of a port in the model, little-endian.
    fn bytes_mut(&mut self, port: usize) -> &mut [u8] {
        let Slot { address, bytes, .. } = self.ports[port];
        // SAFETY: as in `bytes`; `&mut self` excludes other access.
        unsafe { slice::from_raw_parts_mut(address.as_ptr(), bytes) }
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        // SAFETY: the handle belongs to an instance, and is not used again.
        unsafe { (self.free)(self.handle.as_ptr()) }
    }
}
