//! What the viewer shows when a recording is opened: particles with their colour bar on the left, plots on
//! the right.

use meshless_engine::scene::Dimension;
use re_sdk_types::blueprint::archetypes::{
    Background, EyeControls3D, LineGrid3D, PlotLegend, TextDocumentFormat, VisualBounds2D,
};
use re_sdk_types::blueprint::components::{
    BackgroundKind, ContainerKind, Corner2D, Enabled, VisualBounds2D as Visible2D,
};
use re_sdk_types::components::{Color, Position3D, Vector3D};
use re_sdk_types::datatypes::{Bool, Range2D};
use rerun::log::LogMsg;
use rerun::{EntityPath, RecordingStreamResult};

use super::blueprint::{Blueprint, Tile, ViewKind, only, with_children, without};
use super::legend;
use super::paths;
use super::series::{Plot, SeriesTable};
use crate::camera::{Bounds, Viewpoint};

/// Input of the layout.
pub struct Layout {
    /// Title of the scene.
    pub title: String,
    /// Plane or space.
    pub dimension: Dimension,
    /// The upward direction.
    pub up: [f64; 3],
    /// The bodies by name.
    pub bodies: Vec<String>,
    /// Name of the field of the colours, if there is one.
    pub colors: Option<String>,
    /// Bodies that are drawn as surfaces.
    pub surfaces: Vec<String>,
    /// Whether the particles of the first frame are shown, too.
    pub undeformed: bool,
    /// Simulated time, s.
    pub duration: f64,
}

/// Time in which the viewer plays the run, s.
const PLAYING_TIME: f64 = 10.0;
/// Width over height of the view, about what the layout gives in windows of usual shapes.
const ASPECT: f64 = 1.3;
/// Behind the particles: light, so that the dark end of the colour maps can be seen.
pub const BACKGROUND: [u8; 3] = [236, 238, 241];

impl Layout {
    /// The layout, with a camera that has the box in view.
    pub fn messages(&self, bounds: &Bounds, series: &SeriesTable) -> RecordingStreamResult<Vec<LogMsg>> {
        let blueprint = Blueprint::new()?;
        let left = self.left(&blueprint, bounds)?;
        let plots = plots(&blueprint, series)?;
        let root = if plots.is_empty() {
            blueprint.container(ContainerKind::Horizontal, &[(left, 1.0)])?
        } else {
            let right = blueprint.container(ContainerKind::Vertical, &plots)?;
            blueprint.container(ContainerKind::Horizontal, &[(left, 3.0), (right, 2.0)])?
        };
        blueprint.finish(&root, if self.duration > 0.0 { self.duration / PLAYING_TIME } else { 1.0 })
    }

    fn left(&self, blueprint: &Blueprint, bounds: &Bounds) -> RecordingStreamResult<Tile> {
        let [r, g, b] = BACKGROUND;
        let background = Background::new(BackgroundKind::SolidColor).with_color(Color::from_rgb(r, g, b));
        let scene = self.space(blueprint, bounds, &background)?;
        let format = TextDocumentFormat::new().with_monospace(Enabled(Bool(true)));
        let text = blueprint.view(
            ViewKind::Text,
            "Scene",
            &[only(&paths::scene())],
            &[("TextDocumentFormat", &format)],
        )?;
        let notes = blueprint.view(ViewKind::Text, "Notes", &[only(&paths::notes())], &[])?;
        let tabs = blueprint.tabs(&[scene, text, notes])?;
        let Some(field) = &self.colors else {
            return blueprint.container(
                ContainerKind::Vertical,
                &tabs.map(|tile| (tile, 1.0)).into_iter().collect::<Vec<_>>(),
            );
        };
        let [x, y] = legend::VISIBLE;
        let bounds = VisualBounds2D::new(Visible2D(Range2D { x_range: x.into(), y_range: y.into() }));
        let bar = blueprint.view(
            ViewKind::Plane,
            &legend::title(field),
            &[with_children(&paths::legend())],
            &[("Background", &background), ("VisualBounds2D", &bounds)],
        )?;
        let mut tiles: Vec<(Tile, f32)> = tabs.map(|tile| (tile, 6.0)).into_iter().collect();
        tiles.push((bar, 1.0));
        blueprint.container(ContainerKind::Vertical, &tiles)
    }

    /// The entity drawn for a body: its particles, or its surface.
    fn shown(&self, body: &str) -> EntityPath {
        let as_surface = self.surfaces.iter().any(|name| name == body);
        if as_surface { paths::surface(body) } else { paths::body(body) }
    }

    fn space(
        &self,
        blueprint: &Blueprint,
        bounds: &Bounds,
        background: &Background,
    ) -> RecordingStreamResult<Tile> {
        let eye = Viewpoint::on(bounds, self.dimension, self.up, ASPECT);
        let single = |v: [f64; 3]| v.map(|x| x as f32);
        let camera = EyeControls3D::new()
            .with_position(Position3D::from(single(eye.position)))
            .with_look_target(Position3D::from(single(eye.target)))
            .with_eye_up(Vector3D::from(single(eye.up)));
        let grid = LineGrid3D::new().with_visible(false);
        let mut contents: Vec<String> = self.bodies.iter().map(|body| only(&self.shown(body))).collect();
        if self.undeformed {
            contents.extend(self.bodies.iter().map(|body| only(&paths::undeformed(body))));
        }
        blueprint.view(
            ViewKind::Space,
            &self.title,
            &contents,
            &[("EyeControls3D", &camera), ("LineGrid3D", &grid), ("Background", background)],
        )
    }
}

fn plots(blueprint: &Blueprint, series: &SeriesTable) -> RecordingStreamResult<Vec<(Tile, f32)>> {
    // Runs mostly start from rest; where they end is of more interest.
    let view = |plot: &Plot| {
        // A single curve is named by the title.
        let legend = PlotLegend::new().with_corner(Corner2D::LeftTop).with_visible(plot.has_legend);
        let contents: Vec<String> =
            plot.include.iter().map(with_children).chain(plot.exclude.iter().map(without)).collect();
        blueprint.view(ViewKind::Plot, &plot.title, &contents, &[("PlotLegend", &legend)])
    };
    let views = |plots: Vec<Plot>| plots.iter().map(view).collect::<RecordingStreamResult<Vec<Tile>>>();
    let mut tiles = Vec::new();
    tiles.extend(blueprint.tabs(&views(series.energies())?)?.map(|tile| (tile, 3.0)));
    tiles.extend(blueprint.tabs(&views(series.errors())?)?.map(|tile| (tile, 2.0)));
    let probes = views(series.probes())?;
    if probes.len() <= 2 {
        tiles.extend(probes.into_iter().map(|tile| (tile, 3.0)));
    } else {
        tiles.extend(blueprint.tabs(&probes)?.map(|tile| (tile, 3.0)));
    }
    Ok(tiles)
}
