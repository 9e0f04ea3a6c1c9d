//! Vector functions of place and time, as conditions use them.

use glam::DVec3;

use super::part::Part;
use crate::notation::{place, quantity};
use crate::parallel::{BlockSum, sum_over_blocks};
use crate::plugin::{SetupError, SimBuilder};
use crate::scene::{Dimension, Expression, PerAxis};
use crate::schedule::StepError;

/// A vector function of place and time; an axis without function is zero.
#[derive(Clone, Debug)]
pub(super) struct VectorField {
    components: [Option<Expression>; 3],
}

/// Number, counted from one, of the first value that is not finite; zero if there is none.
#[derive(Clone, Copy, Default)]
struct FirstBad(usize);

impl BlockSum for FirstBad {
    fn add(&mut self, next: &Self) {
        if self.0 == 0 {
            self.0 = next.0;
        }
    }
}

impl VectorField {
    /// The function that a scene gives as `value`. It is an error if no axis has one, or if it leaves the
    /// plane of a two-dimensional scene.
    pub fn new(value: PerAxis<Expression>, sim: &SimBuilder<'_>) -> Result<Self, SetupError> {
        let mut components = value.0;
        if sim.dimension() == Dimension::Two
            && let Some(z) = components[2].take()
            && !(z.is_constant() && z.eval(DVec3::ZERO, 0.0) == 0.0)
        {
            return Err(SetupError::parameter(
                "value[2]",
                "a two-dimensional scene has no axis z",
                "give two entries, `(x, y)`",
            ));
        }
        if components.iter().all(Option::is_none) {
            return Err(SetupError::parameter(
                "value",
                "no axis has a value",
                "give a number or an expression for at least one axis; `None` leaves an axis unconstrained",
            ));
        }
        Ok(Self { components })
    }

    /// The axes that have a function.
    pub fn axes(&self) -> [bool; 3] {
        [0, 1, 2].map(|axis| self.components[axis].is_some())
    }

    /// Whether there is a value along an axis that is not zero everywhere.
    pub fn acts_along(&self, axis: usize) -> bool {
        let zero = |f: &Expression| f.is_constant() && f.eval(DVec3::ZERO, 0.0) == 0.0;
        self.components[axis].as_ref().is_some_and(|f| !zero(f))
    }

    /// Whether the values change with time.
    pub fn depends_on_time(&self) -> bool {
        self.components.iter().flatten().any(Expression::depends_on_time)
    }

    /// Whether a load keeps its values on the particles of a part: where they are in space, they come to
    /// other places.
    pub fn is_constant(&self, part: &Part) -> bool {
        !(self.depends_on_time() || part.in_space && self.depends_on_place())
    }

    /// The functions of its axes.
    pub fn functions(&self) -> impl Iterator<Item = &Expression> {
        self.components.iter().flatten()
    }

    /// Whether the values differ from place to place.
    pub fn depends_on_place(&self) -> bool {
        self.components.iter().flatten().any(Expression::depends_on_place)
    }

    /// The value at one place.
    pub fn at(&self, point: DVec3, t: f64) -> DVec3 {
        let component = |axis: usize| self.components[axis].as_ref().map_or(0.0, |f| f.eval(point, t));
        DVec3::new(component(0), component(1), component(2))
    }

    /// An error unless the values at the start are finite on all parts; `what` names them.
    pub fn require_finite(&self, parts: &[Part], what: &str) -> Result<(), SetupError> {
        let values = parts.iter().flat_map(|part| &part.points).map(|&point| (point, self.at(point, 0.0)));
        match values.into_iter().find(|(_, value)| !value.is_finite()) {
            None => Ok(()),
            Some((point, value)) => Err(SetupError::parameter(
                "value",
                format!("the {what} must be finite, found {} at {} m", place(value), place(point)),
                "give an expression that is finite on all selected particles",
            )),
        }
    }

    /// The values at the given places; `by` names the condition in errors.
    pub fn values(&self, points: &[DVec3], t: f64, by: &str, out: &mut Vec<DVec3>) -> Result<(), StepError> {
        out.clear();
        out.resize(points.len(), DVec3::ZERO);
        let rows = (&mut out[..], points);
        let bad = sum_over_blocks(rows, &|first, (out, points): (&mut [DVec3], &[DVec3])| {
            let mut bad = FirstBad::default();
            for (k, (value, &point)) in out.iter_mut().zip(points).enumerate() {
                *value = self.at(point, t);
                if bad.0 == 0 && !value.is_finite() {
                    bad.0 = first + k + 1;
                }
            }
            bad
        });
        if bad.0 == 0 {
            return Ok(());
        }
        Err(not_finite(points[bad.0 - 1], out[bad.0 - 1], t, by))
    }
}

/// The error of a value that is not finite at a place and time; `by` names the condition.
pub(super) fn not_finite(point: DVec3, value: DVec3, t: f64, by: &str) -> StepError {
    let message = format!(
        "the value must be finite, found {} at the place {} m and {}",
        place(value),
        place(point),
        quantity(t, "s")
    );
    StepError::System { system: by.to_owned(), message }
}
