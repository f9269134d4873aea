//! Kinds of roads that are drawn differently within their class: slip roads, tunnels, service roads and carriageways.

use corniche_roads::{Form, OwnWidth, RoadAttributes, Structure};
use corniche_tileset::TilePayload;
use serde::{Deserialize, Serialize};

/// What a road is, as far as it changes how it is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum RoadLook {
    /// The road looks as its class does.
    #[default]
    Plain,
    /// A slip road: narrower, without the bands that take less than half of the width.
    Link,
    /// A road under the ground: pale, with a dashed edge, and hidden by every road that is not.
    Tunnel,
    /// The same in a package that tells where tunnels are under the ground: half as wide, with a tick at each portal.
    Bore,
    /// A service road: driveways, parking aisles, ways to yards and barns. Narrower, of one colour, shown one zoom step later than
    /// the rest of its class, and hidden by every other road on the ground.
    Service,
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

    /// All of them.
    const ALL: [Self; 8] = [
        Self::Plain,
        Self::Link,
        Self::Tunnel,
        Self::Bore,
        Self::Service,
        Self::Carriageway,
        Self::CarriagewayTunnel,
        Self::CarriagewayBore,
    ];

    /// Its number in shaders: the constants of these names in `shaders/common.wgsl`.
    pub(crate) fn number(self) -> u32 {
        match self {
            Self::Plain => 0,
            Self::Link => 1,
            Self::Tunnel => 2,
            Self::Service => 3,
            Self::Bore => 4,
            Self::Carriageway => 5,
            Self::CarriagewayTunnel => 6,
            Self::CarriagewayBore => 7,
        }
    }

    /// The look of a number.
    pub(crate) fn of_number(number: u32) -> Option<Self> {
        Self::ALL.into_iter().find(|look| look.number() == number)
    }
}

/// What the tags of a way say of its width and of what it is; nothing if the attributes were not read.
pub(crate) fn tagged(payload: &TilePayload, way_id: i64) -> (OwnWidth, RoadLook) {
    let found = payload.attributes.binary_search_by_key(&way_id, |record| record.way_id);
    let record = found.ok().and_then(|at| payload.attributes.get(at));
    record
        .map(|record| (record.attributes.own_width(), RoadLook::of(&record.attributes)))
        .unwrap_or_default()
}

#[cfg(test)]
#[path = "look_tests.rs"]
mod tests;
