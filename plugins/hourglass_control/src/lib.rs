//! hourglass_control
