//! Tests that the built-in scenes are valid, that errors of rejected files name the location, and that the requirements follow
//! from the keys.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use glint_core::block::Block;
use glint_core::console::{Command, FORMS, Row};
use glint_core::feature::FIT;
use glint_core::field::FRACTION;
use glint_core::light::Material;
use glint_core::picture::{Samples, Size};
use glint_core::quality::{Preset, Quality, Threshold};
use glint_scene::lines;
use glint_scene_file::{NAMES, Needs, SceneFile, Steer, built_in, keys};

fn parse(text: &str) -> Result<SceneFile, String> {
    SceneFile::parse("a", "a.toml", text).map_err(|error| error.to_string())
}

/// The scene of a text that is preceded by a title and a camera.
fn with_camera(text: &str) -> SceneFile {
    parse(&format!("title = \"a\"\ncamera = \"3 30 60\"\n{text}")).unwrap()
}

/// The rows of a table: the lines of a scene file, separated by `;`, and after `→` the expected
/// result.
fn rows(table: &str) -> impl Iterator<Item = (String, &str)> {
    let rows = table.lines().filter_map(|row| row.split_once('→'));
    rows.map(|(lines, result)| (lines.trim().replace("; ", "\n"), result.trim()))
}

fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
}

#[test]
fn the_files_of_the_folder_are_built_in() {
    let files = fs::read_dir(root().join("scenes")).unwrap();
    let names = files.map(|file| {
        let path = file.unwrap().path();
        assert_eq!(path.extension().unwrap(), "toml", "{path:?}");
        let name = path.file_stem().unwrap().to_str().unwrap().to_owned();
        let text = fs::read_to_string(&path).unwrap();
        let scene = SceneFile::parse(&name, &path.display().to_string(), &text).unwrap();
        assert!(scene.lines().count() > 0, "{name}");
        // A board reads the lines in the same way.
        let text: String = scene.lines().map(|line| format!("{line}\n")).collect();
        let read: Result<Vec<_>, _> = lines(&text).collect();
        let read = read.unwrap_or_else(|error| panic!("{name}: {error}"));
        let numbers = read.into_iter().map(|(line, _)| line);
        assert!(numbers.eq(1..=scene.lines().count()));
        assert!(built_in(&name).is_some(), "{name}");
        name
    });
    let names: BTreeSet<String> = names.collect();
    assert_eq!(names, NAMES.map(str::to_owned).into());
}

#[test]
fn every_key_is_documented() {
    let page = fs::read_to_string(root().join("docs/scenes.md")).unwrap();
    for key in keys() {
        let is_documented = page.contains(&format!("`{key}`"));
        assert!(is_documented, "docs/scenes.md has no key `{key}`");
    }
}

#[test]
fn the_page_has_what_each_quality_sets() {
    let page = fs::read_to_string(root().join("docs/scenes.md")).unwrap();
    for quality in Quality::ALL {
        let Preset {
            size,
            samples,
            threshold,
        } = quality.preset();
        let samples = samples.map_or("default", Samples::name);
        let Threshold { base, footprint } = threshold;
        let (width, height) = (size.width(), size.height());
        let threshold = format!("{base}·2^-{FRACTION} + z/2^{footprint}");
        let row = format!("| `{quality}` | {width}×{height} | {samples} | {threshold} |\n");
        assert!(page.contains(&row), "docs/scenes.md has no row {row}");
    }
}

#[test]
fn the_scene_of_the_page_is_valid() {
    let page = fs::read_to_string(root().join("docs/scenes.md")).unwrap();
    let (_, rest) = page.split_once("```toml\n").unwrap();
    let (text, _) = rest.split_once("```").unwrap();
    let scene = parse(text).unwrap();
    let needs = scene.needs().options().join(" ");
    assert_eq!(
        needs,
        "--blocks scanout raymarch i2c --no-depths --fields box,spheres --lanes 2"
    );
}

#[test]
fn keys_are_console_commands() {
    let scene = with_camera(
        "model = \"torus\"\nfield = \"box:1,1,1\"\nsize = \"640  360\"\nfog = 0.25\nocclusion = true\n\
         light = [\"camera\", \"1,2,3\"]\nfov = 66\nsteer = \"orbit 60\"\n",
    );
    let lines: Vec<_> = scene.lines().collect();
    let expected = [
        "size 640 360",
        "camera 3 30 60",
        "fov 66",
        "light camera",
        "light 1,2,3",
        "fog 0.25",
        "occlusion on",
        "scene torus",
        "mesh on",
        "field box:1,1,1",
        "orbit 60",
    ];
    assert_eq!(lines, expected);
    assert_eq!(scene.settings().len(), expected.len() - 1);
    assert_eq!(*scene.steer(), Steer::Command("orbit 60".to_owned()));
}

/// The default quality is `balanced`; a size overrides the size that the quality sets.
#[test]
fn a_scene_has_a_quality() {
    for (text, lines, size) in [
        ("", "quality balanced", Size::W640),
        ("quality = \"fast\"", "quality fast", Size::W320),
        ("size = \"1280 720\"", "size 1280 720", Size::W1280),
        (
            "size = \"320 180\"\nquality = \"exact\"",
            "quality exact, size 320 180",
            Size::W320,
        ),
    ] {
        for subject in ["model = \"cube\"", "field = \"menger:2\""] {
            let scene = with_camera(&format!("{subject}\n{text}"));
            let found: Vec<_> = scene.lines().collect();
            assert!(found.join(", ").starts_with(&format!("{lines}, camera ")));
            assert_eq!(scene.size(), size, "{text}");
        }
    }
}

#[test]
fn refused_files() {
    const MODEL: &str = "title = \"a\"\nmodel = \"cube\"\ncamera = \"3 30 60\"\n";
    const FIELD: &str = "title = \"a\"\nfield = \"menger:4\"\ncamera = \"3 30 60\"\n";
    const PROGRAM: &str = "title = \"a\"\nprogram = \"cube\"\n";
    let cases = [
        (
            "",
            r#"
            → a.toml: no title: expected the key title
            title = 3 → line 1: title: `3`: expected a text in quotation marks
            title = "a → line 1: invalid basic string
            title = "a" → nothing to show: expected one of the keys model, object
            title = "a"; program = "gear" → line 2: program: `gear`: expected `cube`, the built-in program, or a file .wft (text) or .wfb (binary) without blanks in its name
            title = "a"; program = "gear.obj" → program: `gear.obj`: expected `cube`, the built-in program, or a file
            title = "a"; program = "gear one.wft" → program: `gear one.wft`: expected `cube`, the built-in program, or a file
            title = "a"; program = "a-name-that-is-much-too-long.wft" → expected a name of at most 24 visible characters of ASCII
            title = "a"; program = "net.wft"; model = "cube" → model: expected only without program, found it in line 2
            title = "a"; scenes = [] → scenes: `[]`: expected at least one scene
            title = "a"; scenes = ["demo"] → scenes: `demo`: expected a built-in scene, one of cubes
            title = "a"; scenes = ["menger", "sphere"] → scenes: `sphere`: expected a built-in scene, did you mean `spheres`?
            title = "a"; scenes = ["cubes"]; fog = 1 → fog: `1`: expected no such key beside scenes
        "#,
        ),
        (
            MODEL,
            r#"
            sise = "640 360" → line 4: `sise`: expected a key, did you mean `size`?
            picture = 3 → line 4: `picture`: expected a key, one of title, steer
            model = "cube" → line 4: duplicate key
            quality = "best" → line 4: quality = `best`: quality: fast|balanced|exact is "best" (column 9): expected fast or balanced or exact
            quality = 1 → quality = `1`: quality: fast|balanced|exact is "1"
            size = "640 480" → line 4: size = `640 480`: size: 640 x 480: expected 320 180, 640 360
            size = ["640 360"] → size: `["640 360"]`: expected a text, a number, true or false
            size = "" → size: `""`: expected a text, a number, true or false, such as size = "640 360"
            fov = [66] → fov: `[66]`: expected a text, a number, true or false, such as fov = 66
            zoom = "2x" → line 4: zoom = `2x`: zoom: FACTOR is "2x" (column 6): expected
            shading = "gouraud" → shading = `gouraud`: shading: flat|smooth is "gouraud" (column 9): expected flat or smooth
            cull = 2020-01-01 → cull: `2020-01-01`: expected a text, a number, true or false, such as cull = "off"
            cull = "on ü" → expected at most 640 visible ASCII
            occlusion = true → line 4: occlusion: expected only beside field
            light = ["camera", "1,2,3"] → expected one light on meshes
            light = [["camera"]] → light: `["camera"]`: expected
            object = "cube" → line 2: model: expected only without object, found it in line 4
            lookat = "1 1 1 0 0 0" → camera: expected only without lookat
            lanes = 2 → lanes: `2`: expected the key only beside field
            geometry = false; edges = "over" → geometry: `false`: expected the key only beside model or object, without edges
            steer = "buttons" → expected buttons only beside program
            steer = "imu off" → steer: `"imu off"`: expected fixed, buttons, orbit FRAMES
            clock = -1 → clock: `-1`: expected a number above 0
            clock = 1e999 → expected a number above 0
            [budget]; luts = 3 → line 5: budget: `luts`: expected a limit, did you mean `lut`?
            [budget]; watts = 3 → line 5: budget: `watts`: expected a limit, one of lut, ff
            up = "y" → line 4: up: expected only without camera, found it in line 3
            material = "normal" → line 4: material: `"normal"`: expected a material of one colour on meshes
            material = "wood" → line 4: material = `wood`: material: MATERIAL is "wood" (column 10): expected normal or mixed or clay
            material = "jade"; edges = "over" → line 4: material: `"jade"`: expected a mesh with faces, without the key edges
            steer = "orbt 60" → line 4: steer: `"orbt 60"`: expected fixed, buttons, orbit FRAMES
            [budget]; lut = "3" → budget.lut: `"3"`: expected a number above 0
            orthographic = 2; stereo = "0.1,4" → stereo: expected only without orthographic, found it in line 4
            animate = "turn z 30" → line 4: animate: `"turn z 30"`: expected as many objects as the number after turn
            animate = "azimuth" → animate = `azimuth`: animate: RATE is missing: expected degrees a second, from -360 to 360
        "#,
        ),
        (
            FIELD,
            r#"
            lanes = 3 → lanes: `3`: expected 1, 2 or 4
            fog = 16 → fog = `16`: fog: off|DENSITY is "16"
            projection = "orthographic -1 1 -1 1 0.1" → projection: `"orthographic -1 1 -1 1 0.1"`: expected perspective beside field or stereo
            projection = "matrix 1" → projection = `matrix 1`: projection: ENTRY is missing: expected a number, usage: projection
            projection = "perspective 1 -1 -1 1 0.1" → projection = `perspective 1 -1 -1 1 0.1`: projection: left 1, right -1: expected left below right
            projection = "perspective -1 1 -1 1 1"; near = 0.1 → near: expected only without projection
            near = 3 → near = `3`: near 3: expected 0.01 to 2
            orthographic = 2 → orthographic: expected only beside model or object
            edges = "over" → edges: expected only beside model
            depth = "on" → depth: `"on"`: expected true or false
            depth = true; aa = 4 → aa: `4`: expected 1 beside the key depth
            geometry = "off" → geometry: `"off"`: expected true or false
            geometry = false → geometry: `false`: expected the key only beside model or object
            animate = "orbit 30" → line 4: animate: `"orbit 30"`: expected a field moving:R,ORBIT,ANGLE beside orbit
        "#,
        ),
        (
            PROGRAM,
            r#"
            stereo = "0.1,4" → stereo: expected only beside model or object or field
            animate = "azimuth 3" → animate: expected only beside model or object or field
            camera = "3 30 60" → camera: expected only beside model or object or field
            steer = "gesture on" → expected fixed or buttons beside program
        "#,
        ),
    ];
    for (start, table) in cases {
        for (text, expected) in rows(table) {
            let error = parse(&format!("{start}{text}")).unwrap_err();
            assert!(error.contains(expected), "{text}: {error}");
            let mut lines = error.lines();
            assert!(lines.all(|line| line.starts_with("a.toml: ")), "{error:?}");
        }
    }
}

/// The error states all violations, in the order of the file. A missing key is not reported if a
/// key is misspelt or a line is damaged.
#[test]
fn all_violations_of_a_file() {
    let text = "titel = \"a\"\nmodel = \"cube\"\ncamera = \"4,30,70\"\nlight = 3\nsize = \"640\"\nocclusion = true\ndepth = 2\n\
                [budget]\nluts = 3\nff = 0\n";
    let camera = r#"camera = `4,30,70`: camera: R is "4,30,70" (column 8): expected a number"#;
    let light = "light = `3`: light: 3: expected";
    let size = "size = `640`: size: H is missing: expected";
    let limit = "budget: `luts`: expected a limit, did you mean `lut`?";
    let expected = [
        (1, "`titel`: expected a key, did you mean `title`?", ""),
        (3, camera, r#", such as camera = "4 30 70""#),
        (4, light, r#", such as light = "1,-2,3,fff0d8""#),
        (5, size, r#", such as size = "640 360""#),
        (6, "occlusion: expected only beside field", ""),
        (7, "depth: `2`: expected true or false", ""),
        (9, limit, ""),
        (10, "budget.ff: `0`: expected a number above 0", ""),
    ];
    let error = parse(text).unwrap_err();
    let found: Vec<_> = error.lines().collect();
    assert_eq!(found.len(), expected.len(), "{error}");
    for (found, (line, start, end)) in found.into_iter().zip(expected) {
        let start = format!("a.toml: line {line}: {start}");
        assert!(found.starts_with(&start) && found.ends_with(end), "{found}");
    }
    let damaged = parse("title = \"a\nfield = menger\ncamera = \"3 30\"\n").unwrap_err();
    let lines: Vec<_> = damaged.lines().map(|line| &line[..16]).collect();
    let expected = [1, 2, 3].map(|line| format!("a.toml: line {line}: "));
    assert_eq!(lines, expected, "{damaged}");
}

/// Errors quote an example of each key's value.
#[test]
fn each_example_is_valid() {
    for Row { command, forms } in FORMS {
        let action = forms.action.unwrap_or_default();
        let line = format!("{command} {action} {}", forms.example);
        assert!(Command::parse(&line).is_ok(), "{line}");
    }
}

/// The line that a scene of meshes without the key `background` has at its end.
fn background(text: &str) -> &'static str {
    if text.contains("field") {
        ""
    } else {
        "; background gradient"
    }
}

/// Without the key `camera`, a scene shows whole meshes with the axis of their file format up, and
/// a field with the default camera of `glint render`.
#[test]
fn automatic_cameras() {
    let table = r#"
        model = "cube" → scene cube; fit z
        model = "a/b.obj" → scene a/b.obj; fit y
        model = "b.GLTF"; up = "x" → scene b.GLTF; fit x
        model = "b.stl"; fov = 60; zoom = 2 → scene b.stl; fit z 60; fov 60; zoom 2
        model = "b.stl"; fov = "60 50"; near = 0.5 → scene b.stl; fit z 60; fov 60 50; near 0.5
        object = ["cube", "torus"]; orthographic = 2 → object add cube; object add torus; fit z; orthographic 2
        field = "menger:2" → camera 4 30 60; field menger:2
        field = "menger:2"; model = "b.obj"; fov = 50 → camera 4 30 60; fov 50; scene b.obj; mesh on; field menger:2
        model = "cube"; view = "0 -3 0 1 0 0 0 0 -1 0 1 0 0.9 0.1" → view 0 -3 0 1 0 0 0 0 -1 0 1 0 0.9 0.1; scene cube
    "#;
    for (text, expected) in rows(table) {
        let scene = parse(&format!("title = \"a\"\n{text}")).unwrap();
        let lines = scene.lines().collect::<Vec<_>>().join("; ");
        let background = background(&text);
        let expected = format!("quality balanced; {expected}{background}");
        assert_eq!(lines, expected, "{text}");
        let fits = scene.needs().features.contains(&FIT);
        assert_eq!(fits, expected.contains("fit "), "{text}");
    }
}

/// A material gives meshes its colour, except objects with a colour of their own.
#[test]
fn materials_of_meshes() {
    let table = r#"
        model = "cube"; material = "jade" → object add cube colour JADE
        object = ["cube", "torus move 0,0,1 colour 00ff00"]; material = "jade" → object add cube colour JADE; object add torus move 0,0,1 colour 00ff00
        model = "cube"; field = "box:1,1,1"; material = "jade" → material jade; scene cube; mesh on; field box:1,1,1
    "#;
    let [r, g, b] = Material::Jade.faces()[0];
    for (text, expected) in rows(table) {
        let expected = expected.replace("JADE", &format!("{r:02x}{g:02x}{b:02x}"));
        let scene = with_camera(&text);
        let lines = scene.lines().collect::<Vec<_>>().join("; ");
        let background = background(&text);
        let expected = format!("quality balanced; camera 3 30 60; {expected}{background}");
        assert_eq!(lines, expected);
    }
}

/// A scene with one sample a pixel and one colour behind meshes, unless the text states others.
fn plain(text: &str) -> SceneFile {
    let mut text = text.to_owned();
    for line in ["aa = 1", "background = \"000000\""] {
        let (key, _) = line.split_once(' ').unwrap();
        if !text.contains(key) {
            text = format!("{text}\n{line}");
        }
    }
    with_camera(&text)
}

/// By default a scene needs antialiasing where it has four samples a pixel, and a gradient behind meshes.
#[test]
fn needs_of_defaults() {
    let table = r#"
        model = "cube" → --blocks scanout triangle
        model = "cube"; quality = "fast" → --blocks scanout triangle --no-antialiasing
        model = "cube"; depth = true → --blocks scanout triangle --no-antialiasing
        model = "cube"; backend = "cpu" → --blocks scanout
        model = "cube"; field = "menger:2" → --blocks scanout triangle raymarch --no-sky --fields menger:2 --lanes 2
        field = "menger:2" → --blocks scanout raymarch --no-depths --fields menger:2 --lanes 2
        field = "menger:2"; size = "1280 720" → --blocks scanout raymarch --no-antialiasing --no-depths --fields menger:2 --lanes 2
        field = "menger:2"; stereo = "0.1,4" → --blocks scanout raymarch --no-antialiasing --no-depths --fields menger:2,stereo --lanes 2
    "#;
    for (text, expected) in rows(table) {
        let found = with_camera(&text).needs().options().join(" ");
        assert_eq!(found, expected, "{text}");
    }
}

#[test]
fn needs_follow_from_the_keys() {
    let options = |text: &str| plain(text).needs().options().join(" ");
    let table = r#"
        model = "cube" → --blocks scanout triangle --no-sky --no-antialiasing
        model = "cube"; background = "sky" → --blocks scanout triangle --no-antialiasing
        model = "cube"; fog = 0.2 → --blocks scanout triangle --no-sky --fog --no-antialiasing
        model = "cube"; geometry = false → --blocks scanout triangle --no-sky --no-antialiasing --no-geometry
        model = "cube"; aa = 4 → --blocks scanout triangle --no-sky
        field = "menger:3"; aa = 4 → --blocks scanout raymarch --no-depths --fields menger:3 --lanes 2
        model = "cube"; fog = "off" → --blocks scanout triangle --no-sky --no-antialiasing
        model = "cube"; backend = "cpu" → --blocks scanout
        model = "cube"; shading = "smooth" → --blocks scanout triangle --smooth --no-sky --no-antialiasing
        model = "cube"; edges = "over" → --blocks scanout triangle line --no-sky --no-antialiasing
        model = "cube"; steer = "gesture vga" → --blocks scanout triangle gesture --no-sky --no-antialiasing
        model = "cube"; steer = "imu look" → --blocks scanout triangle i2c --no-sky --no-antialiasing
        model = "cube"; clip = 10 → --blocks scanout triangle --no-sky --no-antialiasing --no-geometry
        model = "cube"; winding = "screen" → --blocks scanout triangle --no-sky --no-antialiasing --no-geometry
        model = "cube"; edges = "over"; clip = 10 → --blocks scanout triangle line --no-sky --no-antialiasing
        field = "menger:3" → --blocks scanout raymarch --no-antialiasing --no-depths --fields menger:3 --lanes 2
        field = "sphere:1"; lanes = 1 → --blocks scanout raymarch --no-antialiasing --no-depths --fields spheres,normals --lanes 1
        field = "sphere:1"; material = "jade"; highlight = "0.5,9" → --blocks scanout raymarch --no-antialiasing --no-depths --fields spheres,highlight --lanes 2
        field = "menger:3"; shadow = true; material = "ivory" → --blocks scanout raymarch --no-antialiasing --no-depths --fields menger:3,shadow --lanes 2
        field = "menger:3"; shadow = true → --blocks scanout raymarch --no-antialiasing --no-depths --fields menger:3 --lanes 2
        field = "box:1,1,1"; shadow = true; material = "ivory" → --blocks scanout raymarch --no-antialiasing --no-depths --fields box --lanes 2
        field = "menger:3"; depth = true → --blocks scanout raymarch --no-antialiasing --fields menger:3 --lanes 2
        field = "planes:4"; prepass = true → --blocks scanout raymarch --no-antialiasing --no-depths --fields box --lanes 2
        field = "octahedron:1"; stereo = "0.1,4" → --blocks scanout raymarch --no-antialiasing --no-depths --fields octahedron,stereo --lanes 2
        model = "cube"; stereo = "0.1,4" → --blocks scanout triangle --no-sky --no-antialiasing
        model = "cube"; field = "octahedron:1"; stereo = "0.1,4" → --blocks scanout triangle raymarch --no-sky --no-antialiasing --fields octahedron --lanes 2
        field = "lattice:2,0.5"; material = "sky" → --blocks scanout raymarch --no-antialiasing --no-depths --fields lattice --lanes 2
        field = "cone:1,2"; material = "sky" → --blocks scanout raymarch --no-antialiasing --no-depths --fields spheres,cone --lanes 2
        field = "union:menger:3+sphere:1" → --blocks scanout raymarch --no-antialiasing --no-depths --fields menger:3,spheres,normals --lanes 2
        field = "smooth:0.3,box:1,1,0.2+sphere:1"; material = "sky" → --blocks scanout raymarch --no-antialiasing --no-depths --fields box,spheres,fillets --lanes 2
        field = "menger:2"; fog = 0.1 → --blocks scanout raymarch --no-antialiasing --no-depths --fields menger:2 --lanes 2
        field = "menger:2"; model = "cube"; fog = 0.1 → --blocks scanout triangle raymarch --no-sky --fog --no-antialiasing --fields menger:2 --lanes 2
        field = "menger:2"; model = "cube" → --blocks scanout triangle raymarch --no-sky --no-antialiasing --fields menger:2 --lanes 2
    "#;
    for (text, expected) in rows(table) {
        assert_eq!(options(&text), expected, "{text}");
    }
    let program = |text: &str| {
        let scene = parse(&format!(
            "title = \"A program\"\nprogram = \"cube\"\n{text}"
        ));
        scene.unwrap().needs().options().join(" ")
    };
    assert_eq!(program(""), "--blocks scanout line --no-depths");
    let file = parse("title = \"A net\"\nprogram = \"NET.wfb\"\n").unwrap();
    assert_eq!(file.program(), Some("NET.wfb"));
    assert_eq!(file.lines().last(), Some("program NET.wfb"));
    assert_eq!(file.needs(), needs_of_program());
    assert_eq!(
        program("aa = 1"),
        "--blocks scanout line --no-antialiasing --no-depths"
    );
    assert_eq!(
        program("depth = true"),
        "--blocks scanout line --no-antialiasing"
    );
}

/// What a scene with the built-in wireframe program needs.
fn needs_of_program() -> Needs {
    let scene = parse("title = \"A cube\"\nprogram = \"cube\"\n").unwrap();
    assert_eq!(scene.program(), None);
    assert_eq!(scene.lines().last(), Some("program"));
    scene.needs()
}

#[test]
fn parts_of_the_firmware_follow_from_the_commands() {
    let features = |text: &str| {
        let needs = plain(text).needs();
        let names = needs.features.iter().map(|feature| feature.name);
        names.collect::<Vec<_>>().join(" ")
    };
    let table = r#"
        model = "torus" → mesh view
        model = "cow.obj" → mesh upload view
        model = "cow.obj"; textures = true → mesh texture upload view
        model = "cow.obj"; textures = true; shading = "smooth" → cpu mesh texture upload view
        model = "torus"; background = "sky" → mesh sky view
        model = "torus"; fog = 0.1 → fog mesh view
        model = "torus"; aa = 4 → antialiasing mesh view
        model = "torus"; geometry = false → cpu mesh view
        model = "torus"; background = "sky"; field = "menger:1" → field mesh mesh-in-field sky view
        model = "cow.obj"; textures = false → mesh texture upload view
        model = "crate"; texture = "wood.png" → mesh texture upload view
        model = "torus"; backend = "cpu" → cpu mesh view
        model = "torus"; clip = 3 → cpu mesh view
        model = "torus"; edges = "over" → edges mesh view
        object = "torus"; light = "1,1,1" → light mesh object view
        model = "torus"; steer = "gesture on" → gesture mesh view
        field = "menger:3"; highlight = "0.5,9"; material = "jade" → field light view
        field = "menger:3"; steer = "imu orbit" → field imu view
        field = "menger:3"; animate = "azimuth 30" → animate field view
        field = "menger:2"; model = "torus" → field mesh mesh-in-field view
        field = "menger:2"; stereo = "0.1,4" → field stereo view
        field = "union:box:1,1,1+sphere:1"; fog = 0.1; prepass = true → field fog spheres view
    "#;
    for (text, expected) in rows(table) {
        assert_eq!(features(&text), expected, "{text}");
    }
}

#[test]
fn several_scenes_need_what_each_needs() {
    let scenes = ["menger", "wireframe", "spheres"].map(|name| built_in(name).unwrap());
    let needs = Needs::of(&scenes);
    let blocks = [Block::Scanout, Block::Raymarch, Block::Line];
    assert_eq!(needs.blocks, blocks.into());
    assert!(needs.geometry && !needs.depths);
    let fields = needs.fields.unwrap();
    assert_eq!(
        (fields.names(), fields.lanes),
        ("menger:4,spheres".into(), 2)
    );
    assert_eq!(built_in("menger").unwrap().needs().fields.unwrap().lanes, 4);
    let demo = built_in("demo").unwrap().needs();
    // No scene requires the flash block.
    assert_eq!(demo.blocks.len(), Block::ALL.len() - 1);
}
