//! Frames: all particles with the requested fields, for recorders and for ParaView.

use serde::{Deserialize, Serialize};

use super::folder::OutputFolder;
use super::present::PresentRows;
use super::track::failed;
use crate::fields::ChosenField;
use crate::neighbors::Periodic;
use crate::record::{
    BodyFrame, FieldValues, Frame, NamedUnit, PointArray, PointValues, PvdFrame, PvdWriter, RecordError,
    Recorder,
};
use crate::schedule::Trigger;
use crate::schedule::{Step, StepError};
use crate::world::{BodyId, Position};

/// Times and content of frames.
pub(super) struct Frames {
    trigger: Trigger,
    last: Option<f64>,
    /// Fields of recordings: those requested by the scene, then those that recorders need. No tensors.
    recorded: Vec<ChosenField>,
    /// Fields of ParaView files.
    written: Vec<ChosenField>,
    vtk: bool,
    /// Particles are shown inside of the domain along its periodic axes, wherever they have gone.
    periodic: Periodic,
    list: Option<PvdWriter>,
}

/// State of the frames in a checkpoint.
#[derive(Serialize, Deserialize)]
pub(super) struct FramesState {
    trigger: Trigger,
    last: Option<f64>,
    list: Option<Vec<PvdFrame>>,
}

impl Frames {
    pub fn new(
        interval: f64,
        [recorded, written]: [Vec<ChosenField>; 2],
        vtk: bool,
        periodic: Periodic,
    ) -> Self {
        Self { trigger: Trigger::new(interval), last: None, recorded, written, vtk, periodic, list: None }
    }

    /// Names of the particle columns that frames read.
    pub fn needs(&self) -> Vec<&'static str> {
        self.recorded.iter().chain(&self.written).flat_map(ChosenField::needs).collect()
    }

    /// The fields of recordings.
    pub fn named(&self) -> Vec<NamedUnit<'_>> {
        self.recorded.iter().map(|field| NamedUnit { name: field.name(), unit: field.unit() }).collect()
    }

    pub fn open(&mut self, folder: &OutputFolder, state: Option<FramesState>) -> Result<(), RecordError> {
        let Some(state) = state else {
            if self.vtk {
                self.list = Some(PvdWriter::create(&folder.pvd(), folder.existing)?);
            }
            return Ok(());
        };
        self.trigger.resume(state.trigger);
        self.last = state.last;
        if self.vtk {
            self.list = Some(PvdWriter::resume(&folder.pvd(), state.list.unwrap_or_default())?);
        }
        Ok(())
    }

    pub fn state(&self) -> FramesState {
        let list = self.list.as_ref().map(|list| list.frames().to_vec());
        FramesState { trigger: self.trigger, last: self.last, list }
    }

    /// Writes a frame if it is due, or if this is the end; whether it did.
    pub fn record(
        &mut self,
        step: &Step<'_>,
        at_end: bool,
        recorders: &mut [Box<dyn Recorder>],
    ) -> Result<bool, StepError> {
        let time = step.clock.time;
        let due = self.trigger.is_due(time) || (at_end && self.last != Some(time));
        if due {
            self.last = Some(time);
            if !recorders.is_empty() {
                self.show(step, recorders)?;
            }
            self.write(step)?;
        }
        Ok(due)
    }

    fn show(&self, step: &Step<'_>, recorders: &mut [Box<dyn Recorder>]) -> Result<(), StepError> {
        let mut positions = Vec::new();
        let mut numbers = Vec::new();
        for (k, body) in step.world.bodies().iter().enumerate() {
            let x = step.world.phase(body.phase).read::<Position>()?;
            let present = PresentRows::of(step.world, BodyId(k))?;
            let places: Vec<_> =
                x[body.rows.clone()].iter().map(|x| self.periodic.wrap(x.0).as_vec3().to_array()).collect();
            positions.push(present.keep(places, 1));
            let of_body = self.recorded.iter().filter(|field| field.is_in(BodyId(k)));
            let read = |field: &ChosenField| {
                let numbers = field.read_numbers(step.world, step.resources, BodyId(k), body.rows.clone());
                numbers.map(|numbers| present.keep(numbers, 1))
            };
            numbers.push(
                of_body
                    .map(|field| Ok((field, read(field)?)))
                    .collect::<Result<Vec<_>, crate::world::MissingColumn>>()?,
            );
        }
        let values: Vec<Vec<FieldValues<'_>>> = numbers
            .iter()
            .map(|fields| {
                let named = fields.iter();
                named.map(|(f, values)| FieldValues { name: f.name(), unit: f.unit(), values }).collect()
            })
            .collect();
        let bodies = step.world.bodies().iter().zip(&positions).zip(&values);
        let bodies: Vec<BodyFrame<'_>> = bodies
            .map(|((body, positions), fields)| BodyFrame {
                name: &body.name,
                positions,
                radius: (0.5 * body.spacing) as f32,
                fields,
            })
            .collect();
        let frame = Frame { step: step.clock.step, time: step.clock.time, bodies: &bodies };
        recorders.iter_mut().try_for_each(|recorder| recorder.frame(&frame)).map_err(failed)
    }

    fn write(&mut self, step: &Step<'_>) -> Result<(), StepError> {
        let Self { list: Some(list), periodic, written, .. } = self else { return Ok(()) };
        for (k, body) in step.world.bodies().iter().enumerate() {
            let present = PresentRows::of(step.world, BodyId(k))?;
            let points: Vec<[f64; 3]> = {
                let x = step.world.phase(body.phase).read::<Position>()?;
                present.keep(x[body.rows.clone()].iter().map(|x| periodic.wrap(x.0).to_array()).collect(), 1)
            };
            let mut values = Vec::new();
            for field in written.iter().filter(|field| field.is_in(BodyId(k))) {
                let read = field.read(step.world, step.resources, BodyId(k), body.rows.clone())?;
                values.push((field, present.keep(read, field.width())));
            }
            let arrays: Vec<PointArray<'_>> = values
                .iter()
                .map(|(field, values)| {
                    let (name, values) = (field.name(), PointValues::F64(values));
                    match field.width() {
                        1 => PointArray::scalar(name, values),
                        3 => PointArray::vector(name, values),
                        _ => PointArray::tensor(name, values),
                    }
                })
                .collect();
            list.write(step.clock.time, &body.name, &points, &arrays).map_err(failed)?;
        }
        Ok(())
    }
}
