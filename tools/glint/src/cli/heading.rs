//! The groups of options in the help of `glint render` and `glint orbit`.

/// What the picture shows.
pub const SUBJECT: &str = "Subject";
/// The camera and its lens.
pub const CAMERA: &str = "Camera";
/// How the subject looks.
pub const APPEARANCE: &str = "Appearance";
/// Pictures and their files.
pub const PICTURE: &str = "Picture";
/// What draws the picture.
pub const RENDERER: &str = "Renderer";
