//! Exchange of rows: every rank has computed its own rows, and afterwards every rank has all rows.

use std::ops::Range;

use bytemuck::Pod;

use super::group::{self, RankGroup};

/// Byte value of a stale row.
pub(super) const SPOILED: u8 = 0xff;

/// Exchanges the rows of one body after every rank has computed its blocks of `block` rows.
pub fn share<T: Pod>(rows: &mut [T], block: usize) {
    let len = rows.len();
    share_bodies(bytemuck::cast_slice_mut(rows), size_of::<T>(), block, std::iter::once(0..len));
}

/// Exchanges the rows of several bodies, of `size` bytes each, in one exchange, after every rank has computed
/// its blocks.
pub fn share_bodies(
    bytes: &mut [u8],
    size: usize,
    block: usize,
    bodies: impl Iterator<Item = Range<usize>> + Clone,
) {
    group::with(|group| {
        let mut some = bodies.clone();
        match (some.next(), some.next()) {
            (Some(body), None) => {
                of_one_body(group, &mut bytes[body.start * size..body.end * size], size, block)
            }
            _ => of_several_bodies(group, bytes, size, block, bodies),
        }
    });
}

/// Exchanges values of some rows of a body of `len` rows, after every rank has computed those in its blocks.
/// `end` is the number of values before a row of the body.
pub fn share_some<T: Pod>(values: &mut [T], len: usize, block: usize, end: impl Fn(usize) -> usize) {
    group::with(|group| {
        let mut cuts = std::mem::take(&mut group.cuts);
        cuts.clear();
        cuts.push(0);
        cuts.extend(
            (0..group.ranks.size()).map(|rank| end(group.part(rank, len, block).end) * size_of::<T>()),
        );
        group.share(bytemuck::cast_slice_mut(values), &cuts);
        group.cuts = cuts;
    });
}

/// Invalidates the rows of other ranks if [`super::spoil_old_rows`] is on: all bits are set, which is NaN.
pub fn spoil_others(bytes: &mut [u8], size: usize, block: usize, bodies: impl Iterator<Item = Range<usize>>) {
    group::with(|group| {
        let own = group.ranks.rank();
        for body in bodies.filter(|_| group.spoils) {
            let part = group.part(own, body.len(), block);
            bytes[body.start * size..(body.start + part.start) * size].fill(SPOILED);
            bytes[(body.start + part.end) * size..body.end * size].fill(SPOILED);
        }
    });
}

fn of_one_body(group: &mut RankGroup, bytes: &mut [u8], size: usize, block: usize) {
    let len = bytes.len() / size;
    let mut cuts = std::mem::take(&mut group.cuts);
    cuts.clear();
    cuts.push(0);
    cuts.extend((0..group.ranks.size()).map(|rank| group.part(rank, len, block).end * size));
    group.share(bytes, &cuts);
    group.cuts = cuts;
}

fn of_several_bodies(
    group: &mut RankGroup,
    bytes: &mut [u8],
    size: usize,
    block: usize,
    bodies: impl Iterator<Item = Range<usize>> + Clone,
) {
    let (mut cuts, mut parts) = (std::mem::take(&mut group.cuts), std::mem::take(&mut group.parts));
    cuts.clear();
    parts.clear();
    cuts.push(0);
    let place = |group: &RankGroup, rank: usize, body: &Range<usize>| {
        let part = group.part(rank, body.len(), block);
        (body.start + part.start) * size..(body.start + part.end) * size
    };
    for rank in 0..group.ranks.size() {
        bodies.clone().for_each(|body| parts.extend_from_slice(&bytes[place(group, rank, &body)]));
        cuts.push(parts.len());
    }
    group.share(&mut parts, &cuts);
    let mut rest = &parts[..];
    for rank in 0..group.ranks.size() {
        for body in bodies.clone() {
            let to = &mut bytes[place(group, rank, &body)];
            let (from, behind) = rest.split_at(to.len());
            to.copy_from_slice(from);
            rest = behind;
        }
    }
    (group.cuts, group.parts) = (cuts, parts);
}
