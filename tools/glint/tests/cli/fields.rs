//! `glint render` of distance fields, alone and with a mesh, with the model.

use crate::common::{
    SQUARE, VIEW, assert_has, depths, drawn, folder, json, picture, refused, said, succeed,
};

#[test]
fn fields_and_their_files() {
    let folder = folder("fields");
    // The camera is at distance 20 from the box, which is too far for a mesh.
    let view = VIEW.replace("[0,-2,0]", "[0,-20,0]");
    let view = view.replace("0.9", "0.05").replace("0.1}", "0.5}");
    std::fs::write(folder.join("far.json"), view).unwrap();
    let render = |field: &str, more: &str| {
        let command = format!("render --field {field} --out a.png {more}");
        let said = succeed(&folder, &command);
        (picture(&folder.join("a.png")), said)
    };
    let seen = "--view far.json --size 320x180 --depth a.f32 --stats a.json";
    let (one, said) = render("box:0.5,0.5,0.25", seen);
    assert!(said.starts_with("rays       57600 cast, "), "{said}");
    let stats = json(&folder.join("a.json"));
    let number = |key: &str| stats[key].as_u64().unwrap();
    assert_eq!(number("rays"), 320 * 180);
    let outcomes = number("hits") + number("misses") + number("undecided");
    assert_eq!(number("rays"), outcomes);
    let mean = number("evaluations") as f64 / number("rays") as f64;
    assert_eq!(stats["evaluations_per_ray"], mean);
    assert!(stats["cycles"].is_null() && stats.get("triangles_in").is_none());

    // The picture shows the box's front face, in the colour of the face's normal, on a white
    // background.
    let depth = depths(&folder.join("a.f32"));
    for (z, pixel) in depth.iter().zip(one.chunks_exact(3)) {
        let is_background = *z == f32::INFINITY && pixel == [0xff; 3];
        assert!(is_background || (z - 19.5).abs() < 0.05, "{z} {pixel:?}");
    }
    assert!(number("hits") > 0);
    let hits = depth.iter().filter(|z| z.is_finite()).count();
    assert_eq!(hits as u64, number("hits"));

    let eyes = "--view far.json --size 320x180 --aa 1 --stereo 0.05,18 --json";
    let (two, said) = render("box:0.5,0.5,0.25", eyes);
    assert_ne!(one, two);
    assert!(
        said.starts_with("{\"field\":\"box:0.5,0.5,0.25\","),
        "{said}"
    );
    assert_has(&said, "\"rays\":115200,");
    // More than four lights are an error.
    let lights = " --light 0,0,1".repeat(5);
    let error = refused(
        &folder,
        &format!("render --field menger:1 --out b.png{lights}"),
    );
    assert_eq!(error, "error: --light: expected at most 4 lights, found 5");
    // One blue light from above and no ambient light: the box's top is blue, its other sides are black, and the background is
    // white.
    let blue = "--material ivory --light 0,0,1,0000ff --ambient 000000 --no-dither --aa 1";
    let (lit, _) = render("box:1,1,1", blue);
    let mut colours: Vec<&[u8]> = lit.chunks_exact(3).collect();
    colours.sort_unstable();
    colours.dedup();
    assert_eq!(colours, [&[0, 0, 0], &[0, 0, 222], &[255; 3]]);
    let (plain, _) = render("menger:2", "");
    for more in "material clay,background sky,fog 0.2,occlusion".split(',') {
        let (with, _) = render("menger:2", &format!("--{more}"));
        assert_ne!(with, plain, "{more}");
    }
    // The default camera shows the whole sponge: the first pixel of the picture is background. A camera at distance 3 gives a
    // different picture.
    let (sponge, _) = render("menger:3", "");
    assert_eq!(sponge[..3], [0xff; 3]);
    assert_ne!(sponge, render("menger:3", "--camera 3,30,60").0);
}

/// Draws a mesh, a sphere of radius 1, in a field, a box: the sphere protrudes from the box's
/// faces, and the box's corners protrude from the sphere.
#[test]
fn a_mesh_in_a_field() {
    let folder = folder("mesh-in-field");
    let render = |what: &str| {
        let files = "--out a.png --depth a.f32 --stats a.json";
        let said = succeed(&folder, &format!("render {what} --camera 4,30,60 {files}"));
        let pixels = picture(&folder.join("a.png"));
        let [depth, stats] = ["a.f32", "a.json"].map(|name| folder.join(name));
        (pixels, depths(&depth), json(&stats), said)
    };
    let box_ = "--field box:0.75,0.75,0.75 --background sky";
    let (mesh, mesh_depth, mesh_stats, _) = render("icosphere:6");
    let (field, field_depth, field_stats, _) = render(box_);
    let (both, depth, stats, said) = render(&format!("icosphere:6 {box_}"));
    let mut seen = [0, 0];
    for (i, pixel) in both.chunks_exact(3).enumerate() {
        let (a, b) = (mesh_depth[i], field_depth[i]);
        // The depth codes of the mesh and of the field, each drawn alone, have different scales, so similar distances count as
        // equal.
        if (a - b).abs() < 1e-3 {
            continue;
        }
        let nearer = if a < b { &mesh } else { &field };
        assert_eq!(pixel, &nearer[3 * i..3 * i + 3], "pixel {i}");
        let is_near = (depth[i] - a.min(b)).abs() < 1e-3;
        assert!(is_near || depth[i] == a.min(b), "pixel {i}");
        seen[usize::from(b < a)] += 1;
    }
    assert!(seen.iter().all(|&pixels| pixels > 1000), "{seen:?}");
    for key in "triangles_in triangles_drawn pixels_tested pixels_covered".split(' ') {
        assert_eq!(stats[key], mesh_stats[key], "{key}");
    }
    for key in ["rays", "hits", "evaluations", "evaluations_per_ray"] {
        assert_eq!(stats[key], field_stats[key], "{key}");
    }
    assert!(stats.get("pixels_drawn").is_none());
    let starts = ["triangles  ", "pixels     ", "rays       ", "field      "];
    let mut lines = said.lines().zip(starts);
    assert!(lines.all(|(line, start)| line.starts_with(start)), "{said}");
}

#[test]
fn warnings_of_pictures_that_show_nothing() {
    let folder = folder("shows_nothing");
    std::fs::write(folder.join("square.obj"), SQUARE).unwrap();
    let inside = "is inside the field, and sees one surface in all directions: move it with --camera or --look-at, or choose another --field\n";
    let culled = "warning: no triangle is drawn: all face away, or lie outside of the picture; --no-cull draws back faces, --look-at moves the camera\n";
    let outside = "warning: no triangle is drawn: all lie outside of the picture; --look-at moves the camera\n";
    let backs = "warning: most surfaces in view are back faces, which are not drawn: --no-cull draws them; if the mesh is inside out, glint convert --fix-winding reverses its faces\n";
    succeed(&folder, "model cube cube.obj");
    let cube = std::fs::read_to_string(folder.join("cube.obj")).unwrap();
    let inside_out = cube.lines().map(|line| match line.strip_prefix("f ") {
        Some(corners) => {
            let corners: Vec<_> = corners.split(' ').rev().collect();
            format!("f {}\n", corners.join(" "))
        }
        None => format!("{line}\n"),
    });
    std::fs::write(folder.join("room.obj"), inside_out.collect::<String>()).unwrap();
    // A square, and a small triangle above it, whose back is visible from above.
    let two = format!("{SQUARE}v 0 0 .1\nv .2 0 .1\nv .2 .2 .1\nf 7 6 5\n");
    std::fs::write(folder.join("two.obj"), two).unwrap();
    for (arguments, expected) in [
        ("--field planes:1", inside),
        ("--field planes:2.5", ""),
        ("cube --field planes:1", inside),
        ("--field menger:3 --look-at 1,1,1,-1,-1,-1", ""),
        ("--field box:1,1,1 --look-at 0,0,0,1,0,0", inside),
        ("square.obj --camera 2,30,120", culled),
        ("square.obj --camera 2,30,120 --no-cull", ""),
        ("square.obj --no-cull --look-at 3,0,0,1,0,0", outside),
        ("cube.obj --up y", ""),
        ("room.obj --up y", backs),
        ("room.obj --up y --no-cull", ""),
        ("--object 'room.obj scale 0.5' --camera 2,30,60", backs),
        ("two.obj --camera 2,30,60", ""),
        ("two.obj --camera 2,30,120", backs),
    ] {
        let [_, error] = said(
            &folder,
            &format!("render --size 320x180 --force --out a.png {arguments}"),
        );
        assert_eq!(error.lines().count(), expected.lines().count(), "{error}");
        assert!(error.ends_with(expected), "{arguments}: {error}");
    }
}

/// Rays that reach the step limit have the colour of the horizon, like sky and fog in the distance.
/// The statistics count these rays, and an option draws them in magenta.
#[test]
fn undecided_rays_have_the_colour_of_the_horizon() {
    let folder = folder("undecided");
    let render = |more: &str| {
        let field = "render --field smooth:0.01,box:8,8,0.01+sphere:0.01 --look-at=-7.5,0,0.0225,1,0,0 --background 000000 --size 320x180 --aa 1 --stats a.json";
        let picture = drawn(&folder, &format!("{field} {more}"));
        let undecided = json(&folder.join("a.json"))["undecided"].as_u64().unwrap();
        (picture, undecided as usize)
    };
    for more in ["", "--fog 0.2"] {
        let (plain, undecided) = render(more);
        assert!(undecided > 0);
        let (marked, counted) = render(&format!("{more} --undecided"));
        assert_eq!(counted, undecided);
        let mut marks = 0;
        for (plain, marked) in plain.chunks_exact(3).zip(marked.chunks_exact(3)) {
            assert_ne!(plain, [0xff, 0, 0xff]);
            if marked == [0xff, 0, 0xff] {
                assert_eq!(plain, [0; 3]);
                marks += 1;
            } else {
                assert_eq!(plain, marked);
            }
        }
        assert_eq!(marks, undecided);
    }
}
