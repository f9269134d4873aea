use std::ops::BitOr;

use corniche_geom::{Frame, LatticePoint, TILE_NODES, TileId};
use corniche_tin::{Placement, Surface};

use super::{
    Damage, DecodeError, TilePayload, attributes,
    envelope::{self, Kind},
    roads_geo, roads_sv,
    terrain::{self, Scale},
};
use crate::manifest::is_height_quantum;

/// Which sections of a payload to decode; combine them with `|`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sections(u8);

impl Sections {
    /// None: checks the header alone.
    pub const NONE: Self = Self(0);
    /// The ground.
    pub const TERRAIN: Self = Self(1);
    /// Centre-lines on the TIN. Reads the ground too, which they lie on.
    pub const ROADS_GEO: Self = Self(2);
    /// Plan lines for shadow volumes.
    pub const ROADS_SV: Self = Self(4);
    /// What is known of each way.
    pub const ATTRIBUTES: Self = Self(8);
    /// Everything, checksums of sections of unknown kinds included.
    pub const ALL: Self = Self(15);

    /// Whether all of `other` are among these.
    #[must_use]
    pub const fn contains(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }
}

impl BitOr for Sections {
    type Output = Self;

    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

/// What positions and heights in a payload are relative to.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Context {
    pub(crate) corner: LatticePoint,
    pub(crate) placement: Placement,
    pub(crate) scale: Scale,
}

impl Context {
    pub(crate) fn new(id: TileId, frame: &Frame, quantum_m: f64) -> Result<Self, Damage> {
        if id.z() > frame.max_level() {
            return Err(Damage::Level { level: id.z(), finest: frame.max_level() });
        }
        if !is_height_quantum(quantum_m) {
            return Err(Damage::Invalid { what: "the height quantum" });
        }
        let placement = Placement::of_tile(frame, id, quantum_m);
        Ok(Self {
            corner: placement.corner,
            placement,
            scale: Scale {
                quantum_m,
                cell: frame.level_cell(id.z()),
                nodes_beneath: (frame.stride(id.z()) as u64 * TILE_NODES as u64).pow(2),
            },
        })
    }
}

/// Reads the wanted sections of a payload; sections that are absent or not wanted are empty or `None`.
///
/// `frame` and `quantum_m` are those of the package's manifest. Memory and work are bounded by the
/// [`limits`](crate::limits), whatever the bytes say. Sections that are not wanted are not looked into, so damage in
/// them goes unnoticed; [`Sections::ALL`] also checks those that this version cannot decode.
///
/// # Errors
/// When the bytes are not a payload of tile `id`, or a wanted section is damaged; the error names both.
pub fn decode(
    bytes: &[u8],
    id: TileId,
    frame: &Frame,
    quantum_m: f64,
    wanted: Sections,
) -> Result<TilePayload, DecodeError> {
    let header = |damage| DecodeError { tile: id, part: "header", damage };
    let context = Context::new(id, frame, quantum_m).map_err(header)?;
    let sections = envelope::open(bytes, id).map_err(header)?;
    if wanted == Sections::ALL {
        envelope::check_unknown(&sections).map_err(|damage| DecodeError {
            tile: id,
            part: "section of an unknown kind",
            damage,
        })?;
    }
    let read = |kind: Kind, section: Sections| {
        if !wanted.contains(section) {
            return Ok(None);
        }
        envelope::section(&sections, kind).map_err(|damage| DecodeError {
            tile: id,
            part: kind.name(),
            damage,
        })
    };
    let inside = |kind: Kind| move |damage| DecodeError { tile: id, part: kind.name(), damage };

    let roads_geo = read(Kind::RoadsGeo, Sections::ROADS_GEO)?;
    let needs_terrain = wanted.contains(Sections::TERRAIN) || roads_geo.is_some();
    let ground = if needs_terrain {
        let bytes = envelope::section(&sections, Kind::Terrain).map_err(inside(Kind::Terrain))?;
        bytes
            .map(|bytes| terrain::decode(&bytes, context.scale))
            .transpose()
            .map_err(inside(Kind::Terrain))?
    } else {
        None
    };
    let roads_geo = match (roads_geo, &ground) {
        (Some(bytes), Some(ground)) => {
            let surface = Surface::new(&ground.tin, context.placement);
            roads_geo::decode(&bytes, context.corner, &surface).map_err(inside(Kind::RoadsGeo))?
        }
        (Some(_), None) => {
            return Err(inside(Kind::RoadsGeo)(Damage::Invalid {
                what: "roads without the ground they lie on",
            }));
        }
        (None, _) => Vec::new(),
    };
    let roads_sv = read(Kind::RoadsSv, Sections::ROADS_SV)?
        .map(|bytes| roads_sv::decode(&bytes, context.corner, quantum_m))
        .transpose()
        .map_err(inside(Kind::RoadsSv))?;
    let records = read(Kind::Attributes, Sections::ATTRIBUTES)?
        .map(|bytes| attributes::decode(&bytes))
        .transpose()
        .map_err(inside(Kind::Attributes))?;
    Ok(TilePayload {
        id,
        terrain: ground,
        roads_geo,
        roads_sv: roads_sv.unwrap_or_default(),
        attributes: records.unwrap_or_default(),
    })
}
