//! Kinds of roads that are drawn differently within their class: slip roads, tunnels, service roads and carriageways.

use corniche_roads::{Form, FunctionalRoadClass, OwnWidth, RoadAttributes, Structure};
use corniche_tileset::TilePayload;
use serde::{Deserialize, Serialize};

/// What a road is: which road of which class, and how wide.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct RoadKind {
    /// Functional road class.
    pub class: FunctionalRoadClass,
    /// What the road's tags say of its width.
    pub own_width: OwnWidth,
    /// What changes how it is drawn within its class.
    pub look: RoadLook,
}

impl Default for RoadKind {
    fn default() -> Self {
        Self::plain(FunctionalRoadClass::LEAST)
    }
}

impl RoadKind {
    /// A road of which no more is known than its class.
    #[must_use]
    pub fn plain(class: FunctionalRoadClass) -> Self {
        Self { class, own_width: OwnWidth::Unknown, look: RoadLook::Plain }
    }

    /// The kind of a way of a tile; that of its class alone if the attributes were not read.
    pub(crate) fn tagged(payload: &TilePayload, way_id: i64, class: FunctionalRoadClass) -> Self {
        let found = payload.attributes.binary_search_by_key(&way_id, |record| record.way_id);
        found.map_or(Self::plain(class), |at| {
            let attributes = &payload.attributes[at].attributes;
            let (own_width, look) = (attributes.own_width(), RoadLook::of(attributes));
            Self { class, own_width, look }
        })
    }
}

/// What a road is, as far as it changes how it is drawn. The numbers in shaders are the constants of these names in `shaders/common.wgsl`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum RoadLook {
    /// The road looks as its class does.
    #[default]
    Plain,
    /// A slip road: narrower, without the bands that take less than half of the width.
    Link,
    /// A road under the ground: pale, with a dashed edge, and hidden by every road that is not.
    Tunnel,
    /// A service road: driveways, parking aisles, ways to yards and barns. Narrower, of one colour, shown one zoom step later than
    /// the rest of its class, and hidden by every other road on the ground.
    Service,
    /// The same as [`RoadLook::Tunnel`] in a package that tells where tunnels are under the ground: half as wide, with a tick at each portal.
    Bore,
    /// One of the two carriageways of a road, as wide as the style says.
    Carriageway,
    /// The same as [`RoadLook::Tunnel`].
    CarriagewayTunnel,
    /// The same as [`RoadLook::Bore`].
    CarriagewayBore,
}

impl RoadLook {
    /// What the tags of a way say.
    #[must_use]
    pub fn of(attributes: &RoadAttributes) -> Self {
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

    /// The same in a package that tells where tunnels are under the ground.
    pub(crate) fn with_portals(self) -> Self {
        match self {
            Self::Tunnel => Self::Bore,
            Self::CarriagewayTunnel => Self::CarriagewayBore,
            other => other,
        }
    }

    /// Whether it is a tunnel of which it is known where it is under the ground.
    pub(crate) fn is_bore(self) -> bool {
        matches!(self, Self::Bore | Self::CarriagewayBore)
    }

    /// Whether it is a tunnel.
    pub(crate) fn is_tunnel(self) -> bool {
        self.is_bore() || matches!(self, Self::Tunnel | Self::CarriagewayTunnel)
    }

    /// All of them, in the order of their numbers in shaders, which are `look as u32`.
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
