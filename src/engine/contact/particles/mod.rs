//! Contact of particles with particles.

mod search;

mod pairs;

mod contact;

pub(super) use contact::ParticleContact;
