//! Lists the serial ports of this host, and guesses the port that is connected to a board.

use super::error::OpenError;
use serialport::{SerialPortType, available_ports};

/// USB vendor number of FTDI, which makes the USB bridges of both supported boards.
const FTDI: u16 = 0x0403;
/// USB product number of the FT2232H, the bridge of the Urbana. Its interface 0 is JTAG, its
/// interface 1 the serial line.
const FT2232H: u16 = 0x6010;
/// USB product number of the FT231X, the bridge of the ULX3S.
const FT231X: u16 = 0x6015;

/// A serial port.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Port {
    /// Name with which programs open the port, such as `/dev/ttyUSB1`.
    pub name: String,
    /// Maker and product of the port's USB device, or the kind of port.
    pub device: String,
    /// Whether the port has the USB bridge of a supported board.
    pub likely: bool,
}

/// The serial ports of this host, sorted by name.
///
/// # Errors
/// The operating system cannot list the ports.
pub fn ports() -> Result<Vec<Port>, OpenError> {
    let found = available_ports().map_err(OpenError::Ports)?;
    let mut ports: Vec<Port> = found
        .into_iter()
        .map(|port| describe(port.port_name, &port.port_type))
        .collect();
    ports.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(ports)
}

fn describe(name: String, kind: &SerialPortType) -> Port {
    let (device, likely) = match kind {
        SerialPortType::UsbPort(usb) => {
            let text = [&usb.manufacturer, &usb.product];
            let text: Vec<&str> = text.into_iter().flatten().map(String::as_str).collect();
            let device = match text.is_empty() {
                true => format!("USB {:04x}:{:04x}", usb.vid, usb.pid),
                false => text.join(" ").escape_debug().to_string(),
            };
            let likely = match (usb.vid, usb.pid) {
                (FTDI, FT2232H) => usb.interface != Some(0),
                (FTDI, FT231X) => true,
                _ => false,
            };
            (device, likely)
        }
        SerialPortType::PciPort => ("PCI".to_owned(), false),
        SerialPortType::BluetoothPort => ("Bluetooth".to_owned(), false),
        SerialPortType::Unknown => ("unknown".to_owned(), false),
    };
    Port {
        name,
        device,
        likely,
    }
}

/// The port that is probably connected to a board: the only port with a board's USB bridge.
///
/// # Errors
/// There is no such port, or more than one.
pub fn guess() -> Result<String, OpenError> {
    let ports = ports()?;
    chosen(&ports).ok_or_else(|| OpenError::Guess {
        found: summary(&ports),
    })
}

fn chosen(ports: &[Port]) -> Option<String> {
    let mut likely = ports.iter().filter(|port| port.likely);
    let port = likely.next()?;
    likely.next().is_none().then(|| port.name.clone())
}

/// Formats the names of ports on one line, for an error message.
pub fn summary(ports: &[Port]) -> String {
    if ports.is_empty() {
        return "no serial port".to_owned();
    }
    let name = |port: &Port| match port.likely {
        true => format!("{} (likely a board)", port.name),
        false => port.name.clone(),
    };
    ports.iter().map(name).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use serialport::UsbPortInfo;

    fn usb(name: &str, pid: u16, interface: u8, product: Option<&str>) -> Port {
        let info = UsbPortInfo {
            vid: FTDI,
            pid,
            serial_number: None,
            manufacturer: product.map(|_| "FTDI".to_owned()),
            product: product.map(str::to_owned),
            interface: Some(interface),
        };
        describe(name.to_owned(), &SerialPortType::UsbPort(info))
    }

    #[test]
    fn a_port_with_the_bridge_of_a_board_is_guessed() {
        let plain = describe("/dev/ttyS0".to_owned(), &SerialPortType::Unknown);
        let jtag = usb("/dev/ttyUSB0", FT2232H, 0, Some("Dual RS232-HS"));
        let line = usb("/dev/ttyUSB1", FT2232H, 1, Some("Dual RS232-HS"));
        let other = usb("/dev/ttyUSB2", FT231X, 0, None);
        assert_eq!(
            (line.device.as_str(), other.device.as_str()),
            ("FTDI Dual RS232-HS", "USB 0403:6015")
        );
        let urbana = [plain.clone(), jtag.clone(), line.clone()];
        assert_eq!(chosen(&urbana).unwrap(), "/dev/ttyUSB1");
        assert_eq!(
            summary(&urbana),
            "/dev/ttyS0, /dev/ttyUSB0, /dev/ttyUSB1 (likely a board)"
        );
        // With two boards or no board, no port is chosen.
        assert_eq!(chosen(&[line, other]), None);
        assert_eq!(chosen(&[plain, jtag]), None);
        assert_eq!(summary(&[]), "no serial port");
    }
}
