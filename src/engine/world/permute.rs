//! Rows of a phase in another order.

use std::ops::Range;

use super::state::PhaseView;

impl PhaseView<'_> {
    /// Puts rows into another order, in all columns: row n of the range becomes what was row `order[n]` of
    /// it. `scratch` is memory that the caller keeps.
    pub fn permute(&self, rows: Range<usize>, order: &[u32], scratch: &mut Vec<u8>) {
        for column in self.columns().iter() {
            let size = column.element_size;
            self.write_bytes(column, &mut |bytes| {
                let part = &mut bytes[rows.start * size..rows.end * size];
                scratch.clear();
                scratch.extend_from_slice(part);
                for (row, &from) in part.chunks_exact_mut(size).zip(order) {
                    let from = from as usize * size;
                    row.copy_from_slice(&scratch[from..from + size]);
                }
            });
        }
    }
}
