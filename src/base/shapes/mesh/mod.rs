//! Closed triangle meshes from STL and OBJ files.

mod closest;
mod file;
mod normals;
mod obj;
mod point;
mod solid;
mod stl;
mod topology;
mod tree;
mod triangle;

pub(super) use file::load;

#[cfg(test)]
mod tests;
