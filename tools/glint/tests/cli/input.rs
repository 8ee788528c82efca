//! Bad input gives one line of error, exit code 2, and no output file.

use crate::common::{
    SQUARE, VIEW, all_refused, assert_has, failed, files_refused, folder, refused, rows, succeed,
};

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
    let square = |from: &str, to: &str| SQUARE.replace(from, to).into_bytes();
    let files = [
        ("empty.obj", vec![]),
        ("empty.stl", vec![]),
        ("empty.ply", vec![]),
        ("empty.glm", vec![]),
        ("nan.obj", square("1 0 0", "1 NaN 0")),
        ("huge.obj", square("1 0 0", "1 1e309 0")),
        ("zero.obj", square("f 1", "f 0")),
        ("range.obj", square("f 1", "f 5")),
        ("negative.obj", square("f 1", "f -5")),
        ("faces.obj", square("f 1", "f 2147483648")),
        ("line.obj", format!("{SQUARE}f {million}\n").into()),
        (
            "polygon.obj",
            format!("{SQUARE}f {}\n", &million[..20_000]).into(),
        ),
        ("binary.obj", (0..=255).collect()),
        ("point.obj", b"v 1 1 1\nf 1 1 1\n".to_vec()),
        ("flat.obj", b"v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n".to_vec()),
        ("faces.stl", stl_of_2_31_faces),
        (
            "cut.stl",
            b"solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0".to_vec(),
        ),
        ("line.stl", format!("solid {million}").into()),
        ("faces.ply", ply("2147483648", "3 0 1 2\n")),
        ("count.ply", ply("-1", "3 0 1 2\n")),
        ("range.ply", ply("1", "3 0 1 3\n")),
        (
            "nothing.ply",
            b"ply\nformat binary_little_endian 1.0\nelement a 4000000000\nend_header\n".to_vec(),
        ),
        ("magic.glm", [0; 64].to_vec()),
    ];
    files_refused(
        &folder,
        ["convert FILE out.glm", "render FILE --out out.png"],
        &files,
        r#"
        empty.obj: expected at least one face, found none
        empty.stl: expected an STL…
        empty.ply: line 1: expected ply…
        empty.glm: byte 0: expected at least 32 bytes of header, found 0…
        nan.obj: line 2: expected a finite number, found 'NaN'
        huge.obj: line 2: expected a finite number, found '1e309'
        zero.obj: line 5: expected a vertex index…
        range.obj: line 5: expected a point index below 4, found 4…
        negative.obj: line 5: expected a vertex index…
        faces.obj: line 5: expected a point…
        line.obj: line 6: expected a line of at most 65536 bytes…
        polygon.obj: line 6: expected a face of 3 to 8192 corners, found 10000…
        binary.obj: line 1: expected an OBJ statement…
        point.obj: expected a mesh with an extent, found extent 0e0…
        flat.obj: expected a triangle with an area…
        faces.stl: expected a binary STL of 2147483648 triangles…
        cut.stl: line 4: expected three numbers of a vertex, found 2…
        line.stl: expected at least one face, found none
        faces.ply: line 13: expected as many elements as the header declares, found the end of the file…
        count.ply: line 7: expected a count of elements up to 2^32 - 1…
        range.ply: line 13: expected a point index below 3, found 3…
        nothing.ply: expected at least one face…
        magic.glm: byte 0: expected "GLM2", found '\x00\x00\x00\x00'…
        "#,
    );
    assert!(!folder.join("out.glm").exists() && !folder.join("out.png").exists());
}

#[test]
fn bad_names_and_numbers() {
    let folder = folder("bad_names");
    std::fs::write(folder.join("square.obj"), SQUARE.replace("v 1", "v 9")).unwrap();
    std::fs::write(folder.join("view.json"), "{}").unwrap();
    let far = VIEW.replace("[0,-2,0]", "[0,-9,0]");
    std::fs::write(folder.join("far.json"), far).unwrap();
    all_refused(
        &folder,
        r#"
        convert gone.obj out.glm
            gone.obj: expected a file to read, found…
        convert . out.glm
            .: expected a name that ends in .obj, .stl, .ply, .gltf, .glb or .glm, found no extension…
        convert square.obj out.xyz
            out.xyz: expected a name that ends in .obj, .stl, .ply, .glm, found '.xyz'…
        convert square.obj out.glm --keep-scale
            square.obj: expected coordinates in [-2, 2 - 2^-14]…
        model sponge:5 out.glm
            sponge:5: expected a model cube, icosphere:N (frequency, 1 to 64), torus-knot, gear, teapot, globe, hall, fence, window (these four with textures), scan:N (frequency, 1 to 64) or sponge:N (0 to 4), found 'sponge:5'…
        render icosphere:x --out out.png
            icosphere:x: expected a model…
        render cube --out out.png --camera 1,2
            --camera: expected a camera R,THETA,PHI…
        render cube --out out.png --camera 6,0,0
            --camera: expected a camera R,THETA,PHI such as 3,30,60, found radius 6…
        render cube --out out.png --look-at 1,2,3,0,0,0
            --look-at: expected a camera EX,EY,EZ,GX,GY,GZ[,UX,UY,UZ] such as 3,0,1,-3,0,-1, found gaze (0, 0, 0): expected a non-zero direction…
        render cube --out out.png --look-at 3,0,0
            --look-at: expected a camera EX,EY,EZ,GX,GY,GZ[,UX,UY,UZ] such as 3,0,1,-3,0,-1, found '3,0,0'
        render cube --out out.png --look-at 3,0,0,1,0,0,0,0,0
            --look-at: expected a camera EX,EY,EZ,GX,GY,GZ[,UX,UY,UZ] such as 3,0,1,-3,0,-1, found up (0, 0, 0)…
        render cube --out out.png --look-at 33,0,0,1,0,0
            --look-at: expected a camera EX,EY,EZ,GX,GY,GZ[,UX,UY,UZ] such as 3,0,1,-3,0,-1, found eye (33, 0, 0): expected within 32 of the origin…
        render cube --out out.png --look-at 3,0,0,inf,0,0
            --look-at: expected a camera EX,EY,EZ,GX,GY,GZ[,UX,UY,UZ] such as 3,0,1,-3,0,-1, found '3,0,0,inf,0,0'
        render cube --out out.png --fov 179.5
            --fov: expected 1 to 179 degrees, found '179.5'…
        render cube --out out.png --fov 0.9
            --fov: expected 1 to 179 degrees, found '0.9'
        render cube --out out.png --fov nan
            --fov: expected 1 to 179 degrees, found 'nan'
        render cube --out out.png --fov=-90
            --fov: expected 1 to 179 degrees, found '-90'
        render cube --out out.png --fov ''
            --fov: expected 1 to 179 degrees, found ''
        render cube --out out.png --orthographic 0
            --orthographic: expected a width in world units, found width 0: expected 0.0174 to 230…
        render cube --out out.png --orthographic 0.01
            --orthographic: expected a width in world units, found width 0.01…
        render cube --out out.png --orthographic 231
            --orthographic: expected a width in world units, found width 231: expected 0.0174 to 230…
        render cube --out out.png --orthographic 300
            --orthographic: expected a width in world units, found '300'
        render cube --out out.png --orthographic wide
            --orthographic: expected a width in world units, found 'wide'
        render cube --out out.png --look 0,-2,0
            --look: expected a camera EX,EY,EZ,YAW,PITCH[,ROLL] such as 0,-3,1,0,20, found '0,-2,0'…
        render --out out.png --object 'cube matrix 1,0,0,2,0,0,0,0,1'
            --object: expected a model matrix, found matrix row 2: singular…
        render --out out.png --object 'cube move nan,0,0'
            --object: expected a vector X,Y,Z, found 'nan,0,0'…
        render cube --out out.png --view view.json
            view.json: expected {"eye":[x,y,z]…
        render cube --out out.png --view gone.json
            gone.json: expected a file to read…
        render cube --out out.png --view far.json
            far.json: expected a camera, found eye (0, -9, 0): expected within 8 of the origin for a mesh…
        render --field ball:1 --out out.png
            --field: expected a distance field, found no field is named ball: expected menger:DEPTH, box:X,Y,Z,…
        render --field menger:9 --out out.png
            --field: expected a distance field, found depth: expected 1 to 6…
        render --field menger:4 --stereo 1 --out out.png
            --stereo: expected two eyes, found 1: expected E,ZERO[,red-blue|red-cyan]…
        render cube --stereo 1,1 --look-at 7.99,0,0,-1,0,0 --out out.png
            --look-at: expected a camera, found eye (7.99, -1, 0): expected within 8 of the origin for a mesh…
        render cube --out out.png --occlusion
            --occlusion: expected a --field, found a mesh…
        render --field menger:2 --fog -1 --out out.png
            --fog: expected a density of at least 0 and below 16, found '-1'…
        render --field menger:2 --ambient fff --out out.png
            --ambient: expected a colour RRGGBB, found 'fff'…
        render --field menger:2 --light 0,0,0 --out out.png
            --light: expected a light, found direction 0,0,0: expected a non-zero direction…
        board --gdb --board virtual
            --board with --gdb: expected emulated, found 'virtual'…
        render cube --out out.png --size 320x200
            --size: expected 320x180, 640x360 or 1280x720, found '320x200'…
        "#,
    );
}

#[test]
fn failures_other_than_bad_input() {
    let folder = folder("failures");
    let table = "
        upload cube --board /dev/no-such-port → /dev/no-such-port: expected `emulated`, `virtual` or a serial port, found:
        model cube no-such-folder/cube.glm → no-such-folder/cube.glm: cannot be written:
        render cube --out a.png --capture monitor → --capture monitor: expected the emulated or the virtual board, found --board model
    ";
    for [command, message] in rows(table) {
        let error = failed(&folder, command, 1);
        assert_eq!(error.lines().count(), 1, "{error}");
        assert!(error.starts_with(&format!("error: {message}")), "{error}");
    }
}

/// The checksum detects damage that still parses as a mesh; a file without a checksum is rejected.
#[test]
fn a_damaged_glm_is_refused() {
    let folder = folder("damaged_glm");
    succeed(&folder, "model icosphere:2 good.glm");
    succeed(&folder, "render good.glm --out good.png");
    let good = std::fs::read(folder.join("good.glm")).unwrap();
    let damaged = |at: usize, bit: u8| {
        let mut bytes = good.clone();
        bytes[at] ^= bit;
        bytes
    };
    // Files with a damaged colour of the first vertex, a damaged checksum, and a damaged format.
    let files = [
        ("colour.glm", damaged(60, 4)),
        ("checksum.glm", damaged(25, 1)),
        ("old.glm", damaged(3, b'1' ^ b'2')),
    ];
    files_refused(
        &folder,
        ["convert FILE out.obj", "render FILE --out out.png"],
        &files,
        r#"
        colour.glm: byte 24: expected the CRC-32 …
        checksum.glm: byte 24: expected the CRC-32 …
        old.glm: byte 0: expected "GLM2", a mesh with a checksum, found 'GLM1', written by an earlier glint: convert…
        "#,
    );
}

#[test]
fn a_mistyped_generator_is_named() {
    let folder = folder("generators");
    for command in ["render teapto --out a.png", "convert teapto a.glm"] {
        let error = refused(&folder, command);
        assert_has(
            &error,
            "teapto: expected a mesh file or a generator (cube, icosphere:N",
        );
    }
    let error = refused(&folder, "convert teapot a.glm");
    assert_has(&error, "`glint model teapot` makes this model");
}
