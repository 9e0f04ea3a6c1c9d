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
    /// Time spent in loops that are divided since the last look at it, s.
    pub busy: f64,
    /// Memory in which parts are put together, and in which others arrive.
    pub parts: Vec<u8>,
    pub received: Vec<u8>,
    /// Memory of bounds.
    pub cuts: Vec<usize>,
    /// Whether rows that have become old are made unusable.
    pub spoils: bool,
}

impl RankGroup {
    /// Rows of rank `rank`, counted from the first of a body of `len` rows, in blocks of `block`.
    pub fn part(&self, rank: usize, len: usize, block: usize) -> Range<usize> {
        let blocks = self.cut.blocks(rank, len.div_ceil(block));
        (blocks.start * block).min(len)..(blocks.end * block).min(len)
    }

    /// [`Ranks::share`], counted.
    pub fn share(&mut self, bytes: &mut [u8], cuts: &[usize]) {
        let rank = self.ranks.rank();
        self.traffic.exchanges += 1;
        self.traffic.bytes += (bytes.len() - (cuts[rank + 1] - cuts[rank])) as u64;
        self.ranks.share(bytes, cuts);
    }

    /// [`Ranks::exchange`], counted.
    pub fn exchange(&mut self, sent: SentParts<'_>, received: ReceivedParts<'_>) {
        self.traffic.exchanges += 1;
        self.traffic.bytes += received.bytes.len() as u64;
        self.ranks.exchange(sent, received);
    }
}

thread_local! {
    static GROUP: RefCell<Option<RankGroup>> = const { RefCell::new(None) };
}

/// Leaves the ranks when dropped, also where what was carried out has panicked.
struct Leave;

impl Drop for Leave {
    fn drop(&mut self) {
        GROUP.set(None);
    }
}

/// Carries `f` out as one of these ranks: exchanges that this thread begins in it are theirs.
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

/// Calls `f` with the group and returns its result, or `None` for a program that runs alone.
pub(super) fn with<T>(f: impl FnOnce(&mut RankGroup) -> T) -> Option<T> {
    GROUP.with_borrow_mut(|group| group.as_mut().map(f))
}

/// Whether this thread has entered several ranks.
pub fn has_several() -> bool {
    GROUP.with_borrow(Option::is_some)
}

/// Makes rows of other ranks unusable from now on once they are old, as debug builds do: a pass that reads
/// one computes with NaN.
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

/// Runs a part of a divided loop, and counts the time that this rank spends in it.
pub(crate) fn work<T>(f: impl FnOnce() -> T) -> T {
    let begun = Instant::now();
    let done = f();
    with(|group| group.busy += begun.elapsed().as_secs_f64());
    done
}

/// A cut by which all ranks would be ready together, from the time that each has spent in divided loops since
/// this was asked last; none where they nearly are. It is the same on all ranks.
pub fn balanced_cut() -> Option<Cut> {
    let busy = with(|group| std::mem::take(&mut group.busy))?;
    let seconds: Vec<f64> = gather(busy.to_bits()).into_iter().map(f64::from_bits).collect();
    with(|group| group.cut.balanced(&seconds))?
}

/// The division of loops; none in a program that runs alone.
pub fn cut() -> Option<Cut> {
    with(|group| group.cut.clone())
}

/// Divides loops anew, between two steps, with the same cut on all ranks.
///
/// # Panics
/// The cut is one for another number of ranks.
pub fn set_cut(cut: Cut) {
    with(|group| {
        assert_eq!(cut.size(), group.ranks.size(), "a cut for another number of ranks");
        group.cut = cut;
    });
}

/// Ends all ranks at once, as this one cannot go on and the others do not know; does nothing in a program
/// that runs alone.
pub fn abort(code: i32) {
    let ranks = with(|group| Rc::clone(&group.ranks));
    if let Some(ranks) = ranks {
        ranks.abort(code);
    }
}

/// Data exchanged by this rank since it entered.
pub fn traffic() -> Traffic {
    with(|group| group.traffic).unwrap_or_default()
}

/// The values of all ranks.
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

/// Whether it is so on any rank.
pub fn any(value: bool) -> bool {
    gather(value.into()).contains(&1)
}

/// Whether all ranks have the same value.
pub fn agree(value: u64) -> bool {
    gather(value).iter().all(|other| *other == value)
}
