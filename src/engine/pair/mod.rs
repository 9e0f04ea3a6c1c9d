//! Pair terms: forces that third parties write as a function of one pair, run in one pass over all pairs: a pass of their own, or
//! that of a formulation which has the geometry of the pairs in its hands.
//!
//! The pass builds the geometry of a row once, then calls each term once per row through a vtable, with the pair
//! function inlined in the row loop and compiled for four neighbours at a time: no dispatch per pair, one pass over memory for
//! all terms.

mod bound;
mod of_phase;
mod pass;
mod read;
mod row;
mod term;
mod work;

pub(crate) use of_phase::{BodyTerms, BoundTerms, Fastest, PhaseTerms, TermRows};
pub(crate) use pass::with_row;
pub use pass::{PairRows, PairSource, add_pair_systems};
pub use read::{FourOf, ReadSet};
pub use row::{FourPairs, FourVectors, PairRow, Room};
pub use term::{BodyPairTerm, Pair, PairReads, PairTerm, Rates};
pub(crate) use work::add_work_systems;
