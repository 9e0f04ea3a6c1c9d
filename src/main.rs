//! meshless
fn main(){}
