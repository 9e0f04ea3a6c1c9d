//! The recorder: frames and samples of a run become entities of a recording.

use meshless_engine::record::{BodyFrame, Existing, Frame, RecordError, Recorder, RunInfo, Sample};
use meshless_engine::scene::Dimension;
use re_sdk_types::archetypes::{TextDocument, Transform3D, ViewCoordinates};
use re_sdk_types::components::{Color, MediaType, Radius};
use re_sdk_types::datatypes::ViewDir;
use rerun::EntityPath;

use super::arrays;
use super::color_scale::{ColorScale, RunningScale};
use super::error::RerunError;
use super::layout::Layout;
use super::legend::{self, Legend, PlacedExtreme, short};
use super::notes::Notes;
use super::output::RecordingOutput;
use super::paths;
use super::series::SeriesTable;
use super::surface::show_surface;
use crate::camera::Bounds;
use crate::colormap::Colormap;
use crate::plugin::RerunRecorder;

/// Writes the recording of a run.
pub struct RerunFile {
    settings: RerunRecorder,
    fields: Vec<String>,
    grey: Vec<String>,
    up: [f64; 3],
    scale: RunningScale,
    open: Option<Open>,
}

/// A recording that is being written. Dropping it completes the file.
struct Open {
    output: RecordingOutput,
    layout: Layout,
    /// The field of the colours.
    color_by: Option<String>,
    /// All particles so far.
    bounds: Bounds,
    /// The particles that the camera has in view.
    in_view: Option<Bounds>,
    /// By how much they are drawn larger; their coordinates stay as they are.
    enlargement: f64,
    legend: Option<Legend>,
    series: SeriesTable,
    notes: Notes,
}

/// Particles of a body that is grey or does not have the field of the colours: a grey that no colour map has.
const PLAIN: [u8; 3] = [122, 126, 132];
/// Share of their radius that particles without colours have in three dimensions, so that a tank does not
/// hide its fluid, nor a tool what it presses.
const SEEN_THROUGH: f32 = 0.2;
/// Directions of an axis in the viewer's words.
const UP: u8 = ViewDir::Up as u8;
const DOWN: u8 = ViewDir::Down as u8;
/// Particles whose value is not a number.
const NOT_A_NUMBER: [u8; 3] = [255, 0, 255];

impl RerunFile {
    /// A recorder that keeps the values of `fields` and draws the bodies of `grey` without colours; `up` is
    /// the unit vector that points up in the picture.
    pub fn new(settings: RerunRecorder, fields: Vec<String>, grey: Vec<String>, up: [f64; 3]) -> Self {
        let scale = RunningScale::new(settings.range);
        Self { settings, fields, grey, up, scale, open: None }
    }

    fn open(&mut self, run: &RunInfo<'_>) -> Result<(), RerunError> {
        // A recording cannot be continued: a resumed run writes the rest of the time into a file of its own,
        // and doing so again replaces that rest.
        let (file, existing) = if run.resumed {
            (format!("{}-from-{}s.rrd", run.scene_name, short(run.start_time)), Existing::Replace)
        } else {
            (file_name(run.scene_name), run.existing)
        };
        let path = run.output.join(file);
        let output =
            RecordingOutput::open(&path, existing, run.scene_name, self.settings.connect.as_deref())?;
        output.log_static(&EntityPath::root(), &axes(self.up))?;
        output.log_static(
            &paths::scene(),
            &TextDocument::new(run.scene_text).with_media_type(MediaType::TEXT),
        )?;
        let title = if run.title.is_empty() { run.scene_name } else { run.title };
        output.log_static(&paths::title(), &TextDocument::new(title))?;
        let notes = Notes::new(run);
        output.log_static(&paths::notes(), &notes.document(&[]))?;
        let colors = match &self.settings.color_by {
            Some(name) => run.fields.iter().find(|field| field.name == name),
            None => run.fields.first(),
        };
        if let Some(field) = colors {
            output.log_static(&paths::legend_part("title"), &TextDocument::new(legend::title(field.name)))?;
        }
        let bodies: Vec<String> = run.bodies.iter().map(|body| body.name.to_owned()).collect();
        let known = run.series.iter().map(|series| (series.name.to_owned(), series.unit.to_owned()));
        self.open = Some(Open {
            layout: Layout {
                title: title.to_owned(),
                dimension: run.dimension,
                up: self.up,
                bodies: bodies.clone(),
                colors: colors.map(|field| field.name.to_owned()),
                surfaces: self.settings.surfaces.clone(),
                undeformed: self.settings.undeformed,
                duration: run.end_time - run.start_time,
            },
            color_by: colors.map(|field| field.name.to_owned()),
            bounds: Bounds::EMPTY,
            in_view: None,
            enlargement: 1.0,
            legend: colors.map(|field| Legend::new(field.unit)),
            series: SeriesTable::new(bodies, known.collect()),
            notes,
            output,
        });
        Ok(())
    }

    fn write(&mut self, frame: &Frame<'_>) -> Result<(), RerunError> {
        let open = self.open.as_mut().ok_or(RerunError::NotOpen)?;
        for body in frame.bodies {
            open.bounds.extend(body.positions, f64::from(body.radius));
        }
        match open.in_view {
            None => {
                open.enlarge()?;
                if self.settings.undeformed {
                    open.show_undeformed(frame)?;
                }
                open.send_layout(false)?;
            }
            // A run that is killed shall leave a file that opens right, too.
            Some(seen) if open.bounds.outgrows(&seen) => open.send_layout(true)?,
            Some(_) => {}
        }
        open.output.set_time(frame.step, frame.time);
        let color_by = open.color_by.as_deref().unwrap_or_default();
        let has_color = |body: &BodyFrame<'_>| !self.grey.iter().any(|name| name == body.name);
        let colored = frame.bodies.iter().filter(|body| has_color(body));
        let mut all: Vec<f64> = colored.flat_map(|body| values(body, color_by)).copied().collect();
        let scale = self.scale.update(&mut all);
        let automatic = if scale.diverging { Colormap::Berlin } else { Colormap::Viridis };
        let map = self.settings.colormap.unwrap_or(automatic);
        if let Some(legend) = &mut open.legend {
            // Rounding is not a value outside.
            let slack = 1e-9 * (scale.high - scale.low);
            let beyond = [
                all.iter().any(|&value| value < scale.low - slack),
                all.iter().any(|&value| value > scale.high + slack),
            ];
            legend.show(&open.output, scale, map, beyond)?;
            if let Some(ends) = extremes(frame, color_by, has_color) {
                legend.show_extremes(&open.output, ends, open.layout.dimension.count())?;
            }
        }
        for body in frame.bodies {
            let shown = if has_color(body) { values(body, color_by) } else { &[] };
            let size = if open.layout.dimension == Dimension::Three && shown.is_empty() {
                SEEN_THROUGH
            } else {
                1.0
            };
            let radius = Radius::from(body.radius * size * self.settings.radius_scale as f32);
            let points = arrays::points(body.positions, &colors(shown, scale, map)).with_radii([radius]);
            open.output.log(&paths::body(body.name), &points)?;
            if self.settings.surfaces.iter().any(|name| name == body.name) {
                show_surface(&open.output, body, &colors(shown, scale, map))?;
            }
            for field in body.fields.iter().filter(|field| self.fields.iter().any(|name| name == field.name))
            {
                let numbers = arrays::scalars(field.values);
                open.output.log(&paths::field(body.name, field.name), &numbers)?;
            }
        }
        Ok(())
    }
}

/// The values of a field of a body; nothing if the body does not have it.
fn values<'a>(body: &BodyFrame<'a>, name: &str) -> &'a [f64] {
    body.fields.iter().find(|field| field.name == name).map_or(&[], |field| field.values)
}

/// The minimum and the maximum value of the coloured bodies, with their places.
fn extremes(
    frame: &Frame<'_>,
    color_by: &str,
    has_color: impl Fn(&BodyFrame<'_>) -> bool,
) -> Option<[PlacedExtreme; 2]> {
    let mut found: Option<[PlacedExtreme; 2]> = None;
    for body in frame.bodies.iter().filter(|body| has_color(body)) {
        for (value, place) in values(body, color_by).iter().zip(body.positions) {
            if value.is_nan() {
                continue;
            }
            let here = PlacedExtreme { value: *value, place: *place };
            let [least, greatest] = found.get_or_insert([here; 2]);
            if here.value < least.value {
                *least = here;
            }
            if here.value > greatest.value {
                *greatest = here;
            }
        }
    }
    found
}

fn file_name(scene_name: &str) -> String {
    format!("{scene_name}.rrd")
}

fn colors(values: &[f64], scale: ColorScale, map: Colormap) -> Vec<Color> {
    let color = |[r, g, b]: [u8; 3]| Color::from_rgb(r, g, b);
    if values.is_empty() {
        return vec![color(PLAIN)];
    }
    let of =
        |value: &f64| color(if value.is_nan() { NOT_A_NUMBER } else { map.color(scale.fraction(*value)) });
    values.iter().map(of).collect()
}

/// Which axis is up, as the viewer says it.
fn axes(up: [f64; 3]) -> ViewCoordinates {
    match up {
        [x, _, _] if x > 0.0 => ViewCoordinates::RIGHT_HAND_X_UP(),
        [x, _, _] if x < 0.0 => ViewCoordinates::RIGHT_HAND_X_DOWN(),
        [_, y, _] if y > 0.0 => ViewCoordinates::RIGHT_HAND_Y_UP(),
        [_, y, _] if y < 0.0 => ViewCoordinates::RIGHT_HAND_Y_DOWN(),
        [_, _, z] if z < 0.0 => ViewCoordinates::RIGHT_HAND_Z_DOWN(),
        _ => ViewCoordinates::RIGHT_HAND_Z_UP(),
    }
}

/// The unit vector that points up, read back from the axes as the viewer says them.
pub fn up_of(axes: [u8; 3]) -> [f64; 3] {
    axes.map(|axis| match axis {
        UP => 1.0,
        DOWN => -1.0,
        _ => 0.0,
    })
}

impl Open {
    /// Shows the particles of the first frame for good, as dots.
    fn show_undeformed(&self, frame: &Frame<'_>) -> Result<(), RerunError> {
        for body in frame.bodies {
            let points = arrays::points(body.positions, &[Color::from_rgb(60, 62, 66)])
                .with_radii([Radius::from(0.5 * SEEN_THROUGH * body.radius)]);
            self.output.log_static(&paths::undeformed(body.name), &points)?;
        }
        Ok(())
    }

    /// Decides how large the bodies are drawn.
    fn enlarge(&mut self) -> Result<(), RerunError> {
        self.enlargement = self.bounds.enlargement();
        if self.enlargement != 1.0 {
            let transform = Transform3D::from_scale(self.enlargement as f32);
            self.output.log_static(&paths::bodies(), &transform)?;
        }
        Ok(())
    }

    fn send_layout(&mut self, file_only: bool) -> Result<(), RerunError> {
        self.in_view = Some(self.bounds);
        let bounds = self.bounds.enlarged(self.enlargement);
        self.output.send_layout(file_only, || self.layout.messages(&bounds, &self.series))
    }
}

impl Recorder for RerunFile {
    fn fields(&self) -> Vec<String> {
        match &self.settings.color_by {
            Some(name) => vec![name.clone()],
            None if self.fields.is_empty() => vec!["velocity".to_owned()],
            None => Vec::new(),
        }
    }

    fn files(&self, scene_name: &str) -> Vec<String> {
        vec![file_name(scene_name)]
    }

    fn start(&mut self, run: &RunInfo<'_>) -> Result<(), RecordError> {
        Ok(self.open(run)?)
    }

    fn frame(&mut self, frame: &Frame<'_>) -> Result<(), RecordError> {
        Ok(self.write(frame)?)
    }

    fn samples(&mut self, step: u64, time: f64, samples: &[Sample<'_>]) -> Result<(), RecordError> {
        let open = self.open.as_mut().ok_or(RerunError::NotOpen)?;
        Ok(open.series.take(&open.output, step, time, samples)?)
    }

    fn flush(&mut self) -> Result<(), RecordError> {
        let open = self.open.as_mut().ok_or(RerunError::NotOpen)?;
        open.series.send_if_due(&open.output)?;
        Ok(open.output.flush()?)
    }

    fn finish(&mut self, warnings: &[String]) -> Result<(), RecordError> {
        let mut open = self.open.take().ok_or(RerunError::NotOpen)?;
        open.series.send(&open.output).map_err(RecordError::from)?;
        open.output.log_static(&paths::notes(), &open.notes.document(warnings)).map_err(RecordError::from)?;
        // In the file the camera now has in view where the particles went, and plots leave out accounts that
        // have stayed empty; a viewer that is watching keeps its own.
        open.series.finish();
        open.send_layout(true)?;
        Ok(open.output.complete()?)
    }
}
