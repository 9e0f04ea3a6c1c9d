//! Prescribed velocities that are meant as a rotation.
//!
//! `Velocity` is a function of the reference position, so that a particle whose velocity there is that of a
//! rotation keeps its direction: by the angle a it comes to sqrt(1 + a^2) times its distance from the axis.

use glam::{DMat3, DVec3};

use super::field::VectorField;
use crate::linalg::Sym3;
use crate::notation::quantity_to;
use crate::plugin::{BodyKind, Selection, SimBuilder};

/// Angle from which a rotation is one, rad: the particles are then 2 % farther from the axis.
const ANGLE: f64 = 0.2;
/// Share of the skew part in the square of the gradient of the displacement from which it is a rotation: that
/// of a simple shear, which straight lines describe exactly, is one half.
const SHARE: f64 = 0.9;
/// Moment across flat selections, over the sum of the moments.
const FLAT: f64 = 1e-9;
/// Times of a run at which it is looked at.
const TIMES: u32 = 64;
/// Largest number of particles that are looked at.
const PARTICLES: usize = 1000;

/// Warns of a velocity that is that of a rotation at the reference positions of a body that is not rigid.
pub(super) fn warn(field: &VectorField, selection: &Selection, sim: &mut SimBuilder<'_>) {
    if !field.depends_on_place() {
        return;
    }
    let end = sim.scene().time.end;
    let mut warnings = Vec::new();
    for (id, rows) in &selection.parts {
        let body = sim.body(*id);
        if body.kind == BodyKind::Rigid {
            continue;
        }
        let places = rows.iter().step_by(rows.len().div_ceil(PARTICLES).max(1));
        let places: Vec<DVec3> =
            places.map(|&row| body.sites[row as usize - body.rows.start].position).collect();
        let Some(angle) = angle_of(field, &places, end) else { continue };
        let (turns, grows) = (quantity_to(angle, "rad", 2), quantity_to(angle.hypot(1.0), "1", 3));
        warnings.push(format!(
            "`Velocity` turns `{}` by {turns} at its reference positions, but its particles move along straight lines: the body becomes {grows} times as large; give `Displacement` with the cosine and sine of the angle, or make it a `Rigid` body with `RotationRate`",
            body.name
        ));
    }
    warnings.into_iter().for_each(|warning| sim.warn(warning));
}

/// The largest angle, rad, by which the displacement of particles is that of a rotation within a run.
fn angle_of(field: &VectorField, places: &[DVec3], end: f64) -> Option<f64> {
    let centre = places.iter().sum::<DVec3>() / places.len() as f64;
    let moment = places.iter().fold(Sym3::ZERO, |sum, x| sum + Sym3::dyad(*x - centre));
    // In a plane or on a line nothing is known of the gradient across: it counts as none.
    let across = Sym3::IDENTITY * (FLAT * moment.trace());
    let inverse = (moment + across).inverse().to_matrix();
    let step = end / f64::from(TIMES);
    let mut displacement = DMat3::ZERO;
    let mut largest: Option<f64> = None;
    for k in 0..TIMES {
        let t = step * (f64::from(k) + 0.5);
        let sum = places.iter().fold(DMat3::ZERO, |sum, &x| {
            let (v, r) = (field.at(x, t), x - centre);
            sum + DMat3::from_cols(v * r.x, v * r.y, v * r.z)
        });
        displacement += sum * inverse * step;
        let skew = (displacement - displacement.transpose()) * 0.5;
        let square = |a: DMat3| Sym3::gram(a).trace();
        let angle = (0.5 * square(skew)).sqrt();
        // 2 a^2 on straight lines, zero on circles: a velocity that changes with time may follow them.
        let growth = square(DMat3::IDENTITY + displacement) - 3.0;
        if angle > ANGLE && square(skew) > SHARE * square(displacement) && growth > angle * angle {
            largest = Some(largest.map_or(angle, |most| most.max(angle)));
        }
    }
    largest
}
