//! local_damping
