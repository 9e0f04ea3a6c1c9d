//! meshless
