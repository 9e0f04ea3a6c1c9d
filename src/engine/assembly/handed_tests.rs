//! Terms of plugins reach the bodies they are meant for, whatever the formulation, or are an error with its
//! place.

use schemars::JsonSchema;
use serde::Deserialize;

use super::build;
use crate::pair::{Pair, PairTerm, Rates};
use crate::parallel::Arithmetic;
use crate::plugin::{Offer, Plugin, Registry, SetupError, SimBuilder};
use crate::scene::{Source, parse};
use crate::simulation::Simulation;
use crate::world::BodyId;

/// A pair force on all bodies of the scope, handed in as one.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[derive(Default)]
struct Friction {
    /// Whether it asks which bodies take pair terms.
    asks: bool,
    /// Whether it takes the pair vectors of a reference.
    of_solids: bool,
}

struct Slowing;

impl PairTerm for Slowing {
    type ReadI = ();
    type ReadJ = ();

    #[inline(always)]
    fn pair<A: Arithmetic>(&self, pair: &Pair<A>, (): (), (): (), rates: &mut Rates<A>) {
        rates.force += pair.v_ij * (pair.volume_i * pair.volume_j * pair.weight);
    }
}

/// The same along reference pair vectors.
struct SlowingSolids;

impl PairTerm for SlowingSolids {
    type ReadI = ();
    type ReadJ = ();

    const NEEDS_REFERENCE: bool = true;

    #[inline(always)]
    fn pair<A: Arithmetic>(&self, pair: &Pair<A>, (): (), (): (), rates: &mut Rates<A>) {
        Slowing.pair(pair, (), (), rates);
    }
}

impl Plugin for Friction {
    const NAME: &'static str = "friction_between";
    const REFERENCE: &'static str = "";

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        let bodies = if self.asks { sim.scope_offering(Offer::PairTerms)? } else { sim.scope().clone() };
        if self.of_solids {
            sim.add_pair_term(bodies, "friction_between", SlowingSolids);
        } else {
            sim.add_pair_term(bodies, "friction_between", Slowing);
        }
        Ok(())
    }
}

/// A block and some water apart from it, with another body.
fn simulation(other: &str, plugins: &str) -> Result<Simulation, String> {
    let text = format!(
        r#"(dimension: Two,
            materials: {{"water": Fluid(density: 1000, viscosity: 0.001, sound_speed: 20),
                         "rubber": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)}},
            bodies: [
                (name: "block", material: "rubber", shape: Box(min: (0, 0), max: (0.5, 0.5)), spacing: 0.1, formulation: TotalLagrangian),
                (name: "water", material: "water", shape: Box(min: (3, 0), max: (3.5, 0.5)), spacing: 0.1, formulation: Fluid),
                {other}
            ],
            conditions: [InitialVelocity(on: Select(), value: ("0.1*y", "0"))],
            plugins: [{plugins}],
            time: (end: 1))"#
    );
    let mut registry = Registry::standard();
    registry.plugin::<Friction>();
    registry.plugin::<Telling>();
    let built = parse(Source::new("test.ron", text));
    built.and_then(|(scene, source)| build(&scene, &source, &registry)).map_err(|error| error.to_string())
}

const BALL: &str = r#"(name: "ball", material: "rubber", shape: Sphere(center: (9, 0), radius: 0.5), spacing: 0.1, formulation: Rigid())"#;

#[test]
fn a_pair_term_acts_on_the_bodies_of_every_formulation_that_it_is_given_to() {
    for (other, plugins) in [("", "friction_between()"), (BALL, "friction_between(asks: true)")] {
        let mut sim = simulation(other, plugins).expect("a simulation");
        sim.run(|sim| sim.clock().step < 5).expect("a run");
        let ledger = sim.ledger();
        let heat =
            ledger.accounts().iter().find(|account| account.name == "friction_between").expect("an account");
        for (k, body) in sim.world().bodies().iter().enumerate() {
            let heat = heat.of(BodyId(k));
            assert_eq!(heat > 0.0, body.name != "ball", "{}: {heat}", body.name);
        }
    }
}

#[test]
fn a_term_that_a_formulation_does_not_take_is_an_error_at_the_plugin() {
    let error = simulation(BALL, "friction_between()").err().expect("an error");
    let wanted = "body `ball` was given a pair term, which bodies with the formulation `Rigid` do not take";
    assert!(error.contains(wanted) && error.contains("test.ron:10:23"), "{error}");
}

#[test]
fn a_term_that_needs_a_reference_is_an_error_on_a_fluid() {
    let error = simulation("", "friction_between(of_solids: true)").err().expect("an error");
    let wanted = "body `water`, a fluid, has no reference for the pair term `friction_between`";
    assert!(error.contains(wanted), "{error}");
}

/// Hands in a value of a type that nothing knows.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Telling {
    /// Whether it is a note.
    is_note: bool,
}

struct Untaken;

impl Plugin for Telling {
    const NAME: &'static str = "telling";
    const REFERENCE: &'static str = "";

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        if self.is_note {
            sim.leave_note(Untaken);
        } else {
            sim.extend(Untaken);
        }
        Ok(())
    }
}

#[test]
fn a_value_that_nothing_takes_is_an_error_at_the_plugin_and_a_note_is_none() {
    let error = simulation("", "telling(is_note: false)").err().expect("an error");
    let wanted = "a value of type `Untaken` was handed in, and nothing takes it";
    assert!(error.contains(wanted) && error.contains("test.ron:10:23"), "{error}");
    simulation("", "telling(is_note: true)").expect("a simulation");
}
