//! Ranks that are threads of one program: what several processes do, on any machine.

use std::process;
use std::rc::Rc;
use std::sync::{Arc, Condvar, Mutex};
use std::time::Duration;

use meshless::ranks::{self, Ranks, ReceivedParts, SentParts};

/// How long a rank waits for the others before it says that they do not come.
const PATIENCE: Duration = Duration::from_secs(120);

/// What the ranks have in common.
struct Table {
    state: Mutex<State>,
    changed: Condvar,
}

/// An exchange in two rounds: all have put down their parts, all have taken those of the others.
struct State {
    parts: Vec<Vec<u8>>,
    /// Cuts of the first one that has come, and those of each.
    cuts: Vec<usize>,
    cuts_of: Vec<Vec<usize>>,
    arrived: usize,
    round: u64,
}

impl Table {
    fn of(size: usize) -> Self {
        let state = State {
            parts: vec![Vec::new(); size],
            cuts: Vec::new(),
            cuts_of: vec![Vec::new(); size],
            arrived: 0,
            round: 0,
        };
        Self { state: Mutex::new(state), changed: Condvar::new() }
    }

    /// Runs `act`, and waits until all have done so.
    fn meet(&self, size: usize, rank: usize, act: impl FnOnce(&mut State)) {
        let mut state = self.state.lock().expect("no rank has failed");
        act(&mut state);
        state.arrived += 1;
        let round = state.round;
        if state.arrived == size {
            (state.arrived, state.round) = (0, round + 1);
            self.changed.notify_all();
            return;
        }
        let waiting = |state: &mut State| state.round == round;
        let (_state, time_out) =
            self.changed.wait_timeout_while(state, PATIENCE, waiting).expect("no rank has failed");
        assert!(!time_out.timed_out(), "rank {rank} waits for others that do not come");
    }
}

struct Thread {
    rank: usize,
    size: usize,
    table: Arc<Table>,
}

impl Ranks for Thread {
    fn rank(&self) -> usize {
        self.rank
    }

    fn size(&self) -> usize {
        self.size
    }

    fn share(&self, bytes: &mut [u8], cuts: &[usize]) {
        assert_eq!(cuts.len(), self.size + 1);
        assert_eq!((cuts[0], cuts[self.size]), (0, bytes.len()));
        self.table.meet(self.size, self.rank, |state| {
            if state.arrived == 0 {
                state.cuts = cuts.to_vec();
            }
            assert_eq!(state.cuts, cuts, "rank {} is elsewhere in the program", self.rank);
            let own = &bytes[cuts[self.rank]..cuts[self.rank + 1]];
            state.parts[self.rank].clear();
            state.parts[self.rank].extend_from_slice(own);
        });
        self.table.meet(self.size, self.rank, |state| {
            for (rank, part) in state.parts.iter().enumerate().filter(|(rank, _)| *rank != self.rank) {
                bytes[cuts[rank]..cuts[rank + 1]].copy_from_slice(part);
            }
        });
    }

    fn exchange(&self, sent: SentParts<'_>, received: ReceivedParts<'_>) {
        assert_eq!((sent.cuts.len(), received.cuts.len()), (self.size + 1, self.size + 1));
        self.table.meet(self.size, self.rank, |state| {
            state.parts[self.rank].clear();
            state.parts[self.rank].extend_from_slice(sent.bytes);
            state.cuts_of[self.rank] = sent.cuts.to_vec();
        });
        self.table.meet(self.size, self.rank, |state| {
            for rank in 0..self.size {
                let from = &state.cuts_of[rank];
                let part = &state.parts[rank][from[self.rank]..from[self.rank + 1]];
                received.bytes[received.cuts[rank]..received.cuts[rank + 1]].copy_from_slice(part);
            }
        });
    }

    fn abort(&self, code: i32) -> ! {
        process::exit(code)
    }
}

/// Runs `f` on that many ranks, each with a pool of `threads` threads, and returns what each has returned.
pub fn on_ranks<T: Send>(size: usize, threads: usize, f: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let table = Arc::new(Table::of(size));
    let (f, table) = (&f, &table);
    let as_rank = |rank: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a thread pool");
        let table = Arc::clone(table);
        pool.install(move || {
            ranks::enter(Rc::new(Thread { rank, size, table }), || {
                ranks::spoil_old_rows();
                f(rank)
            })
        })
    };
    std::thread::scope(|scope| {
        let ranks: Vec<_> = (0..size).map(|rank| scope.spawn(move || as_rank(rank))).collect();
        ranks.into_iter().map(|rank| rank.join().expect("a rank")).collect()
    })
}
