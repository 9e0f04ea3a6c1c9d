//! The output that a scene asks for, resolved to bodies, fields and recorders; checked even if nothing is
//! written.

use std::path::Path;
use std::sync::Arc;

use super::due::{Output, OutputParts, SceneInfo};
use super::folder::{ENERGY, OutputFolder};
use super::frames::Frames;
use super::options::OutputOptions;
use super::silent::of_this_rank;
use super::system::output_system;
use super::track::Track;
use crate::fields::{ChosenField, FieldTable};
use crate::plugin::SimBuilder;
use crate::record::probe::{self, EnergyColumns, Gauge, ResolvedProbe};
use crate::record::{Recorder, stop};
use crate::scene::{Item, Problem, Source, SourcePlace};
use crate::schedule::Shared;
use crate::world::BodySet;

/// The planned output, if there is any.
pub struct OutputPlan {
    probes: Vec<ResolvedProbe>,
    recorded: Vec<ChosenField>,
    written: Vec<ChosenField>,
    recorders: Vec<Box<dyn Recorder>>,
}

impl OutputPlan {
    /// Finds the probes and fields that the scene and the recorders name. `recorder_items` are the plugins
    /// that have added the recorders, in their order.
    ///
    /// # Errors
    /// A field is not there, a selection is empty, and the like; all at once.
    pub fn resolve(sim: &mut SimBuilder<'_>, recorder_items: &[Item]) -> Result<Self, Vec<Problem>> {
        let recorders: Vec<Box<dyn Recorder>> = sim.take_extensions();
        let recorders: Vec<_> = recorders.into_iter().map(of_this_rank).collect();
        probe::add_system(sim);
        let table = Arc::new(FieldTable::collect(sim));
        let scene = sim.scene();
        let everything = BodySet::new(sim.bodies().iter().map(|body| body.id));
        let mut problems = Vec::new();
        let (mut recorded, mut written): (Vec<ChosenField>, Vec<ChosenField>) = Default::default();
        for (k, name) in scene.record.fields.iter().enumerate() {
            let place = SourcePlace::Path(format!("record.fields[{k}]"));
            if scene.record.fields[..k].contains(name) {
                let message = format!("`{name}` stands twice in `fields`");
                problems.push(Problem { at: place.clone(), ..Problem::new(message) });
            }
            match table.choose(name, &everything, false) {
                Ok(field) if field.width() > 3 && !scene.record.vtk => problems.push(tensor(&field, place)),
                Ok(field) => {
                    if field.width() <= 3 {
                        add(&mut recorded, field.clone());
                    }
                    add(&mut written, field);
                }
                Err(problem) => problems.push(Problem { at: place, ..*problem }),
            }
        }
        for (k, recorder) in recorders.iter().enumerate() {
            for name in recorder.fields() {
                let place =
                    recorder_items.get(k).map_or(SourcePlace::Scene, |item| item.problem_with_name("").at);
                match table.choose(&name, &everything, false) {
                    Ok(field) if field.width() > 3 => problems.push(tensor(&field, place)),
                    Ok(field) => add(&mut recorded, field),
                    Err(problem) => problems.push(Problem { at: place, ..*problem }),
                }
            }
        }
        let mut probes = Vec::new();
        for (k, probe) in scene.probes.iter().enumerate() {
            match ResolvedProbe::resolve(k, probe, sim, &table) {
                Ok(probe) => probes.push(probe),
                Err(found) => problems.extend(found),
            }
        }
        if problems.is_empty()
            && let Err(found) = stop::add_system(sim, &table)
        {
            problems.extend(found);
        }
        let plan = Self { probes, recorded, written, recorders };
        if problems.is_empty() { Ok(plan) } else { Err(problems) }
    }

    /// The probes of the scene.
    pub fn probes(&self) -> Vec<ResolvedProbe> {
        self.probes.clone()
    }

    /// Makes the output that writes it, and adds its system; returns its place among what systems share.
    pub fn attach(
        self,
        sim: &mut SimBuilder<'_>,
        source: &Source,
        options: &OutputOptions,
    ) -> Shared<Output> {
        let scene = sim.scene();
        let name = Path::new(&source.name).file_stem().map(|stem| stem.to_string_lossy().into_owned());
        let scene_name = name.unwrap_or_else(|| "scene".to_owned());
        let folder = OutputFolder::new(options, &scene_name, scene.record.vtk);
        let bodies = sim.bodies().iter().map(|body| (body.id, body.name.clone())).collect();
        let ledger = ResolvedProbe {
            name: "energy".to_owned(),
            interval: scene.record_interval() / 10.0,
            may_be_empty: false,
            mean: false,
            gauge: Arc::new(Gauge::Energies(EnergyColumns::detailed(bodies))),
        };
        let mut tracks = vec![Track::new("energy".to_owned(), ledger, folder.file(ENERGY))];
        tracks.extend(self.probes.into_iter().map(|probe| Track::of_probe(probe, &folder)));
        let frames = Frames::new(
            scene.record_interval(),
            [self.recorded, self.written],
            scene.record.vtk,
            sim.periodic(),
        );
        let mut needs: Vec<&'static str> =
            tracks.iter().flat_map(Track::needs).chain(frames.needs()).collect();
        needs.sort_unstable();
        needs.dedup();
        let info = SceneInfo { title: scene.title.clone(), name: scene_name, text: source.text.clone() };
        let output = Output::new(OutputParts {
            scene: info,
            folder,
            tracks,
            frames,
            recorders: self.recorders,
            end: scene.time.end,
            checkpoint_every: scene.record.checkpoint_every,
        });
        let output = sim.share(output);
        sim.add_system(output_system(output, &needs));
        output
    }
}

/// A field that is asked for twice is there once.
fn add(fields: &mut Vec<ChosenField>, field: ChosenField) {
    if !fields.iter().any(|known| known.name() == field.name()) {
        fields.push(field);
    }
}

fn tensor(field: &ChosenField, at: SourcePlace) -> Problem {
    let name = field.name();
    let message = format!("the field `{name}` is a tensor, and a recording shows numbers");
    let help = format!("name a component, such as `{name}.xx`, or a number such as `von_mises`");
    Problem { at, ..Problem::new(message).help(help) }
}
