//! Circles in a graph of modules.

use std::collections::{BTreeSet, HashMap, VecDeque};

use super::arrows::Arrows;
use super::tree::Id;

/// Finds for each module on a circle a shortest circle through that module. A circle that is found for several modules is listed
/// once, starting at the module with the lowest id.
pub fn circles(arrows: &Arrows) -> Vec<Vec<Id>> {
    let modules: BTreeSet<Id> = arrows.keys().map(|(from, _)| *from).collect();
    let circles: BTreeSet<Vec<Id>> = modules
        .into_iter()
        .filter_map(|module| shortest(arrows, module))
        .map(|mut circle| {
            let lowest = (0..circle.len()).min_by_key(|place| circle[*place]);
            circle.rotate_left(lowest.unwrap_or(0));
            circle
        })
        .collect();
    circles.into_iter().collect()
}

/// A shortest circle through `start`, found by a breadth-first search.
fn shortest(arrows: &Arrows, start: Id) -> Option<Vec<Id>> {
    let mut before: HashMap<Id, Id> = HashMap::new();
    let mut queue = VecDeque::from([start]);
    while let Some(from) = queue.pop_front() {
        for (_, to) in arrows
            .range((from, 0)..=(from, Id::MAX))
            .map(|(ends, _)| ends)
        {
            if *to == start {
                let mut circle = vec![from];
                while let Some(previous) = before.get(&circle[circle.len() - 1]) {
                    circle.push(*previous);
                }
                circle.reverse();
                return Some(circle);
            }
            if !before.contains_key(to) {
                before.insert(*to, from);
                queue.push_back(*to);
            }
        }
    }
    None
}
