//! Symmetry planes.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::notation::number;
use crate::plugin::{BodyKind, BodyPlan, Offer, Plugin, SetupError, SimBuilder};
use crate::rigid::HalvedBody;
use crate::scene::{Axis, Dimension};
use crate::symmetry::MirrorPlane;
use crate::world::{BodyId, BodySet};

/// A symmetry plane: the bodies that end at it see their own mirror image behind it, so that half a problem
/// is solved like the whole. Bodies farther from it than their spacing are left alone; rigid bodies may go on
/// behind it if their motion along its axis is prescribed. For a fluid, a `Wall` with free slip behind the
/// plane is the same; beside solids that are cut, fluids and the walls behind them may end at the plane.
///
/// The lower left quarter of a punch: `Symmetry(plane: X, at: 0.0), Symmetry(plane: Y, at: 0.0)`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Symmetry {
    /// Axis that the plane is normal to.
    pub plane: Axis,
    /// Coordinate of the plane along this axis \[m\].
    pub at: f64,
    /// Bodies on this side only. Default: both sides; they do not see each other through the plane.
    #[serde(default)]
    pub side: Option<Side>,
}

/// A side of a plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
pub enum Side {
    /// Smaller coordinates.
    Below,
    /// Larger coordinates.
    Above,
}

/// Minimum distance of a particle from the plane, as a share of the spacing.
const MIN_DISTANCE: f64 = 0.05;

impl Plugin for Symmetry {
    const NAME: &'static str = "Symmetry";
    const REFERENCE: &'static str = "";

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        let axis = self.plane.index();
        if sim.dimension() == Dimension::Two && self.plane == Axis::Z {
            let help = "planes normal to X and Y are possible";
            return Err(SetupError::parameter("plane", "a two-dimensional scene has no axis Z", help));
        }
        if sim.scene().domain.as_ref().is_some_and(|domain| domain.periodic.contains(&self.plane)) {
            let message =
                format!("the domain is periodic along {:?}, and has a symmetry plane there", self.plane);
            return Err(SetupError::parameter("plane", message, "leave out one of the two"));
        }
        let mut cut = Vec::new();
        // Walls have no stress that an image could take up.
        let mut halved = Vec::new();
        for body in sim.bodies().iter().filter(|body| body.kind != BodyKind::Boundary) {
            if body.kind == BodyKind::Rigid {
                // A tool may go on behind the plane: what touches it touches its surface.
                halved.extend(self.cuts(body).unwrap_or(true).then_some(body.id));
            } else if self.cuts(body)? {
                cut.push(body.id);
            }
        }
        if cut.is_empty() {
            return Err(self.no_body(sim));
        }
        let mirrored = self.mirrored(&cut, sim)?;
        for body in halved {
            sim.extend(HalvedBody { body, axis });
        }
        sim.extend(MirrorPlane { axis, at: self.at, bodies: BodySet::new(mirrored) });
        Ok(())
    }
}

/// The symmetry planes of the scene at which a body ends, whether their conditions are built already or not.
pub(super) fn planes_of(body: &BodyPlan, sim: &SimBuilder<'_>) -> Vec<MirrorPlane> {
    let items = sim.scene().conditions.iter().filter(|item| item.name() == Symmetry::NAME);
    // A fault of a plane is reported where its condition is built.
    let planes = items.filter_map(|item| item.parse::<Symmetry>().ok());
    let cut = planes.filter(|own| body.offers(Offer::MirrorImages) && own.cuts(body).unwrap_or(false));
    let plane =
        |own: Symmetry| MirrorPlane { axis: own.plane.index(), at: own.at, bodies: BodySet::new([body.id]) };
    cut.map(plane).collect()
}

impl Symmetry {
    /// That no body ends at the plane.
    fn no_body(&self, sim: &SimBuilder<'_>) -> SetupError {
        let axis = self.plane.index();
        let extent = |body: &BodyPlan| {
            let (min, max) = (number(body.bounds.min[axis]), number(body.bounds.max[axis]));
            format!("`{}` extends from {min} to {max}", body.name)
        };
        let extents: Vec<String> = sim.bodies().iter().map(extent).collect();
        SetupError::parameter(
            "at",
            format!("no body ends at the symmetry plane {:?} = {}", self.plane, self.at),
            format!("along {:?}, {}", self.plane, extents.join("; ")),
        )
    }

    /// Those of the bodies that end at the plane which get an image; a fluid that a wall holds beside them
    /// needs none.
    fn mirrored(&self, cut: &[BodyId], sim: &SimBuilder<'_>) -> Result<Vec<BodyId>, SetupError> {
        let mirrored = cut.iter().copied().filter(|id| sim.body(*id).offers(Offer::MirrorImages));
        let mirrored: Vec<BodyId> = mirrored.collect();
        for body in cut.iter().filter(|id| !mirrored.contains(id)).map(|id| sim.body(*id)) {
            let fluid = body.kind == BodyKind::Fluid;
            if fluid && !mirrored.is_empty() && self.is_held(body, sim) {
                continue;
            }
            let BodyPlan { name, formulation, .. } = body;
            let message = format!(
                "body `{name}` ends at a symmetry plane, and bodies with the formulation `{formulation}` have no mirror images"
            );
            let help = if fluid {
                "for a fluid, a `Wall` with free slip behind the plane does the same; the plane is for solids beside it"
            } else {
                "fix its motion along the axis instead"
            };
            return Err(SetupError::parameter("plane", message, help));
        }
        Ok(mirrored)
    }

    /// Whether the body ends at the plane.
    fn cuts(&self, body: &BodyPlan) -> Result<bool, SetupError> {
        let axis = self.plane.index();
        let distances = || body.sites.iter().map(|site| site.position[axis] - self.at);
        let least = distances().fold(f64::INFINITY, f64::min);
        let most = distances().fold(f64::NEG_INFINITY, f64::max);
        match self.side {
            Some(Side::Above) if most < 0.0 => return Ok(false),
            Some(Side::Below) if least > 0.0 => return Ok(false),
            _ => {}
        }
        let nearest = distances().map(f64::abs).fold(f64::INFINITY, f64::min);
        if (least < 0.0 && most > 0.0) || nearest < MIN_DISTANCE * body.spacing {
            return Err(SetupError::parameter(
                "at",
                format!(
                    "the symmetry plane {:?} = {} crosses body `{}`, which extends from {} to {}",
                    self.plane,
                    number(self.at),
                    body.name,
                    number(body.bounds.min[axis]),
                    number(body.bounds.max[axis])
                ),
                "let the shape of the body end at the plane",
            ));
        }
        Ok(nearest < body.spacing)
    }

    /// Whether there is a wall behind the plane at which a fluid ends.
    fn is_held(&self, fluid: &BodyPlan, sim: &SimBuilder<'_>) -> bool {
        let axis = self.plane.index();
        let beyond = |body: &BodyPlan, side: f64| {
            body.sites
                .iter()
                .any(|site| (0.0..body.spacing).contains(&(side * (site.position[axis] - self.at))))
        };
        let side = if beyond(fluid, 1.0) { -1.0 } else { 1.0 };
        sim.bodies().iter().any(|body| body.kind == BodyKind::Boundary && beyond(body, side))
    }
}
