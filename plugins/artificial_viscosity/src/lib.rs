//! artificial_viscosity
