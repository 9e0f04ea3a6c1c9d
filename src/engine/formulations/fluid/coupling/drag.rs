//! Friction of a flow on bodies that take sub-steps follows their motion within the long one.
//!
//! Friction that is frozen in the long step lags: it drives a part of the body that oscillates within some
//! steps of the flow, instead of damping it. So the sub-steps add the change of the friction by the motion of
//! the body, with frozen weights:
//!
//! `f_w = f_w(n) - c_w (v_w - v_w(n))`, with v_w(n) the velocity that f_w(n) was computed with, and `c_w = 2
//! sum_f V_w V_f 4 mu w_wf`.
//!
//! At the end of the long step the body receives the rest of dt/2 (f(n) + f(n+1)), the impulse of the fluid:
//! momentum is conserved.

use std::ops::Range;

use glam::DVec3;
use hecs::ArchetypeColumnMut;

use crate::parallel::{for_each_block, split_by_rows};
use crate::plugin::SimBuilder;
use crate::removal::{LEAVING, LeavingParticles};
use crate::schedule::{Mode, Run, Stage, Step, StepError, System};
use crate::world::{BodySet, Force, MissingColumn, PhaseId, PhaseView, Removed, Velocity};

crate::column! {
    /// How fast friction grows with the velocity of the particle.
    pub struct CouplingDrag(f64) = "coupling_drag", "c_w", "kg/s";
}
crate::column! {
    /// Velocity that the frozen friction was computed with.
    pub struct CouplingMotion(glam::DVec3) = "coupling_motion", "v_w(n)", "m/s";
}
crate::column! {
    /// Change of the friction in this sub-step.
    pub struct CouplingDamping(glam::DVec3) = "coupling_damping_force", "f_d", "N";
}
crate::column! {
    /// Impulse of the change of friction in this long step.
    pub struct CouplingImpulse(glam::DVec3) = "coupling_impulse", "j_d", "N s";
}
crate::column! {
    /// Work of the change of friction in this long step.
    pub struct CouplingWork(f64) = "coupling_work", "w_d", "J";
}

/// Adds the change of friction in the sub-steps of a phase of bodies.
pub fn add(sim: &mut SimBuilder<'_>, bodies: &BodySet, phase: PhaseId, label: &str) {
    sim.add_column_to::<CouplingDrag>(bodies);
    sim.add_column_to::<CouplingMotion>(bodies);
    sim.add_column_to::<CouplingDamping>(bodies);
    sim.add_column_to::<CouplingImpulse>(bodies);
    sim.add_column_to::<CouplingWork>(bodies);
    sim.add_system(writes_drag(
        System::new(Stage::External, format!("{label}_drag"), Drag { bodies: bodies.clone() })
            .on_phases([phase])
            .reads::<Velocity>()
            .reads::<Removed>()
            .touches(LEAVING, Mode::Reads)
            .adds::<Force>(),
    ));
}

/// Declares that a system writes all columns of the friction that follows the body.
pub fn writes_drag(system: System) -> System {
    system
        .writes::<CouplingDrag>()
        .writes::<CouplingMotion>()
        .writes::<CouplingDamping>()
        .writes::<CouplingImpulse>()
        .writes::<CouplingWork>()
}

/// The columns of a phase.
pub struct DragColumns<'w> {
    drag: ArchetypeColumnMut<'w, CouplingDrag>,
    motion: ArchetypeColumnMut<'w, CouplingMotion>,
    damping: ArchetypeColumnMut<'w, CouplingDamping>,
    impulse: ArchetypeColumnMut<'w, CouplingImpulse>,
    work: ArchetypeColumnMut<'w, CouplingWork>,
}

impl<'w> DragColumns<'w> {
    /// Those of a phase that has them.
    pub fn new(view: &PhaseView<'w>) -> Result<Self, MissingColumn> {
        Ok(Self {
            drag: view.write()?,
            motion: view.write()?,
            damping: view.write()?,
            impulse: view.write()?,
            work: view.write()?,
        })
    }

    /// Those of a body.
    pub fn rows(&mut self, rows: Range<usize>) -> DragRows<'_> {
        DragRows {
            drag: &mut self.drag[rows.clone()],
            motion: &mut self.motion[rows.clone()],
            damping: &mut self.damping[rows.clone()],
            impulse: &mut self.impulse[rows.clone()],
            work: &mut self.work[rows],
        }
    }
}

/// Columns of the drag of the particles of a body.
pub struct DragRows<'a> {
    pub drag: &'a mut [CouplingDrag],
    pub motion: &'a mut [CouplingMotion],
    pub damping: &'a mut [CouplingDamping],
    pub impulse: &'a mut [CouplingImpulse],
    pub work: &'a mut [CouplingWork],
}

split_by_rows!(DragRows { drag, motion, damping, impulse, work });

/// Adds the change of friction in the sub-steps.
pub struct Drag {
    pub bodies: BodySet,
}

type Rows<'a> = (&'a mut [Force], (&'a [Velocity], &'a [Removed]), DragRows<'a>);

impl Run for Drag {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        // In one sub-step there is nothing to follow.
        if step.part.long_step().is_none() {
            return Ok(());
        }
        let half = 0.5 * step.clock.dt;
        for body in step.part.due(step.world, &self.bodies) {
            let (view, rows) = step.world.body_view(body);
            let (mut force, velocity) = (view.write::<Force>()?, view.read::<Velocity>()?);
            let removed = view.read::<Removed>()?;
            let leaving = step.resources.try_get_of::<LeavingParticles>(step.world.body(body).phase);
            let leaving = leaving.as_deref();
            let mut columns = DragColumns::new(&view)?;
            let columns = columns.rows(rows.clone());
            let own = (&velocity[rows.clone()], &removed[rows.clone()]);
            let first_row = rows.start;
            let rows = (&mut force[rows], own, columns);
            for_each_block(rows, &mut Vec::new(), &|first, (force, (velocity, removed), rows): Rows<'_>| {
                for k in 0..force.len() {
                    let mut velocity = velocity[k].0;
                    let mut now = -rows.drag[k].0 * (velocity - rows.motion[k].0);
                    if removed[k] != Removed::NO {
                        // What goes in this step has had the first kick of it.
                        let row = first_row + first + k;
                        velocity = leaving.map_or(DVec3::ZERO, |leaving| leaving.velocity(row));
                        now = DVec3::ZERO;
                    }
                    let kicks = half * (rows.damping[k].0 + now);
                    rows.impulse[k].0 += kicks;
                    rows.work[k].0 += kicks.dot(velocity);
                    rows.damping[k].0 = now;
                    force[k].0 += now;
                }
            });
        }
        Ok(())
    }
}

impl DragRows<'_> {
    /// Impulse of the change of friction on particle `k` in the long step, N s.
    pub fn impulse(&self, k: usize) -> DVec3 {
        self.impulse.get(k).map_or(DVec3::ZERO, |impulse| impulse.0)
    }

    /// The change of friction that the next kick would still spend, N.
    pub fn rest(&self, k: usize) -> DVec3 {
        self.damping.get(k).map_or(DVec3::ZERO, |damping| damping.0)
    }

    /// Begins a long step of particle `k` with friction computed at that velocity, m/s. Returns the work of
    /// the change of friction in the last one, J.
    pub fn begin(&mut self, k: usize, drag: f64, velocity: DVec3) -> f64 {
        if k >= self.drag.len() {
            return 0.0;
        }
        self.drag[k] = CouplingDrag(drag);
        self.motion[k] = CouplingMotion(velocity);
        self.damping[k] = CouplingDamping(DVec3::ZERO);
        self.impulse[k] = CouplingImpulse(DVec3::ZERO);
        std::mem::take(&mut self.work[k].0)
    }
}
