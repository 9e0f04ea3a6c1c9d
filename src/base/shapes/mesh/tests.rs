//! Meshes of known solids: volumes in closed form, distances by a naive second implementation, defects.

use std::f64::consts::{PI, TAU};
use std::path::Path;

use glam::{DQuat, DVec3};
use proptest::prelude::*;

use super::solid::MeshSolid;
use super::{obj, stl};
use crate::scene::Dimension::{Three, Two};
use crate::shapes::error::FillErrorKind;
use crate::shapes::mesh_fault::MeshFault;
use crate::shapes::region::Region;
use crate::shapes::surface::Surface;
use crate::shapes::{Filling, Lattice, Shape, fill};

mod moments;

type Soup = Vec<[DVec3; 3]>;

/// The triangles of a grid of points that is periodic in both directions.
fn closed_grid(n: usize, m: usize, point: impl Fn(usize, usize) -> DVec3) -> Soup {
    let quad = |i: usize, j: usize| {
        let at = |i: usize, j: usize| point(i % n, j % m);
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [[a, b, c], [a, c, d]]
    };
    (0..n).flat_map(|i| (0..m).flat_map(move |j| quad(i, j))).collect()
}

fn torus(n: usize, m: usize, radius: f64, thickness: f64) -> Soup {
    closed_grid(n, m, |i, j| {
        let (u, v) = (TAU * i as f64 / n as f64, TAU * j as f64 / m as f64);
        let r = radius + thickness * v.cos();
        DVec3::new(r * u.cos(), r * u.sin(), thickness * v.sin())
    })
}

/// A sphere of n by m quadrilaterals; those at the poles have two equal corners.
fn ball(n: usize, m: usize) -> Soup {
    let quad = |i: usize, j: usize| {
        let at = |i: usize, j: usize| {
            let (u, v) = (TAU * (i % n) as f64 / n as f64, PI * j as f64 / m as f64);
            // The poles exactly, so that their corners are one point.
            let r = if j == 0 || j == m { 0.0 } else { v.sin() };
            DVec3::new(r * u.cos(), r * u.sin(), -v.cos())
        };
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [[a, b, c], [a, c, d]]
    };
    (0..n).flat_map(|i| (0..m).flat_map(move |j| quad(i, j))).collect()
}

fn cube(min: DVec3, max: DVec3) -> Soup {
    let corner = |n: usize| {
        let pick = |k: usize| if n >> k & 1 == 0 { min[k] } else { max[k] };
        DVec3::new(pick(0), pick(1), pick(2))
    };
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    faces.iter().flat_map(|f| [[f[0], f[1], f[2]], [f[0], f[2], f[3]]]).map(|t| t.map(corner)).collect()
}

fn solid(triangles: &Soup) -> MeshSolid {
    MeshSolid::new(triangles).unwrap()
}

#[test]
fn volumes_are_those_of_the_polyhedra() {
    assert!(
        (solid(&cube(DVec3::splat(1e3), DVec3::new(1002.0, 1003.0, 1005.0))).volume().unwrap() - 30.0).abs()
            < 1e-9
    );
    // A regular polygon of m corners swept along a regular polygon of n: Pappus's theorem with sines in the
    // place of arcs.
    let (n, m) = (24, 16);
    let section = 0.5 * m as f64 * 0.09 * (TAU / m as f64).sin();
    let expected = n as f64 * (TAU / n as f64).sin() * section;
    assert!((solid(&torus(n, m, 1.0, 0.3)).volume().unwrap() / expected - 1.0).abs() < 1e-13);
    // The volume is that of the sphere to second order in the size of the triangles.
    let error = |n: usize| 1.0 - solid(&ball(2 * n, n)).volume().unwrap() / (4.0 / 3.0 * PI);
    assert!((error(20) / error(40) - 4.0).abs() < 0.05, "{} {}", error(20), error(40));
    // An inward orientation is reversed.
    let inward: Soup = torus(n, m, 1.0, 0.3).into_iter().map(|[a, b, c]| [a, c, b]).collect();
    let turned = solid(&inward);
    assert!((turned.volume().unwrap() / expected - 1.0).abs() < 1e-13 && turned.distance(DVec3::X) < 0.0);
}

/// Distance to a triangle from its plane and edges, in a naive implementation.
fn naive_distance(p: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let segment = |a: DVec3, b: DVec3| {
        let t = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        p.distance(a + t * (b - a))
    };
    let edges = segment(a, b).min(segment(b, c)).min(segment(c, a));
    let n = (b - a).cross(c - a);
    let within = [(a, b), (b, c), (c, a)].iter().all(|&(u, v)| (v - u).cross(p - u).dot(n) >= 0.0);
    if within { edges.min((p - a).dot(n).abs() / n.length()) } else { edges }
}

/// Winding number of the surface about a point, the sum of solid angles over 4 pi.
/// Van Oosterom and Strackee, IEEE Transactions on Biomedical Engineering 30 (1983), 125-126.
fn winding(p: DVec3, triangles: &Soup) -> f64 {
    let angle = |t: &[DVec3; 3]| {
        let [a, b, c] = t.map(|corner| corner - p);
        let (x, y, z) = (a.length(), b.length(), c.length());
        let below = x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y;
        2.0 * a.dot(b.cross(c)).atan2(below)
    };
    triangles.iter().map(angle).sum::<f64>() / (4.0 * PI)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]
    #[test]
    fn distances_are_those_of_all_triangles(p in [-1.5..1.5, -1.5..1.5, -1.5..1.5]) {
        let turn = DQuat::from_rotation_x(0.3) * DQuat::from_rotation_z(0.7);
        let turned: Soup = cube(DVec3::new(-1.0, -0.2, -0.5), DVec3::splat(0.6)).iter().map(|t| t.map(|c| turn * c)).collect();
        for triangles in [torus(12, 8, 1.0, 0.3), ball(10, 6), turned] {
            let mesh = solid(&triangles);
            let p = DVec3::from_array(p);
            let found = mesh.closest(p);
            let least = triangles.iter().map(|&t| naive_distance(p, t)).filter(|d| d.is_finite()).fold(f64::INFINITY, f64::min);
            let inside = winding(p, &triangles).abs() > 0.5;
            prop_assert!((found.signed_distance - if inside { -least } else { least }).abs() < 1e-12, "{:?} {}", found, least);
            prop_assert!((found.point + found.signed_distance * found.normal).distance(p) < 1e-9);
        }
    }
}

#[test]
fn nearest_points_at_edges_and_corners_of_a_cube() {
    // The diagonals of the faces are edges of the mesh and must have no effect.
    let mesh = solid(&cube(DVec3::splat(-1.0), DVec3::ONE));
    let text = "Box(min: (-1, -1, -1), max: (1, 1, 1))";
    let block = ron::from_str::<Shape>(text).unwrap().surface(Three, Path::new(""), "").unwrap();
    for p in [
        [0.0, 0.0, 1.5],
        [0.3, 0.3, 0.8],
        [2.0, 2.0, 0.1],
        [1.0, 1.0, 0.4],
        [1.5, -2.0, 3.0],
        [1.0, 1.0, 1.0],
        [-1.0, 1.0, -1.0],
        [0.25, 0.25, 1.0],
        [-0.9, 0.1, 0.1],
    ] {
        let (found, expected) = (mesh.closest(p.into()), block.closest(p.into()));
        assert!(
            (found.signed_distance - expected.signed_distance).abs() < 1e-14,
            "{p:?} {found:?} {expected:?}"
        );
        assert!(found.point.distance(expected.point) < 1e-14, "{p:?} {found:?} {expected:?}");
        assert!(found.normal.distance(expected.normal) < 1e-12, "{p:?} {found:?} {expected:?}");
    }
}

#[test]
fn the_sign_holds_at_a_sharp_edge() {
    // A wedge of one degree: in front of the edge the nearest point belongs to two faces with opposite
    // normals.
    let s = 0.5f64.to_radians().sin();
    let (tip, tail) = ([DVec3::ZERO, DVec3::Z], [DVec3::new(1.0, s, 0.0), DVec3::new(1.0, -s, 0.0)]);
    let lift = |p: DVec3| p + DVec3::Z;
    let [a, b] = tail;
    let wedge = vec![
        [tip[0], a, b],
        [tip[1], lift(b), lift(a)],
        [tip[0], tip[1], lift(a)],
        [tip[0], lift(a), a],
        [tip[0], b, lift(b)],
        [tip[0], lift(b), tip[1]],
        [a, lift(a), lift(b)],
        [a, lift(b), b],
    ];
    let mesh = solid(&wedge);
    for y in [-0.3, -1e-4, 0.0, 1e-4, 0.3] {
        let p = DVec3::new(-0.1, y, 0.4);
        assert!((mesh.distance(p) - (0.1f64).hypot(y)).abs() < 1e-14, "{y}");
    }
    assert!(mesh.distance(DVec3::new(0.5, 0.0, 0.4)) < 0.0);
}

fn binary_stl(triangles: &Soup) -> Vec<u8> {
    let mut bytes = b"solid although this is binary".to_vec();
    bytes.resize(80, b' ');
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for triangle in triangles {
        bytes.extend([0; 12]);
        for value in triangle.iter().flat_map(|corner| corner.to_array()) {
            bytes.extend((value as f32).to_le_bytes());
        }
        bytes.extend([0; 2]);
    }
    bytes
}

#[test]
fn files_of_all_kinds_hold_the_same() {
    let triangles = cube(DVec3::ZERO, DVec3::new(1.0, 2.0, 0.5));
    assert_eq!(stl::read(&binary_stl(&triangles)).unwrap(), triangles);
    let facet = |t: &[DVec3; 3]| {
        let corners = t.map(|c| format!("      vertex {} {:e} {}\n", c.x, c.y, c.z)).concat();
        format!("  facet normal 0 0 0\n    outer loop\n{corners}    endloop\n  endfacet\n")
    };
    let text = format!("solid a cube\n{}endsolid a cube\n", triangles.iter().map(facet).collect::<String>());
    assert_eq!(stl::read(text.as_bytes()).unwrap(), triangles);
    let quads = "# a cube\nv 0 0 0\nv 1 0 0 1.0\nv 0 2 0\nv 1 2 0\nv 0 0 .5\nv 1 0 .5\nv 0 2 .5\nv 1 2 .5\nvn 0 0 1\no part\n\
        f 1 3 4 2\nf 5//1 6//1 8//1 7//1\nf 1/1 2/2 6/3 5/4\nf 3 7 8 4\nf -8 -4 -2 -6\nf 2 4 8 6\n";
    assert_eq!(obj::read(quads).unwrap(), triangles);
}

#[test]
fn files_that_are_wrong_say_where() {
    let line = |fault: MeshFault| match fault {
        MeshFault::Line { line, message } => (line, message),
        other => panic!("{other}"),
    };
    assert_eq!(
        line(obj::read("v 0 0 0\nv 1 x 0\n").unwrap_err()),
        (2, "expected a number, found `x`".into())
    );
    assert_eq!(line(obj::read("v 0 0\n").unwrap_err()).1, "expected 3 coordinates, found 2");
    assert_eq!(
        line(obj::read("v 0 0 0\nf 1 2 3\n").unwrap_err()),
        (2, "the face names corner `2`, there are 1 so far".into())
    );
    assert_eq!(
        line(obj::read("v 0 0 0\nf 1 1\n").unwrap_err()).1,
        "expected a face of at least 3 corners, found 2"
    );
    assert_eq!(
        line(stl::read(b"solid\nvertex 0 0 0\nendfacet\n").unwrap_err()),
        (3, "expected a facet of 3 corners, found 1".into())
    );
    assert_eq!(line(stl::read(b"solid\nbox\n").unwrap_err()).0, 2);
    let mut cut = binary_stl(&cube(DVec3::ZERO, DVec3::ONE));
    cut.pop();
    assert!(matches!(
        stl::read(&cut),
        Err(MeshFault::Line { .. } | MeshFault::NotStl { size: 683, expected: 684 })
    ));
    assert!(matches!(stl::read(b"PK\x03\x04"), Err(MeshFault::NotStl { size: 4, .. })));
}

#[test]
fn what_is_no_solid_is_refused() {
    let whole = cube(DVec3::ZERO, DVec3::ONE);
    let fault = |triangles: Soup| MeshSolid::new(&triangles).err().unwrap();
    assert!(matches!(fault(Vec::new()), MeshFault::NoTriangle));
    assert!(matches!(fault(whole[1..].to_vec()), MeshFault::Open { edges: 3, .. }));
    let mut turned = whole.clone();
    turned[3].swap(0, 1);
    assert!(matches!(fault(turned), MeshFault::Orientation { edges: 3, .. }));
    let mut infinite = whole.clone();
    infinite[4][2].x = f64::INFINITY;
    assert!(matches!(fault(infinite), MeshFault::NotFinite(4)));
    // A two-sided sheet, two cubes that share an edge, two intersecting cubes.
    let [a, b, c] = whole[0];
    assert!(matches!(fault(vec![[a, b, c], [a, c, b]]), MeshFault::NoVolume));
    let with = |min: DVec3, max: DVec3| [whole.clone(), cube(min, max)].concat();
    assert!(matches!(
        fault(with(DVec3::new(1.0, 1.0, 0.0), DVec3::new(2.0, 2.0, 1.0))),
        MeshFault::Crowded { edges: 1, .. }
    ));
    let MeshFault::Crossing { pairs, at } = fault(with(DVec3::splat(0.5), DVec3::splat(1.5))) else {
        panic!()
    };
    assert!(pairs > 0 && at.cmpge(DVec3::splat(0.3)).all());
    // A nested surface is a solid with a cavity.
    let hollow: Soup =
        cube(DVec3::splat(0.25), DVec3::splat(0.75)).into_iter().map(|[a, b, c]| [a, c, b]).collect();
    let mesh = solid(&[whole.clone(), hollow].concat());
    assert!((mesh.volume().unwrap() - 0.875).abs() < 1e-15);
    assert_eq!((mesh.distance(DVec3::splat(0.5)), mesh.distance(DVec3::new(0.5, 0.5, 0.1))), (0.25, -0.1));
}

#[test]
fn particles_fill_the_volume_of_the_mesh() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("ring.STL"), binary_stl(&torus(48, 24, 40.0, 12.0))).unwrap();
    let shape: Shape = ron::from_str("Mesh(file: \"ring.STL\", scale: 0.001)").unwrap();
    let fill = |shape: &Shape, spacing| {
        fill(
            shape,
            Filling {
                lattice: Lattice::Regular,
                spacing,
                dimension: Three,
                folder: folder.path(),
                limit: 100_000,
                is_wall: false,
            },
        )
    };
    let sites = fill(&shape, 0.003).unwrap();
    let volume: f64 = sites.iter().map(|site| site.volume).sum();
    let polyhedron = solid(&torus(48, 24, 0.04, 0.012)).volume().unwrap();
    assert!((volume / polyhedron - 1.0).abs() < 1e-6, "{volume} {polyhedron}");
    // All centres are inside the torus itself; a particle counts as a cell.
    let inside = |p: DVec3| (p.truncate().length() - 0.04).hypot(p.z) < 0.012;
    assert!(sites.iter().all(|site| inside(site.position)));
    assert!((sites[0].volume / 0.003f64.powi(3) - 1.0).abs() < 0.05);
    // Metres in place of millimetres, a file that is not there, two dimensions.
    let metres: Shape = ron::from_str("Translate(shape: Mesh(file: \"ring.STL\"), by: (1, 0, 0))").unwrap();
    let error = fill(&metres, 0.003).unwrap_err();
    assert_eq!(error.path, "shape.shape");
    assert!(error.kind.help().unwrap().contains("`scale: 0.001` reads millimetres"), "{error}");
    assert!(matches!(fill(&shape, 0.1).unwrap_err().kind, FillErrorKind::MeshSize { .. }));
    let missing: Shape = ron::from_str("Mesh(file: \"no.stl\")").unwrap();
    assert_eq!(fill(&missing, 0.1).unwrap_err().path, "shape.file");
    assert!(matches!(
        shape.region(Two, folder.path(), "shape").err().unwrap().kind,
        FillErrorKind::WrongDimension { .. }
    ));
}
