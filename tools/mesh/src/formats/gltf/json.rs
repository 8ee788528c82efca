//! The parts of a glTF's JSON that Glint reads. All other parts are skipped without a check, so
//! that a fault in them does not reject a file. Invalid textures count as missing, because a mesh
//! is useful without textures.

use crate::error::FormatError;
use serde::Deserialize;
use serde::de::{Deserializer, IgnoredAny};

/// Index into a list of [`Root`].
pub type Index = u32;

/// Returns the item of a list at `index`.
///
/// # Errors
/// The index is out of range; the error states `name`, the name of the list.
pub fn item<'a, T>(list: &'a [T], index: Index, name: &str) -> Result<&'a T, FormatError> {
    list.get(index as usize).ok_or_else(|| {
        FormatError::whole(
            format!("an index below {} in the list of {name}", list.len()),
            index.to_string(),
        )
    })
}

/// Reads a value; a value of another type counts as missing.
fn if_valid<'de, D: Deserializer<'de>, T: Default + Deserialize<'de>>(
    deserializer: D,
) -> Result<T, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged)]
    enum Form<T> {
        Valid(T),
        Other(IgnoredAny),
    }
    Form::deserialize(deserializer).map(|form| match form {
        Form::Valid(value) => value,
        Form::Other(_) => T::default(),
    })
}

#[derive(Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub struct Root {
    pub accessors: Vec<Accessor>,
    pub animations: Vec<IgnoredAny>,
    pub buffer_views: Vec<View>,
    pub buffers: Vec<Buffer>,
    pub extensions_required: Vec<String>,
    #[serde(deserialize_with = "if_valid")]
    pub images: Vec<Image>,
    pub materials: Vec<Material>,
    pub meshes: Vec<Mesh>,
    pub nodes: Vec<Node>,
    #[serde(deserialize_with = "if_valid")]
    pub samplers: Vec<Sampler>,
    pub scene: Option<Index>,
    pub scenes: Vec<Scene>,
    #[serde(deserialize_with = "if_valid")]
    pub textures: Vec<Texture>,
}

/// A picture: data or a file by its URI, or a part of a buffer.
#[derive(Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub struct Image {
    pub buffer_view: Option<Index>,
    pub uri: Option<String>,
}

/// Wrap modes and filters of a texture, as OpenGL constants.
#[derive(Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub struct Sampler {
    pub mag_filter: Option<u32>,
    pub min_filter: Option<u32>,
    pub wrap_s: Option<u32>,
    pub wrap_t: Option<u32>,
}

#[derive(Default, Deserialize)]
#[serde(default)]
pub struct Texture {
    pub sampler: Option<Index>,
    pub source: Option<Index>,
}

/// The use of a texture by a material.
#[derive(Clone, Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub struct TextureUse {
    pub index: Index,
    pub tex_coord: u32,
    pub extensions: TextureExtensions,
}

#[derive(Clone, Default, Deserialize)]
pub struct TextureExtensions {
    #[serde(rename = "KHR_texture_transform")]
    pub transform: Option<Transform>,
}

/// A transform of texture coordinates: first scale, then rotation, then offset.
#[derive(Clone, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub struct Transform {
    pub offset: [f32; 2],
    pub rotation: f32,
    pub scale: [f32; 2],
    pub tex_coord: Option<u32>,
}

impl Default for Transform {
    fn default() -> Self {
        Self {
            offset: [0.0; 2],
            rotation: 0.0,
            scale: [1.0; 2],
            tex_coord: None,
        }
    }
}

#[derive(Deserialize)]
pub struct Scene {
    #[serde(default)]
    pub nodes: Vec<Index>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Buffer {
    pub byte_length: usize,
    pub uri: Option<String>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct View {
    pub buffer: Index,
    pub byte_length: usize,
    #[serde(default)]
    pub byte_offset: usize,
    #[serde(default)]
    pub byte_stride: usize,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Accessor {
    pub buffer_view: Option<Index>,
    #[serde(default)]
    pub byte_offset: usize,
    pub component_type: u32,
    pub count: usize,
    #[serde(default)]
    pub normalized: bool,
    pub sparse: Option<Box<Sparse>>,
    #[serde(rename = "type")]
    pub dimensions: Dimensions,
}

/// Number of components of a value, named by its type in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub enum Dimensions {
    Scalar,
    Vec2,
    Vec3,
    Vec4,
    #[serde(other)]
    Other,
}

/// The values of an accessor that differ from the values in its view, or from 0 if it has no view.
#[derive(Deserialize)]
pub struct Sparse {
    pub count: usize,
    pub indices: SparseIndices,
    pub values: SparseValues,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct SparseIndices {
    pub buffer_view: Index,
    #[serde(default)]
    pub byte_offset: usize,
    pub component_type: u32,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct SparseValues {
    pub buffer_view: Index,
    #[serde(default)]
    pub byte_offset: usize,
}

#[derive(Deserialize)]
pub struct Mesh {
    pub primitives: Vec<Primitive>,
}

#[derive(Deserialize)]
pub struct Primitive {
    pub attributes: Attributes,
    pub indices: Option<Index>,
    pub material: Option<Index>,
    #[serde(default)]
    pub mode: Mode,
    #[serde(default)]
    pub targets: Vec<IgnoredAny>,
}

#[derive(Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub struct Attributes {
    pub position: Option<Index>,
    pub normal: Option<Index>,
    pub color_0: Option<Index>,
    pub texcoord_0: Option<Index>,
    pub texcoord_1: Option<Index>,
    pub texcoord_2: Option<Index>,
    pub texcoord_3: Option<Index>,
}

impl Attributes {
    /// The accessor of a set of texture coordinates.
    pub fn coordinates(&self, set: u32) -> Option<Index> {
        match set {
            0 => self.texcoord_0,
            1 => self.texcoord_1,
            2 => self.texcoord_2,
            3 => self.texcoord_3,
            _ => None,
        }
    }
}

/// How the corners of a primitive form triangles.
#[derive(Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(try_from = "u32")]
pub enum Mode {
    PointsOrLines,
    #[default]
    Triangles,
    TriangleStrip,
    TriangleFan,
}

impl TryFrom<u32> for Mode {
    type Error = String;

    fn try_from(mode: u32) -> Result<Self, String> {
        match mode {
            0..=3 => Ok(Self::PointsOrLines),
            4 => Ok(Self::Triangles),
            5 => Ok(Self::TriangleStrip),
            6 => Ok(Self::TriangleFan),
            _ => Err(format!("mode {mode} of a primitive")),
        }
    }
}

#[derive(Deserialize)]
#[serde(default)]
pub struct Node {
    pub children: Vec<Index>,
    pub extensions: NodeExtensions,
    pub matrix: Option<Box<[f32; 16]>>,
    pub mesh: Option<Index>,
    pub rotation: [f32; 4],
    pub scale: [f32; 3],
    pub skin: Option<IgnoredAny>,
    pub translation: [f32; 3],
}

impl Default for Node {
    fn default() -> Self {
        Self {
            children: Vec::new(),
            extensions: NodeExtensions::default(),
            matrix: None,
            mesh: None,
            rotation: [0.0, 0.0, 0.0, 1.0],
            scale: [1.0; 3],
            skin: None,
            translation: [0.0; 3],
        }
    }
}

#[derive(Default, Deserialize)]
pub struct NodeExtensions {
    #[serde(rename = "EXT_mesh_gpu_instancing")]
    pub instancing: Option<Box<Instancing>>,
    #[serde(rename = "KHR_node_visibility")]
    pub visibility: Option<Visibility>,
}

#[derive(Deserialize)]
pub struct Instancing {
    pub attributes: InstanceAttributes,
}

#[derive(Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub struct InstanceAttributes {
    pub translation: Option<Index>,
    pub rotation: Option<Index>,
    pub scale: Option<Index>,
}

#[derive(Deserialize)]
pub struct Visibility {
    #[serde(default = "visible")]
    pub visible: bool,
}

fn visible() -> bool {
    true
}

#[derive(Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub struct Material {
    pub alpha_cutoff: Option<f32>,
    pub alpha_mode: Option<String>,
    pub double_sided: bool,
    pub emissive_factor: [f32; 3],
    pub extensions: MaterialExtensions,
    pub pbr_metallic_roughness: MetallicRoughness,
}

impl Material {
    /// The texture of the base colour, and the factor of its colours and opacity.
    pub fn base(&self) -> (Option<&TextureUse>, [f32; 4]) {
        match &self.extensions.specular_glossiness {
            Some(diffuse) => (diffuse.diffuse_texture.as_ref(), diffuse.diffuse_factor),
            None => {
                let base = &self.pbr_metallic_roughness;
                (base.base_color_texture.as_ref(), base.base_color_factor)
            }
        }
    }
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub struct MetallicRoughness {
    pub base_color_factor: [f32; 4],
    #[serde(deserialize_with = "if_valid")]
    pub base_color_texture: Option<TextureUse>,
}

impl Default for MetallicRoughness {
    fn default() -> Self {
        Self {
            base_color_factor: [1.0; 4],
            base_color_texture: None,
        }
    }
}

#[derive(Default, Deserialize)]
pub struct MaterialExtensions {
    #[serde(rename = "KHR_materials_pbrSpecularGlossiness")]
    pub specular_glossiness: Option<SpecularGlossiness>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub struct SpecularGlossiness {
    pub diffuse_factor: [f32; 4],
    #[serde(deserialize_with = "if_valid")]
    pub diffuse_texture: Option<TextureUse>,
}

impl Default for SpecularGlossiness {
    fn default() -> Self {
        Self {
            diffuse_factor: [1.0; 4],
            diffuse_texture: None,
        }
    }
}
