//! The form of a case, and inputs that several cases share.

use glint_core::fixed::{Q8_24, U8_28};
use glint_core::matrix::Matrix;
use glint_core::mesh::Mesh;
use glint_model::{Clip, MeshSubject, Object, Placement};

/// The case as the page names it, and the function that checks it and states its outcome in the words of the page.
pub type Case = (&'static str, fn() -> String);

/// The outcome of a refused input: its error text.
pub fn refused<T>(result: Result<T, impl ToString>) -> String {
    let error = result.err().expect("an error").to_string();
    format!("refused: `{error}`")
}

pub fn number(x: f64) -> Q8_24 {
    Q8_24::from_num(x)
}

pub fn view_volume(far: f64) -> Clip {
    Clip::View {
        far: U8_28::from_num(far),
    }
}

/// An object without a colour of its own.
pub fn object(bytes: &[u8], matrix: Matrix) -> Object<'_> {
    Object {
        subject: MeshSubject::new(Mesh::new_checked(bytes).unwrap()),
        placement: Placement::new(matrix),
        colour: None,
    }
}
