//! Closed triangle meshes from STL and OBJ files.

mod closest;
mod fault;
mod file;
mod obj;
mod solid;
mod stl;
mod topology;
mod tree;
mod triangle;

pub use fault::MeshFault;
pub(super) use file::load;

#[cfg(test)]
mod tests;
