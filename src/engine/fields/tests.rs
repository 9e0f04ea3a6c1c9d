//! Fields against closed forms and naive sums, read through probes at the start of a run.

use glam::{DMat3, DVec3};

use super::Field;
use crate::assembly::{BuildOptions, build_with};
use crate::plugin::{Plugin, Registry, SetupError, SimBuilder};
use crate::record::read_series;
use crate::scene::{Source, parse};
use crate::simulation::Simulation;
use crate::world::{BodyId, DeformationGradient, Mass, Position, ReferencePosition, Velocity};

#[derive(Clone, serde::Deserialize, schemars::JsonSchema)]
struct MoreFields {}

impl Plugin for MoreFields {
    const NAME: &'static str = "more_fields";
    const REFERENCE: &'static str = "";

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        sim.add_field(Field::new::<(Mass, Velocity), f64>("kinetic_energy", "J", |(m, v)| {
            0.5 * m.0 * v.0.length_squared()
        }));
        Ok(())
    }
}

const YOUNG: f64 = 1.0e5;
const POISSON: f64 = 0.3;

/// What a plane block of 48 particles, moved by `place`, reports of particle 20 at the start, field by field.
fn report(place: impl Fn(DVec3) -> DVec3, fields: &[&str]) -> (Vec<Vec<f64>>, Simulation) {
    let probes: Vec<String> = fields
        .iter()
        .enumerate()
        .map(|(k, field)| {
            format!("Probe(name: \"{k}\", on: Select(nearest: (0.035, 0.025)), quantity: Field(\"{field}\"))")
        })
        .collect();
    let text = format!(
        r#"Scene(
    dimension: Two,
    materials: {{"m": StVenantKirchhoff(density: 1000.0, young: {YOUNG:?}, poisson: {POISSON:?})}},
    bodies: [Body(name: "block", material: "m", shape: Box(min: (0.0, 0.0), max: (0.08, 0.06)), spacing: 0.01,
                  formulation: TotalLagrangian, velocity: (3.0, 4.0))],
    plugins: [more_fields],
    time: (end: 1.0),
    probes: [{}],
)"#,
        probes.join(",\n")
    );
    let (scene, source) = parse(Source::new("block.ron", text)).unwrap_or_else(|e| panic!("{e}"));
    let registry = Registry::standard().with(|registry| {
        registry.plugin::<MoreFields>();
    });
    let folder = tempfile::tempdir().unwrap();
    let options = BuildOptions::into_folder(folder.path());
    let mut sim = build_with(&scene, &source, &registry, &options).unwrap_or_else(|e| panic!("{e}"));
    let (view, _) = sim.world().body_view(BodyId(0));
    view.write::<Position>().unwrap().iter_mut().for_each(|x| x.0 = place(x.0));
    sim.start().unwrap();
    sim.finish().unwrap();
    let read = |k: usize| {
        let series = read_series(&folder.path().join(format!("{k}.csv"))).unwrap();
        series.columns()[1..].iter().map(|c| series.numbers(&c.name).unwrap()[0]).collect()
    };
    ((0..fields.len()).map(read).collect(), sim)
}

fn assert_close(found: f64, expected: f64, scale: f64, what: &str) {
    assert!((found - expected).abs() < 1e-11 * scale, "{what}: {found} instead of {expected}");
}

#[test]
fn homogeneous_deformation_gives_the_closed_forms() {
    let f = [[1.1, 0.2], [-0.05, 0.9]];
    let place =
        |x: DVec3| DVec3::new(f[0][0] * x.x + f[0][1] * x.y, f[1][0] * x.x + f[1][1] * x.y, 0.0) + DVec3::X;
    let fields = [
        "displacement",
        "speed",
        "volume_ratio",
        "stress",
        "von_mises",
        "pressure",
        "max_principal_stress",
        "min_principal_stress",
        "max_principal_stretch",
        "min_principal_stretch",
        "hourglass_residual",
        "kinetic_energy",
        "velocity.y",
        "deformation_gradient.xy",
    ];
    let (values, _) = report(place, &fields);
    let of = |name: &str| &values[fields.iter().position(|field| *field == name).unwrap()];

    // St Venant-Kirchhoff in plane strain, by components.
    let (lambda, mu) =
        (YOUNG * POISSON / ((1.0 + POISSON) * (1.0 - 2.0 * POISSON)), YOUNG / (2.0 * (1.0 + POISSON)));
    let c = |a: usize, b: usize| f[0][a] * f[0][b] + f[1][a] * f[1][b];
    let strain = |a: usize, b: usize| 0.5 * (c(a, b) - f64::from(u8::from(a == b)));
    let trace = strain(0, 0) + strain(1, 1);
    let second = |a: usize, b: usize| lambda * trace * f64::from(u8::from(a == b)) + 2.0 * mu * strain(a, b);
    let j = f[0][0] * f[1][1] - f[0][1] * f[1][0];
    let sigma = |a: usize, b: usize| {
        let sum: f64 = (0..2).flat_map(|k| (0..2).map(move |l| f[a][k] * second(k, l) * f[b][l])).sum();
        sum / j
    };
    let (xx, yy, xy, zz) = (sigma(0, 0), sigma(1, 1), sigma(0, 1), lambda * trace / j);
    let mises = (0.5 * ((xx - yy).powi(2) + (yy - zz).powi(2) + (zz - xx).powi(2)) + 3.0 * xy * xy).sqrt();
    let (mean, radius) = (0.5 * (xx + yy), (0.25 * (xx - yy).powi(2) + xy * xy).sqrt());
    let stress = of("stress");
    // In the plane the columns are xx, xy, yx, yy, zz.
    assert_eq!(stress.len(), 5);
    for (found, expected) in stress.iter().zip([xx, xy, xy, yy, zz]) {
        assert_close(*found, expected, YOUNG, "stress");
    }
    assert_close(of("von_mises")[0], mises, YOUNG, "von_mises");
    assert_close(of("pressure")[0], -(xx + yy + zz) / 3.0, YOUNG, "pressure");
    assert_close(of("max_principal_stress")[0], (mean + radius).max(zz), YOUNG, "max_principal_stress");
    assert_close(of("min_principal_stress")[0], (mean - radius).min(zz), YOUNG, "min_principal_stress");

    let (mean, radius) =
        (0.5 * (c(0, 0) + c(1, 1)), (0.25 * (c(0, 0) - c(1, 1)).powi(2) + c(0, 1).powi(2)).sqrt());
    assert_close(
        of("max_principal_stretch")[0],
        (mean + radius).sqrt().max(1.0),
        1.0,
        "max_principal_stretch",
    );
    assert_close(
        of("min_principal_stretch")[0],
        (mean - radius).sqrt().min(1.0),
        1.0,
        "min_principal_stretch",
    );
    assert_close(of("volume_ratio")[0], j, 1.0, "volume_ratio");
    assert_close(of("deformation_gradient.xy")[0], 0.2, 1.0, "F_xy");
    let at = DVec3::new(0.035, 0.025, 0.0);
    for k in 0..2 {
        assert_close(of("displacement")[k], (place(at) - at)[k], 1.0, "displacement");
    }
    assert_close(of("speed")[0], 5.0, 5.0, "speed");
    assert_close(of("velocity.y")[0], 4.0, 5.0, "velocity.y");
    assert_close(of("kinetic_energy")[0], 0.5 * 1000.0 * 1e-4 * 25.0, 1.0, "kinetic_energy");
    // An affine motion has no hourglass error.
    assert!(of("hourglass_residual")[0] < 1e-13, "{:?}", of("hourglass_residual"));
}

#[test]
fn the_hourglass_residual_is_that_of_a_naive_sum() {
    let place = |x: DVec3| x + 1e-3 * DVec3::new((500.0 * x.y).sin(), (700.0 * x.x).cos(), 0.0);
    let (values, sim) = report(place, &["hourglass_residual", "neighbors"]);
    let (view, rows) = sim.world().body_view(BodyId(0));
    let x = view.read::<Position>().unwrap();
    let reference = view.read::<ReferencePosition>().unwrap();
    let gradient = view.read::<DeformationGradient>().unwrap();
    let i = rows.clone().find(|&i| reference[i].0.distance(DVec3::new(0.035, 0.025, 0.0)) < 1e-9).unwrap();
    let (mut sum, mut count) = (0.0, 0.0_f64);
    for j in rows {
        let bond = reference[j].0 - reference[i].0;
        if j != i && bond.length() < 0.0241 {
            let f: DMat3 = gradient[i].0;
            sum += ((f * bond - (x[j].0 - x[i].0)).length() / bond.length()).powi(2);
            count += 1.0;
        }
    }
    let expected = (sum / count).sqrt();
    assert!(expected > 0.01);
    assert_close(values[0][0], expected, expected, "hourglass_residual");
    assert_eq!(values[1][0], count);
}
