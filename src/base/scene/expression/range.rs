//! Bounds of the values of an expression over an interval of time, by interval arithmetic: no pulse between
//! two times escapes them, however short it is.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::Expression;
use super::compile::{MAX_STACK, Op};
use super::functions::{Binary, BinaryKind, Course, Unary};
use crate::scene::table::Interpolation;

/// The values of an argument lie between the two, in order.
type Range = [f64; 2];

const UNBOUNDED: Range = [f64::NEG_INFINITY, f64::INFINITY];

impl Expression {
    /// Bounds of the values at position `x` \[m\] between two times \[s\]; infinite where nothing is known.
    /// They may be wider than the values: each occurrence of the time counts as if it were another variable.
    pub fn range_over_time(&self, x: DVec3, times: [f64; 2]) -> [f64; 2] {
        let variables = [[x.x; 2], [x.y; 2], [x.z; 2], times];
        let mut stack = [[0.0; 2]; MAX_STACK];
        let mut top = 0;
        for op in &self.program.ops {
            match *op {
                Op::Constant(value) => {
                    stack[top] = [value; 2];
                    top += 1;
                }
                Op::Variable(index) => {
                    stack[top] = variables[index];
                    top += 1;
                }
                Op::Unary(function) => stack[top - 1] = of_one(function, stack[top - 1]),
                Op::Table(index) => stack[top - 1] = of_table(&self.program.tables[index], stack[top - 1]),
                Op::Binary(function) => {
                    top -= 1;
                    stack[top - 1] = of_two(function, stack[top - 1], stack[top]);
                }
            }
        }
        stack[0]
    }
}

/// The smallest and the largest of values; unbounded if one of them is no number.
fn around(values: impl IntoIterator<Item = f64>) -> Range {
    let start = [f64::INFINITY, f64::NEG_INFINITY];
    values.into_iter().fold(start, |range, value| {
        if value.is_nan() { UNBOUNDED } else { [range[0].min(value), range[1].max(value)] }
    })
}

/// Whether `place` plus a multiple of `period` is within the range.
fn meets(range: Range, place: f64, period: f64) -> bool {
    ((range[0] - place) / period).ceil() <= ((range[1] - place) / period).floor()
}

fn of_one(function: Unary, range: Range) -> Range {
    let mut ends = around(range.map(function.at));
    match function.course {
        Course::Monotonic => {}
        Course::Even if range[0] < 0.0 && range[1] > 0.0 => ends[0] = (function.at)(0.0),
        Course::Even => {}
        Course::Wave(_) if !(range[0].is_finite() && range[1].is_finite()) => return [-1.0, 1.0],
        Course::Wave(top) => {
            if meets(range, top, TAU) {
                ends[1] = 1.0;
            }
            if meets(range, top + PI, TAU) {
                ends[0] = -1.0;
            }
        }
        Course::Poles if range[0] == range[1] => {}
        Course::Poles => return UNBOUNDED,
    }
    ends
}

fn of_two(function: Binary, a: Range, b: Range) -> Range {
    let corners = || {
        let pairs = [(a[0], b[0]), (a[0], b[1]), (a[1], b[0]), (a[1], b[1])];
        around(pairs.map(|(a, b)| (function.at)(a, b)))
    };
    let single = b[0] == b[1];
    match function.kind {
        BinaryKind::Monotonic => corners(),
        BinaryKind::Quotient if b[0] > 0.0 || b[1] < 0.0 => corners(),
        BinaryKind::Power if a[0] > 0.0 || a[0] == 0.0 && b[0] > 0.0 => corners(),
        BinaryKind::Power if single && b[0] >= 0.0 && b[0].fract() == 0.0 => {
            let mut range = corners();
            if a[0] < 0.0 && a[1] > 0.0 && b[0] > 0.0 && b[0] % 2.0 == 0.0 {
                range[0] = 0.0;
            }
            range
        }
        BinaryKind::Angle if b[0] > 0.0 => corners(),
        BinaryKind::Angle => [-PI, PI],
        BinaryKind::Remainder if single && b[0] != 0.0 => {
            let period = b[0].abs();
            if (a[0] / period).floor() == (a[1] / period).floor() { corners() } else { [0.0, period] }
        }
        BinaryKind::Quotient | BinaryKind::Power | BinaryKind::Remainder => UNBOUNDED,
    }
}

/// The values of a table lie between those at its points and at the ends of the range.
fn of_table(table: &Interpolation, range: Range) -> Range {
    let inside = table.values_between(range[0], range[1]);
    around(range.map(|x| table.at(x)).into_iter().chain(inside))
}
