//! The program from outside: exit codes, messages, files.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A folder of this test's own.
fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR"))
        .join("cli")
        .join(name);
    if path.exists() {
        std::fs::remove_dir_all(&path).unwrap();
    }
    std::fs::create_dir_all(&path).unwrap();
    path
}

/// Runs the program with a quarter of a gigabyte of address space: unbounded memory would show.
fn glint(folder: &Path, arguments: &[&str]) -> Output {
    Command::new("sh")
        .args([
            "-c",
            "ulimit -v 262144; exec \"$0\" \"$@\"",
            env!("CARGO_BIN_EXE_glint"),
        ])
        .args(arguments)
        .current_dir(folder)
        .output()
        .unwrap()
}

fn succeed(folder: &Path, arguments: &[&str]) -> String {
    let output = glint(folder, arguments);
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {error}");
    String::from_utf8(output.stdout).unwrap()
}

/// The one line of a refusal.
fn refused(folder: &Path, arguments: &[&str]) -> String {
    let output = glint(folder, arguments);
    let error = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {error}");
    assert_eq!(error.lines().count(), 1, "{arguments:?}: {error}");
    assert!(output.stdout.is_empty(), "{arguments:?}");
    assert!(
        error.contains("expected ") && error.contains("found "),
        "{arguments:?}: {error}"
    );
    error.trim_end().to_owned()
}

const VIEW: &str =
    r#"{"eye":[0,-2,0],"u":[1,0,0],"v":[0,0,-1],"n":[0,1,0],"half_width":0.9,"near":0.1}"#;

/// The pixels of a picture of 16 to 9, three bytes each.
fn picture(path: &Path) -> Vec<u8> {
    let decoder = png::Decoder::new(std::io::BufReader::new(std::fs::File::open(path).unwrap()));
    let mut reader = decoder.read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    assert_eq!(
        (info.width * 9, info.color_type),
        (info.height * 16, png::ColorType::Rgb)
    );
    pixels
}

fn depths(path: &Path) -> Vec<f32> {
    let number = |bytes: &[u8]| f32::from_le_bytes(bytes.try_into().unwrap());
    let bytes = std::fs::read(path).unwrap();
    bytes.chunks_exact(4).map(number).collect()
}

fn json(path: &Path) -> serde_json::Value {
    serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap()
}

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";

#[test]
fn bad_meshes() {
    let folder = folder("bad_meshes");
    let stl_of_2_31_faces = [&[0; 80][..], &(1_u32 << 31).to_le_bytes(), &[0; 50]].concat();
    let ply = |faces: &str, body: &str| {
        format!(
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face {faces}\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n{body}"
        )
        .into_bytes()
    };
    let million = "1 ".repeat(500_000);
    let cases: Vec<(&str, Vec<u8>, &str)> = vec![
        (
            "empty.obj",
            vec![],
            "expected at least one face, found none",
        ),
        ("empty.stl", vec![], "expected an STL"),
        ("empty.ply", vec![], "line 1: expected ply"),
        (
            "empty.glm",
            vec![],
            "byte 0: expected at least 32 bytes of header, found 0",
        ),
        (
            "nan.obj",
            SQUARE.replace("1 0 0", "1 NaN 0").into(),
            "line 2: expected a number within ±1e15, found 'NaN'",
        ),
        (
            "huge.obj",
            SQUARE.replace("1 0 0", "1 1e300 0").into(),
            "line 2: expected a number within ±1e15, found '1e300'",
        ),
        (
            "zero.obj",
            SQUARE.replace("f 1", "f 0").into(),
            "line 5: expected a vertex index",
        ),
        (
            "range.obj",
            SQUARE.replace("f 1", "f 5").into(),
            "line 5: expected a point of the 4 in the file, found one with index 4",
        ),
        (
            "negative.obj",
            SQUARE.replace("f 1", "f -5").into(),
            "line 5: expected a vertex index",
        ),
        (
            "faces.obj",
            SQUARE.replace("f 1", "f 2147483648").into(),
            "line 5: expected a point",
        ),
        (
            "line.obj",
            format!("{SQUARE}f {million}\n").into(),
            "line 6: expected a line of at most 65536 bytes",
        ),
        (
            "polygon.obj",
            format!("{SQUARE}f {}\n", &million[..20_000]).into(),
            "line 6: expected a face of 3 to 8192 corners, found 10000",
        ),
        (
            "binary.obj",
            (0..=255).collect(),
            "line 1: expected an OBJ statement",
        ),
        (
            "point.obj",
            b"v 1 1 1\nf 1 1 1\n".to_vec(),
            "expected a mesh with an extent, found one of 0e0",
        ),
        (
            "flat.obj",
            b"v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n".to_vec(),
            "expected a triangle with an area",
        ),
        (
            "faces.stl",
            stl_of_2_31_faces,
            "expected a binary STL of 2147483648 triangles",
        ),
        (
            "cut.stl",
            b"solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0".to_vec(),
            "line 4: expected three numbers of a vertex, found 2",
        ),
        (
            "line.stl",
            format!("solid {million}").into(),
            "line 1: expected a line of at most 65536 bytes",
        ),
        (
            "faces.ply",
            ply("2147483648", "3 0 1 2\n"),
            "line 13: expected as many elements as the header declares, found the end of the file",
        ),
        (
            "count.ply",
            ply("-1", "3 0 1 2\n"),
            "line 7: expected a count of elements up to 2^32 - 1",
        ),
        (
            "range.ply",
            ply("1", "3 0 1 3\n"),
            "line 13: expected a point of the 3 in the file, found one with index 3",
        ),
        (
            "nothing.ply",
            b"ply\nformat binary_little_endian 1.0\nelement a 4000000000\nend_header\n".to_vec(),
            "expected at least one face",
        ),
        (
            "magic.glm",
            [0; 64].to_vec(),
            "byte 0: expected \"GLM1\", found '\\x00\\x00\\x00\\x00'",
        ),
    ];
    for (name, contents, message) in cases {
        std::fs::write(folder.join(name), contents).unwrap();
        for arguments in [
            &["convert", name, "out.glm"][..],
            &["render", name, "--out", "out.png"],
        ] {
            let error = refused(&folder, arguments);
            assert!(
                error.starts_with(&format!("error: {name}: {message}")),
                "{error}"
            );
        }
    }
    assert!(!folder.join("out.glm").exists() && !folder.join("out.png").exists());
}

#[test]
fn bad_names_and_numbers() {
    let folder = folder("bad_names");
    std::fs::write(folder.join("square.obj"), SQUARE.replace("v 1", "v 9")).unwrap();
    std::fs::write(folder.join("view.json"), "{}").unwrap();
    let far = VIEW.replace("[0,-2,0]", "[0,-9,0]");
    std::fs::write(folder.join("far.json"), far).unwrap();
    let cases: &[(&[&str], &str)] = &[
        (
            &["convert", "gone.obj", "out.glm"],
            "error: gone.obj: expected a file to read, found ",
        ),
        (
            &["convert", ".", "out.glm"],
            "error: .: expected a name that ends in .obj, .stl, .ply or .glm, found no extension",
        ),
        (
            &["convert", "square.obj", "out.xyz"],
            "error: out.xyz: expected a name that ends in .obj, .stl, .ply or .glm, found '.xyz'",
        ),
        (
            &["convert", "square.obj", "out.glm", "--keep-scale"],
            "error: square.obj: expected coordinates in [-2, 2 - 2^-14]",
        ),
        (
            &["model", "sponge:5", "out.glm"],
            "error: sponge:5: expected a model cube, icosphere:N (frequency, 1 to 64), torus-knot, gear, teapot or sponge:N (0 to 4), found 'sponge:5'",
        ),
        (
            &["render", "icosphere:x", "--out", "out.png"],
            "error: icosphere:x: expected a model",
        ),
        (
            &["render", "cube", "--out", "out.png", "--camera", "1,2"],
            "error: --camera: expected a camera R,THETA,PHI",
        ),
        (
            &["render", "cube", "--out", "out.png", "--camera", "6,0,0"],
            "error: --camera: expected a camera, found radius 6",
        ),
        (
            &["render", "cube", "--out", "out.png", "--view", "view.json"],
            "error: view.json: expected {\"eye\":[x,y,z]",
        ),
        (
            &["render", "cube", "--out", "out.png", "--view", "gone.json"],
            "error: gone.json: expected a file to read",
        ),
        (
            &["render", "cube", "--out", "out.png", "--view", "far.json"],
            "error: far.json: expected a camera, found eye (0, -9, 0): expected within 8 of the origin for a mesh",
        ),
        (
            &["render", "--field", "ball:1", "--out", "out.png"],
            "error: --field: expected a distance field, found no field is named ball: expected menger:DEPTH, box:X,Y,Z,",
        ),
        (
            &["render", "--field", "menger:9", "--out", "out.png"],
            "error: --field: expected a distance field, found depth: expected 1 to 6",
        ),
        (
            &[
                "render", "--field", "menger:4", "--stereo", "1", "--out", "out.png",
            ],
            "error: --stereo: expected two eyes, found 1: expected E,ZERO[,red-blue|red-cyan]",
        ),
        (
            &["render", "cube", "--stereo", "0.05,3", "--out", "out.png"],
            "error: --stereo: expected a --field alone, as a mesh is seen with one eye, found a mesh",
        ),
        (
            &[
                "render", "cube", "--field", "menger:2", "--stereo", "0.05,3", "--out", "out.png",
            ],
            "error: --stereo: expected a --field alone, as a mesh is seen with one eye, found a mesh",
        ),
        (
            &["render", "cube", "--out", "out.png", "--fog", "1"],
            "error: --fog: expected a --field, which alone has it, found a mesh",
        ),
        (
            &[
                "render", "--field", "menger:2", "--fog", "-1", "--out", "out.png",
            ],
            "error: --fog: expected a density of at least 0 and below 16, found '-1'",
        ),
        (
            &[
                "render",
                "--field",
                "menger:2",
                "--ambient",
                "fff",
                "--out",
                "out.png",
            ],
            "error: --ambient: expected a colour RRGGBB, found 'fff'",
        ),
        (
            &[
                "render", "--field", "menger:2", "--light", "0,0,0", "--out", "out.png",
            ],
            "error: --light: expected a light, found direction 0,0,0: expected one that is not 0",
        ),
        (
            &["render", "cube", "--out", "out.png", "--size", "320x200"],
            "error: --size: expected 320x180, 640x360 or 1280x720, found '320x200'",
        ),
    ];
    for (arguments, message) in cases {
        let error = refused(&folder, arguments);
        assert!(error.starts_with(message), "{error}");
    }
}

#[test]
fn failures_that_are_no_bad_input() {
    let folder = folder("failures");
    for (arguments, message) in [
        (
            &["upload", "cube", "--board", "/dev/no-such-port"][..],
            "error: /dev/no-such-port: expected a serial port, found: ",
        ),
        (
            &["model", "cube", "no-such-folder/cube.glm"],
            "error: no-such-folder/cube.glm: cannot be written: ",
        ),
        (
            &["render", "cube", "--out", "a.png", "--capture", "monitor"],
            "error: --capture monitor: only the virtual board",
        ),
    ] {
        let output = glint(&folder, arguments);
        let error = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "{error}");
        assert!(
            error.starts_with(message) && error.lines().count() == 1,
            "{error}"
        );
    }
}

#[test]
fn conversions_by_every_way_agree() {
    let folder = folder("conversions");
    // A model whose faces have no colours of their own, so that no format loses any.
    succeed(&folder, &["model", "icosphere:4", "straight.glm"]);
    for extension in ["obj", "ply"] {
        let between = format!("between.{extension}");
        succeed(&folder, &["model", "icosphere:4", &between]);
        succeed(&folder, &["convert", &between, "back.glm"]);
        let read = |name: &str| std::fs::read(folder.join(name)).unwrap();
        assert_eq!(read("straight.glm"), read("back.glm"), "{extension}");
    }
    // STL has neither shared points nor colours of points: each face has its own colour, and so its own vertices.
    succeed(
        &folder,
        &["convert", "straight.glm", "between.stl", "--keep-scale"],
    );
    let report = succeed(
        &folder,
        &[
            "convert",
            "between.stl",
            "back.glm",
            "--keep-scale",
            "--json",
        ],
    );
    let report: serde_json::Value = serde_json::from_str(&report).unwrap();
    assert_eq!(
        (&report["vertices"], &report["triangles"]),
        (&960.into(), &320.into())
    );
    assert_eq!(report["error_max"], 0.0);
}

#[test]
fn a_material_file_beside_the_mesh() {
    let folder = folder("materials");
    std::fs::write(
        folder.join("a.obj"),
        format!("mtllib sub/a.mtl\nusemtl red\n{SQUARE}"),
    )
    .unwrap();
    let text = succeed(&folder, &["convert", "a.obj", "a.glm"]);
    assert!(
        text.contains("note       no material file 'sub/a.mtl' beside the mesh"),
        "{text}"
    );
    std::fs::write(folder.join("a.mtl"), "newmtl red\nKd 1 0 0\n").unwrap();
    let text = succeed(&folder, &["convert", "a.obj", "a.glm"]);
    assert!(!text.contains("note"), "{text}");
    std::fs::write(folder.join("a.mtl"), "newmtl red\nKd 1 x 0\n").unwrap();
    let error = refused(&folder, &["convert", "a.obj", "b.glm"]);
    assert_eq!(
        error,
        "error: sub/a.mtl: line 2: expected a number within ±1e15, found 'x'"
    );
}

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

#[test]
fn fields_and_their_files() {
    let folder = folder("fields");
    // A box of half a unit, from 20 away: farther than a mesh allows.
    let view = VIEW.replace("[0,-2,0]", "[0,-20,0]");
    std::fs::write(
        folder.join("far.json"),
        view.replace("0.9", "0.05").replace("0.1}", "0.5}"),
    )
    .unwrap();
    let render = |field: &str, more: &[&str]| {
        let arguments = ["render", "--field", field, "--out", "a.png"]
            .iter()
            .chain(more)
            .copied()
            .collect::<Vec<_>>();
        let said = succeed(&folder, &arguments);
        (picture(&folder.join("a.png")), said)
    };
    let far = ["--view", "far.json"];
    let files = ["--depth", "a.f32", "--stats", "a.json"];
    let (one, said) = render("box:0.5,0.5,0.25", &[&far[..], &files[..]].concat());
    assert!(said.starts_with("rays       57600 cast, "), "{said}");
    let stats = json(&folder.join("a.json"));
    let number = |key: &str| stats[key].as_u64().unwrap();
    assert_eq!(number("rays"), 320 * 180);
    assert_eq!(
        number("rays"),
        number("hits") + number("misses") + number("undecided")
    );
    let mean = number("evaluations") as f64 / number("rays") as f64;
    assert_eq!(stats["evaluations_per_ray"], mean);
    assert!(stats["cycles"].is_null() && stats.get("triangles_in").is_none());

    // The face towards the camera, in the colour of its normal, in front of white.
    let depth = depths(&folder.join("a.f32"));
    for (z, pixel) in depth.iter().zip(one.chunks_exact(3)) {
        assert!(
            *z == f32::INFINITY && pixel == [0xff; 3] || (z - 19.5).abs() < 0.05,
            "{z} {pixel:?}"
        );
    }
    assert!(number("hits") > 0);
    assert_eq!(
        depth.iter().filter(|z| z.is_finite()).count() as u64,
        number("hits")
    );

    let (two, said) = render(
        "box:0.5,0.5,0.25",
        &[&far[..], &["--stereo", "0.05,18", "--json"]].concat(),
    );
    assert_ne!(one, two);
    assert!(
        said.starts_with("{\"field\":\"box:0.5,0.5,0.25\",") && said.contains("\"rays\":115200,"),
        "{said}"
    );
    // Five lights are one too many.
    let lights = ["--light", "0,0,1"].repeat(5);
    let arguments = [
        &["render", "--field", "menger:1", "--out", "b.png"],
        &lights[..],
    ]
    .concat();
    assert_eq!(
        refused(&folder, &arguments),
        "error: --light: expected at most 4 lights, found 5"
    );
    // Blue light from above, and nothing from anywhere else.
    let blue = [
        "--material",
        "ivory",
        "--light",
        "0,0,1,0000ff",
        "--ambient",
        "000000",
    ];
    let (lit, _) = render("box:1,1,1", &blue);
    let mut colours: Vec<&[u8]> = lit.chunks_exact(3).collect();
    colours.sort_unstable();
    colours.dedup();
    assert_eq!(colours, [&[0, 0, 0], &[0, 0, 231], &[255; 3]]);
    for more in [
        &["--material", "clay"][..],
        &["--background", "sky"],
        &["--fog", "0.2"],
        &["--occlusion"],
    ] {
        assert_ne!(
            render("menger:2", more).0,
            render("menger:2", &[]).0,
            "{more:?}"
        );
    }
    // The camera without a name sees the whole sponge.
    let (sponge, _) = render("menger:3", &[]);
    assert_eq!(sponge[..3], [0xff; 3]);
    assert_ne!(sponge, render("menger:3", &["--camera", "3,30,60"]).0);
}

/// A sphere of radius 1 looks out of the faces of a box, and the box's corners look out of the sphere.
#[test]
fn a_mesh_in_a_field() {
    let folder = folder("mesh-in-field");
    let render = |what: &[&str]| {
        let files = ["--out", "a.png", "--depth", "a.f32", "--stats", "a.json"];
        let camera = ["--camera", "4,30,60"];
        let arguments = [&["render"], what, &camera, &files].concat();
        let said = succeed(&folder, &arguments);
        let pixels = picture(&folder.join("a.png"));
        (
            pixels,
            depths(&folder.join("a.f32")),
            json(&folder.join("a.json")),
            said,
        )
    };
    let box_ = ["--field", "box:0.75,0.75,0.75", "--background", "sky"];
    let (mesh, mesh_depth, mesh_stats, _) = render(&["icosphere:6"]);
    let (field, field_depth, field_stats, _) = render(&box_);
    let (both, depth, stats, said) = render(&[&["icosphere:6"], &box_[..]].concat());
    let mut seen = [0, 0];
    for (i, pixel) in both.chunks_exact(3).enumerate() {
        let (a, b) = (mesh_depth[i], field_depth[i]);
        // Each has codes of its own alone.
        if (a - b).abs() < 1e-3 {
            continue;
        }
        let nearer = if a < b { &mesh } else { &field };
        assert_eq!(pixel, &nearer[3 * i..3 * i + 3], "pixel {i}");
        assert!(
            (depth[i] - a.min(b)).abs() < 1e-3 || depth[i] == a.min(b),
            "pixel {i}"
        );
        seen[usize::from(b < a)] += 1;
    }
    assert!(seen.iter().all(|&pixels| pixels > 1000), "{seen:?}");
    for key in [
        "triangles_in",
        "triangles_drawn",
        "pixels_tested",
        "pixels_covered",
    ] {
        assert_eq!(stats[key], mesh_stats[key], "{key}");
    }
    for key in ["rays", "hits", "evaluations", "evaluations_per_ray"] {
        assert_eq!(stats[key], field_stats[key], "{key}");
    }
    assert!(stats.get("pixels_drawn").is_none());
    let starts = ["triangles  ", "pixels     ", "rays       ", "field      "];
    assert!(
        said.lines()
            .zip(starts)
            .all(|(line, start)| line.starts_with(start)),
        "{said}"
    );
}

#[test]
fn logs_of_a_gyroscope() {
    let folder = folder("imu");
    // At rest for 0.1 s with noise and a bias, then 90 °/s about z for a second; the last 10 ms are lost.
    let mut log = String::from("gx,gy,gz,t_us,temp,ax,ay,az\n");
    for i in (0..=1090).chain([1100]) {
        let noise = i * 7 % 5 - 2;
        let turning = if i > 100 { 1476 } else { 0 };
        log += &format!(
            "{},{},{},{},-500,0,0,4096\n",
            20 + noise,
            -10 - noise,
            5 + turning,
            3_000_000 + i * 1000
        );
    }
    std::fs::write(folder.join("turn.csv"), &log).unwrap();
    let replay = |log: &str, more: &[&str]| -> Vec<String> {
        let arguments = [&["imu", "replay", log, "--out", "o.csv"], more].concat();
        let mut said = vec![succeed(&folder, &arguments)];
        let out = std::fs::read_to_string(folder.join("o.csv")).unwrap();
        said.extend(out.lines().map(str::to_owned));
        said
    };
    let numbers =
        |line: &str| -> Vec<f64> { line.split(',').map(|word| word.parse().unwrap()).collect() };
    let said = replay("turn.csv", &["--still", "0.1", "--json"]);
    assert_eq!(said[1], "t_us,w,x,y,z,yaw,pitch,roll");
    assert_eq!(said.len(), 2 + 1092);
    assert_eq!(
        said[2],
        "3000000,1.0000000000,0.0000000000,0.0000000000,0.0000000000,0.0000000,0.0000000,0.0000000"
    );
    let last = numbers(said.last().unwrap());
    assert_eq!(last[0], 4_100_000.0);
    // The first turning sample follows a still one: half of its step is missing, and what a cubic makes of the corner.
    assert!(
        (last[5] - 89.96).abs() < 0.02 && last[6].abs() < 0.1 && last[7].abs() < 0.1,
        "{last:?}"
    );
    let summary: serde_json::Value = serde_json::from_str(&said[0]).unwrap();
    assert_eq!(summary["steps"], 1091);
    assert_eq!(summary["calibration"]["samples"], 100);
    assert_eq!(
        summary["calibration"]["bias"],
        serde_json::json!([20.0, -10.0, 5.0])
    );
    let yaw = summary["end"]["yaw"].as_f64().unwrap();
    assert!((yaw - last[5]).abs() < 1e-6, "{yaw}");

    // Twice as long between samples, half as much a count: the same. And without the gap, which is a step now.
    let said = replay(
        "turn.csv",
        &["--dt-us", "2000", "--gyro-lsb", "32.8", "--no-tilt"],
    );
    assert!(
        said[0].starts_with("samples     1092 in 2.182 s: 1091 steps, 0 stale, "),
        "{}",
        said[0]
    );
    let turned = numbers(said.last().unwrap())[5];
    // The bias of 5 LSB counts here.
    let expected = (991.0 * 1481.0 + 100.5 * 5.0) * 0.002 / 32.8;
    assert!((turned - expected).abs() < 0.1, "{turned} {expected}");

    // On its side gravity says so, unless it is left out.
    let side = "t_us,ax,ay,az,gx,gy,gz\n0,0,4096,0,0,0,0\n1000,0,4096,0,0,0,0\n";
    std::fs::write(folder.join("side.csv"), side).unwrap();
    let angles = |more: &[&str]| numbers(replay("side.csv", more).last().unwrap())[5..].to_vec();
    assert_eq!(angles(&[]), [0.0, 0.0, 90.0]);
    assert_eq!(angles(&["--no-tilt"]), [0.0, 0.0, 0.0]);

    std::fs::write(
        folder.join("bad.csv"),
        side.replace("1000,0,4096", "1000,0,4096.5"),
    )
    .unwrap();
    for (arguments, message) in [
        (
            &["bad.csv"][..],
            "bad.csv: line 3, column ay: expected a whole number from -32768 to 32767, found '4096.5'",
        ),
        (
            &["none.csv"],
            "none.csv: expected a file to read, found No such file or directory (os error 2)",
        ),
        (
            &["side.csv", "--still", "1"],
            "side.csv: expected at least 64 samples in the first 1 s, found 2",
        ),
        (
            &["turn.csv", "--still", "0.5"],
            "turn.csv: line 103: expected a sensor at rest in the first 0.5 s, found gyroscope z of sample 101 is 1476 LSB from the first: expected at most 33, keep it still",
        ),
        (
            &["side.csv", "--gyro-lsb", "0"],
            "--gyro-lsb: expected a number of LSB per °/s from 8 to 4096, found '0'",
        ),
        (
            &["side.csv", "--accel-lsb", "2g"],
            "--accel-lsb: expected a whole number of LSB per g from 1024 to 32767, found '2g'",
        ),
        (
            &["side.csv", "--still", "-1"],
            "--still: expected a number of seconds up to 86400, found '-1'",
        ),
    ] {
        let all = [&["imu", "replay", "--out", "x.csv"], arguments].concat();
        assert_eq!(refused(&folder, &all), format!("error: {message}"));
        assert!(!folder.join("x.csv").exists());
    }
}
