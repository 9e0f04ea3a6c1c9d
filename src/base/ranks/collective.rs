//! The collective operations that a run on several processes needs.

/// Bytes for other ranks: `bytes[cuts[r]..cuts[r + 1]]` go to rank r.
#[derive(Clone, Copy, Debug)]
pub struct SentParts<'a> {
    /// The concatenated parts.
    pub bytes: &'a [u8],
    /// Start of the part of each rank, and end of the last one.
    pub cuts: &'a [usize],
}

/// Buffer for the bytes of other ranks: `bytes[cuts[r]..cuts[r + 1]]` come from rank r.
#[derive(Debug)]
pub struct ReceivedParts<'a> {
    /// The concatenated parts.
    pub bytes: &'a mut [u8],
    /// Start of the part of each rank, and end of the last one.
    pub cuts: &'a [usize],
}

/// Processes of a parallel run. Every call is collective: all ranks make the same calls in the
/// same order.
pub trait Ranks {
    /// Number of this rank, from 0.
    fn rank(&self) -> usize;

    /// Number of ranks.
    fn size(&self) -> usize;

    /// Gathers the parts of all ranks on every rank: rank r has written the bytes `cuts[r]..cuts[r + 1]`
    /// beforehand, and afterwards every rank has all bytes. `cuts` ascends from 0 to the number of bytes and
    /// is the same on every rank.
    fn share(&self, bytes: &mut [u8], cuts: &[usize]);

    /// Sends each rank its part and receives one part from each (all-to-all).
    fn exchange(&self, sent: SentParts<'_>, received: ReceivedParts<'_>);

    /// Aborts all ranks, because one of them cannot continue.
    fn abort(&self, code: i32) -> !;
}
