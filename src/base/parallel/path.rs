//! The instruction path. One binary runs on any x86-64 machine, and uses AVX2 and FMA, or AVX-512, where
//! available.
//!
//! A hot loop is written once, generic over [`FourLanes`], and compiled for every path. A multiply-add rounds
//! once with FMA, so the last bits differ from those of the baseline. AVX-512 adds registers (thirty-two
//! instead of sixteen) and masks. Vector lengths and the order of sums are unchanged, so its results are
//! bitwise those of AVX2.

use std::sync::OnceLock;

use thiserror::Error;

use super::arithmetic::{FourLanes, Portable};

/// A loop that is compiled once for every instruction path.
///
/// Everything that [`HotLoop::run`] calls must be `#[inline(always)]`, or it is compiled for the portable
/// path.
pub trait HotLoop {
    /// Result of the loop.
    type Output;
    /// The loop.
    fn run<A: FourLanes>(self, arithmetic: A) -> Self::Output;
}

/// Error of selecting an instruction path.
#[derive(Debug, Error, PartialEq, Eq)]
pub enum PathError {
    /// No path has that name, or this processor does not have its instructions.
    #[error("this processor has no instruction path `{name}`; it has {}", names())]
    Absent {
        /// The requested name.
        name: String,
    },
    /// Loops have already run on another path.
    #[error("the instruction path is {0} already")]
    Taken(&'static str),
}

#[cfg(target_arch = "x86_64")]
mod paths {
    use pulp::NullaryFnOnce;
    use pulp::x86::{V3, V4};

    use super::{HotLoop, Portable};

    // Inlining compiles a loop in the unit of its caller. Without it the compiler places all hot loops of a
    // crate in one unit, which a single core compiles.

    /// A path supported by this processor.
    #[derive(Clone, Copy)]
    pub enum Path {
        Baseline,
        V3(V3),
        V4(V4),
    }

    struct WithV3<L>(L, V3);

    impl<L: HotLoop> NullaryFnOnce for WithV3<L> {
        type Output = L::Output;

        #[inline(always)]
        fn call(self) -> L::Output {
            self.0.run(self.1)
        }
    }

    impl Path {
        /// The paths supported by this processor, the best one first.
        pub fn all() -> impl Iterator<Item = Self> {
            let wide = V4::try_new().map(Self::V4).into_iter().chain(V3::try_new().map(Self::V3));
            wide.chain([Self::Baseline])
        }

        pub fn name(self) -> &'static str {
            match self {
                Self::Baseline => "x86-64",
                Self::V3(_) => "x86-64-v3",
                Self::V4(_) => "x86-64-v4",
            }
        }

        #[inline]
        pub fn run<L: HotLoop>(self, hot: L) -> L::Output {
            match self {
                Self::Baseline => hot.run(Portable),
                Self::V3(v3) => v3.vectorize(WithV3(hot, v3)),
                Self::V4(v4) => v4.vectorize(WithV3(hot, *v4)),
            }
        }
    }
}

#[cfg(not(target_arch = "x86_64"))]
mod paths {
    use super::{HotLoop, Portable};

    /// The only path.
    #[derive(Clone, Copy)]
    pub struct Path;

    impl Path {
        pub fn all() -> impl Iterator<Item = Self> {
            [Self].into_iter()
        }

        pub fn name(self) -> &'static str {
            std::env::consts::ARCH
        }

        #[inline]
        pub fn run<L: HotLoop>(self, hot: L) -> L::Output {
            hot.run(Portable)
        }
    }
}

use paths::Path;

static PATH: OnceLock<Path> = OnceLock::new();

fn best() -> Path {
    Path::all().next().expect("every processor has the baseline")
}

fn path() -> Path {
    *PATH.get_or_init(best)
}

fn names() -> String {
    Path::all().map(Path::name).collect::<Vec<_>>().join(", ")
}

/// Runs a hot loop on the instruction path of this program.
#[inline]
pub fn run_hot<L: HotLoop>(hot: L) -> L::Output {
    path().run(hot)
}

/// Name of the instruction path in use, such as `x86-64-v3`: the best one supported by this processor, unless
/// another one was selected.
pub fn instruction_path() -> &'static str {
    PATH.get().copied().unwrap_or_else(best).name()
}

/// Selects the instruction path of that name for the whole program, before any loop has run.
///
/// # Errors
/// The processor does not support it, or loops have run on another path.
pub fn take_instruction_path(name: &str) -> Result<(), PathError> {
    let asked = Path::all().find(|path| path.name() == name);
    let asked = asked.ok_or_else(|| PathError::Absent { name: name.to_owned() })?;
    let taken = PATH.get_or_init(|| asked).name();
    if taken == asked.name() { Ok(()) } else { Err(PathError::Taken(taken)) }
}

/// Whether two instruction paths give bitwise equal results.
pub fn have_same_bits(one: &str, other: &str) -> bool {
    let rounding = |path| if path == "x86-64-v4" { "x86-64-v3" } else { path };
    rounding(one) == rounding(other)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_that_the_processor_lacks_is_refused() {
        let error = take_instruction_path("x86-64-v9").expect_err("there is none");
        assert!(error.to_string().contains("`x86-64-v9`; it has "), "{error}");
        assert_eq!(take_instruction_path(instruction_path()), Ok(()));
    }

    #[test]
    fn registers_and_masks_change_no_bits() {
        assert!(have_same_bits("x86-64-v3", "x86-64-v4"));
        assert!(!have_same_bits("x86-64", "x86-64-v4"));
    }
}
