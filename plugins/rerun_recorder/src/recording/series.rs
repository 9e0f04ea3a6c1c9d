//! Time series: which plot each is drawn in, and its name and colour there.

use std::collections::{BTreeMap, BTreeSet};

use re_sdk_types::archetypes::SeriesLines;
use re_sdk_types::components::{Color, Name, StrokeWidth};
use rerun::EntityPath;

use meshless_engine::record::Sample;
use meshless_engine::scene::Dimension;

use super::error::RerunError;
use super::output::{Output, TimedValue};
use super::paths;

/// A plot of time series.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Plot {
    /// What is plotted, with its unit.
    pub title: String,
    /// The series, and all beneath them.
    pub include: Vec<EntityPath>,
    /// What is not drawn of these.
    pub exclude: Vec<EntityPath>,
}

/// The time series that a run has.
#[derive(Clone, Debug)]
pub struct SeriesTable {
    bodies: Vec<String>,
    dimension: Dimension,
    known: Vec<(String, String)>,
    /// What has come since the last time that it was sent, series by series: one piece costs little more than one value.
    pending: BTreeMap<String, Vec<TimedValue>>,
    /// Accounts that have been nothing but zero.
    idle: BTreeSet<String>,
    /// Whether the run is over, so that what is idle stays so.
    over: bool,
}

/// Values of a series that are held back at most.
const MOST_PENDING: usize = 1000;

/// Colours that differ for all kinds of colour vision, on dark and on light (M. Okabe, K. Ito, 2008; the last three: P. Tol, 2021).
const COLORS: [[u8; 3]; 10] = [
    [230, 159, 0],
    [86, 180, 233],
    [0, 158, 115],
    [213, 94, 0],
    [204, 121, 167],
    [0, 114, 178],
    [190, 175, 50],
    [170, 68, 153],
    [136, 136, 136],
    [68, 170, 153],
];

impl SeriesTable {
    /// The series known at the start, with their units, of a run with these bodies.
    pub fn new(bodies: Vec<String>, dimension: Dimension, known: Vec<(String, String)>) -> Self {
        Self { bodies, dimension, known, pending: BTreeMap::new(), idle: BTreeSet::new(), over: false }
    }

    /// Takes values of a step and time, s, to be sent with the others of their series.
    pub fn take(
        &mut self,
        output: &Output,
        (step, time): (u64, f64),
        samples: &[Sample<'_>],
    ) -> Result<(), RerunError> {
        let mut most = 0;
        for sample in samples {
            let value = TimedValue { step, time, value: sample.value };
            if sample.value != 0.0 {
                self.idle.remove(sample.name);
            }
            if let Some(values) = self.pending.get_mut(sample.name) {
                values.push(value);
                most = most.max(values.len());
                continue;
            }
            let known = self.known.iter().any(|(name, _)| name == sample.name);
            if !known {
                self.known.push((sample.name.to_owned(), sample.unit.to_owned()));
            }
            output.log_static(&paths::series(sample.name), &self.style(sample.name))?;
            self.pending.insert(sample.name.to_owned(), vec![value]);
            if sample.value == 0.0 && sample.name.starts_with("energy/") {
                self.idle.insert(sample.name.to_owned());
            }
        }
        if most < MOST_PENDING { Ok(()) } else { self.send(output) }
    }

    /// Sends what has been taken.
    pub fn send(&mut self, output: &Output) -> Result<(), RerunError> {
        for (name, values) in self.pending.iter_mut().filter(|(_, values)| !values.is_empty()) {
            output.send_series(&paths::series(name), values)?;
            values.clear();
        }
        Ok(())
    }

    /// The run is over: accounts that have never moved are drawn no more.
    pub fn finish(&mut self) {
        self.over = true;
    }

    /// The accounts that are not drawn.
    fn hidden(&self) -> impl Iterator<Item = EntityPath> {
        self.idle.iter().filter(|_| self.over).map(|name| paths::series(name))
    }

    fn style(&self, name: &str) -> SeriesLines {
        let group = self.group(name);
        let others = self.known.iter().filter(|(other, _)| self.group(other) == group);
        let place = others.take_while(|(other, _)| other != name).count();
        let [r, g, b] = COLORS[place % COLORS.len()];
        let segments: Vec<&str> = name.split('/').skip(1).collect();
        let label = match group {
            Group::Body(_) | Group::Energy => segments.last().copied().unwrap_or(name).replace('_', " "),
            Group::Error(_) | Group::Probe(_) => segments.join(" ").replace('_', " "),
        };
        SeriesLines::new()
            .with_names([Name(label.into())])
            .with_colors([Color::from_rgb(r, g, b)])
            .with_widths([StrokeWidth(1.8.into())])
    }

    fn group(&self, name: &str) -> Group {
        let mut segments = name.split('/');
        if segments.next() != Some("energy") {
            return Group::Probe(self.unit(name));
        }
        let rest: Vec<&str> = segments.collect();
        match rest.as_slice() {
            [body, .., _] => Group::Body((*body).to_owned()),
            [error] if error.ends_with("error") => Group::Error(self.unit(name)),
            _ => Group::Energy,
        }
    }

    fn unit(&self, name: &str) -> String {
        self.known.iter().find(|(known, _)| known == name).map_or_else(String::new, |(_, unit)| unit.clone())
    }

    fn names(&self, group: &Group) -> Vec<EntityPath> {
        let names = self.known.iter().filter(|(name, _)| self.group(name) == *group);
        names.map(|(name, _)| paths::series(name)).collect()
    }

    fn groups(&self) -> Vec<Group> {
        let mut groups = Vec::new();
        for (name, _) in &self.known {
            let group = self.group(name);
            if !groups.contains(&group) {
                groups.push(group);
            }
        }
        groups
    }

    /// Energies of all bodies together and, where there are several, of each.
    pub fn energies(&self) -> Vec<Plot> {
        let body_paths = self.bodies.iter().map(|body| paths::entity(["energy", body]));
        let errors = self.groups().into_iter().filter(|group| matches!(group, Group::Error(_)));
        let exclude: Vec<EntityPath> =
            body_paths.chain(errors.flat_map(|group| self.names(&group))).chain(self.hidden()).collect();
        // An account that opens while the run goes on belongs here, too.
        let all = Plot { title: "Energies [J]".to_owned(), include: vec![paths::series("energy")], exclude };
        let mut plots = Vec::new();
        if self.known.iter().any(|(name, _)| name.starts_with("energy/")) {
            plots.push(all);
        }
        if self.bodies.len() > 1 {
            plots.extend(self.bodies.iter().filter(|body| self.has_energies(body)).map(|body| Plot {
                title: format!("{body} [J]"),
                include: vec![paths::entity(["energy", body])],
                exclude: self.hidden().collect(),
            }));
        }
        plots
    }

    fn has_energies(&self, body: &str) -> bool {
        self.groups().contains(&Group::Body(body.to_owned()))
    }

    /// Errors of the energy balance, in joules in front: the relative one starts with next to nothing over nothing.
    pub fn errors(&self) -> Vec<Plot> {
        let mut errors: Vec<(Group, String)> = self
            .groups()
            .into_iter()
            .filter_map(|group| match &group {
                Group::Error(unit) => {
                    let title = match unit.as_str() {
                        "1" | "" => "Energy balance error, relative".to_owned(),
                        unit => format!("Energy balance error [{unit}]"),
                    };
                    Some((group, title))
                }
                _ => None,
            })
            .collect();
        errors.sort_by_key(|(group, _)| *group != Group::Error("J".to_owned()));
        errors.into_iter().map(|(group, title)| self.plot(&group, title)).collect()
    }

    /// Probes, one plot for each unit; in a plane scene without the components across the plane, which are zero.
    pub fn probes(&self) -> Vec<Plot> {
        let across = |path: &EntityPath| {
            self.dimension == Dimension::Two && path.last().is_some_and(|part| part.unescaped_str() == "z")
        };
        let groups = self.groups().into_iter().filter_map(|group| match &group {
            Group::Probe(unit) => {
                let title = if unit == "1" { "Probes".to_owned() } else { format!("Probes [{unit}]") };
                Some((group, title))
            }
            _ => None,
        });
        let mut plots: Vec<Plot> = groups.map(|(group, title)| self.plot(&group, title)).collect();
        plots.iter_mut().for_each(|plot| plot.include.retain(|path| !across(path)));
        plots
    }

    fn plot(&self, group: &Group, title: String) -> Plot {
        Plot { title, include: self.names(group), exclude: Vec::new() }
    }
}

/// What is drawn together.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Group {
    /// Energies of all bodies together.
    Energy,
    /// Energies of one body.
    Body(String),
    /// Errors of the energy balance in one unit.
    Error(String),
    /// Probes in one unit.
    Probe(String),
}

#[cfg(test)]
mod tests {
    use super::*;
    use meshless_engine::record::Existing;

    fn table(bodies: &[&str], known: &[(&str, &str)]) -> SeriesTable {
        let owned = |(name, unit): &(&str, &str)| ((*name).to_owned(), (*unit).to_owned());
        SeriesTable::new(
            bodies.iter().map(|body| (*body).to_owned()).collect(),
            Dimension::Two,
            known.iter().map(owned).collect(),
        )
    }

    #[test]
    fn probes_are_grouped_by_unit_and_errors_are_kept_from_energies() {
        let table = table(
            &["plate", "ball"],
            &[
                ("energy/kinetic", "J"),
                ("energy/plate/kinetic", "J"),
                ("energy/ball/kinetic", "J"),
                ("energy/balance_error", "J"),
                ("energy/relative_error", "1"),
                ("probe/tip/x", "m"),
                ("probe/reaction/x", "N"),
                ("probe/tip/y", "m"),
                ("probe/tip/z", "m"),
            ],
        );
        let titles = |plots: Vec<Plot>| plots.into_iter().map(|plot| plot.title).collect::<Vec<_>>();
        assert_eq!(titles(table.energies()), ["Energies [J]", "plate [J]", "ball [J]"]);
        assert_eq!(titles(table.errors()), ["Energy balance error [J]", "Energy balance error, relative"]);
        let probes = table.probes();
        assert_eq!(probes[0].title, "Probes [m]");
        assert_eq!(probes[0].include, [paths::series("probe/tip/x"), paths::series("probe/tip/y")]);
        assert_eq!(probes[1].title, "Probes [N]");
        let excluded = &table.energies()[0].exclude;
        for path in ["energy/plate", "energy/ball", "energy/balance_error", "energy/relative_error"] {
            assert!(excluded.contains(&paths::series(path)), "{path}");
        }
    }

    #[test]
    fn accounts_that_never_move_are_left_out_in_the_end() {
        let folder = tempfile::TempDir::new().expect("a temporary folder");
        let output = Output::open(&folder.path().join("run.rrd"), Existing::Refuse, "run", None);
        let output = output.expect("a recording");
        let names = ["energy/kinetic", "energy/friction", "energy/gravity"];
        let mut table = table(&["plate"], &names.map(|name| (name, "J")));
        for (step, values) in [[0.0, 0.0, 0.0], [2.0, 0.0, 1.0], [0.0, 0.0, 0.0]].iter().enumerate() {
            let samples: Vec<Sample<'_>> =
                names.iter().zip(values).map(|(&name, &value)| Sample { name, unit: "J", value }).collect();
            table.take(&output, (step as u64, step as f64), &samples).expect("they are taken");
        }
        let friction = paths::series("energy/friction");
        assert!(!table.energies()[0].exclude.contains(&friction), "it may move yet");
        table.finish();
        let excluded = &table.energies()[0].exclude;
        assert!(excluded.contains(&friction));
        assert!(!excluded.contains(&paths::series("energy/kinetic")));
        assert!(!excluded.contains(&paths::series("energy/gravity")));
    }

    #[test]
    fn names_with_odd_signs_stay_one_entity() {
        assert_eq!(paths::body("left plate/2").len(), 2);
    }
}
