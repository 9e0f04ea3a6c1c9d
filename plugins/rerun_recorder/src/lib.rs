//! rerun_recorder
