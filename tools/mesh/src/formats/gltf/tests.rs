//! Tests with a file of two meshes under a node: one mesh rotated by 90° about z, with a material and indices; the other mesh mirrored, a
//! strip with vertex colours.

use super::example::{TWO_MESHES, as_binary};
use super::*;

fn read(text: &str) -> Result<Polygons, FormatError> {
    parse(text.as_bytes(), &mut |_| None)
}

fn error(from: &str, to: &str) -> String {
    assert!(TWO_MESHES.contains(from), "{from}");
    read(&TWO_MESHES.replacen(from, to, 1))
        .unwrap_err()
        .to_string()
}

/// The points of each face, rounded.
fn faces(polygons: &Polygons) -> Vec<Vec<[i32; 3]>> {
    let faces = polygons.faces.iter();
    let corners = faces.map(|face| polygons.corners_of(face));
    corners
        .map(|corners| {
            let points = corners.iter().map(|corner| polygons.point(*corner));
            points
                .map(|point| point.map(|c| c.round() as i32))
                .collect()
        })
        .collect()
}

#[test]
fn transforms_colours_and_strips() {
    let polygons = read(TWO_MESHES).unwrap();
    assert_eq!(
        faces(&polygons),
        [
            // The strip, mirrored, so with reversed winding.
            vec![[10, 0, 0], [10, 2, 0], [8, 0, 0]],
            vec![[10, 2, 0], [8, 2, 1], [8, 0, 0]],
            // The indexed triangles, rotated.
            vec![[10, 0, 0], [10, 2, 0], [8, 0, 0]],
            vec![[10, 2, 0], [8, 2, 1], [8, 0, 0]],
        ]
    );
    // The linear intensity 0.214 is half of the full sRGB value.
    let material = Rgb8([127, 255, 0]);
    assert_eq!(polygons.faces[3].colour, Some(material));
    assert_eq!(polygons.faces[0].colour, None);
    assert_eq!(
        polygons.point_colours[..3],
        [[255, 0, 0], [0, 255, 0], [0, 0, 255]].map(Rgb8)
    );
    assert_eq!(polygons.point_colours[4], material);
    // A rotation about z does not change a normal along z.
    assert!(polygons.normals.iter().all(|n| (n[2] - 1.0).abs() < 1e-6));
    assert_eq!(polygons.remarks, ["points and lines are ignored"]);
}

#[test]
fn binary_and_beside() {
    let expected = faces(&read(TWO_MESHES).unwrap());
    let (binary, buffer) = as_binary(TWO_MESHES).unwrap();
    let polygons = parse(&binary, &mut |_| None).unwrap();
    assert_eq!(faces(&polygons), expected);
    let start = TWO_MESHES.find("data:").unwrap();
    let end = start + TWO_MESHES[start..].find('"').unwrap();
    let text = [&TWO_MESHES[..start], "two%20meshes.bin", &TWO_MESHES[end..]].concat();
    let polygons = parse(text.as_bytes(), &mut |name| {
        assert_eq!(name, "two meshes.bin");
        Some(buffer.clone())
    });
    assert_eq!(faces(&polygons.unwrap()), expected);
    assert_eq!(
        read(&text).unwrap_err().to_string(),
        "expected the file of a buffer in the folder of the glTF, found 'two%20meshes.bin'"
    );
}

#[test]
fn errors() {
    assert_eq!(
        error("\"children\": [1, 2]", "\"children\": [1, 0]"),
        "expected one parent of node 0, found several"
    );
    assert_eq!(
        error("\"byteLength\": 12}", "\"byteLength\": 10}"),
        "expected accessor 3 within its buffer, found 6 values that end outside of it"
    );
    assert_eq!(
        error("\"byteLength\": 124", "\"byteLength\": 125"),
        "expected 125 bytes in buffer 0, found 124"
    );
    assert_eq!(
        error("\"byteOffset\": 112", "\"byteOffset\": 96"),
        "expected an index below 4, found 255"
    );
    assert_eq!(
        error("\"POSITION\": 0", "\"POSITION\": 4"),
        "expected an accessor of positions below 4, found 4"
    );
    assert_eq!(
        error("[10, 0, 0]", "[3e38, 0, 0]"),
        "expected coordinates within ±1e30, found 3.000e38 of a mesh in its place"
    );
    assert_eq!(
        error("\"scenes\": [{\"nodes\": [0]}]", "\"scenes\": []"),
        "expected valid glTF 2.0, found scene: Index out of bounds"
    );
    assert_eq!(
        error("octet-stream;base64,", "octet-stream;base64,-")
            .split(',')
            .next(),
        Some("expected data of a buffer in base64")
    );
    assert_eq!(
        error("\"version\": \"2.0\"", "\"version\": \"1.0\""),
        "expected an asset.version 2.0 or 2.x, found '1.0'"
    );
    assert_eq!(
        error("\"version\": \"2.0\"", "\"version\": \"2\""),
        "expected an asset.version 2.0 or 2.x, found '2'"
    );
    assert_eq!(
        error(
            "\"version\": \"2.0\"",
            "\"version\": \"2.1\", \"minVersion\": \"2.1\""
        ),
        "expected an asset.minVersion of 2.0 or none, found '2.1'"
    );
    let draco = "\"extensionsRequired\": [\"KHR_draco_mesh_compression\"], \"scene\": 0";
    assert_eq!(
        error("\"scene\": 0", draco),
        "expected valid glTF 2.0, found extensionsRequired[0] = \"KHR_draco_mesh_compression\": Unsupported extension"
    );
    assert_eq!(
        parse(b"glTF\x02\0\0\0\x05\0\0\0", &mut |_| None)
            .unwrap_err()
            .to_string(),
        "byte 8: expected a length of 12 to 12 bytes, found 5"
    );
}

#[test]
fn memory_is_bounded() {
    let nodes = "{},".repeat(MAX_STRUCTURE / 3);
    let text = format!("{{\"asset\": {{\"version\": \"2.0\"}}, \"nodes\": [{nodes}{{}}]}}");
    let error = read(&text).unwrap_err().to_string();
    assert!(
        error.starts_with("expected at most 4194304 bytes of JSON outside of strings"),
        "{error}"
    );
    // Strings, such as data in base64, are not counted.
    assert_eq!(structure(br#"{"a\"{{{": "}}}\\"}"#), 8);
}

/// Minor versions are compatible.
#[test]
fn a_later_minor_version_is_read() {
    for version in ["2.1", "2.10\", \"minVersion\": \"2.0"] {
        let text = format!("\"version\": \"{version}\"");
        read(&TWO_MESHES.replacen("\"version\": \"2.0\"", &text, 1)).unwrap();
    }
}

#[test]
fn what_is_ignored_is_remarked() {
    let text = TWO_MESHES
        .replacen(
            "\"baseColorFactor\"",
            "\"baseColorTexture\": {\"index\": 0}, \"baseColorFactor\"",
            1,
        )
        .replacen("\"mesh\": 0", "\"mesh\": 0, \"skin\": 0", 1)
        .replacen(
            "\"scene\": 0",
            "\"skins\": [{\"joints\": [0]}], \"images\": [{\"uri\": \"x.png\"}], \"textures\": [{\"source\": 0}], \"scene\": 0",
            1,
        );
    let polygons = read(&text).unwrap();
    assert_eq!(
        polygons.remarks,
        [
            "points and lines are ignored",
            "skins are ignored: meshes have their rest pose",
            "textures are ignored: materials have their base colours",
        ]
    );
}
