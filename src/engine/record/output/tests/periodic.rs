//! Particles that have crossed a periodic boundary are shown inside the domain.

use super::*;
use crate::record::read_series;
use crate::world::{BodyId, Position};

/// The points of a `.vtu` file.
fn points(path: &Path) -> Vec<[f64; 3]> {
    let bytes = fs::read(path).unwrap();
    let mark = b"encoding=\"raw\">\n_";
    let start = bytes.windows(mark.len()).position(|bytes| bytes == mark).unwrap() + mark.len();
    let head = String::from_utf8_lossy(&bytes[..start]).into_owned();
    let after = head.split("Name=\"Points\"").nth(1).unwrap().split("offset=\"").nth(1).unwrap();
    let offset: usize = after.split('"').next().unwrap().parse().unwrap();
    let data = &bytes[start + offset..];
    let (length, data) = data.split_first_chunk::<8>().unwrap();
    data[..u64::from_le_bytes(*length) as usize].chunks_exact(24).map(bytemuck::pod_read_unaligned).collect()
}

#[test]
fn particles_are_shown_inside_of_a_periodic_domain() {
    let folder = tempfile::tempdir().unwrap();
    let text = r#"(dimension: Two, domain: (min: (0.2, -1), max: (1.2, 1), periodic: [X]),
        materials: {"fluid": Fluid(density: 1.0, sound_speed: 10.0)},
        bodies: [(name: "fluid", material: "fluid", shape: Box(min: (0.2, 0), max: (1.2, 0.5)), spacing: 0.05, formulation: Fluid,
                  velocity: (1.0, 0.0))],
        time: (end: 1.5),
        probes: [Probe(name: "speed", at: (0.7, 0.25), quantity: Velocity)],
        record: (every: 1.5, fields: ["speed"], vtk: true))"#;
    let scene = parse(Source::new("flow.ron", text)).unwrap_or_else(|error| panic!("{error}"));
    let sim = run(built(&scene, folder.path()));
    let (view, rows) = sim.world().body_view(BodyId(0));
    let x = view.read::<Position>().unwrap();
    assert!(x[rows].iter().all(|x| x.0.x > 1.6), "all have moved by one and a half periods");
    let shown = points(&folder.path().join("flow_fluid_000001.vtu"));
    assert_eq!(shown.len(), x.len());
    for (shown, x) in shown.iter().zip(x.iter()) {
        assert!((0.2..1.2).contains(&shown[0]), "{shown:?}");
        let turns = x.0.x - shown[0];
        assert!((turns - turns.round()).abs() < 1e-12 && shown[1] == x.0.y, "{shown:?} {x:?}");
    }
    let speed = read_series(&folder.path().join("speed.csv")).unwrap();
    assert!((speed.numbers("x").unwrap().last().unwrap() - 1.0).abs() < 1e-9);
}
