//! Shapes of concentric lattices: discs and rings, cylinders and tubes, balls and hollow spheres.

use glam::DVec3;

/// Shape filled by a concentric lattice.
#[derive(Clone, Copy, Debug)]
pub enum Rings {
    /// A disc or ring in z = 0.
    Plane {
        /// Centre \[m\].
        center: DVec3,
        /// Radius of the hole, 0 for a disc \[m\].
        inner: f64,
        /// Outer radius \[m\].
        outer: f64,
    },
    /// A cylinder or tube.
    Axial {
        /// Centre of one end \[m\].
        from: DVec3,
        /// Centre of the other end \[m\].
        to: DVec3,
        /// Radius of the bore, 0 for a cylinder \[m\].
        inner: f64,
        /// Outer radius \[m\].
        outer: f64,
    },
    /// A ball or hollow sphere.
    Shells {
        /// Centre \[m\].
        center: DVec3,
        /// Radius of the cavity, 0 for a ball \[m\].
        inner: f64,
        /// Outer radius \[m\].
        outer: f64,
    },
}

impl Rings {
    /// The same shape moved by an isometry.
    pub(super) fn moved(self, to: impl Fn(DVec3) -> DVec3) -> Self {
        match self {
            Self::Plane { center, inner, outer } => Self::Plane { center: to(center), inner, outer },
            Self::Axial { from, to: end, inner, outer } => {
                Self::Axial { from: to(from), to: to(end), inner, outer }
            }
            Self::Shells { center, inner, outer } => Self::Shells { center: to(center), inner, outer },
        }
    }

    /// The shape without `hole`, if the hole is solid, concentric, and extends from end to end.
    pub(super) fn bored(self, hole: Self) -> Option<Self> {
        match (self, hole) {
            (
                Self::Plane { center, inner, outer },
                Self::Plane { center: other, inner: 0.0, outer: bore },
            ) => {
                let inner = bored_radius(inner, outer, bore)?;
                (center.distance(other) <= SAME * outer).then_some(Self::Plane { center, inner, outer })
            }
            (
                Self::Shells { center, inner, outer },
                Self::Shells { center: other, inner: 0.0, outer: bore },
            ) => {
                let inner = bored_radius(inner, outer, bore)?;
                (center.distance(other) <= SAME * outer).then_some(Self::Shells { center, inner, outer })
            }
            (
                Self::Axial { from, to, inner, outer },
                Self::Axial { from: first, to: last, inner: 0.0, outer: bore },
            ) => {
                let inner = bored_radius(inner, outer, bore)?;
                let (axis, tolerance) = ((to - from).normalize(), SAME * (outer + from.distance(to)));
                let is_on_axis = |end: DVec3| (end - from).reject_from_normalized(axis).length() <= tolerance;
                let [a, b] = [first, last].map(|end| (end - from).dot(axis));
                let goes_through = a.min(b) <= tolerance && a.max(b) >= from.distance(to) - tolerance;
                (is_on_axis(first) && is_on_axis(last) && goes_through).then_some(Self::Axial {
                    from,
                    to,
                    inner,
                    outer,
                })
            }
            _ => None,
        }
    }
}

/// Maximum distance of coincident centres, over the size of the shapes.
const SAME: f64 = 1e-9;

/// The inner radius with a bore; `None` where no material remains.
fn bored_radius(inner: f64, outer: f64, bore: f64) -> Option<f64> {
    (bore < outer).then_some(inner.max(bore))
}
