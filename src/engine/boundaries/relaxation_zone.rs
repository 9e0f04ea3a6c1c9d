//! Zones in which a flow is led to a given velocity: inlets and outlets, generated and absorbed waves.

use glam::DVec3;
use schemars::JsonSchema;
use serde::Deserialize;

use super::field::VectorField;
use super::mean_velocity::take_mean_velocities;
use super::zone_box::ZoneBox;
use super::zone_checks::warnings;
use super::zone_flow::{ACCOUNT, FlowZone, FlowZones, NAME, ZoneFlow};
use crate::notation::place as words;
use crate::plugin::{BodyKind, BodyPlan, Plugin, SetupError, SimBuilder};
use crate::scene::{Expression, PerAxis, Select, Vec3};
use crate::schedule::{Shared, Stage, System};
use crate::world::{BodySet, Mass, Mobility, Position, Velocity};

/// Leads fluids to a given velocity within a box: the inlet and outlet of a channel or of a stream past a
/// body, the end of a tank in which waves are generated or absorbed.
///
/// Velocities decay towards `value` as v' = -rate s^2 (v - value), where s grows from 0 to 1 through the box
/// in the direction of `along`: the flow enters the zone without a jump and has the given velocity at its
/// end. An inlet and an outlet are one zone that closes a periodic domain: what leaves through the outlet
/// loses its wake there, and comes in with the profile of the inlet. Along such an axis a uniform force per
/// mass, times s^2, is adjusted until the mean velocity in the zone is the given one. The energy that the
/// zone supplies is in the account `relaxation_zone`.
///
/// A channel from x = 0 to 2 m, 0.4 m high, its inlet and outlet closed by a zone 0.4 m long: `domain: (min:
/// (-0.4, -0.1), max: (2, 0.5), periodic: [X])`, `RelaxationZone(min: (-0.4, 0), max: (0, 0.4), along: (1,
/// 0), value: ("6*y*(0.4 - y)/0.16", 0))`, and an `InitialVelocity` with the same `value`, so that nothing
/// has to be accelerated. Waves with a celerity of 3 m/s that end at x = 10 m: `RelaxationZone(min: (8, -1),
/// max: (10, 1), along: (1, 0), value: (0, 0), rate: 9)`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RelaxationZone {
    /// Fluid; `"water*"` stands for all whose names begin with `water`. Without it: all fluids.
    #[serde(default)]
    pub body: Option<String>,
    /// Corner of the box with the smallest coordinates \[m\].
    pub min: Vec3,
    /// Corner of the box with the largest coordinates \[m\].
    pub max: Vec3,
    /// Direction in which the zone grows stronger, of any length \[-\]: downstream between an outlet and an
    /// inlet, towards the end of a tank of waves.
    pub along: Vec3,
    /// Velocity per axis \[m/s\], a function of place and time; `None` leaves an axis free.
    pub value: PerAxis<Expression>,
    /// Rate at the end of the zone \[1/s\]. Without it, along a periodic axis: 6 c_0 over the length of the
    /// zone. For waves 6 times their celerity over that length.
    #[serde(default)]
    pub rate: Option<f64>,
}

/// Default rate, in speeds of sound over the length of the zone: its mean over the zone is a third of it. A
/// sound wave that is long beside the zone meets a sheet of the resistance 2 rho c_0, of which one half goes
/// back, one half passes, and one half of the energy is lost, the most that a sheet can take. The flow, ten
/// times as slow as sound, keeps e^-20 of what it has in excess.
const RATE: f64 = 6.0;
/// Time within which the uniform force follows, over that in which sound crosses the period: with it the flux
/// of an incompressible flow settles like an oscillator with 0.7 of the critical damping.
const SETTLING: f64 = 1.0;
impl Plugin for RelaxationZone {
    const NAME: &'static str = NAME;
    const REFERENCE: &'static str =
        "fringe region: J. Nordstrom, N. Nordin, D. Henningson, SIAM J. Sci. Comput. 20 (1999) 1365-1393";

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        let zone = self.zone(sim)?;
        let axes: Vec<usize> = (0..3).filter(|&axis| zone.driven[axis] != 0.0).collect();
        let driven = zone.bodies.iter().flat_map(|&id| axes.iter().map(move |&axis| (id, axis)));
        take_mean_velocities(driven, NAME, "value", sim)?;
        warnings(&zone, sim).into_iter().for_each(|warning| sim.warn(warning));
        let bodies = BodySet::new(zone.bodies.iter().copied());
        if let Some(zones) = sim.take_extensions::<Shared<FlowZones>>().pop() {
            sim.shared_mut(zones).0.push(zone);
            sim.leave_note(zones);
            return Ok(());
        }
        let zones = sim.share(FlowZones(vec![zone]));
        sim.leave_note(zones);
        let phases = sim.phases_of(&bodies);
        sim.add_system(
            System::new(Stage::PostStep, ACCOUNT, ZoneFlow::new(zones))
                .on_phases(phases)
                .after_any("local_damping")
                .after_any("xsph")
                .after_any("particle_shifting")
                .reads::<Position>()
                .reads::<Mass>()
                .reads::<Mobility>()
                .writes::<Velocity>(),
        );
        Ok(())
    }
}

impl RelaxationZone {
    fn zone(self, sim: &SimBuilder<'_>) -> Result<FlowZone, SetupError> {
        let bodies = self.fluids(sim)?;
        let dimensions = sim.dimension().count();
        let place = ZoneBox::new([self.min.0, self.max.0], self.along.0, dimensions, sim.periodic())?;
        let sound = bodies.iter().filter_map(|body| body.material.sound_speed()).fold(0.0, f64::max);
        let default = (0..dimensions).any(|axis| place.repeats(axis)).then_some(RATE * sound / place.length);
        let Some(rate) = self.rate.or(default) else {
            let help = "`along` is not along a periodic axis, so that the zone is no outlet and inlet; for waves give the rate of decay at the end of the zone: they are absorbed best at some 6 times their celerity over the length of the zone";
            return Err(SetupError::parameter("rate", "`rate` is missing", help));
        };
        if !(rate > 0.0 && rate.is_finite()) {
            let message = format!("`rate` must be positive, found {rate} 1/s");
            return Err(SetupError::parameter("rate", message, "leave it out for the default"));
        }
        let field = VectorField::new(self.value, sim)?;
        let sites = bodies.iter().flat_map(|body| body.sites.iter()).map(|site| site.position);
        for site in sites.filter(|&site| place.strength(site) > 0.0) {
            let value = field.at(place.image(site), 0.0);
            if !value.is_finite() {
                let message =
                    format!("the velocity must be finite, found {} at {} m", words(value), words(site));
                let help = "give an expression that is finite in the whole zone";
                return Err(SetupError::parameter("value", message, help));
            }
        }
        let flags = |is: [bool; 3]| DVec3::from_array(is.map(|is| f64::from(u8::from(is))));
        let given = field.axes();
        Ok(FlowZone {
            bodies: bodies.iter().map(|body| body.id).collect(),
            mass: bodies.iter().map(|body| body.mass()).sum(),
            axes: flags(given),
            field,
            rate,
            sound,
            settling: SETTLING * place.period() / sound,
            driven: flags([0, 1, 2].map(|axis| given[axis] && place.repeats(axis))),
            place,
        })
    }

    /// The fluids on which it acts.
    fn fluids<'s>(&self, sim: &'s SimBuilder<'_>) -> Result<Vec<&'s BodyPlan>, SetupError> {
        let is_fluid = |body: &&BodyPlan| body.kind == BodyKind::Fluid;
        let Some(name) = &self.body else {
            let all: Vec<&BodyPlan> = sim.bodies().iter().filter(is_fluid).collect();
            let help = "a relaxation zone acts on bodies with `formulation: Fluid`";
            return if all.is_empty() {
                Err(SetupError::parameter("min", "the scene has no fluid", help))
            } else {
                Ok(all)
            };
        };
        let select = Select { body: Some(name.clone()), ..Select::default() };
        let named = sim.select_at_start(&select, "")?.parts;
        let named: Vec<&BodyPlan> = named.iter().map(|(id, _)| sim.body(*id)).collect();
        match named.iter().find(|body| !is_fluid(body)) {
            None => Ok(named),
            Some(body) => {
                let message = format!("body `{}` is not a fluid", body.name);
                Err(SetupError::parameter("body", message, "solids and walls are moved by `Velocity`"))
            }
        }
    }
}
