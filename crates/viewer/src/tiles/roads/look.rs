//! Kinds of roads with a look of their own within their class: slip roads, tunnels, service roads
//! and carriageways.

use corniche_roads::{Form, FunctionalRoadClass, OwnWidth, RoadAttributes, Structure};
use corniche_tileset::TilePayload;
use serde::{Deserialize, Serialize};

/// The kind of a road: class, look and width.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct RoadKind {
    /// Functional road class.
    pub class: FunctionalRoadClass,
    /// Width of the road according to its tags.
    pub own_width: OwnWidth,
    /// Look of the road within its class.
    pub look: RoadLook,
}

impl Default for RoadKind {
    fn default() -> Self {
        Self::plain(FunctionalRoadClass::LEAST)
    }
}

impl RoadKind {
    /// A road of which only the class is known.
    #[must_use]
    pub fn plain(class: FunctionalRoadClass) -> Self {
        Self { class, own_width: OwnWidth::Unknown, look: RoadLook::Plain }
    }

    /// The kind of a way of a tile; only its class if the attributes were not read.
    pub(crate) fn tagged(payload: &TilePayload, way_id: i64, class: FunctionalRoadClass) -> Self {
        let found = payload.attributes.binary_search_by_key(&way_id, |record| record.way_id);
        found.map_or(Self::plain(class), |at| {
            let attributes = &payload.attributes[at].attributes;
            let (own_width, look) = (attributes.own_width(), RoadLook::from_attributes(attributes));
            Self { class, own_width, look }
        })
    }
}

/// The look of a road within its class. The numbers in shaders are the constants of these names in
/// `shaders/common.wgsl`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum RoadLook {
    /// The usual look of the class.
    #[default]
    Plain,
    /// A slip road: narrower, without the bands that are less than half as wide as the road.
    Link,
    /// A road under the ground: pale, with a dashed edge, and hidden by every road above the
    /// ground.
    Tunnel,
    /// A service road: driveways, parking aisles, ways to yards and barns. Narrower, of one colour,
    /// shown one zoom step later than the rest of its class, and hidden by every other road on the
    /// ground.
    Service,
    /// The same as [`RoadLook::Tunnel`] in a package that stores where tunnels are under the
    /// ground: half as wide, with a tick at each portal.
    Bore,
    /// One of the two carriageways of a road, with the width from the style.
    Carriageway,
    /// The same as [`RoadLook::Tunnel`].
    CarriagewayTunnel,
    /// The same as [`RoadLook::Bore`].
    CarriagewayBore,
}

impl RoadLook {
    /// The look that the tags of a way define.
    #[must_use]
    pub fn from_attributes(attributes: &RoadAttributes) -> Self {
        let is_carriageway = attributes.form == Form::DualCarriageway;
        if attributes.structure == Structure::Tunnel {
            if is_carriageway { Self::CarriagewayTunnel } else { Self::Tunnel }
        } else if attributes.form == Form::Link {
            Self::Link
        } else if attributes.highway == "service" {
            Self::Service
        } else if is_carriageway {
            Self::Carriageway
        } else {
            Self::Plain
        }
    }

    /// The look in a package that stores where tunnels are under the ground.
    pub(crate) fn with_portals(self) -> Self {
        match self {
            Self::Tunnel => Self::Bore,
            Self::CarriagewayTunnel => Self::CarriagewayBore,
            other => other,
        }
    }

    /// Whether the road is a tunnel in a package that stores where tunnels are under the ground.
    pub(crate) fn is_bore(self) -> bool {
        matches!(self, Self::Bore | Self::CarriagewayBore)
    }

    /// Whether the road is a tunnel.
    pub(crate) fn is_tunnel(self) -> bool {
        self.is_bore() || matches!(self, Self::Tunnel | Self::CarriagewayTunnel)
    }

    /// All looks, in the order of their numbers in shaders, which are `look as u32`.
    pub(crate) const ALL: [Self; 8] = [
        Self::Plain,
        Self::Link,
        Self::Tunnel,
        Self::Service,
        Self::Bore,
        Self::Carriageway,
        Self::CarriagewayTunnel,
        Self::CarriagewayBore,
    ];
}

#[cfg(test)]
#[path = "look_tests.rs"]
mod tests;
