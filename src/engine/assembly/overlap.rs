//! Bodies that overlap. Without a contact no two particles of different bodies may start closer than half
//! their spacing. Bodies with a contact touch with the surfaces of their shapes, whatever their spacings:
//! these may overlap by a quarter of the smaller spacing, as in a shrink fit. How deep particles lie below a
//! curved side of their own shape is a matter of their lattice, so that their depths in both shapes count.
//! Where both touch with their particles the first rule stays, and particles of walls may not start in
//! another shape. Two rigid bodies are left to their contact, and so are half-spaces beside solids and rigid
//! bodies: particles that stand for them are in no particular place, and two planes of a groove always
//! overlap.

use std::collections::{BTreeMap, HashMap};
use std::path::Path;

use glam::DVec3;

use crate::neighbors::{Cloud, NeighborList, Periodic, SupportRadii};
use crate::notation::place;
use crate::plugin::{BodyKind, BodyPlan, contact_pairs};
use crate::scene::{ContactSurface, Problem, Scene};
use crate::shapes::Region;
use crate::world::BodyId;

/// Overlap of surfaces in contact at the start, over the smaller spacing: as deep as the skin of a body may
/// start in a rigid one.
const ALLOWED: f64 = 0.25;

/// Distance from a face below which a particle is on it, over the spacing.
const ON_FACE: f64 = 1e-6;

/// One problem for every pair of bodies that overlap. Files of shapes are looked for in `folder`.
pub(super) fn problems(bodies: &[BodyPlan], scene: &Scene, folder: &Path) -> Vec<Problem> {
    let between = |(number, [a, b]): (usize, [BodyId; 2])| ((a.0.min(b.0), a.0.max(b.0)), number);
    let contacts: HashMap<(usize, usize), usize> = contact_pairs(scene, bodies).map(between).collect();
    let owners: Vec<usize> = bodies.iter().flat_map(|body| vec![body.id.0; body.sites.len()]).collect();
    if bodies.len() < 2 {
        return Vec::new();
    }
    let positions: Vec<DVec3> =
        bodies.iter().flat_map(|body| body.sites.iter().map(|site| site.position)).collect();
    let reach = |body: &BodyPlan| vec![0.5 * body.spacing; body.sites.len()];
    let supports: Vec<f64> = bodies.iter().flat_map(reach).collect();
    let cloud = Cloud { positions: &positions, support: SupportRadii::PerParticle(&supports) };
    let Ok(list) = NeighborList::reference(cloud, &Periodic::NONE) else { return Vec::new() };
    let mut reported = Vec::new();
    let mut problems = Vec::new();
    let mut shapes = Shapes { scene, folder, regions: BTreeMap::new() };
    for i in 0..positions.len() {
        for &j in list.row(i) {
            let pair = (owners[i], owners[j as usize]);
            if pair.0 >= pair.1 || reported.contains(&pair) {
                continue;
            }
            let (first, second) = (&bodies[pair.0], &bodies[pair.1]);
            let contact = contacts.get(&pair).map(|&number| &scene.contacts[number]);
            let is_endless = |body: &BodyPlan| !body.bounds.is_bounded();
            let is_solid = |body: &BodyPlan| matches!(body.kind, BodyKind::Rigid | BodyKind::Solid);
            if (is_endless(first) || is_endless(second)) && is_solid(first) && is_solid(second) {
                continue;
            }
            let is_left = contact.is_some_and(|contact| {
                match [first, second].map(|body| body.kind == BodyKind::Rigid) {
                    [true, true] => true,
                    [false, false] if contact.surface == ContactSurface::Particles => false,
                    _ => {
                        let least = first.spacing.min(second.spacing);
                        let allowed = if is_solid(first) && is_solid(second) { ALLOWED * least } else { 0.0 };
                        let at = [positions[i], positions[j as usize]];
                        !shapes.overlap_by_more_than(allowed, [pair.0, pair.1], at)
                    }
                }
            });
            if is_left {
                continue;
            }
            reported.push(pair);
            problems.push(problem([first, second], [positions[i], positions[j as usize]], &mut shapes));
        }
    }
    problems
}

/// The problem of two bodies that have particles at `at`, one each, too close to each other.
fn problem([first, second]: [&BodyPlan; 2], at: [DVec3; 2], shapes: &mut Shapes) -> Problem {
    let pair = [first.id.0, second.id.0];
    let share_face = shapes.share_face(pair, at[0], ON_FACE * first.spacing);
    let path = format!("bodies[{}].shape", second.id.0);
    if !share_face && shapes.part(pair, at) {
        let spacings = at[0].distance(at[1]) / (0.5 * (first.spacing + second.spacing));
        let (of, and) = (&first.name, &second.name);
        let message = format!(
            "particles of `{of}` and `{and}` start {spacings:.2} spacings apart at {}: \
             lattices that are not cut along the faces of their shapes have particles right beside them",
            place(at[0])
        );
        return Problem::at_path(path, message)
            .help("give the bodies, a fluid above all, `lattice: BodyFitted()`, whose particles keep half a spacing from every face")
            .help("or leave a gap of about the mean spacing between particles of different bodies");
    }
    let message = format!("body `{}` overlaps body `{}` at {}", second.name, first.name, place(at[0]));
    let problem = Problem::at_path(path, message);
    match share_face {
        true => problem.help("a face that the shapes share runs through centres of their lattices, where both have particles: move it by a quarter of a spacing"),
        false => problem
            .help("leave a gap of about the mean spacing between particles of different bodies")
            .help("a body clamped in another one: cut its place out of the other by `Difference`"),
    }
}

/// The shapes of bodies, built where they are asked for; none of those that are lists of particles.
struct Shapes<'a> {
    scene: &'a Scene,
    folder: &'a Path,
    regions: BTreeMap<usize, Option<Box<dyn Region>>>,
}

impl Shapes<'_> {
    /// Whether neither of two points, one of each body, is in the shape of the other one.
    fn part(&mut self, pair: [usize; 2], at: [DVec3; 2]) -> bool {
        !self.holds(pair[0], at[1]) && !self.holds(pair[1], at[0])
    }

    /// Whether one of two points, one of each body, is in the shape of the other one, and its depths in both
    /// add up to more than those `allowed`, m.
    fn overlap_by_more_than(&mut self, allowed: f64, pair: [usize; 2], at: [DVec3; 2]) -> bool {
        [(0, 1), (1, 0)].into_iter().any(|(own, other)| {
            let inside = self.depth(pair[other], at[own]);
            inside > 0.0 && inside + self.depth(pair[own], at[own]).max(0.0) > allowed
        })
    }

    /// Whether a point is on the surface of both bodies.
    fn share_face(&mut self, pair: [usize; 2], at: DVec3, within: f64) -> bool {
        pair.iter().all(|&body| self.region(body).is_some_and(|region| region.distance(at).abs() < within))
    }

    /// Whether a point is in a body; also where its shape is not known.
    fn holds(&mut self, body: usize, x: DVec3) -> bool {
        self.depth(body, x) > 0.0
    }

    /// How deep a point is in a body, m; any depth where its shape is not known.
    fn depth(&mut self, body: usize, x: DVec3) -> f64 {
        self.region(body).map_or(f64::INFINITY, |region| -region.distance(x))
    }

    fn region(&mut self, body: usize) -> Option<&dyn Region> {
        let (scene, folder) = (self.scene, self.folder);
        let make = || scene.bodies[body].shape.region(scene.dimension, folder, "shape").ok();
        self.regions.entry(body).or_insert_with(make).as_deref()
    }
}

#[cfg(test)]
mod tests {
    use crate::assembly::build;
    use crate::plugin::Registry;
    use crate::scene::{Source, parse};

    /// Error of a finely filled ring about a coarsely filled disc of another radius.
    fn error(radius: f64, disc: &str, contact: &str) -> Option<String> {
        let text = format!(
            r#"(dimension: Two, materials: {{"m": NeoHookean(density: 1000, young: 1e7, poisson: 0.3)}},
                bodies: [
                    (name: "ring", material: "m", shape: Ring(center: (0, 0), inner: 0.1, outer: 0.11), spacing: 0.0025, lattice: Concentric, formulation: TotalLagrangian),
                    (name: "disc", material: "m", shape: Sphere(center: (0, 0), radius: {radius:?}), spacing: 0.01, formulation: {disc}),
                ],
                contacts: [{contact}], time: (end: 1))"#
        );
        let (scene, source) = parse(Source::new("overlap.ron", &text)).unwrap_or_else(|e| panic!("{e}"));
        build(&scene, &source, &Registry::standard()).err().map(|error| error.to_string())
    }

    /// Shafts on a regular lattice, whose particles lie at any depth below its side, in a ring of the same
    /// spacing.
    #[test]
    fn a_shrink_fit_of_up_to_a_quarter_of_a_spacing_is_no_error_on_any_lattice() {
        for shaft in ["Rigid()", "TotalLagrangian"] {
            let error = |interference: f64| {
                let text = format!(
                    r#"(dimension: Two, materials: {{"m": NeoHookean(density: 1000, young: 1e7, poisson: 0.3)}},
                        bodies: [
                            (name: "shaft", material: "m", shape: Sphere(center: (0, 0), radius: {:?}), spacing: 0.01, formulation: {shaft}),
                            (name: "ring", material: "m", shape: Ring(center: (0, 0), inner: 0.1, outer: 0.16), spacing: 0.01, lattice: Concentric, formulation: TotalLagrangian),
                        ],
                        contacts: [Contact(between: ("ring", "shaft"))], time: (end: 1))"#,
                    0.1 + interference
                );
                let (scene, source) =
                    parse(Source::new("overlap.ron", &text)).unwrap_or_else(|e| panic!("{e}"));
                build(&scene, &source, &Registry::standard()).err().map(|error| error.to_string())
            };
            for k in 1..=8 {
                let interference = 0.0003 * f64::from(k);
                assert_eq!(error(interference), None, "{shaft}: {interference}");
            }
            let deep = error(0.011).unwrap_or_default();
            assert!(deep.contains("body `ring` overlaps body `shaft`"), "{shaft}: {deep}");
        }
    }

    #[test]
    fn two_half_spaces_may_form_a_groove_of_any_angle() {
        for slope in [0.02, 0.2, 0.5, 1.0, 3.0] {
            let text = format!(
                r#"(dimension: Two, materials: {{"m": NeoHookean(density: 1000, young: 1e7, poisson: 0.3)}},
                    bodies: [
                        (name: "one", material: "m", shape: HalfSpace(point: (0, 0), normal: ({slope:?}, 1)), spacing: 0.02, formulation: Rigid()),
                        (name: "two", material: "m", shape: HalfSpace(point: (0, 0), normal: (-{slope:?}, 1)), spacing: 0.02, formulation: Rigid()),
                    ],
                    conditions: [Fix(on: Select())], time: (end: 1))"#
            );
            let (scene, source) = parse(Source::new("groove.ron", &text)).unwrap_or_else(|e| panic!("{e}"));
            let error = build(&scene, &source, &Registry::standard()).err();
            assert!(error.is_none(), "{slope}: {}", error.map_or_else(String::new, |e| e.to_string()));
        }
    }

    #[test]
    fn a_shared_face_through_centres_of_cells_is_told_from_bodies_that_overlap() {
        let of = |low: &str| {
            let text = format!(
                r#"(dimension: Two, materials: {{"m": NeoHookean(density: 1000, young: 1e7, poisson: 0.3)}},
                    bodies: [
                        (name: "upper", material: "m", shape: Polygon(points: [(0, 0), (1, 1), (0, 1)]), spacing: 0.1, formulation: TotalLagrangian),
                        (name: "lower", material: "m", shape: Polygon(points: [{low}]), spacing: 0.1, formulation: TotalLagrangian),
                    ],
                    time: (end: 1))"#
            );
            let (scene, source) = parse(Source::new("overlap.ron", &text)).unwrap_or_else(|e| panic!("{e}"));
            build(&scene, &source, &Registry::standard())
                .err()
                .map(|error| error.to_string())
                .unwrap_or_default()
        };
        let says = |text: &str| text.contains("a face that the shapes share");
        let (shared, overlapping) = (of("(0, 0), (1, 1), (1, 0)"), of("(0, 0.2), (0.8, 1), (0, 1)"));
        assert!(says(&shared), "{shared}");
        assert!(overlapping.contains("overlaps") && !says(&overlapping), "{overlapping}");
    }

    #[test]
    fn surfaces_that_meet_may_be_filled_with_any_two_spacings() {
        let contact = r#"Contact(between: ("ring", "disc"))"#;
        let particles = r#"Contact(between: ("ring", "disc"), surface: Particles)"#;
        for disc in ["Rigid()", "TotalLagrangian"] {
            assert_eq!(error(0.1, disc, contact), None, "{disc}");
            let deep = error(0.104, disc, contact).unwrap_or_default();
            assert!(deep.contains("body `disc` overlaps body `ring`"), "{disc}: {deep}");
            assert!(error(0.1, disc, "").is_some(), "{disc}");
        }
        assert_eq!(error(0.1, "Rigid()", particles), None);
        let close = error(0.1, "TotalLagrangian", particles).unwrap_or_default();
        assert!(close.contains("spacings apart") && close.contains("BodyFitted()"), "{close}");
    }
}
