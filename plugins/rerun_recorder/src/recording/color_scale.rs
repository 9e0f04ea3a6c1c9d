//! Which value has which colour: the range of a colour scale, given or found while the run goes on.

/// The values at the two ends of a colour scale.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ColorScale {
    /// Value at the lower end.
    pub low: f64,
    /// Value at the upper end.
    pub high: f64,
    /// Whether zero is in the middle.
    pub diverging: bool,
}

impl ColorScale {
    /// Place of a value on the scale: 0 at the lower end, 1 at the upper end.
    pub fn fraction(&self, value: f64) -> f64 {
        let width = self.high - self.low;
        if width > 0.0 { (value - self.low) / width } else { 0.0 }
    }

    /// The narrowest scale with round ends that holds all values from `min` to `max`. It starts at zero if
    /// that is near, and is symmetric if the values lie on both sides of it.
    pub fn around(min: f64, max: f64) -> Self {
        let size = min.abs().max(max.abs());
        let width = max - min;
        if width <= 1e-9 * size {
            return Self { low: min, high: min, diverging: false };
        }
        if min >= -NEGLIGIBLE * size && min < 0.5 * max {
            return Self { low: 0.0, high: round_up(max), diverging: false };
        }
        if max <= NEGLIGIBLE * size && max > 0.5 * min {
            return Self { low: -round_up(-min), high: 0.0, diverging: false };
        }
        if min < 0.0 && max > 0.0 {
            return Self { low: -round_up(size), high: round_up(size), diverging: true };
        }
        let step = round_up(width / 4.0);
        Self { low: (min / step).floor() * step, high: (max / step).ceil() * step, diverging: false }
    }
}

/// A side of zero on which no value is larger than this share of the largest is left out of the scale.
const NEGLIGIBLE: f64 = 0.05;

/// Mantissas of round numbers: a quarter of each is short, too.
const ROUND: [f64; 10] = [1.0, 1.2, 1.6, 2.0, 2.4, 3.0, 4.0, 5.0, 6.0, 8.0];

fn round_up(x: f64) -> f64 {
    let decade = 10f64.powf(x.log10().floor());
    let fits = ROUND.iter().map(|mantissa| mantissa * decade).find(|round| x <= round * (1.0 + 1e-9));
    fits.unwrap_or(10.0 * decade)
}

/// The share of the particles at either end that an automatic scale may leave outside: single particles at a
/// corner or a point load would else take all colours from the rest.
const OUTSIDE: f64 = 0.005;

/// The colour scale of a run.
#[derive(Clone, Debug)]
pub struct RunningScale {
    fixed: Option<ColorScale>,
    seen: Option<(f64, f64)>,
    /// Ends of the values of the last frame.
    last: Option<(f64, f64)>,
}

impl RunningScale {
    /// A scale with given ends, or one that grows with the values.
    pub fn new(range: Option<(f64, f64)>) -> Self {
        let fixed = range.map(|(low, high)| ColorScale { low, high, diverging: low == -high });
        Self { fixed, seen: None, last: None }
    }

    /// The scale for a frame with these values. An automatic scale only grows, so that a colour means the
    /// same in all frames from the one with the largest values on; it grows to what two frames in a row have
    /// reached, so that one impact does not take the colours from all the rest.
    pub fn update(&mut self, values: &mut Vec<f64>) -> ColorScale {
        if let Some(fixed) = self.fixed {
            return fixed;
        }
        values.retain(|value| value.is_finite());
        if !values.is_empty() {
            let last = values.len() - 1;
            let outside = (OUTSIDE * last as f64) as usize;
            let min = *values.select_nth_unstable_by(outside, f64::total_cmp).1;
            let max = *values.select_nth_unstable_by(last - outside, f64::total_cmp).1;
            let last = self.last.replace((min, max)).unwrap_or((min, max));
            let held = (last.0.max(min), last.1.min(max));
            self.seen = Some(self.seen.map_or(held, |(low, high)| (low.min(held.0), high.max(held.1))));
        }
        self.seen.map_or_else(ColorScale::default, |(min, max)| ColorScale::around(min, max))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ends(min: f64, max: f64) -> (f64, f64, bool) {
        let ColorScale { low, high, diverging } = ColorScale::around(min, max);
        (low, high, diverging)
    }

    #[test]
    fn scales_have_round_ends_and_start_at_zero_where_it_is_near() {
        assert_eq!(ends(0.0, 103.0e3), (0.0, 120.0e3, false));
        assert_eq!(ends(20.0, 100.0), (0.0, 100.0, false));
        assert_eq!(ends(-1.0, 100.0), (0.0, 100.0, false));
        assert_eq!(ends(-730.0, -3.0), (-800.0, 0.0, false));
        assert_eq!(ends(-70.0, 30.0), (-80.0, 80.0, true));
        assert_eq!(ends(991.0, 1012.0), (990.0, 1014.0, false));
        assert_eq!(ends(5.0, 5.0), (5.0, 5.0, false));
    }

    #[test]
    fn an_automatic_scale_only_grows_and_leaves_out_single_particles() {
        let mut scale = RunningScale::new(None);
        let mut many: Vec<f64> = (0..1000).map(f64::from).collect();
        many.push(1e9);
        many.push(f64::NAN);
        let first = scale.update(&mut many);
        assert_eq!((first.low, first.high), (0.0, 1000.0));
        assert_eq!(scale.update(&mut vec![0.0, 1.0]), first);
        assert_eq!(scale.update(&mut Vec::new()), first);
    }

    #[test]
    fn an_impact_of_one_frame_does_not_widen_the_scale() {
        let mut scale = RunningScale::new(None);
        let mut ends = |most: f64| scale.update(&mut vec![0.0, most]).high;
        assert_eq!([ends(10.0), ends(1000.0), ends(8.0), ends(10.0)], [10.0; 4]);
        assert_eq!([ends(100.0), ends(200.0), ends(200.0)], [10.0, 100.0, 200.0]);
    }

    #[test]
    fn a_given_range_stays() {
        let mut scale = RunningScale::new(Some((-2.0, 5.0)));
        let ColorScale { low, high, diverging } = scale.update(&mut vec![1e9]);
        assert_eq!((low, high, diverging), (-2.0, 5.0, false));
        assert!((ColorScale { low, high, diverging }.fraction(1.5) - 0.5).abs() < 1e-15);
    }
}
