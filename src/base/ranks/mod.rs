//! Ranks: the processes of a parallel run.
//!
//! Every rank runs the same program on the same scene and holds all rows of all columns. Passes over pairs
//! are partitioned: a rank computes a range of whole blocks of rows of each body ([`own_blocks`]) and
//! exchanges the results with the others. Every rank computes everything else redundantly, in the order of a
//! serial run, so that results are bitwise independent of the number of ranks.
//!
//! The engine depends on the trait [`Ranks`] alone; a serial program has no implementation of it. The ranks
//! of an exchange are those that the calling thread has entered ([`enter`]), just as the thread pool of a
//! parallel loop is that of the calling thread.

mod collective;
mod cut;
mod exchange;
mod group;
mod halo;
mod join;
mod tree;

pub use collective::{Ranks, ReceivedParts, SentParts};
pub use cut::Cut;
pub use exchange::{share, share_bodies, share_some, spoil_others};
pub(crate) use group::work;
pub use group::{
    Traffic, abort, agree, any, balanced_cut, cut, enter, has_several, is_first, own_blocks, set_cut,
    spoil_old_rows, traffic,
};
pub use halo::Halo;
pub use join::{concatenate, concatenate_rows, join};
pub(crate) use tree::{complete, maximal_subtrees};
