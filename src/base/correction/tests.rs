//! Case K1: corrected gradients are exact for linear fields; singular neighbourhoods are rejected.

use super::MomentMatrix;
use crate::kernels::{Kernel, KernelName};
use crate::linalg::{Eigen, Sym3};
use crate::neighbors::{Cloud, NeighborList, Periodic};
use glam::{DMat3, DVec3};

fn moment_matrix(dimension: usize, neighbors: impl IntoIterator<Item = (f64, DVec3)>) -> MomentMatrix {
    let mut moment = MomentMatrix::new(dimension);
    neighbors.into_iter().for_each(|(volume_weight, x_ij)| moment.add(volume_weight, x_ij));
    moment
}

/// Correction matrix of a given moment matrix, which is the sum over one neighbour along each eigenvector.
fn correction_matrix(moment: &Sym3, dimension: usize) -> Option<Sym3> {
    let eigen = Eigen::new(moment);
    let axes = [eigen.vectors.x_axis, eigen.vectors.y_axis, eigen.vectors.z_axis];
    moment_matrix(dimension, eigen.values.to_array().into_iter().zip(axes)).inverse()
}

/// Particles of a lattice of spacing one, perturbed by up to 0.4, with volumes that vary by 30 %.
fn disordered(dimension: usize) -> (Vec<DVec3>, Vec<f64>) {
    let n = [40_usize, 14, 8][dimension - 1];
    let mut state = 11_u64;
    let mut random = move || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let count = n.pow(dimension as u32);
    let positions = (0..count).map(|k| {
        let mut x = DVec3::ZERO;
        for a in 0..dimension {
            x[a] = (k / n.pow(a as u32) % n) as f64 + 0.8 * random();
        }
        x
    });
    let positions: Vec<_> = positions.collect();
    let volumes = (0..count).map(|_| 1.0 + 0.6 * random()).collect();
    (positions, volumes)
}

#[test]
fn corrected_gradient_of_a_linear_field_is_exact() {
    let slope = DMat3::from_cols_array(&[0.3, -1.2, 0.7, 2.1, 0.4, -0.9, 1.1, -0.2, 0.5]);
    let constant = DVec3::new(3.0, -7.0, 1.0);
    for dimension in 1..=3 {
        let (positions, volumes) = disordered(dimension);
        let in_space =
            DMat3::from_diagonal(DVec3::from_array([0, 1, 2].map(|a| f64::from(u8::from(a < dimension)))));
        for &name in KernelName::ALL {
            let (kernel, support) = (Kernel::new(name, dimension).unwrap(), 3.2);
            let h = kernel.smoothing_length(support);
            let list = NeighborList::reference(Cloud::uniform(&positions, support), &Periodic::NONE).unwrap();
            for i in 0..list.rows() {
                let pair = |&j: &u32| {
                    let x_ij = positions[j as usize] - positions[i];
                    (volumes[j as usize] * kernel.pair_weight(x_ij.length(), h), x_ij)
                };
                let correction = moment_matrix(dimension, list.row(i).iter().map(pair)).inverse().unwrap();
                let mut gradient = DMat3::ZERO;
                for j in list.row(i) {
                    let (weight, x_ij) = pair(j);
                    let field = |x: DVec3| constant + slope * x;
                    let difference = field(positions[*j as usize]) - field(positions[i]);
                    let g_ij = correction * x_ij * weight;
                    gradient +=
                        DMat3::from_cols(difference * g_ij.x, difference * g_ij.y, difference * g_ij.z);
                }
                let error = (gradient - slope * in_space).abs_diff_eq(DMat3::ZERO, 1e-10);
                assert!(error, "{name} in {dimension} dimensions, particle {i}: {gradient}");
            }
        }
    }
}

#[test]
fn moment_matrix_of_a_full_neighbourhood_is_near_the_identity() {
    let lattice: Vec<DVec3> = (0..4913)
        .map(|k| DVec3::new((k % 17) as f64, (k / 17 % 17) as f64, (k / 289) as f64) - DVec3::splat(8.0))
        .collect();
    let kernel = Kernel::new(KernelName::WendlandC2, 3).unwrap();
    let near = lattice.iter().filter(|x| **x != DVec3::ZERO && x.length() < 6.0);
    let moment = moment_matrix(3, near.map(|x| (kernel.pair_weight(x.length(), 3.0), *x)));
    assert!((*moment.matrix() - Sym3::IDENTITY).norm() < 1e-2, "{moment:?}");
}

#[test]
fn inverse_of_a_known_matrix() {
    let m = Sym3 { xx: 2.0, yy: 3.0, zz: 4.0, xy: 1.0, xz: 0.0, yz: 1.0 };
    // By cofactors, det = 2 (12 - 1) - 4 = 18.
    let space = Sym3 { xx: 11.0, yy: 8.0, zz: 5.0, xy: -4.0, xz: 1.0, yz: -2.0 } * (1.0 / 18.0);
    let plane = Sym3 { xx: 3.0, yy: 2.0, xy: -1.0, ..Sym3::ZERO } * (1.0 / 5.0);
    let line = Sym3 { xx: 0.5, ..Sym3::ZERO };
    for (dimension, expected) in [(1, line), (2, plane), (3, space)] {
        let inverse = correction_matrix(&m, dimension).unwrap();
        assert!((inverse - expected).norm() < 1e-14, "{inverse:?}");
    }
}

#[test]
fn singular_neighbourhoods_are_refused() {
    let inverse = |points: &[DVec3], d| moment_matrix(d, points.iter().map(|x| (1.0, *x))).inverse();
    let line = [DVec3::new(1.0, 2.0, 0.5), DVec3::new(-2.0, -4.0, -1.0), DVec3::new(0.5, 1.0, 0.25)];
    let plane = [DVec3::X, DVec3::new(0.3, 0.0, 1.0), DVec3::new(-1.0, 0.0, 0.7), DVec3::Z];
    for points in [&[][..], &line[..1], &line] {
        assert_eq!(inverse(points, 2), None, "{points:?}");
        assert_eq!(inverse(points, 3), None, "{points:?}");
    }
    assert_eq!(inverse(&plane, 3), None);
    assert_eq!(inverse(&[], 1), None);
    assert_eq!(inverse(&[DVec3::X, DVec3::Y], 2), Some(Sym3::from_diagonal(DVec3::new(1.0, 1.0, 0.0))));
    assert_eq!(inverse(&[DVec3::X, DVec3::Y, DVec3::Z], 3), Some(Sym3::IDENTITY));
    for d in 1..=3 {
        for bad in [f64::NAN, f64::INFINITY] {
            assert_eq!(inverse(&[DVec3::X, DVec3::Y, DVec3::Z, DVec3::splat(bad)], d), None);
        }
    }
}

/// Neighbours of height a over the x axis: M = diag(1, a^2), so the limit is a^2 = 1e-6 ((1 + a^2) / 2)^2 at
/// every scale.
#[test]
fn the_limit_is_relative() {
    let limit = (1e-6_f64 / 4.0).sqrt();
    for scale in [1e-12, 1.0, 1e12] {
        for (height, accepted) in [(0.99 * limit, false), (1.01 * limit, true)] {
            let moment = moment_matrix(2, [(scale, DVec3::X), (scale, DVec3::Y * height)]);
            assert_eq!(moment.inverse().is_some(), accepted);
        }
    }
}
