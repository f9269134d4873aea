//! The stages of all long commands: their names and the units that they count.

/// The unit that a stage counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unit {
    /// Bytes, which have units of their own.
    Bytes,
    /// Things, by their plural name, which ends in s.
    Things(&'static str),
}

impl Unit {
    /// The plural name of the unit.
    #[must_use]
    pub const fn plural(self) -> &'static str {
        match self {
            Self::Bytes => "bytes",
            Self::Things(name) => name,
        }
    }
}

/// The unit of most stages.
const TILES: Unit = Unit::Things("tiles");

/// Declares the stages in their order: the name for programs, the name for people, and the unit.
macro_rules! stages {
    ($($(#[doc = $doc:literal])+ $stage:ident = $id:literal, $title:literal, $unit:expr;)+) => {
        /// A stage; the stages of a command come in this order.
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
    /// Split the objects of layers by tile.
    Layers = "layers", "splitting layers", Unit::Things("objects");
    /// Split roads by tile.
    Roads = "roads", "splitting roads", Unit::Things("ways");
    /// Read the DEM, reproject it, fill its voids, create the rasters of all levels.
    // A window has the samples for some of the finest tiles.
    Heights = "heights", "reading heights", Unit::Things("windows");
    /// Read photos.
    Photos = "photos", "reading photos", TILES;
    /// Triangulate the tiles of all levels but the finest.
    CoarseTins = "coarse-tins", "meshing coarse levels", TILES;
    /// Measure every finest tile, and the coarser ones above it, against the full resolution.
    Deviations = "deviations", "measuring errors", TILES;
    /// Measure every level at the DEM's own samples, if they are not the nodes.
    Samples = "samples", "measuring at samples", Unit::Things("blocks");
    /// Create the tiles: clip, drape and encode.
    Tiles = "tiles", "creating tiles", TILES;
    /// Create the tiles of all levels but the finest.
    CoarseTiles = "coarse-tiles", "creating coarse tiles", TILES;
    /// Solve the heights of bridges and tunnels, and cut them by tile.
    Spans = "spans", "solving bridges", TILES;
    /// Write the package.
    Package = "package", "writing package", TILES;
    /// Check the ground and the roads of a package.
    Verify = "verify", "checking tiles", TILES;
    /// Check photos and their seams.
    VerifyPhotos = "verify-photos", "checking photos", TILES;
    /// Check layers and the seams of areas.
    VerifyLayers = "verify-layers", "checking layers", TILES;
    /// Check bridges and tunnels.
    VerifySpans = "verify-spans", "checking bridges", TILES;
    /// Compare vertices and reliefs with the DEM.
    CompareHeights = "compare-heights", "comparing heights", TILES;
    /// Compare roads with the extract.
    CompareRoads = "compare-roads", "comparing roads", TILES;
    /// Compare layers with the extract.
    CompareLayers = "compare-layers", "comparing layers", TILES;
    /// Compare bridges and tunnels with the extract.
    CompareSpans = "compare-spans", "comparing bridges", TILES;
    /// Compare the ends of layers with the polygon.
    ComparePolygon = "compare-polygon", "comparing with polygon", TILES;
    /// An export reads tiles and sorts their content by way, or converts it.
    ExportTiles = "export-tiles", "reading tiles", TILES;
    /// An export writes blocks of a raster.
    ExportBlocks = "export-blocks", "writing blocks", Unit::Things("blocks");
    /// An export reads heights along the roads of an extract.
    ExportChains = "export-chains", "reading road heights", Unit::Things("chains");
    /// An export joins the pieces of each way and writes features.
    ExportFeatures = "export-features", "writing features", Unit::Things("pieces");
    /// Compare roads with an image.
    Match = "match", "comparing tiles", TILES;
    /// Draw the frames of a flight with one drawing method.
    Fly = "fly", "drawing frames", Unit::Things("frames");
}

impl Stage {
    /// The stage's name for programs: lower-case letters and hyphens. It never changes.
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
