//! Projection onto the faces of walls around a fluid particle.

use glam::{DMat3, DVec3};

use super::faces::FacesBefore;
use super::forces::WITHIN;
use crate::formulations::fluid::cloud::FlowCloud;

/// Moment of normals below which a direction counts as along the faces, over all moments: faces that are
/// round spread over less, those of a corner over more.
const SPREAD: f64 = 0.1;

/// Neighbourhood of a fluid particle.
#[derive(Default)]
struct Around {
    /// Gradient of the part of the kernel that walls fill, and of all of it that is filled, 1/m.
    wall: DVec3,
    all: DVec3,
    moments: DMat3,
}

impl FlowCloud {
    /// Projection of a motion of particle `i` onto walls, times the share that is lost to empty space, and
    /// the direction along them into the wall; none where this is zero. `faces` are those before it and the
    /// fluid particles around it.
    pub(super) fn along_walls(&self, i: usize, faces: &FacesBefore) -> Option<(DMat3, DVec3)> {
        let Around { wall, all, moments } = self.around(i, faces);
        let spread = SPREAD * (moments.x_axis.x + moments.y_axis.y + moments.z_axis.z);
        if spread == 0.0 {
            return None;
        }
        let square = DMat3::from_diagonal(DVec3::splat(spread * spread));
        let along = square * (moments * moments + square).inverse();
        let (wall, all) = (along * wall, along * all);
        let share = wall.dot(all) / wall.length_squared();
        (share > 0.0).then(|| (share.min(1.0) * along, wall.normalize_or_zero()))
    }

    fn around(&self, i: usize, faces: &FacesBefore) -> Around {
        let mut around = Around::default();
        self.for_each_end_wall(i, |w, x| {
            around.wall += self.records[w].volume() * self.kernel.weight(x.length()) * x;
        });
        let own = self.records[i].position();
        let mut add = |j: usize, distance: f64| {
            if let Some(face) = faces.of(j) {
                around.moments += self.kernel.value(distance) * *face;
            }
        };
        add(i, 0.0);
        for &j in self.near_row(i) {
            let j = j as usize;
            let x = self.offset(own, self.records[j].position());
            let distance = x.length();
            if j != i && distance < WITHIN * self.kernel.support {
                add(j, distance);
                around.all += self.records[j].volume() * self.kernel.weight(distance) * x;
            }
        }
        around
    }
}
