//! The gear wheel of `assets/meshes/gear.stl`: how to make a closed mesh for a scene, and how to see that it
//! is one.
//!
//! `cargo run --release --example gear_mesh` compares the file with what is made here, `... gear_mesh
//! wheel.stl` writes another.

use std::f64::consts::TAU;
use std::path::Path;

use anyhow::{Result, ensure};
use meshless::prelude::*;
use meshless::shapes::Shape;

const TEETH: usize = 12;
/// Radius of the bore \[mm\].
const BORE: f64 = 6.0;
/// Radius at the foot of the teeth \[mm\].
const FOOT: f64 = 16.0;
/// Radius at the tip of the teeth \[mm\].
const TIP: f64 = 20.0;
/// Width of the wheel \[mm\].
const WIDTH: f64 = 8.0;
/// A tooth and the gap after it as points of the rim: where, as a part of the pitch, and at which radius
/// \[mm\].
const TOOTH: [(f64, f64); 6] =
    [(0.0, FOOT), (0.14, TIP), (0.26, TIP), (0.40, FOOT), (0.60, FOOT), (0.80, FOOT)];

/// A point of the section of the wheel at a point of the rim: the four corners, counter-clockwise from the
/// lower inner one \[mm\].
fn point(around: usize, corner: usize) -> [f64; 3] {
    let (tooth, part) = (around / TOOTH.len() % TEETH, around % TOOTH.len());
    let angle = TAU * (tooth as f64 + TOOTH[part].0) / TEETH as f64;
    let radius = if matches!(corner % 4, 1 | 2) { TOOTH[part].1 } else { BORE };
    let height = if matches!(corner % 4, 2 | 3) { WIDTH } else { 0.0 };
    [radius * angle.cos(), radius * angle.sin(), height]
}

/// The triangles: the section led round the axis, two for each side of it.
fn triangles() -> Vec<[[f64; 3]; 3]> {
    let quad = |around: usize, corner: usize| {
        let [a, b] = [point(around, corner), point(around, corner + 1)];
        let [d, c] = [point(around + 1, corner), point(around + 1, corner + 1)];
        [[a, d, c], [a, c, b]]
    };
    (0..TEETH * TOOTH.len()).flat_map(|around| (0..4).flat_map(move |corner| quad(around, corner))).collect()
}

/// A binary STL file: 80 bytes of title, the number of triangles, for each its normal (left zero) and
/// corners.
fn stl(triangles: &[[[f64; 3]; 3]]) -> Vec<u8> {
    let mut bytes = format!("{:80}", "gear wheel with 12 teeth, millimetres").into_bytes();
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for triangle in triangles {
        bytes.extend([0; 12]);
        bytes.extend(triangle.iter().flatten().flat_map(|&value| (value as f32).to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

fn main() -> Result<()> {
    let made = stl(&triangles());
    let asset = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/meshes/gear.stl");
    let file = match std::env::args().nth(1) {
        Some(path) => {
            std::fs::write(&path, &made)?;
            std::path::absolute(path)?
        }
        None => {
            ensure!(std::fs::read(&asset)? == made, "{} is another wheel", asset.display());
            asset
        }
    };
    let wheel = Shape::Mesh { file: file.display().to_string(), scale: 0.001 };
    let solid = wheel.region(Dimension::Three, Path::new(""), "shape")?;
    println!("{}: {:.4e} m3", file.display(), solid.volume().unwrap_or_default());
    Ok(())
}
