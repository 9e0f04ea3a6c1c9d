//! Pair terms: forces that third parties write as a function of one pair, run in one pass over all pairs: a pass of their own, or
//! that of a formulation which has the geometry of the pairs in its hands.
//!
//! The pass builds the geometry of some rows once, then calls each term once for all of these through a vtable, with the pair
//! function inlined in the loop over rows and compiled for four neighbours at a time: no dispatch per pair, one pass over memory
//! for all terms.

mod batch;
mod block;
mod bound;
mod of_phase;
mod pass;
mod read;
mod term;
mod work;

pub use batch::{Extras, FourPairs, FourVectors, Neighbor, PairBatch, RowSlots, WeightAt};
pub(crate) use block::{BlockPairs, CHUNK, EightPairs, TermSums};
pub(crate) use of_phase::{AllSums, BodyTerms, BoundTerms, PhaseTerms, RateBounds, TermRows};
pub(crate) use pass::with_batch;
pub use pass::{PairRows, PairSource, add_pair_systems};
pub use read::{FourOf, ReadSet, Relative};
pub use term::{Pair, PairReads, PairTerm, Rates};
pub(crate) use work::add_work_systems;
