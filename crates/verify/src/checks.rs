//! All checks: for each its short id, the promise that it checks, and the inputs that it needs.

/// The input that a check needs beside the package.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Needs {
    /// The package alone.
    Package,
    /// The elevation files (`--dem`).
    Dem,
    /// The photos (`--photo`).
    Photo,
    /// The extract (`--osm`).
    Osm,
}

impl Needs {
    /// The input's name in the list of checks.
    #[must_use]
    pub fn text(self) -> &'static str {
        match self {
            Self::Package => "the package",
            Self::Dem => "`--dem`",
            Self::Photo => "`--photo`",
            Self::Osm => "`--osm`",
        }
    }
}

macro_rules! checks {
    ($($variant:ident $id:literal $needs:ident $promise:literal)*) => {
        /// A check. Reports list checks in this order.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum CheckId {
            $(#[doc = $promise] $variant,)*
        }

        impl CheckId {
            /// All checks.
            pub const ALL: &'static [Self] = &[$(Self::$variant),*];

            /// Its name: short, and the same in every version.
            #[must_use]
            pub fn id(self) -> &'static str {
                match self { $(Self::$variant => $id),* }
            }

            /// What the check makes sure of.
            #[must_use]
            pub fn promise(self) -> &'static str {
                match self { $(Self::$variant => $promise),* }
            }

            /// The input that it needs.
            #[must_use]
            pub fn needs(self) -> Needs {
                match self { $(Self::$variant => Needs::$needs),* }
            }
        }
    };
}

checks! {
    Whole "tiles.whole" Package "every tile's sections are whole and match their checksums"
    Header "package.header" Package "what the file says for PMTiles tools follows from manifest and tiles"
    Order "roads.order" Package "the roads of a tile are sorted by class, way and part, and parts are counted from 0"
    OnTin "P1" Package "every edge of a GEO road lies on one triangle of its tile"
    Seams "P3" Package "neighbours of one level share bit-identical border vertices"
    ReliefThere "relief.there" Package "the tiles with ground of the levels that the settings name, and no others, have a relief"
    ReliefSeams "relief.seams" Package "the reliefs of neighbours of one level have the same slopes at the nodes that both have"
    Nested "P2.nested" Package "a parent's error and height range are never below its children's"
    Levels "P2.levels" Package "at nodes that both cover, a child's TIN and its parent's TIN differ by no more than the sum of their errors"
    Vertices "heights.vertices" Package "TIN vertices lie within their tile's height range"
    RootHeights "heights.root" Package "the lowest and the highest height of the package are those of the root tile"
    Methods "sv.line" Package "within a tile, the GEO line and the SV line of a way coincide wherever there is ground"
    SvRange "sv.range" Package "the height range of an SV segment is that of the ground within the margin around it, rounded outwards"
    Shown "roads.levels" Package "a road is on every level that shows its class, within the simplification tolerance"
    Classes "roads.classes" Package "a way has one class, and a level has no road of a class that it does not show"
    Attributes "roads.attributes" Package "a way has one set of attributes, and exactly the ways of a tile have them there"
    Length "P6.length" Package "GEO roads of the finest level are as long as the manifest says"
    Structures "P6.structures" Package "the GEO roads of the finest level on the ground, those of bridges and those of tunnels are each as long as the manifest says, together as long as all"
    RoadSums "P6.roads" Package "the roads read are the roads kept plus the roads lost, by reason"
    SampleSums "P6.samples" Package "the nodes are those with data, those that were filled and those that are void, together"
    LevelSums "levels.sums" Package "tiles, triangles, vertices, bytes and errors of each level are those of its tiles"
    Growth "growth.sums" Package "the rows of the growth table are sums over the tiles"
    SvTails "sv.tails" Package "the manifest lists the tiles that end with most SV roads, with their bytes there"
    LevelRecords "levels.derived" Package "cells, tolerances, margins and classes of the levels follow from grid and settings"
    PhotoWhole "photo.whole" Package "every photo can be decoded and has the size that level and settings give it"
    PhotoSeams "photo.seams" Package "neighbours of one level agree, within the loss of their coding, on the texels that they share"
    PhotoLevels "photo.levels" Package "a photo of a coarse level is, within the loss of its coding, that of the tiles beneath it, averaged"
    PhotoSums "photo.sums" Package "photos and their bytes on each level are those of the tiles"
    AreaRings "areas.rings" Package "the outer rings of areas run counter-clockwise, those around holes clockwise, and no point of a ring comes twice"
    AreaSeams "areas.seams" Package "what an area covers of a line between two tiles is the same in both, but where its outline can run along the line"
    AreaSums "areas.sums" Package "areas, points and bytes on each level are those of the tiles, and objects are kept or lost"
    BoundaryPlaces "boundaries.places" Package "each segment of a boundary comes into its tile or the margin around it"
    BoundaryOrder "boundaries.order" Package "boundaries of a tile are in order of class and way"
    BoundarySums "boundaries.sums" Package "parts, points and bytes of boundaries on each level are those of the tiles, and ways are kept or lost"
    SpanEnds "spans.ends" Package "a run of a bridge or a tunnel ends on the ground of its way, or where the way's line ends"
    SpanSide "spans.side" Package "a bridge is nowhere below the ground of its level, and a tunnel nowhere above it, along its centre-line"
    SpanOrder "spans.order" Package "on the finest level bridges that cross bridges, and tunnels that cross tunnels, are in the order of their layers, but as often as the manifest tells that they are not (`order_reversed`)"
    SpanSeams "spans.seams" Package "where a bridge or a tunnel goes over a border, the tiles on both sides have the same height there"
    SpanSums "spans.sums" Package "runs, points and bytes of bridges and tunnels on each level are those of the tiles"
    SettingsHash "settings.hash" Package "the recorded hash is that of the recorded settings"
    Grid "manifest.grid" Package "the grid is the smallest that covers the rectangle of the data, and the corners of this rectangle are nodes"
    Crs "manifest.crs" Package "the CRS's code or name is that of its WKT, and its way to WGS84 is the one that is recorded"
    Scale "manifest.scale" Package "the scale is one that the CRS has over the data"
    Bounds "manifest.bounds" Package "the rectangle in the working CRS and the rectangle in degrees are around the same place"
    Coordinates "manifest.coordinates" Package "the table of longitudes and latitudes is what the CRS says, to a centimetre"
    Texts "manifest.texts" Package "fixed texts are as the format has them, kinds of inputs are known, and extracts are credited"
    DemInputs "dem.inputs" Dem "the elevation files are as long as the manifest says"
    DemPlan "dem.plan" Dem "the elevation files and the settings give the grid, CRS and heights that the manifest tells of"
    DemCounts "dem.counts" Dem "nodes with data, filled and void, and the lowest and highest, are those of the elevation files, and the settings allow them"
    Bound "P2.bound" Dem "no stored error is below the true one"
    Tight "P2.tight" Dem "stored errors are at most twice the true ones, for 95 % of tiles"
    Recorded "P2.recorded" Dem "the recorded distributions of stored over true errors hold"
    Finest "P2.finest" Dem "the finest level stays within --max-error"
    Samples "P2.samples" Dem "the error at the DEM's own samples is what the levels say"
    SampleBound "P2.bounded" Dem "where nodes are samples, samples are within --max-error of the finest level"
    Stray "P2.stray" Dem "nodes without ground lie within one cell of a void or an edge"
    Uncovered "P2.uncovered" Dem "uncovered nodes are as many as tiles and levels say"
    Ranges "heights.ranges" Dem "the height range of a tile reaches from the lowest to the highest node beneath the tile"
    Nodes "heights.nodes" Dem "the height of a TIN vertex is the DEM's at its node, rounded to the height quantum"
    Normals "heights.normals" Dem "the normal of a TIN vertex is that of the heights' gradient on its level"
    Relief "heights.relief" Dem "no height of a relief is farther from its level's than the relief says, gaps and water are the same, and slopes on the border are those of the heights, to half a 256th"
    PhotoInputs "photo.inputs" Photo "the photos are as long as the manifest says"
    PhotoCover "photo.cover" Photo "the texels that have a photo are those that the photos cover"
    PhotoPlace "photo.place" Photo "no photo of a tile fits the photos better when it is moved by one texel"
    PhotoColours "photo.colours" Photo "colours are off the photos' by no more than coding them again loses, over a tile and over each of its blocks of 16 × 16 texels"
    OsmInputs "osm.inputs" Osm "the extracts are as long as the manifest says, and the FRC table is the one it names"
    OsmGeo "osm.geo" Osm "the GEO roads are those of the extract, clipped and laid on the ground again; they are compared to the lattice step"
    OsmSv "osm.sv" Osm "the SV roads are those of the extract, clipped again; they are compared to the lattice step"
    OsmAttributes "osm.attributes" Osm "classes and attributes of ways are those of the extract"
    OsmCounts "osm.counts" Osm "counts and lengths of roads are those of the extract"
    OsmGrowth "osm.growth" Osm "source and simplified points of the growth table are those of the extract"
    OsmAreas "osm.areas" Osm "the areas of each tile are those of the extract, split again; their points are compared to the lattice step"
    OsmAreaCounts "osm.areas.counts" Osm "areas by class, their square kilometres and the objects lost are those of the extract"
    OsmBoundaries "osm.boundaries" Osm "the boundaries of each tile are those of the extract, split again"
    OsmBoundaryCounts "osm.boundaries.counts" Osm "ways that are boundaries by class, their lengths and the ways lost are those of the extract"
    OsmSpans "osm.spans" Osm "the runs of bridges and tunnels of each tile are those of the extract, solved again on the ground of the tiles"
    OsmSpanCounts "osm.spans.counts" Osm "bridges, tunnels, crossings and what is told of them are those of the extract"
    AreaPolygon "areas.polygon" Osm "areas of a package that was cut with a polygon end at it"
    BoundaryPolygon "boundaries.polygon" Osm "boundaries of a package that was cut with a polygon end at it"
}

/// One check, how often it was made, and where it failed.
#[derive(Debug, Clone, PartialEq)]
pub struct Check {
    /// Which check.
    pub id: CheckId,
    /// How many things were looked at.
    pub checked: u64,
    /// How many of them break it.
    pub broken: u64,
    /// The first few of those, in words.
    pub examples: Vec<String>,
}

/// Examples kept of each broken promise.
const EXAMPLES: usize = 5;

impl Check {
    /// A check of which nothing was seen.
    #[must_use]
    pub fn new(id: CheckId) -> Self {
        Self { id, checked: 0, broken: 0, examples: Vec::new() }
    }

    /// Whether nothing breaks it.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.broken == 0
    }

    /// Whether nothing breaks it. `None` if it needs the elevation files or the extract and was not made: another check on
    /// which it depends is broken, or the package has nothing of this kind.
    #[must_use]
    pub fn verdict(&self) -> Option<bool> {
        let made = self.id.needs() == Needs::Package || self.checked > 0;
        made.then(|| self.holds())
    }

    /// Counts a case; `example` tells of the first that does not hold.
    pub fn look(&mut self, holds: bool, example: impl FnOnce() -> String) {
        self.checked += 1;
        if !holds {
            self.broken += 1;
            if self.examples.len() < EXAMPLES {
                self.examples.push(example());
            }
        }
    }

    pub(crate) fn merge(&mut self, other: Self) {
        self.checked += other.checked;
        self.broken += other.broken;
        let room = EXAMPLES - self.examples.len();
        self.examples.extend(other.examples.into_iter().take(room));
    }
}

/// The checks made so far, each of them once in the list.
#[derive(Debug, Clone, Default)]
pub(crate) struct Findings {
    checks: Vec<Check>,
}

/// A value in an example of what is broken, where there may be none.
pub(crate) fn or_none<T: ToString>(value: Option<T>) -> String {
    value.map_or_else(|| "none".to_owned(), |value| value.to_string())
}

impl Findings {
    /// Counts one more thing that was looked at.
    pub(crate) fn look(&mut self, id: CheckId, holds: bool, example: impl FnOnce() -> String) {
        self.of(id).look(holds, example);
    }

    /// The check with this id; it is added if the list does not have it.
    pub(crate) fn of(&mut self, id: CheckId) -> &mut Check {
        let at = match self.checks.binary_search_by_key(&id, |check| check.id) {
            Ok(at) => at,
            Err(at) => {
                self.checks.insert(at, Check::new(id));
                at
            }
        };
        &mut self.checks[at]
    }

    /// Adds what others found.
    pub(crate) fn merge(&mut self, checks: impl IntoIterator<Item = Check>) {
        for check in checks {
            self.of(check.id).merge(check);
        }
    }

    /// All checks that can be made with the given inputs, in the order of [`CheckId::ALL`].
    pub(crate) fn into_checks(mut self, given: &[Needs]) -> Vec<Check> {
        for &id in CheckId::ALL.iter().filter(|id| given.contains(&id.needs())) {
            self.of(id);
        }
        self.checks
    }
}

impl IntoIterator for Findings {
    type Item = Check;
    type IntoIter = std::vec::IntoIter<Check>;

    fn into_iter(self) -> Self::IntoIter {
        self.checks.into_iter()
    }
}

/// A record as examples of broken checks show it.
pub(crate) fn as_json(record: &impl serde::Serialize) -> String {
    serde_json::to_string(record).unwrap_or_else(|error| error.to_string())
}

#[cfg(test)]
#[path = "checks_tests.rs"]
mod tests;
