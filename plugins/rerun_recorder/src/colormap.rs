//! Colour maps: a number between 0 and 1 becomes a colour.
//!
//! The tables are every fifteenth of the 256 colours of the published maps; between them colours are
//! interpolated.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A colour map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
pub enum Colormap {
    /// Dark violet to yellow, perceptually uniform (S. van der Walt, N. Smith, 2015).
    Viridis,
    /// Black to light yellow, perceptually uniform (S. van der Walt, N. Smith, 2015).
    Inferno,
    /// Blue to red through the rainbow, smooth (A. Mikhailov, 2019).
    Turbo,
    /// Blue to red through grey: zero is in the middle (K. Moreland, 2009).
    CoolWarm,
    /// Light blue to light red through black: zero is in the middle, and stands out from a light background
    /// (F. Crameri, 2018).
    Berlin,
}

const POINTS: usize = 18;

type Table = [[u8; 3]; POINTS];

impl Colormap {
    /// The colour of `fraction`; below 0 and above 1 that of the end.
    pub fn color(self, fraction: f64) -> [u8; 3] {
        let table = match self {
            Self::Viridis => &VIRIDIS,
            Self::Inferno => &INFERNO,
            Self::Turbo => &TURBO,
            Self::CoolWarm => &COOL_WARM,
            Self::Berlin => &BERLIN,
        };
        let place = fraction.clamp(0.0, 1.0) * (POINTS - 1) as f64;
        let k = (place as usize).min(POINTS - 2);
        let t = place - k as f64;
        std::array::from_fn(|c| {
            let (a, b) = (f64::from(table[k][c]), f64::from(table[k + 1][c]));
            (a + (b - a) * t).round() as u8
        })
    }
}

#[rustfmt::skip]
const VIRIDIS: Table = [
    [68, 1, 84], [72, 23, 105], [71, 42, 122], [67, 61, 132], [61, 78, 138], [53, 94, 141],
    [46, 109, 142], [41, 123, 142], [35, 137, 142], [31, 151, 139], [33, 165, 133], [46, 179, 124],
    [70, 192, 111], [101, 203, 94], [137, 213, 72], [176, 221, 47], [216, 226, 25], [253, 231, 37],
];

#[rustfmt::skip]
const INFERNO: Table = [
    [0, 0, 4], [10, 7, 34], [30, 12, 69], [56, 9, 98], [81, 14, 108], [105, 22, 110],
    [128, 31, 108], [152, 39, 102], [176, 49, 91], [198, 61, 77], [217, 77, 61], [233, 97, 43],
    [244, 121, 24], [250, 148, 7], [252, 176, 20], [248, 205, 55], [242, 234, 105], [252, 255, 164],
];

#[rustfmt::skip]
const TURBO: Table = [
    [48, 18, 59], [63, 62, 156], [70, 102, 221], [69, 140, 253], [47, 178, 244], [26, 212, 208],
    [34, 235, 170], [82, 250, 122], [139, 255, 75], [183, 247, 53], [219, 226, 54], [245, 197, 58],
    [254, 161, 48], [249, 117, 29], [232, 75, 12], [206, 45, 4], [169, 22, 1], [122, 4, 3],
];

#[rustfmt::skip]
const COOL_WARM: Table = [
    [59, 76, 192], [76, 102, 214], [95, 127, 232], [115, 150, 245], [136, 171, 253], [157, 189, 255],
    [177, 203, 252], [196, 213, 243], [213, 219, 229], [228, 217, 210], [240, 205, 187], [246, 190, 164],
    [247, 170, 140], [243, 148, 117], [233, 122, 95], [220, 93, 74], [202, 59, 55], [180, 4, 38],
];

#[rustfmt::skip]
const BERLIN: Table = [
    [158, 176, 255], [123, 172, 238], [86, 162, 215], [57, 139, 180], [43, 111, 143], [32, 84, 108],
    [23, 58, 75], [17, 35, 44], [18, 18, 20], [33, 11, 3], [51, 15, 0], [72, 21, 2],
    [99, 33, 12], [132, 57, 36], [162, 85, 68], [192, 113, 101], [223, 143, 137], [255, 173, 173],
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_and_middle_are_those_of_the_published_maps() {
        assert_eq!(Colormap::Viridis.color(0.0), [68, 1, 84]);
        assert_eq!(Colormap::Viridis.color(1.0), [253, 231, 37]);
        assert_eq!(Colormap::Viridis.color(7.0), [253, 231, 37]);
        let published = [33, 145, 140];
        for (ours, theirs) in Colormap::Viridis.color(0.502).into_iter().zip(published) {
            assert!(ours.abs_diff(theirs) <= 2, "{ours} {theirs}");
        }
    }

    #[test]
    fn viridis_grows_lighter_all_the_way() {
        let light = |k: i32| {
            let [r, g, b] = Colormap::Viridis.color(f64::from(k) / 50.0).map(f64::from);
            0.2126 * r + 0.7152 * g + 0.0722 * b
        };
        assert!((0..50).all(|k| light(k + 1) > light(k)));
    }

    #[test]
    fn the_middle_of_the_map_of_signed_values_stands_out_from_the_background_and_from_plain_bodies() {
        let light =
            |[r, g, b]: [u8; 3]| 0.2126 * f64::from(r) + 0.7152 * f64::from(g) + 0.0722 * f64::from(b);
        let background = light([236, 238, 241]);
        assert!(background - light(Colormap::CoolWarm.color(0.5)) < 30.0, "it vanishes there");
        assert!(background - light(Colormap::Berlin.color(0.5)) > 150.0);
    }
}
