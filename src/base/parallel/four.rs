//! Instruction paths of four lanes of double precision.

use super::arithmetic::{Arithmetic, FourLanes, Portable};
use super::eight::Eight;
use super::lanes::Lanes4;

impl Arithmetic for Portable {
    type Lanes = Lanes4;

    #[inline(always)]
    fn splat(self, value: f64) -> Lanes4 {
        Lanes4([value; 4])
    }

    #[inline(always)]
    fn sum(self, a: Lanes4) -> f64 {
        a.sum()
    }

    #[inline(always)]
    fn add(self, a: Lanes4, b: Lanes4) -> Lanes4 {
        Lanes4([a.0[0] + b.0[0], a.0[1] + b.0[1], a.0[2] + b.0[2], a.0[3] + b.0[3]])
    }

    #[inline(always)]
    fn sub(self, a: Lanes4, b: Lanes4) -> Lanes4 {
        Lanes4([a.0[0] - b.0[0], a.0[1] - b.0[1], a.0[2] - b.0[2], a.0[3] - b.0[3]])
    }

    #[inline(always)]
    fn mul(self, a: Lanes4, b: Lanes4) -> Lanes4 {
        Lanes4([a.0[0] * b.0[0], a.0[1] * b.0[1], a.0[2] * b.0[2], a.0[3] * b.0[3]])
    }

    #[inline(always)]
    fn div(self, a: Lanes4, b: Lanes4) -> Lanes4 {
        Lanes4([a.0[0] / b.0[0], a.0[1] / b.0[1], a.0[2] / b.0[2], a.0[3] / b.0[3]])
    }

    #[inline(always)]
    fn min(self, a: Lanes4, b: Lanes4) -> Lanes4 {
        Lanes4([
            if a.0[0] < b.0[0] { a.0[0] } else { b.0[0] },
            if a.0[1] < b.0[1] { a.0[1] } else { b.0[1] },
            if a.0[2] < b.0[2] { a.0[2] } else { b.0[2] },
            if a.0[3] < b.0[3] { a.0[3] } else { b.0[3] },
        ])
    }

    #[inline(always)]
    fn max(self, a: Lanes4, b: Lanes4) -> Lanes4 {
        Lanes4([
            if a.0[0] > b.0[0] { a.0[0] } else { b.0[0] },
            if a.0[1] > b.0[1] { a.0[1] } else { b.0[1] },
            if a.0[2] > b.0[2] { a.0[2] } else { b.0[2] },
            if a.0[3] > b.0[3] { a.0[3] } else { b.0[3] },
        ])
    }

    #[inline(always)]
    fn where_below(self, a: Lanes4, b: Lanes4, c: Lanes4) -> Lanes4 {
        Lanes4([
            if a.0[0] < b.0[0] { c.0[0] } else { 0.0 },
            if a.0[1] < b.0[1] { c.0[1] } else { 0.0 },
            if a.0[2] < b.0[2] { c.0[2] } else { 0.0 },
            if a.0[3] < b.0[3] { c.0[3] } else { 0.0 },
        ])
    }

    #[inline(always)]
    fn below(self, a: Lanes4, b: Lanes4) -> usize {
        let bit = |k: usize| usize::from(a.0[k] < b.0[k]) << k;
        bit(0) | bit(1) | bit(2) | bit(3)
    }

    #[inline(always)]
    fn mul_add(self, a: Lanes4, b: Lanes4, c: Lanes4) -> Lanes4 {
        Lanes4([
            self.scalar_mul_add(a.0[0], b.0[0], c.0[0]),
            self.scalar_mul_add(a.0[1], b.0[1], c.0[1]),
            self.scalar_mul_add(a.0[2], b.0[2], c.0[2]),
            self.scalar_mul_add(a.0[3], b.0[3], c.0[3]),
        ])
    }

    #[inline(always)]
    fn sqrt(self, a: Lanes4) -> Lanes4 {
        Lanes4([a.0[0].sqrt(), a.0[1].sqrt(), a.0[2].sqrt(), a.0[3].sqrt()])
    }

    #[inline(always)]
    fn max_zero(self, a: Lanes4) -> Lanes4 {
        Lanes4([above_zero(a.0[0]), above_zero(a.0[1]), above_zero(a.0[2]), above_zero(a.0[3])])
    }
}

impl FourLanes for Portable {
    type Eight = Eight<Self>;

    #[inline(always)]
    fn eight(self) -> Eight<Self> {
        Eight(self)
    }

    #[inline(always)]
    fn scalar_mul_add(self, a: f64, b: f64, c: f64) -> f64 {
        // A fused multiply-add would be a library call where the baseline instruction set lacks it.
        if cfg!(target_arch = "aarch64") { a.mul_add(b, c) } else { a * b + c }
    }

    #[inline(always)]
    fn prefetch<T>(self, _: &[T], _: usize) {}

    #[inline(always)]
    fn pack(self, values: [u32; 4], bits: usize) -> [u32; 4] {
        let mut packed = [0; 4];
        let mut count = 0;
        for (k, value) in values.into_iter().enumerate() {
            packed[count] = value;
            count = (count + (bits >> k & 1)).min(3);
        }
        packed
    }

    #[inline(always)]
    fn transpose(self, [a, b, c, d]: [Lanes4; 4]) -> [Lanes4; 4] {
        [
            Lanes4([a.0[0], b.0[0], c.0[0], d.0[0]]),
            Lanes4([a.0[1], b.0[1], c.0[1], d.0[1]]),
            Lanes4([a.0[2], b.0[2], c.0[2], d.0[2]]),
            Lanes4([a.0[3], b.0[3], c.0[3], d.0[3]]),
        ]
    }
}

#[inline(always)]
fn above_zero(x: f64) -> f64 {
    if x > 0.0 { x } else { 0.0 }
}

#[cfg(target_arch = "x86_64")]
mod v3 {
    use std::arch::x86_64::_MM_HINT_T0;

    use bytemuck::cast;
    use pulp::f64x4;
    use pulp::x86::V3;

    use super::{Arithmetic, Eight, FourLanes, Lanes4};

    /// Size of a cache line of this architecture, bytes.
    const CACHE_LINE: usize = 64;

    /// Byte shuffle for each bit mask, which packs the values whose bits are set.
    const PACKED: [[u8; 16]; 16] = {
        let mut table = [[0x80; 16]; 16];
        let mut bits = 0;
        while bits < 16 {
            let (mut k, mut at) = (0, 0);
            while k < 4 {
                if bits >> k & 1 == 1 {
                    let mut byte = 0;
                    while byte < 4 {
                        table[bits][4 * at + byte] = (4 * k + byte) as u8;
                        byte += 1;
                    }
                    at += 1;
                }
                k += 1;
            }
            bits += 1;
        }
        table
    };

    /// AVX2 and FMA: product and sum are rounded once.
    impl Arithmetic for V3 {
        type Lanes = Lanes4;

        #[inline(always)]
        fn splat(self, value: f64) -> Lanes4 {
            Lanes4([value; 4])
        }

        #[inline(always)]
        fn sum(self, a: Lanes4) -> f64 {
            a.sum()
        }

        #[inline(always)]
        fn add(self, a: Lanes4, b: Lanes4) -> Lanes4 {
            cast::<f64x4, Lanes4>(self.add_f64x4(cast(a), cast(b)))
        }

        #[inline(always)]
        fn sub(self, a: Lanes4, b: Lanes4) -> Lanes4 {
            cast::<f64x4, Lanes4>(self.sub_f64x4(cast(a), cast(b)))
        }

        #[inline(always)]
        fn mul(self, a: Lanes4, b: Lanes4) -> Lanes4 {
            cast::<f64x4, Lanes4>(self.mul_f64x4(cast(a), cast(b)))
        }

        #[inline(always)]
        fn div(self, a: Lanes4, b: Lanes4) -> Lanes4 {
            cast(self.avx._mm256_div_pd(cast(a), cast(b)))
        }

        #[inline(always)]
        fn min(self, a: Lanes4, b: Lanes4) -> Lanes4 {
            cast(self.avx._mm256_min_pd(cast(a), cast(b)))
        }

        #[inline(always)]
        fn max(self, a: Lanes4, b: Lanes4) -> Lanes4 {
            cast(self.avx._mm256_max_pd(cast(a), cast(b)))
        }

        #[inline(always)]
        fn where_below(self, a: Lanes4, b: Lanes4, c: Lanes4) -> Lanes4 {
            let mask = self.cmp_lt_f64x4(cast(a), cast(b));
            cast(self.avx._mm256_and_pd(cast(mask), cast(c)))
        }

        #[inline(always)]
        fn below(self, a: Lanes4, b: Lanes4) -> usize {
            self.avx._mm256_movemask_pd(cast(self.cmp_lt_f64x4(cast(a), cast(b)))) as usize
        }

        #[inline(always)]
        fn mul_add(self, a: Lanes4, b: Lanes4, c: Lanes4) -> Lanes4 {
            cast::<f64x4, Lanes4>(self.mul_add_f64x4(cast(a), cast(b), cast(c)))
        }

        #[inline(always)]
        fn sqrt(self, a: Lanes4) -> Lanes4 {
            cast(self.avx._mm256_sqrt_pd(cast(a)))
        }

        #[inline(always)]
        fn max_zero(self, a: Lanes4) -> Lanes4 {
            // If an operand is NaN, the instruction returns the second one, zero.
            cast::<f64x4, Lanes4>(self.max_f64x4(cast(a), cast(Lanes4::ZERO)))
        }
    }

    impl FourLanes for V3 {
        type Eight = Eight<Self>;

        #[inline(always)]
        fn eight(self) -> Eight<Self> {
            Eight(self)
        }

        #[inline(always)]
        fn scalar_mul_add(self, a: f64, b: f64, c: f64) -> f64 {
            a.mul_add(b, c)
        }

        #[inline(always)]
        fn prefetch<T>(self, rows: &[T], row: usize) {
            let row = rows.as_ptr().wrapping_add(row).cast::<i8>();
            for line in 0..size_of::<T>().div_ceil(CACHE_LINE) {
                self.sse._mm_prefetch::<_MM_HINT_T0>(row.wrapping_add(line * CACHE_LINE));
            }
        }

        #[inline(always)]
        fn pack(self, values: [u32; 4], bits: usize) -> [u32; 4] {
            cast(self.ssse3._mm_shuffle_epi8(cast(values), cast(PACKED[bits & 15])))
        }

        #[inline(always)]
        fn transpose(self, [a, b, c, d]: [Lanes4; 4]) -> [Lanes4; 4] {
            let avx = self.avx;
            let (low_ab, high_ab) =
                (avx._mm256_unpacklo_pd(cast(a), cast(b)), avx._mm256_unpackhi_pd(cast(a), cast(b)));
            let (low_cd, high_cd) =
                (avx._mm256_unpacklo_pd(cast(c), cast(d)), avx._mm256_unpackhi_pd(cast(c), cast(d)));
            [
                cast(avx._mm256_permute2f128_pd::<0x20>(low_ab, low_cd)),
                cast(avx._mm256_permute2f128_pd::<0x20>(high_ab, high_cd)),
                cast(avx._mm256_permute2f128_pd::<0x31>(low_ab, low_cd)),
                cast(avx._mm256_permute2f128_pd::<0x31>(high_ab, high_cd)),
            ]
        }
    }
}
