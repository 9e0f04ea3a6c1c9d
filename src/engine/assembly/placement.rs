//! Bodies against the domain and its periods, before any neighbour search: particles outside the domain, or
//! two at one place, make that search slow and its result wrong.

use crate::notation::{count, digits, number};
use crate::plugin::BodyPlan;
use crate::scene::{Axis, Domain, Problem, Scene};

/// One problem for every body and axis.
pub(super) fn problems(bodies: &[BodyPlan], scene: &Scene) -> Vec<Problem> {
    let Some(domain) = &scene.domain else { return Vec::new() };
    let axes = [Axis::X, Axis::Y, Axis::Z].into_iter().take(scene.dimension.count());
    let of_body = |body| axes.clone().filter_map(move |axis| problem(body, axis, domain));
    bodies.iter().flat_map(of_body).collect()
}

fn problem(body: &BodyPlan, axis: Axis, domain: &Domain) -> Option<Problem> {
    let k = axis.index();
    let (min, max) = (domain.min.0[k], domain.max.0[k]);
    let places = body.sites.iter().map(|site| site.position[k]);
    let (lowest, highest) =
        places.clone().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    let at = format!("bodies[{}].shape", body.id.0);
    let name = &body.name;
    if domain.periodic.contains(&axis) {
        // Particles fill their cells: a body that just fits is a spacing longer than its outermost places are
        // apart.
        let (extent, period) = (highest - lowest + body.spacing, max - min);
        let message = format!(
            "body `{name}` must not be longer than the period of {} m along {axis:?}, found {} m",
            number(period),
            number(extent)
        );
        let help = "make the domain as long as the body, or the body as long as the domain";
        return (extent > period + 0.9 * body.spacing).then(|| Problem::at_path(at, message).help(help));
    }
    let outside = places.filter(|x| !(min..=max).contains(x)).count();
    let message = format!(
        "body `{name}` must start inside the domain, found {} of {} outside: it extends from {} m to {} m along {axis:?}, the domain from \
         {} m to {} m",
        digits(outside as u64),
        count(body.sites.len() as u64, "particle"),
        number(lowest),
        number(highest),
        number(min),
        number(max)
    );
    (outside > 0).then(|| Problem::at_path(at, message).help("enlarge the domain, or make the body smaller"))
}
