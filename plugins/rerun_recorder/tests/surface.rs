//! Surfaces of bodies as meshes.

use std::collections::BTreeMap;

use meshless_engine::record::{BodyFrame, BodyInfo, Existing, Frame, Recorder, RunInfo};
use meshless_engine::scene::Dimension;
use rerun_recorder::{RerunFile, RerunRecorder, SurfaceError, SurfaceMesh, surface_of};

/// A ball of radius 0.5 about (1, 2, 3) on a lattice, red growing from left to right.
fn ball(spacing: f32) -> SurfaceMesh {
    let cells = (0.5 / spacing).ceil() as i32;
    let (mut positions, mut colors) = (Vec::new(), Vec::new());
    for k in 0..(2 * cells).pow(3) {
        let place = [k % (2 * cells), k / (2 * cells) % (2 * cells), k / (4 * cells * cells)]
            .map(|index| (index - cells) as f32 * spacing + 0.5 * spacing);
        if place.iter().map(|x| x * x).sum::<f32>() < 0.25 {
            positions.push([1.0 + place[0], 2.0 + place[1], 3.0 + place[2]]);
            colors.push([(100.0 + 150.0 * place[0]) as u8, 20, 30]);
        }
    }
    surface_of(&positions, 0.5 * spacing, &colors).expect("a surface")
}

fn corners(mesh: &SurfaceMesh, triangle: [u32; 3]) -> [[f64; 3]; 3] {
    triangle.map(|k| mesh.positions[k as usize].map(f64::from))
}

/// Volume within the mesh, by the divergence theorem: positive where triangles are anticlockwise seen from
/// outside.
fn volume(mesh: &SurfaceMesh) -> f64 {
    let of = |triangle: &[u32; 3]| {
        let [a, b, c] = corners(mesh, *triangle).map(|[x, y, z]| [x - 1.0, y - 2.0, z - 3.0]);
        let cross = [b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0]];
        (a[0] * cross[0] + a[1] * cross[1] + a[2] * cross[2]) / 6.0
    };
    mesh.triangles.iter().map(of).sum()
}

#[test]
fn a_ball_has_a_closed_surface_near_its_own() {
    let exact = std::f64::consts::PI / 6.0;
    let errors = [0.1, 0.05, 0.025].map(|spacing| {
        let mesh = ball(spacing);
        let mut sides = BTreeMap::new();
        for [a, b, c] in &mesh.triangles {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                *sides.entry((from.min(to), from.max(to))).or_insert(0) += if from < to { 1 } else { -1 };
            }
        }
        assert!(sides.values().all(|&sum| sum == 0), "the mesh is open");
        let radii = mesh
            .positions
            .iter()
            .map(|[x, y, z]| ((x - 1.0).powi(2) + (y - 2.0).powi(2) + (z - 3.0).powi(2)).sqrt());
        assert!(radii.into_iter().all(|radius| (radius - 0.5).abs() < spacing), "a vertex is off");
        for (place, normal) in mesh.positions.iter().zip(&mesh.normals) {
            let arm = [place[0] - 1.0, place[1] - 2.0, place[2] - 3.0];
            let along: f32 = arm.iter().zip(normal).map(|(x, n)| x * n).sum();
            assert!(along > 0.4, "a normal points aside");
        }
        (volume(&mesh) / exact - 1.0).abs()
    });
    assert!(errors[2] < errors[0] && errors[2] < 0.1, "{errors:?}");
}

#[test]
fn colors_are_those_of_the_particles_around() {
    let mesh = ball(0.05);
    for (place, color) in mesh.positions.iter().zip(&mesh.colors) {
        let expected = 100.0 + 150.0 * (place[0] - 1.0);
        // Means of one side lag behind by up to a spacing, and bytes are cut.
        assert!((f32::from(color[0]) - expected).abs() < 150.0 * 0.05 + 1.0, "{color:?} {expected}");
        assert_eq!(color[1..], [20, 30]);
    }
}

#[test]
fn meshes_are_written_for_other_programs() {
    let mesh = ball(0.1);
    let mut obj = Vec::new();
    mesh.write_obj(&mut obj).expect("memory");
    let text = String::from_utf8(obj).expect("text");
    let lines = |start: &str| text.lines().filter(|line| line.starts_with(start)).count();
    assert_eq!(
        [lines("v "), lines("vn "), lines("f ")],
        [mesh.positions.len(), mesh.normals.len(), mesh.triangles.len()]
    );
    let mut vtp = Vec::new();
    mesh.write_vtp(&mut vtp).expect("memory");
    let text = String::from_utf8(vtp).expect("text");
    let numbers = 3 * 3 * mesh.positions.len() + 4 * mesh.triangles.len();
    let found: usize =
        text.lines().filter(|line| !line.starts_with('<')).map(|line| line.split(' ').count()).sum();
    assert_eq!(found, numbers);
}

#[test]
fn what_has_no_surface_is_told() {
    let plane = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]];
    assert!(matches!(surface_of(&plane, 0.5, &[[0; 3]]), Err(SurfaceError::Plane)));
    assert!(surface_of(&[], 0.5, &[]).expect("nothing").triangles.is_empty());
    let scattered = [[0.0, 0.0, 1.0], [f32::NAN, 0.0, 0.0], [9.0, 0.0, 2.0]];
    assert!(surface_of(&scattered, 0.5, &[[9; 3]]).is_ok());
}

#[test]
fn what_is_left_of_a_body_may_lie_in_a_plane() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let settings = RerunRecorder { surfaces: vec!["drop".to_owned()], ..RerunRecorder::default() };
    let mut recorder = RerunFile::new(settings, Vec::new(), Vec::new(), [0.0, 0.0, 1.0]);
    let run = RunInfo {
        title: "",
        scene_name: "drop",
        scene_text: "",
        dimension: Dimension::Three,
        bodies: &[BodyInfo { name: "drop", radius: 0.5, particles: 2 }],
        fields: &[],
        series: &[],
        references: &[],
        output: folder.path(),
        existing: Existing::Refuse,
        resumed: false,
        start_time: 0.0,
        end_time: 1.0,
    };
    recorder.start(&run).expect("a file");
    for (step, positions) in
        [&[[0.0, 0.0, 0.5], [1.0, 0.0, 0.5]][..], &[[1.0, 0.0, 0.0]], &[]].iter().enumerate()
    {
        let body = BodyFrame { name: "drop", positions, radius: 0.5, fields: &[] };
        let frame = Frame { step: step as u64, time: step as f64, bodies: &[body] };
        recorder.frame(&frame).expect("a frame, with a surface or without");
    }
    recorder.finish(&[]).expect("a recording");
}
