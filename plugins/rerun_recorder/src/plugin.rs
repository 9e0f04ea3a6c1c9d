//! The plugin as scenes name it: its parameters, and their check.

use meshless_engine::formulations::fluid::Wall;
use meshless_engine::plugin::{Formulation, Plugin, Registry, SetupError, SimBuilder};
use meshless_engine::scene::{Dimension, Scene};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::colormap::Colormap;
use crate::recording::{add, check_address};

/// Registers the plugin.
pub fn register(registry: &mut Registry) {
    registry.plugin::<RerunRecorder>();
}

/// Writes a recording for the rerun viewer, `<scene>.rrd`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct RerunRecorder {
    /// The field that colours the particles, such as `"von_mises"` or `"velocity"`; of a vector its
    /// magnitude. Default: the first of `record.fields`, else `"velocity"`.
    pub color_by: Option<String>,
    /// Values at the two ends of the colour scale, in the unit of the field. Default: round values around
    /// those of all frames so far, so that the scale only grows; one particle in two hundred may lie outside
    /// at either end, and what a single frame alone has reached, such as an impact.
    pub range: Option<(f64, f64)>,
    /// Colour map. Default: `Viridis`, or `Berlin` where the values lie on both sides of zero.
    pub colormap: Option<Colormap>,
    /// Bodies drawn in grey, whatever their field, and left out of the range. Default: the walls, so that a
    /// fluid can be told from its tank. In three dimensions they are dots, so that one sees into it; so are
    /// bodies that do not have the field, such as rigid tools beside stresses.
    pub grey: Option<Vec<String>>,
    /// Dots where the particles were in the first frame. Default: false.
    pub undeformed: bool,
    /// Bodies drawn as closed surfaces, in three dimensions. It needs a program built with `--features
    /// surfaces`. Default: none.
    pub surfaces: Vec<String>,
    /// Radius of the particles in the picture over half their spacing \[1\]. Default: 1.
    pub radius_scale: f64,
    /// A rerun viewer that shows the run while it goes on, such as `"127.0.0.1:9876"`; the file is written
    /// all the same.
    pub connect: Option<String>,
}

impl Default for RerunRecorder {
    fn default() -> Self {
        Self {
            color_by: None,
            range: None,
            colormap: None,
            grey: None,
            undeformed: false,
            surfaces: Vec::new(),
            radius_scale: 1.0,
            connect: None,
        }
    }
}

impl Plugin for RerunRecorder {
    const NAME: &'static str = "rerun_recorder";
    const REFERENCE: &'static str = "";

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        self.check()?;
        let grey = self.grey_bodies(sim.scene())?;
        self.check_surfaces(sim.scene(), sim.dimension())?;
        let gravity = sim.gravity().to_array();
        let up = match sim.dimension() {
            Dimension::Two => [0.0, 1.0, 0.0],
            Dimension::Three => against(gravity),
        };
        add(self, grey, up, sim);
        Ok(())
    }
}

impl RerunRecorder {
    /// Names of the bodies that have no colours.
    fn grey_bodies(&self, scene: &Scene) -> Result<Vec<String>, SetupError> {
        let Some(named) = &self.grey else {
            let walls = scene.bodies.iter().filter(|body| body.formulation.name() == Wall::NAME);
            return Ok(walls.map(|body| body.name.clone()).collect());
        };
        bodies_of("grey", named, scene)?;
        Ok(named.clone())
    }

    fn check_surfaces(&self, scene: &Scene, dimension: Dimension) -> Result<(), SetupError> {
        if self.surfaces.is_empty() {
            return Ok(());
        }
        bodies_of("surfaces", &self.surfaces, scene)?;
        let refused =
            |message: &str, help: &str| Err(SetupError::parameter("surfaces", message.to_owned(), help));
        if dimension == Dimension::Two {
            return refused(
                "`surfaces` are meshes in three dimensions, and this scene is plane",
                "`meshless picture --smooth` draws plane bodies as areas",
            );
        }
        if cfg!(feature = "rerun") && !cfg!(feature = "surfaces") {
            return refused(
                "this program was built without `surfaces`",
                "build it with `cargo build --release --features surfaces`, or leave `surfaces` out",
            );
        }
        Ok(())
    }

    fn check(&self) -> Result<(), SetupError> {
        if let Some((low, high)) = self.range
            && !(low < high && low.is_finite() && high.is_finite())
        {
            return Err(SetupError::parameter(
                "range",
                format!("the lower end of `range` must be below the upper one, found ({low}, {high})"),
                "give two finite numbers, the smaller first",
            ));
        }
        if !(self.radius_scale > 0.0 && self.radius_scale.is_finite()) {
            return Err(SetupError::parameter(
                "radius_scale",
                format!("`radius_scale` must be positive, found {}", self.radius_scale),
                "1 lets neighbouring particles just touch",
            ));
        }
        if let Some(text) = &self.connect
            && let Err(error) = check_address(text)
        {
            return Err(SetupError::parameter(
                "connect",
                error.to_string(),
                "give host and port of a running viewer, such as \"127.0.0.1:9876\"",
            ));
        }
        Ok(())
    }
}

/// Checks that the scene has all bodies that the parameter `field` names.
fn bodies_of(field: &'static str, named: &[String], scene: &Scene) -> Result<(), SetupError> {
    let Some(unknown) = named.iter().find(|name| scene.bodies.iter().all(|body| body.name != **name)) else {
        return Ok(());
    };
    let known: Vec<_> = scene.bodies.iter().map(|body| format!("`{}`", body.name)).collect();
    let message = format!("there is no body `{unknown}`");
    Err(SetupError::parameter(field, message, format!("the bodies are {}", known.join(", "))))
}

/// The unit vector along the axis nearest to the direction opposite to gravity; z without gravity.
fn against(gravity: [f64; 3]) -> [f64; 3] {
    let mut up = [0.0, 0.0, 1.0];
    let axis = (0..3).max_by(|&a, &b| gravity[a].abs().total_cmp(&gravity[b].abs()));
    if let Some(axis) = axis.filter(|&axis| gravity[axis] != 0.0) {
        up = [0.0; 3];
        up[axis] = -gravity[axis].signum();
    }
    up
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn up_is_against_gravity() {
        assert_eq!(against([0.0, -9.81, 0.0]), [0.0, 1.0, 0.0]);
        assert_eq!(against([0.1, 0.0, 2.0]), [0.0, 0.0, -1.0]);
        assert_eq!(against([0.0; 3]), [0.0, 0.0, 1.0]);
    }

    #[test]
    fn parameters_out_of_range_are_refused_by_name() {
        let faulty = [
            ("range", RerunRecorder { range: Some((1.0, 1.0)), ..RerunRecorder::default() }),
            ("range", RerunRecorder { range: Some((0.0, f64::NAN)), ..RerunRecorder::default() }),
            ("radius_scale", RerunRecorder { radius_scale: 0.0, ..RerunRecorder::default() }),
            #[cfg(feature = "rerun")]
            ("connect", RerunRecorder { connect: Some("my viewer".into()), ..RerunRecorder::default() }),
        ];
        for (name, plugin) in faulty {
            match plugin.check() {
                Err(SetupError::Parameter { field, .. }) => assert_eq!(field, name),
                other => panic!("{name}: {other:?}"),
            }
        }
        let good = RerunRecorder { connect: Some("127.0.0.1:9876".into()), ..RerunRecorder::default() };
        assert_eq!(good.check(), Ok(()));
    }
}
