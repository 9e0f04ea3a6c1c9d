//! A frame of a recording, read back from its file.

use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};

use re_sdk_types::archetypes::{Image, Points2D, Points3D, TextDocument, ViewCoordinates};
use rerun::external::re_log_encoding::DecoderApp;
use rerun::log::{Chunk, LogMsg, RowId};
use rerun::{ComponentDescriptor, StoreKind};
use thiserror::Error;

use crate::camera::Bounds;
use crate::recording::{TIMELINE, paths, up_of};

/// The particles of a body, as they are drawn.
#[derive(Clone, Debug, Default)]
pub struct RecordedBody {
    /// Name.
    pub name: String,
    /// Positions \[m\].
    pub positions: Vec<[f32; 3]>,
    /// A colour for each particle, or one for all.
    pub colors: Vec<[u8; 3]>,
    /// Radius of the particles \[m\].
    pub radius: f32,
    /// When they were there \[ns\].
    time: i64,
    /// The row of the recording that had them first: bodies are written in the order of the scene, but not
    /// kept in it.
    first_row: Option<RowId>,
}

/// Content of a recording at one time.
#[derive(Clone, Debug)]
pub struct RecordedFrame {
    /// Title of the scene.
    pub title: String,
    /// Name of the field of the colours; empty without one.
    pub field: String,
    /// The colours of the bar, from its lower end to its upper one.
    pub bar: Vec<[u8; 3]>,
    /// The values under the bar, evenly from end to end.
    pub values: Vec<String>,
    /// Minimum and maximum with their places.
    pub extremes: Vec<String>,
    /// Time of the frame \[s\].
    pub time: f64,
    /// The upward direction.
    pub up: [f64; 3],
    /// The bodies in the order of the scene.
    pub bodies: Vec<RecordedBody>,
    /// A box around the particles of all frames \[m\].
    pub bounds: Bounds,
    /// Error at the end of the file, if it has none: that of a killed run.
    pub cut_off: Option<String>,
}

/// Why a frame cannot be read.
#[derive(Debug, Error)]
pub enum ReadError {
    /// The file cannot be opened.
    #[error("`{}` cannot be read: {source}", path.display())]
    Open {
        /// The file.
        path: PathBuf,
        /// Error of the system.
        source: std::io::Error,
    },
    /// The file is no recording, or damaged.
    #[error("`{}` is not a recording that rerun {} can read: {message}", path.display(), rerun::build_info().version)]
    Damaged {
        /// The file.
        path: PathBuf,
        /// Error of rerun.
        message: String,
    },
    /// The recording has no particles at that time.
    #[error("`{}` has no frame up to {at} s; its first one is at {first} s", path.display())]
    TooEarly {
        /// The file.
        path: PathBuf,
        /// The time that was asked for \[s\].
        at: f64,
        /// The time of the first frame \[s\].
        first: f64,
    },
    /// The recording has no particles at all.
    #[error("`{}` has no frame", path.display())]
    Empty {
        /// The file.
        path: PathBuf,
    },
}

/// Reads the last frame up to the time `at` \[s\]; without one, the last of all.
///
/// # Errors
///
/// A file that cannot be read, is no recording, or has no such frame.
pub fn read_frame(path: &Path, at: Option<f64>) -> Result<RecordedFrame, ReadError> {
    let file = File::open(path).map_err(|source| ReadError::Open { path: path.to_owned(), source })?;
    let damaged = |message: String| ReadError::Damaged { path: path.to_owned(), message };
    let messages =
        DecoderApp::decode_eager(BufReader::new(file)).map_err(|error| damaged(error.to_string()))?;
    // Times are kept to the nanosecond.
    let mut reader = RecordingReader::new(at.map_or(i64::MAX, |time| (time * 1e9).round() as i64));
    for message in messages {
        let chunk = message.map_err(|error| error.to_string()).and_then(chunk_of);
        match chunk {
            Ok(Some(chunk)) => reader.take(&chunk),
            Ok(None) => {}
            Err(message) => {
                reader.frame.cut_off = Some(message);
                break;
            }
        }
    }
    reader.finish(path, at)
}

/// The data of a message of the recording; nothing if it belongs to the layout.
fn chunk_of(message: LogMsg) -> Result<Option<Chunk>, String> {
    match message {
        LogMsg::ArrowMsg(store, data) if store.kind() == StoreKind::Recording => {
            Chunk::from_arrow_msg(&data).map(Some).map_err(|error| error.to_string())
        }
        _ => Ok(None),
    }
}

/// State of reading.
struct RecordingReader {
    at: i64,
    first: i64,
    frame: RecordedFrame,
    bar_time: i64,
    values_time: i64,
    extremes_time: i64,
}

impl RecordingReader {
    fn new(at: i64) -> Self {
        let frame = RecordedFrame {
            title: String::new(),
            field: String::new(),
            bar: Vec::new(),
            values: Vec::new(),
            extremes: Vec::new(),
            time: 0.0,
            up: [0.0, 1.0, 0.0],
            bodies: Vec::new(),
            bounds: Bounds::EMPTY,
            cut_off: None,
        };
        let never = i64::MIN;
        Self { at, first: i64::MAX, frame, bar_time: never, values_time: never, extremes_time: never }
    }

    fn take(&mut self, chunk: &Chunk) {
        let entity = chunk.entity_path();
        if entity.is_root() {
            self.add_chunk(chunk);
        } else if *entity == paths::title() {
            text(chunk, &mut self.frame.title);
        } else if *entity == paths::legend_part("title") {
            text(chunk, &mut self.frame.field);
        } else if *entity == paths::legend_part("values") {
            labels(chunk, self.at, &mut self.values_time, &mut self.frame.values);
        } else if *entity == paths::legend_part("extremes") {
            labels(chunk, self.at, &mut self.extremes_time, &mut self.frame.extremes);
        } else if *entity == paths::legend_part("bar") {
            self.take_bar(chunk);
        } else if entity.len() == 2 && entity.is_child_of(&paths::bodies()) && !chunk.is_static() {
            self.take_body(chunk);
        }
    }

    fn add_chunk(&mut self, chunk: &Chunk) {
        let component = ViewCoordinates::descriptor_xyz().component;
        let axes = chunk.iter_slices::<[u8; 3]>(component).next();
        if let Some(axes) = axes.and_then(|axes| axes.first()) {
            self.frame.up = up_of(*axes);
        }
    }

    fn take_bar(&mut self, chunk: &Chunk) {
        let buffer = Image::descriptor_buffer();
        let format = chunk
            .iter_component::<re_sdk_types::components::ImageFormat>(Image::descriptor_format().component);
        let widths = format.map(|format| format.as_slice().first().map_or(0, |format| format.width as usize));
        let rows = times(chunk, &buffer).zip(chunk.iter_slices::<&[u8]>(buffer.component)).zip(widths);
        for ((time, pixels), width) in rows {
            let row = pixels.first().and_then(|bytes| bytes.get(..3 * width));
            if let Some(row) = row.filter(|_| (self.bar_time..=self.at).contains(&time)) {
                self.bar_time = time;
                self.frame.bar = row.chunks_exact(3).map(|rgb| [rgb[0], rgb[1], rgb[2]]).collect();
            }
        }
    }

    fn take_body(&mut self, chunk: &Chunk) {
        let (places, paint, size) =
            (Points3D::descriptor_positions(), Points3D::descriptor_colors(), Points3D::descriptor_radii());
        let name =
            chunk.entity_path().iter().last().map_or(String::new(), |part| part.unescaped_str().to_owned());
        let known = self.frame.bodies.iter().position(|body| body.name == name);
        let k = known.unwrap_or_else(|| {
            self.frame.bodies.push(RecordedBody { name, time: i64::MIN, ..RecordedBody::default() });
            self.frame.bodies.len() - 1
        });
        let first_row = chunk.row_ids().min();
        let body = &mut self.frame.bodies[k];
        body.first_row = body.first_row.into_iter().chain(first_row).min();
        let rows = times(chunk, &places)
            .zip(chunk.iter_slices::<[f32; 3]>(places.component))
            .zip(chunk.iter_slices::<u32>(paint.component))
            .zip(chunk.iter_slices::<f32>(size.component));
        for (((time, positions), colors), radii) in rows {
            let radius = radii.first().copied().unwrap_or(0.0);
            self.frame.bounds.extend(positions, f64::from(radius));
            self.first = self.first.min(time);
            let body = &mut self.frame.bodies[k];
            if (body.time..=self.at).contains(&time) {
                body.time = time;
                body.positions = positions.to_vec();
                body.colors = colors.iter().map(|&color| rgb(color)).collect();
                body.radius = radius;
            }
        }
    }

    fn finish(self, path: &Path, at: Option<f64>) -> Result<RecordedFrame, ReadError> {
        let mut frame = self.frame;
        frame.bodies.sort_by_key(|body| body.first_row);
        let path = path.to_owned();
        let latest = frame.bodies.iter().map(|body| body.time).max().filter(|&time| time != i64::MIN);
        match (latest, frame.cut_off.take(), at) {
            (Some(time), cut_off, _) => {
                frame.time = time as f64 * 1e-9;
                frame.cut_off = cut_off;
                Ok(frame)
            }
            (None, _, Some(at)) if self.first != i64::MAX => {
                Err(ReadError::TooEarly { path, at, first: self.first as f64 * 1e-9 })
            }
            (None, Some(message), _) => Err(ReadError::Damaged { path, message }),
            (None, None, _) => Err(ReadError::Empty { path }),
        }
    }
}

/// The times of the rows of a component \[ns\].
fn times(chunk: &Chunk, component: &ComponentDescriptor) -> impl Iterator<Item = i64> {
    chunk.iter_component_indices(TIMELINE.into(), component.component).map(|(time, _)| time.as_i64())
}

/// A text that is the same at all times.
fn text(chunk: &Chunk, into: &mut String) {
    let component = TextDocument::descriptor_text().component;
    if let Some(text) = chunk.iter_slices::<String>(component).next().and_then(|texts| texts.first().cloned())
    {
        *into = text.to_string();
    }
}

/// The labels of points, of the last row up to the time `at`.
fn labels(chunk: &Chunk, at: i64, time_of: &mut i64, into: &mut Vec<String>) {
    let component = Points2D::descriptor_labels();
    for (time, texts) in times(chunk, &component).zip(chunk.iter_slices::<String>(component.component)) {
        if (*time_of..=at).contains(&time) {
            *time_of = time;
            *into = texts.iter().map(ToString::to_string).collect();
        }
    }
}

fn rgb(color: u32) -> [u8; 3] {
    let [r, g, b, _] = color.to_be_bytes();
    [r, g, b]
}
