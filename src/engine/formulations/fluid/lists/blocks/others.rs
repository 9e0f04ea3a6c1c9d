//! The blocks that other ranks compute.
//!
//! Loops that are divided among ranks need the lists of their own blocks. Reads of single particles, as by
//! probes, may need the lists of any block.

use std::ops::Range;
use std::sync::OnceLock;

use super::table::BlockTable;
use crate::parallel::own_rows;
use crate::ranks::{self, Cut};

/// Lists of other ranks' blocks.
#[derive(Debug, Default)]
pub struct OtherRows {
    /// Division of loops when the lists were built.
    cut: Option<Cut>,
    /// Blocks of this rank, ascending.
    own: Vec<Range<usize>>,
    /// The lists of all blocks, as far as they have been asked for; none where this rank has all blocks.
    pub(super) found: Vec<OnceLock<Box<[u32]>>>,
}

/// The blocks of a table that this rank computes, and all of the bodies that every rank needs.
pub fn own_blocks(
    table: &BlockTable,
    looks_at_all: impl Fn(&Range<usize>) -> bool,
) -> impl Iterator<Item = Range<usize>> {
    let rows = table.bodies().map(move |body| if looks_at_all(&body) { body } else { own_rows(&body) });
    rows.filter(|rows| !rows.is_empty()).map(|rows| table.of_rows(&rows))
}

impl OtherRows {
    /// Starts again, with these blocks of this rank among `count`.
    pub fn begin(&mut self, own: impl Iterator<Item = Range<usize>>, count: usize) {
        self.own.clear();
        self.own.extend(own);
        let others = count - self.own.iter().map(Range::len).sum::<usize>();
        self.cut = ranks::cut();
        self.found.clear();
        self.found.resize_with(if others > 0 { count } else { 0 }, OnceLock::new);
    }

    /// Whether loops are divided as they were when the lists were built.
    pub fn is_current(&self) -> bool {
        self.cut == ranks::cut()
    }

    /// The blocks of this rank, ascending.
    pub fn own(&self) -> &[Range<usize>] {
        &self.own
    }

    /// Whether this rank has the list of a block.
    #[inline(always)]
    pub fn is_own(&self, block: usize) -> bool {
        self.found.is_empty() || self.own.iter().any(|own| own.contains(&block))
    }
}
