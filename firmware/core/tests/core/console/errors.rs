//! Tests of the error messages for lines that are not commands.

use glint_core::console::Command;

/// Invalid lines, each followed by the expected error.
const MISTAKES: &str = r#"
    help cube
        help: COMMAND is "cube" (column 6): expected a command, `help` lists them
    camera 3 4
        camera: PHI is missing: expected a number of degrees from 0 to 180, usage: camera R THETA PHI
    camera 3 x 5
        camera: THETA is "x" (column 10): expected a number of degrees
    camera 1e300 0 0
        camera: R is "1e300" (column 8): expected a number
    camera nan 0 0
        camera: R is "nan" (column 8): expected a number
    quality best
        quality: fast|balanced|exact is "best" (column 9): expected fast or balanced or exact
    unload a-name-of-more-than-24-bytes
        unload: NAME is "a-name-of-more-than-24-b..." (column 8): expected a name of at most 24 visible characters of ASCII
    cull
        cull: on|off is missing: expected on or off, usage: cull on|off
    stats xml
        stats: json is "xml" (column 7): expected json
    frame depth 2
        frame: "2" (column 13): expected the end of the line, usage: frame [depth]
    view 0 0 3 1 0 0 0 2
        view: VY is "2" (column 20): expected a number from -2 to 2
    field box:1,1,1 on
        field: "on" (column 17): expected the end of the line, usage: field [off|FIELD]
    stereo 0.05
        stereo: 0.05: expected E,ZERO[,red-blue|red-cyan]
    material wood
        material: MATERIAL is "wood" (column 10): expected normal or mixed or clay or jade or sky or gold or ivory or slate
    light 1,2
        light: 1,2: expected X,Y,Z[,RRGGBB] or camera[,RRGGBB]
    ambient fff
        ambient: default|COLOUR is "fff" (column 9): expected default or a colour RRGGBB
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
}
