//! The ranks of a run as MPI processes. The engine knows only their trait `Ranks`.
#![cfg(feature = "mpi")]

use std::cell::RefCell;

use meshless_base::ranks::{Ranks, ReceivedParts, SentParts};
use mpi::Threading;
use mpi::datatype::{Partition, PartitionMut};
use mpi::environment::Universe;
use mpi::topology::SimpleCommunicator;
use mpi::traits::{Communicator, CommunicatorCollectives};
use thiserror::Error;

/// Maximum number of bytes in one exchange: MPI counts in i32.
const MAX_BYTES: usize = 1 << 30;

/// MPI cannot be used.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
pub enum StartError {
    /// A program initializes it once.
    #[error("MPI has been started already")]
    Twice,
    /// The library refuses calls from a program with threads.
    #[error("this MPI library must allow threads beside the one that calls it (MPI_THREAD_FUNNELED)")]
    NoThreads,
}

/// The processes that `mpirun` has started.
pub struct MpiRanks {
    world: SimpleCommunicator,
    /// Send buffer: MPI requires it to be separate from the receive buffer.
    own: RefCell<Vec<u8>>,
    /// Ends MPI when the run is over.
    _universe: Universe,
}

impl MpiRanks {
    /// Starts MPI. All exchanges must begin on this thread.
    ///
    /// # Errors
    /// MPI has been started before, or does not allow threads.
    pub fn start() -> Result<Self, StartError> {
        let (universe, threading) =
            mpi::initialize_with_threading(Threading::Funneled).ok_or(StartError::Twice)?;
        if threading < Threading::Funneled {
            return Err(StartError::NoThreads);
        }
        Ok(Self { world: universe.world(), own: RefCell::default(), _universe: universe })
    }

    /// One exchange of fewer than [`MAX_BYTES`] bytes.
    fn share_at_once(&self, bytes: &mut [u8], cuts: &[usize]) {
        let (start, end) = (cuts[self.rank()], cuts[self.rank() + 1]);
        let mut own = self.own.borrow_mut();
        own.clear();
        // See `addressed`.
        own.reserve(1);
        own.extend_from_slice(&bytes[start..end]);
        let counts: Vec<i32> = cuts.windows(2).map(|pair| count(pair[1] - pair[0])).collect();
        let places: Vec<i32> = cuts[..self.size()].iter().map(|&cut| count(cut)).collect();
        let mut all = PartitionMut::new(bytes, counts, places);
        self.world.all_gather_varcount_into(&own[..], &mut all);
    }
}

/// Bytes with an address: that of an empty vector is 1, which Open MPI takes for `MPI_IN_PLACE`.
fn addressed(bytes: &[u8]) -> &[u8] {
    if bytes.is_empty() { &[0] } else { bytes }
}

/// A number of bytes as MPI counts; those of one exchange are below [`MAX_BYTES`].
fn count(bytes: usize) -> i32 {
    i32::try_from(bytes).unwrap_or(i32::MAX)
}

impl Ranks for MpiRanks {
    fn rank(&self) -> usize {
        usize::try_from(self.world.rank()).unwrap_or(0)
    }

    fn size(&self) -> usize {
        usize::try_from(self.world.size()).unwrap_or(1)
    }

    fn share(&self, bytes: &mut [u8], cuts: &[usize]) {
        if bytes.len() < MAX_BYTES {
            return self.share_at_once(bytes, cuts);
        }
        // In rounds, in each of which every rank sends the next piece of its part.
        let size = self.size();
        let piece = MAX_BYTES / size;
        let longest = cuts.windows(2).map(|pair| pair[1] - pair[0]).max().unwrap_or(0);
        let mut round = Vec::new();
        for first in (0..longest).step_by(piece) {
            let part = |rank: usize| {
                let at = |place: usize| (cuts[rank] + place).min(cuts[rank + 1]);
                at(first)..at(first + piece)
            };
            let mut of_round = vec![0];
            round.clear();
            for rank in 0..size {
                round.extend_from_slice(&bytes[part(rank)]);
                of_round.push(round.len());
            }
            self.share_at_once(&mut round, &of_round);
            for rank in 0..size {
                bytes[part(rank)].copy_from_slice(&round[of_round[rank]..of_round[rank + 1]]);
            }
        }
    }

    fn exchange(&self, sent: SentParts<'_>, received: ReceivedParts<'_>) {
        let counts =
            |cuts: &[usize]| cuts.windows(2).map(|pair| count(pair[1] - pair[0])).collect::<Vec<i32>>();
        let places = |cuts: &[usize]| cuts[..self.size()].iter().map(|&cut| count(cut)).collect::<Vec<i32>>();
        let out = Partition::new(addressed(sent.bytes), counts(sent.cuts), places(sent.cuts));
        let mut nothing = [0];
        let into = if received.bytes.is_empty() { &mut nothing[..] } else { received.bytes };
        let mut into = PartitionMut::new(into, counts(received.cuts), places(received.cuts));
        self.world.all_to_all_varcount_into(&out, &mut into);
    }

    fn abort(&self, code: i32) -> ! {
        self.world.abort(code)
    }
}
