//! Where the viewer looks from: all bodies fill the picture.

use meshless_engine::scene::Dimension;

/// A box around particles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Minimum coordinates, m.
    pub min: [f64; 3],
    /// Largest coordinates, m.
    pub max: [f64; 3],
}

impl Bounds {
    /// A box that holds nothing yet.
    pub const EMPTY: Self = Self { min: [f64::INFINITY; 3], max: [f64::NEG_INFINITY; 3] };

    /// Grows the box so that it holds balls at these positions; positions that are not numbers are left out.
    pub fn extend(&mut self, positions: &[[f32; 3]], radius: f64) {
        for position in positions.iter().filter(|p| p.iter().all(|x| x.is_finite())) {
            for k in 0..3 {
                self.min[k] = self.min[k].min(f64::from(position[k]) - radius);
                self.max[k] = self.max[k].max(f64::from(position[k]) + radius);
            }
        }
    }

    /// Whether this box reaches out of `seen` by more than a tenth of the diagonal of `seen`.
    pub fn outgrows(&self, seen: &Self) -> bool {
        let diagonal = (0..3).map(|k| (seen.max[k] - seen.min[k]).powi(2)).sum::<f64>().sqrt();
        let beyond = |k: usize| (seen.min[k] - self.min[k]).max(self.max[k] - seen.max[k]);
        (0..3).any(|k| beyond(k) > OUTGROWN * diagonal)
    }

    /// By how much the scene is drawn larger than it is.
    pub fn enlargement(&self) -> f64 {
        let diagonal = (0..3).map(|k| (self.max[k] - self.min[k]).powi(2)).sum::<f64>().sqrt();
        if diagonal < SMALL { ENLARGED } else { 1.0 }
    }

    /// The box as it is drawn.
    pub fn enlarged(&self, by: f64) -> Self {
        Self { min: self.min.map(|x| by * x), max: self.max.map(|x| by * x) }
    }

    fn corners(&self) -> impl Iterator<Item = [f64; 3]> + '_ {
        (0..8).map(|corner| {
            std::array::from_fn(|k| if corner >> k & 1 == 0 { self.min[k] } else { self.max[k] })
        })
    }
}

/// Place and direction of the viewer's eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewpoint {
    /// Position, m.
    pub position: [f64; 3],
    /// The point in the middle of the picture, m.
    pub target: [f64; 3],
    /// The upward direction of the picture.
    pub up: [f64; 3],
}

/// Diagonal below which a scene is small, m: the viewer leaves out what is within 0.01 of its eye, so that a
/// scene of a few millimetres could not be seen.
const SMALL: f64 = 0.1;
/// Small scenes are drawn in millimetres.
const ENLARGED: f64 = 1000.0;
/// Share of the diagonal of what is in view by which particles may leave it.
const OUTGROWN: f64 = 0.1;
/// Half the vertical opening angle of the viewer's camera is 27.5 degrees; its tangent.
pub const OPENING: f64 = 0.5206;
/// Room around the bodies.
const MARGIN: f64 = 1.12;

impl Viewpoint {
    /// An eye that has the box in view: from the front in two dimensions, else from the front, right and
    /// above. `up` is a unit vector along an axis, `aspect` the width over the height of the picture.
    pub fn on(bounds: &Bounds, dimension: Dimension, up: [f64; 3], aspect: f64) -> Self {
        let axis = (0..3).find(|&k| up[k] != 0.0).unwrap_or(2);
        let direction = match (dimension, axis) {
            (Dimension::Two, _) => [0.0, 0.0, 1.0],
            (Dimension::Three, 0) => [0.8 * up[0], 1.0, 1.6],
            (Dimension::Three, 1) => [1.0, 0.8 * up[1], 1.6],
            (Dimension::Three, _) => [1.0, -1.6, 0.8 * up[2]],
        };
        let back = unit(direction);
        let [right, top] = across(up, back);
        let target: [f64; 3] = std::array::from_fn(|k| 0.5 * (bounds.min[k] + bounds.max[k]));
        let distance = bounds.corners().map(|corner| {
            let offset: [f64; 3] = std::array::from_fn(|k| corner[k] - target[k]);
            let reach = (dot(offset, right).abs() / aspect).max(dot(offset, top).abs());
            dot(offset, back) + MARGIN * reach / OPENING
        });
        let distance = distance.fold(0.0, f64::max);
        Self { position: std::array::from_fn(|k| target[k] + distance * back[k]), target, up }
    }
}

/// The unit vectors to the right and to the top of a picture that is seen from the direction `back`.
pub fn across(up: [f64; 3], back: [f64; 3]) -> [[f64; 3]; 2] {
    let right = unit(cross(up, back));
    [right, cross(back, right)]
}

pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub fn unit(a: [f64; 3]) -> [f64; 3] {
    let length = dot(a, a).sqrt();
    a.map(|x| x / length)
}

#[cfg(test)]
mod tests {
    use super::*;

    const ASPECT: f64 = 1.3;

    #[test]
    fn a_plane_body_is_seen_from_the_front_with_y_up() {
        let mut bounds = Bounds::EMPTY;
        bounds.extend(&[[0.0, 0.0, 0.0], [2.0, 1.0, 0.0], [f32::NAN, 0.0, 0.0]], 0.0);
        let eye = Viewpoint::on(&bounds, Dimension::Two, [0.0, 1.0, 0.0], ASPECT);
        assert_eq!(eye.target, [1.0, 0.5, 0.0]);
        assert_eq!((eye.position[0], eye.position[1]), (1.0, 0.5));
        let half_width_in_view = eye.position[2] * OPENING * ASPECT;
        assert!((half_width_in_view / (MARGIN * 1.0) - 1.0).abs() < 1e-12, "{half_width_in_view}");
    }

    #[test]
    fn small_scenes_are_drawn_larger() {
        let plate = Bounds { min: [0.0, 0.0, 0.0], max: [0.006, 0.003, 0.0] };
        assert_eq!(plate.enlargement(), 1000.0);
        assert!((plate.enlarged(1000.0).max[0] - 6.0).abs() < 1e-12);
        assert_eq!(Bounds { max: [0.2, 0.1, 0.0], ..plate }.enlargement(), 1.0);
    }

    #[test]
    fn a_box_outgrows_another_by_a_tenth_of_its_diagonal() {
        let seen = Bounds { min: [0.0, 0.0, 0.0], max: [4.0, 3.0, 0.0] };
        let reaching = |y: f64| Bounds { min: [1.0, y, 0.0], max: [3.0, 1.0, 0.0] };
        assert!(!reaching(-0.49).outgrows(&seen));
        assert!(reaching(-0.51).outgrows(&seen));
        assert!(!Bounds::EMPTY.outgrows(&Bounds::EMPTY));
    }

    #[test]
    fn all_corners_of_a_block_are_in_view() {
        for (axis, sign) in [(0, 1.0), (1, 1.0), (2, 1.0), (2, -1.0), (1, -1.0)] {
            let bounds = Bounds { min: [-1.0, 0.0, 3.0], max: [4.0, 0.5, 4.0] };
            let mut up = [0.0; 3];
            up[axis] = sign;
            let eye = Viewpoint::on(&bounds, Dimension::Three, up, ASPECT);
            let back: [f64; 3] = std::array::from_fn(|k| eye.position[k] - eye.target[k]);
            let back = unit(back);
            let right = unit(cross(up, back));
            let top = cross(back, right);
            assert!(dot(top, up) > 0.5, "the picture is upside down");
            for corner in bounds.corners() {
                let seen: [f64; 3] = std::array::from_fn(|k| corner[k] - eye.position[k]);
                let depth = -dot(seen, back);
                assert!(depth > 0.0);
                assert!(dot(seen, right).abs() <= depth * OPENING * ASPECT);
                assert!(dot(seen, top).abs() <= depth * OPENING);
            }
        }
    }
}
