//! The instruction path: one binary runs on any x86-64 machine and uses AVX2 and FMA where the processor has them.
//!
//! A hot loop is written once, generic over [`FourLanes`], and compiled for both paths. The two differ in the last
//! bits (a fused multiply-add rounds once), so the path is part of a checkpoint.

use super::arithmetic::{FourLanes, Portable};

/// A loop that is compiled once for every instruction path.
///
/// Everything that [`HotLoop::run`] calls must be `#[inline(always)]`, or it stays behind on the portable path.
pub trait HotLoop {
    /// What the loop returns.
    type Output;
    /// The loop.
    fn run<A: FourLanes>(self, arithmetic: A) -> Self::Output;
}

#[cfg(target_arch = "x86_64")]
mod detected {
    use std::sync::OnceLock;

    use pulp::NullaryFnOnce;
    use pulp::x86::V3;

    use super::{HotLoop, Portable};

    struct WithV3<L>(L, V3);

    impl<L: HotLoop> NullaryFnOnce for WithV3<L> {
        type Output = L::Output;

        #[inline(always)]
        fn call(self) -> L::Output {
            self.0.run(self.1)
        }
    }

    fn v3() -> Option<V3> {
        static V3_PATH: OnceLock<Option<V3>> = OnceLock::new();
        *V3_PATH.get_or_init(V3::try_new)
    }

    pub fn run<L: HotLoop>(hot: L) -> L::Output {
        match v3() {
            Some(v3) => v3.vectorize(WithV3(hot, v3)),
            None => hot.run(Portable),
        }
    }

    pub fn name() -> &'static str {
        if v3().is_some() { "x86-64-v3" } else { "x86-64" }
    }
}

#[cfg(not(target_arch = "x86_64"))]
mod detected {
    use super::{HotLoop, Portable};

    pub fn run<L: HotLoop>(hot: L) -> L::Output {
        hot.run(Portable)
    }

    pub fn name() -> &'static str {
        std::env::consts::ARCH
    }
}

/// Runs a hot loop on the best path of this processor.
pub fn run_hot<L: HotLoop>(hot: L) -> L::Output {
    detected::run(hot)
}

/// Name of the instruction path in use, such as `x86-64-v3`.
pub fn instruction_path() -> &'static str {
    detected::name()
}
