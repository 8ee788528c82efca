//! Files with content that their format does not define are loaded, with a warning about this
//! content.

use crate::common::{SQUARE, folder, picture, said, succeed};
use std::fs;
use std::path::Path;

const STL: &str = "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n";
const PLY: &str = "ply\nformat ascii 1.0\nauthor a b\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty list uchar int rings\nelement face 1\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\nend_header\n0 0 0 1 7\n1 0 0 0\n0 1 0 0\n3 0 1 2 2 0.5 0.5\n";

/// Renders a model, and returns the warning lines.
fn warnings(folder: &Path, model: &str) -> Vec<String> {
    let render = format!("render {model} --up z --force --out a.png");
    let [_, error] = said(folder, &render);
    assert!(picture(&folder.join("a.png")).iter().any(|&c| c != 0));
    error.lines().map(str::to_owned).collect()
}

#[test]
fn meshes_with_more_than_their_format() {
    let folder = folder("tolerance");
    let mark = "\u{feff}";
    let binary = {
        let corners = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
        let corners = corners.map(f32::to_le_bytes);
        let header = [&[b's'; 80][..], &1_u32.to_le_bytes(), &[0; 12]].concat();
        [&header[..], corners.as_flattened(), &[0; 2], b"the end"].concat()
    };
    let large = SQUARE
        .replace("v 1", "v 1e30")
        .replace(" 1 0\n", " 1e30 0\n");
    let files: [(&str, Vec<u8>); 7] = [
        ("mark.obj", format!("{mark}{SQUARE}").into()),
        ("mark.stl", format!("{mark}{STL}").into()),
        (
            "mark.ply",
            format!("{mark}{}", PLY.replace("author a b\n", "")).into(),
        ),
        (
            "unknown.obj",
            format!("crease 1 2\n{SQUARE}crease 3 4\nrefl x\n").into(),
        ),
        ("header.ply", PLY.into()),
        ("rest.stl", binary),
        ("large.obj", large.into()),
    ];
    let expected = "
        mark.obj: the byte order mark at the start is skipped
        mark.stl: the byte order mark at the start is skipped
        mark.ply: the list 'rings' of 'vertex' is skipped
        mark.ply: the list 'texcoord' of 'face' is skipped
        mark.ply: the byte order mark at the start is skipped
        unknown.obj: line 1: the unknown statement 'crease' is skipped
        unknown.obj: line 8: the unknown statement 'refl' is skipped
        header.ply: the list 'rings' of 'vertex' is skipped
        header.ply: the list 'texcoord' of 'face' is skipped
        header.ply: line 3: the header line 'author a b' is skipped
        rest.stl: 7 bytes after the last triangle are skipped
        large.obj: a coordinate of magnitude 1e30: the file may be damaged
    ";
    for (name, contents) in files {
        fs::write(folder.join(name), contents).unwrap();
        let expected = expected.lines().map(str::trim);
        let expected = expected.filter(|line| line.starts_with(&format!("{name}: ")));
        let expected: Vec<_> = expected.map(|line| format!("warning: {line}")).collect();
        assert_eq!(warnings(&folder, name), expected);
    }
}

#[test]
fn a_material_file_that_is_a_pipe_a_device_or_elsewhere_is_not_opened() {
    let folder = folder("pipes");
    let made = std::process::Command::new("mkfifo")
        .arg(folder.join("pipe.mtl"))
        .status();
    assert!(made.unwrap().success());
    std::os::unix::fs::symlink("/dev/zero", folder.join("zero.mtl")).unwrap();
    fs::create_dir(folder.join("other")).unwrap();
    fs::write(folder.join("other/a.mtl"), "newmtl a\n").unwrap();
    std::os::unix::fs::symlink("other/a.mtl", folder.join("other.mtl")).unwrap();
    fs::write(folder.join("a.mtl"), "newmtl a\n").unwrap();
    std::os::unix::fs::symlink("a.mtl", folder.join("near.mtl")).unwrap();
    fs::write(folder.join("a.obj"), format!("mtllib near.mtl\n{SQUARE}")).unwrap();
    assert!(warnings(&folder, "a.obj").is_empty());
    for library in ["pipe.mtl", "zero.mtl", "other.mtl"] {
        fs::write(folder.join("a.obj"), format!("mtllib {library}\n{SQUARE}")).unwrap();
        let expected = format!(
            "warning: a.obj: no material file '{library}' beside the mesh: its colours are missing"
        );
        assert_eq!(warnings(&folder, "a.obj"), [expected]);
    }
}

#[test]
fn a_log_with_more_columns() {
    let folder = folder("columns");
    let log = "t_us,ax,ay,az,gx,gy,gz,mx,my\n0,0,0,4096,0,0,0,1,2\n1000,0,0,4096,0,0,0,x,\n";
    fs::write(folder.join("log.csv"), log).unwrap();
    let replay = "imu replay log.csv --still 0 --out a.csv";
    let [_, error] = said(&folder, replay);
    assert_eq!(error, "warning: log.csv: ignored columns: 'mx', 'my'\n");
    fs::write(folder.join("log.csv"), log.replace(",mx,my", ",,")).unwrap();
    succeed(&folder, replay);
}
