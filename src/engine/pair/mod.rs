//! Pair terms: forces that third parties write as a function of one pair, run in one pass over all pairs: a
//! separate pass, or that of a formulation which computes the geometry of the pairs anyway.
//!
//! The pass builds the geometry of some rows once, then calls each term once for all of these through a
//! vtable, with the pair function inlined in the loop over rows and compiled for four neighbours at a time:
//! no dispatch per pair, one pass over memory for all terms.

mod batch;
mod block;
mod body_terms;
mod bound;
mod handed_in;
mod of_phase;
mod pass;
mod rate_bounds;
mod read;
mod term;
mod weight_at;
mod work;

pub(crate) use batch::components;
pub use batch::{Extras, FourPairs, FourVectors, Neighbor, PairBatch, RowSlots};
pub(crate) use block::{BlockPairs, CHUNK, EightPairs, TermSums};
pub(crate) use body_terms::BodyTerms;
pub(crate) use of_phase::{AllSums, BoundTerms, PhaseTerms, TermRows};
pub(crate) use pass::add_present_pair_systems;
pub(crate) use pass::with_batch;
pub use pass::{PairRows, PairSource, add_pair_systems};
pub(crate) use rate_bounds::RateBounds;
pub use read::{FourOf, ReadSet, Relative};
pub use term::{Pair, PairReads, PairTerm, Rates};
pub use weight_at::WeightAt;
pub(crate) use work::add_work_systems;
