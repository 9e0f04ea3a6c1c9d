//! The ranks that a thread has entered.

use std::cell::RefCell;
use std::ops::Range;
use std::rc::Rc;
use std::time::Instant;

use super::collective::{ReceivedParts, SentParts};
use super::{Cut, Ranks};

/// Data exchanged between a rank and the others.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Traffic {
    /// Number of exchanges.
    pub exchanges: u64,
    /// Bytes that this rank has received from others.
    pub bytes: u64,
}

pub(super) struct RankGroup {
    pub ranks: Rc<dyn Ranks>,
    pub cut: Cut,
    pub traffic: Traffic,
    /// Time spent in partitioned loops since the last [`balanced_cut`], s.
    pub busy: f64,
    /// Send buffer, and receive buffer.
    pub parts: Vec<u8>,
    pub received: Vec<u8>,
    /// Buffer of part bounds.
    pub cuts: Vec<usize>,
    /// Whether stale rows are invalidated.
    pub spoils: bool,
}

impl RankGroup {
    /// Rows of rank `rank`, counted from the first of a body of `len` rows, in blocks of `block`.
    pub fn part(&self, rank: usize, len: usize, block: usize) -> Range<usize> {
        let blocks = self.cut.blocks(rank, len.div_ceil(block));
        (blocks.start * block).min(len)..(blocks.end * block).min(len)
    }

    /// [`Ranks::share`] with a count of the traffic.
    pub fn share(&mut self, bytes: &mut [u8], cuts: &[usize]) {
        let rank = self.ranks.rank();
        self.traffic.exchanges += 1;
        self.traffic.bytes += (bytes.len() - (cuts[rank + 1] - cuts[rank])) as u64;
        self.ranks.share(bytes, cuts);
    }

    /// [`Ranks::exchange`] with a count of the traffic.
    pub fn exchange(&mut self, sent: SentParts<'_>, received: ReceivedParts<'_>) {
        self.traffic.exchanges += 1;
        self.traffic.bytes += received.bytes.len() as u64;
        self.ranks.exchange(sent, received);
    }
}

thread_local! {
    static GROUP: RefCell<Option<RankGroup>> = const { RefCell::new(None) };
}

/// Leaves the ranks when dropped, even after a panic.
struct Leave;

impl Drop for Leave {
    fn drop(&mut self) {
        GROUP.set(None);
    }
}

/// Runs `f` as one of the given ranks, which take part in all exchanges that this thread begins in it.
pub fn enter<T>(ranks: Rc<dyn Ranks>, f: impl FnOnce() -> T) -> T {
    let cut = Cut::even(ranks.size());
    let several = ranks.size() > 1;
    GROUP.set(several.then(|| RankGroup {
        ranks,
        cut,
        traffic: Traffic::default(),
        busy: 0.0,
        parts: Vec::new(),
        received: Vec::new(),
        cuts: Vec::new(),
        spoils: cfg!(debug_assertions),
    }));
    let _leave = Leave;
    f()
}

/// Calls `f` with the group and returns its result, or `None` in a serial run.
pub(super) fn with<T>(f: impl FnOnce(&mut RankGroup) -> T) -> Option<T> {
    GROUP.with_borrow_mut(|group| group.as_mut().map(f))
}

/// Whether this thread has entered several ranks.
pub fn has_several() -> bool {
    GROUP.with_borrow(Option::is_some)
}

/// Invalidates stale rows of other ranks from now on, as debug builds do, so that a pass that reads one
/// computes NaN.
pub fn spoil_old_rows() {
    with(|group| group.spoils = true);
}

/// Whether this rank is the first, which writes the files of the run.
pub fn is_first() -> bool {
    with(|group| group.ranks.rank() == 0).unwrap_or(true)
}

/// The blocks of a loop over `count` of them that this rank computes.
pub fn own_blocks(count: usize) -> Range<usize> {
    with(|group| group.cut.blocks(group.ranks.rank(), count)).unwrap_or(0..count)
}

/// Runs a part of a partitioned loop, and measures the time that this rank spends in it.
pub(crate) fn work<T>(f: impl FnOnce() -> T) -> T {
    let begun = Instant::now();
    let done = f();
    with(|group| group.busy += begun.elapsed().as_secs_f64());
    done
}

/// A partition that balances the load, from the time that each rank has spent in partitioned loops since the
/// last call; `None` where the load is nearly balanced. It is the same on all ranks.
pub fn balanced_cut() -> Option<Cut> {
    let busy = with(|group| std::mem::take(&mut group.busy))?;
    let seconds: Vec<f64> = gather(busy.to_bits()).into_iter().map(f64::from_bits).collect();
    with(|group| group.cut.balanced(&seconds))?
}

/// The partition of loops; `None` in a serial run.
pub fn cut() -> Option<Cut> {
    with(|group| group.cut.clone())
}

/// Repartitions loops, between two steps, with the same partition on all ranks.
///
/// # Panics
/// The partition is for another number of ranks.
pub fn set_cut(cut: Cut) {
    with(|group| {
        assert_eq!(cut.size(), group.ranks.size(), "a cut for another number of ranks");
        group.cut = cut;
    });
}

/// Aborts all ranks, because this one cannot continue and the others are unaware of it; does nothing in a
/// serial run.
pub fn abort(code: i32) {
    let ranks = with(|group| Rc::clone(&group.ranks));
    if let Some(ranks) = ranks {
        ranks.abort(code);
    }
}

/// Traffic of this rank since it entered.
pub fn traffic() -> Traffic {
    with(|group| group.traffic).unwrap_or_default()
}

/// Gathers the values of all ranks.
pub(super) fn gather(value: u64) -> Vec<u64> {
    let values = with(|group| {
        let (rank, size) = (group.ranks.rank(), group.ranks.size());
        let mut values = vec![0_u64; size];
        values[rank] = value;
        let cuts: Vec<usize> = (0..=size).map(|k| 8 * k).collect();
        group.share(bytemuck::cast_slice_mut(&mut values), &cuts);
        values
    });
    values.unwrap_or_else(|| vec![value])
}

/// Whether the value is true on any rank.
pub fn any(value: bool) -> bool {
    gather(value.into()).contains(&1)
}

/// Whether all ranks have the same value.
pub fn agree(value: u64) -> bool {
    gather(value).iter().all(|other| *other == value)
}
