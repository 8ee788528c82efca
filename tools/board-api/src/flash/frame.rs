//! Frames of LiteX's serial boot.

/// Command that loads bytes at an address.
pub const LOAD: u8 = 1;
/// Command that jumps to an address.
pub const JUMP: u8 = 2;

/// Builds a frame: length, CRC-16/XMODEM over command and payload (high byte first), command, payload.
pub fn frame(command: u8, payload: &[u8]) -> Vec<u8> {
    const CRC: crc::Crc<u16> = crc::Crc::<u16>::new(&crc::CRC_16_XMODEM);
    let mut digest = CRC.digest();
    digest.update(&[command]);
    digest.update(payload);
    let mut frame = vec![payload.len() as u8];
    frame.extend(digest.finalize().to_be_bytes());
    frame.push(command);
    frame.extend(payload);
    frame
}
