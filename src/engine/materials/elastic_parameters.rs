//! The parameters shared by all elastic solids, declared once.

/// Declares the parameters of an elastic solid as a scene gives them: density and elastic constants, then its
/// own fields.
///
/// A macro rather than a struct of its own, so that a scene writes all parameters of a material side by side
/// and an error names the one that is wrong.
macro_rules! elastic_parameters {
    (
        $(#[$about:meta])*
        pub struct $name:ident { $($own:tt)* }
    ) => {
        $(#[$about])*
        #[derive(Clone, Debug, serde::Deserialize, schemars::JsonSchema)]
        #[serde(deny_unknown_fields)]
        pub struct $name {
            /// Density rho_0, kg/m3.
            pub density: f64,
            /// Young's modulus E, Pa. Goes with `poisson`.
            #[serde(default)]
            pub young: Option<f64>,
            /// Poisson's ratio nu, -1 < nu < 0.5. Goes with `young`.
            #[serde(default)]
            pub poisson: Option<f64>,
            /// Bulk modulus K, Pa. Goes with `shear`.
            #[serde(default)]
            pub bulk: Option<f64>,
            /// Shear modulus mu, Pa. Goes with `bulk`.
            #[serde(default)]
            pub shear: Option<f64>,
            $($own)*
        }

        impl $name {
            /// The elastic constants, after a check of the density.
            fn elastic(
                &self,
            ) -> Result<$crate::materials::ElasticConstants, $crate::materials::ParameterError> {
                $crate::materials::ParameterError::require_positive("density", self.density)?;
                $crate::materials::ElasticConstants::from_parameters(
                    self.young,
                    self.poisson,
                    self.bulk,
                    self.shear,
                )
            }
        }
    };
}

pub(super) use elastic_parameters;
