//! The definition of a column: one newtype per physical quantity, with name, symbol and unit.

use bytemuck::Pod;
use glam::{DMat3, DVec3};

use crate::linalg::Sym3;
use crate::parallel::{Arithmetic, FourLanes, Lanes4, Matrix, Number, Vector};

/// Value of one row of a column: a number, a vector, a tensor, as a fixed list of components.
pub trait Value: Pod + Send + Sync + 'static {
    /// Names of the components, in the order in which [`Value::component`] counts; `[""]` for a number.
    const COMPONENTS: &'static [&'static str];

    /// The component `k` as a number, `k < COMPONENTS.len()`.
    fn component(&self, k: usize) -> f64;

    /// Four values as hot loops see them: [`Number`], [`Vector`], [`Matrix`].
    type Four<A: Arithmetic>: Copy;

    /// Four values, one a lane.
    fn four<A: FourLanes>(a: A, values: [Self; 4]) -> Self::Four<A>;

    /// Values that are given component by component.
    fn of_components<A: Arithmetic>(a: A, components: &[A::Lanes]) -> Self::Four<A>;

    /// The value of a mirror image, `signs` being those of its axes: S v for a vector, S A S for a tensor, a
    /// number as it is.
    #[must_use]
    #[inline]
    fn mirrored(self, _signs: DVec3) -> Self {
        self
    }
}

impl Value for f64 {
    const COMPONENTS: &'static [&'static str] = &[""];
    type Four<A: Arithmetic> = Number<A>;

    #[inline(always)]
    fn four<A: FourLanes>(a: A, values: [Self; 4]) -> Number<A> {
        Number::new(a, Lanes4(values))
    }

    #[inline(always)]
    fn of_components<A: Arithmetic>(a: A, components: &[A::Lanes]) -> Number<A> {
        Number::new(a, components[0])
    }

    #[inline(always)]
    fn component(&self, _: usize) -> f64 {
        *self
    }
}

impl Value for u32 {
    const COMPONENTS: &'static [&'static str] = &[""];
    type Four<A: Arithmetic> = Number<A>;

    #[inline(always)]
    fn four<A: FourLanes>(a: A, values: [Self; 4]) -> Number<A> {
        let [j, k, l, m] = values;
        Number::new(a, Lanes4([f64::from(j), f64::from(k), f64::from(l), f64::from(m)]))
    }

    #[inline(always)]
    fn of_components<A: Arithmetic>(a: A, components: &[A::Lanes]) -> Number<A> {
        Number::new(a, components[0])
    }

    #[inline(always)]
    fn component(&self, _: usize) -> f64 {
        f64::from(*self)
    }
}

impl Value for u64 {
    const COMPONENTS: &'static [&'static str] = &[""];
    type Four<A: Arithmetic> = Number<A>;

    #[inline(always)]
    fn four<A: FourLanes>(a: A, values: [Self; 4]) -> Number<A> {
        let [j, k, l, m] = values;
        Number::new(a, Lanes4([j as f64, k as f64, l as f64, m as f64]))
    }

    #[inline(always)]
    fn of_components<A: Arithmetic>(a: A, components: &[A::Lanes]) -> Number<A> {
        Number::new(a, components[0])
    }

    #[inline(always)]
    fn component(&self, _: usize) -> f64 {
        *self as f64
    }
}

impl Value for DVec3 {
    const COMPONENTS: &'static [&'static str] = &["x", "y", "z"];
    type Four<A: Arithmetic> = Vector<A>;

    #[inline(always)]
    fn four<A: FourLanes>(a: A, values: [Self; 4]) -> Vector<A> {
        Vector::from_rows(a, values)
    }

    #[inline(always)]
    fn of_components<A: Arithmetic>(a: A, components: &[A::Lanes]) -> Vector<A> {
        Vector::new(a, [components[0], components[1], components[2]])
    }

    #[inline(always)]
    fn component(&self, k: usize) -> f64 {
        self[k]
    }

    #[inline]
    fn mirrored(self, signs: DVec3) -> Self {
        signs * self
    }
}

impl Value for DMat3 {
    const COMPONENTS: &'static [&'static str] = &["xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"];
    type Four<A: Arithmetic> = Matrix<A>;

    #[inline(always)]
    fn four<A: FourLanes>(a: A, [j, k, l, m]: [Self; 4]) -> Matrix<A> {
        Matrix([
            Vector::from_rows(a, [j.x_axis, k.x_axis, l.x_axis, m.x_axis]),
            Vector::from_rows(a, [j.y_axis, k.y_axis, l.y_axis, m.y_axis]),
            Vector::from_rows(a, [j.z_axis, k.z_axis, l.z_axis, m.z_axis]),
        ])
    }

    #[inline(always)]
    fn of_components<A: Arithmetic>(a: A, components: &[A::Lanes]) -> Matrix<A> {
        let [xx, xy, xz] = [components[0], components[1], components[2]];
        let [yx, yy, yz] = [components[3], components[4], components[5]];
        let [zx, zy, zz] = [components[6], components[7], components[8]];
        Matrix([Vector::new(a, [xx, yx, zx]), Vector::new(a, [xy, yy, zy]), Vector::new(a, [xz, yz, zz])])
    }

    #[inline(always)]
    fn component(&self, k: usize) -> f64 {
        self.col(k % 3)[k / 3]
    }

    #[inline]
    fn mirrored(self, signs: DVec3) -> Self {
        let column = |axis: usize| self.col(axis) * signs * signs[axis];
        DMat3::from_cols(column(0), column(1), column(2))
    }
}

impl Value for Sym3 {
    const COMPONENTS: &'static [&'static str] = &["xx", "yy", "zz", "xy", "xz", "yz"];
    type Four<A: Arithmetic> = [Number<A>; 6];

    #[inline(always)]
    fn four<A: FourLanes>(a: A, [j, k, l, m]: [Self; 4]) -> [Number<A>; 6] {
        [
            Number::new(a, Lanes4([j.xx, k.xx, l.xx, m.xx])),
            Number::new(a, Lanes4([j.yy, k.yy, l.yy, m.yy])),
            Number::new(a, Lanes4([j.zz, k.zz, l.zz, m.zz])),
            Number::new(a, Lanes4([j.xy, k.xy, l.xy, m.xy])),
            Number::new(a, Lanes4([j.xz, k.xz, l.xz, m.xz])),
            Number::new(a, Lanes4([j.yz, k.yz, l.yz, m.yz])),
        ]
    }

    #[inline(always)]
    fn of_components<A: Arithmetic>(a: A, components: &[A::Lanes]) -> [Number<A>; 6] {
        let mut numbers = [Number::zero(a); 6];
        for k in 0..6 {
            numbers[k] = Number::new(a, components[k]);
        }
        numbers
    }

    #[inline(always)]
    fn component(&self, k: usize) -> f64 {
        [self.xx, self.yy, self.zz, self.xy, self.xz, self.yz][k]
    }

    #[inline]
    fn mirrored(self, signs: DVec3) -> Self {
        let DVec3 { x, y, z } = signs;
        Self { xy: x * y * self.xy, xz: x * z * self.xz, yz: y * z * self.yz, ..self }
    }
}

/// A component column: every particle of a phase that has the column holds one value of it.
///
/// Declare one with [`column!`](crate::column).
pub trait Column: Pod + Send + Sync + 'static {
    /// Type of one row.
    type Value: Value;
    /// Name used in scenes, recordings and errors, such as `velocity`.
    const NAME: &'static str;
    /// Symbol used in formulas, such as `v`.
    const SYMBOL: &'static str;
    /// Unit in SI, such as `m/s`; `1` for a pure number.
    const UNIT: &'static str;
    /// Description, from its documentation.
    const ABOUT: &'static str;

    /// The value of the row.
    fn value(&self) -> &Self::Value;

    /// The row of a mirror image (see [`Value::mirrored`]); a position it does not fit.
    #[must_use]
    fn mirrored(self, signs: DVec3) -> Self;
}

/// Declares a column: a transparent newtype with name, symbol and unit.
///
/// ```
/// use meshless_engine::column;
///
/// column! {
///     /// Temperature of the particle.
///     pub struct Temperature(f64) = "temperature", "T", "K";
/// }
/// ```
#[macro_export]
macro_rules! column {
    ($($(#[doc = $doc:literal])* pub struct $name:ident($value:ty) = $label:literal, $symbol:literal, $unit:literal;)+) => {$(
        $(#[doc = $doc])*
        ///
        #[doc = concat!("Column `", $label, "`: symbol ", $symbol, ", unit ", $unit, ".")]
        #[derive(Clone, Copy, Debug, Default, PartialEq, $crate::bytemuck::Pod, $crate::bytemuck::Zeroable)]
        #[bytemuck(crate = "::meshless_engine::bytemuck")]
        #[repr(transparent)]
        pub struct $name(pub $value);

        impl $crate::world::Column for $name {
            type Value = $value;
            const NAME: &'static str = $label;
            const SYMBOL: &'static str = $symbol;
            const UNIT: &'static str = $unit;
            const ABOUT: &'static str = concat!($($doc),*);

            #[inline(always)]
            fn value(&self) -> &$value {
                &self.0
            }

            #[inline]
            fn mirrored(self, signs: $crate::glam::DVec3) -> Self {
                Self($crate::world::Value::mirrored(self.0, signs))
            }
        }
    )+};
}
