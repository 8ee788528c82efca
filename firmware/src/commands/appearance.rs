//! Commands that set a field's appearance: material, lights, background, fog, occlusion and undecided rays. Meshes have the lights too.

use glint_core::appearance::Appearance;
use glint_core::choice::switch_name;
use glint_core::console::AppearanceCommands;
use glint_core::fixed::U4_28;
use glint_core::light::{Background, Hexadecimal, Light, Material, Rgb};

use crate::error::CommandError;
use crate::format::{OrDefault, OrOff};
use crate::job::{Outcome, Reply};
use crate::machine::Machine;

impl<'l> AppearanceCommands<'l> for Machine {
    fn material(&mut self, material: Option<Material>) -> Outcome<'l> {
        match material {
            Some(material) => change(self, &mut |appearance| appearance.material = material),
            None => {
                let material = self.scene.appearance().material;
                self.terminal.print_entry("material", &material);
            }
        }
        Ok(Reply::Done)
    }

    fn light(&mut self, light: Option<Option<Light>>) -> Outcome<'l> {
        match light {
            Some(Some(_)) if self.scene.appearance().lights.is_full() => {
                return Err(CommandError::Lights);
            }
            Some(light) => change(self, &mut |appearance| match light {
                // The list has room, as checked above.
                Some(light) => {
                    let _ = appearance.lights.push(light);
                }
                None => appearance.lights.clear(),
            }),
            None => {
                let appearance = self.scene.appearance();
                let mut lights = appearance.lighting().lights;
                if appearance.lights.is_empty() && !self.scene.shows_field() {
                    lights.clear();
                    // The list has room for one light.
                    let _ = lights.push(appearance.mesh_lighting().light);
                }
                if lights.is_empty() {
                    self.terminal.print_entry("light", &"none");
                }
                for light in lights {
                    self.terminal.print_entry("light", &light);
                }
            }
        }
        Ok(Reply::Done)
    }

    fn ambient(&mut self, colour: Option<Option<Rgb>>) -> Outcome<'l> {
        match colour {
            Some(colour) => change(self, &mut |appearance| appearance.ambient = colour),
            None => {
                let appearance = self.scene.appearance();
                let colour = if self.scene.shows_field() {
                    appearance.lighting().ambient
                } else {
                    appearance.mesh_lighting().ambient
                };
                self.terminal.print_entry("ambient", &Hexadecimal(colour));
            }
        }
        Ok(Reply::Done)
    }

    fn background(&mut self, background: Option<Option<Background>>) -> Outcome<'l> {
        match background {
            Some(background) => change(self, &mut |appearance| appearance.background = background),
            None => {
                let background = OrDefault(self.scene.appearance().background);
                self.terminal.print_entry("background", &background);
            }
        }
        Ok(Reply::Done)
    }

    fn fog(&mut self, density: Option<Option<U4_28>>) -> Outcome<'l> {
        match density {
            Some(density) => change(self, &mut |appearance| {
                appearance.fog = density.unwrap_or_default();
            }),
            None => {
                let density = Some(self.scene.appearance().fog).filter(|&fog| fog != U4_28::ZERO);
                self.terminal.print_entry("fog", &OrOff(density));
            }
        }
        Ok(Reply::Done)
    }

    fn occlusion(&mut self, on: Option<bool>) -> Outcome<'l> {
        match on {
            Some(on) => change(self, &mut |appearance| appearance.occlusion = on),
            None => {
                let on = switch_name(self.scene.appearance().occlusion);
                self.terminal.print_entry("occlusion", &on);
            }
        }
        Ok(Reply::Done)
    }

    fn undecided(&mut self, on: Option<bool>) -> Outcome<'l> {
        match on {
            Some(on) => change(self, &mut |appearance| appearance.undecided = on),
            None => {
                let on = switch_name(self.scene.appearance().undecided);
                self.terminal.print_entry("undecided", &on);
            }
        }
        Ok(Reply::Done)
    }
}

fn change(machine: &mut Machine, change: &mut dyn FnMut(&mut Appearance)) {
    let mut appearance = machine.scene.appearance().clone();
    change(&mut appearance);
    machine.scene.set_appearance(appearance);
}
