//! The registry of kernels, and the dispatch from a name in a scene to code compiled for that kernel.

use super::profile::KernelProfile;
use super::profiled::ProfiledKernel;
use super::{CubicSpline, QuarticSpline, QuinticSpline, Spiky, WendlandC2, WendlandC4, WendlandC6};
use std::fmt;

/// Code that is compiled once for every kernel, which is inlined in its loops; see
/// [`Kernel::dispatch`](super::Kernel::dispatch).
pub trait KernelVisitor {
    /// Result of the code.
    type Output;

    /// Runs the code with the kernel as a type parameter.
    fn visit<K: KernelProfile>(self, kernel: ProfiledKernel<K>) -> Self::Output;
}

macro_rules! register_kernels {
    ($($profile:ident: $doc:literal),+ $(,)?) => {
        /// Name of a kernel in a scene, for instance `kernel: wendland_c2`.
        #[derive(
            Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize, schemars::JsonSchema,
        )]
        #[serde(rename_all = "snake_case")]
        pub enum KernelName {
            $(#[doc = $doc] $profile,)+
        }

        impl KernelName {
            /// Every kernel, in the order of registration.
            pub const ALL: &[KernelName] = &[$(KernelName::$profile),+];

            /// The name as scenes write it.
            pub const fn as_str(self) -> &'static str {
                match self { $(Self::$profile => $profile::NAME),+ }
            }

            /// Support radius over smoothing length.
            pub const fn support(self) -> f64 {
                match self { $(Self::$profile => $profile::SUPPORT),+ }
            }

            /// Source of the kernel.
            pub const fn reference(self) -> &'static str {
                match self { $(Self::$profile => $profile::REFERENCE),+ }
            }

            /// sigma_d of dimension 1, 2 or 3; `None` for any other.
            pub fn normalisation(self, dimension: usize) -> Option<f64> {
                match self { $(Self::$profile => $profile::normalisation(dimension)),+ }
            }

            /// Runs `visitor` in the version compiled for this kernel of a dimension and its sigma_d.
            #[inline]
            pub(super) fn dispatch<V: KernelVisitor>(
                self,
                dimension: u32,
                normalisation: f64,
                visitor: V,
            ) -> V::Output {
                match self {
                    $(Self::$profile => {
                        visitor.visit(ProfiledKernel::<$profile>::new(dimension, normalisation))
                    })+
                }
            }
        }
    };
}

register_kernels! {
    CubicSpline: "Cubic B-spline, support 2 h.",
    QuarticSpline: "Quartic B-spline, support 2.5 h.",
    QuinticSpline: "Quintic B-spline, support 3 h.",
    WendlandC2: "Wendland C2, support 2 h.",
    WendlandC4: "Wendland C4, support 2 h.",
    WendlandC6: "Wendland C6, support 2 h.",
    Spiky: "Desbrun's spiky kernel, support 2 h.",
}

impl fmt::Display for KernelName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.as_str())
    }
}
