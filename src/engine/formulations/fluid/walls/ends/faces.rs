//! The faces of walls in front of fluid particles.

use glam::DMat3;

use crate::parallel::for_each_block;

/// In the place of a number for particles that have not been taken in.
const NONE: u32 = u32::MAX;

/// The faces in front of some fluid particles: n (x) n of their normals, by their weights.
#[derive(Default)]
pub(super) struct FacesBefore {
    /// Number of each fluid particle among those that have been taken in.
    numbers: Vec<u32>,
    rows: Vec<u32>,
    faces: Vec<DMat3>,
}

impl FacesBefore {
    /// Allocates memory for that many fluid particles.
    pub fn reserve(&mut self, fluid: usize) {
        self.numbers.resize(fluid, NONE);
        self.rows.reserve(fluid);
        self.faces.reserve(fluid);
    }

    /// Lets go of all particles.
    pub fn clear(&mut self) {
        for row in self.rows.drain(..) {
            self.numbers[row as usize] = NONE;
        }
        self.faces.clear();
    }

    /// Takes in a particle, with no face before it; whether it is new.
    pub fn take_in(&mut self, row: u32) -> bool {
        let number = &mut self.numbers[row as usize];
        if *number != NONE {
            return false;
        }
        *number = self.rows.len() as u32;
        self.rows.push(row);
        self.faces.push(DMat3::ZERO);
        true
    }

    /// Adds a face, if there is one, before every particle that has been taken in.
    pub fn add(&mut self, face: impl Fn(usize) -> Option<DMat3> + Sync) {
        let rows = (&self.rows[..], &mut self.faces[..]);
        type Rows<'a> = (&'a [u32], &'a mut [DMat3]);
        for_each_block(rows, &mut Vec::new(), &|_, (rows, faces): Rows<'_>| {
            for (&row, sum) in rows.iter().zip(faces) {
                *sum += face(row as usize).unwrap_or(DMat3::ZERO);
            }
        });
    }

    /// The faces before a particle of the cloud, if there are any.
    pub fn of(&self, row: usize) -> Option<&DMat3> {
        let number = *self.numbers.get(row)?;
        self.faces.get(number as usize).filter(|faces| **faces != DMat3::ZERO)
    }
}
