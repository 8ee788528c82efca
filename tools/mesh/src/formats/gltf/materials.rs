//! Textures of a glTF's materials.

use super::buffers::{Beside, Buffers, load};
use super::json::{self, Index, Material, Root, Transform};
use crate::error::{FormatError, quote};
use crate::polygons::{Content, Polygons, Texture};
use glint_core::texture::{Filter, Sampler, Wrap};
use std::collections::HashMap;
use std::sync::Arc;

/// Default alpha cutoff of a material.
const CUTOFF: f32 = 0.5;
/// End of the remark on a texture that cannot be used.
const INSTEAD: &str = "its surfaces keep their base colours";

/// Picture, wrap modes and filter, bits of the cutoff, and opacity of a texture.
type Key = (Index, [u8; 3], Option<u32>, Option<u8>);

/// Reads the textures of materials, and each picture only once.
pub struct Materials<'a> {
    root: &'a Root,
    buffers: &'a Buffers<'a>,
    beside: Beside<'a>,
    /// The pictures that were requested; `None` for a picture that cannot be read.
    pictures: HashMap<Index, Option<Arc<Vec<u8>>>>,
    /// The numbers of the textures.
    numbers: HashMap<Key, u8>,
}

/// The use of a texture by a material.
pub struct Use {
    /// The number of the texture in the polygons, counted from 1.
    pub texture: u8,
    /// The number of the set of texture coordinates.
    pub set: u32,
    transform: Transform,
}

impl Use {
    /// Applies the transform of the texture to coordinates.
    pub fn transformed(&self, [s, t]: [f64; 2]) -> [f64; 2] {
        let Transform {
            offset,
            rotation,
            scale,
            ..
        } = &self.transform;
        let [s, t] = [s * f64::from(scale[0]), t * f64::from(scale[1])];
        let (sin, cos) = f64::from(*rotation).sin_cos();
        // The rotation is counter-clockwise, and t points down.
        [
            f64::from(offset[0]) + s * cos + t * sin,
            f64::from(offset[1]) - s * sin + t * cos,
        ]
    }
}

impl<'a> Materials<'a> {
    /// The materials of a file; `beside` reads a picture in the same folder.
    pub fn new(root: &'a Root, buffers: &'a Buffers<'a>, beside: Beside<'a>) -> Self {
        Self {
            root,
            buffers,
            beside,
            pictures: HashMap::new(),
            numbers: HashMap::new(),
        }
    }

    /// Adds the texture of a material, if any, to the polygons. For a texture that cannot be used
    /// it adds a remark.
    ///
    /// # Errors
    /// There are too many textures.
    pub fn texture(
        &mut self,
        material: &Material,
        polygons: &mut Polygons,
    ) -> Result<Option<Use>, FormatError> {
        let (used, [.., opacity]) = material.base();
        let Some(used) = used else {
            return Ok(None);
        };
        let Some(texture) = self.root.textures.get(used.index as usize) else {
            let count = self.root.textures.len();
            polygons.remark(format!(
                "expected a texture index below {count}, found {}: {INSTEAD}",
                used.index
            ));
            return Ok(None);
        };
        let Some(source) = texture.source else {
            polygons.remark(format!(
                "texture {} has no PNG or JPEG file: {INSTEAD}",
                used.index
            ));
            return Ok(None);
        };
        let sampler = texture.sampler;
        let sampler = sampler.and_then(|index| self.root.samplers.get(index as usize));
        let sampler = sampler_of(sampler);
        let blended = blended_opacity(material);
        let cutoff = (material.alpha_mode.as_deref() == Some("MASK")).then(|| {
            // The opacity of the material multiplies the opacity of the texels.
            let cutoff = material.alpha_cutoff.unwrap_or(CUTOFF);
            if opacity > 0.0 || cutoff <= 0.0 {
                cutoff / opacity.max(f32::MIN_POSITIVE)
            } else {
                f32::INFINITY
            }
        });
        let Sampler {
            wrap: [wrap_s, wrap_t],
            filter,
        } = sampler;
        let key = (
            source,
            [wrap_s as u8, wrap_t as u8, filter as u8],
            cutoff.map(f32::to_bits),
            blended,
        );
        let number = match self.numbers.get(&key) {
            Some(&number) => number,
            None => {
                let number = match self.picture(source, polygons) {
                    None => 0,
                    Some(picture) => polygons.add_texture(Texture {
                        name: self.name(source),
                        content: Content::Picture(picture),
                        sampler,
                        cutoff,
                        opacity: blended,
                    })?,
                };
                self.numbers.insert(key, number);
                number
            }
        };
        if number == 0 {
            return Ok(None);
        }
        let transform = used.extensions.transform.clone().unwrap_or_default();
        Ok(Some(Use {
            texture: number,
            set: transform.tex_coord.unwrap_or(used.tex_coord),
            transform,
        }))
    }

    /// The bytes of a picture. Returns `None` and adds a remark if the picture cannot be read.
    fn picture(&mut self, index: Index, polygons: &mut Polygons) -> Option<Arc<Vec<u8>>> {
        if let Some(picture) = self.pictures.get(&index) {
            return picture.clone();
        }
        let found = match self.root.images.get(index as usize) {
            None => {
                let expected = format!("an image index below {}", self.root.images.len());
                Err(FormatError::whole(expected, index.to_string()))
            }
            Some(image) => match (image.buffer_view, &image.uri) {
                (Some(view), _) => self.buffers.view(view).map(<[u8]>::to_vec).ok_or_else(|| {
                    let found = format!("a view {view} outside of it");
                    FormatError::whole(format!("image {index} within a buffer"), found)
                }),
                (None, Some(uri)) => load(uri, "an image", &mut *self.beside),
                (None, None) => {
                    let expected = format!("image {index} with a URI or a view of a buffer");
                    Err(FormatError::whole(expected, "neither"))
                }
            },
        };
        let picture = found.map_err(|error| polygons.remark(format!("{error}: {INSTEAD}")));
        let picture = picture.ok().map(Arc::new);
        self.pictures.insert(index, picture.clone());
        picture
    }

    /// The name of a picture for messages.
    fn name(&self, index: Index) -> String {
        let image = self.root.images.get(index as usize);
        match image.and_then(|image| image.uri.as_deref()) {
            Some(uri) if !uri.starts_with("data:") => quote(uri.as_bytes()),
            _ => format!("image {index}"),
        }
    }
}

/// Opacity of a material that is blended with the picture behind it, 0 to 255.
pub fn blended_opacity(material: &Material) -> Option<u8> {
    let (_, [.., opacity]) = material.base();
    // The conversion to an integer saturates.
    (material.alpha_mode.as_deref() == Some("BLEND")).then_some((opacity * 255.0).round() as u8)
}

/// Converts a sampler of OpenGL constants; an unknown constant counts as missing. The default
/// filter is the one that most viewers use.
fn sampler_of(sampler: Option<&json::Sampler>) -> Sampler {
    let wrap = |number: Option<u32>| match number {
        Some(33_071) => Wrap::Clamp,
        Some(33_648) => Wrap::Mirror,
        _ => Wrap::Repeat,
    };
    let Some(sampler) = sampler else {
        return Sampler {
            wrap: [Wrap::Repeat; 2],
            filter: Filter::Bilinear,
        };
    };
    // The magnification filter counts or, without it, the minification filter: 9984 and 9986 select
    // the nearest texel within a level.
    let filter = match sampler.mag_filter.or(sampler.min_filter) {
        Some(9728 | 9984 | 9986) => Filter::Nearest,
        _ => Filter::Bilinear,
    };
    Sampler {
        wrap: [wrap(sampler.wrap_s), wrap(sampler.wrap_t)],
        filter,
    }
}
