//! Kinds of roads that are drawn differently within their class: slip roads, tunnels and service roads.

use corniche_roads::{Form, RoadAttributes, Structure};
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
    /// A service road: driveways, parking aisles, ways to yards and barns. Narrower, of one colour, shown one zoom step later than
    /// the rest of its class, and hidden by every other road on the ground.
    Service,
}

impl RoadLook {
    /// What the tags of a way say.
    #[must_use]
    pub fn of(attributes: &RoadAttributes) -> Self {
        if attributes.structure == Structure::Tunnel {
            Self::Tunnel
        } else if attributes.form == Form::Link {
            Self::Link
        } else if attributes.highway == "service" {
            Self::Service
        } else {
            Self::Plain
        }
    }

    /// Its number in shaders: `PLAIN`, `LINK`, `TUNNEL`, `SERVICE` in `shaders/common.wgsl`.
    pub(crate) fn number(self) -> u32 {
        match self {
            Self::Plain => 0,
            Self::Link => 1,
            Self::Tunnel => 2,
            Self::Service => 3,
        }
    }

    /// The look of a number.
    pub(crate) fn of_number(number: u32) -> Option<Self> {
        [Self::Plain, Self::Link, Self::Tunnel, Self::Service]
            .into_iter()
            .find(|look| look.number() == number)
    }
}

#[cfg(test)]
#[path = "look_tests.rs"]
mod tests;
