//! Console commands from `--send` and from a pipe.

use crate::common::piped;
use std::process::{Command, Output};

/// Runs `glint console` on a new emulated board, with commands on its standard input.
fn console(arguments: &[&str], input: &str) -> Output {
    let mut glint = Command::new(env!("CARGO_BIN_EXE_glint"));
    piped(glint.args(["console", "emulated"]).args(arguments), input)
}

/// The replies to the commands before a failing command are printed, as lines and as JSON. No later
/// command is sent.
#[test]
fn replies_before_a_failed_command_are_kept() {
    let send = ["--send", "info triangles", "--send", "infor", "--send"];
    for (more, expected) in [
        (&["info backend"][..], "triangles 12\n"),
        (&["info backend", "--json"], "[[\"triangles 12\"]]\n"),
    ] {
        let output = console(&[&send[..], more].concat(), "");
        assert_eq!(output.status.code(), Some(1));
        assert_eq!(String::from_utf8(output.stdout).unwrap(), expected);
        let error = String::from_utf8(output.stderr).unwrap();
        assert!(
            error.starts_with("error: the board refused `infor`"),
            "{error}"
        );
    }
}

#[test]
fn a_pipe_of_commands_gets_replies() {
    let output = console(&[], "info triangles\n# a comment\n\ninfo scene\n");
    assert!(output.status.success());
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(said.starts_with("triangles 12\nscene "), "{said}");
}
