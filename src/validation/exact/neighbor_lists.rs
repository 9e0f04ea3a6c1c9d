//! K5: neighbour lists against brute force.

use anyhow::Result;
use meshless_engine::glam::DVec3;
use meshless_engine::neighbors::{Cloud, NeighborList, Periodic};
use meshless_engine::plugin::Registry;

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::Random;

pub(crate) const CASE: Case = Case {
    id: "K5",
    title: "neighbour lists against brute force",
    resolutions: &[600],
    ci_resolution: 600,
    run: neighbor_lists,
};

fn neighbor_lists(_: &Registry, count: usize) -> Result<Vec<Check>> {
    let mut checks = Vec::new();
    let clouds: [(&str, fn(&mut Random) -> DVec3, Periodic); 5] = [
        ("random in space", in_space, Periodic::NONE),
        ("random in the plane", in_plane, Periodic::NONE),
        ("clustered", clustered, Periodic::NONE),
        ("on a line", on_a_line, Periodic::NONE),
        ("periodic along x and y", in_space, Periodic::new(DVec3::ZERO, DVec3::ONE, [true, true, false])?),
    ];
    for (name, place, periodic) in clouds {
        let mut random = Random::new(5);
        let places: Vec<DVec3> = (0..count).map(|_| place(&mut random)).collect();
        let radii: Vec<f64> = (0..count).map(|_| 0.08 + 0.1 * random.next()).collect();
        let list = NeighborList::reference(Cloud::per_particle(&places, &radii), &periodic)?;
        let within = |i: usize, j: usize| {
            periodic.minimal_image(places[j] - places[i]).length() < 0.5 * (radii[i] + radii[j])
        };
        let mut wrong = 0_u32;
        for i in 0..count {
            let found: Vec<u32> = (0..count).filter(|&j| j != i && within(i, j)).map(|j| j as u32).collect();
            wrong += u32::from(found != list.row(i));
        }
        let text = format!("rows that differ, {name}");
        checks.push(Check::new(
            text,
            f64::from(wrong),
            0.0,
            Tolerance::Absolute(0.0),
            "1",
            "all pairs tried",
        ));
    }
    Ok(checks)
}

fn in_space(random: &mut Random) -> DVec3 {
    DVec3::new(random.next(), random.next(), random.next())
}

fn in_plane(random: &mut Random) -> DVec3 {
    DVec3::new(random.next(), random.next(), 0.0)
}

fn clustered(random: &mut Random) -> DVec3 {
    in_space(random) * if random.next() < 0.5 { 0.05 } else { 1.0 }
}

fn on_a_line(random: &mut Random) -> DVec3 {
    random.next() * DVec3::new(1.0, 0.5, -0.3)
}
