//! Contact of the skins of deformable bodies, with rigid bodies and with each other.

mod region;

mod near_tool;

mod points;

mod facet_places;

mod foot;

mod close_facets;

mod skin_end;

mod tool_edges;

mod tips;

mod on_tool;

mod displaced;

mod near_skins;

mod side;

mod pair;

mod contact;

pub(super) use contact::SkinContact;
pub(super) use near_skins::{gap_of, speed_of_points};
pub(super) use on_tool::SkinOnTool;
pub(super) use pair::SkinPair;
