//! Flow stress of Johnson and Cook, and the material that is named after it.

use super::elastic_parameters::elastic_parameters;
use super::eos::SolidEos;
use super::error::ParameterError;
use super::hardening::Hardening;
use super::heating::{Heating, room_temperature};
use super::j2::plastic;
use super::johnson_cook_flow::{JohnsonCookFlow, flow_parameters, one};
use super::law::{Material, MaterialModel};

macro_rules! metal {
    ([$($(#[$meta:meta])* $field:ident,)*] $($own:tt)*) => {
        elastic_parameters! {
            /// Johnson-Cook metal: J2 plasticity with the flow stress (a + b eps_p^n)(1 + c ln rate*)(1 -
            /// T*^m), heated by plastic work.
            pub struct JohnsonCook {
                $($(#[$meta])* pub $field: f64,)*
                $($own)*
            }
        }

        impl JohnsonCook {
            fn flow(&self) -> JohnsonCookFlow {
                JohnsonCookFlow { $($field: self.$field),* }
            }
        }
    };
}

flow_parameters! {
    metal {
        /// Specific heat, J/(kg K). Without it plastic work does not heat the metal.
        #[serde(default)]
        pub specific_heat: Option<f64>,
        /// Share of plastic work that becomes heat (Taylor-Quinney), 0 to 1.
        #[serde(default = "super::heating::usual_share")]
        pub taylor_quinney: f64,
        /// Temperature at the start, K; the reference temperature if not given.
        #[serde(default)]
        pub temperature: Option<f64>,
        /// Pressure as a function of volume; without it the Kirchhoff pressure is -K ln J.
        #[serde(default)]
        pub eos: Option<SolidEos>,
    }
}

impl MaterialModel for JohnsonCook {
    const NAME: &'static str = "JohnsonCook";
    const REFERENCE: &'static str = "G. R. Johnson and W. H. Cook 1983, 7th Int. Symp. Ballistics; return mapping: Simo and Hughes 1998, section 9.3";

    fn build(self) -> Result<Material, ParameterError> {
        let elastic = self.elastic()?;
        let flow = self.flow();
        flow.check(&JohnsonCookFlow::FIELDS)?;
        let heating = Heating {
            specific_heat: self.specific_heat,
            taylor_quinney: self.taylor_quinney,
            temperature: self.temperature.unwrap_or(self.reference_temperature),
        };
        heating.check(&Heating::FIELDS)?;
        plastic(self.density, elastic, Hardening::JohnsonCook(flow), Some(heating), self.eos)
    }
}
