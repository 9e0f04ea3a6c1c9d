//! Time series: which plot each is drawn in, and its name and colour there.

use std::collections::{BTreeMap, BTreeSet};

use re_sdk_types::archetypes::SeriesLines;
use re_sdk_types::components::{Color, Name, StrokeWidth};
use rerun::EntityPath;

use meshless_engine::record::Sample;

use super::error::RerunError;
use super::output::{RecordingOutput, TimedValue};
use super::paths;

/// A plot of time series.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Plot {
    /// The plotted quantity, with its unit.
    pub title: String,
    /// The series, and all beneath them.
    pub include: Vec<EntityPath>,
    /// Entities of these that are not drawn.
    pub exclude: Vec<EntityPath>,
    /// Whether the curves need names.
    pub has_legend: bool,
}

/// The time series that a run has.
#[derive(Clone, Debug)]
pub struct SeriesTable {
    bodies: Vec<String>,
    known: Vec<(String, String)>,
    /// Values since the last transmission, series by series: one piece costs little more than one value.
    pending: BTreeMap<String, Vec<TimedValue>>,
    /// Accounts that have been nothing but zero.
    idle: BTreeSet<String>,
    /// Largest magnitude of each account.
    largest: BTreeMap<String, f64>,
    /// Whether the run is over, so that what is idle stays so.
    over: bool,
    /// Values of the longest series that have been sent.
    sent: usize,
}

/// Share of the largest account of a plot, below which an account is drawn in the plot of all accounts only.
const MINOR: f64 = 0.01;
/// Curves in one plot of probes, at most: the entries of a legend that is longer cannot be reached.
const MAX_CURVES: usize = 8;

/// Values that have been sent over those that are sent next, at most: a recording that is cut short may lack
/// the last of so many parts of its curves.
const PIECES: usize = 100;

/// Values of a series that are held back at most.
const MAX_PENDING: usize = 1000;

/// Colours that differ for all kinds of colour vision, on dark and on light (M. Okabe, K. Ito, 2008; the last
/// three: P. Tol, 2021).
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
    pub fn new(bodies: Vec<String>, known: Vec<(String, String)>) -> Self {
        Self {
            bodies,
            known,
            pending: BTreeMap::new(),
            idle: BTreeSet::new(),
            largest: BTreeMap::new(),
            over: false,
            sent: 0,
        }
    }

    /// Takes values of a step and time, s, to be sent with the others of their series.
    pub fn take(
        &mut self,
        output: &RecordingOutput,
        step: u64,
        time: f64,
        samples: &[Sample<'_>],
    ) -> Result<(), RerunError> {
        let mut most = 0;
        for sample in samples {
            let value = TimedValue { step, time, value: sample.value };
            if sample.value != 0.0 {
                self.idle.remove(sample.name);
            }
            if let Some(largest) = self.largest.get_mut(sample.name) {
                *largest = largest.max(sample.value.abs());
            } else if sample.name.starts_with("energy/") && !sample.name.ends_with("error") {
                self.largest.insert(sample.name.to_owned(), sample.value.abs());
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
        if most < MAX_PENDING { Ok(()) } else { self.send(output) }
    }

    /// Sends what has been taken if that is a good part of all: each piece leaves an entry in the index of
    /// the recording, which is kept in memory, so that their number may grow with the logarithm of the run
    /// only.
    pub fn send_if_due(&mut self, output: &RecordingOutput) -> Result<(), RerunError> {
        if self.longest_pending() * PIECES < self.sent { Ok(()) } else { self.send(output) }
    }

    fn longest_pending(&self) -> usize {
        self.pending.values().map(Vec::len).max().unwrap_or(0)
    }

    /// Sends what has been taken.
    pub fn send(&mut self, output: &RecordingOutput) -> Result<(), RerunError> {
        self.sent += self.longest_pending();
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

    /// The accounts that are not drawn among those that matter: below a share of the largest of their group,
    /// once the run is over.
    fn minor(&self) -> Vec<EntityPath> {
        let largest_of = |group: &PlotGroup| {
            let members = self.largest.iter().filter(|(name, _)| self.group(name) == *group);
            members.map(|(_, largest)| *largest).fold(0.0, f64::max)
        };
        let is_minor = |(name, largest): &(&String, &f64)| **largest < MINOR * largest_of(&self.group(name));
        let known = self.largest.iter().filter(|_| self.over);
        known.filter(is_minor).map(|(name, _)| paths::series(name)).collect()
    }

    /// The accounts that are not drawn at all.
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
            PlotGroup::Body(_) | PlotGroup::Energy => {
                segments.last().copied().unwrap_or(name).replace('_', " ")
            }
            PlotGroup::Error(_) | PlotGroup::Probe(_) => segments.join(" ").replace('_', " "),
        };
        SeriesLines::new()
            .with_names([Name(label.into())])
            .with_colors([Color::from_rgb(r, g, b)])
            .with_widths([StrokeWidth(1.8.into())])
    }

    fn group(&self, name: &str) -> PlotGroup {
        let mut segments = name.split('/');
        if segments.next() != Some("energy") {
            return PlotGroup::Probe(self.unit(name));
        }
        let rest: Vec<&str> = segments.collect();
        match rest.as_slice() {
            [body, .., _] => PlotGroup::Body((*body).to_owned()),
            [error] if error.ends_with("error") => PlotGroup::Error(self.unit(name)),
            _ => PlotGroup::Energy,
        }
    }

    fn unit(&self, name: &str) -> String {
        self.known.iter().find(|(known, _)| known == name).map_or_else(String::new, |(_, unit)| unit.clone())
    }

    fn names(&self, group: &PlotGroup) -> Vec<EntityPath> {
        let names = self.known.iter().filter(|(name, _)| self.group(name) == *group);
        names.map(|(name, _)| paths::series(name)).collect()
    }

    fn groups(&self) -> Vec<PlotGroup> {
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
        let errors = self.groups().into_iter().filter(|group| matches!(group, PlotGroup::Error(_)));
        let others: Vec<EntityPath> =
            body_paths.chain(errors.flat_map(|group| self.names(&group))).chain(self.hidden()).collect();
        let minor = self.minor();
        // An account that opens while the run goes on belongs here, too.
        let energies = |title: &str, exclude: Vec<EntityPath>| Plot {
            title: title.to_owned(),
            include: vec![paths::series("energy")],
            exclude,
            has_legend: true,
        };
        let mut plots = Vec::new();
        if self.known.iter().any(|(name, _)| name.starts_with("energy/")) {
            plots.push(energies("Energies [J]", others.iter().chain(&minor).cloned().collect()));
        }
        if self.bodies.len() > 1 {
            plots.extend(self.bodies.iter().filter(|body| self.has_energies(body)).map(|body| Plot {
                title: format!("{body} [J]"),
                include: vec![paths::entity(["energy", body])],
                exclude: self.hidden().chain(minor.iter().cloned()).collect(),
                has_legend: true,
            }));
        }
        if !minor.is_empty() {
            plots.push(energies("All accounts [J]", others));
        }
        plots
    }

    fn has_energies(&self, body: &str) -> bool {
        self.groups().contains(&PlotGroup::Body(body.to_owned()))
    }

    /// Errors of the energy balance, in joules in front: the relative one starts with next to nothing over
    /// nothing.
    pub fn errors(&self) -> Vec<Plot> {
        let mut errors: Vec<(PlotGroup, String)> = self
            .groups()
            .into_iter()
            .filter_map(|group| match &group {
                PlotGroup::Error(unit) => {
                    let title = match unit.as_str() {
                        "1" | "" => "Energy balance error, relative".to_owned(),
                        unit => format!("Energy balance error [{unit}]"),
                    };
                    Some((group, title))
                }
                _ => None,
            })
            .collect();
        errors.sort_by_key(|(group, _)| *group != PlotGroup::Error("J".to_owned()));
        errors.into_iter().map(|(group, title)| self.plot(&group, title)).collect()
    }

    /// Probes, one plot for each unit, or several where the legend would be too long.
    pub fn probes(&self) -> Vec<Plot> {
        let groups = self.groups().into_iter().filter_map(|group| match &group {
            PlotGroup::Probe(unit) => {
                let title = if unit == "1" { "Probes".to_owned() } else { format!("Probes [{unit}]") };
                Some((group, title))
            }
            _ => None,
        });
        groups.flat_map(|(group, title)| parts(self.plot(&group, title))).collect()
    }

    fn plot(&self, group: &PlotGroup, title: String) -> Plot {
        let include = self.names(group);
        Plot { title, has_legend: include.len() > 1, include, exclude: Vec::new() }
    }
}

/// A plot in as many parts as it takes to keep their legends short.
fn parts(plot: Plot) -> Vec<Plot> {
    let count = plot.include.len().div_ceil(MAX_CURVES);
    if count <= 1 {
        return vec![plot];
    }
    let part = |(k, include): (usize, &[EntityPath])| Plot {
        title: format!("{} ({} of {count})", plot.title, k + 1),
        include: include.to_vec(),
        exclude: Vec::new(),
        has_legend: true,
    };
    plot.include.chunks(MAX_CURVES).enumerate().map(part).collect()
}

/// Plots by the series drawn together.
#[derive(Clone, Debug, PartialEq, Eq)]
enum PlotGroup {
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
        let output = RecordingOutput::open(&folder.path().join("run.rrd"), Existing::Refuse, "run", None);
        let output = output.expect("a recording");
        let names = ["energy/kinetic", "energy/friction", "energy/gravity"];
        let mut table = table(&["plate"], &names.map(|name| (name, "J")));
        for (step, values) in [[0.0, 0.0, 0.0], [2.0, 0.0, 1.0], [0.0, 0.0, 0.0]].iter().enumerate() {
            let samples: Vec<Sample<'_>> =
                names.iter().zip(values).map(|(&name, &value)| Sample { name, unit: "J", value }).collect();
            table.take(&output, step as u64, step as f64, &samples).expect("they are taken");
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
    fn accounts_that_hardly_matter_are_drawn_in_a_plot_of_their_own_in_the_end() {
        let folder = tempfile::TempDir::new().expect("a temporary folder");
        let output = RecordingOutput::open(&folder.path().join("run.rrd"), Existing::Refuse, "run", None);
        let output = output.expect("a recording");
        let names = ["energy/kinetic", "energy/hourglass"];
        let mut table = table(&["plate"], &names.map(|name| (name, "J")));
        let samples = [1.0, 0.001].iter().zip(names).map(|(&value, name)| Sample { name, unit: "J", value });
        table.take(&output, 0, 0.0, &samples.collect::<Vec<_>>()).expect("they are taken");
        table.finish();
        let plots = table.energies();
        let hourglass = paths::series("energy/hourglass");
        assert!(plots[0].exclude.contains(&hourglass));
        let all = plots.last().expect("a plot");
        assert!(all.title == "All accounts [J]" && !all.exclude.contains(&hourglass));
    }

    #[test]
    fn curves_go_out_in_pieces_whose_number_grows_slowly() {
        let folder = tempfile::TempDir::new().expect("a temporary folder");
        let output = RecordingOutput::open(&folder.path().join("run.rrd"), Existing::Refuse, "run", None);
        let output = output.expect("a recording");
        let mut table = table(&["plate"], &[("probe/tip", "m")]);
        let mut pieces = 0;
        for step in 0..10_000 {
            let sample = Sample { name: "probe/tip", unit: "m", value: 1.0 };
            table.take(&output, step, step as f64, &[sample]).expect("they are taken");
            let before = table.sent;
            table.send_if_due(&output).expect("they are sent");
            pieces += usize::from(table.sent > before);
        }
        // One for each of the first hundred, then ever fewer: 100 (1 + ln 100) or so.
        assert!(pieces > 400 && pieces < 600, "{pieces}");
        assert!(table.longest_pending() <= 100);
    }

    #[test]
    fn many_probes_of_one_unit_are_drawn_in_several_plots() {
        let names: Vec<String> = (0..20).map(|k| format!("probe/line/at {k}")).collect();
        let known: Vec<(&str, &str)> = names.iter().map(|name| (name.as_str(), "Pa")).collect();
        let plots = table(&["plate"], &known).probes();
        assert_eq!(plots.iter().map(|plot| plot.include.len()).collect::<Vec<_>>(), [8, 8, 4]);
        assert_eq!(plots[2].title, "Probes [Pa] (3 of 3)");
    }

    #[test]
    fn names_with_odd_signs_stay_one_entity() {
        assert_eq!(paths::body("left plate/2").len(), 2);
    }
}
