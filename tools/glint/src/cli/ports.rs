//! `glint ports`.

use super::messages::{print_json, say};
use clap::Args;
use glint::board::ports;

/// List the serial ports of this host, and guess which port is connected to a board.
///
/// A port with the USB bridge of the Urbana or the ULX3S is marked; `--board serial` selects it if it is the only one.
#[derive(Args)]
pub struct PortsArguments {
    /// Print the ports as JSON.
    #[arg(long)]
    json: bool,
}

impl PortsArguments {
    pub fn run(self) -> anyhow::Result<()> {
        let ports = ports()?;
        if self.json {
            return print_json(&ports);
        }
        if ports.is_empty() {
            return say("no serial port; `--board emulated` needs none");
        }
        let width = ports.iter().map(|port| port.name.len()).max().unwrap_or(0);
        for port in ports {
            let mark = if port.likely { "  likely a board" } else { "" };
            say(format_args!("{:width$}  {}{mark}", port.name, port.device))?;
        }
        Ok(())
    }
}
