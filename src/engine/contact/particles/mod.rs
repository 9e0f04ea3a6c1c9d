//! Contact of particles with particles.

mod search;

mod contact;

pub(super) use contact::ParticleContact;
