//! The stages of all commands that take their time: what each is called and what it counts.

/// What a stage counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unit {
    /// Bytes, which have units of their own.
    Bytes,
    /// Things, by the name of several of them, which ends in s.
    Things(&'static str),
}

impl Unit {
    /// Several of what is counted.
    #[must_use]
    pub const fn plural(self) -> &'static str {
        match self {
            Self::Bytes => "bytes",
            Self::Things(name) => name,
        }
    }
}

/// Tiles are what most stages count.
const TILES: Unit = Unit::Things("tiles");

/// Declares the stages in their order: for each its name for programs, its name for people, and what it counts.
macro_rules! stages {
    ($($(#[doc = $doc:literal])+ $stage:ident = $id:literal, $title:literal, $unit:expr;)+) => {
        /// A stage, in the order in which those of one command come.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        pub enum Stage {
            $($(#[doc = $doc])+ $stage,)+
        }

        impl Stage {
            /// All stages, in their order.
            pub const ALL: &'static [Self] = &[$(Self::$stage),+];

            const fn row(self) -> (&'static str, &'static str, Unit) {
                match self {
                    $(Self::$stage => ($id, $title, $unit),)+
                }
            }
        }
    };
}

stages! {
    /// Hash the input files.
    Hash = "hash", "hashing inputs", Unit::Bytes;
    /// Read the extract: ways and nodes of all layers.
    Extract = "extract", "reading extract", Unit::Bytes;
    /// Split areas by tile.
    MapAreas = "areas", "splitting areas", Unit::Things("objects");
    /// Split boundaries by tile.
    Boundaries = "boundaries", "splitting boundaries", Unit::Things("ways");
    /// Split roads by tile.
    Roads = "roads", "splitting roads", Unit::Things("ways");
    /// Read the DEM, reproject it, fill its voids, make the level rasters.
    // Finest tiles of one window of the DEM.
    Heights = "heights", "reading heights", Unit::Things("areas");
    /// Read photos.
    Photos = "photos", "reading photos", TILES;
    /// Triangulate the tiles of all levels but the finest.
    CoarseTins = "coarse-tins", "meshing coarse levels", TILES;
    /// Measure every finest tile, and the coarser ones above it, against the full resolution.
    Deviations = "deviations", "measuring errors", TILES;
    /// Measure every level at the DEM's own samples, where they are not the nodes.
    Samples = "samples", "measuring at samples", Unit::Things("blocks");
    /// Make the tiles: clip, drape and encode.
    Tiles = "tiles", "making tiles", TILES;
    /// Make the tiles of all levels but the finest.
    CoarseTiles = "coarse-tiles", "making coarse tiles", TILES;
    /// Solve the heights of bridges and tunnels, and cut them by tile.
    Spans = "spans", "solving bridges", TILES;
    /// Write the package.
    Package = "package", "writing package", TILES;
    /// Check a package.
    Verify = "verify", "verifying", TILES;
    /// An export reads tiles: it sorts what they hold by way, or makes what is written of them.
    ExportTiles = "export-tiles", "reading tiles", TILES;
    /// An export makes blocks of a raster.
    ExportBlocks = "export-blocks", "writing blocks", Unit::Things("blocks");
    /// An export reads heights along the roads of an extract.
    ExportChains = "export-chains", "heights along roads", Unit::Things("chains");
    /// An export joins the pieces of each way and writes features.
    ExportFeatures = "export-features", "writing features", Unit::Things("pieces");
    /// Compare roads with an image.
    Match = "match", "comparing tiles", TILES;
    /// Draw the frames of a flight, in one way of drawing.
    Fly = "fly", "drawing frames", Unit::Things("frames");
}

impl Stage {
    /// The stage's name for programs: small letters and hyphens. It does not change.
    #[must_use]
    pub const fn id(self) -> &'static str {
        self.row().0
    }

    /// What the stage does, for people; at most 22 characters, one column of a table.
    #[must_use]
    pub const fn title(self) -> &'static str {
        self.row().1
    }

    /// What the stage counts.
    #[must_use]
    pub const fn unit(self) -> Unit {
        self.row().2
    }
}

#[cfg(test)]
#[path = "stage_tests.rs"]
mod tests;
