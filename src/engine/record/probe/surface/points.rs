//! Points at the surface of a body where its stress is in balance with the traction there.

use glam::{DMat3, DVec3};

use super::internal_force::ForceOfBody;
use super::traction::{LoadedParticle, SurfaceTraction};
use crate::fields::cauchy;
use crate::formulations::fluid::{CouplingForce, FlowCloud};
use crate::linalg::Sym3;
use crate::record::probe::flow::pressure_on_face;
use crate::record::probe::stencil::Stencil;
use crate::schedule::Resources;
use crate::symmetry::Map;
use crate::world::{
    BodyId, Column, Damage, DeformationGradient, Force, MissingColumn, Mobility, PiolaStress, PlasticStrain,
    Position, ReferenceVolume, World,
};

/// Force from outside on the particles near a point that no traction explains, over their stress times their
/// area: up to the first the traction is known, from the second on it is not.
const UNEXPLAINED: [f64; 2] = [0.05, 0.2];
/// Logarithmic stretch along the normal from which on nothing is known of the traction on a body whose
/// kernels have present distances: loads are then shared by more or fewer layers than at the start.
const OTHER_LAYERS: f64 = 0.2;

/// A point at or below a surface.
pub(super) struct PointBelow {
    /// Outward normal in the reference configuration.
    pub normal: DVec3,
    /// Share of the change of the traction at the surface that the stress has here.
    pub fade: f64,
    /// The particles near it, at the places for which their deformation gradients hold.
    pub stencil: Stencil,
    /// The same of the point of the surface above it.
    pub foot: Stencil,
    /// The point of the surface, by the places of the particles.
    pub place: Stencil,
    /// What each of these carries of this side of the body in the reference configuration, outwards, m2 (m),
    /// by its number and that of its map.
    pub surfaces: Vec<(u32, u32, DVec3)>,
}

/// Points of a body, with those of them that are at a surface.
pub(in crate::record::probe) struct SurfacePoints {
    pub(super) body: BodyId,
    /// lambda / (lambda + 2 mu).
    pub(super) coupling: f64,
    /// Whether the material may flow.
    pub(super) flows: bool,
    /// Whether as many layers as at the start share a load, however deformed they are.
    pub(super) keeps_layers: bool,
    /// Acceleration of gravity, m/s2.
    pub(super) gravity: DVec3,
    /// By which the body goes on beyond symmetry planes and periods.
    pub(super) maps: Vec<Map>,
    pub(super) points: Vec<Option<PointBelow>>,
}

/// Stress at a point of a surface.
pub(in crate::record::probe) struct SurfaceStress {
    /// Cauchy stress, Pa.
    pub stress: Sym3,
    /// Whether it is right: 1 if the traction on the surface is known and the material is elastic, 0 if not.
    pub share: f64,
}

impl SurfacePoints {
    /// Names of the columns that it reads.
    pub fn needs() -> [&'static str; 5] {
        [DeformationGradient::NAME, PiolaStress::NAME, Force::NAME, ForceOfBody::NAME, Mobility::NAME]
    }

    /// The stress at a point, of the particles that are `there`; none where no traction is known.
    pub fn stress(
        &self,
        k: usize,
        world: &World,
        resources: &Resources,
        there: &dyn Fn(u32) -> bool,
    ) -> Result<Option<SurfaceStress>, MissingColumn> {
        let Some(point) = &self.points[k] else { return Ok(None) };
        let axes = world.dimension().count();
        let foot = StressesNearby::read(self, world, point.foot.shares_of_images(axes, there))?;
        let loaded = self.loaded(&point.surfaces, world, there)?;
        let traction = SurfaceTraction::of(&loaded);
        let normal = foot.deformation().inverse().transpose() * point.normal;
        let left = loaded.iter().map(|of| traction.left(of).length()).sum();
        let share = foot.explained(left, axes) * self.known_layers(normal.length());
        if share == 0.0 {
            return Ok(None);
        }
        let normal = normal.normalize_or_zero();
        let mut excess = foot.stress() * normal - traction.on(normal);
        if let Some(pressure) = self.pressure_of_fluids(point, normal, (world, resources), there)? {
            // Their friction is not known at the surface: along it the stress is extrapolated.
            excess = (excess.dot(normal) + pressure) * normal;
        }
        let of_traction = self.of_traction(excess, normal) * point.fade;
        let near = StressesNearby::read(self, world, point.stencil.shares_of_images(axes, there))?;
        Ok(Some(SurfaceStress { stress: Sym3::symmetric_part(near.stress() - of_traction), share }))
    }

    /// 1 if a load is shared by the layers of the start, 0 if it is not, by one over the stretch along the
    /// normal.
    fn known_layers(&self, compression: f64) -> f64 {
        if self.keeps_layers { 1.0 } else { (1.0 - compression.ln().abs() / OTHER_LAYERS).max(0.0) }
    }

    /// Pressure of the fluids on the surface at a point, Pa, as a sensor shows it there; none where there is
    /// none. Their forces act on rows of particles as deep as their kernel is wide: those on the outermost
    /// row alone are no traction.
    fn pressure_of_fluids(
        &self,
        point: &PointBelow,
        normal: DVec3,
        (world, resources): (&World, &Resources),
        there: &dyn Fn(u32) -> bool,
    ) -> Result<Option<f64>, MissingColumn> {
        let (view, rows) = world.body_view(self.body);
        let Some(cloud) = FlowCloud::whole(resources).filter(|_| view.has::<CouplingForce>()) else {
            return Ok(None);
        };
        let position = view.read::<Position>()?;
        let shares = point.place.shares_of_images(world.dimension().count(), there);
        let place = |&(particle, map, share): &(u32, u32, f64)| {
            share * self.maps[map as usize].place(position[rows.start + particle as usize].0)
        };
        let at = shares.iter().map(place).sum();
        let pressure = pressure_on_face(&cloud, at, normal, self.gravity);
        Ok((pressure != 0.0).then_some(pressure))
    }

    /// The particles that carry these parts of the surface, with the forces from outside on them, without
    /// those of fluids.
    fn loaded(
        &self,
        surfaces: &[(u32, u32, DVec3)],
        world: &World,
        there: &dyn Fn(u32) -> bool,
    ) -> Result<Vec<LoadedParticle>, MissingColumn> {
        let (view, rows) = world.body_view(self.body);
        let (force, internal) = (view.read::<Force>()?, view.read::<ForceOfBody>()?);
        let deformation = view.read::<DeformationGradient>()?;
        let of_fluids = if view.has::<CouplingForce>() { Some(view.read::<CouplingForce>()?) } else { None };
        let of = |&(particle, map, surface): &(u32, u32, DVec3)| {
            let (row, map) = (rows.start + particle as usize, &self.maps[map as usize]);
            let gradient = map.tensor(deformation[row].0);
            let surface = gradient.determinant() * (gradient.inverse().transpose() * surface);
            let of_fluids = of_fluids.as_ref().map_or(DVec3::ZERO, |of_fluids| of_fluids[row].0);
            LoadedParticle { surface, force: map.vector(force[row].0 - internal[row].0 - of_fluids) }
        };
        Ok(surfaces.iter().filter(|carried| there(carried.0)).map(of).collect())
    }

    /// What a stress at a surface has of such a traction there, at constant strains along the surface.
    fn of_traction(&self, traction: DVec3, normal: DVec3) -> DMat3 {
        let pull = traction.dot(normal);
        let along = traction - pull * normal;
        let dyad = |a: DVec3, b: DVec3| DMat3::from_cols(a * b.x, a * b.y, a * b.z);
        dyad(normal, normal) * pull
            + dyad(along, normal)
            + dyad(normal, along)
            + (DMat3::IDENTITY - dyad(normal, normal)) * (self.coupling * pull)
    }
}

/// The particles near a point.
struct StressesNearby {
    shares: Vec<f64>,
    deformation: Vec<DMat3>,
    stress: Vec<DMat3>,
    /// Of the cells, m2 (m).
    area: Vec<f64>,
    /// Whether any of them is held, or has flowed or failed.
    is_bound: bool,
}

impl StressesNearby {
    fn read(
        points: &SurfacePoints,
        world: &World,
        shares: Vec<(u32, u32, f64)>,
    ) -> Result<Self, MissingColumn> {
        let (view, rows) = world.body_view(points.body);
        let axes = world.dimension().count();
        let at = |n: &(u32, u32, f64)| rows.start + n.0 as usize;
        let (f, p) = (view.read::<DeformationGradient>()?, view.read::<PiolaStress>()?);
        let mobility = view.read::<Mobility>()?;
        let volume = view.read::<ReferenceVolume>()?;
        let image = |n: &(u32, u32, f64), tensor: DMat3| points.maps[n.1 as usize].tensor(tensor);
        let is_held = |row: usize| (0..axes).any(|axis| mobility[row].0[axis] == 0.0);
        let mut is_bound = shares.iter().any(|n| is_held(at(n)));
        if points.flows {
            // A law of which nothing is known but that it remembers.
            is_bound |= !view.has::<PlasticStrain>();
            if view.has::<PlasticStrain>() {
                let strain = view.read::<PlasticStrain>()?;
                is_bound |= shares.iter().any(|n| strain[at(n)].0 > 0.0);
            }
        }
        if view.has::<Damage>() {
            let damage = view.read::<Damage>()?;
            is_bound |= shares.iter().any(|n| damage[at(n)].0 > 0.0);
        }
        let power = (axes as f64 - 1.0) / axes as f64;
        Ok(Self {
            shares: shares.iter().map(|n| n.2).collect(),
            deformation: shares.iter().map(|n| image(n, f[at(n)].0)).collect(),
            stress: shares.iter().map(|n| image(n, cauchy((&f[at(n)], &p[at(n)])).to_matrix())).collect(),
            area: shares.iter().map(|n| volume[at(n)].0.powf(power)).collect(),
            is_bound,
        })
    }

    /// 1 if a traction is all that acts on the particles from outside, 0 if it leaves forces, N, that are
    /// large beside the stress.
    fn explained(&self, left: f64, axes: usize) -> f64 {
        if self.is_bound || self.shares.len() <= axes {
            return 0.0;
        }
        let stress: f64 = self
            .stress
            .iter()
            .zip(&self.area)
            .map(|(stress, area)| Sym3::symmetric_part(*stress).norm() * area)
            .sum();
        let over = if left > 0.0 { left / stress } else { 0.0 };
        ((UNEXPLAINED[1] - over) / (UNEXPLAINED[1] - UNEXPLAINED[0])).clamp(0.0, 1.0)
    }

    /// The deformation gradient at the point.
    fn deformation(&self) -> DMat3 {
        self.sum(self.deformation.iter().copied())
    }

    /// Cauchy stress at the point, Pa.
    fn stress(&self) -> DMat3 {
        self.sum(self.stress.iter().copied())
    }

    fn sum(&self, values: impl Iterator<Item = DMat3>) -> DMat3 {
        self.shares.iter().zip(values).fold(DMat3::ZERO, |sum, (share, value)| sum + value * *share)
    }
}
