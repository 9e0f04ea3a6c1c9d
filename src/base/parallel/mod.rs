//! Parallel loops whose results do not depend on the number of threads, and the instruction path of hot
//! loops.

mod arithmetic;
mod block_loop;
mod blocks;
mod dimension;
mod eight;
mod four;
mod lanes;
mod maximum;
mod number;
mod own;
mod path;
mod picked;
mod plane;
mod vector;

pub use arithmetic::{Arithmetic, EightLanes, FourLanes};
pub use block_loop::{BlockLoop, run_blocks_on};
pub use blocks::{
    BLOCK, BlockSum, Split, block_count, for_each_block, for_each_block_in_tasks, for_each_heavy_block,
    sum_over_blocks,
};
pub use dimension::{PlaneOrSpace, run_hot_in};
pub use lanes::{EIGHT, Lanes4, Lanes8};
pub use maximum::Maximum;
pub use number::Number;
pub use own::{
    for_each_own_block, for_each_own_block_in_tasks, others_rows, own_part, own_rows, share_part,
    share_picked, share_rows, share_rows_of, share_wide_rows, sum_over_own_blocks,
};
pub use path::{HotLoop, PathError, have_same_bits, instruction_path, run_hot, take_instruction_path};
pub use picked::Picked;
pub use plane::run_hot_on;
pub use vector::{Matrix, Vector};

pub use crate::split_by_rows;
