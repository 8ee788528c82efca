//! A short run of every fuzz target; `cargo run -p glint --example fuzz` makes long runs.

use glint::fuzz::{Inputs, Target};

fn run(target: Target) {
    // The firmware restarts for each input, which takes 20 ms.
    let count = match target {
        Target::Firmware => 400,
        _ => 20_000,
    };
    let inputs = Inputs::new(target, 0x610e);
    let accepted = (0..count).filter(|&number| inputs.run(number)).count();
    // The inputs must be partly accepted and partly rejected. Otherwise they would test only the
    // parser's first check, or only its path without errors.
    let share = accepted as f64 / count as f64;
    assert!(
        (0.005..0.995).contains(&share),
        "{target:?}: {accepted} of {count} accepted"
    );
}

/// Each target has a separate test, so that the targets run in parallel.
macro_rules! tests {
    ($($name:ident: $target:ident),*) => {
        $(
            #[test]
            fn $name() {
                run(Target::$target);
            }
        )*
    };
}

tests! {
    upload: Upload,
    console: Console,
    obj: Obj,
    stl: Stl,
    ply: Ply,
    gltf: Gltf,
    glm: Glm,
    texture: Texture,
    imu: Imu,
    replay: Replay,
    wireframe_text: WireframeText,
    wireframe_words: WireframeWords,
    scene: Scene,
    flash: Flash,
    host: Host,
    firmware: Firmware
}
