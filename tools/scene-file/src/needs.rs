//! Gateware and firmware that scenes require.

use std::collections::BTreeSet;

use glint_core::block::Block;
use glint_core::camera::Projection;
use glint_core::colour::{Shading, Winding};
use glint_core::feature::{
    ANTIALIASING, CPU, DEMO, Feature, GESTURE, IMU, MESH, SKY, SPHERES, TEXTURE, UPLOAD,
};
use glint_core::field::{Field, Flat, Primitive, Solid};
use glint_core::fixed::U4_28;
use glint_core::light::{Background, Material};
use glint_core::picture::{Backend, Samples};
use glint_core::shape::Shape;
use glint_model::{Clip, MeshOptions};
use litex_pac::raymarch::Kind;

use crate::scene::SceneFile;

/// Default number of lanes of the raymarcher.
const LANES: u8 = 2;

/// Features that a raymarcher must have: the options `--fields` and `--lanes` of `cargo xtask gateware`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fields {
    /// Evaluations of the field per clock cycle.
    pub lanes: u8,
    /// Maximum recursion depth of a Menger sponge; 0 without sponges.
    pub levels: u8,
    /// Names of the fields with flat faces, except the sponge.
    pub flat: BTreeSet<&'static str>,
    /// A field that is a list of spheres.
    pub spheres: bool,
    /// A field that is a lattice of spheres.
    pub lattice: bool,
    /// Fillets between spheres and flat fields.
    pub fillets: bool,
    /// Stereo pictures: one view for each eye.
    pub stereo: bool,
    /// Spheres that are coloured by their normals.
    pub normals: bool,
    /// A highlight on spheres.
    pub highlight: bool,
    /// A solid cone.
    pub cone: bool,
    /// Shadows on faces.
    pub shadow: bool,
}

/// Gateware and firmware that scenes require.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Needs {
    /// The optional blocks.
    pub blocks: BTreeSet<Block>,
    /// The required parts of the firmware: names of its Cargo features.
    pub features: BTreeSet<Feature>,
    /// Smooth shading in the triangle engine.
    pub smooth: bool,
    /// Textures in the triangle engine, which draws them under flat light.
    pub texture: bool,
    /// The sky behind meshes in the triangle engine.
    pub sky: bool,
    /// The fog on meshes in the triangle engine.
    pub fog: bool,
    /// Pictures with four samples a pixel.
    pub antialiasing: bool,
    /// The geometry pass of the triangle engine, which lines and most meshes require.
    pub geometry: bool,
    /// The depth buffer in memory, which triangles and depth codes require.
    pub depths: bool,
    /// The raymarcher's features.
    pub fields: Option<Fields>,
}

impl SceneFile {
    /// The requirements of the scene; for a list of scenes, the requirements of all its scenes.
    pub fn needs(&self) -> Needs {
        if !self.scenes().is_empty() {
            let mut needs = Needs::of(self.scenes());
            needs.features.insert(DEMO);
            needs.blocks.insert(Block::Digits);
            if let (Some(fields), Some(lanes)) = (&mut needs.fields, self.lanes) {
                fields.lanes = lanes;
            }
            needs.depths |= self.depth;
            return needs;
        }
        let scene = self.scene();
        let mut blocks: BTreeSet<Block> = Block::of_bits(scene.blocks()).collect();
        for (feature, block) in [(GESTURE, Block::Gesture), (IMU, Block::I2C)] {
            if self.features().contains(&feature) {
                blocks.insert(block);
            }
        }
        let has = |block| blocks.contains(&block);
        let (has_triangles, has_fields) = (has(Block::Triangle), has(Block::Raymarch));
        let fields = scene.field.filter(|_| has_fields).map(|field| {
            let fields = Fields::of(&field);
            let appearance = &scene.appearance;
            Fields {
                lanes: self.lanes.unwrap_or(LANES),
                // A scene with a mesh in a field is drawn for one eye after the other, without the
                // raymarcher's stereo.
                stereo: scene.stereo.is_some() && !has_triangles,
                normals: field.is_round() && appearance.material == Material::Normal,
                highlight: field.is_round() && appearance.has_highlight(),
                shadow: fields.shadow && !fields.fillets && appearance.has_shadows(),
                ..fields
            }
        });
        let features = self.needed_features();
        Needs {
            smooth: scene.options.shading == Shading::Smooth && has_triangles,
            texture: scene.options.textures
                && scene.options.shading == Shading::Flat
                && has_triangles
                && self.features().contains(&TEXTURE),
            // A raymarcher draws the sky behind a field.
            sky: has_triangles && !has_fields && features.contains(&SKY),
            fog: has_triangles && scene.appearance.fog != U4_28::ZERO,
            antialiasing: features.contains(&ANTIALIASING),
            // For other meshes the soft core computes the triangle descriptors.
            geometry: has(Block::Line)
                || has_triangles
                    && self.geometry
                    && scene.options.clip == Clip::Guard
                    && scene.options.winding == Winding::Mesh,
            depths: has_triangles || self.depth,
            fields,
            blocks,
            features,
        }
    }

    /// The parts of the firmware that execute the scene's commands and draw its picture.
    fn needed_features(&self) -> BTreeSet<Feature> {
        let (scene, meshes) = (self.scene(), self.meshes());
        let mut features = self.features().clone();
        if !meshes.is_empty() {
            features.insert(MESH);
        }
        if !meshes
            .iter()
            .all(|mesh| Shape::NAMES.contains(&mesh.as_str()))
            || scene.texture.is_some()
        {
            features.insert(UPLOAD);
        }
        if scene
            .appearance
            .background
            .and_then(Background::gradient)
            .is_some()
        {
            features.insert(SKY);
        }
        if scene.samples() == Samples::Four {
            features.insert(ANTIALIASING);
        }
        if scene.field.is_some_and(|field| field.is_round()) {
            features.insert(SPHERES);
        }
        let MeshOptions {
            cull,
            clip,
            winding,
            textures,
            shading,
        } = scene.options;
        // The soft core computes the descriptors of such meshes, or draws the whole picture.
        if scene.backend == Backend::Cpu
            || !self.geometry
            || !cull
            || textures && shading == Shading::Smooth && features.contains(&TEXTURE)
            || clip != Clip::Guard
            || winding == Winding::Screen
            || scene.view.projection() == Projection::Orthographic
            || (scene.field).is_some_and(|field| field.is_left_to_soft_core())
        {
            features.insert(CPU);
        }
        features
    }
}

impl Needs {
    /// The combined requirements of several scenes. If their numbers of lanes differ, two lanes are
    /// required.
    pub fn of(scenes: &[SceneFile]) -> Self {
        scenes
            .iter()
            .map(SceneFile::needs)
            .reduce(Self::with)
            .unwrap_or_default()
    }

    fn with(self, other: Self) -> Self {
        Self {
            blocks: &self.blocks | &other.blocks,
            features: &self.features | &other.features,
            smooth: self.smooth || other.smooth,
            texture: self.texture || other.texture,
            sky: self.sky || other.sky,
            fog: self.fog || other.fog,
            antialiasing: self.antialiasing || other.antialiasing,
            geometry: self.geometry || other.geometry,
            depths: self.depths || other.depths,
            fields: match (self.fields, other.fields) {
                (Some(one), Some(other)) => Some(one.with(&other)),
                (one, other) => one.or(other),
            },
        }
    }

    /// The options of `cargo xtask gateware` for gateware with exactly these features.
    pub fn options(&self) -> Vec<String> {
        let mut options = vec!["--blocks".to_owned()];
        options.extend(self.blocks.iter().map(|block| block.name().to_owned()));
        if self.smooth {
            options.push("--smooth".to_owned());
        }
        // Gateware with smooth shading leaves textures to the soft core.
        if self.texture && !self.smooth {
            options.push("--texture".to_owned());
        }
        let has = |block| self.blocks.contains(&block);
        if has(Block::Triangle) && !self.sky {
            options.push("--no-sky".to_owned());
        }
        if self.fog {
            options.push("--fog".to_owned());
        }
        let engine = [Block::Triangle, Block::Line, Block::Raymarch];
        if engine.into_iter().any(has) && !self.antialiasing {
            options.push("--no-antialiasing".to_owned());
        }
        if has(Block::Triangle) && !self.geometry {
            options.push("--no-geometry".to_owned());
        }
        if (has(Block::Line) || has(Block::Raymarch)) && !self.depths {
            options.push("--no-depths".to_owned());
        }
        if let Some(fields) = &self.fields {
            options.extend([
                "--fields".to_owned(),
                fields.names(),
                "--lanes".to_owned(),
                fields.lanes.to_string(),
            ]);
        }
        options
    }
}

impl Fields {
    /// The features that a field requires, for one eye and with shadows.
    fn of(field: &Field) -> Self {
        let none = Self {
            lanes: LANES,
            levels: 0,
            flat: BTreeSet::new(),
            spheres: false,
            lattice: false,
            fillets: false,
            stereo: false,
            normals: false,
            highlight: false,
            cone: false,
            shadow: false,
        };
        match field {
            Field::Primitive(primitive) => none.and(primitive),
            Field::Union(union) => Self {
                fillets: union.blend() != 0,
                ..none.and(union.first()).and(union.spheres())
            },
        }
    }

    fn and(mut self, primitive: &Primitive) -> Self {
        match primitive.placed().solid {
            Solid::Spheres(spheres) if spheres.repeated => self.lattice = true,
            Solid::Spheres(spheres) => {
                self.spheres = true;
                self.cone |= spheres.cone.is_some();
            }
            Solid::Flat(flat) => self.add(&flat),
        }
        self
    }

    fn add(&mut self, flat: &Flat) {
        let constants = flat.constants();
        match Kind::from_bits(constants.kind) {
            Some(Kind::Menger) | None => {
                let levels = 8 - constants.levels.leading_zeros() as u8;
                self.levels = self.levels.max(levels);
                self.shadow = true;
            }
            Some(kind) => {
                self.flat.insert(kind.name());
                self.shadow |= constants.repeated;
            }
        }
    }

    fn with(self, other: &Self) -> Self {
        Self {
            lanes: if self.lanes == other.lanes {
                self.lanes
            } else {
                LANES
            },
            levels: self.levels.max(other.levels),
            flat: &self.flat | &other.flat,
            spheres: self.spheres || other.spheres,
            lattice: self.lattice || other.lattice,
            fillets: self.fillets || other.fillets,
            stereo: self.stereo || other.stereo,
            normals: self.normals || other.normals,
            highlight: self.highlight || other.highlight,
            cone: self.cone || other.cone,
            shadow: self.shadow || other.shadow,
        }
    }

    /// The value of the option `--fields`.
    pub fn names(&self) -> String {
        let mut names = Vec::new();
        if self.levels > 0 {
            names.push(format!("{}:{}", Kind::Menger.name(), self.levels));
        }
        names.extend(self.flat.iter().map(|name| (*name).to_owned()));
        let features = [
            ("spheres", self.spheres),
            ("lattice", self.lattice),
            ("fillets", self.fillets),
            ("stereo", self.stereo),
            ("normals", self.normals),
            ("highlight", self.highlight),
            ("shadow", self.shadow),
            ("cone", self.cone),
        ];
        let built = features.into_iter().filter(|(_, is_built)| *is_built);
        names.extend(built.map(|(name, _)| name.to_owned()));
        names.join(",")
    }
}
