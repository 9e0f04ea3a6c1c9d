//! Views and containers of the viewer's layout, written as the viewer keeps them.
//!
//! The layout builder of the rerun crate cannot set cameras, backgrounds and bounds of views, and does not
//! tell the names of its views to those who would set them; the archetypes beneath it can be logged by
//! anyone.

use re_sdk_types::blueprint::archetypes::{
    ContainerBlueprint, PanelBlueprint, TimePanelBlueprint, ViewBlueprint, ViewContents, ViewportBlueprint,
};
use re_sdk_types::blueprint::components::{
    AutoLayout, AutoViews, ColumnShare, ContainerKind, IncludedContent, LoopMode, PanelState, PlayState,
    PlaybackSpeed, QueryExpression, RootContainer, RowShare, TimelineName, ViewClass,
};
use re_sdk_types::components::Name;
use re_sdk_types::datatypes::{Bool, Float32, Float64};
use re_sdk_types::external::uuid::Uuid;
use rerun::log::LogMsg;
use rerun::sink::MemorySinkStorage;
use rerun::{AsComponents, EntityPath, RecordingStream, RecordingStreamBuilder, RecordingStreamResult};

use super::output::{APPLICATION, TIMELINE};

/// A layout that is being written.
pub struct Blueprint {
    stream: RecordingStream,
    storage: MemorySinkStorage,
}

/// A view or a container that is in the layout.
#[derive(Clone, Debug)]
pub struct Tile {
    path: String,
    id: Uuid,
}

/// A kind of view.
#[derive(Clone, Copy, Debug)]
pub enum ViewKind {
    /// Particles in space.
    Space,
    /// Pictures in a plane.
    Plane,
    /// Time series.
    Plot,
    /// A text.
    Text,
}

impl ViewKind {
    fn class(self) -> &'static str {
        match self {
            Self::Space => "3D",
            Self::Plane => "2D",
            Self::Plot => "TimeSeries",
            Self::Text => "TextDocument",
        }
    }
}

impl Blueprint {
    /// An empty layout.
    pub fn new() -> RecordingStreamResult<Self> {
        let id = Uuid::new_v4().to_string();
        let builder = RecordingStreamBuilder::new(APPLICATION).enabled(true).recording_id(id).blueprint();
        let (stream, storage) = builder.memory()?;
        stream.set_time_sequence("blueprint", 0);
        Ok(Self { stream, storage })
    }

    /// Adds a view of these entities (`- /path/**` leaves some out), with properties by name.
    pub fn view(
        &self,
        kind: ViewKind,
        name: &str,
        contents: &[String],
        properties: &[(&str, &dyn AsComponents)],
    ) -> RecordingStreamResult<Tile> {
        let tile = Tile::new("view");
        let contents = contents.iter().map(|query| QueryExpression(query.as_str().into()));
        self.stream.log(format!("{}/ViewContents", tile.path), &ViewContents::new(contents))?;
        let view = ViewBlueprint::new(ViewClass(kind.class().into()))
            .with_display_name(Name(name.into()))
            .with_space_origin("/");
        self.stream.log(tile.path.as_str(), &view)?;
        for (name, property) in properties {
            self.stream.log(format!("{}/{name}", tile.path), *property)?;
        }
        Ok(tile)
    }

    /// Adds a container of tiles side by side, one above the other, or behind each other, with their shares.
    pub fn container(&self, kind: ContainerKind, tiles: &[(Tile, f32)]) -> RecordingStreamResult<Tile> {
        let tile = Tile::new("container");
        let contents = tiles.iter().map(|(tile, _)| IncludedContent(tile.path.as_str().into()));
        let shares = tiles.iter().map(|(_, share)| Float32(*share));
        let mut container = ContainerBlueprint::new(kind).with_contents(contents);
        container = match kind {
            ContainerKind::Horizontal => container.with_col_shares(shares.map(ColumnShare)),
            ContainerKind::Vertical => container.with_row_shares(shares.map(RowShare)),
            ContainerKind::Tabs | ContainerKind::Grid => container,
        };
        self.stream.log(tile.path.as_str(), &container)?;
        Ok(tile)
    }

    /// Tiles behind each other, the first in front; a single one stays as it is.
    pub fn tabs(&self, tiles: &[Tile]) -> RecordingStreamResult<Option<Tile>> {
        match tiles {
            [] => Ok(None),
            [one] => Ok(Some(one.clone())),
            more => {
                let tiles: Vec<(Tile, f32)> = more.iter().map(|tile| (tile.clone(), 1.0)).collect();
                self.container(ContainerKind::Tabs, &tiles).map(Some)
            }
        }
    }

    /// Sets what fills the window, folds the panels at the sides, and lets the run be played in `seconds`.
    pub fn finish(self, root: &Tile, playback_speed: f64) -> RecordingStreamResult<Vec<LogMsg>> {
        let viewport = ViewportBlueprint::new()
            .with_root_container(RootContainer(root.id.into()))
            .with_auto_layout(AutoLayout(Bool(false)))
            .with_auto_views(AutoViews(Bool(false)));
        self.stream.log("viewport", &viewport)?;
        let folded = PanelBlueprint::new().with_state(PanelState::Collapsed);
        self.stream.log("blueprint_panel", &folded)?;
        self.stream.log("selection_panel", &folded)?;
        let time = TimePanelBlueprint::new()
            .with_state(PanelState::Collapsed)
            .with_timeline(TimelineName(TIMELINE.into()))
            .with_playback_speed(PlaybackSpeed(Float64(playback_speed)))
            // The viewer follows a running simulation, and shows the last frame of one that is over.
            .with_play_state(PlayState::Following)
            .with_loop_mode(LoopMode::Off);
        self.stream.log("time_panel", &time)?;
        Ok(self.storage.take())
    }
}

impl Tile {
    fn new(kind: &str) -> Self {
        let id = Uuid::new_v4();
        Self { path: format!("{kind}/{id}"), id }
    }
}

/// The query for an entity alone.
pub fn only(path: &EntityPath) -> String {
    format!("+ {path}")
}

/// The query for an entity and all beneath it.
pub fn with_children(path: &EntityPath) -> String {
    format!("+ {path}/**")
}

/// The query that leaves out an entity and all beneath it.
pub fn without(path: &EntityPath) -> String {
    format!("- {path}/**")
}
