//! Alignment of files that are included in a program's image, for the engines.

/// Bytes aligned to 16 bytes, which the engines require of meshes and textures.
///
/// ```
/// use glint_program::Aligned;
/// static TEXT: &Aligned<[u8]> = &Aligned(*b"sixteen");
/// assert_eq!(TEXT.0.as_ptr().addr() % 16, 0);
/// ```
#[repr(C, align(16))]
pub struct Aligned<T: ?Sized>(pub T);

/// The bytes of a file, aligned for the engines: `include_aligned!("ship.mesh")` is a `&'static [u8]` in the program's image. The path is
/// relative to the source file.
///
/// ```standalone_crate
/// let bytes = glint_program::include_aligned!("../Cargo.toml");
/// assert!(bytes.as_ptr().addr() % 16 == 0 && bytes.starts_with(b"[package]"));
/// ```
#[macro_export]
macro_rules! include_aligned {
    ($path:expr $(,)?) => {{
        static BYTES: &$crate::Aligned<[u8]> = &$crate::Aligned(*include_bytes!($path));
        &BYTES.0
    }};
}
