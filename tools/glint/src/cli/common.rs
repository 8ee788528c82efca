//! Options, access to boards, progress bars and output that the commands share.

use anyhow::Context;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use glint::board::{Board, BoardName, SerialBoard, SimulatedBoard, built_firmware};
use glint::console::Console;
use glint::error::{FormatError, quote};
use glint::transfer::Route;
use glint_core::picture::Size;
use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;
use std::fs::{File, Permissions};
use std::io::{self, BufWriter, Write};
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Options for the connection to a board.
#[derive(clap::Args)]
pub struct LineArguments {
    /// Baud rate of a serial port, in bits per second.
    #[arg(long, default_value_t = 115_200, value_name = "BITS")]
    pub baud: u32,
    /// Firmware of the virtual board [default: the one built by `cargo xtask firmware`].
    #[arg(long, value_name = "FILE")]
    pub firmware: Option<PathBuf>,
}

impl LineArguments {
    /// Starts a virtual board and runs it to the firmware's first prompt.
    pub fn virtual_board(&self) -> anyhow::Result<SimulatedBoard> {
        let firmware = built_firmware(self.firmware.as_deref())?;
        let mut board = SimulatedBoard::fast(&firmware)?;
        let spinner = spinner("the virtual board starts");
        Console::new(&mut board).greet()?;
        spinner.finish_and_clear();
        Ok(board)
    }

    /// Opens a board on a serial port.
    pub fn serial_board(&self, port: &str) -> anyhow::Result<SerialBoard> {
        Ok(SerialBoard::open(port, self.baud)?)
    }

    /// Opens the board that `name` selects. A virtual board is started and runs its firmware.
    pub fn board(&self, name: &BoardName) -> anyhow::Result<Box<dyn Board>> {
        Ok(match name {
            BoardName::Virtual => Box::new(self.virtual_board()?),
            BoardName::Serial(port) => Box::new(self.serial_board(port)?),
        })
    }
}

/// Options of a command that transfers data to and from a board, and prints a result.
#[derive(clap::Args)]
pub struct TransferArguments {
    /// Route of the data to and from a board [default: memory for the virtual board, serial for a board on a serial port].
    #[arg(long, value_enum)]
    pub transfer: Option<Route>,
    #[command(flatten)]
    pub line: LineArguments,
    /// Print the result as JSON.
    #[arg(long)]
    pub json: bool,
}

/// Returns a clap parser that accepts the names of the values in `all` and converts a name to its value.
pub fn named<T: Copy + Send + Sync + 'static, const N: usize>(
    all: [T; N],
    name: fn(T) -> &'static str,
) -> impl TypedValueParser<Value = T> {
    PossibleValuesParser::new(all.map(name)).try_map(move |found| {
        let value = all.into_iter().find(|value| name(*value) == found);
        value.ok_or("not one of the names")
    })
}

/// A spinner for work of unknown length. It is drawn on a terminal only.
pub fn spinner(label: &str) -> ProgressBar {
    let spinner = ProgressBar::new_spinner().with_message(label.to_owned());
    spinner.set_style(style("{spinner} {msg} {elapsed}"));
    spinner.enable_steady_tick(Duration::from_millis(200));
    spinner
}

/// A progress bar that counts bytes. It is drawn on a terminal only.
pub fn bar(label: &str) -> ProgressBar {
    let bar = ProgressBar::new(0).with_message(label.to_owned());
    bar.set_style(style("{msg} {wide_bar} {bytes}/{total_bytes} {eta}"));
    bar
}

/// A progress bar that counts items, which the text `items` names. It is drawn on a terminal only.
pub fn count_bar(label: &str, items: &str) -> ProgressBar {
    let bar = ProgressBar::new(0).with_message(label.to_owned());
    let template = format!("{{msg}} {{wide_bar}} {{pos}}/{{len}} {items} {{eta}}");
    bar.set_style(style(&template));
    bar
}

fn style(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar())
}

/// Returns a progress callback that sets the position and the length of a bar.
pub fn advance(bar: &ProgressBar) -> impl FnMut(u64, u64) {
    move |done, all| {
        bar.set_length(all);
        bar.set_position(done);
    }
}

/// Prints a line to standard output. A closed pipe, as with `| head`, is no error.
pub fn say(line: impl std::fmt::Display) -> anyhow::Result<()> {
    match writeln!(std::io::stdout(), "{line}") {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(error).context("standard output")
        }
        _ => Ok(()),
    }
}

/// Prints a value as JSON on one line.
pub fn print_json(value: &impl Serialize) -> anyhow::Result<()> {
    say(serde_json::to_string(value)?)
}

/// Writes `bytes` as the whole content of the file at `path`, as [`write_whole`].
pub fn write_file(path: &Path, bytes: &[u8]) -> anyhow::Result<()> {
    write_whole(path, |out| out.write_all(bytes))
}

/// Writes the file at `path` whole or not at all: `write` fills a new file beside it, which then takes its place.
///
/// A device or a pipe, such as /dev/null, is written directly.
pub fn write_whole(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> anyhow::Result<()> {
    replace(path, write).with_context(|| format!("{}: cannot be written", path.display()))
}

fn replace(path: &Path, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let present = path.metadata().ok();
    if present.as_ref().is_some_and(|present| !present.is_file()) {
        let mut out = BufWriter::new(File::create(path)?);
        write(&mut out)?;
        return out.flush();
    }
    // A symbolic link stays, and the file that it leads to is replaced.
    let path = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let folder = path.parent().filter(|folder| *folder != Path::new(""));
    let permissions = present.map_or(Permissions::from_mode(0o666), |file| file.permissions());
    let file = tempfile::Builder::new()
        .permissions(permissions)
        .tempfile_in(folder.unwrap_or(Path::new(".")))?;
    let mut out = BufWriter::new(file.as_file());
    write(&mut out)?;
    out.flush()?;
    drop(out);
    file.persist(path)?;
    Ok(())
}

/// Parses the option `--size`.
pub fn size(text: &str) -> anyhow::Result<Size> {
    let size = Size::ALL.into_iter().find(|size| size.to_string() == text);
    size.ok_or_else(|| {
        let error = FormatError::whole("320x180, 640x360 or 1280x720", quote(text.as_bytes()));
        error.in_file("--size").into()
    })
}

#[cfg(test)]
mod tests {
    use super::{write_file, write_whole};
    use std::fs::{self, Permissions};
    use std::io;
    use std::os::unix::fs::{PermissionsExt, symlink};

    #[test]
    fn a_file_is_replaced_whole_or_not_at_all() {
        let folder = tempfile::tempdir().unwrap();
        let [file, link] = ["file", "link"].map(|name| folder.path().join(name));
        write_file(&file, b"before").unwrap();
        fs::set_permissions(&file, Permissions::from_mode(0o640)).unwrap();
        symlink(&file, &link).unwrap();
        let failed = write_whole(&link, |out| {
            out.write_all(b"a part")?;
            Err(io::Error::other("full"))
        });
        assert_eq!(
            format!("{:#}", failed.unwrap_err()),
            format!("{}: cannot be written: full", link.display())
        );
        assert_eq!(fs::read(&file).unwrap(), b"before");

        write_file(&link, b"after").unwrap();
        assert_eq!(fs::read(&file).unwrap(), b"after");
        assert!(link.is_symlink());
        assert_eq!(file.metadata().unwrap().permissions().mode() & 0o777, 0o640);
        assert_eq!(folder.path().read_dir().unwrap().count(), 2);
        write_file("/dev/null".as_ref(), b"anything").unwrap();
    }
}
