//! Ranks: processes that carry out one run together.
//!
//! Every rank runs the same program on the same scene and holds all rows of all columns. Passes over pairs
//! are divided: of each body a rank computes a range of whole blocks of rows ([`own_blocks`]) and exchanges
//! the results with the others. Everything else is computed by every rank from equal values, in the order in
//! which one rank would: the bits of a run do not depend on the number of ranks.
//!
//! The engine knows the trait [`Ranks`] alone; a program without several processes has none. As the thread
//! pool of a parallel loop is that of the thread that begins it, the ranks of an exchange are those that the
//! thread has entered ([`enter`]).

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
