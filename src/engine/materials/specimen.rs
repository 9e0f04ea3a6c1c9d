//! One particle of a material in tests: deformed step by step, with its state.

use std::sync::Arc;

use glam::DMat3;

use super::{Law, MAX_STATE, Material, SolidLaw, StateColumns, StateRows, StressRows};
use crate::world::{Column, ColumnSet};

/// A particle with its state.
pub(super) struct MaterialSpecimen {
    law: Arc<dyn SolidLaw>,
    columns: StateColumns,
    /// A word for each eight bytes of each column, so that they are aligned.
    words: Vec<Vec<u64>>,
    pub deformation: DMat3,
    pub stress: DMat3,
    pub energy: f64,
    pub strength: f64,
    /// Plastic work since the start, J/m3.
    pub plastic_work: f64,
    /// Work of the stress by the trapezoidal rule since the start, J/m3.
    pub work: f64,
}

impl MaterialSpecimen {
    pub fn new(material: Material) -> Self {
        let Law::Solid(law) = material.law else { panic!("not a solid") };
        let mut set = ColumnSet::default();
        law.state(&mut set);
        let columns = StateColumns::new(&set).expect("not too many columns");
        let words = columns.as_slice().iter().map(|column| vec![0; column.element_size / 8]).collect();
        let mut specimen = Self {
            law: Arc::clone(&law),
            columns,
            words,
            deformation: DMat3::IDENTITY,
            stress: DMat3::ZERO,
            energy: 0.0,
            strength: 0.0,
            plastic_work: 0.0,
            work: 0.0,
        };
        law.start(specimen.state());
        specimen
    }

    fn state(&mut self) -> StateRows<'_> {
        let mut bytes: [&mut [u8]; MAX_STATE] = Default::default();
        for (slot, words) in bytes.iter_mut().zip(&mut self.words) {
            *slot = bytemuck::cast_slice_mut(words);
        }
        StateRows::new(&self.columns, bytes)
    }

    /// The value of a state column.
    pub fn get<T: Column>(&mut self) -> T {
        self.state().take::<T>()[0]
    }

    /// Sets the value of a state column.
    pub fn set<T: Column>(&mut self, value: T) {
        self.state().take::<T>()[0] = value;
    }

    /// Deforms the particle to `deformation` within `dt` seconds.
    pub fn step(&mut self, deformation: DMat3, dt: f64) {
        let (mut stress, mut energy, mut modulus) = ([DMat3::ZERO], [0.0], [0.0]);
        let (mut strength, mut plastic_work) = ([f64::INFINITY], [0.0]);
        let law = Arc::clone(&self.law);
        law.stress(&mut StressRows {
            dt,
            deformation: &[deformation],
            share: &[1.0],
            stress_before: &[self.stress],
            stress: &mut stress,
            energy: &mut energy,
            modulus: &mut modulus,
            strength: &mut strength,
            plastic_work: &mut plastic_work,
            state: self.state(),
        });
        let change = (deformation - self.deformation).to_cols_array();
        let mean = ((stress[0] + self.stress) * 0.5).to_cols_array();
        self.work += change.iter().zip(mean).map(|(a, b)| a * b).sum::<f64>();
        self.plastic_work += plastic_work[0];
        (self.deformation, self.stress, self.energy) = (deformation, stress[0], energy[0]);
        self.strength = strength[0];
    }

    /// Deforms it along a path from 0 to 1 in equal steps within `time` seconds.
    pub fn follow(&mut self, path: impl Fn(f64) -> DMat3, steps: u32, time: f64) {
        for k in 1..=steps {
            self.step(path(f64::from(k) / f64::from(steps)), time / f64::from(steps));
        }
    }

    /// Kirchhoff stress, Pa.
    pub fn kirchhoff(&self) -> DMat3 {
        self.stress * self.deformation.transpose()
    }
}
