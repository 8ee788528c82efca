//! The fuzz target of the sender and the receiver of an upload.

use glint_core::wire::{MAX_FRAME, Manifest, Receiver, Sender, State, Timing, crc32};

/// Session number of the transfers of the seeds.
pub const SESSION: u8 = 5;

/// The data of the transfers in the corpus.
pub fn upload_data(length: usize) -> Vec<u8> {
    (0..length).map(|i| (i * 7 / 3) as u8).collect()
}

/// Passes the input in pieces to the sender or the receiver of a transfer. The first three bytes
/// select the side, the time between two pieces, and the length of a piece.
pub fn run(input: &[u8]) -> bool {
    let &[side, pace, piece, ref stream @ ..] = input else {
        return false;
    };
    let data = upload_data(1500);
    let mut frame = [0; MAX_FRAME];
    let mut now = 0;
    if side & 1 == 0 {
        let mut buffer = vec![0; 2000];
        let announced = match side >> 1 & 3 {
            0 => None,
            n => Some(Manifest::of(&data[..[0, 100, 1500, 16][usize::from(n)]])),
        };
        let mut receiver = Receiver::new(&mut buffer, announced, Timing::CONSOLE, now);
        for bytes in stream.chunks(usize::from(piece) + 1) {
            let taken = receiver.on_bytes(now, bytes);
            assert!(taken <= bytes.len());
            assert!(receiver.poll(now, &mut frame) <= MAX_FRAME);
            now += u64::from(pace) * 4;
        }
        let accepted = receiver.state() == State::Done;
        match (accepted, receiver.received(), announced) {
            (true, None, _) => panic!("done without data"),
            (false, Some(_), _) => panic!("data without being done"),
            (_, Some(got), Some(manifest)) => {
                assert_eq!(
                    (got.len() as u32, crc32(got)),
                    (manifest.length, manifest.crc32)
                );
            }
            _ => {}
        }
        for _ in 0..3 {
            now += 10_000;
            receiver.poll(now, &mut frame);
        }
        assert_ne!(
            receiver.state(),
            State::Running,
            "a silent line ends a transfer"
        );
        accepted
    } else {
        let length = [1500, 0, 100, 16][usize::from(side >> 1 & 3)];
        let mut sender = Sender::new(&data[..length], 5, Timing::HOST, now);
        for bytes in stream.chunks(usize::from(piece) + 1) {
            while sender.poll(now, &mut frame) > 0 {}
            let taken = sender.on_bytes(now, bytes);
            assert!(taken <= bytes.len());
            now += u64::from(pace) * 4;
        }
        while sender.poll(now, &mut frame) > 0 {}
        let accepted = sender.state() == State::Done;
        for _ in 0..5 {
            now += 30_000;
            while sender.poll(now, &mut frame) > 0 {}
        }
        assert_ne!(
            sender.state(),
            State::Running,
            "a silent line ends a transfer"
        );
        accepted
    }
}

/// Corrects the CRC-16 of every frame in a stream.
pub fn repair(input: &mut Vec<u8>) {
    const CRC: crc::Crc<u16> = crc::Crc::<u16>::new(&crc::CRC_16_IBM_3740);
    let Some((head, stream)) = input.split_at_checked(3) else {
        return;
    };
    let mut repaired = head.to_vec();
    for frame in stream.split(|&byte| byte == 0) {
        match cobs::decode_vec(frame) {
            Ok(body) if body.len() > 2 => {
                let body = &body[..body.len() - 2];
                let with_crc = [body, &CRC.checksum(body).to_le_bytes()].concat();
                repaired.extend(cobs::encode_vec(&with_crc));
            }
            _ => repaired.extend(frame),
        }
        repaired.push(0);
    }
    *input = repaired;
}

/// Byte streams of complete transfers, from the sender and from the receiver. The first three bytes of each seed select how the
/// fuzz target delivers the stream to the other side.
pub fn seeds() -> Vec<Vec<u8>> {
    let streams = [0, 1, 16, 100, 1500].map(|length| exchange(&upload_data(length), SESSION));
    let seeds = streams
        .into_iter()
        .flat_map(|[from_sender, from_receiver]| {
            [
                [&[0, 0, 40], &from_sender[..]].concat(),
                [&[1, 0, 40], &from_receiver[..]].concat(),
            ]
        });
    seeds.collect()
}

/// All frames of a transfer of `data`, from the sender and from the receiver.
pub fn exchange(data: &[u8], session: u8) -> [Vec<u8>; 2] {
    let mut buffer = vec![0; data.len()];
    let mut sender = Sender::new(data, session, Timing::HOST, 0);
    let mut receiver = Receiver::new(&mut buffer, Some(Manifest::of(data)), Timing::CONSOLE, 0);
    let mut said = [const { Vec::new() }; 2];
    let mut frame = [0; MAX_FRAME];
    for now in 0..1000 {
        let sent = sender.poll(now, &mut frame);
        said[0].extend(&frame[..sent]);
        receiver.on_bytes(now, &frame[..sent]);
        let answered = receiver.poll(now, &mut frame);
        said[1].extend(&frame[..answered]);
        sender.on_bytes(now, &frame[..answered]);
        if sender.state() != State::Running {
            break;
        }
    }
    said
}
