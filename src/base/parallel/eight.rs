//! Instruction paths of eight lanes of single precision, in which a lane is a particle of a block.

use super::arithmetic::{Arithmetic, EightLanes, Portable};
use super::lanes::{EIGHT, Lanes8};

/// An instruction path with eight lanes of single precision.
#[derive(Clone, Copy)]
pub struct Eight<A>(pub(super) A);

macro_rules! lane_by_lane {
    ($k:ident => $value:expr) => {
        Lanes8([
            {
                const $k: usize = 0;
                $value
            },
            {
                const $k: usize = 1;
                $value
            },
            {
                const $k: usize = 2;
                $value
            },
            {
                const $k: usize = 3;
                $value
            },
            {
                const $k: usize = 4;
                $value
            },
            {
                const $k: usize = 5;
                $value
            },
            {
                const $k: usize = 6;
                $value
            },
            {
                const $k: usize = 7;
                $value
            },
        ])
    };
}

mod portable {
    use super::{Arithmetic, EIGHT, Eight, EightLanes, Lanes8, Portable};

    impl Arithmetic for Eight<Portable> {
        type Lanes = Lanes8;

        #[inline(always)]
        fn splat(self, value: f64) -> Lanes8 {
            Lanes8([value as f32; EIGHT])
        }

        #[inline(always)]
        fn sum(self, a: Lanes8) -> f64 {
            a.sum()
        }

        #[inline(always)]
        fn add(self, a: Lanes8, b: Lanes8) -> Lanes8 {
            lane_by_lane!(K => a.0[K] + b.0[K])
        }

        #[inline(always)]
        fn sub(self, a: Lanes8, b: Lanes8) -> Lanes8 {
            lane_by_lane!(K => a.0[K] - b.0[K])
        }

        #[inline(always)]
        fn mul(self, a: Lanes8, b: Lanes8) -> Lanes8 {
            lane_by_lane!(K => a.0[K] * b.0[K])
        }

        #[inline(always)]
        fn div(self, a: Lanes8, b: Lanes8) -> Lanes8 {
            lane_by_lane!(K => a.0[K] / b.0[K])
        }

        #[inline(always)]
        fn min(self, a: Lanes8, b: Lanes8) -> Lanes8 {
            lane_by_lane!(K => if a.0[K] < b.0[K] { a.0[K] } else { b.0[K] })
        }

        #[inline(always)]
        fn max(self, a: Lanes8, b: Lanes8) -> Lanes8 {
            lane_by_lane!(K => if a.0[K] > b.0[K] { a.0[K] } else { b.0[K] })
        }

        #[inline(always)]
        fn where_below(self, a: Lanes8, b: Lanes8, c: Lanes8) -> Lanes8 {
            lane_by_lane!(K => if a.0[K] < b.0[K] { c.0[K] } else { 0.0 })
        }

        #[inline(always)]
        fn below(self, a: Lanes8, b: Lanes8) -> usize {
            let mut bits = 0;
            for k in 0..EIGHT {
                bits |= usize::from(a.0[k] < b.0[k]) << k;
            }
            bits
        }

        #[inline(always)]
        fn mul_add(self, a: Lanes8, b: Lanes8, c: Lanes8) -> Lanes8 {
            if cfg!(target_arch = "aarch64") {
                lane_by_lane!(K => a.0[K].mul_add(b.0[K], c.0[K]))
            } else {
                lane_by_lane!(K => a.0[K] * b.0[K] + c.0[K])
            }
        }

        #[inline(always)]
        fn sqrt(self, a: Lanes8) -> Lanes8 {
            lane_by_lane!(K => a.0[K].sqrt())
        }

        #[inline(always)]
        fn max_zero(self, a: Lanes8) -> Lanes8 {
            lane_by_lane!(K => if a.0[K] > 0.0 { a.0[K] } else { 0.0 })
        }
    }

    impl EightLanes for Eight<Portable> {
        #[inline(always)]
        fn same(self, value: f32) -> Lanes8 {
            Lanes8([value; EIGHT])
        }

        #[inline(always)]
        fn apart(self, j: i32, i: [i32; EIGHT]) -> Lanes8 {
            lane_by_lane!(K => j.wrapping_sub(i[K]) as f32)
        }
    }
}

#[cfg(target_arch = "x86_64")]
mod v3 {
    use bytemuck::cast;
    use pulp::x86::V3;
    use pulp::{f32x8, i32x8};

    use super::{Arithmetic, EIGHT, Eight, EightLanes, Lanes8};

    /// AVX2 and FMA.
    impl Arithmetic for Eight<V3> {
        type Lanes = Lanes8;

        #[inline(always)]
        fn splat(self, value: f64) -> Lanes8 {
            cast::<f32x8, Lanes8>(self.0.splat_f32x8(value as f32))
        }

        #[inline(always)]
        fn sum(self, a: Lanes8) -> f64 {
            a.sum()
        }

        #[inline(always)]
        fn add(self, a: Lanes8, b: Lanes8) -> Lanes8 {
            cast::<f32x8, Lanes8>(self.0.add_f32x8(cast(a), cast(b)))
        }

        #[inline(always)]
        fn sub(self, a: Lanes8, b: Lanes8) -> Lanes8 {
            cast::<f32x8, Lanes8>(self.0.sub_f32x8(cast(a), cast(b)))
        }

        #[inline(always)]
        fn mul(self, a: Lanes8, b: Lanes8) -> Lanes8 {
            cast::<f32x8, Lanes8>(self.0.mul_f32x8(cast(a), cast(b)))
        }

        #[inline(always)]
        fn div(self, a: Lanes8, b: Lanes8) -> Lanes8 {
            cast(self.0.avx._mm256_div_ps(cast(a), cast(b)))
        }

        #[inline(always)]
        fn min(self, a: Lanes8, b: Lanes8) -> Lanes8 {
            cast(self.0.avx._mm256_min_ps(cast(a), cast(b)))
        }

        #[inline(always)]
        fn max(self, a: Lanes8, b: Lanes8) -> Lanes8 {
            cast(self.0.avx._mm256_max_ps(cast(a), cast(b)))
        }

        #[inline(always)]
        fn where_below(self, a: Lanes8, b: Lanes8, c: Lanes8) -> Lanes8 {
            let mask = self.0.cmp_lt_f32x8(cast(a), cast(b));
            cast(self.0.avx._mm256_and_ps(cast(mask), cast(c)))
        }

        #[inline(always)]
        fn below(self, a: Lanes8, b: Lanes8) -> usize {
            self.0.avx._mm256_movemask_ps(cast(self.0.cmp_lt_f32x8(cast(a), cast(b)))) as usize
        }

        #[inline(always)]
        fn mul_add(self, a: Lanes8, b: Lanes8, c: Lanes8) -> Lanes8 {
            cast::<f32x8, Lanes8>(self.0.mul_add_f32x8(cast(a), cast(b), cast(c)))
        }

        #[inline(always)]
        fn sqrt(self, a: Lanes8) -> Lanes8 {
            cast(self.0.avx._mm256_sqrt_ps(cast(a)))
        }

        #[inline(always)]
        fn max_zero(self, a: Lanes8) -> Lanes8 {
            // If an operand is NaN, the instruction returns the second one, zero.
            cast(self.0.avx._mm256_max_ps(cast(a), cast(Lanes8::ZERO)))
        }
    }

    impl EightLanes for Eight<V3> {
        #[inline(always)]
        fn same(self, value: f32) -> Lanes8 {
            cast::<f32x8, Lanes8>(self.0.splat_f32x8(value))
        }

        #[inline(always)]
        fn apart(self, j: i32, i: [i32; EIGHT]) -> Lanes8 {
            let apart: i32x8 = self.0.wrapping_sub_i32x8(self.0.splat_i32x8(j), cast(i));
            cast::<f32x8, Lanes8>(self.0.convert_i32x8_to_f32x8(apart))
        }
    }
}
