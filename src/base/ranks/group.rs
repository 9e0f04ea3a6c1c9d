//! The ranks that a thread has entered.

use std::cell::RefCell;
use std::ops::Range;
use std::rc::Rc;

use super::{Cut, Ranks};

/// What a rank has exchanged with the others.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Traffic {
    /// Number of exchanges.
    pub exchanges: u64,
    /// Bytes that this rank has received from others.
    pub bytes: u64,
}

pub(super) struct Group {
    pub ranks: Rc<dyn Ranks>,
    pub cut: Cut,
    pub traffic: Traffic,
    /// Memory in which parts are put together.
    pub parts: Vec<u8>,
    /// Memory of bounds.
    pub cuts: Vec<usize>,
}

thread_local! {
    static GROUP: RefCell<Option<Group>> = const { RefCell::new(None) };
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
    GROUP.set(several.then(|| Group {
        ranks,
        cut,
        traffic: Traffic::default(),
        parts: Vec::new(),
        cuts: Vec::new(),
    }));
    let _leave = Leave;
    f()
}

/// What `f` returns of the group, or `None` for a program that runs alone.
pub(super) fn with<T>(f: impl FnOnce(&mut Group) -> T) -> Option<T> {
    GROUP.with_borrow_mut(|group| group.as_mut().map(f))
}

/// Whether this thread has entered several ranks.
pub fn has_several() -> bool {
    GROUP.with_borrow(Option::is_some)
}

/// Whether this rank is the first, which writes the files of the run.
pub fn is_first() -> bool {
    with(|group| group.ranks.rank() == 0).unwrap_or(true)
}

/// The blocks of a loop over `count` of them that this rank computes.
pub fn own_blocks(count: usize) -> Range<usize> {
    with(|group| group.cut.blocks(group.ranks.rank(), count)).unwrap_or(0..count)
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

/// Ends all ranks at once, as this one cannot go on and the others do not know; does nothing in a program that runs alone.
pub fn abort(code: i32) {
    let ranks = with(|group| Rc::clone(&group.ranks));
    if let Some(ranks) = ranks {
        ranks.abort(code);
    }
}

/// What this rank has exchanged since it entered.
pub fn traffic() -> Traffic {
    with(|group| group.traffic).unwrap_or_default()
}

/// The values of all ranks.
fn gather(value: u64) -> Vec<u64> {
    let values = with(|group| {
        let (rank, size) = (group.ranks.rank(), group.ranks.size());
        let mut values = vec![0_u64; size];
        values[rank] = value;
        let cuts: Vec<usize> = (0..=size).map(|k| 8 * k).collect();
        group.traffic.exchanges += 1;
        group.traffic.bytes += 8 * (size as u64 - 1);
        group.ranks.share(bytemuck::cast_slice_mut(&mut values), &cuts);
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
