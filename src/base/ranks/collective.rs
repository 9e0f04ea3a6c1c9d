//! What processes that run together must be able to do.

/// Processes that carry out a run together. Every call is collective: all ranks make the same calls in the
/// same order.
pub trait Ranks {
    /// Number of this rank, from 0.
    fn rank(&self) -> usize;

    /// Number of ranks.
    fn size(&self) -> usize;

    /// Gives every rank the part of each: rank r has written the bytes `cuts[r]..cuts[r + 1]`, and afterwards
    /// all are there. `cuts` ascends from 0 to the number of bytes and is the same on every rank.
    fn share(&self, bytes: &mut [u8], cuts: &[usize]);

    /// Sends each rank a part and receives one from each: `sent[cuts[r]..cuts[r + 1]]` goes to rank r, and of
    /// `received` the part of rank r is filled by it.
    fn exchange(&self, sent: (&[u8], &[usize]), received: (&mut [u8], &[usize]));

    /// Ends all ranks at once, as one of them cannot go on.
    fn abort(&self, code: i32) -> !;
}
