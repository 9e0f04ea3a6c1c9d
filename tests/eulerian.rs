//! Solids whose kernels live in the present configuration: what is exact, against sums over all pairs that
//! are written out here.

mod common;

use common::eulerian::{FOLLOWING, Particle, UPSET, after, block, particles};
use common::simulation;
use meshless::glam::{DMat3, DVec3};
use meshless::kernels::{Kernel, KernelName};
use meshless::linalg::Sym3;
use meshless::scene::Source;
use meshless::simulation::Simulation;
use meshless::world::BodyId;

/// Sums over all pairs of one body.
struct Naive {
    all: Vec<Particle>,
    kernel: Kernel,
    h: f64,
    plane: bool,
}

impl Naive {
    fn of(sim: &Simulation, dimension: usize) -> Self {
        let support = 2.6 * sim.world().body(BodyId(0)).spacing;
        let kernel = Kernel::new(KernelName::CubicSpline, dimension).expect("a kernel");
        Self { all: particles(sim), kernel, h: kernel.smoothing_length(support), plane: dimension == 2 }
    }

    fn is_stretched(&self) -> bool {
        self.all.iter().any(|p| p.metric != Sym3::IDENTITY)
    }

    fn volume(&self, i: usize) -> f64 {
        self.all[i].volume * self.all[i].deformation.determinant()
    }

    /// Neighbours with V_0,j w_ij and x_ij.
    fn pairs(&self, i: usize) -> impl Iterator<Item = (usize, f64, DVec3)> {
        (0..self.all.len()).filter(move |&j| j != i).map(move |j| {
            let x_ij = self.all[j].x - self.all[i].x;
            (j, self.all[j].volume * self.weight((i, j), x_ij, |_| DMat3::IDENTITY), x_ij)
        })
    }

    /// w_ij of a pair vector by the metrics of both, each of which has turned.
    fn weight(&self, (i, j): (usize, usize), x_ij: DVec3, turn: impl Fn(usize) -> DMat3) -> f64 {
        let square = |k: usize| {
            let back = turn(k).transpose() * x_ij;
            back.dot(self.all[k].metric.to_matrix() * back)
        };
        let density = |k: usize| self.all[k].metric.determinant().sqrt();
        let distance = (0.5 * (square(i) + square(j))).sqrt();
        0.5 * (density(i) + density(j)) * self.kernel.pair_weight(distance, self.h)
    }

    fn inverse_moment(&self, i: usize) -> DMat3 {
        let mut m = self.pairs(i).fold(DMat3::ZERO, |m, (_, w, x)| m + Sym3::dyad(x).to_matrix() * w);
        if self.plane {
            m.z_axis.z = 1.0;
        }
        m.inverse()
    }

    fn cauchy(&self, i: usize) -> DMat3 {
        let f = self.all[i].deformation;
        self.all[i].stress * f.transpose() * (1.0 / f.determinant())
    }

    fn velocity_gradient(&self, i: usize) -> DMat3 {
        let sum = self.pairs(i).fold(DMat3::ZERO, |sum, (j, w, x)| {
            let v = (self.all[j].v - self.all[i].v) * w;
            sum + DMat3::from_cols(v * x.x, v * x.y, v * x.z)
        });
        sum * self.inverse_moment(i)
    }

    fn forces(&self) -> Vec<DVec3> {
        let n = self.all.len();
        let kirchhoff = |i: usize| self.all[i].stress * self.all[i].deformation.transpose();
        let a: Vec<DMat3> = (0..n).map(|i| kirchhoff(i) * self.inverse_moment(i)).collect();
        let force = |i: usize| {
            self.all[i].volume * self.pairs(i).map(|(j, w, x)| (a[i] + a[j]) * x * w).sum::<DVec3>()
        };
        (0..n).map(force).collect()
    }
}

impl Naive {
    /// The stiffness form of the hourglass control with xi and Young's modulus 1.
    fn control(&self, xi: f64, reference: &[DVec3]) -> Vec<DVec3> {
        let force = |i: usize| {
            let of_pair = |(j, _, x): (usize, f64, DVec3)| {
                let original = reference[j] - reference[i];
                let error = 0.5 * (self.all[i].deformation + self.all[j].deformation) * original - x;
                let weight = self.volume(i) * self.volume(j) * self.kernel.w(x.length(), self.h)
                    / original.length_squared();
                -xi * weight * error.dot(x) / x.length_squared() * x
            };
            self.pairs(i).map(of_pair).sum()
        };
        (0..self.all.len()).map(force).collect()
    }
}

impl Naive {
    /// The energy of the control with xi and Young's modulus 1, where the particles have moved on by `by`
    /// seconds at their velocities, F with these, and the supports with their spin.
    fn energy(&self, xi: f64, by: f64, reference: &[DVec3], rates: &[DMat3]) -> f64 {
        let (h, n) = (self.h, self.all.len());
        let place = |i: usize| self.all[i].x + by * self.all[i].v;
        let deformation = |i: usize| self.all[i].deformation + by * rates[i] * self.all[i].deformation;
        let turn = |i: usize| {
            let half = (rates[i] - rates[i].transpose()) * (0.25 * by);
            (DMat3::IDENTITY - half).inverse() * (DMat3::IDENTITY + half)
        };
        let of_pair = |(i, j): (usize, usize)| {
            let (original, x) = (reference[j] - reference[i], place(j) - place(i));
            let square = |k: usize| {
                let error = deformation(k) * original - x;
                0.9 * error.dot(x).powi(2) / x.length_squared() + 0.1 * error.length_squared()
            };
            let known = (4.0 * h * h / original.length_squared()).min(1.0).powi(2);
            let weight = self.all[i].volume * self.all[j].volume * self.weight((i, j), x, turn);
            0.25 * xi * weight * known * (square(i) + square(j))
        };
        (0..n).flat_map(|i| (0..i).map(move |j| (i, j))).map(of_pair).sum()
    }
}

#[test]
fn the_power_of_the_control_is_the_change_of_its_energy() {
    for (dimension, velocity, stretched) in MOTIONS {
        let plugins = "plugins: [hourglass_control(form: Variational, xi: 3)],";
        let mut sim = simulation(&block(dimension, FOLLOWING, velocity, plugins));
        let reference: Vec<DVec3> = particles(&sim).iter().map(|p| p.x).collect();
        sim.run(|sim| sim.clock().step < 60).expect("a run");
        let mut naive = Naive::of(&sim, dimension);
        assert_eq!(naive.is_stretched(), stretched);
        let stored = naive.energy(3.0, 0.0, &reference, &vec![DMat3::ZERO; reference.len()]);
        let booked = sim.ledger().total_named("hourglass");
        assert!((stored - booked).abs() < 1e-10 * stored, "{stored} J and {booked} J");
        let control: Vec<DVec3> =
            naive.forces().into_iter().zip(&naive.all).map(|(stress, p)| p.f - stress).collect();
        let size: f64 = control.iter().map(|f| f.length()).sum();
        let torque: DVec3 = control.iter().zip(&naive.all).map(|(f, p)| p.x.cross(*f)).sum();
        assert!(torque.length() < 1e-12 * size, "{torque} of {size}");
        // Whatever the particles do now: velocities that no neighbourhood sees as affine, and a turn.
        for k in 0..4 {
            for (i, p) in naive.all.iter_mut().enumerate() {
                let phase = (i * (k + 3) * 7 % 41) as f64;
                let rough = DVec3::new(phase.sin(), (1.7 * phase).cos(), (2.3 * phase).sin());
                let rough = if dimension == 2 { DVec3::new(rough.x, rough.y, 0.0) } else { rough };
                p.v = if k == 0 { DVec3::Z.cross(p.x) } else { rough };
            }
            let rates: Vec<DMat3> = (0..naive.all.len()).map(|i| naive.velocity_gradient(i)).collect();
            let h = 1e-5;
            let energy = |by: f64| naive.energy(3.0, by, &reference, &rates);
            let slope = (8.0 * (energy(h) - energy(-h)) - (energy(2.0 * h) - energy(-2.0 * h))) / (12.0 * h);
            let power: f64 = control.iter().zip(&naive.all).map(|(f, p)| f.dot(p.v)).sum();
            assert!((power + slope).abs() < 1e-7 * size, "{k}: {power} W and {slope} J/s of {size}");
            assert!(k == 0 || power.abs() > 1e-3 * size, "{k}: {power} W of {size}");
        }
    }
}

#[test]
fn the_stiffness_form_of_the_control_is_the_sum_over_all_pairs() {
    for dimension in [2, 3] {
        let plugins = "plugins: [hourglass_control(form: Stiffness, xi: 3)],";
        let mut sim = simulation(&block(dimension, "Eulerian()", WILD[dimension - 2], plugins));
        let reference: Vec<DVec3> = particles(&sim).iter().map(|p| p.x).collect();
        sim.run(|sim| sim.clock().step < 60).expect("a run");
        let naive = Naive::of(&sim, dimension);
        let control = naive.control(3.0, &reference);
        let size = control.iter().map(|f| f.length()).fold(0.0, f64::max);
        assert!(size > 1e-7, "{size}");
        for ((particle, force), control) in naive.all.iter().zip(naive.forces()).zip(control) {
            assert!(
                (particle.f - force - control).length() < 1e-9 * size,
                "{} {force} {control}",
                particle.f
            );
        }
        assert!(sim.ledger().total_named("hourglass_work") > 0.0);
    }
}

const WILD: [&str; 2] = [
    r#"("0.3*sin(5*x)*y", "0.2*cos(4*x) - 0.1*y")"#,
    r#"("0.3*sin(5*x)*z", "0.2*cos(4*x) - 0.1*y", "0.2*x*y")"#,
];

/// Dimension, velocity, and whether the supports have become ellipsoids after 60 steps.
const MOTIONS: [(usize, &str, bool); 4] =
    [(2, WILD[0], false), (3, WILD[1], false), (2, UPSET[0], true), (3, UPSET[1], true)];

#[test]
fn the_force_is_the_adjoint_of_the_velocity_gradient() {
    for (dimension, velocity, stretched) in MOTIONS {
        let sim = after(&block(dimension, FOLLOWING, velocity, ""), 60);
        let naive = Naive::of(&sim, dimension);
        assert_eq!(naive.is_stretched(), stretched);
        let forces = naive.forces();
        let size = forces.iter().map(|f| f.length()).fold(0.0, f64::max);
        assert!(size > 1e-6);
        for (particle, force) in naive.all.iter().zip(&forces) {
            assert!((particle.f - *force).length() < 1e-11 * size, "{} and {force}", particle.f);
        }
        let sum = |of: &dyn Fn(&Particle) -> DVec3| naive.all.iter().map(of).sum::<DVec3>().length();
        assert!(sum(&|p| p.f) < 1e-12 * size && sum(&|p| p.x.cross(p.f)) < 1e-12 * size);
        let power: f64 = naive.all.iter().map(|p| p.f.dot(p.v)).sum();
        let stress_power: f64 = (0..naive.all.len())
            .map(|i| {
                let (s, l) = (naive.cauchy(i), naive.velocity_gradient(i));
                naive.volume(i) * (0..3).map(|k| s.col(k).dot(l.col(k))).sum::<f64>()
            })
            .sum();
        assert!((power + stress_power).abs() < 1e-11 * stress_power.abs(), "{power} W and {stress_power} W");
    }
}

#[test]
fn an_affine_motion_has_its_gradient_to_the_bit_of_rounding_and_no_net_force() {
    for (dimension, velocity) in [
        (2, r#"("0.3*x + 0.2*y", "-0.5*x + 0.1*y")"#),
        (3, r#"("0.3*x + 0.2*y", "-0.5*x + 0.1*z", "0.2*y - 0.4*z")"#),
    ] {
        // Nothing has acted before the second step: after the first, places are an affine map of those of the
        // start.
        let sim = after(&block(dimension, "Eulerian()", velocity, ""), 1);
        let t = sim.clock().time;
        let rate = if dimension == 2 {
            DMat3::from_cols(DVec3::new(0.3, -0.5, 0.0), DVec3::new(0.2, 0.1, 0.0), DVec3::ZERO)
        } else {
            DMat3::from_cols(
                DVec3::new(0.3, -0.5, 0.0),
                DVec3::new(0.2, 0.0, 0.2),
                DVec3::new(0.0, 0.1, -0.4),
            )
        };
        let all = particles(&sim);
        let (size, net): (f64, DVec3) =
            all.iter().fold((0.0, DVec3::ZERO), |(size, net), p| (size + p.f.length(), net + p.f));
        assert!(net.length() < 1e-10 * size, "{net} of {size}");
        for p in all {
            assert!(p.deformation.abs_diff_eq(DMat3::IDENTITY + rate * t, 1e-12), "{}", p.deformation);
        }
    }
}

#[test]
fn a_body_that_starts_deformed_knows_it() {
    let place = r#"InitialDisplacement(on: Select(body: "block"), value: ("0.2*x + 0.1*y", "-0.1*y"))"#;
    let source = block(2, "Eulerian()", r#"("0", "0")"#, "");
    let text = source.text.replace("conditions: [", &format!("conditions: [{place}, "));
    let mut sim = simulation(&Source::new("stretched.ron", text));
    sim.start().expect("a start");
    let f = DMat3::from_cols(DVec3::new(1.2, 0.0, 0.0), DVec3::new(0.1, 0.9, 0.0), DVec3::Z);
    assert!(particles(&sim).iter().all(|p| p.deformation.abs_diff_eq(f, 1e-12)));
    assert!(sim.ledger().total_named("strain") > 0.0);
}

/// Momentum and angular momentum about the origin.
fn momenta(sim: &Simulation) -> (DVec3, DVec3) {
    let all = particles(sim);
    (all.iter().map(|p| p.m * p.v).sum(), all.iter().map(|p| p.x.cross(p.m * p.v)).sum())
}

#[test]
fn a_thrown_body_that_turns_and_swings_keeps_its_momenta_and_its_energy() {
    let velocities = [
        r#"("0.3 - 0.4*(y - 0.2)", "0.4*(x - 0.5) + 0.1*cos(5.2*x)")"#,
        r#"("0.3 - 0.4*(y - 0.2)", "0.4*(x - 0.5) + 0.1*cos(5.2*x)", "0.1*x")"#,
    ];
    let controls = ["", "form: Combined", "form: Viscous", "form: MohseniMofidi2020"];
    for (dimension, velocity) in [2, 3].into_iter().zip(velocities) {
        for control in controls {
            let plugins = format!("plugins: [hourglass_control({control})],");
            let mut sim = simulation(&block(dimension, "Eulerian()", velocity, &plugins));
            let end = if dimension == 2 { 10.0 } else { 3.0 };
            let error = balance_of_thrown(&mut sim, end);
            assert!(error < 0.03, "{control}: balance {error}");
        }
    }
}

/// Runs a body to the time `end`, s, with the momenta that it has had. Returns the error of the energy
/// balance over the energy.
fn balance_of_thrown(sim: &mut Simulation, end: f64) -> f64 {
    sim.run(|sim| sim.clock().step < 1).expect("a step");
    let ((linear, angular), energy) = (momenta(sim), sim.ledger().stored());
    sim.run(|sim| sim.clock().time < end).expect("a run");
    let (now, turned) = momenta(sim);
    assert!((now - linear).length() < 1e-12 * linear.length(), "{linear} -> {now}");
    assert!((turned - angular).length() < 1e-10 * angular.length(), "{angular} -> {turned}");
    sim.ledger().balance_error().abs() / energy
}

#[test]
fn a_body_that_is_upset_keeps_them_with_supports_that_follow() {
    for (dimension, velocity) in [2, 3].into_iter().zip(UPSET) {
        let plugins = "plugins: [hourglass_control()],";
        let mut sim = simulation(&block(dimension, FOLLOWING, velocity, plugins));
        let error = balance_of_thrown(&mut sim, 1.2);
        assert!(Naive::of(&sim, dimension).is_stretched() && error < 2e-3, "balance {error}");
        assert!(sim.warnings().is_empty(), "{:?}", sim.warnings());
        let mut fixed = simulation(&block(dimension, "TotalLagrangian", velocity, plugins));
        fixed.run(|sim| sim.clock().time < 1.2).expect("a run");
        let kinetic = |sim: &Simulation| sim.ledger().total_named("kinetic");
        let ratio = kinetic(&sim) / kinetic(&fixed);
        assert!((ratio - 1.0).abs() < 0.05, "{ratio}");
    }
}

#[test]
fn the_divergence_of_the_paper_is_the_sum_over_all_pairs() {
    let sim = after(&block(2, "Eulerian(divergence: Shepard)", WILD[0], ""), 30);
    let naive = Naive::of(&sim, 2);
    let n = naive.all.len();
    let over_density: Vec<DMat3> = (0..n)
        .map(|i| {
            let itself = naive.volume(i) * naive.kernel.w(0.0, naive.h);
            let others =
                naive.pairs(i).map(|(j, _, x)| naive.volume(j) * naive.kernel.w(x.length(), naive.h));
            let density = naive.all[i].m / naive.volume(i);
            naive.cauchy(i) * (1.0 / (density * density * (itself + others.sum::<f64>())))
        })
        .collect();
    let force = |i: usize| {
        let of_pair = |(j, weight, x): (usize, f64, DVec3)| {
            let weight = weight / naive.all[j].volume * naive.all[j].m;
            weight * ((over_density[i] + over_density[j]) * x)
        };
        naive.all[i].m * naive.pairs(i).map(of_pair).sum::<DVec3>()
    };
    let size = naive.all.iter().map(|p| p.f.length()).fold(0.0, f64::max);
    let net: DVec3 = naive.all.iter().map(|p| p.f).sum();
    assert!(size > 1e-6 && net.length() < 1e-12 * size);
    for (i, particle) in naive.all.iter().enumerate() {
        assert!((particle.f - force(i)).length() < 1e-11 * size, "{} and {}", particle.f, force(i));
    }
}

#[test]
fn the_artificial_stress_is_the_sum_over_all_pairs() {
    let sim = after(&block(2, "Eulerian(artificial_stress: (epsilon: 0.5, exponent: 3))", WILD[0], ""), 30);
    let naive = Naive::of(&sim, 2);
    let tensile = |i: usize| {
        let stress = Sym3::symmetric_part(naive.cauchy(i));
        meshless::linalg::Eigen::new(&stress).map(|principal| principal.max(0.0)).to_matrix()
    };
    let at_spacing = naive.kernel.w(0.05, naive.h);
    let size = naive.all.iter().map(|p| p.f.length()).fold(0.0, f64::max);
    let mut largest = 0.0f64;
    for (i, stress) in naive.forces().into_iter().enumerate() {
        let of_pair = |(j, weight, x): (usize, f64, DVec3)| {
            let near = (naive.kernel.w(x.length(), naive.h) / at_spacing).powi(3);
            let weight = weight / naive.all[j].volume * naive.volume(j);
            -0.5 * near * weight * ((tensile(i) + tensile(j)) * x)
        };
        let repulsion = naive.volume(i) * naive.pairs(i).map(of_pair).sum::<DVec3>();
        let found = naive.all[i].f - stress;
        assert!((found - repulsion).length() < 1e-10 * size, "{found} and {repulsion}");
        largest = largest.max(repulsion.length());
    }
    assert!(largest > 1e-2 * size, "{largest} of {size}");
    assert!(sim.ledger().total_named("artificial_stress") != 0.0);
}
