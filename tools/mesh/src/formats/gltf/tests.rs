//! Tests with a file that has two meshes under one node: an indexed mesh with a material, rotated
//! by 90° about z, and a mirrored strip with vertex colours.

use super::example::{TWO_MESHES, as_binary};
use super::*;
use crate::formats::text::rows;
use crate::polygons::Content;
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use glint_texture::options::{filter_name, wrap_name};

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
            // The strip is mirrored, so its winding is reversed.
            vec![[10, 0, 0], [10, 2, 0], [8, 0, 0]],
            vec![[10, 2, 0], [8, 2, 1], [8, 0, 0]],
            // The indexed triangles, rotated.
            vec![[10, 0, 0], [10, 2, 0], [8, 0, 0]],
            vec![[10, 2, 0], [8, 2, 1], [8, 0, 0]],
        ]
    );
    // The linear intensity 0.214 corresponds to half of the full sRGB value.
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
    let cases = r#"
        "children": [1, 2] → "children": [1, 0] → expected one parent of node 0, found several
        "byteLength": 12} → "byteLength": 10} → expected accessor 3 within its buffer, found 6 values that end outside of it
        "byteLength": 124 → "byteLength": 125 → expected 125 bytes in buffer 0, found 124
        "byteOffset": 112 → "byteOffset": 96 → expected an index below 4, found 255
        "POSITION": 0 → "POSITION": 4 → expected an index below 4 in the list of accessors, found 4
        [10, 0, 0] → [10, 0, 0], "scale": [1e39, 1, 1] → expected a finite number, found NaN
        "scenes": [{"nodes": [0]}] → "scenes": [] → expected an index below 0 in the list of scenes, found 0
        "version": "2.0" → "version": "1.0" → expected an asset.version 2.0 or 2.x, found '1.0'
        "version": "2.0" → "version": "2" → expected an asset.version 2.0 or 2.x, found '2'
        "version": "2.0" → "version": "2.1", "minVersion": "2.1" → expected an asset.minVersion of 2.0 or none, found '2.1'
        "scene": 0 → "extensionsRequired": ["KHR_draco_mesh_compression"], "scene": 0 → expected a file without compression, found 'KHR_draco_mesh_compression'
    "#;
    for [from, to, message] in rows(cases) {
        assert_eq!(error(from, to), message);
    }
    let error = error("octet-stream;base64,", "octet-stream;base64,-");
    assert!(error.starts_with("expected data of a buffer in base64,"));
    let error = parse(b"glTF\x02\0\0\0\x05\0\0\0", &mut |_| None).unwrap_err();
    assert_eq!(
        error.to_string(),
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

/// A file of a later minor version is compatible.
#[test]
fn a_later_minor_version_is_read() {
    for version in ["2.1", "2.10\", \"minVersion\": \"2.0"] {
        let text = format!("\"version\": \"{version}\"");
        read(&TWO_MESHES.replacen("\"version\": \"2.0\"", &text, 1)).unwrap();
    }
}

#[test]
fn what_is_ignored_is_remarked() {
    let changes = r#"
        "baseColorFactor" → "baseColorTexture": {"index": 0}, "baseColorFactor"
        "pbrMetallicRoughness" → "alphaMode": "BLEND", "emissiveFactor": [0, 1, 0], "pbrMetallicRoughness"
        "mesh": 0 → "mesh": 0, "skin": 0
        "scene": 0 → "skins": [{"joints": [0]}], "images": [{"uri": "x.png"}], "textures": [{"source": 0}], "scene": 0
    "#;
    let text = rows(changes).fold(TWO_MESHES.to_owned(), |text, [from, to]| {
        text.replacen(from, to, 1)
    });
    assert_eq!(
        read(&text).unwrap().remarks,
        [
            "points and lines are ignored",
            "skins are ignored: meshes have their rest pose",
            "expected the file of an image in the folder of the glTF, found 'x.png': its surfaces keep their base colours",
            "emitted light is ignored (emissiveFactor)",
        ]
    );
}

/// Whether the replacement of `from` by `to` in the file leaves its faces unchanged.
fn is_unchanged(from: &str, to: &str) -> bool {
    assert!(TWO_MESHES.contains(from), "{from}");
    let read = |text: &str| read(text).unwrap_or_else(|error| panic!("{to}: {error}"));
    faces(&read(&TWO_MESHES.replacen(from, to, 1))) == faces(&read(TWO_MESHES))
}

#[test]
fn faults_in_ignored_parts_are_ignored() {
    let positions = "\"POSITION\": 0, \"NORMAL\"";
    for more in ["_FEATURE_ID_0", "_X", "CUSTOM", "TEXCOORD_0", "JOINTS_0"] {
        let to = format!("\"{more}\": 77, {positions}");
        assert!(is_unchanged(positions, &to));
    }
    let members = r#"
        "extensionsRequired": ["KHR_materials_unlit"]
        "extensionsRequired": ["KHR_texture_transform"]
        "extensionsRequired": ["EXT_texture_webp"]
        "extensionsRequired": ["KHR_texture_basisu"]
        "extensionsRequired": ["KHR_lights_punctual"]
        "extensionsRequired": ["KHR_mesh_quantization"]
        "textures": [{}, {"source": 9}]
        "images": [{"mimeType": 1}]
        "samplers": 7
        "images": [1]
        "textures": [{"source": -1}]
        "cameras": [{}]
        "skins": [{}]
        "animations": [{"channels": [{"target": {"path": "pointer"}}]}]
    "#;
    for [member] in rows(members) {
        let to = format!("{member}, \"scene\": 0");
        assert!(is_unchanged("\"scene\": 0", &to));
    }
    let limits = ", \"min\": [0, 0, 0], \"max\": [2, 2, 1]";
    assert!(is_unchanged(limits, ""));
    for texture in ["{\"index\": 5}", "{\"index\": -5}", "7", "[]"] {
        let texture = format!("\"baseColorTexture\": {texture}, \"baseColorFactor\"");
        assert!(is_unchanged("\"baseColorFactor\"", &texture), "{texture}");
    }
}

#[test]
fn required_extensions_of_the_shape_are_named() {
    for name in [
        "KHR_draco_mesh_compression",
        "EXT_meshopt_compression",
        "VENDOR_shapes",
    ] {
        let required = format!("\"extensionsRequired\": [\"{name}\"], \"scene\": 0");
        let error = error("\"scene\": 0", &required);
        assert!(error.ends_with(&format!("found '{name}'")), "{error}");
    }
}

/// First the extension of a node places one instance, scaled and moved by the last point of the
/// positions, (2, 2, 1); then it places two instances by the last two points.
#[test]
fn instances_of_a_mesh() {
    let views = "\"accessors\": [";
    let accessor = |offset: usize, kind: &str| {
        format!(
            "{{\"bufferView\": 0, \"byteOffset\": {offset}, \"componentType\": 5126, \"count\": 1, \"type\": \"{kind}\"}}, "
        )
    };
    let end = "\"type\": \"SCALAR\"}]";
    let more = [accessor(36, "VEC3"), accessor(36, "VEC3")].concat();
    let extension = "\"extensions\": {\"EXT_mesh_gpu_instancing\": {\"attributes\": {\"TRANSLATION\": 4, \"SCALE\": 5}}}, ";
    let text = TWO_MESHES
        .replacen(
            end,
            &format!("\"type\": \"SCALAR\"}}, {}]", more.trim_end_matches(", ")),
            1,
        )
        .replacen("{\"mesh\": 1, ", &format!("{{{extension}\"mesh\": 1, "), 1);
    assert!(text.contains(views));
    let instances = faces(&read(&text).unwrap());
    // (0, 0, 0) is scaled by (2, 2, 1), moved by (2, 2, 1), mirrored in x and moved by 10.
    assert_eq!(instances[0][0], [8, 2, 1]);
    assert_eq!(instances.len(), 4);
    let twice = text
        .replace("\"count\": 1,", "\"count\": 2,")
        .replace("\"byteOffset\": 36", "\"byteOffset\": 24");
    assert_eq!(faces(&read(&twice).unwrap()).len(), 6);
}

#[test]
fn hidden_nodes_and_colours_of_an_extension() {
    let hidden = "{\"extensions\": {\"KHR_node_visibility\": {\"visible\": false}}, \"mesh\": 1,";
    let polygons = read(&TWO_MESHES.replacen("{\"mesh\": 1,", hidden, 1)).unwrap();
    assert_eq!(faces(&polygons).len(), 2);
    assert_eq!(
        polygons.remarks,
        ["hidden nodes are left out (KHR_node_visibility)"]
    );
    let diffuse = "{\"extensions\": {\"KHR_materials_pbrSpecularGlossiness\": {\"diffuseFactor\": [1, 0, 0, 1]}}, \"pbrMetallicRoughness\"";
    let polygons = read(&TWO_MESHES.replacen("{\"pbrMetallicRoughness\"", diffuse, 1)).unwrap();
    assert_eq!(polygons.faces[3].colour, Some(Rgb8([255, 0, 0])));
}

/// The 16-bit sparse index at the start of view 3 is 0, so the first normal, (0, 0, 1), replaces
/// point 0.
#[test]
fn sparse_positions() {
    let sparse = "\"sparse\": {\"count\": 1, \"indices\": {\"bufferView\": 3, \"componentType\": 5123}, \"values\": {\"bufferView\": 1}}";
    let view = "{\"bufferView\": 0, ";
    let polygons = read(&TWO_MESHES.replacen(view, &format!("{view}{sparse}, "), 1)).unwrap();
    assert_eq!(faces(&polygons)[0], [[10, 0, 1], [10, 2, 0], [8, 0, 0]]);
    let zeros = TWO_MESHES.replacen(view, &format!("{{{sparse}, "), 1);
    let polygons = read(&zeros).unwrap();
    assert_eq!(faces(&polygons)[0], [[10, 0, 1], [10, 0, 0], [10, 0, 0]]);
    assert_eq!(
        read(&zeros.replacen("\"count\": 1,", "\"count\": 12,", 1))
            .unwrap_err()
            .to_string(),
        "expected accessor 0 within its buffer, found 12 values that end outside of it"
    );
    let wide = zeros.replacen("\"componentType\": 5123}", "\"componentType\": 5125}", 1);
    assert_eq!(
        read(&wide).unwrap_err().to_string(),
        "expected accessor 0 with sparse indices below 4, found 65536"
    );
}

#[test]
fn double_sided_materials() {
    let double = "\"doubleSided\": true, \"pbrMetallicRoughness\"";
    let polygons = read(&TWO_MESHES.replacen("\"pbrMetallicRoughness\"", double, 1)).unwrap();
    let sides: Vec<bool> = polygons
        .faces
        .iter()
        .map(|face| face.double_sided)
        .collect();
    assert_eq!(sides, [false, false, true, true]);
}

/// A square with two sets of texture coordinates: 32-bit floats from 0 to 1 in steps of 1/2, and
/// normalised bytes.
struct Textured {
    material: String,
    textures: String,
    images: String,
    samplers: String,
}

impl Textured {
    /// A square with the first texture, the first image and this material.
    fn new(material: &str, image: &str) -> Self {
        Self {
            material: material.into(),
            textures: "[{\"source\": 0}]".into(),
            images: format!("[{image}]"),
            samplers: "[]".into(),
        }
    }

    fn json(&self) -> String {
        let floats = [0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0]
            .into_iter()
            .chain([0.0, 1.0, 0.5, 1.0, 0.5, 0.0, 0.0, 0.0]);
        let mut bytes: Vec<u8> = floats.flat_map(f32::to_le_bytes).collect();
        bytes.extend([0, 255, 255, 255, 255, 0, 0, 51, 0, 1, 2, 0, 2, 3, 9, 9, 9]);
        let data = BASE64_STANDARD.encode(&bytes);
        let Self {
            material,
            textures,
            images,
            samplers,
        } = self;
        format!(
            "{{\"asset\": {{\"version\": \"2.0\"}}, \"scenes\": [{{\"nodes\": [0]}}], \"nodes\": [{{\"mesh\": 0}}],
            \"meshes\": [{{\"primitives\": [{{\"attributes\": {{\"POSITION\": 0, \"TEXCOORD_0\": 1, \"TEXCOORD_1\": 2}}, \"indices\": 3, \"material\": 0}}]}}],
            \"materials\": [{material}], \"textures\": {textures}, \"images\": {images}, \"samplers\": {samplers},
            \"buffers\": [{{\"byteLength\": {}, \"uri\": \"data:;base64,{data}\"}}],
            \"bufferViews\": [{{\"buffer\": 0, \"byteLength\": 94}}, {{\"buffer\": 0, \"byteOffset\": 94, \"byteLength\": 3}}, {{\"buffer\": 0, \"byteOffset\": 94, \"byteLength\": 4}}],
            \"accessors\": [{{\"bufferView\": 0, \"componentType\": 5126, \"count\": 4, \"type\": \"VEC3\"}},
            {{\"bufferView\": 0, \"byteOffset\": 48, \"componentType\": 5126, \"count\": 4, \"type\": \"VEC2\"}},
            {{\"bufferView\": 0, \"byteOffset\": 80, \"componentType\": 5121, \"normalized\": true, \"count\": 4, \"type\": \"VEC2\"}},
            {{\"bufferView\": 0, \"byteOffset\": 88, \"componentType\": 5121, \"count\": 6, \"type\": \"SCALAR\"}}]}}",
            bytes.len()
        )
    }

    fn read(&self) -> Polygons {
        let read = parse(self.json().as_bytes(), &mut |name| {
            (name == "a b.png").then(|| b"file".to_vec())
        });
        read.unwrap_or_else(|error| panic!("{error}: {}", self.json()))
    }
}

/// An image whose file exists.
const A_B: &str = r#"{"uri": "a%20b.png"}"#;

/// A material with the first texture. `more` adds members to the material, and `of_texture` adds
/// members to its texture.
fn material(more: &str, of_texture: &str) -> String {
    format!(
        "{{{more}\"pbrMetallicRoughness\": {{\"baseColorTexture\": {{\"index\": 0{of_texture}}}}}}}"
    )
}

/// The pictures of a file's textures.
fn pictures(polygons: &Polygons) -> Vec<&[u8]> {
    let textures = polygons.textures.iter();
    textures
        .map(|texture| match &texture.content {
            Content::Picture(bytes) => &bytes[..],
            Content::Board(_) | Content::White => panic!("a file has pictures"),
        })
        .collect()
}

#[test]
fn textures_from_files_data_and_buffers() {
    // The content determines the type of the picture.
    let data = r#"{"uri": "data:text/plain;base64,AQID", "mimeType": "image/x"}"#;
    let view = r#"{"bufferView": 1, "mimeType": "image/jpeg"}"#;
    for (image, picture, name) in [
        (A_B, &b"file"[..], "'a%20b.png'"),
        (data, &[1, 2, 3], "image 0"),
        (view, &[9; 3], "image 0"),
    ] {
        let polygons = Textured::new(&material("", ""), image).read();
        assert_eq!(pictures(&polygons), [picture]);
        assert_eq!(polygons.textures[0].name, name);
        assert_eq!(polygons.textures[0].cutoff, None);
        assert!(polygons.faces.iter().all(|face| face.texture == 1));
        assert!(polygons.remarks.is_empty());
        let set = [[0.0, 1.0], [0.5, 1.0], [0.5, 0.0], [0.0, 0.0]];
        assert_eq!(polygons.coordinates, set);
        let corners = polygons.corners.iter().map(|corner| corner.coordinates);
        assert_eq!(corners.collect::<Vec<_>>(), [0, 1, 2, 0, 2, 3]);
    }
}

#[test]
fn pictures_that_cannot_be_read_are_remarked() {
    let cases = r#"
        {"uri": "gone.png"} → expected the file of an image in the folder of the glTF, found 'gone.png'
        {"uri": "../a b.png"} → expected the file of an image in the folder of the glTF, found '../a b.png'
        {"uri": "data:image/png;base64,-"} → expected data of an image in base64, found 'data:image/png;base64,-'
        {"bufferView": 2} → expected image 0 within a buffer, found a view 2 outside of it
        {"bufferView": 7} → expected image 0 within a buffer, found a view 7 outside of it
        {} → expected image 0 with a URI or a view of a buffer, found neither
        → expected an image index below 0, found 0
    "#;
    for [image, expected] in rows(cases) {
        let polygons = Textured::new(&material("", ""), image).read();
        let expected = format!("{expected}: its surfaces keep their base colours");
        assert_eq!(polygons.remarks, [expected]);
        assert!(polygons.textures.is_empty());
        assert!(polygons.faces.iter().all(|face| face.texture == 0));
    }
    let mut other = Textured::new(&material("", ""), "{}");
    other.textures = r#"[{"extensions": {"KHR_texture_basisu": {"source": 0}}}]"#.into();
    let expected = "texture 0 has no PNG or JPEG file: its surfaces keep their base colours";
    assert_eq!(other.read().remarks, [expected]);
    other.textures = "[]".into();
    let expected =
        "expected a texture index below 0, found 0: its surfaces keep their base colours";
    assert_eq!(other.read().remarks, [expected]);
    let set = material("", ", \"texCoord\": 2");
    let expected =
        "no texture coordinates TEXCOORD_2 (up to 3 are read): surfaces keep their base colours";
    assert_eq!(Textured::new(&set, A_B).read().remarks, [expected]);
}

#[test]
fn samplers() {
    let mut file = Textured::new(&material("", ""), A_B);
    file.textures = r#"[{"source": 0, "sampler": 0}]"#.into();
    let cases = r#"
        {} → repeat repeat bilinear
        {"wrapS": 33071, "wrapT": 33648} → clamp mirror bilinear
        {"wrapS": 10497, "wrapT": 7} → repeat repeat bilinear
        {"magFilter": 9728, "minFilter": 9987} → repeat repeat nearest
        {"magFilter": 9729, "minFilter": 9728} → repeat repeat bilinear
        {"minFilter": 9984} → repeat repeat nearest
        {"minFilter": 9987} → repeat repeat bilinear
    "#;
    for [sampler, expected] in rows(cases) {
        file.samplers = format!("[{sampler}]");
        let found = file.read().textures[0].sampler;
        let [s, t] = found.wrap.map(wrap_name);
        let found = format!("{s} {t} {}", filter_name(found.filter));
        assert_eq!(found, expected, "{sampler}");
    }
    file.samplers = "[]".into();
    assert_eq!(file.read().textures.len(), 1);
}

#[test]
fn cut_out_by_the_mask() {
    let cutoff = |members: &str, opacity: &str| {
        let factor = "\"pbrMetallicRoughness\": {";
        let material = material(members, "").replace(factor, &format!("{factor}{opacity}"));
        Textured::new(&material, A_B).read().textures[0].cutoff
    };
    assert_eq!(cutoff("\"alphaMode\": \"OPAQUE\", ", ""), None);
    assert_eq!(cutoff("\"alphaMode\": \"BLEND\", ", ""), None);
    let mask = "\"alphaMode\": \"MASK\", ";
    assert_eq!(cutoff(mask, ""), Some(0.5));
    let quarter = format!("\"alphaCutoff\": 0.25, {mask}");
    assert_eq!(cutoff(&quarter, ""), Some(0.25));
    let opacity = |opacity: f32| format!("\"baseColorFactor\": [1, 1, 1, {opacity}], ");
    assert_eq!(cutoff(mask, &opacity(0.5)), Some(1.0));
    assert_eq!(cutoff(mask, &opacity(0.0)), Some(f32::INFINITY));
}

#[test]
fn opacities_of_blended_materials() {
    let read = |members: &str, opacity: &str| {
        let factor = "\"pbrMetallicRoughness\": {";
        let opacity = format!("\"baseColorFactor\": [1, 1, 1, {opacity}], ");
        let material = material(members, "").replace(factor, &format!("{factor}{opacity}"));
        Textured::new(&material, A_B).read()
    };
    let blended = "\"alphaMode\": \"BLEND\", ";
    assert_eq!(read(blended, "0.5").textures[0].opacity, Some(128));
    assert_eq!(read(blended, "1").textures[0].opacity, Some(255));
    assert_eq!(read(blended, "-3").textures[0].opacity, Some(0));
    assert_eq!(read("", "0.5").textures[0].opacity, None);
    // A blended material without a picture.
    let text = TWO_MESHES.replacen(
        "\"pbrMetallicRoughness\": {",
        "\"alphaMode\": \"BLEND\", \"pbrMetallicRoughness\": {",
        1,
    );
    let start = text.find("\"baseColorFactor\": [").unwrap();
    let end = start + text[start..].find(']').unwrap();
    let text = [
        &text[..start],
        "\"baseColorFactor\": [1, 0, 0, 0.25",
        &text[end..],
    ]
    .concat();
    let polygons = self::read(&text).unwrap();
    assert_eq!(polygons.textures.len(), 1);
    let texture = &polygons.textures[0];
    assert_eq!(
        (&texture.content, texture.opacity),
        (&Content::White, Some(64))
    );
    assert!(polygons.faces.iter().any(|face| face.texture == 1));
}

#[test]
fn transforms_of_textures() {
    let read = |of_texture: &str| {
        let polygons = Textured::new(&material("", of_texture), A_B).read();
        let coordinates = polygons.coordinates.iter();
        coordinates
            .map(|c| c.map(|c| (1e6 * c).round() / 1e6))
            .collect::<Vec<_>>()
    };
    let transformed = |transform: &str| {
        read(&format!(
            ", \"extensions\": {{\"KHR_texture_transform\": {{{transform}}}}}"
        ))
    };
    let second = [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.2]];
    assert_eq!(read(", \"texCoord\": 1"), second);
    assert_eq!(transformed("\"texCoord\": 1"), second);
    assert_eq!(
        transformed("\"offset\": [0.25, 2], \"scale\": [2, -1]"),
        [[0.25, 1.0], [1.25, 1.0], [1.25, 2.0], [0.25, 2.0]]
    );
    // The example from the extension's specification: the lower left quarter, rotated clockwise by
    // 90°.
    assert_eq!(
        transformed("\"offset\": [0, 1], \"rotation\": 1.57079632679, \"scale\": [0.5, 0.5]"),
        [[0.5, 1.0], [0.5, 0.75], [0.0, 0.75], [0.0, 1.0]]
    );
}

#[test]
fn several_materials_share_pictures() {
    let mut file = Textured::new("", A_B);
    let mask = material("\"alphaMode\": \"MASK\", ", "");
    file.material = [&material("", "")[..], &mask, &material("", "")].join(", ");
    let more = |number: u32| {
        format!(
            "{{\"attributes\": {{\"POSITION\": 0, \"TEXCOORD_0\": 1}}, \"material\": {number}}}, "
        )
    };
    let json = file.json().replace(
        "\"primitives\": [",
        &format!("\"primitives\": [{}{}", more(1), more(2)),
    );
    let mut reads = 0;
    let polygons = parse(json.as_bytes(), &mut |_| {
        reads += 1;
        Some(vec![])
    });
    let polygons = polygons.unwrap();
    assert_eq!(reads, 1);
    let textures: Vec<u8> = polygons.faces.iter().map(|face| face.texture).collect();
    assert_eq!(textures, [1, 2, 2, 2]);
    let cutoffs: Vec<_> = polygons.textures.iter().map(|one| one.cutoff).collect();
    assert_eq!(cutoffs, [Some(0.5), None]);
}
