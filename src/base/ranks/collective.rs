//! What processes that run together must be able to do.

/// Bytes for other ranks: `bytes[cuts[r]..cuts[r + 1]]` go to rank r.
#[derive(Clone, Copy, Debug)]
pub struct SentParts<'a> {
    /// The parts, one behind the other.
    pub bytes: &'a [u8],
    /// Where the part of each rank begins, and where the last one ends.
    pub cuts: &'a [usize],
}

/// Room for the bytes of other ranks: `bytes[cuts[r]..cuts[r + 1]]` come from rank r.
#[derive(Debug)]
pub struct ReceivedParts<'a> {
    /// The parts, one behind the other.
    pub bytes: &'a mut [u8],
    /// Where the part of each rank begins, and where the last one ends.
    pub cuts: &'a [usize],
}

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

    /// Sends each rank its part and receives one from each.
    fn exchange(&self, sent: SentParts<'_>, received: ReceivedParts<'_>);

    /// Ends all ranks at once, as one of them cannot go on.
    fn abort(&self, code: i32) -> !;
}
