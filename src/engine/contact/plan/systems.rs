//! Adds the systems of all contacts of a scene.

use std::collections::{BTreeSet, HashSet};

use super::checks::NamedPair;
use super::pairs::{MakeLaw, Planner};
use super::skins_of::BodySkins;
use super::start::refuse_bodies_within_others;
use crate::contact::system;
use crate::contact::system::{Planned, Touching};
use crate::plugin::SimBuilder;
use crate::scene::Problem;
use crate::world::{BodyId, BodySet};

/// Adds the contacts of the scene.
///
/// # Errors
/// Two contacts of one pair, a law whose parameters are wrong, bodies that cannot touch.
pub fn add_systems(sim: &mut SimBuilder<'_>, make: MakeLaw<'_>) -> Result<(), Vec<Problem>> {
    let planes = sim.mirror_planes();
    let pairs: Vec<(usize, [BodyId; 2])> = sim.contact_pairs().collect();
    let mut planner = Planner {
        sim,
        make,
        planes: &planes,
        skins: BodySkins::default(),
        fragile: Vec::new(),
        warnings: Vec::new(),
    };
    let (mut planned, mut problems) = (Planned::default(), Vec::new());
    // The contact of the scene that each pair belongs to.
    let mut numbers = Vec::new();
    let is_warm = |body: &BodyId| sim.body(*body).specific_heat().is_some();
    let warm: BTreeSet<usize> =
        pairs.iter().filter(|(_, pair)| pair.iter().any(is_warm)).map(|(number, _)| *number).collect();
    let mut known = HashSet::new();
    for &(number, [first, second]) in &pairs {
        let is_known = !known.insert([first.min(second), first.max(second)]);
        let (contact, bodies) = (&sim.scene().contacts[number], [first, second].map(|body| sim.body(body)));
        let named = NamedPair { contact, number, bodies, is_known, is_warm: warm.contains(&number) };
        if let Some(problem) = named.refused() {
            problems.push(problem);
            continue;
        }
        match planner.pairs_of(&named) {
            Ok(pairs) => {
                numbers.resize(numbers.len() + pairs.len(), number);
                for (touching, acts) in pairs {
                    planned.touching.push(touching);
                    planned.acts.push(acts);
                }
            }
            Err(found) => problems.extend(found),
        }
    }
    if !problems.is_empty() {
        return Err(problems);
    }
    let Planner { warnings, fragile, .. } = planner;
    planned.fragile = fragile;
    warnings.into_iter().for_each(|warning| sim.warn(warning));
    if !planned.touching.is_empty() {
        let bodies = BodySet::new(planned.touching.iter().flat_map(Touching::bodies));
        refuse_bodies_within_others(sim, &planned.touching, numbers);
        system::add(sim, planned, &bodies);
    }
    Ok(())
}
