//! `glint render` of meshes by the model.

use crate::common::{VIEW, depths, folder, json, picture, refused, succeed};

#[test]
fn renders_and_their_files() {
    let folder = folder("renders");
    let render = |out: &str, more: &[&str]| -> Vec<u8> {
        let arguments = ["render", "teapot", "--out", out]
            .iter()
            .chain(more)
            .copied()
            .collect::<Vec<_>>();
        succeed(&folder, &arguments);
        picture(&folder.join(out))
    };
    let options = [
        "--camera", "2,-90,90", "--depth", "a.f32", "--stats", "a.json", "--json",
    ];
    let picture = render("a.png", &options);
    assert_eq!(picture.len(), 320 * 180 * 3);

    std::fs::write(folder.join("view.json"), VIEW).unwrap();
    assert_eq!(picture, render("b.png", &["--view", "view.json"]));
    assert_ne!(picture, render("c.png", &["--camera", "2,-80,90"]));
    assert_ne!(
        picture,
        render("s.png", &["--view", "view.json", "--shading", "smooth"])
    );
    assert_eq!(picture, render("l.png", &["--look-at", "0,-2,0,0,5,0"]));
    assert_eq!(picture, render("k.png", &["--look", "0,-2,0,0,0"]));
    let view = ["--view", "view.json"];
    assert_eq!(
        picture,
        render("f.png", &[&view[..], &["--far", "100"]].concat())
    );
    assert_ne!(
        picture,
        render("n.png", &[&view[..], &["--far", "1.8"]].concat())
    );
    assert_ne!(
        picture,
        render("w.png", &[&view[..], &["--fov", "150"]].concat())
    );
    let orthographic = ["--orthographic", "1.8", "--depth", "orthographic.f32"];
    assert_ne!(
        picture,
        render("p.png", &[&view[..], &orthographic].concat())
    );
    let object = [
        "--object",
        "cube scale 0.2 rotate x 30 move 0,-0.6,0 colour ff0000",
    ];
    assert_ne!(picture, render("o.png", &[&view[..], &object].concat()));
    assert_eq!(
        render("d.png", &["--size", "1280x720"]).len(),
        1280 * 720 * 3
    );

    let stats = json(&folder.join("a.json"));
    let number = |key: &str| stats[key].as_u64().unwrap();
    assert_eq!(
        number("triangles_in"),
        number("triangles_culled") + number("triangles_drawn")
    );
    assert!(number("pixels_tested") >= number("pixels_covered"));
    assert!(stats["cycles"].is_null() && stats["clock"].is_null());

    // The teapot lies between 1.5 and 2.5 from the eye along n.
    let parallel = depths(&folder.join("orthographic.f32"));
    let covered = parallel.iter().filter(|z| z.is_finite());
    assert!(covered.clone().count() > 5_000 && covered.clone().all(|z| (1.4..2.6).contains(z)));
    let depth = depths(&folder.join("a.f32"));
    assert_eq!(depth.len(), 320 * 180);
    for (z, pixel) in depth.iter().zip(picture.chunks_exact(3)) {
        // The teapot lies between 1.5 and 2.5 from the eye along n.
        assert!(
            *z == f32::INFINITY && pixel == [0; 3] || (1.4..2.6).contains(z),
            "{z} {pixel:?}"
        );
    }
    assert!(depth.iter().any(|z| z.is_finite()));
}

/// Light on a mesh: at the camera or from a direction, with a colour, and ambient light.
#[test]
fn light_on_a_mesh() {
    let folder = folder("light-on-a-mesh");
    let render = |more: &[&str]| {
        let arguments = [&["render", "icosphere:4", "--out", "a.png"], more].concat();
        succeed(&folder, &arguments);
        picture(&folder.join("a.png"))
    };
    let lit = |picture: &[u8], channel: usize| {
        let channels = picture.iter().skip(channel).step_by(3);
        channels.filter(|&&value| value > 0).count()
    };
    let default = render(&[]);
    let stated = ["--light", "camera", "--ambient", "000000"];
    assert_eq!(render(&stated), default);
    // The light comes from above, so that the lower half is dark: without ambient light it is black.
    let above = render(&["--light", "0,0,1,ff0000", "--ambient", "000000"]);
    let bright = lit(&default, 0);
    assert!((bright / 4..bright * 9 / 10).contains(&lit(&above, 0)));
    assert_eq!([lit(&above, 1), lit(&above, 2)], [0; 2]);
    // The default ambient light is grey.
    let grey = render(&["--light", "0,0,1,ff0000"]);
    assert!(
        [0, 1, 2]
            .iter()
            .all(|&channel| lit(&grey, channel) >= bright)
    );
    assert_ne!(render(&["--ambient", "0000ff"]), default);
    let two = [
        "render", "cube", "--out", "b.png", "--light", "1,0,0", "--light", "0,1,0",
    ];
    assert_eq!(
        refused(&folder, &two),
        "error: --light: expected one light on meshes, found 2"
    );
}

/// The background of a mesh, and its material in place of its colours.
#[test]
fn background_and_material_of_a_mesh() {
    let folder = folder("background-of-a-mesh");
    let render = |more: &[&str]| {
        let arguments = [&["render", "icosphere:4", "--out", "a.png"], more].concat();
        succeed(&folder, &arguments);
        picture(&folder.join("a.png"))
    };
    let black = render(&[]);
    for (text, colour) in [
        ("white", [0xFF; 3]),
        ("ff0000", [0xFF, 0, 0]),
        // The sky at its horizon, in RGB565.
        ("sky", [214, 227, 239]),
    ] {
        let seen = render(&["--background", text]);
        let both = black.chunks_exact(3).zip(seen.chunks_exact(3));
        for (before, after) in both {
            let expected = if before == [0; 3] { &colour } else { before };
            assert_eq!(after, expected, "{text}");
        }
    }
    // Each triangle is grey before, and has the material's mixture of red, green and blue after.
    let gold = render(&["--material", "gold"]);
    let lit = gold.chunks_exact(3).filter(|pixel| pixel[0] > 100);
    assert!(lit.clone().count() > 5_000);
    assert!(
        lit.clone()
            .all(|pixel| pixel[0] > pixel[1] && pixel[1] > pixel[2])
    );
    let object = ["--object", "icosphere:4", "--material", "gold"];
    succeed(
        &folder,
        &[&["render", "--out", "b.png"], &object[..]].concat(),
    );
    assert!(picture(&folder.join("b.png")) == gold);
    // An object's own colour stays.
    let blue = [
        "--object",
        "icosphere:4 colour 0000ff",
        "--material",
        "gold",
    ];
    succeed(
        &folder,
        &[&["render", "--out", "c.png"], &blue[..]].concat(),
    );
    let blue = picture(&folder.join("c.png"));
    assert!(blue.chunks_exact(3).all(|pixel| pixel[..2] == [0; 2]));
    let cube = ["render", "cube", "--out", "d.png"];
    for (more, expected) in [
        (
            &["--material", "normal"][..],
            "error: --material: expected a material of one colour on meshes, found normal",
        ),
        (
            &["--material", "gold", "--wireframe", "over"],
            "error: --material: expected a mesh with faces, found --wireframe",
        ),
        (
            &["--background", "green"],
            "error: --background: expected white, sky or a colour RRGGBB, found 'green'",
        ),
    ] {
        assert_eq!(refused(&folder, &[&cube, more].concat()), expected);
    }
}

/// A supersampled picture is the mean of one of twice the size, and has colours between those of the mesh.
#[test]
fn supersampled_pictures() {
    let folder = folder("supersampled");
    let render = ["render", "gear", "--camera", "2,30,60"];
    let draw = |more: &[&str]| succeed(&folder, &[&render[..], more].concat());
    draw(&["--out", "large.png", "--size", "640x360"]);
    draw(&["--out", "small.png", "--supersample", "2"]);
    let [large, small] = ["large.png", "small.png"].map(|name| picture(&folder.join(name)));
    assert_eq!(large.len(), 4 * small.len());
    for (at, &found) in small.iter().enumerate() {
        let (pixel, channel) = (at / 3, at % 3);
        let (x, y) = (pixel % 320, pixel / 320);
        let of = |dx, dy| u32::from(large[3 * ((2 * y + dy) * 640 + 2 * x + dx) + channel]);
        let sum = of(0, 0) + of(1, 0) + of(0, 1) + of(1, 1);
        assert_eq!(u32::from(found), (sum + 2) / 4);
    }
    // A scene too, by a factor of four.
    let scene = ["render", "--scene", "cubes", "--size", "320x180"];
    succeed(
        &folder,
        &[&scene[..], &["--supersample", "4", "--out", "cubes.png"]].concat(),
    );
    assert_eq!(picture(&folder.join("cubes.png")).len(), 3 * 320 * 180);
    let large = ["--supersample", "4", "--size", "640x360", "--out", "x.png"];
    let error = refused(&folder, &[&render[..], &large].concat());
    assert_eq!(
        error,
        "error: --supersample: expected 2 for 320x180 or 640x360, or 4 for 320x180, found 4 for 640x360"
    );
    let board = [
        "--supersample",
        "2",
        "--board",
        "emulated",
        "--out",
        "x.png",
    ];
    let error = refused(&folder, &[&render[..], &board].concat());
    assert!(error.ends_with("expected --board model, found --board emulated"));
}

#[test]
fn a_command_with_nothing_to_draw_says_what_it_draws() {
    let folder = folder("nothing");
    let error = refused(&folder, &["render", "--out", "x.png"]);
    assert_eq!(
        error,
        "error: MODEL: expected a mesh file or a generator such as teapot, or --field, --object or --scene in its place, found none"
    );
}
