//! The groups of options in the help of `glint render` and `glint orbit`.

/// What the picture shows.
pub const SUBJECT: &str = "Subject";
/// The camera and its lens.
pub const CAMERA: &str = "Camera";
/// The appearance of the subject.
pub const APPEARANCE: &str = "Appearance";
/// Pictures and their files.
pub const PICTURE: &str = "Picture";
/// The renderer of the picture.
pub const RENDERER: &str = "Renderer";
