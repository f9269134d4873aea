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

/// A stage, in the order in which those of one command come.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Stage {
    /// Hash the input files.
    Hash,
    /// Read the extract: ways and nodes of all layers.
    Extract,
    /// Split areas by tile.
    MapAreas,
    /// Split boundaries by tile.
    Boundaries,
    /// Split roads by tile.
    Roads,
    /// Read the DEM, reproject it, fill its voids, make the level rasters.
    Heights,
    /// Read photos.
    Photos,
    /// Triangulate the tiles of all levels but the finest.
    CoarseTins,
    /// Measure every finest tile, and the coarser ones above it, against the full resolution.
    Deviations,
    /// Measure every level at the DEM's own samples, where they are not the nodes.
    Samples,
    /// Make the tiles: clip, drape and encode.
    Tiles,
    /// Make the tiles of all levels but the finest.
    CoarseTiles,
    /// Solve the heights of bridges and tunnels, and cut them by tile.
    Spans,
    /// Write the package.
    Package,
    /// Check a package.
    Verify,
    /// An export reads tiles: it sorts what they hold by way, or makes what is written of them.
    ExportTiles,
    /// An export makes blocks of a raster.
    ExportBlocks,
    /// An export reads heights along the roads of an extract.
    ExportChains,
    /// An export joins the pieces of each way and writes features.
    ExportFeatures,
    /// Compare roads with an image.
    Match,
    /// Draw the frames of a flight, in one way of drawing.
    Fly,
}

impl Stage {
    /// All stages, in their order.
    pub const ALL: [Self; 21] = [
        Self::Hash,
        Self::Extract,
        Self::MapAreas,
        Self::Boundaries,
        Self::Roads,
        Self::Heights,
        Self::Photos,
        Self::CoarseTins,
        Self::Deviations,
        Self::Samples,
        Self::Tiles,
        Self::CoarseTiles,
        Self::Spans,
        Self::Package,
        Self::Verify,
        Self::ExportTiles,
        Self::ExportBlocks,
        Self::ExportChains,
        Self::ExportFeatures,
        Self::Match,
        Self::Fly,
    ];

    /// Its name for programs, its name for people, and what it counts.
    const fn row(self) -> (&'static str, &'static str, Unit) {
        const TILES: Unit = Unit::Things("tiles");
        match self {
            Self::Hash => ("hash", "hashing inputs", Unit::Bytes),
            Self::Extract => ("extract", "reading extract", Unit::Bytes),
            Self::MapAreas => ("areas", "splitting areas", Unit::Things("objects")),
            Self::Boundaries => ("boundaries", "splitting boundaries", Unit::Things("ways")),
            Self::Roads => ("roads", "splitting roads", Unit::Things("ways")),
            // Finest tiles of one window of the DEM.
            Self::Heights => ("heights", "reading heights", Unit::Things("areas")),
            Self::Photos => ("photos", "reading photos", TILES),
            Self::CoarseTins => ("coarse-tins", "meshing coarse levels", TILES),
            Self::Deviations => ("deviations", "measuring errors", TILES),
            Self::Samples => ("samples", "measuring at samples", Unit::Things("blocks")),
            Self::Tiles => ("tiles", "making tiles", TILES),
            Self::CoarseTiles => ("coarse-tiles", "making coarse tiles", TILES),
            Self::Spans => ("spans", "solving bridges", Unit::Things("tiles")),
            Self::Package => ("package", "writing package", TILES),
            Self::Verify => ("verify", "verifying", TILES),
            Self::ExportTiles => ("export-tiles", "reading tiles", TILES),
            Self::ExportBlocks => ("export-blocks", "writing blocks", Unit::Things("blocks")),
            Self::ExportChains => ("export-chains", "heights along roads", Unit::Things("chains")),
            Self::ExportFeatures => ("export-features", "writing features", Unit::Things("pieces")),
            Self::Match => ("match", "comparing tiles", TILES),
            Self::Fly => ("fly", "drawing frames", Unit::Things("frames")),
        }
    }

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
