//! `glint completions`.

use super::messages::say;
use clap::{Args, Command};
use clap_complete::{Shell, generate};

/// Print the shell completions of this program.
///
/// For bash: `glint completions bash > ~/.local/share/bash-completion/completions/glint`.
#[derive(Args)]
pub struct CompletionsArguments {
    /// Shell that will read the completions.
    shell: Shell,
}

impl CompletionsArguments {
    /// Prints the completions of `program`.
    pub fn run(self, mut program: Command) -> anyhow::Result<()> {
        let mut script = Vec::new();
        generate(self.shell, &mut program, "glint", &mut script);
        say(String::from_utf8_lossy(&script).trim_end())
    }
}
