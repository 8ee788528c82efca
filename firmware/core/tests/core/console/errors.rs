//! Tests of the error messages for lines that are not commands.

use glint_core::console::Command;

/// Invalid lines, each followed by the expected error.
const MISTAKES: &str = r#"
    help cube
        help: COMMAND is "cube" (column 6): expected a command, `help` lists them
    buttons now
        buttons: "now" (column 9): expected the end of the line, usage: buttons
    camera 3 4
        camera: PHI is missing: expected a number of degrees from 0 to 180, usage: camera R THETA PHI
    camera 3 4 181
        camera: PHI is "181" (column 12): expected a number of degrees from 0 to 180
    camera 3 x 5
        camera: THETA is "x" (column 10): expected a number of degrees
    camera 1e300 0 0
        camera: R is "1e300" (column 8): expected a number
    camera nan 0 0
        camera: R is "nan" (column 8): expected a number
    quality best
        quality: fast|balanced|exact is "best" (column 9): expected fast or balanced or exact
    size 1 2
        size: 1 x 2: expected 320 180, 640 360 or 1280 720
    load -1 0
        load: BYTES is "-1" (column 6): expected a whole number from 0 to 33554432
    load 5 123456789
        load: CRC32 is "123456789" (column 8): expected up to 8 hexadecimal digits
    unload a-name-of-more-than-24-bytes
        unload: NAME is "a-name-of-more-than-24-b..." (column 8): expected a name of at most 24 visible characters of ASCII
    leds 65536
        leds: VALUE is "65536" (column 6): expected a whole number from 0 to 65535
    cull
        cull: on|off is missing: expected on or off, usage: cull on|off
    stats xml
        stats: json is "xml" (column 7): expected json
    frame depth 2
        frame: "2" (column 13): expected the end of the line, usage: frame [depth]
    view 0 0 3 1 0 0 0 2
        view: VY is "2" (column 20): expected a number from -2 to 2
    view 0 0 3 1 0 0 0 1 0 0 0 -1 0.9 0.1
        view: u × v = −n: expected u × v = n (u right, v down, n forward)
    field menger:7
        field: depth: expected 1 to 6
    field box:1,1,1 on
        field: "on" (column 17): expected the end of the line, usage: field [off|FIELD]
    stereo 0.05
        stereo: 0.05: expected E,ZERO[,red-blue|red-cyan]
    stereo 0.5,0.25
        stereo: ZERO 0.25: expected at least 0.5
    material wood
        material: MATERIAL is "wood" (column 10): expected normal or clay or jade or sky or gold or ivory or slate
    light 1,2
        light: 1,2: expected X,Y,Z[,RRGGBB] or camera[,RRGGBB]
    light 0,0,0
        light: direction 0,0,0: expected a non-zero direction
    ambient fff
        ambient: default|COLOUR is "fff" (column 9): expected default or a colour RRGGBB
    mounting y -y
        mounting: FORWARD and UP are on the same axis: expected perpendicular directions
    imu off 3
        imu: SAMPLES is 3 after off: expected only after calibrate or stream
    sensitivity 8.5
        sensitivity: expected a number from 0.125 to 8
    fog 16
        fog: off|DENSITY is "16" (column 5): expected off or a number from 0 to below 16
"#;

fn error(line: &str) -> String {
    Command::parse(line).expect_err(line).to_string()
}

#[test]
fn mistakes_are_named_with_their_place() {
    let lines: Vec<&str> = MISTAKES.trim().lines().map(str::trim).collect();
    for [line, expected] in lines.as_chunks().0 {
        assert_eq!(error(line), *expected);
    }
    for (line, shown, column) in [
        ("  cube", "cube".to_owned(), 3),
        (&"\u{1}é".repeat(50), "??".repeat(12) + "...", 1),
    ] {
        let expected = "expected a command, `help` lists them";
        assert_eq!(
            error(line),
            format!("\"{shown}\" (column {column}): {expected}")
        );
    }
    let unknown = error("field ball:1");
    assert!(unknown.starts_with("field: no field is named ball: expected menger:DEPTH, "));
}
