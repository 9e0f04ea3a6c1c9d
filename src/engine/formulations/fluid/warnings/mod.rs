//! What a flow must not do, looked at in the course of the run.

mod intrusion;

mod passing;

mod compression;

mod filling;

mod fit;

mod friction;

mod unevenness;

pub mod watch;
