//! The columns of a frame as arrow arrays. They are filled here, where loops are optimized, and not by the
//! generic code of rerun's types.

use std::sync::Arc;

use re_sdk_types::archetypes::{Points3D, Scalars};
use re_sdk_types::components::Color;
use re_sdk_types::external::arrow::array::{
    ArrayRef, FixedSizeListArray, Float32Array, Float64Array, UInt32Array,
};
use re_sdk_types::external::arrow::datatypes::{DataType, Field};
use re_sdk_types::{ComponentDescriptor, SerializedComponentBatch};

/// Points at places \[m\] with a colour each, or one for all.
pub(super) fn points(positions: &[[f32; 3]], colors: &[Color]) -> Points3D {
    let coordinates = Arc::new(Float32Array::from(positions.as_flattened().to_vec()));
    let coordinate = Arc::new(Field::new("item", DataType::Float32, false));
    let colors: Vec<u32> = colors.iter().map(|color| color.0.0).collect();
    Points3D {
        positions: batch(
            Arc::new(FixedSizeListArray::new(coordinate, 3, coordinates, None)),
            Points3D::descriptor_positions(),
        ),
        colors: batch(Arc::new(UInt32Array::from(colors)), Points3D::descriptor_colors()),
        ..Points3D::update_fields()
    }
}

/// A number for each particle.
pub(super) fn scalars(values: &[f64]) -> Scalars {
    let values = Arc::new(Float64Array::from(values.to_vec()));
    Scalars { scalars: batch(values, Scalars::descriptor_scalars()) }
}

#[expect(clippy::unnecessary_wraps, reason = "components are optional in rerun's types")]
fn batch(array: ArrayRef, descriptor: ComponentDescriptor) -> Option<SerializedComponentBatch> {
    Some(SerializedComponentBatch::new(array, descriptor))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrays_are_those_of_the_types_of_rerun() {
        let (positions, colors) = ([[1.0, -2.0, 3.5], [0.0, 4.0, 1e-3]], [Color::from_rgb(1, 2, 3)]);
        let expected = Points3D::new(positions).with_colors(colors);
        assert_eq!(points(&positions, &colors), expected);
        let nothing = Points3D::new(Vec::<[f32; 3]>::new()).with_colors(Vec::<Color>::new());
        assert_eq!(points(&[], &[]), nothing);
        assert_eq!(
            scalars(&[1.0, 2.0]).scalars.map(|batch| batch.array.to_data()),
            Scalars::new([1.0, 2.0]).scalars.map(|batch| batch.array.to_data())
        );
    }
}
