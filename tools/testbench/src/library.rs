//! The shared library of a module: `tools/testbench/harness/module.cpp` as safe Rust.

use std::collections::BTreeMap;
use std::ffi::{CStr, c_char, c_void};
use std::path::Path;
use std::ptr::NonNull;
use std::slice;

use libloading::Library;
use serde::Deserialize;

use crate::Layout;

/// An instance of the module, opaque outside of the library.
#[repr(C)]
struct Opaque {
    _private: [u8; 0],
}

type Handle = *mut Opaque;

/// A port's name, type and direction.
#[derive(Clone, Debug, Deserialize)]
pub struct PortDescription {
    pub name: String,
    pub output: bool,
    #[serde(rename = "type")]
    pub layout: Layout,
}

impl PortDescription {
    /// Bytes in which Verilator stores it.
    fn bytes(&self) -> usize {
        match self.layout.width() {
            0..=8 => 1,
            9..=16 => 2,
            17..=32 => 4,
            33..=64 => 8,
            wide => 4 * wide.div_ceil(32),
        }
    }
}

/// Ports and types of a module.
#[derive(Clone, Debug, Deserialize)]
pub struct Description {
    pub ports: Vec<PortDescription>,
    /// The types of all packages, by `package::type`.
    pub types: BTreeMap<String, Layout>,
}

/// One instance of a verilated module.
pub struct Instance {
    handle: NonNull<Opaque>,
    data: Vec<NonNull<u8>>,
    description: Description,
    free: unsafe extern "C" fn(Handle),
    settle: unsafe extern "C" fn(Handle),
    clock: unsafe extern "C" fn(Handle),
    // Last, so that it is unloaded after everything that lives in it.
    _library: Library,
}

// SAFETY: an instance has a context of its own and is used by one thread at a time; nothing in it is shared.
unsafe impl Send for Instance {}

impl Instance {
    pub fn load(path: &Path, seed: u32) -> Result<Self, libloading::Error> {
        // SAFETY: the library's initializers are those of libstdc++ and Verilator, without conditions. Names and types
        // are those of module.cpp.
        unsafe {
            let library = Library::new(path)?;
            let text: unsafe extern "C" fn() -> *const c_char =
                *library.get(b"module_description")?;
            let new: unsafe extern "C" fn(u32) -> Handle = *library.get(b"module_new")?;
            let data: unsafe extern "C" fn(Handle, usize) -> *mut c_void =
                *library.get(b"module_data")?;
            let description: Description =
                serde_json::from_slice(CStr::from_ptr(text()).to_bytes())
                    .expect("a description as gateware/tests/description.py writes it");
            let handle = NonNull::new(new(seed)).expect("module_new returns an instance");
            let data = (0..description.ports.len())
                .map(|port| {
                    NonNull::new(data(handle.as_ptr(), port).cast()).expect("every port has data")
                })
                .collect();
            Ok(Self {
                handle,
                data,
                description,
                free: *library.get(b"module_free")?,
                settle: *library.get(b"module_settle")?,
                clock: *library.get(b"module_clock")?,
                _library: library,
            })
        }
    }

    pub fn description(&self) -> &Description {
        &self.description
    }

    pub fn port(&self, port: usize) -> &PortDescription {
        &self.description.ports[port]
    }

    /// The bytes of a port, little-endian.
    pub fn bytes(&self, port: usize) -> &[u8] {
        // SAFETY: the address is that of as many bytes, which live as long as the instance and are written to through
        // `&mut self` only.
        unsafe { slice::from_raw_parts(self.data[port].as_ptr(), self.port(port).bytes()) }
    }

    /// The bytes of a port, little-endian, to be changed.
    pub fn bytes_mut(&mut self, port: usize) -> &mut [u8] {
        // SAFETY: as in `bytes`, and nothing else looks at the instance.
        unsafe { slice::from_raw_parts_mut(self.data[port].as_ptr(), self.port(port).bytes()) }
    }

    pub fn settle(&mut self) {
        // SAFETY: the handle is an instance's.
        unsafe { (self.settle)(self.handle.as_ptr()) }
    }

    pub fn clock(&mut self) {
        // SAFETY: the handle is an instance's.
        unsafe { (self.clock)(self.handle.as_ptr()) }
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        // SAFETY: the handle is an instance's, and is not used again.
        unsafe { (self.free)(self.handle.as_ptr()) }
    }
}
