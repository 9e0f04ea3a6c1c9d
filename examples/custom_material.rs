//! A material of one's own: a hyperelastic law in one file, with one line of registration.
//!
//! `cargo run --release --example custom_material` runs the scene below and compares with the closed form.
//! With arguments it is the whole `meshless` program, and its scenes may say `MooneyRivlin(density: 1000,
//! ...)`.

use std::error::Error;
use std::process::ExitCode;

use meshless::prelude::*;

/// Mooney-Rivlin elasticity of rubber, psi = c1 (I1 J^(-2/3) - 3) + c2 (I2 J^(-4/3) - 3) + K/2 (J - 1)^2.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct MooneyRivlin {
    /// Density rho_0, kg/m3.
    density: f64,
    /// Constant c1 of the first invariant, Pa.
    c1: f64,
    /// Constant c2 of the second invariant, Pa. The shear modulus is 2 (c1 + c2).
    c2: f64,
    /// Bulk modulus K, Pa.
    bulk: f64,
}

impl MaterialModel for MooneyRivlin {
    const NAME: &'static str = "MooneyRivlin";
    const REFERENCE: &'static str =
        "Mooney 1940, J. Appl. Phys. 11, 582-592; Bonet and Wood 2008, section 6.5";

    fn build(self) -> Result<Material, ParameterError> {
        ParameterError::require_positive("density", self.density)?;
        ParameterError::require_positive("c1", self.c1)?;
        ParameterError::require_not_negative("c2", self.c2)?;
        ParameterError::require_positive("bulk", self.bulk)?;
        let elastic = ElasticConstants::from_bulk_shear(self.bulk, 2.0 * (self.c1 + self.c2));
        let law = MooneyRivlinLaw { c1: self.c1, c2: self.c2, elastic };
        Ok(Material::solid(self.density, law))
    }
}

#[derive(Clone, Copy)]
struct MooneyRivlinLaw {
    c1: f64,
    c2: f64,
    elastic: ElasticConstants,
}

impl Hyperelastic for MooneyRivlinLaw {
    const NEEDS_POSITIVE_VOLUME: bool = true;

    fn elastic(&self) -> &ElasticConstants {
        &self.elastic
    }

    #[inline(always)]
    fn stress_and_energy(&self, f: &DMat3) -> (DMat3, f64) {
        let (a, b, c) = (f.x_axis, f.y_axis, f.z_axis);
        let cofactor = DMat3::from_cols(b.cross(c), c.cross(a), a.cross(b));
        let jacobian = a.dot(cofactor.x_axis);
        let (one, two) = (a.dot(a) + b.dot(b) + c.dot(c), cofactor_square(&cofactor));
        let shrink = (-2.0 / 3.0 * jacobian.ln()).exp();
        let (first, second) = (self.c1 * shrink, self.c2 * shrink * shrink);
        // dI1/dF = 2 F, dI2/dF = 2 (I1 F - F F^T F), dJ/dF = cof F.
        let spread = *f * one - *f * (f.transpose() * *f);
        let volume = self.elastic.bulk * (jacobian - 1.0)
            - (2.0 * first * one + 4.0 * second * two) / (3.0 * jacobian);
        let stress = *f * (2.0 * first) + spread * (2.0 * second) + cofactor * volume;
        let shape = first * one - 3.0 * self.c1 + second * two - 3.0 * self.c2;
        (stress, shape + 0.5 * self.elastic.bulk * (jacobian - 1.0).powi(2))
    }
}

/// The second invariant of F^T F: the squared cofactors.
fn cofactor_square(cofactor: &DMat3) -> f64 {
    cofactor.x_axis.length_squared() + cofactor.y_axis.length_squared() + cofactor.z_axis.length_squared()
}

fn register(registry: &mut Registry) {
    registry.material::<MooneyRivlin>();
}

/// A sheet pulled to one and a half of its length, slowly and damped; 1000 times stiffer in volume than in
/// shape.
const SCENE: &str = r#"Scene(
    title: "Rubber sheet",
    dimension: Two,
    materials: { "rubber": MooneyRivlin(density: 1000.0, c1: 0.3e6, c2: 0.2e6, bulk: 500.0e6) },
    bodies: [
        Body(name: "sheet", material: "rubber", shape: Box(min: (0.0, 0.0), max: (0.1, 0.05)), spacing: 0.005,
             formulation: TotalLagrangian, plugins: [hourglass_control()]),
    ],
    conditions: [
        Fix(on: Select(face: MinX), axes: [X]),
        Displacement(on: Select(face: MaxX), value: ("0.05*smoothstep(t/0.03)", None)),
    ],
    plugins: [local_damping(rate: 300.0)],
    time: (end: 0.05),
)"#;

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let registry = standard_plugins().with(register);
    if std::env::args().len() > 1 {
        return Ok(meshless::cli::run(registry));
    }
    let (scene, source) = parse(Source::new("rubber_sheet.ron", SCENE))?;
    let mut sim = build(&scene, &source, &registry)?;
    sim.run(|_| true)?;
    let (sheet, rows) = sim.world().body_view(BodyId(0));
    let (gradient, stress) = (sheet.read::<DeformationGradient>()?, sheet.read::<PiolaStress>()?);
    let count = rows.len() as f64;
    let stretch = gradient[rows.clone()].iter().map(|f| f.0.x_axis.x).sum::<f64>() / count;
    let pull = stress[rows].iter().map(|p| p.0.x_axis.x).sum::<f64>() / count;
    // Plane strain, incompressible: the principal stretches are s, 1/s and 1, and P = 2 (c1 + c2) (s - s^-3).
    let expected = 2.0 * 0.5e6 * (stretch - stretch.powi(-3));
    println!("nominal stress at a stretch of {stretch:.3}: {pull:.3e} Pa, expected {expected:.3e} Pa");
    assert!((pull / expected - 1.0).abs() < 0.03, "the law or its use is wrong");
    Ok(ExitCode::SUCCESS)
}
