//! Particle files.

use std::path::Path;

use glam::DVec3;

use crate::scene::Dimension::{self, Three, Two};
use crate::shapes::{FillError, Filling, Lattice, Shape, Site, fill};

fn read(content: &str, dimension: Dimension) -> Result<Vec<Site>, FillError> {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("cloud.csv"), content).unwrap();
    fill(
        &Shape::Points { file: "cloud.csv".into() },
        Filling {
            lattice: Lattice::Regular,
            spacing: 1.0,
            dimension,
            folder: folder.path(),
            limit: 5,
            is_wall: false,
        },
    )
}

#[test]
fn columns_by_name() {
    let sites =
        read("# a cloud\nvolume[m^3], y[m], z, x, color\n0.5, 2, 3, 1, red\n0.25,0,0,-1,blue\n", Three)
            .unwrap();
    assert_eq!(
        sites,
        [
            Site { position: DVec3::new(-1.0, 0.0, 0.0), volume: 0.25 },
            Site { position: DVec3::new(1.0, 2.0, 3.0), volume: 0.5 }
        ]
    );
    assert_eq!(read("x,y,volume\n1,2,3\n", Two).unwrap()[0].position, DVec3::new(1.0, 2.0, 0.0));
}

#[test]
fn mistakes_are_shown_with_their_line() {
    for (content, dimension, message) in [
        ("x,y\n1,2\n", Two, "line 1: the header must have a column `volume`, found `x,y`"),
        ("x,y,volume\n1,2,3\n", Three, "line 1: the header must have a column `z`, found `x,y,volume`"),
        (
            "root:$6$salt:99\n1\n",
            Two,
            "line 1: the header must have a column `x`, found a line that is no header",
        ),
        ("\n# nothing\n", Two, "line 1: the file is empty, expected a header `x,y,volume`"),
        ("x,y,volume\n", Two, "line 1: the file has no particle"),
        ("x,y,volume\n1,2,3\n1,two,3\n", Two, "line 3: expected a number for `y`, found `two`"),
        ("x,y,volume\n1,2,3\n\n1,NaN,3\n", Two, "line 4: expected a number for `y`, found `NaN`"),
        ("x,y,volume\n1,2,0\n", Two, "line 2: the volume must be greater than 0, found 0"),
        ("x,y,z,volume\n1,2,1,1\n", Two, "line 2: z must be 0 in two dimensions, found 1"),
        (
            "x;y;volume\n1;2;3\n",
            Two,
            "line 1: the values of a line must be separated by `,`, found `;`; decimals are written with a point",
        ),
        ("x,y,volume\n1,2,3\n1,2\n", Two, "line 3: expected 3 values as in the header, found 2"),
    ] {
        let error = read(content, dimension).unwrap_err();
        assert_eq!(error.path, "shape.file");
        assert!(error.to_string().ends_with(&format!("cloud.csv`, {message}")), "{error}");
    }
    let error = read("x,y,volume\n1,1,1\n2,1,1\n3,1,1\n4,1,1\n5,1,1\n6,1,1\n", Two).unwrap_err();
    assert!(error.to_string().contains("more than the 5 that fit into memory"), "{error}");
}

#[test]
fn missing_file() {
    let shape = Shape::Points { file: "missing.csv".into() };
    let error = fill(
        &shape,
        Filling {
            lattice: Lattice::Regular,
            spacing: 0.1,
            dimension: Two,
            folder: Path::new("nowhere"),
            limit: 5,
            is_wall: false,
        },
    )
    .unwrap_err();
    assert_eq!(error.path, "shape.file");
    assert!(error.to_string().starts_with("shape.file: cannot read `nowhere/missing.csv`: "), "{error}");
}

#[test]
fn transforms_apply() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("cloud.csv"), "x,y,volume\n1,0,2\n").unwrap();
    let text = "Translate(shape: Rotate(shape: Scale(shape: Points(file: \"cloud.csv\"), by: (2, 3)), angle_degrees: 90), by: (5, 0))";
    let sites = fill(
        &super::shape(text),
        Filling {
            lattice: Lattice::Regular,
            spacing: 1.0,
            dimension: Two,
            folder: folder.path(),
            limit: 5,
            is_wall: false,
        },
    )
    .unwrap();
    assert!(sites[0].position.distance(DVec3::new(5.0, 2.0, 0.0)) < 1e-12);
    assert!((sites[0].volume - 12.0).abs() < 1e-12);
}

#[test]
fn a_mark_at_the_start_of_the_file_is_passed_over() {
    assert_eq!(read("\u{feff}x,y,volume\n1,2,3\n", Two).unwrap().len(), 1);
}

#[test]
fn particles_that_are_there_twice_are_refused() {
    for second in ["1,2,1", "1.0000001,2,1", "0.995,2,1"] {
        let error = read(&format!("x,y,volume\n0,2,1\n1,2,1\n{second}\n"), Two).unwrap_err();
        assert!(error.to_string().contains("must not be at one place, found particles 2 and 3"), "{error}");
    }
    assert_eq!(read("x,y,volume\n1,2,1\n1.1,2,1\n", Two).unwrap().len(), 2);
}

#[test]
fn volumes_of_another_unit_are_refused() {
    let error = read("x,y,volume\n1,2,1e4\n", Two).unwrap_err();
    assert!(error.to_string().contains("must be near spacing^2 = 1, found 10000"), "{error}");
    assert!(read("x,y,volume\n1,2,1e-3\n", Two).is_err());
}
