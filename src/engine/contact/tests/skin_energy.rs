//! The forces between two skins are the gradient of one continuous energy: at faces, edges and corners,
//! straight and deformed.

use std::sync::Arc;

use glam::{DMat3, DVec3};

use super::simulation;
use crate::contact::laws::{ContactLaw, ContactPair, Penalty};
use crate::contact::response::Interaction;
use crate::contact::skins::SkinPair;
use crate::neighbors::Periodic;
use crate::scene::{ContactSurface, Dimension};
use crate::simulation::Simulation;
use crate::skins::SkinColumns;
use crate::skins::tests::skin;
use crate::world::{BodyId, DeformationGradient, Position};

/// Two blocks whose particles are put where a test wants them, and their contact.
struct Blocks {
    sim: Simulation,
    pair: SkinPair,
    reference: [Vec<DVec3>; 2],
}

/// Where every particle of both blocks is, and its deformation gradient; or how they change.
type State = [Vec<(DVec3, DMat3)>; 2];

impl Blocks {
    fn new(dimension: &str) -> Self {
        let shapes = match dimension {
            "Two" => ["Box(min: (0, 0), max: (0.08, 0.04))", "Box(min: (0, 0.1), max: (0.05, 0.14))"],
            _ => [
                "Box(min: (0, 0, 0), max: (0.06, 0.04, 0.05))",
                "Box(min: (0, 0.1, 0), max: (0.04, 0.14, 0.03))",
            ],
        };
        let body = |k: usize| {
            format!(
                r#"(name: "body{k}", material: "soft", shape: {}, spacing: 0.01, formulation: TotalLagrangian)"#,
                shapes[k]
            )
        };
        let sim = simulation(&format!(
            r#"(dimension: {dimension},
                materials: {{"soft": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)}},
                bodies: [{}, {}], time: (end: 0.1))"#,
            body(0),
            body(1)
        ));
        let axes = if dimension == "Two" { Dimension::Two } else { Dimension::Three };
        let contact = ContactPair { dimension: axes, surface: ContactSurface::Skin, modulus: 1e6 };
        let law = Penalty::default().build(&contact).unwrap();
        let interaction =
            Interaction { law, friction: 0.0, damping_ratio: 0.0, tangential: 1.0, heat: [0.0; 2] };
        let skins = [0, 1].map(|k| Arc::new(skin(&sim, BodyId(k), dimension, shapes[k])));
        let reference = [0, 1].map(|k| {
            let (view, rows) = sim.world().body_view(BodyId(k));
            let x = view.read::<Position>().unwrap();
            rows.map(|row| x[row].0 - DVec3::new(0.0, 0.1 * k as f64, 0.0)).collect()
        });
        Self { pair: SkinPair::new(Arc::new(interaction), skins, Periodic::NONE), sim, reference }
    }

    /// Energy, J, and the forces and couples on the particles.
    fn energy(&mut self, state: &State) -> (f64, State) {
        for (k, of_body) in state.iter().enumerate() {
            let (view, rows) = self.sim.world().body_view(BodyId(k));
            let mut x = view.write::<Position>().unwrap();
            let mut gradient = view.write::<DeformationGradient>().unwrap();
            for (row, (place, f)) in rows.zip(of_body) {
                (x[row].0, gradient[row].0) = (*place, *f);
            }
        }
        let skins = self.pair.patches.each_ref().map(|patch| Arc::clone(&patch.skin));
        let columns = [0, 1].map(|k| SkinColumns::new(&skins[k], self.sim.world()).unwrap());
        // A speed and a step that make the candidates old each time.
        let views = columns.each_ref().map(SkinColumns::view);
        let (tally, _) = self.pair.act(views, [1e3; 2], 1.0).unwrap();
        let mut forces = [0, 1].map(|k| vec![(DVec3::ZERO, DMat3::ZERO); state[k].len()]);
        for (forces, patch) in forces.iter_mut().zip(&self.pair.patches) {
            patch.on_particles().for_each(|(particle, force, couple)| forces[particle] = (force, couple));
        }
        (tally.stored, forces)
    }

    /// The first block at rest, the second one turned by an angle with its lowest corner at a place.
    fn posed(&self, turn: DMat3, corner: DVec3) -> State {
        let size = self.reference[1].iter().fold(DVec3::ZERO, |most, x| most.max(*x)) + 0.005;
        let size = if size.z < 0.01 { size.truncate().extend(0.0) } else { size };
        let corners =
            (0..8).map(|k| turn * (size * DVec3::new((k & 1) as f64, (k >> 1 & 1) as f64, (k >> 2) as f64)));
        let lowest = corners.min_by(|a, b| a.y.total_cmp(&b.y)).unwrap();
        [
            self.reference[0].iter().map(|x| (*x, DMat3::IDENTITY)).collect(),
            self.reference[1].iter().map(|x| (turn * *x - lowest + corner, turn)).collect(),
        ]
    }
}

struct Random(u64);

impl Random {
    /// Steele, Lea, Flood, OOPSLA 2014 (SplitMix).
    fn number(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        low + (high - low) * ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn vector(&mut self, size: f64, axes: usize) -> DVec3 {
        let z = if axes == 3 { self.number(-size, size) } else { 0.0 };
        DVec3::new(self.number(-size, size), self.number(-size, size), z)
    }

    /// A change of both blocks.
    fn change(&mut self, state: &State, of_place: f64, of_gradient: f64, axes: usize) -> State {
        state.each_ref().map(|of_body| {
            let of_gradient = |random: &mut Self| {
                [0, 1, 2].map(|k| if k < axes { random.vector(of_gradient, axes) } else { DVec3::ZERO })
            };
            of_body
                .iter()
                .map(|_| {
                    let [a, b, c] = of_gradient(self);
                    (self.vector(of_place, axes), DMat3::from_cols(a, b, c))
                })
                .collect()
        })
    }

    fn turn(&mut self, axes: usize, angle: f64) -> DMat3 {
        let axis = if axes == 3 { self.vector(1.0, 3).normalize() } else { DVec3::Z };
        DMat3::from_axis_angle(axis, self.number(-angle, angle))
    }
}

fn moved(state: &State, change: &State, by: f64) -> State {
    [0, 1].map(|k| {
        let rows = state[k].iter().zip(&change[k]);
        rows.map(|((x, f), (u, g))| (*x + by * *u, *f + *g * by)).collect()
    })
}

/// The work of forces on a change.
fn work(forces: &State, change: &State) -> f64 {
    let columns =
        |f: &DMat3, g: &DMat3| f.x_axis.dot(g.x_axis) + f.y_axis.dot(g.y_axis) + f.z_axis.dot(g.z_axis);
    let of_body = |k: usize| {
        forces[k].iter().zip(&change[k]).map(|((f, c), (u, g))| f.dot(*u) + columns(c, g)).sum::<f64>()
    };
    of_body(0) + of_body(1)
}

#[test]
fn the_forces_of_two_skins_are_the_gradient_of_their_energy() {
    let mut random = Random(1);
    for (dimension, axes, cases) in [("Two", 2, 60), ("Three", 3, 12)] {
        let mut blocks = Blocks::new(dimension);
        let mut touching = 0;
        for _ in 0..cases {
            // The corner comes down on the upper face, near its end, or beside it.
            let turn = random.turn(axes, 0.8);
            let end = if axes == 2 { 0.08 } else { 0.06 };
            let corner = DVec3::new(
                end + random.number(-0.03, 0.002),
                0.04 - random.number(0.001, 0.004),
                if axes == 3 { 0.012 } else { 0.0 },
            );
            let posed = blocks.posed(turn, corner);
            let noise = random.change(&posed, 3e-4, 0.05, axes);
            let state = moved(&posed, &noise, 1.0);
            // A second time, so that no contact is in its first step.
            blocks.energy(&state);
            let (energy, forces) = blocks.energy(&state);
            if energy == 0.0 {
                continue;
            }
            touching += 1;
            for _ in 0..4 {
                let change = random.change(&state, 1.0, 30.0, axes);
                let h = 2e-9;
                let (up, _) = blocks.energy(&moved(&state, &change, h));
                let (down, _) = blocks.energy(&moved(&state, &change, -h));
                let (slope, expected) = ((up - down) / (2.0 * h), -work(&forces, &change));
                let scale =
                    forces.iter().flatten().map(|(f, c)| f.length() + 30.0 * c.x_axis.length()).sum::<f64>();
                assert!((slope - expected).abs() < 2e-4 * scale, "{dimension}: {slope} {expected} {scale}");
            }
        }
        assert!(touching > cases / 2, "{touching}");
    }
}

#[test]
fn nothing_makes_the_energy_of_two_skins_jump() {
    let mut random = Random(1);
    for (dimension, axes, cases, steps) in [("Two", 2, 16, 400), ("Three", 3, 3, 120)] {
        let mut blocks = Blocks::new(dimension);
        for _ in 0..cases {
            let end = if axes == 2 { 0.08 } else { 0.06 };
            let corner = DVec3::new(
                end + random.number(-0.03, -0.01),
                0.04 - random.number(0.002, 0.004),
                if axes == 3 { 0.012 } else { 0.0 },
            );
            let turn = random.turn(axes, 0.3);
            let posed = blocks.posed(turn, corner);
            let noise = random.change(&posed, 6e-5, 0.01, axes);
            let mut state = moved(&posed, &noise, 1.0);
            // It slides over the end of the face, while corners open and shut.
            let mut change = random.change(&state, 4e-4, 0.1, axes);
            let slide = random.number(0.01, 0.02);
            change[1].iter_mut().for_each(|(u, _)| u.x += slide);
            let (first, mut forces) = blocks.energy(&state);
            let (mut last, mut sum, mut largest) = (first, first, first);
            for _ in 0..steps {
                state = moved(&state, &change, 1.0 / steps as f64);
                let (energy, next) = blocks.energy(&state);
                sum -= 0.5 * (work(&forces, &change) + work(&next, &change)) / steps as f64;
                (last, forces, largest) = (energy, next, largest.max(energy));
            }
            // Where a bent face is touched beside a corner, the share of the integral jumps with the foot.
            assert!(
                (sum - last).abs() < 1e-2 * largest,
                "{dimension}: {sum} instead of {last}, largest {largest}"
            );
        }
    }
}
