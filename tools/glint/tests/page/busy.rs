//! Pages of a board that runs a command.

use crate::served::{Served, wait_for};
use tungstenite::Message;

const MESH: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

#[test]
fn a_model_waits_for_the_end_of_a_command_that_can_be_stopped() {
    let served = Served::start("page-busy");
    let mut page = served.viewer();
    wait_for(&mut page, r#""holder":"you""#);
    // The first measurements have no attitude, because the sensor starts later than the board.
    while !wait_for(&mut page, r#""type":"sample""#).contains(r#""attitude":["#) {}
    let command = r#"{"type":"command","line":"imu stream"}"#;
    page.send(Message::text(command)).unwrap();
    wait_for(&mut page, "gx,gy,gz");

    // A page that is opened during the command receives all lists.
    let mut second = served.viewer();
    let lists = wait_for(&mut second, r#""type":"lists""#);
    assert!(lists.contains("octahedron"), "{lists}");

    let length = MESH.len();
    let upload = format!(r#"{{"type":"upload","name":"a.obj","bytes":{length}}}"#);
    let help = r#"{"type":"help","command":"render"}"#;
    for message in [
        Message::text(upload),
        Message::binary(MESH),
        Message::text(help),
        Message::text(r#"{"type":"interrupt"}"#),
    ] {
        page.send(message).unwrap();
    }
    wait_for(&mut page, "the model is shown");
    wait_for(&mut page, r#""type":"help","command":"render""#);
}
