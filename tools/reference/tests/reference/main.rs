//! Tests of the references, and of the report that compares Glint with the references.
//!
//! All tests are in one program, because linking further programs takes time.

mod cone;
mod exits;
mod field;
mod gesture;
mod imu;
mod lines;
mod rasterizer;
mod raymarched;
mod report;
mod round;
mod stiff;
mod wireframe;
mod workflow;

use std::fs;
use std::path::PathBuf;

/// Console output with the cycles of the measured kernels, in place of a board.
const TRANSCRIPT: &str = "bench sin_cos_q30 min 1 median 2 max 3 cycles\nok\n";

/// Makes an empty folder for a test's files.
fn folder(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    if folder.exists() {
        fs::remove_dir_all(&folder).expect("a removable old folder");
    }
    fs::create_dir_all(&folder).expect("a writable build folder");
    folder
}
