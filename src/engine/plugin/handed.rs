//! Contributions of plugins while a simulation is built: terms for the formulations of bodies, fields,
//! recorders, rules of removal. Terms are assigned by body. A term or value that no formulation or plugin has
//! accepted is an error.

use std::any::{Any, TypeId, type_name};
use std::cell::Cell;
use std::collections::BTreeMap;
use std::sync::Arc;

use super::error::SetupError;
use super::plan::BodyPlan;
use crate::scene::{Item, Problem, SourcePlace};
use crate::world::{BodyId, BodySet};

/// A value that was handed to the formulations of bodies, with those of the bodies that the taker asked for.
pub struct ForBodies<T> {
    /// Bodies of the taker.
    pub bodies: BodySet,
    /// The value; formulations of other bodies may have it, too.
    pub value: Arc<T>,
}

/// A value for bodies.
struct Term {
    by: Option<Item>,
    /// Description for errors: `a pair term`.
    what: &'static str,
    /// Bodies whose formulations have not taken it.
    left: BodySet,
    value: Arc<dyn Any + Send + Sync>,
}

/// A value that concerns the whole simulation.
struct ForAll {
    by: Option<Item>,
    /// The Rust type of the value, for errors.
    type_name: &'static str,
    /// Whether the value may remain unused.
    is_note: bool,
    /// Whether somebody has looked at it.
    is_seen: Cell<bool>,
    value: Box<dyn Any>,
}

/// All that was handed in and not yet taken. Values of one type keep the order in which they came.
#[derive(Default)]
pub(crate) struct Contributions {
    /// The plugin, condition or formulation that is being built.
    pub by: Option<Item>,
    /// Values that concern the whole simulation.
    whole: BTreeMap<TypeId, Vec<ForAll>>,
    terms: BTreeMap<TypeId, Vec<Term>>,
}

impl Contributions {
    pub fn put<T: 'static>(&mut self, value: T, is_note: bool) {
        let value = ForAll {
            by: self.by.clone(),
            type_name: type_name::<T>(),
            is_note,
            is_seen: Cell::new(false),
            value: Box::new(value),
        };
        self.whole.entry(TypeId::of::<T>()).or_default().push(value);
    }

    pub fn count<T: 'static>(&self) -> usize {
        self.whole.get(&TypeId::of::<T>()).map_or(0, Vec::len)
    }

    pub fn take<T: 'static>(&mut self) -> Vec<T> {
        let all = self.whole.remove(&TypeId::of::<T>()).unwrap_or_default();
        all.into_iter().filter_map(|of| of.value.downcast().ok()).map(|boxed| *boxed).collect()
    }

    pub fn all<T: 'static>(&self) -> impl Iterator<Item = &T> {
        let all = self.whole.get(&TypeId::of::<T>()).into_iter().flatten();
        all.filter_map(|of| {
            of.is_seen.set(true);
            of.value.downcast_ref()
        })
    }

    pub fn put_for<T: Send + Sync + 'static>(&mut self, bodies: BodySet, what: &'static str, value: T) {
        let term = Term { by: self.by.clone(), what, left: bodies, value: Arc::new(value) };
        self.terms.entry(TypeId::of::<T>()).or_default().push(term);
    }

    /// Takes the values of a type for the bodies that `wanted` accepts; the rest is left for others.
    pub fn take_for<T: Send + Sync + 'static>(
        &mut self,
        wanted: impl Fn(BodyId) -> bool,
    ) -> Vec<ForBodies<T>> {
        let mut taken = Vec::new();
        for term in self.terms.get_mut(&TypeId::of::<T>()).into_iter().flatten() {
            let bodies = BodySet::new(term.left.iter().filter(|&id| wanted(id)));
            if bodies.is_empty() {
                continue;
            }
            term.left = BodySet::new(term.left.iter().filter(|&id| !wanted(id)));
            if let Ok(value) = Arc::clone(&term.value).downcast() {
                taken.push(ForBodies { bodies, value });
            }
        }
        taken
    }

    /// Problems of terms and values that nobody has accepted.
    pub fn problems(&self, bodies: &[BodyPlan]) -> Vec<Problem> {
        let place = |by: &Option<Item>, message: String, help: String| match by {
            Some(item) => item.problem("", message, help),
            None => Problem { at: SourcePlace::Scene, ..Problem::new(message).help(help) },
        };
        let terms = self.terms.values().flatten().flat_map(|term| {
            term.left.iter().map(|id| {
                let BodyPlan { name, formulation, .. } = &bodies[id.0];
                let message = format!(
                    "body `{name}` was given {}, which bodies with the formulation `{formulation}` do not take",
                    term.what
                );
                place(&term.by, message, "leave it out for this body, or give the body another formulation".to_owned())
            })
        });
        let is_left = |of: &&ForAll| !of.is_note && !of.is_seen.get();
        let whole = self.whole.values().flatten().filter(is_left).map(|of| {
            let name = of.type_name.rsplit("::").next().unwrap_or(of.type_name).trim_end_matches('>');
            let message = format!("a value of type `{name}` was handed in, and nothing takes it");
            let help = "hand in a type that the engine or a plugin takes, or leave a note (`SimBuilder::leave_note`)";
            place(&of.by, message, help.to_owned())
        });
        terms.chain(whole).collect()
    }
}

impl super::SimBuilder<'_> {
    /// Passes a value to the part of the engine, or the other plugin, that takes values of its type. A value
    /// that nothing takes or reads is an error.
    pub fn extend<T: 'static>(&mut self, value: T) {
        self.handed.put(value, false);
    }

    /// Leaves a value for others that look for one of its type, such as a later item of the same plugin: it
    /// is no error if there are none.
    pub fn leave_note<T: 'static>(&mut self, value: T) {
        self.handed.put(value, true);
    }

    /// Takes all values of type `T`, in the order in which they were added.
    pub fn take_extensions<T: 'static>(&mut self) -> Vec<T> {
        self.handed.take()
    }

    /// The values of type `T` that nothing has accepted yet.
    pub fn extensions<T: 'static>(&self) -> impl Iterator<Item = &T> {
        self.handed.all()
    }

    /// Passes a value to the formulations of these bodies; `what` names it in errors: `a pair term`. A body
    /// whose formulation does not take it is an error of the scene.
    pub fn extend_bodies<T: Send + Sync + 'static>(&mut self, bodies: BodySet, what: &'static str, value: T) {
        self.handed.put_for(bodies, what, value);
    }

    /// Takes the values of type `T` that were handed to these bodies, in the order in which they were added.
    pub fn take_for<T: Send + Sync + 'static>(&mut self, bodies: &BodySet) -> Vec<ForBodies<T>> {
        self.handed.take_for(|id| bodies.contains(id))
    }

    /// # Errors
    /// Something was handed in that nothing has accepted.
    pub(crate) fn refuse_leftovers(&self) -> Result<(), Vec<Problem>> {
        let problems = self.handed.problems(&self.bodies);
        if problems.is_empty() { Ok(()) } else { Err(problems) }
    }
}

impl From<Vec<Problem>> for SetupError {
    fn from(problems: Vec<Problem>) -> Self {
        Self::Problems(problems)
    }
}
