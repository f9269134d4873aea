//! The classes of areas, such as water or forest, with their numbers and names.

use serde::{Deserialize, Serialize};

use crate::named_classes::named_classes;

named_classes! {
    /// The class of an area on the map. Packages store the numbers of classes, so a new class comes
    /// last.
    #[derive(Serialize, Deserialize)]
    #[non_exhaustive]
    AreaClass:
    /// The sea: everything to the right of coastlines.
    Sea = "sea",
    /// Lakes, reservoirs, wide rivers.
    Water = "water",
    /// Permanent ice.
    Glacier = "glacier",
    /// Forest and wood.
    Forest = "forest",
    /// Meadows, pastures, farmland.
    Meadow = "meadow",
    /// Places where people live and work.
    Settlement = "settlement",
    /// Parks and gardens.
    Park = "park",
    /// Bare rock and scree.
    Rock = "rock",
}
