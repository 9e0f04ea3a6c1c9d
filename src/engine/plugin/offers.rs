//! The kind of bodies that a formulation moves, and the terms it accepts from plugins, conditions and
//! contacts.

/// Kind of the bodies of a formulation for the rest of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BodyKind {
    /// A deformable solid: particles with a deformation gradient and a stress.
    Solid,
    /// A fluid: particles with density and pressure.
    Fluid,
    /// Boundary particles of a fluid, which move as prescribed.
    Boundary,
    /// A body that moves as a whole.
    Rigid,
}

impl BodyKind {
    /// The kind in words, in the plural.
    pub fn words(self) -> &'static str {
        match self {
            Self::Solid => "deformable solids",
            Self::Fluid => "fluids",
            Self::Boundary => "walls",
            Self::Rigid => "rigid bodies",
        }
    }
}

/// Something that a formulation may take for its bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Offer {
    /// Terms that are a function of one pair ([`PairTerm`](crate::pair::PairTerm)).
    PairTerms,
    /// Terms that fold into the pass of the internal force: hourglass control.
    FoldedTerms,
    /// Stabilization by differences of second derivatives
    /// ([`HessianDifference`](crate::solids::HessianDifference)).
    HessianDifferences,
    /// Hourglass control along pairs, with the weights of the present places
    /// ([`PairControl`](crate::solids::PairControl)).
    PairControl,
    /// Mirror images across symmetry planes.
    MirrorImages,
    /// Contact with other bodies.
    Contact,
    /// Contact of a body with itself.
    SelfContact,
    /// Particles in contact that are as large as their deformation gradient says: ellipsoids. Without it they
    /// stay spheres.
    DeformedContact,
    /// A deformation gradient that is a state of the particle, whose volume plugins may change by a column of
    /// the formulation.
    Dilatation,
    /// Held particles that end where a condition says, and carry but a share of their stress.
    Supports,
    /// Held particles that stand on a side of their body, one and a half spacings from the next ones.
    Sides,
}

impl Offer {
    /// All that a formulation of solids can take.
    pub const OF_SOLIDS: &'static [Self] = &[
        Self::PairTerms,
        Self::FoldedTerms,
        Self::MirrorImages,
        Self::Contact,
        Self::SelfContact,
        Self::DeformedContact,
        Self::Supports,
        Self::Sides,
    ];

    /// Offers of the formulations of solids with a Lagrangian kernel.
    pub const OF_LAGRANGIAN_SOLIDS: &'static [Self] = &[
        Self::PairTerms,
        Self::FoldedTerms,
        Self::HessianDifferences,
        Self::MirrorImages,
        Self::Contact,
        Self::SelfContact,
        Self::DeformedContact,
        Self::Supports,
        Self::Sides,
    ];

    /// Description in words.
    pub fn words(self) -> &'static str {
        match self {
            Self::PairTerms => "pair terms",
            Self::FoldedTerms => "terms that fold into the internal force",
            Self::HessianDifferences => "stabilization by differences of second derivatives",
            Self::PairControl => "hourglass control along pairs",
            Self::MirrorImages => "mirror images",
            Self::Contact => "contact",
            Self::SelfContact => "contact of a body with itself",
            Self::DeformedContact => "contact with deformed particles",
            Self::Dilatation => "changes of volume without a motion",
            Self::Supports => "supports that end between particles",
            Self::Sides => "supports on a side of the body",
        }
    }
}
