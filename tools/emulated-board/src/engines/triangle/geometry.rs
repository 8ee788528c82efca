//! The geometry pass: computes descriptors, band lists and exceptions in memory from a mesh or segments in memory.

use glint_core::colour::Shading;
use glint_core::mesh::{Triangle, Vertex};
use glint_core::picture::Size;
use glint_core::records::TextureCoordinates;
use glint_model::line::Segment;
use glint_model::triangle::descriptor::Layout;
use glint_model::triangle::shade::Light;
use glint_model::triangle::vertex::{project, transform};
use glint_model::triangle::vertex_cache::{SLOTS, VertexCache};
use glint_model::triangle::{Path, Placed, light_of, texture_on};
use glint_model::{Options, Projected};
use litex_pac::triangle::{Counters, Error, Geometry, offset};

use super::output::{Output, OutputLimits};
use super::region::{Regions, WORD, picture_size, record};
use super::setup::Setup;
use super::time::{GeometryTime, Work};
use super::walk::Walk;
use crate::MainMemory;
use crate::engines::parameters::Parameters;

/// Results of the last pass; the fields have the names of the registers.
#[derive(Clone, Copy, Debug, Default)]
pub struct Results {
    pub triangles: u32,
    pub unseen: u32,
    pub culled: u32,
    pub descriptor_count: u32,
    pub exception_count: u32,
}

/// The geometry unit.
pub struct GeometryUnit {
    output: Output,
    /// Whether the output belongs to a frame that has not been cancelled.
    has_output: bool,
    pub results: Results,
}

impl GeometryUnit {
    pub fn new() -> Self {
        Self {
            output: Output::new(),
            has_output: false,
            results: Results::default(),
        }
    }

    /// Discards the output, so that the next pass starts with empty lists.
    pub const fn cancel(&mut self) {
        self.has_output = false;
    }

    /// Computes the results of a pass.
    ///
    /// # Errors
    /// The reason why the pass is refused; memory is then unchanged.
    pub fn run(
        &mut self,
        flags: Geometry,
        parameters: &Parameters,
        layout: Layout,
        ram: &mut MainMemory,
    ) -> Result<Work, Error> {
        let size = picture_size(flags.size()).ok_or(Error::Size)?;
        let room = OutputLimits::new(parameters, size, layout);
        let mesh = parameters.word(offset::MESH);
        let words = parameters.word(offset::MESH_BYTES) / WORD;
        let mut regions = Regions::default();
        regions.check(mesh, words.into());
        room.check(&mut regions);
        regions.result()?;

        let continues = flags.append() && self.has_output;
        self.output.open(room, continues);
        self.has_output = true;
        self.results = Results::default();
        let first = mesh / WORD;
        let mut walk = Walk::new(first, u64::from(first) + u64::from(words));
        let time = if flags.lines() {
            self.draw_lines(&mut walk, size, ram)
        } else {
            let flags = flags.with_smooth(flags.smooth() && layout.is_smooth);
            let setup = Setup::new(flags, parameters, size);
            let textures = Textures {
                is_drawn: flags.textures() && layout.is_textured && !flags.smooth(),
                coordinates: parameters.word(offset::COORDINATES),
                before: parameters.unsigned(offset::FIRST_TEXTURE, 8) as u8,
            };
            self.draw_mesh(&mut walk, &setup, &textures, size, ram)
        };
        let written = self.output.write(ram);
        self.results.descriptor_count = self.output.descriptors();
        self.results.exception_count = self.output.exceptions();
        let error = if walk.is_damaged {
            Error::Mesh
        } else if self.output.is_full() {
            Error::Full
        } else {
            Error::None
        };
        Ok(Work {
            error,
            cycles: time.cycles(),
            counters: Counters {
                vertices: time.vertices,
                items_in: walk.words.wrapping_add(time.vertices),
                items_out: written,
                ..Counters::default()
            },
        })
    }

    fn draw_mesh(
        &mut self,
        walk: &mut Walk,
        setup: &Setup,
        textures: &Textures,
        size: Size,
        ram: &MainMemory,
    ) -> GeometryTime {
        let mut time = GeometryTime::new(setup.shading);
        time.has_textures = textures.is_drawn;
        let frame = &setup.frame;
        let options = Options {
            cull: setup.cull,
            light: Some(&setup.light),
            colour: setup.colour,
            shading: setup.shading,
            ..Options::default()
        };

        let (mut lists, exceptions) = self.output.parts(size);
        let results = &mut self.results;
        let mut vertices = [(Projected::Behind, Light::default()); SLOTS];
        while let Some(chunk) = walk.chunk(ram) {
            let mut cache = VertexCache::empty();
            for number in chunk.triangles {
                let triangle = Triangle::from_bytes(&record(ram, number));
                // Each corner is read before the next corner may replace its vertex in the cache.
                let corners = triangle.indices.map(|index| {
                    let slot = &mut vertices[usize::from(index) % SLOTS];
                    if cache.misses(index) {
                        let place = chunk.vertices.wrapping_add(index.into());
                        let vertex = Vertex::from_bytes(&record(ram, place));
                        *slot = (
                            project(frame, &transform(frame, vertex.position)),
                            match setup.shading {
                                Shading::Flat => Light::default(),
                                Shading::Smooth => light_of(frame, &options, &vertex),
                            },
                        );
                        time.vertices += 1;
                    }
                    *slot
                });
                let light =
                    (setup.shading == Shading::Smooth).then(|| corners.map(|corner| corner.1));
                match Path::of(frame, corners.each_ref().map(|corner| &corner.0)) {
                    Path::Unseen => results.unseen += 1,
                    Path::Exception => exceptions.put(results.triangles),
                    Path::Regular(places) => {
                        match Placed::new(frame, &options, &triangle, places, light.as_ref()) {
                            Some(placed) => {
                                let setup = placed.setup();
                                let texture = textures.of(ram, chunk.first, &triangle);
                                let texture = texture.map(|(number, coordinates)| {
                                    let texture = (number, &coordinates);
                                    texture_on(
                                        frame, &options, &triangle, places, texture, &placed,
                                        &setup,
                                    )
                                });
                                lists.put(&setup, placed.colour, texture.as_ref());
                                time.drawn += 1;
                            }
                            None => results.culled += 1,
                        }
                    }
                }
                results.triangles += 1;
            }
        }
        time.triangles = results.triangles;
        time
    }

    fn draw_lines(&mut self, walk: &mut Walk, size: Size, ram: &MainMemory) -> GeometryTime {
        let mut time = GeometryTime::new(Shading::Flat);
        let (mut lists, _) = self.output.parts(size);
        let mut first = None;
        while let Some(chunk) = walk.chunk(ram) {
            for number in chunk.triangles {
                let half = record(ram, number);
                let Some(begin) = first.take() else {
                    first = Some(half);
                    continue;
                };
                let halves = [begin, half];
                let mut words = halves.as_flattened().as_chunks().0.iter();
                let segment = Segment::from_words(std::array::from_fn(|_| {
                    words.next().map_or(0, |word| u32::from_le_bytes(*word))
                }));
                let mut pieces = 0;
                for piece in segment.pieces(size) {
                    lists.put_piece(&piece);
                    pieces += 1;
                }
                time.add_line(&segment, pieces);
            }
        }
        time
    }
}

/// The textures of the mesh of a pass.
struct Textures {
    is_drawn: bool,
    /// Address of the vertices' texture coordinates.
    coordinates: u32,
    /// Offset that is added to a texture number of the mesh, which begins at 1, to get the number
    /// in the frame's table.
    before: u8,
}

impl Textures {
    /// The number of a triangle's texture in the frame's table, and the texture coordinates of its
    /// vertices; `None` without a texture. `first` is the index in the mesh of the first vertex of
    /// the triangle's chunk.
    fn of(&self, ram: &MainMemory, first: u32, triangle: &Triangle) -> Option<(u8, [[i32; 2]; 3])> {
        if !self.is_drawn || triangle.texture == 0 {
            return None;
        }
        let coordinates = triangle.indices.map(|index| {
            let vertex = first.wrapping_add(index.into());
            let place = TextureCoordinates::BYTES as u32 * vertex;
            let bytes = ram.array(self.coordinates.wrapping_add(place));
            let element = bytes.map(|bytes| TextureCoordinates::from_bytes(&bytes));
            let TextureCoordinates { s, t } = element.unwrap_or_default();
            [s, t]
        });
        Some((triangle.texture.wrapping_add(self.before), coordinates))
    }
}
