//! Defaults of the board options, from the environment or the configuration file.

use anyhow::Context;
use glint::board::BoardName;
use glint::error::FormatError;
use glint::formats::read_at_most;
use serde::Deserialize;
use std::env;
use std::io::{self, ErrorKind};
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

/// Maximum size of a configuration file in bytes.
const MAX_BYTES: u64 = 64 << 10;
/// Default baud rate, in bits per second.
const BAUD: u32 = 115_200;

/// Allowed baud rates, in bits per second. A rate of 0 would hang up the line.
const BAUDS: RangeInclusive<u32> = 50..=12_000_000;

/// The configuration file, `glint/config.toml` in the user's configuration folder.
#[derive(Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(deny_unknown_fields)]
struct Config {
    /// Name of the default board.
    board: Option<String>,
    /// Baud rate of serial ports, in bits per second.
    baud: Option<u32>,
}

/// The board option of commands that need a board.
#[derive(clap::Args)]
pub struct BoardChoice {
    /// Board: `emulated`, `virtual`, a serial port, or `serial` for the port that `glint ports` guesses [default: from
    /// GLINT_BOARD or the configuration file, otherwise emulated].
    #[arg(long)]
    board: Option<BoardName>,
}

impl BoardChoice {
    /// The name of the board.
    ///
    /// # Errors
    /// The configuration file is damaged.
    pub fn name(&self) -> anyhow::Result<BoardName> {
        board(self.board.as_ref())
    }
}

/// The board from the option, the environment or the configuration file, in this order; by default
/// the emulated board.
///
/// # Errors
/// The configuration file is damaged.
pub fn board(option: Option<&BoardName>) -> anyhow::Result<BoardName> {
    if let Some(board) = option {
        return Ok(board.clone());
    }
    let board = match variable("GLINT_BOARD") {
        Some(board) => Some(board),
        None => read()?.board,
    };
    Ok(match board {
        Some(board) => board.parse()?,
        None => BoardName::Emulated,
    })
}

/// The baud rate from the option, the environment or the configuration file, in this order; by
/// default 115,200.
///
/// # Errors
/// The value is not a baud rate, or the configuration file is damaged.
pub fn baud(option: Option<u32>) -> anyhow::Result<u32> {
    if let Some(baud) = option {
        return checked("--baud", &baud.to_string());
    }
    if let Some(text) = variable("GLINT_BAUD") {
        return checked("GLINT_BAUD", &text);
    }
    match read()?.baud {
        Some(baud) => checked("the configuration file's baud", &baud.to_string()),
        None => Ok(BAUD),
    }
}

/// Parses a baud rate; `name` is the source of the text.
fn checked(name: &str, text: &str) -> anyhow::Result<u32> {
    let baud = text.parse().ok().filter(|baud| BAUDS.contains(baud));
    let (slowest, fastest) = (BAUDS.start(), BAUDS.end());
    Ok(baud.ok_or_else(|| {
        let found = glint::error::quote(text.as_bytes());
        let expected = format!("a number of bits per second from {slowest} to {fastest}");
        FormatError::whole(expected, found).in_file(name)
    })?)
}

/// The value of an environment variable that is set and not empty.
fn variable(name: &str) -> Option<String> {
    let value = env::var_os(name)?.to_string_lossy().into_owned();
    Some(value).filter(|value| !value.is_empty())
}

/// The path of the configuration file, if the user has a home folder.
fn path() -> Option<PathBuf> {
    let folder = env::var_os("XDG_CONFIG_HOME").map(PathBuf::from);
    let folder = folder.filter(|folder| folder.is_absolute());
    let folder = folder.or_else(|| Some(Path::new(&env::var_os("HOME")?).join(".config")));
    Some(folder?.join("glint").join("config.toml"))
}

/// Reads the configuration file, if it exists.
fn read() -> anyhow::Result<Config> {
    let Some(path) = path() else {
        return Ok(Config::default());
    };
    match contents(&path) {
        Ok(text) => Ok(parse(&text).map_err(|error| error.in_path(&path))?),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(Config::default()),
        Err(error) => Err(error).with_context(|| path.display().to_string()),
    }
}

/// The text of a configuration file. Only regular files are read, because reading a pipe or a
/// device could block or never end.
fn contents(path: &Path) -> io::Result<String> {
    if !path.metadata()?.is_file() {
        return Err(io::Error::other(
            "expected a file, found a folder, a pipe or a device",
        ));
    }
    let text = String::from_utf8(read_at_most(path, MAX_BYTES)?);
    text.map_err(|_| io::Error::other("expected UTF-8"))
}

fn parse(text: &str) -> Result<Config, FormatError> {
    toml::from_str(text).map_err(|error: toml::de::Error| {
        let expected = "board = \"NAME\" and baud = NUMBER, each at most once";
        FormatError::whole(expected, error.message().escape_debug().to_string())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_known_entries_are_read() {
        let config = parse("# mine\nbaud = 9600\nboard = \"/dev/ttyUSB1\"\n").unwrap();
        let board = Some("/dev/ttyUSB1".to_owned());
        assert_eq!(
            config,
            Config {
                board,
                baud: Some(9600)
            }
        );
        assert_eq!(parse(""), Ok(Config::default()));
        for text in [
            "bord = \"x\"",
            "baud = -1",
            "baud = \"fast\"",
            "board = 3",
            "board",
        ] {
            let error = parse(text).unwrap_err().to_string();
            assert!(error.starts_with("expected board = \"NAME\""), "{error}");
            assert!(!error.contains('\n'));
        }
    }
}
