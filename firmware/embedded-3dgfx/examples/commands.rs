//! Three scenes of the crate `embedded-3dgfx`, whose recorded commands the triangle engine draws. Button 3 shows the next scene, and button
//! 0 stops the time. Switch 0 selects the crate's own rasteriser on the soft core, which draws 320×180 pixels, and switch 1 this size for
//! the engine too. Each second the console shows the clock cycles of the parts of a picture.
#![cfg_attr(target_arch = "riscv32", no_std, no_main)]
#![deny(unsafe_code)]

use core::cell::{Cell, RefCell};
use core::mem;

use embedded_3dgfx::pipeline::vertex::shapes::{self, CubeMesh, Sphere16x12};
use embedded_3dgfx::prelude::*;
use glint_program::core::light::Background;
use glint_program::core::picture::{Samples, Size};
use glint_program::graphics::pixelcolor::{Rgb565, RgbColor};
use glint_program::triangles::Triangles;
use glint_program::{Board, Button, Canvas, Picture, PictureError, Program, cycles};

const SMALL: Size = Size::W320;
const PIXELS: usize = (SMALL.width() * SMALL.height()) as usize;
const SCENES: [&str; 3] = ["three cubes", "three spheres", "cube of lines"];

struct Commands {
    scene: usize,
    seconds: f32,
    engine: K3dengine,
    cube: CubeMesh,
    sphere: Sphere16x12,
    commands: CommandBuffer<1024>,
    list: Triangles<32>,
    size: Size,
    /// Whether the crate's rasteriser draws.
    is_own: bool,
    depths: RefCell<[ZDepth; PIXELS]>,
    /// Clock cycles of the crate's rasteriser.
    rasteriser: Cell<u64>,
    /// The second of the last line on the console.
    second: u64,
}

impl Commands {
    fn record(&mut self) {
        let [width, height] = self.size.pixels().map(|pixels| pixels as u16);
        self.engine = K3dengine::new(width, height);
        self.engine.camera.set_position([0.0, 1.2, 3.4].into());
        self.engine.camera.set_target([0.0; 3].into());
        let lit = RenderMode::SolidLightDir([-0.4, 0.6, -0.7].into());
        let (geometry, mode, count) = match self.scene {
            0 => (self.cube.geometry(), lit, 3),
            1 => (self.sphere.geometry(), lit, 3),
            _ => (self.cube.geometry(), RenderMode::Lines, 1),
        };
        let colours = [Rgb565::CYAN, Rgb565::YELLOW, Rgb565::RED];
        let meshes = [0, 1, 2].map(|i: usize| {
            let x = [0.0, -2.4, 2.4][i];
            let mut mesh = K3dMesh::new(geometry);
            mesh.set_render_mode(mode.clone());
            mesh.set_color(colours[i]);
            mesh.set_position(x, 0.0, 0.0);
            mesh.set_scale(0.8);
            mesh.set_attitude(self.seconds * 0.5, self.seconds + x, self.seconds * 0.3);
            mesh
        });
        let recorded = self
            .engine
            .record(&meshes[..count], &mut self.commands, None);
        recorded.expect("the buffer takes the commands of each scene");
    }
}

impl Program for Commands {
    fn start(board: &mut Board) -> Self {
        board.log(format_args!("commands: press button 3 for the next scene"));
        Self {
            scene: 0,
            seconds: 0.0,
            engine: K3dengine::new(0, 0),
            cube: shapes::cube([1.0; 3]),
            sphere: shapes::uv_sphere_16x12(1.2),
            commands: CommandBuffer::new(),
            list: Triangles::new(),
            size: SMALL,
            is_own: false,
            depths: RefCell::new([Z_MAX_VALUE; PIXELS]),
            rasteriser: Cell::new(0),
            second: 0,
        }
    }

    fn update(&mut self, board: &mut Board) {
        if board.is_pressed(Button::Right) {
            self.scene = (self.scene + 1) % SCENES.len();
        }
        if !board.is_held(Button::Up) {
            self.seconds += board.step().as_secs_f32();
        }
        self.is_own = board.switches() & 1 != 0;
        let largest = board.largest_size();
        let is_small = board.switches() & 3 != 0;
        self.size = if is_small { SMALL } else { largest };
        let start = cycles();
        self.record();
        let recorded = cycles();
        if !self.is_own {
            glint_embedded_3dgfx::convert(&self.commands, &mut self.list, self.size);
        }
        let [recording, conversion] = [recorded - start, cycles() - recorded];
        let second = board.time().as_secs();
        if mem::replace(&mut self.second, second) != second {
            let (scene, size, count) = (SCENES[self.scene], self.size, self.commands.len());
            // The engine clears the picture before the crate's rasteriser draws.
            let drawing = board.drawing().max(self.rasteriser.take());
            board.log(format_args!(
                "{scene}, {size}: {count} commands, {recording} cycles to record, {conversion} to convert, {drawing} to draw"
            ));
        }
    }

    fn draw<'p>(&'p self, picture: &mut Picture<'p>) -> Result<(), PictureError> {
        picture.appearance.background = Some(Background::Colour([24, 36, 56]));
        picture.size = self.size;
        if self.size == SMALL {
            picture.samples = Samples::One;
        }
        if !self.is_own {
            picture.triangles(&self.list)?;
        }
        Ok(())
    }

    fn paint(&self, canvas: &mut Canvas) {
        if !self.is_own {
            return;
        }
        let start = cycles();
        let [width, height] = SMALL.pixels().map(|pixels| pixels as usize);
        let zbuffer = &mut *self.depths.borrow_mut();
        zbuffer.fill(Z_MAX_VALUE);
        let mut frame = FrameCtx {
            zbuffer,
            width,
            height,
        };
        let engine = &self.engine;
        let drawn = engine.execute(canvas, &mut frame, &self.commands, None);
        drawn.expect("the canvas takes every pixel");
        self.rasteriser.set(cycles() - start);
    }
}

glint_program::run!(Commands);
