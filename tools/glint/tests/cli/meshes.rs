//! `glint render` of meshes with the model.

use crate::common::{VIEW, all_refused, depths, drawn, failed, folder, json, refused};

#[test]
fn renders_and_their_files() {
    let folder = folder("renders");
    let options = "--size 320x180 --aa 1 --shading flat --background 000000";
    let render = |more: &str| drawn(&folder, &format!("render teapot {options} {more}"));
    let picture = render("--camera 2,-90,90 --depth a.f32 --stats a.json --json");
    assert_eq!(picture.len(), 320 * 180 * 3);

    std::fs::write(folder.join("view.json"), VIEW).unwrap();
    for same in [
        "--view view.json",
        "--look-at 0,-2,0,0,5,0",
        "--look 0,-2,0,0,0",
        "--view view.json --far 100",
    ] {
        assert!(render(same) == picture, "{same}");
    }
    for other in [
        "--camera 2,-80,90",
        "--view view.json --far 1.8",
        "--view view.json --fov 150",
        "--view view.json --orthographic 1.8 --depth orthographic.f32",
        "--view view.json --object 'cube scale 0.2 rotate x 30 move 0,-0.6,0 colour ff0000'",
    ] {
        assert!(render(other) != picture, "{other}");
    }

    let stats = json(&folder.join("a.json"));
    let number = |key: &str| stats[key].as_u64().unwrap();
    let counted = number("triangles_culled") + number("triangles_drawn");
    assert_eq!(number("triangles_in"), counted);
    assert!(number("pixels_tested") >= number("pixels_covered"));
    assert!(stats["cycles"].is_null() && stats["clock"].is_null());

    // The teapot's distance from the eye along n is between 1.5 and 2.5.
    let parallel = depths(&folder.join("orthographic.f32"));
    let covered = parallel.iter().filter(|z| z.is_finite());
    assert!(covered.clone().count() > 5_000 && covered.clone().all(|z| (1.4..2.6).contains(z)));
    let depth = depths(&folder.join("a.f32"));
    assert_eq!(depth.len(), 320 * 180);
    for (z, pixel) in depth.iter().zip(picture.chunks_exact(3)) {
        let is_background = *z == f32::INFINITY && pixel == [0; 3];
        assert!(is_background || (1.4..2.6).contains(z), "{z} {pixel:?}");
    }
    assert!(depth.iter().any(|z| z.is_finite()));
}

/// Light on a mesh: a light at the camera or a directional light, with a colour, and ambient light.
#[test]
fn light_on_a_mesh() {
    let folder = folder("light-on-a-mesh");
    let options = "--size 320x180 --aa 1 --shading flat --background 000000";
    let render = |more: &str| drawn(&folder, &format!("render icosphere:4 {options} {more}"));
    let lit = |picture: &[u8], channel: usize| {
        let channels = picture.iter().skip(channel).step_by(3);
        channels.filter(|&&value| value > 0).count()
    };
    let default = render("");
    assert_eq!(render("--light camera --ambient 000000"), default);
    // The light comes from above, so the lower half is black without ambient light.
    let above = render("--light 0,0,1,ff0000 --ambient 000000");
    let bright = lit(&default, 0);
    assert!((bright / 4..bright * 9 / 10).contains(&lit(&above, 0)));
    assert_eq!([lit(&above, 1), lit(&above, 2)], [0; 2]);
    // The default ambient light is grey.
    let grey = render("--light 0,0,1,ff0000");
    assert!((0..3).all(|channel| lit(&grey, channel) >= bright));
    assert_ne!(render("--ambient 0000ff"), default);
    let two = "render cube --out b.png --light 1,0,0 --light 0,1,0";
    let expected = "error: --light: expected one light on meshes, found 2";
    assert_eq!(refused(&folder, two), expected);
}

/// The background of a mesh, and the material that replaces its colours.
#[test]
fn background_and_material_of_a_mesh() {
    let folder = folder("background-of-a-mesh");
    let options = "--size 320x180 --aa 1";
    let render = |more: &str| drawn(&folder, &format!("render icosphere:4 {options} {more}"));
    let black = render("--background 000000");
    for (text, colour) in [("white", [0xFF; 3]), ("ff0000", [0xFF, 0, 0])] {
        let seen = render(&format!("--background {text}"));
        let both = black.chunks_exact(3).zip(seen.chunks_exact(3));
        for (before, after) in both {
            let expected = if before == [0; 3] { &colour } else { before };
            assert_eq!(after, expected, "{text}");
        }
    }
    // The sky is blue above and grey below.
    let sky = render("--background sky --camera 3,30,90 --fov 90");
    let line = 3 * 640;
    let [top, bottom] = [&sky[..line], &sky[sky.len() - line..]];
    assert!(top.chunks_exact(3).all(|pixel| pixel[2] > pixel[0] + 40));
    assert!(bottom.chunks_exact(3).all(|pixel| pixel[2] < pixel[0] + 40));
    // Without the option each triangle is grey. With the option it has the material's ratio of red,
    // green and blue.
    let gold = render("--material gold --background 000000");
    let mut lit = gold.chunks_exact(3).filter(|pixel| pixel[0] > 100);
    assert!(lit.clone().count() > 5_000);
    assert!(lit.all(|pixel| pixel[0] > pixel[1] && pixel[1] > pixel[2]));
    let object = |object: &str| {
        let options = format!("{options} --background 000000 --material gold");
        drawn(&folder, &format!("render --object '{object}' {options}"))
    };
    assert!(object("icosphere:4") == gold);
    // An object's own colour does not change.
    let blue = object("icosphere:4 colour 0000ff");
    assert!(blue.chunks_exact(3).all(|pixel| pixel[..2] == [0; 2]));
    all_refused(
        &folder,
        "
        render cube --out d.png --material normal
            --material: expected a material of one colour on meshes, found normal
        render cube --out d.png --material gold --wireframe over
            --material: expected a mesh with faces, found --wireframe
        render cube --out d.png --background green
            --background: expected white, sky, gradient or a colour RRGGBB, found 'green'
        ",
    );
}

/// A pixel with four samples is the average of four pixels of a picture of twice the size, within a step of RGB565.
#[test]
fn pictures_with_four_samples_a_pixel() {
    let folder = folder("samples");
    let draw = |more: &str| drawn(&folder, &format!("render gear --camera 2,30,60 {more}"));
    let large = draw("--size 640x360 --aa 1");
    let small = draw("--size 320x180 --aa 4");
    assert_eq!(large.len(), 4 * small.len());
    for (at, &found) in small.iter().enumerate() {
        let (pixel, channel) = (at / 3, at % 3);
        let (x, y) = (pixel % 320, pixel / 320);
        let of = |dx, dy| f64::from(large[3 * ((2 * y + dy) * 640 + 2 * x + dx) + channel]);
        let average = (of(0, 0) + of(1, 0) + of(0, 1) + of(1, 1)) / 4.0;
        assert!((f64::from(found) - average).abs() < 9.0);
    }
    // Of a picture 1280 pixels wide, a quarter is drawn at a time.
    let scene = "render --scene cubes --size 1280x720 --aa 4";
    assert_eq!(drawn(&folder, scene).len(), 3 * 1280 * 720);
    all_refused(
        &folder,
        "
        render gear --aa 4 --depth x.f32 --out x.png
            --depth: expected a picture with --aa 1, found --aa 4
        ",
    );
}

/// Frames that no board can draw are bad input.
#[test]
fn frames_beyond_the_limits() {
    let folder = folder("limits");
    for board in ["model", "emulated"] {
        let objects = "--object cube ".repeat(17);
        all_refused(
            &folder,
            &format!(
                "
                render {objects} --board {board} --out x.png
                    --object: expected at most 16 objects, found 17
                render cube {objects} --board {board} --out x.png
                    --object: expected at most 16 objects, found 18
                "
            ),
        );
    }
    let objects = "\"cube\", ".repeat(1000);
    let text = format!("title = \"A\"\nobject = [{objects}]\n");
    std::fs::write(folder.join("a.toml"), text).unwrap();
    for command in [
        "scene check a.toml",
        "render --scene a.toml --out x.png",
        "image make --scene a.toml --firmware a --out x.bin",
    ] {
        let error = failed(&folder, command, 2);
        if !command.starts_with("image") {
            let first =
                "error: a.toml: line 2: object = `cube`: object: expected at most 16 objects";
            assert!(error.starts_with(first), "{error}");
            let last = "error: a.toml: 964 further errors\n";
            assert!(error.ends_with(last), "{error}");
        }
    }
    for options in ["--far 0.05", "--field box:1,1,1 --camera 2,0,60 --far 0.01"] {
        failed(&folder, &format!("render cube {options} --out x.png"), 2);
    }
}

#[test]
fn a_command_with_nothing_to_draw_says_what_it_draws() {
    let folder = folder("nothing");
    let error = refused(&folder, "render --out x.png");
    assert_eq!(
        error,
        "error: MODEL: expected a mesh file or a generator such as teapot, or --field, --object or --scene in its place, found none"
    );
}
