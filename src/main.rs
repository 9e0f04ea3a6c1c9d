//! meshless
fn main() {}
