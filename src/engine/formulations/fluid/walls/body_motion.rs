//! The motion of a whole body, where it is one affine map: of a wall or a rigid body that moves and turns.

use glam::{DMat3, DVec3};

use crate::formulations::fluid::lanes::FlowParticle;
use crate::linalg::dyad;
use crate::neighbors::Periodic;
use crate::parallel::sum_over_blocks;
use crate::world::ReferencePosition;

/// Largest distance of a particle from where the map puts it, over the spacing.
const MARGIN: f64 = 1e-6;
/// Minimum determinant of the moments of a body that fixes a map, over that of a body of equal width along
/// all axes.
const FLAT: f64 = 1e-9;
/// `X = home + map (x - now)`: from a place to where it is in the body as the scene has it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyMotion {
    now: DVec3,
    home: DVec3,
    pub map: DMat3,
}

impl BodyMotion {
    /// That of particles whose places in the scene are these, if one map fits all of them.
    pub fn new(
        records: &[FlowParticle],
        reference: &[ReferencePosition],
        spacing: f64,
        plane: bool,
    ) -> Option<Self> {
        let square = (MARGIN * spacing).powi(2);
        type Rows<'a> = (&'a [FlowParticle], &'a [ReferencePosition]);
        let fits = |motion: &Self| {
            // How many are elsewhere.
            let strays = sum_over_blocks((records, reference), &|_, (records, reference): Rows<'_>| {
                let pairs = records.iter().zip(reference);
                let is_elsewhere = |(record, home): &(&FlowParticle, &ReferencePosition)| {
                    motion.home(record.position()).distance_squared(home.0) > square
                };
                pairs.filter(is_elsewhere).count() as f64
            });
            strays == 0.0
        };
        let (now, home) = (records.first()?.position(), reference.first()?.0);
        let moved = Self { now, home, map: DMat3::IDENTITY };
        if fits(&moved) {
            return Some(moved);
        }
        let pairs = || records.iter().map(FlowParticle::position).zip(reference.iter().map(|home| home.0));
        let (mut count, mut now, mut home) = (0.0, DVec3::ZERO, DVec3::ZERO);
        for (x, origin) in pairs() {
            count += 1.0;
            now += x;
            home += origin;
        }
        (now, home) = (now / count, home / count);
        let (mut moment, mut cross) = (DMat3::ZERO, DMat3::ZERO);
        for (x, origin) in pairs() {
            moment += dyad(x - now, x - now);
            cross += dyad(origin - home, x - now);
        }
        let width = (moment.x_axis.x + moment.y_axis.y + moment.z_axis.z) / if plane { 2.0 } else { 3.0 };
        if plane {
            (moment.z_axis.z, cross.z_axis.z) = (width, width);
        }
        if moment.determinant() <= FLAT * width.powi(3) {
            return None;
        }
        let fitted = Self { now, home, map: cross * moment.inverse() };
        fits(&fitted).then_some(fitted)
    }

    /// Whether periodic images stay images of each other: nothing turns out of a periodic axis.
    pub fn keeps(&self, periodic: &Periodic) -> bool {
        let turned = |axis: usize| self.map.col(axis) - DVec3::AXES[axis];
        (0..3).filter(|&axis| periodic.axes()[axis]).all(|axis| turned(axis).length() < 1e-9)
    }

    /// Where a place is in the body as the scene has it, m.
    #[inline]
    pub fn home(&self, x: DVec3) -> DVec3 {
        self.home + self.map * (x - self.now)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parallel::Lanes4;

    fn block(plane: bool) -> Vec<DVec3> {
        let place = |k: usize| {
            DVec3::new((k % 4) as f64, (k / 4 % 3) as f64, if plane { 0.0 } else { (k / 12) as f64 })
        };
        (0..if plane { 12 } else { 24 }).map(|k| 0.01 * place(k) + DVec3::new(3.0, -2.0, 0.0)).collect()
    }

    fn motion(now: &[DVec3], home: &[DVec3], plane: bool) -> Option<BodyMotion> {
        let record = |x: &DVec3| FlowParticle { place: Lanes4::new(*x, 1.0), ..FlowParticle::default() };
        let records: Vec<FlowParticle> = now.iter().map(record).collect();
        let reference: Vec<ReferencePosition> = home.iter().map(|x| ReferencePosition(*x)).collect();
        BodyMotion::new(&records, &reference, 0.01, plane)
    }

    #[test]
    fn the_motion_of_a_body_that_moves_turns_and_stretches_takes_every_place_back() {
        for plane in [false, true] {
            let turn = if plane {
                DMat3::from_rotation_z(2.0)
            } else {
                DMat3::from_rotation_y(0.7) * DMat3::from_rotation_z(2.0)
            };
            let stretch = DMat3::from_diagonal(DVec3::new(1.2, 1.0, 1.0));
            let there = |x: DVec3| turn * (stretch * x) + DVec3::new(0.3, 5.0, 0.0);
            let home = block(plane);
            let now: Vec<DVec3> = home.iter().map(|x| there(*x)).collect();
            let found = motion(&now, &home, plane).expect("one map");
            let beside = DVec3::new(3.05, -1.97, if plane { 0.0 } else { 0.02 });
            assert!(found.home(there(beside)).distance(beside) < 1e-12);
        }
    }

    #[test]
    fn a_body_that_bends_has_none_and_one_that_moves_keeps_its_bits() {
        let home = block(true);
        let bent: Vec<DVec3> =
            home.iter().map(|x| *x + 1e-3 * DVec3::Y * (x.x - 3.0).powi(2) / 0.01).collect();
        assert_eq!(motion(&bent, &home, true), None);
        let moved: Vec<DVec3> = home.iter().map(|x| *x + DVec3::new(0.25, 0.5, 0.0)).collect();
        assert_eq!(motion(&moved, &home, true).expect("one map").map, DMat3::IDENTITY);
        // A row of particles that turns: the map is not known across it.
        let row: Vec<DVec3> = home.iter().take(4).copied().collect();
        let turned: Vec<DVec3> = row.iter().map(|x| DMat3::from_rotation_z(0.5) * *x).collect();
        assert_eq!(motion(&turned, &row, true), None);
    }
}
