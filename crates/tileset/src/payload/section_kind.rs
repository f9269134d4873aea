//! The sections that a payload can have.

use std::{borrow::Cow, ops::BitOr};

use corniche_geom::TileId;
use serde::{Deserialize, Serialize};

#[cfg(feature = "write")]
use crate::payload::damage::EncodeError;
use crate::{
    layer_slot::LayerSlot,
    payload::damage::{Damage, DecodeError},
};

/// Declares the kinds, so that the list of all kinds is complete.
macro_rules! kinds {
    ($($kind:ident = $number:literal, $name:literal;)+) => {
        /// The kinds of section that this version knows; readers skip other kinds.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub(crate) enum SectionKind {
            $($kind,)+
            /// The objects of a layer.
            Layer(LayerSlot),
        }

        impl SectionKind {
            /// All kinds but those of layers.
            #[cfg(test)]
            pub(crate) const FIXED: &'static [Self] = &[$(Self::$kind),+];

            /// The number that a payload stores.
            pub(crate) const fn number(self) -> u16 {
                match self {
                    $(Self::$kind => $number,)+
                    Self::Layer(slot) => FIRST_LAYER + slot.index() as u16,
                }
            }

            /// Returns the kind with this number, if this version knows it.
            pub(crate) fn from_number(number: u16) -> Option<Self> {
                match number {
                    $($number => Some(Self::$kind),)+
                    _ => number.checked_sub(FIRST_LAYER).and_then(LayerSlot::new).map(Self::Layer),
                }
            }

            /// The name of the kind in errors.
            pub(crate) fn name(self) -> Cow<'static, str> {
                match self {
                    $(Self::$kind => $name.into(),)+
                    Self::Layer(slot) => format!("section of layer {}", slot.index()).into(),
                }
            }
        }
    };
}

kinds! {
    Terrain = 1, "terrain section";
    RoadsGeo = 2, "GEO roads section";
    RoadsSv = 3, "SV roads section";
    Attributes = 4, "road attributes section";
    RoadTags = 5, "road tags section";
    Relief = 6, "relief section";
    Photo = 7, "photo section";
    CodedGeo = 10, "GEO roads section";
    CodedSv = 11, "SV roads section";
    Spans = 13, "spans section";
}

/// The number of the kind of section of a package's first layer; the other layers follow.
const FIRST_LAYER: u16 = 64;

impl SectionKind {
    /// Returns a function that turns damage of a section of this kind into an error.
    pub(crate) fn damaged(self, tile: TileId) -> impl Fn(Damage) -> DecodeError + Copy {
        move |damage| DecodeError { tile, part: self.name(), damage }
    }

    /// Returns a function that turns a value which this kind of section cannot hold into an error.
    #[cfg(feature = "write")]
    pub(crate) fn refused(self, tile: TileId) -> impl Fn(&'static str) -> EncodeError + Copy {
        move |what| EncodeError::Unencodable { tile, section: self.name(), what }
    }

    /// Whether the section has SV roads. They are written last, so that readers that draw by GEO
    /// can read a payload without them.
    pub(crate) const fn is_sv(self) -> bool {
        matches!(self, Self::RoadsSv | Self::CodedSv)
    }

    /// Whether compression does not make the section's bytes smaller.
    #[cfg(feature = "write")]
    pub(crate) const fn is_dense(self) -> bool {
        matches!(self, Self::Terrain | Self::CodedGeo | Self::CodedSv | Self::Photo)
    }

    /// Whether a payload has only one of the two sections, because they are for the same objects.
    #[cfg(feature = "write")]
    pub(crate) fn excludes(self, other: Self) -> bool {
        self == other
            || [GEO, SV].iter().any(|of| {
                [of.planes, of.coded].contains(&self) && [of.planes, of.coded].contains(&other)
            })
    }
}

/// The two kinds of section in which the roads of a method can be stored.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TwoKinds {
    /// The kind with numbers in planes.
    pub planes: SectionKind,
    /// The kind with range-coded bits.
    pub coded: SectionKind,
}

/// The kinds of GEO roads: centre-lines on the TIN.
pub(crate) const GEO: TwoKinds =
    TwoKinds { planes: SectionKind::RoadsGeo, coded: SectionKind::CodedGeo };
/// The kinds of SV roads: lines in plan for shadow volumes.
pub(crate) const SV: TwoKinds =
    TwoKinds { planes: SectionKind::RoadsSv, coded: SectionKind::CodedSv };

/// The set of sections of a payload to decode; combine sets with `|`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Sections(u16);

impl Sections {
    /// No sections: only the header is checked.
    pub const NONE: Self = Self(0);
    /// The ground.
    pub const TERRAIN: Self = Self::from_kind(SectionKind::Terrain);
    /// Centre-lines on the TIN (GEO roads). The ground is read, too, because they are on it.
    pub const ROADS_GEO: Self =
        Self::from_kind(SectionKind::RoadsGeo).and(Self::from_kind(SectionKind::CodedGeo));
    /// Lines in plan for shadow volumes (SV roads).
    pub const ROADS_SV: Self =
        Self::from_kind(SectionKind::RoadsSv).and(Self::from_kind(SectionKind::CodedSv));
    /// The attributes of each way, from both sections that have some.
    pub const ATTRIBUTES: Self =
        Self::from_kind(SectionKind::Attributes).and(Self::from_kind(SectionKind::RoadTags));
    /// The raster of the level, for shading.
    pub const RELIEF: Self = Self::from_kind(SectionKind::Relief);
    /// The photo. [`decode`](crate::decode) checks it; [`decode_photo`](crate::decode_photo)
    /// returns it.
    pub const PHOTO: Self = Self::from_kind(SectionKind::Photo);
    /// The objects of all layers. [`Manifest::decode`](crate::Manifest::decode) checks them;
    /// [`Manifest::decode_layer`](crate::Manifest::decode_layer) returns those of a layer.
    pub const LAYERS: Self = Self(1 << 15);
    /// The runs of spans, which are stretches of bridges and tunnels off the ground.
    /// [`decode`](crate::decode) checks them, and reads the ground, too, because their ends are on
    /// it; [`decode_spans`](crate::decode_spans) returns them.
    pub const SPANS: Self = Self::from_kind(SectionKind::Spans);
    /// All sections, including the checksums of sections of unknown kinds.
    pub const ALL: Self = Self::TERRAIN
        .and(Self::ROADS_GEO)
        .and(Self::ROADS_SV)
        .and(Self::ATTRIBUTES)
        .and(Self::RELIEF)
        .and(Self::PHOTO)
        .and(Self::LAYERS)
        .and(Self::SPANS);

    /// One bit per kind, by its number.
    const fn from_kind(kind: SectionKind) -> Self {
        Self(1 << (kind.number() - 1))
    }

    /// Returns the union with `other`; like `|`, but for constants.
    #[must_use]
    pub const fn and(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Whether all sections of `other` are in this set.
    #[must_use]
    pub const fn contains(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }
}

impl BitOr for Sections {
    type Output = Self;

    fn bitor(self, other: Self) -> Self {
        self.and(other)
    }
}

#[cfg(test)]
#[path = "section_kind_tests.rs"]
mod tests;
