//! The columns that the formulations of the engine share, and the state of materials; a phase has those that
//! its materials need.

use glam::{DMat3, DVec3};

use crate::column;
use crate::linalg::Sym3;

column! {
    /// Identity of the particle: it stays with the particle when rows are sorted.
    pub struct ParticleId(u64) = "particle_id", "id", "1";
    /// Position in the current configuration.
    pub struct Position(DVec3) = "position", "x", "m";
    /// Position in the reference configuration.
    pub struct ReferencePosition(DVec3) = "reference_position", "X", "m";
    /// Velocity; between the two kicks of a step it is the velocity at mid-step.
    pub struct Velocity(DVec3) = "velocity", "v", "m/s";
    /// Total force on the particle: internal, body and external forces.
    pub struct Force(DVec3) = "force", "f", "N";
    /// Mass of the particle; in two dimensions per metre of thickness.
    pub struct Mass(f64) = "mass", "m", "kg";
    /// Inverse mass per axis; zero along an axis whose motion is prescribed, so that no force moves it.
    pub struct Mobility(DVec3) = "mobility", "1/m", "1/kg";
    /// Whether the particle has been removed from the run. It is [`Removed::NO`] or [`Removed::YES`]. A
    /// removed particle keeps its row: it does not move, carries no stress and no force, and lists and sums
    /// leave it out. The systems of [`removal`](crate::removal) set it, permanently.
    pub struct Removed(u32) = "removed", "-", "1";
    /// Volume in the reference configuration; in two dimensions per metre of thickness.
    pub struct ReferenceVolume(f64) = "reference_volume", "V0", "m^3";
    /// Support radius in the reference configuration: pairs farther apart than the mean of two radii do not
    /// interact.
    pub struct SupportRadius(f64) = "support_radius", "H", "m";
    /// Deformation gradient, F = dx/dX.
    pub struct DeformationGradient(DMat3) = "deformation_gradient", "F", "1";
    /// Density of a fluid.
    pub struct Density(f64) = "density", "rho", "kg/m^3";
    /// Rate of change of the density of a fluid by pair terms, beside that of the flow.
    pub struct DensityRate(f64) = "density_rate", "drho/dt", "kg/(m^3 s)";
    /// Pressure of a fluid, or of the fluid beside a wall.
    pub struct Pressure(f64) = "pressure", "p", "Pa";
    /// First Piola-Kirchhoff stress, P = J sigma F^-T.
    pub struct PiolaStress(DMat3) = "piola_stress", "P", "Pa";
    /// Accumulated equivalent plastic strain, the integral of sqrt(2/3 D_p : D_p).
    pub struct PlasticStrain(f64) = "plastic_strain", "eps_p", "1";
    /// Inverse of the plastic right Cauchy-Green tensor, (F_p^T F_p)^-1.
    pub struct InversePlasticCauchyGreen(Sym3) = "inverse_plastic_cauchy_green", "Cp^-1", "1";
    /// Equivalent stress of the last step, sqrt(3/2 s : s) of the Kirchhoff stress.
    pub struct EquivalentStress(f64) = "equivalent_stress", "q", "Pa";
    /// Quasi-static flow stress, at the present plastic strain and temperature.
    pub struct YieldStress(f64) = "yield_stress", "sigma_y", "Pa";
    /// Deviator of the Cauchy stress, integrated by a hypoelastic law.
    pub struct DeviatoricStress(Sym3) = "deviatoric_stress", "S", "Pa";
    /// Deformation gradient to which a hypoelastic law has integrated the stress.
    pub struct ReachedDeformation(DMat3) = "reached_deformation", "F", "1";
    /// Internal energy of an equation of state per reference volume: work of the pressure, and heat.
    pub struct InternalEnergy(f64) = "internal_energy", "E", "J/m^3";
    /// Plastic work since the start per reference volume.
    pub struct PlasticWork(f64) = "plastic_work", "w_p", "J/m^3";
    /// Power per reference volume that pair terms turn into heat, such as that of an artificial viscosity.
    pub struct ViscousPower(f64) = "viscous_power", "q", "W/m^3";
    /// Heat of pair terms, and of friction and conduction, since the start per reference volume.
    pub struct ViscousHeat(f64) = "viscous_heat", "w_q", "J/m^3";
    /// Volume ratio to which an equation of state has integrated its energy.
    pub struct ReachedVolumeRatio(f64) = "reached_volume_ratio", "J", "1";
    /// Temperature at which a law with an equation of state has left a particle; not a number before it has
    /// seen it. What it finds beyond is heat of friction and conduction.
    pub struct ReachedTemperature(f64) = "reached_temperature", "T", "K";
    /// Damage: the share of the strength that is lost; 1 for a particle that has failed.
    pub struct Damage(f64) = "damage", "D", "1";
    /// Temperature.
    pub struct Temperature(f64) = "temperature", "T", "K";
    /// Modulus in the stiffness of hourglass control.
    pub struct HourglassModulus(f64) = "hourglass_modulus", "E_h", "Pa";
    /// Hourglass residual of the last step, `sum_j V_j w_ij |F_i X_ij - x_ij|^2`.
    pub struct HourglassResidual(f64) = "hourglass_residual_before", "e^2", "1";
    /// Deformation gradient for the hourglass residual in bodies that can fail: the fit to the intact
    /// neighbours.
    pub struct HourglassGradient(DMat3) = "hourglass_gradient", "F_h", "1";
}

impl Removed {
    /// The particle takes part in the run.
    pub const NO: Self = Self(0);
    /// The particle has been removed.
    pub const YES: Self = Self(1);
}
