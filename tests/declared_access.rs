//! A system touches only the columns and the packed rows that it has declared, and rows of neighbours only
//! where it has said so: otherwise the run ends, with what to add.

use meshless::prelude::*;
use meshless::solids::PACKED_SOLID;

/// Does to a column what its text says, having declared what its text says.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Touch {
    declares: String,
    does: String,
}

impl Plugin for Touch {
    const NAME: &'static str = "touch";
    const REFERENCE: &'static str = "";

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        let does = self.does;
        let system = System::new(Stage::External, "touch", move |step: &mut Step<'_>| {
            let (view, _) = step.world.body_view(BodyId(0));
            match does.as_str() {
                "reads" => drop(view.read::<Velocity>()?),
                "reads near" => drop(view.read_near::<Velocity>()?),
                "reads packed" => drop(step.resources.solid(step.world.body(BodyId(0)).phase)),
                "writes packed" => drop(step.resources.solid_mut(step.world.body(BodyId(0)).phase)),
                _ => drop(view.write::<Velocity>()?),
            }
            Ok(())
        });
        sim.add_system(match self.declares.as_str() {
            "nothing" => system,
            "reads" => system.reads::<Velocity>(),
            "reads near" => system.reads_near::<Velocity>(),
            "adds" => system.adds::<Velocity>(),
            "reads packed" => system.touches(PACKED_SOLID, Mode::Reads),
            "writes packed" => system.touches(PACKED_SOLID, Mode::Writes),
            _ => system.writes::<Velocity>(),
        });
        Ok(())
    }
}

/// What ends the run, or nothing.
fn run(declares: &str, does: &str) -> Option<String> {
    let text = format!(
        r#"Scene(
            dimension: Two,
            materials: {{ "rubber": NeoHookean(density: 1000.0, young: 1.0e6, poisson: 0.4) }},
            bodies: [Body(name: "block", material: "rubber", shape: Box(min: (0.0, 0.0), max: (0.1, 0.1)), spacing: 0.02,
                          formulation: TotalLagrangian)],
            plugins: [touch(declares: "{declares}", does: "{does}")],
            time: (end: 1.0e-4),
        )"#
    );
    let registry = standard_plugins().with(|registry: &mut Registry| {
        registry.plugin::<Touch>();
    });
    let (scene, source) = parse(Source::new("touch.ron", text)).expect("a scene");
    let mut sim = build(&scene, &source, &registry).expect("a simulation");
    sim.run(|_| true).err().map(|error| error.to_string())
}

#[test]
fn what_is_declared_may_be_done() {
    let allowed = [
        ("reads", "reads"),
        ("reads near", "reads"),
        ("reads near", "reads near"),
        ("writes", "reads"),
        ("writes", "writes"),
        ("adds", "writes"),
        ("reads packed", "reads packed"),
        ("writes packed", "reads packed"),
        ("writes packed", "writes packed"),
    ];
    for (declares, does) in allowed {
        assert_eq!(run(declares, does), None, "declares {declares}, does {does}");
    }
}

#[test]
fn what_is_not_declared_ends_the_run_and_says_what_to_add() {
    let refused = [
        ("nothing", "reads", "reads"),
        ("nothing", "reads near", "reads_near"),
        ("nothing", "writes", "writes"),
        ("reads", "reads near", "reads_near"),
        ("reads", "writes", "writes"),
        ("reads near", "writes", "writes"),
        ("writes", "reads near", "reads_near"),
    ];
    for (declares, does, missing) in refused {
        let error = run(declares, does).unwrap_or_else(|| panic!("declares {declares}, does {does}"));
        let expected = format!(
            "system `touch` touches the column `velocity` and has not declared it: add `.{missing}::<Velocity>()` to the system"
        );
        assert!(error.contains(&expected), "{error}");
    }
}

#[test]
fn packed_rows_that_are_not_declared_end_the_run_too() {
    let refused = [
        ("nothing", "reads packed", "Reads"),
        ("writes", "reads packed", "Reads"),
        ("nothing", "writes packed", "Writes"),
        ("reads packed", "writes packed", "Writes"),
    ];
    for (declares, does, mode) in refused {
        let error = run(declares, does).unwrap_or_else(|| panic!("declares {declares}, does {does}"));
        let expected = format!(
            "system `touch` touches `packed_solid` or `corrected_stress` of what systems share and has not declared it: \
             add `.touches_packed(\"packed_solid\", Mode::{mode})` to the system"
        );
        assert!(error.contains(&expected), "{error}");
    }
}
