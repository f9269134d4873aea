//! The sections that a payload can have.

use std::ops::BitOr;

use corniche_areas::ClassedLayer;
use serde::{Deserialize, Serialize};

/// Declares the kinds, so that the list of all kinds has every kind.
macro_rules! kinds {
    ($($kind:ident = $number:literal, $name:literal;)+) => {
        /// The kinds of section that this version knows, by the number that a payload stores; a reader skips others.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        #[repr(u16)]
        pub(crate) enum Kind {
            $($kind = $number,)+
        }

        impl Kind {
            /// All kinds.
            pub(crate) const ALL: &'static [Self] = &[$(Self::$kind),+];

            /// Its name in errors.
            pub(crate) fn name(self) -> &'static str {
                match self {
                    $(Self::$kind => $name,)+
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
    Areas = 8, "areas section";
    Boundaries = 9, "boundaries section";
    CodedGeo = 10, "GEO roads section";
    CodedSv = 11, "SV roads section";
    CodedAreas = 12, "areas section";
    Spans = 13, "spans section";
}

impl Kind {
    /// Whether it has SV roads. They are written last, so that those who draw by GEO can read a payload without them.
    pub(crate) const fn is_sv(self) -> bool {
        matches!(self, Self::RoadsSv | Self::CodedSv)
    }

    /// Whether its bytes do not become smaller by compression.
    #[cfg(feature = "write")]
    pub(crate) const fn is_dense(self) -> bool {
        matches!(self, Self::Terrain | Self::CodedGeo | Self::CodedSv | Self::Photo)
    }

    /// The kind of the sections of a layer of lines.
    pub(crate) const fn of_lines(layer: ClassedLayer) -> Self {
        match layer {
            ClassedLayer::Boundaries => Self::Boundaries,
        }
    }
}

/// The two kinds of section that roads of a method, or areas, can be in.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TwoKinds {
    /// Numbers in planes.
    pub(crate) planes: Kind,
    /// Range-coded bits.
    pub(crate) coded: Kind,
}

/// Centre-lines on the TIN.
pub(crate) const GEO: TwoKinds = TwoKinds { planes: Kind::RoadsGeo, coded: Kind::CodedGeo };
/// Plan lines for shadow volumes.
pub(crate) const SV: TwoKinds = TwoKinds { planes: Kind::RoadsSv, coded: Kind::CodedSv };
/// Areas.
pub(crate) const AREAS: TwoKinds = TwoKinds { planes: Kind::Areas, coded: Kind::CodedAreas };

/// Which sections of a payload to decode; combine them with `|`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Sections(u16);

impl Sections {
    /// None: checks the header alone.
    pub const NONE: Self = Self(0);
    /// The ground.
    pub const TERRAIN: Self = Self::of(Kind::Terrain);
    /// Centre-lines on the TIN. Reads the ground too, which they lie on.
    pub const ROADS_GEO: Self = Self::of(Kind::RoadsGeo).and(Self::of(Kind::CodedGeo));
    /// Plan lines for shadow volumes.
    pub const ROADS_SV: Self = Self::of(Kind::RoadsSv).and(Self::of(Kind::CodedSv));
    /// The attributes of each way, of both sections that have some.
    pub const ATTRIBUTES: Self = Self::of(Kind::Attributes).and(Self::of(Kind::RoadTags));
    /// The raster of the level, for shading.
    pub const RELIEF: Self = Self::of(Kind::Relief);
    /// The photo. [`decode`](crate::decode) checks it; [`decode_photo`](crate::decode_photo) gives it.
    pub const PHOTO: Self = Self::of(Kind::Photo);
    /// Areas. [`decode`](crate::decode) checks them; [`decode_areas`](crate::decode_areas) gives them.
    pub const AREAS: Self = Self::of(Kind::Areas).and(Self::of(Kind::CodedAreas));
    /// Runs of bridges and tunnels that are off the ground. [`decode`](crate::decode) checks them, and reads the ground too, on which their ends lie;
    /// [`decode_spans`](crate::decode_spans) gives them.
    pub const SPANS: Self = Self::of(Kind::Spans);
    /// Everything, checksums of sections of unknown kinds included.
    pub const ALL: Self = Self::all();

    /// The lines of a layer. [`decode`](crate::decode) checks them; [`decode_lines`](crate::decode_lines) gives them.
    #[must_use]
    pub const fn lines(layer: ClassedLayer) -> Self {
        Self::of(Kind::of_lines(layer))
    }

    /// One bit for each kind, by its number.
    const fn of(kind: Kind) -> Self {
        Self(1 << (kind as u16 - 1))
    }

    const fn all() -> Self {
        let (mut all, mut k) = (Self::NONE, 0);
        while k < Kind::ALL.len() {
            all = all.and(Self::of(Kind::ALL[k]));
            k += 1;
        }
        all
    }

    /// These and `other`; as `|`, for constants.
    #[must_use]
    pub const fn and(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Whether all of `other` are among these.
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
