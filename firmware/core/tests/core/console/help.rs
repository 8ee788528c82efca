//! Tests of the help texts of the commands.

use glint_core::console::{Command, write_help};
use glint_core::field::KINDS;

#[test]
fn the_help_lists_every_command_and_how_it_is_used() {
    let help = |command| {
        let mut text = String::new();
        write_help(&mut text, command).expect("a string takes everything");
        text
    };
    let list = help(None);
    for line in list.lines() {
        assert!(line.len() <= 120, "{line}");
    }
    for name in list
        .lines()
        .filter_map(|line| line.split_once("  "))
        .map(|(name, _)| name.trim())
    {
        let usage = help(Some(name));
        assert!(usage.starts_with(name), "{usage}");
        // The usage line in an error message equals the usage line in the help.
        let first = usage.lines().next().unwrap_or_default();
        if let Some(required) = first
            .split_once(' ')
            .filter(|(_, arguments)| !arguments.starts_with('['))
        {
            assert!(
                Command::parse(required.0)
                    .expect_err("incomplete")
                    .to_string()
                    .contains(first)
            );
        } else {
            assert!(Command::parse(name).is_ok(), "{name}");
        }
    }
    assert_eq!(list.lines().count(), 63);
    for (command, usage) in [
        ("object", "object [ACTION [OBJECT [PLACE]]]\n"),
        ("animate", "animate [off|PART [RATE]]\n"),
        ("imu", "imu [ACTION [SAMPLES]]\n"),
        ("replay", "replay [BYTES CRC32]\n"),
        ("gesture", "gesture [ACTION]\n"),
        ("quality", "quality [fast|balanced|exact]\n"),
        ("size", "size W H\n"),
        ("stats", "stats [json]\n"),
        ("texture", "texture [own|TEXTURE]\n"),
        ("light", "light [default|LIGHT]\n"),
        ("lookat", "lookat EX EY EZ GX GY GZ [UX UY UZ]\n"),
        ("fov", "fov X [Y]\n"),
        ("near", "near DISTANCE\n"),
        (
            "projection",
            "projection perspective|orthographic|matrix NUMBERS\n",
        ),
        ("shading", "shading [flat|smooth]\n"),
        ("material", "material [MATERIAL]\n"),
    ] {
        assert!(help(Some(command)).starts_with(usage), "{command}");
    }
    let field = help(Some("field"));
    assert!(
        KINDS.iter().all(|(form, _)| field.contains(form)),
        "{field}"
    );
    assert_eq!(
        help(Some("camera")),
        "camera R THETA PHI\n  face the origin from distance R (2 to 5), azimuth THETA, angle PHI from the z axis\n  \
         R: a number\n  THETA: a number of degrees\n  PHI: a number of degrees from 0 to 180\n"
    );
}
