//! Named materials with their sources: parameters from the literature, each of which a scene can override.

use schemars::JsonSchema;
use serde::Deserialize;

use super::error::ParameterError;
use super::heating::usual_share;
use super::law::{Material, MaterialModel};
use super::{Hardening, J2, JohnsonCook, NeoHookean, SolidEos};

/// A metal of Johnson and Cook by its name.
macro_rules! johnson_cook {
    ($(#[doc = $doc:literal])* $name:ident, $source:literal, { $($field:ident: $value:expr,)* }) => {
        $(#[doc = $doc])*
        #[derive(Clone, Debug, Deserialize, JsonSchema)]
        #[serde(deny_unknown_fields, default)]
        pub struct $name {
            /// Density rho_0, kg/m3.
            pub density: f64,
            /// Young's modulus E, Pa.
            pub young: f64,
            /// Poisson's ratio nu.
            pub poisson: f64,
            /// Yield stress A, Pa.
            pub a: f64,
            /// Hardening coefficient B, Pa.
            pub b: f64,
            /// Hardening exponent n.
            pub n: f64,
            /// Rate coefficient C.
            pub c: f64,
            /// Thermal exponent m.
            pub m: f64,
            /// Plastic strain rate at and below which the rate has no influence, 1/s.
            pub reference_rate: f64,
            /// Temperature at and below which temperature has no influence, K.
            pub reference_temperature: f64,
            /// Melting temperature, at which the flow stress is zero, K.
            pub melt_temperature: f64,
            /// Specific heat, J/(kg K); `None` for no heating.
            pub specific_heat: Option<f64>,
            /// Share of plastic work that becomes heat, 0 to 1.
            pub taylor_quinney: f64,
            /// Temperature at the start, K.
            pub temperature: f64,
            /// Pressure as a function of volume.
            pub eos: Option<SolidEos>,
        }

        impl Default for $name {
            fn default() -> Self {
                Self { $($field: $value,)* taylor_quinney: usual_share(), eos: None }
            }
        }

        impl MaterialModel for $name {
            const NAME: &'static str = stringify!($name);
            const REFERENCE: &'static str = $source;

            fn build(self) -> Result<Material, ParameterError> {
                let Self { density, a, b, n, c, m, specific_heat, taylor_quinney, eos, .. } = self;
                let Self { reference_rate, reference_temperature, melt_temperature, .. } = self;
                let (young, poisson, temperature) = (Some(self.young), Some(self.poisson), Some(self.temperature));
                let (bulk, shear) = (None, None);
                let metal = JohnsonCook {
                    density, young, poisson, bulk, shear, a, b, n, c, m, reference_rate, reference_temperature,
                    melt_temperature, specific_heat, taylor_quinney, temperature, eos,
                };
                metal.build()
            }
        }
    };
}

johnson_cook!(
    /// Aluminium 6061-T6, Johnson-Cook.
    Al6061T6, "Mohseni-Mofidi and Bierwisch 2020, table 1 (from Takaffoli and Papini 2012)", {
        density: 2800.0,
        young: 70.477516e9,
        poisson: 0.32976445,
        a: 164.0e6,
        b: 211.0e6,
        n: 0.465,
        c: 0.002,
        m: 1.419,
        reference_rate: 1.0,
        reference_temperature: 292.0,
        melt_temperature: 925.0,
        specific_heat: Some(885.0),
        temperature: 292.0,
    }
);

johnson_cook!(
    /// Acrylic glass (polymethyl methacrylate), Johnson-Cook.
    PMMA, "Mohseni-Mofidi and Bierwisch 2020, table 1 (from Takaffoli and Papini 2012)", {
        density: 1186.0,
        young: 5.8648101e9,
        poisson: 0.33291139,
        a: 212.0e6,
        b: 580.0e6,
        n: 3.5,
        c: 0.081,
        m: 0.749,
        reference_rate: 0.001,
        reference_temperature: 213.0,
        melt_temperature: 398.0,
        specific_heat: Some(1470.0),
        temperature: 292.0,
    }
);

johnson_cook!(
    /// Steel 42CrMo4, Johnson-Cook.
    Steel42CrMo4, "O. Pantale, DynELA v. 4, documentation of the impact samples", {
        density: 7830.0,
        young: 206.9e9,
        poisson: 0.3,
        a: 806.0e6,
        b: 614.0e6,
        n: 0.168,
        c: 0.0089,
        m: 1.1,
        reference_rate: 1.0,
        reference_temperature: 293.15,
        melt_temperature: 1813.15,
        specific_heat: Some(460.0),
        temperature: 293.15,
    }
);

/// A metal of J2 plasticity with linear hardening by its name.
macro_rules! linear_hardening {
    ($(#[doc = $doc:literal])* $name:ident, $source:literal, { $($field:ident: $value:expr,)* }) => {
        $(#[doc = $doc])*
        #[derive(Clone, Debug, Deserialize, JsonSchema)]
        #[serde(deny_unknown_fields, default)]
        pub struct $name {
            /// Density rho_0, kg/m3.
            pub density: f64,
            /// Young's modulus E, Pa.
            pub young: f64,
            /// Poisson's ratio nu.
            pub poisson: f64,
            /// Yield stress, Pa.
            pub yield_stress: f64,
            /// Hardening modulus, Pa.
            pub modulus: f64,
            /// Pressure as a function of volume.
            pub eos: Option<SolidEos>,
        }

        impl Default for $name {
            fn default() -> Self {
                Self { $($field: $value,)* eos: None }
            }
        }

        impl MaterialModel for $name {
            const NAME: &'static str = stringify!($name);
            const REFERENCE: &'static str = $source;

            fn build(self) -> Result<Material, ParameterError> {
                let Self { density, yield_stress, modulus, eos, .. } = self;
                ParameterError::require_positive("yield_stress", yield_stress)?;
                ParameterError::require_not_negative("modulus", modulus)?;
                let (young, poisson, bulk, shear) = (Some(self.young), Some(self.poisson), None, None);
                let hardening = Hardening::Linear { yield_stress, modulus };
                J2 { density, young, poisson, bulk, shear, hardening, heating: None, eos }.build()
            }
        }
    };
}

linear_hardening!(
    /// Copper, standard Taylor-bar parameters: J2 with linear hardening.
    Copper, "Taylor bar of J. Bonet and A. J. Burton, Commun. Numer. Methods Engrg. 14 (1998) 437-449", {
        density: 8930.0,
        young: 117.0e9,
        poisson: 0.35,
        yield_stress: 400.0e6,
        modulus: 100.0e6,
    }
);

linear_hardening!(
    /// Structural steel S355, J2 without hardening: nominal values of the standard.
    Steel, "EN 10025-2 (yield stress), EN 1993-1-1, 3.2.6 (elastic constants)", {
        density: 7850.0,
        young: 210.0e9,
        poisson: 0.3,
        yield_stress: 355.0e6,
        modulus: 0.0,
    }
);

/// Rubber of the bending and twisting columns, neo-Hookean.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Rubber {
    /// Density rho_0, kg/m3.
    pub density: f64,
    /// Young's modulus E, Pa.
    pub young: f64,
    /// Poisson's ratio nu.
    pub poisson: f64,
}

impl Default for Rubber {
    fn default() -> Self {
        Self { density: 1100.0, young: 17.0e6, poisson: 0.45 }
    }
}

impl MaterialModel for Rubber {
    const NAME: &'static str = "Rubber";
    const REFERENCE: &'static str =
        "M. Aguirre, A. J. Gil, J. Bonet, A. A. Carreno, J. Comput. Phys. 259 (2014) 672-699";

    fn build(self) -> Result<Material, ParameterError> {
        let (young, poisson) = (Some(self.young), Some(self.poisson));
        NeoHookean { density: self.density, young, poisson, bulk: None, shear: None }.build()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parameters_are_those_of_the_source_and_can_be_overridden() {
        // Table 1 gives bulk and shear modulus.
        let aluminium = Al6061T6::default().build().expect("valid parameters");
        let crate::materials::Law::Solid(law) = aluminium.law else { panic!("not a solid") };
        assert!((law.elastic().bulk / 69.0e9 - 1.0).abs() < 1e-6);
        assert!((law.elastic().shear / 26.5e9 - 1.0).abs() < 1e-6);
        let pmma = PMMA::default().build().expect("valid parameters");
        let crate::materials::Law::Solid(law) = pmma.law else { panic!("not a solid") };
        assert!((law.elastic().bulk / 5.85e9 - 1.0).abs() < 1e-6);
        assert!((law.elastic().shear / 2.2e9 - 1.0).abs() < 1e-6);
        assert!(Steel42CrMo4::default().build().is_ok());
        assert!(Copper::default().build().is_ok() && Steel::default().build().is_ok());
        assert_eq!(Rubber { density: 1000.0, ..Rubber::default() }.build().expect("valid").density, 1000.0);
        let error = Steel { yield_stress: -1.0, ..Steel::default() }.build().err().expect("an error");
        assert_eq!(error.field, "yield_stress");
    }
}
