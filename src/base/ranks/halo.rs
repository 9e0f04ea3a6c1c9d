//! Halo rows of a rank, for passes that read only neighbours among the rows of other ranks.

use std::ops::Range;

use bytemuck::Pod;

use super::Cut;
use super::collective::{ReceivedParts, SentParts};
use super::exchange::SPOILED;
use super::group::{self, RankGroup};

/// The halo: rows of other ranks that are neighbours of the own rows, with their senders and receivers; empty
/// in a serial run.
#[derive(Debug, Default)]
pub struct Halo {
    /// The partition that it belongs to.
    cut: Option<Cut>,
    /// Own rows that other ranks read, rank by rank, and the bounds of each rank.
    send: Vec<u32>,
    send_cuts: Vec<usize>,
    /// Rows of other ranks that this rank reads.
    receive: Vec<u32>,
    receive_cuts: Vec<usize>,
    /// Rows of other ranks that this rank does not read, if stale rows are invalidated.
    unread: Vec<u32>,
}

impl Halo {
    /// The halo of a rank that reads `wanted` rows of these bodies, whose loops run in blocks of `block`
    /// rows; its own rows may be among them. The call is collective.
    pub fn of(bodies: &[Range<usize>], block: usize, wanted: &[bool]) -> Self {
        group::with(|group| Self::in_group(group, bodies, block, wanted)).unwrap_or_default()
    }

    fn in_group(group: &mut RankGroup, bodies: &[Range<usize>], block: usize, wanted: &[bool]) -> Self {
        let (rank, size) = (group.ranks.rank(), group.ranks.size());
        let (mut receive, mut receive_cuts, mut unread) = (Vec::new(), vec![0], Vec::new());
        for other in 0..size {
            for body in bodies.iter().filter(|_| other != rank) {
                let part = group.part(other, body.len(), block);
                let rows = body.start + part.start..body.start + part.end;
                receive.extend(rows.clone().filter(|&row| wanted[row]).map(|row| row as u32));
                unread.extend(rows.filter(|&row| group.spoils && !wanted[row]).map(|row| row as u32));
            }
            receive_cuts.push(receive.len());
        }
        // Number of rows that each rank reads from each other one.
        let mut counts = vec![0_u64; size * size];
        for other in 0..size {
            counts[rank * size + other] = (receive_cuts[other + 1] - receive_cuts[other]) as u64;
        }
        let rows_of_counts: Vec<usize> = (0..=size).map(|k| k * size * size_of::<u64>()).collect();
        group.share(bytemuck::cast_slice_mut(&mut counts), &rows_of_counts);
        let mut send_cuts = vec![0];
        for other in 0..size {
            send_cuts.push(send_cuts[other] + counts[other * size + rank] as usize);
        }
        let mut send = vec![0_u32; send_cuts[size]];
        let bytes = |cuts: &[usize]| cuts.iter().map(|cut| cut * size_of::<u32>()).collect::<Vec<_>>();
        group.exchange(
            SentParts { bytes: bytemuck::cast_slice(&receive), cuts: &bytes(&receive_cuts) },
            ReceivedParts { bytes: bytemuck::cast_slice_mut(&mut send), cuts: &bytes(&send_cuts) },
        );
        Self { cut: Some(group.cut.clone()), send, send_cuts, receive, receive_cuts, unread }
    }

    /// Whether it belongs to the current partition.
    pub fn is_current(&self) -> bool {
        group::with(|group| self.cut.as_ref() == Some(&group.cut)).unwrap_or(true)
    }

    /// The rows of other ranks, ascending rank by rank.
    pub fn rows(&self) -> &[u32] {
        &self.receive
    }

    /// Fills the rows of the halo with the results of their ranks.
    pub fn fill<T: Pod>(&self, rows: &mut [T]) {
        self.fill_bytes(bytemuck::cast_slice_mut(rows), size_of::<T>());
    }

    /// [`Halo::fill`] for rows of `size` bytes.
    pub fn fill_bytes(&self, bytes: &mut [u8], size: usize) {
        self.fill_parts(
            size,
            bytes,
            &mut |bytes, row, to| to.extend_from_slice(&bytes[row * size..(row + 1) * size]),
            &mut |bytes, row, from| bytes[row * size..(row + 1) * size].copy_from_slice(from),
        );
        self.unread
            .iter()
            .for_each(|&row| bytes[row as usize * size..(row as usize + 1) * size].fill(SPOILED));
    }

    /// Transfers a value for each row of the halo: the owner reads it from `rows` by `take`, and this rank
    /// stores it by `put`.
    pub fn fill_with<S: ?Sized, T: Pod>(
        &self,
        rows: &mut S,
        take: impl Fn(&S, usize) -> T,
        mut put: impl FnMut(&mut S, usize, T),
    ) {
        self.fill_parts(
            size_of::<T>(),
            rows,
            &mut |rows, row, to| to.extend_from_slice(bytemuck::bytes_of(&take(rows, row))),
            &mut |rows, row, from| put(rows, row, bytemuck::pod_read_unaligned(from)),
        );
    }

    fn fill_parts<S: ?Sized>(
        &self,
        size: usize,
        rows: &mut S,
        take: &mut dyn FnMut(&S, usize, &mut Vec<u8>),
        put: &mut dyn FnMut(&mut S, usize, &[u8]),
    ) {
        group::with(|group| {
            let (mut out, mut into) = (std::mem::take(&mut group.parts), std::mem::take(&mut group.received));
            out.clear();
            self.send.iter().for_each(|&row| take(rows, row as usize, &mut out));
            into.resize(self.receive.len() * size, 0);
            let in_bytes = |cuts: &[usize]| cuts.iter().map(|cut| cut * size).collect::<Vec<_>>();
            group.exchange(
                SentParts { bytes: &out, cuts: &in_bytes(&self.send_cuts) },
                ReceivedParts { bytes: &mut into, cuts: &in_bytes(&self.receive_cuts) },
            );
            for (&row, from) in self.receive.iter().zip(into.chunks_exact(size)) {
                put(rows, row as usize, from);
            }
            (group.parts, group.received) = (out, into);
        });
    }

    /// The rows of other ranks that are not in the halo, if stale rows are invalidated.
    pub fn unread(&self) -> &[u32] {
        &self.unread
    }
}
