//! The commands that say how a field looks.

use glint_core::console::Command;
use glint_core::fixed::U4_28;
use glint_core::light::Hexadecimal;

use crate::commands::{Refusal, print_choice, switch_name};
use crate::machine::Machine;

/// Prints what a command asks for, or changes it; all others do nothing.
///
/// # Errors
/// There are as many lights as there may be.
pub fn execute<'l>(machine: &mut Machine, command: &Command) -> Result<(), Refusal<'l>> {
    let Machine {
        scene, terminal, ..
    } = machine;
    let mut appearance = scene.appearance().clone();
    match *command {
        Command::Material(None) => {
            let material = appearance.material.name();
            terminal.print(format_args!("material {material}\n"));
        }
        Command::Material(Some(material)) => appearance.material = material,
        Command::Light(None) => {
            let lights = appearance.lighting().lights;
            if lights.is_empty() {
                terminal.print(format_args!("light none\n"));
            }
            for light in lights {
                terminal.print(format_args!("light {light}\n"));
            }
        }
        Command::Light(Some(None)) => appearance.lights.clear(),
        Command::Light(Some(Some(light))) => {
            appearance.lights.push(light).map_err(|_| Refusal::Lights)?;
        }
        Command::Ambient(None) => {
            let ambient = Hexadecimal(appearance.lighting().ambient);
            terminal.print(format_args!("ambient {ambient}\n"));
        }
        Command::Ambient(Some(ambient)) => appearance.ambient = ambient,
        Command::Background(None) => {
            let background = appearance.background.name();
            terminal.print(format_args!("background {background}\n"));
        }
        Command::Background(Some(background)) => appearance.background = background,
        Command::Fog(None) => {
            let fog = Some(appearance.fog).filter(|&fog| fog != U4_28::ZERO);
            print_choice(terminal, "fog", fog);
        }
        Command::Fog(Some(density)) => appearance.fog = density,
        Command::Occlusion(None) => {
            let occlusion = switch_name(appearance.occlusion);
            terminal.print(format_args!("occlusion {occlusion}\n"));
        }
        Command::Occlusion(Some(occlusion)) => appearance.occlusion = occlusion,
        _ => {}
    }
    scene.set_appearance(appearance);
    Ok(())
}
