//! The symmetry planes and periodic axes of the bodies of a scene.

use glam::DVec3;

use super::map::Map;
use crate::notation::number;
use crate::plugin::{BodyPlan, SetupError, SimBuilder};
use crate::scene::{Axis, Domain};

/// Symmetry plane or period of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Repeat {
    /// A mirror plane at a coordinate, m.
    Mirror {
        /// Axis that the plane is normal to.
        axis: usize,
        /// Coordinate of the plane, m.
        at: f64,
    },
    /// A period, m, of a body that fills it from `min` on.
    Period {
        /// Axis.
        axis: usize,
        /// Lower end of the body, m.
        min: f64,
        /// Length of the period, m.
        length: f64,
    },
}

impl Repeat {
    /// The axis along which it repeats.
    pub fn axis(&self) -> usize {
        match *self {
            Self::Mirror { axis, .. } | Self::Period { axis, .. } => axis,
        }
    }

    /// The coordinates of the sides beyond which the body continues, m.
    pub fn sides(&self) -> [f64; 2] {
        match *self {
            Self::Mirror { at, .. } => [at; 2],
            Self::Period { min, length, .. } => [min, min + length],
        }
    }

    /// The place of the body that is seen at `x`, m: of an image that of which it is one. `middle`, m, is on
    /// the side of a plane where the body is.
    pub fn place_seen(&self, mut x: DVec3, middle: DVec3) -> DVec3 {
        match *self {
            Self::Mirror { axis, at } => {
                if (x[axis] - at) * (middle[axis] - at) < 0.0 {
                    x[axis] = 2.0 * at - x[axis];
                }
            }
            Self::Period { axis, min, length } => x[axis] = min + (x[axis] - min).rem_euclid(length),
        }
        x
    }

    /// The maps to the images of a place that is within reach of a side.
    pub(super) fn near(&self, place: DVec3, reach: f64) -> [Option<Map>; 2] {
        match *self {
            Self::Mirror { axis, at } => {
                [((place[axis] - at).abs() < reach).then(|| Map::mirror(axis, at)), None]
            }
            Self::Period { axis, min, length } => [
                (place[axis] - min < reach).then(|| Map::shift(axis, length)),
                (min + length - place[axis] < reach).then(|| Map::shift(axis, -length)),
            ],
        }
    }
}

/// Repeats of a body with support radius `support`, m.
///
/// # Errors
/// Planes or periods that are too close for the support.
pub fn repeats_of(body: &BodyPlan, support: f64, sim: &SimBuilder<'_>) -> Result<Vec<Repeat>, SetupError> {
    let planes = sim.mirror_planes();
    let mirrors = planes.iter().filter(|plane| plane.bodies.contains(body.id));
    let mut repeats: Vec<Repeat> =
        mirrors.map(|plane| Repeat::Mirror { axis: plane.axis, at: plane.at }).collect();
    for (k, repeat) in repeats.iter().enumerate() {
        if let Some(other) = repeats[..k].iter().find(|other| other.axis() == repeat.axis())
            && let (Repeat::Mirror { at, .. }, Repeat::Mirror { at: before, .. }) = (repeat, other)
            && (at - before).abs() < support
        {
            return Err(SetupError::parameter(
                "",
                format!(
                    "two symmetry planes of body `{}` are {} m apart, less than its support radius of {support} m",
                    body.name,
                    (at - before).abs()
                ),
                "use more particles between the planes, or a smaller support",
            ));
        }
    }
    let Some(domain) = &sim.scene().domain else { return Ok(repeats) };
    for axis in &domain.periodic {
        let (length, extent) = lengths(body, domain, *axis);
        if extent > length + FILLS * body.spacing {
            return Err(SetupError::parameter(
                "",
                format!(
                    "body `{}` must not be longer than the period of {} m along {axis:?}, found {} m",
                    body.name,
                    number(length),
                    number(extent)
                ),
                "make the domain as long as the body, or the body as long as the domain",
            ));
        }
        if extent >= length - FILLS * body.spacing && length < 2.0 * support {
            return Err(SetupError::parameter(
                "",
                format!(
                    "the period of {length} m along {axis:?} is less than twice the support radius of body `{}`, \
                     {support} m",
                    body.name
                ),
                "use a longer domain, or more particles along this axis",
            ));
        }
    }
    repeats.extend(periods_of(body, sim));
    Ok(repeats)
}

/// Tolerance by which a body may be shorter than a period that it fills, over its spacing. A body that ends
/// before the period does is not joined to itself.
const FILLS: f64 = 0.5;

/// The length of the domain along an axis, and that of a body, m.
fn lengths(body: &BodyPlan, domain: &Domain, axis: Axis) -> (f64, f64) {
    let a = axis.index();
    (domain.max.0[a] - domain.min.0[a], body.bounds.max[a] - body.bounds.min[a])
}

/// The periods that a body fills.
pub fn periods_of(body: &BodyPlan, sim: &SimBuilder<'_>) -> Vec<Repeat> {
    let Some(domain) = &sim.scene().domain else { return Vec::new() };
    let period = |axis: &Axis| {
        let (length, extent) = lengths(body, domain, *axis);
        let is_filled = extent >= length - FILLS * body.spacing;
        let axis = axis.index();
        is_filled.then(|| Repeat::Period { axis, min: body.bounds.min[axis], length })
    };
    domain.periodic.iter().filter_map(period).collect()
}

/// The maps to the images that a body has beside it, beginning with the one that changes nothing: across each
/// plane and period, and across several of them along different axes.
pub fn maps_of(repeats: &[Repeat]) -> Vec<Map> {
    let mut all: Vec<(Map, [bool; 3])> = vec![(Map::IDENTITY, [false; 3])];
    for repeat in repeats {
        let ways: &[Map] = match *repeat {
            Repeat::Mirror { axis, at } => &[Map::mirror(axis, at)],
            Repeat::Period { axis, length, .. } => &[Map::shift(axis, length), Map::shift(axis, -length)],
        };
        for (map, mut axes) in all.clone() {
            if !std::mem::replace(&mut axes[repeat.axis()], true) {
                all.extend(ways.iter().map(|way| (way.after(map), axes)));
            }
        }
    }
    all.into_iter().map(|(map, _)| map).collect()
}
