//! Damaged meshes and particle files: any content must give a result or an error. `PROPTEST_CASES` sets the
//! number of cases.

use proptest::prelude::*;

use crate::scene::Dimension::{Three, Two};
use crate::shapes::{Filling, Lattice, Shape, fill};

const POINTS: &str =
    "x[m],y[m],volume[m^2],color\n# two\n0,0,0.01,red\n0.1,0,0.01,blue\n\"0.2\",1e-1,0.01,green\n";

const TETRAHEDRON: &str = "solid t
facet normal 0 0 -1\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 1 0 0\nendloop\nendfacet
facet normal 0 -1 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0 1\nendloop\nendfacet
facet normal -1 0 0\nouter loop\nvertex 0 0 0\nvertex 0 0 1\nvertex 0 1 0\nendloop\nendfacet
facet normal 1 1 1\nouter loop\nvertex 1 0 0\nvertex 0 1 0\nvertex 0 0 1\nendloop\nendfacet
endsolid t\n";

const OBJ: &str =
    "# t\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1//1 4//2 3//3\nf 2/1 3/2 4/3\n";

/// The same solid in the binary form of STL.
fn binary() -> Vec<u8> {
    let corners = [[0.0f32; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let mut bytes = vec![b' '; 80];
    bytes.extend(4u32.to_le_bytes());
    for face in [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]] {
        bytes.extend([0; 12]);
        face.iter().flat_map(|&k: &usize| corners[k]).for_each(|x| bytes.extend(x.to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

/// Fills a body from a file with this content; an error is a valid result.
fn survives(name: &str, content: &[u8]) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::write(folder.path().join(name), content).expect("a file");
    let (shape, dimension) = match name {
        "p.csv" => (Shape::Points { file: name.into() }, Two),
        _ => (super::shape(&format!("Mesh(file: \"{name}\", scale: 1.0)")), Three),
    };
    let _ = fill(
        &shape,
        Filling {
            lattice: Lattice::Regular,
            spacing: 0.1,
            dimension,
            folder: folder.path(),
            limit: 10_000,
            is_wall: false,
        },
    );
}

const PIECES: [&str; 12] =
    ["", "-", "1e308", "NaN", "inf", "\u{0}", ",", "\n", "0", "\u{feff}", "99999999999999999999", "\"é"];

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: cases(), ..ProptestConfig::default() })]

    #[test]
    fn damaged_files(
        which in 0usize..4,
        cuts in prop::collection::vec((0.0..1.0f64, 0usize..12, 0usize..PIECES.len()), 1..6),
    ) {
        let binary = binary();
        let (name, content) = [
            ("p.csv", POINTS.as_bytes()),
            ("t.stl", TETRAHEDRON.as_bytes()),
            ("t.obj", OBJ.as_bytes()),
            ("b.stl", binary.as_slice()),
        ][which];
        let mut bytes = content.to_vec();
        for (place, length, piece) in cuts {
            let start = (place * bytes.len() as f64) as usize;
            let end = (start + length).min(bytes.len());
            bytes.splice(start..end, PIECES[piece].bytes());
        }
        survives(name, &bytes);
    }

    #[test]
    fn flipped_bits(which in 0usize..2, places in prop::collection::vec((0.0..1.0f64, 0u32..8), 1..8)) {
        let (name, mut bytes) = [("b.stl", binary()), ("t.obj", OBJ.as_bytes().to_vec())][which].clone();
        for (place, bit) in places {
            let at = (place * bytes.len() as f64) as usize;
            bytes[at] ^= 1 << bit;
        }
        survives(name, &bytes);
    }
}

#[test]
fn particles_at_the_ends_of_numbers() {
    for place in ["1e308", "-1e308"] {
        survives("p.csv", POINTS.replace("0.1,0,", &format!("{place},{place},")).as_bytes());
    }
}

/// Few cases in continuous integration, more by `PROPTEST_CASES`.
fn cases() -> u32 {
    std::env::var("PROPTEST_CASES").ok().and_then(|cases| cases.parse().ok()).unwrap_or(64)
}

#[test]
fn the_files_are_good_before_they_are_damaged() {
    let folder = tempfile::tempdir().unwrap();
    for (name, content) in
        [("t.stl", TETRAHEDRON.as_bytes()), ("t.obj", OBJ.as_bytes()), ("b.stl", &binary())]
    {
        std::fs::write(folder.path().join(name), content).unwrap();
        let shape = super::shape(&format!("Mesh(file: \"{name}\", scale: 1.0)"));
        let filled = fill(
            &shape,
            Filling {
                lattice: Lattice::Regular,
                spacing: 0.1,
                dimension: Three,
                folder: folder.path(),
                limit: 10_000,
                is_wall: false,
            },
        );
        assert!(filled.is_ok_and(|sites| !sites.is_empty()), "{name}");
    }
    std::fs::write(folder.path().join("p.csv"), POINTS).unwrap();
    let shape = Shape::Points { file: "p.csv".into() };
    assert_eq!(
        fill(
            &shape,
            Filling {
                lattice: Lattice::Regular,
                spacing: 0.1,
                dimension: Two,
                folder: folder.path(),
                limit: 10,
                is_wall: false
            }
        )
        .unwrap()
        .len(),
        3
    );
}
