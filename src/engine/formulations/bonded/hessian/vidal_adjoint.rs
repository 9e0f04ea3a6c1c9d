//! The passes of the form of the paper ([`vidal_2007`](super::vidal_2007)): the gradients that it compares,
//! and the adjoint of their differences in stress and force.

use glam::{DMat3, DVec3};

use super::super::bonds::Bonds;
use super::super::gather::fit_gradients;
use super::super::pairs::BodyKernel;
use super::super::rows::PackedParticle;
use super::rows::{BondedSites, HessianBody, HessianRows};
use super::vidal_2007::{VidalBody, VidalRows, along};
use crate::parallel::{FourLanes, HotLoop, for_each_own_block, run_hot};
use crate::solids::{CorrectedStress, HessianForm};
use crate::world::Force;

impl HessianRows {
    /// Before the stress: takes in a new reference, and fits the gradients that the difference needs of all
    /// rows.
    pub fn begin(&mut self, bonded: BondedSites<'_>, kernels: &[BodyKernel], support: &[f64], plane: bool) {
        let BondedSites { bonds, ghosts, sites } = bonded;
        let is_stale = std::mem::take(&mut self.is_stale);
        if !self.has(HessianForm::Vidal2007) {
            return;
        }
        let Self { bodies, gradient, vidal, .. } = self;
        let own = bodies.iter().filter(|body| body.term.form == HessianForm::Vidal2007);
        if is_stale {
            vidal.resize(support.len(), ghosts.len(), bonds.len());
            for HessianBody { body, rows, .. } in own.clone() {
                let kernel = kernels[*body].kernel;
                vidal.renew(&VidalBody { bonds, ghosts, sites, kernel, support }, rows.clone());
            }
            vidal.renew_ghosts(ghosts);
        }
        for HessianBody { rows, .. } in own {
            fit_gradients(bonds, sites, plane, rows.start, &mut gradient[rows.clone()]);
        }
        self.fill_ghost_gradients(ghosts);
    }

    /// Adds the stresses of the form to the corrected stresses, after the stress of all bodies.
    pub fn add_vidal_stress(
        &mut self,
        bonded: BondedSites<'_>,
        stresses: &mut [CorrectedStress],
        self_force: &mut [DVec3],
    ) {
        let BondedSites { bonds, ghosts, sites } = bonded;
        if !self.has(HessianForm::Vidal2007) {
            return;
        }
        ghosts.fill(&mut self.stress, |ghost, stress| ghost.map.tensor(*stress));
        for HessianBody { rows, term, .. } in self.with_form(HessianForm::Vidal2007) {
            let own = (&mut stresses[rows.clone()], &mut self_force[rows.clone()]);
            type Rows<'a> = (&'a mut [CorrectedStress], &'a mut [DVec3]);
            for_each_own_block(own, &mut Vec::new(), &|first, (stresses, self_force): Rows<'_>| {
                let (vidal, theta, first) = (&self.vidal, &self.stress[..], rows.start + first);
                let eta = term.eta;
                run_hot(AdjointStress { vidal, theta, bonds, sites, eta, first, stresses, self_force });
            });
        }
    }

    /// Adds the forces that act along the second derivatives.
    pub fn add_vidal_force(&self, bonds: &Bonds, sites: &[PackedParticle], force: &mut [Force]) {
        for HessianBody { rows, term, .. } in self.with_form(HessianForm::Vidal2007) {
            let force = &mut force[rows.clone()];
            for_each_own_block(force, &mut Vec::new(), &|first, force: &mut [Force]| {
                let (vidal, theta, first) = (&self.vidal, &self.stress[..], rows.start + first);
                run_hot(AdjointForce { vidal, theta, bonds, sites, eta: term.eta, first, force });
            });
        }
    }
}

struct AdjointStress<'a> {
    vidal: &'a VidalRows,
    theta: &'a [DMat3],
    bonds: &'a Bonds,
    sites: &'a [PackedParticle],
    eta: f64,
    first: usize,
    stresses: &'a mut [CorrectedStress],
    self_force: &'a mut [DVec3],
}

impl HotLoop for AdjointStress<'_> {
    type Output = ();

    #[inline(always)]
    fn run<A: FourLanes>(self, _: A) {
        let Self { vidal, theta, bonds, sites, eta, first, stresses, self_force } = self;
        let VidalRows { shift, .. } = vidal;
        for (k, (stress, self_force)) in stresses.iter_mut().zip(self_force).enumerate() {
            let i = first + k;
            let x = sites[i].reference.xyz();
            let first_moment = bonds.first_moment[i];
            let mut sum = theta[i] * shift[i].dot(first_moment);
            for bond in bonds.offsets[i] as usize..bonds.offsets[i + 1] as usize {
                let j = bonds.neighbors[bond] as usize;
                let other = &sites[j].reference;
                let arm = (other.xyz() - x) * (f64::from(bonds.weights[bond]) * other.0[3]);
                sum += theta[j] * shift[j].dot(arm);
            }
            let own = sum * bonds.inverse_moment[i].to_matrix() * eta;
            stress.add(&own, x);
            *self_force += own * first_moment;
        }
    }
}

struct AdjointForce<'a> {
    vidal: &'a VidalRows,
    theta: &'a [DMat3],
    bonds: &'a Bonds,
    sites: &'a [PackedParticle],
    eta: f64,
    first: usize,
    force: &'a mut [Force],
}

impl HotLoop for AdjointForce<'_> {
    type Output = ();

    #[inline(always)]
    fn run<A: FourLanes>(self, _: A) {
        let Self { vidal, theta, bonds, sites, eta, first, force } = self;
        let VidalRows { curvature, step, correction, .. } = vidal;
        for (k, force) in force.iter_mut().enumerate() {
            let i = first + k;
            let site = &sites[i].reference;
            let mut sum = DVec3::ZERO;
            for bond in bonds.offsets[i] as usize..bonds.offsets[i + 1] as usize {
                let j = bonds.neighbors[bond] as usize;
                let other = &sites[j].reference;
                let arm = other.xyz() - site.xyz();
                let (b, weight) = (f64::from(curvature[bond]), f64::from(bonds.weights[bond]));
                let own = theta[i] * (along(b, weight, arm, step[i]) - correction[i] * arm);
                let theirs = theta[j] * (along(b, weight, arm, step[j]) + correction[j] * arm);
                sum += (own - theirs) * other.0[3];
            }
            force.0 += sum * (eta * site.0[3]);
        }
    }
}
