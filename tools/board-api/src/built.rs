//! Finds the files that `cargo xtask` builds.

use std::env;
use std::path::{Path, PathBuf};

/// Environment variable with the path of the clone that contains the built files.
pub const HOME: &str = "GLINT_HOME";

/// A built file was not found.
#[derive(Debug, thiserror::Error)]
#[error(
    "{file}: found in none of {searched}; run `{command}` in a clone of Glint, and set {HOME} to the path of the clone"
)]
pub struct NotBuilt {
    /// Path of the missing file in a clone of Glint.
    pub file: PathBuf,
    /// The folders that were searched.
    pub searched: String,
    /// The command that builds the file.
    pub command: &'static str,
}

/// Finds a file in the folder `target` of a clone of Glint; `command` is the command that builds the file. The variable
/// `GLINT_HOME` gives the path of the clone. If the variable is not set, the function takes the first folder with the file among
/// the folders above the running program, the current folder and the folders above the current folder.
///
/// # Errors
/// No folder contains the file.
pub fn find(file: &str, command: &'static str) -> Result<PathBuf, NotBuilt> {
    let file = Path::new("target").join(file);
    let folders = folders();
    let folders: Vec<_> = folders.iter().map(PathBuf::as_path).collect();
    find_in(&folders, file, command)
}

/// The folders in which [`find`] looks for a clone of Glint, in the order of the search.
pub fn folders() -> Vec<PathBuf> {
    if let Some(home) = env::var_os(HOME) {
        return vec![PathBuf::from(home)];
    }
    let program = env::current_exe().map(|program| program.with_file_name(""));
    let starts = [program, env::current_dir()];
    let folders = starts.iter().flatten().flat_map(|start| start.ancestors());
    folders.map(Path::to_owned).collect()
}

fn find_in(folders: &[&Path], file: PathBuf, command: &'static str) -> Result<PathBuf, NotBuilt> {
    let mut paths = folders.iter().map(|folder| folder.join(&file));
    paths.find(|path| path.exists()).ok_or_else(|| {
        let searched = folders.iter().map(|folder| folder.display().to_string());
        NotBuilt {
            searched: searched.collect::<Vec<_>>().join(", "),
            file,
            command,
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_folder_with_the_file_counts() {
        let [here, nowhere] = [env!("CARGO_MANIFEST_DIR"), "/nowhere"].map(Path::new);
        let find =
            |folders: &[&Path]| find_in(folders, "Cargo.toml".into(), "cargo xtask firmware");
        assert_eq!(find(&[nowhere, here]).unwrap(), here.join("Cargo.toml"));
        assert_eq!(
            find(&[nowhere, Path::new("/else")])
                .unwrap_err()
                .to_string(),
            "Cargo.toml: found in none of /nowhere, /else; run `cargo xtask firmware` in a clone of Glint, and set GLINT_HOME to the \
             path of the clone"
        );
    }
}
