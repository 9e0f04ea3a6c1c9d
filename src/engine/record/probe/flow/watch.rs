//! Whether the wall or body that a gauge lies in has moved away from it, or one has come over it.
//!
//! A gauge without `follows` stays where it is. In front of the face of a sensor in a wall there is none of
//! the wall, or up to 3/8 of the kernel in the corner of a box, and behind it half of the kernel, or an
//! eighth at an edge in space. Once the wall has moved over the sensor it fills the half in front, and once
//! it has moved back there is none of it behind. Other bodies that come before a sensor leave its wall where
//! it is. Above the foot of a gauge for the level nothing is wet any longer once a wall has come over it,
//! which then fills its place.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

use glam::DVec3;

use super::nearest::nearest;
use crate::formulations::fluid::FlowCloud;
use crate::world::BodyId;

/// Part of the kernel in front of the face, of a half, beyond which the wall has moved over it.
const COVERED: f64 = 0.45;
/// Part behind the face, of a half, below which the wall is not there.
const BARE: f64 = 0.05;
/// Part of the kernel that walls fill at a foot inside of them: at one on a floor, or in the corner of a box,
/// it is up to 7/8.
const FILLED: f64 = 0.9;

/// What is known of the wall behind a gauge.
#[derive(Default)]
pub struct WallWatch {
    wall: OnceLock<BodyId>,
    has_left: AtomicBool,
    was_wet: AtomicBool,
}

impl WallWatch {
    /// Looks for the wall at a face in which a gauge was when this was first called there; `walls` are the
    /// rows of the cloud near it.
    pub fn look(&self, cloud: &FlowCloud, walls: &[usize], at: DVec3, normal: DVec3) {
        if self.has_left.load(Ordering::Relaxed) {
            return;
        }
        let body = match self.wall.get() {
            Some(&body) => body,
            None => {
                let nearest = nearest(cloud, walls, at);
                let Some(body) = nearest.and_then(|i| body_of(cloud, i)) else { return };
                body
            }
        };
        let (mut before, mut behind) = (0.0, 0.0);
        for &i in walls.iter().filter(|&&i| body_of(cloud, i) == Some(body)) {
            let record = &cloud.records()[i];
            let x = cloud.offset(at, record.position());
            let share = record.volume() * cloud.kernel.value(x.length());
            *(if x.dot(normal) > 0.0 { &mut before } else { &mut behind }) += share;
        }
        let is_there = before < COVERED && behind > BARE;
        if is_there {
            let _ = self.wall.set(body);
        } else if self.wall.get().is_some() {
            self.has_left.store(true, Ordering::Relaxed);
        }
    }

    /// Looks whether a wall has come over the foot of a line along which something was wet before.
    pub fn look_at_foot(&self, cloud: &FlowCloud, at: DVec3, is_wet: bool) {
        if is_wet {
            self.was_wet.store(true, Ordering::Relaxed);
        } else if self.was_wet.load(Ordering::Relaxed) && self.wall.get().is_none() {
            let reach = cloud.kernel.support;
            let is_near = |i: &usize| {
                let x = cloud.offset(at, cloud.records()[*i].position());
                x.length_squared() < reach * reach
            };
            let walls: Vec<usize> = cloud.boundaries_once().filter(is_near).collect();
            let share = |&i: &usize| {
                let record = &cloud.records()[i];
                record.volume() * cloud.kernel.value(cloud.offset(at, record.position()).length())
            };
            let filled = walls.iter().map(share).sum::<f64>();
            let body = nearest(cloud, &walls, at).and_then(|i| body_of(cloud, i));
            if let Some(body) = body.filter(|_| filled > FILLED) {
                let _ = self.wall.set(body);
                self.has_left.store(true, Ordering::Relaxed);
            }
        }
    }

    /// The wall that has moved away.
    pub fn left(&self) -> Option<BodyId> {
        self.wall.get().copied().filter(|_| self.has_left.load(Ordering::Relaxed))
    }
}

fn body_of(cloud: &FlowCloud, row: usize) -> Option<BodyId> {
    cloud.groups.iter().find(|group| group.cloud.contains(&row)).map(|group| group.body)
}
