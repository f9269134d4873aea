//! The list of all checks: the id of each check, the promise that it checks, and the inputs that it
//! needs.

/// An input that a check needs in addition to the package.
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
            Self::Package => "package",
            Self::Dem => "`--dem`",
            Self::Photo => "`--photo`",
            Self::Osm => "`--osm`",
        }
    }
}

macro_rules! checks {
    ($($variant:ident $id:literal $needs:ident $promise:literal)*) => {
        /// The id of a check. Reports list checks in this order.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum CheckId {
            $(#[doc = $promise] $variant,)*
        }

        impl CheckId {
            /// All checks.
            pub const ALL: &'static [Self] = &[$(Self::$variant),*];

            /// The stable name of the check: short, and the same in every version.
            #[must_use]
            pub fn id(self) -> &'static str {
                match self { $(Self::$variant => $id),* }
            }

            /// The promise that the check verifies.
            #[must_use]
            pub fn promise(self) -> &'static str {
                match self { $(Self::$variant => $promise),* }
            }

            /// The input that the check needs.
            #[must_use]
            pub fn needs(self) -> Needs {
                match self { $(Self::$variant => Needs::$needs),* }
            }
        }
    };
}

checks! {
    Whole "tiles.whole" Package "every tile's sections can be read and match their checksums"
    Header "package.header" Package "the PMTiles header and metadata match the manifest and the tiles"
    Order "roads.order" Package "each tile's roads are sorted by class, way and part, and the parts are numbered from 0"
    OnTin "P1" Package "every edge of a GEO road lies on one triangle of its tile, so no road floats or is buried"
    Seams "P3" Package "neighbouring tiles of a level have bit-identical vertices on their border, so the ground has no cracks"
    ReliefThere "relief.there" Package "a tile has a relief (heights for shading) exactly if it has ground and the settings request one on its level"
    ReliefSeams "relief.seams" Package "the reliefs of neighbouring tiles of a level have the same slopes on their border, so shading has no seams"
    Nested "P2.nested" Package "a parent tile's stored error is never smaller than its children's, and its height range contains theirs"
    Levels "P2.levels" Package "at nodes that both cover, the TINs of a tile and its parent differ by no more than the sum of their errors"
    Vertices "heights.vertices" Package "TIN vertices lie within their tile's height range"
    RootHeights "heights.root" Package "the height range recorded for the package is that of the root tile"
    Methods "sv.line" Package "within a tile, the GEO and SV roads of a way follow the same line wherever there is ground"
    SvRange "sv.range" Package "an SV segment's height range is that of the ground within the margin around it, rounded outwards, so the road has no gaps"
    Shown "roads.levels" Package "a road is on every level that shows its class, and its lines on two levels agree within the simplification tolerance"
    Classes "roads.classes" Package "a way has the same class in all tiles, and no level has roads of a class that it does not show"
    Attributes "roads.attributes" Package "a way has the same attributes in all tiles, and a tile stores attributes for exactly its own ways"
    Length "P6.length" Package "the GEO roads of the finest level have the total length that the manifest records"
    Structures "P6.structures" Package "on the finest level, GEO roads on the ground, bridges and tunnels have the recorded lengths, which add up to that of all roads"
    RoadSums "P6.roads" Package "the roads kept and the roads lost, by reason, add up to the roads read, in number and length"
    SampleSums "P6.samples" Package "nodes with data, filled nodes and void nodes add up to all nodes of the grid"
    LevelSums "levels.sums" Package "the tiles, triangles, vertices, bytes and errors recorded for each level match its tiles"
    Growth "growth.sums" Package "the growth table (what clipping to triangles adds to roads) matches the tiles"
    SvTails "sv.tails" Package "the manifest correctly lists the tiles that end with the largest SV sections, which readers of GEO roads can skip"
    LevelRecords "levels.derived" Package "the cells, tolerances, margins and classes of the levels follow from the grid and the settings"
    PhotoWhole "photo.whole" Package "every photo can be decoded and has the size that its level and the settings require"
    PhotoSeams "photo.seams" Package "the photos of neighbouring tiles of a level agree where they overlap, within the loss of compression"
    PhotoLevels "photo.levels" Package "the photo of a coarse tile is the average of the photos beneath it, within the loss of compression"
    PhotoSums "photo.sums" Package "the numbers and bytes of photos recorded for each level match the tiles"
    AreaRings "areas.rings" Package "outer rings of areas run counter-clockwise, rings around holes run clockwise, and no ring has a point twice"
    AreaSeams "areas.seams" Package "an area covers the same stretches of a tile border on both sides, except where its outline can run along the border"
    LinePlaces "lines.places" Package "each segment of a layer's line reaches into its tile or the margin around it"
    PointPlaces "points.places" Package "a point of a layer on the border of two tiles is in the tile east or south of it"
    LayerTables "layers.tables" Package "the tables of the layers are those that the settings name, and each of their classes can be reached"
    LayerLevels "layers.levels" Package "no level has objects of a class that its table shows only at larger scales"
    LayerOrder "layers.order" Package "each tile's lines and points are sorted by class and object"
    LayerSums "layers.sums" Package "the objects, points and bytes of layers recorded for each level match the tiles, and each object is counted as kept or lost"
    SpanEnds "spans.ends" Package "a bridge or tunnel ends on the ground of its way, or where the way's line ends, so roads have no steps there"
    SpanSide "spans.side" Package "along its centre line, a bridge is nowhere below the ground of its level, and a tunnel nowhere above it"
    SpanOrder "spans.order" Package "the manifest counts all crossings of two bridges or two tunnels on the finest level whose heights contradict their OSM layer tags"
    SpanSeams "spans.seams" Package "where a bridge or tunnel crosses a tile border, both tiles store the same height"
    SpanSums "spans.sums" Package "the stretches, points and bytes of bridges and tunnels recorded for each level match the tiles"
    SettingsHash "settings.hash" Package "the recorded settings match their recorded hash"
    Grid "manifest.grid" Package "the grid is the smallest that covers the data's rectangle, and the corners of this rectangle are nodes"
    Crs "manifest.crs" Package "the code or name of the CRS matches its WKT, and the recorded coordinate operation leads from the CRS to WGS84"
    Scale "manifest.scale" Package "the recorded scales (working metres divided by true metres), on which road widths depend, occur within the data's rectangle"
    Bounds "manifest.bounds" Package "the data's rectangles in the working CRS and in degrees enclose the same region"
    Coordinates "manifest.coordinates" Package "the table that converts positions to longitude and latitude agrees with the CRS to a centimetre"
    Texts "manifest.texts" Package "fixed texts are those of the format, the kinds of inputs are known, and the attribution of extracts is present"
    DemInputs "dem.inputs" Dem "the elevation files have the sizes that the manifest records"
    DemPlan "dem.plan" Dem "the elevation files and the settings give the grid, CRS, bounds, datum operations and treatment of heights that the manifest records"
    DemCounts "dem.counts" Dem "the recorded numbers of nodes with data, filled and void, and the height range match the elevation files, and the settings allow these heights"
    Bound "P2.bound" Dem "no tile's stored error is smaller than its true one, the largest vertical distance of its TIN from the finest grid"
    Tight "P2.tight" Dem "in 95 % of the tiles, the stored error is at most twice the true one"
    Recorded "P2.recorded" Dem "the recorded distributions of stored errors divided by true errors are correct"
    Finest "P2.finest" Dem "the finest level stays within --max-error of the heights"
    Samples "P2.samples" Dem "the errors recorded for each level at the DEM's own samples are correct"
    SampleBound "P2.bounded" Dem "the finest level stays within --max-error of the DEM's samples, if these are the nodes of the grid"
    Stray "P2.stray" Dem "uncovered nodes (with a height, but without a triangle) lie within one cell of a void or of the edge of the data"
    Uncovered "P2.uncovered" Dem "the numbers of uncovered nodes recorded for tiles and levels are correct"
    Ranges "heights.ranges" Dem "the height range of a tile is that of the nodes beneath it"
    Nodes "heights.nodes" Dem "a TIN vertex has the DEM's height at its node, rounded to the step in which heights are stored"
    Normals "heights.normals" Dem "the normal of a TIN vertex follows from the slope of its level's heights"
    Relief "heights.relief" Dem "a relief is as close to its level's heights as it states, with the same gaps and water, and the same slopes on the border to within 1/512"
    PhotoInputs "photo.inputs" Photo "the photo files have the sizes that the manifest records"
    PhotoCover "photo.cover" Photo "tiles have coloured texels exactly where the photo files cover them"
    PhotoPlace "photo.place" Photo "no tile's photo matches the photo files better when shifted by one texel"
    PhotoColours "photo.colours" Photo "colours differ from the photo files by no more than the loss of compressing them again, over a tile and over each of its blocks of 16 × 16 texels"
    OsmInputs "osm.inputs" Osm "the extracts have the sizes that the manifest records, and the FRC table (road classes) is the one that it names"
    OsmGeo "osm.geo" Osm "clipping and draping the extract again gives the same GEO roads, to within the lattice step (at most 1 mm)"
    OsmSv "osm.sv" Osm "clipping the extract again gives the same SV roads, to within the lattice step"
    OsmAttributes "osm.attributes" Osm "the classes and attributes of ways are those of the extract"
    OsmCounts "osm.counts" Osm "the counts and lengths of roads are those of the extract"
    OsmGrowth "osm.growth" Osm "the growth table's numbers of source and simplified points are those of the extract"
    OsmAreas "osm.areas" Osm "splitting the areas of the extract's layers at tile borders again gives the same areas and attributes"
    OsmLines "osm.lines" Osm "splitting the lines of the extract's layers by tile again gives the same lines and attributes"
    OsmPoints "osm.points" Osm "reading the points of the extract's layers again gives the same points and attributes"
    OsmLayerCounts "osm.layers.counts" Osm "the numbers of objects by layer and class, their lengths and areas, and the lost objects are those of the extract"
    OsmSpans "osm.spans" Osm "computing the extract's bridges and tunnels again above the tiles' ground gives the same stretches and heights"
    OsmSpanCounts "osm.spans.counts" Osm "the counts of bridges, tunnels, crossings and reported problems are those of the extract"
    LayerPolygon "layers.polygon" Osm "if the package was clipped to a polygon, no object of a layer reaches beyond it"
}

/// The result of one check: how many cases it checked, and how many of them failed.
#[derive(Debug, Clone, PartialEq)]
pub struct Check {
    /// The check.
    pub id: CheckId,
    /// The number of checked cases.
    pub checked: u64,
    /// The number of cases that break the promise.
    pub broken: u64,
    /// Descriptions of the first few broken cases.
    pub examples: Vec<String>,
}

/// The number of examples kept for each broken promise.
const EXAMPLES: usize = 5;

impl Check {
    /// A check without any case yet.
    #[must_use]
    pub fn new(id: CheckId) -> Self {
        Self { id, checked: 0, broken: 0, examples: Vec::new() }
    }

    /// Whether no case is broken.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.broken == 0
    }

    /// Whether no case is broken. `None` if a check that needs an input has no case: another check,
    /// on which this one depends, is broken, or the package has nothing to check.
    #[must_use]
    pub fn verdict(&self) -> Option<bool> {
        let made = self.id.needs() == Needs::Package || self.checked > 0;
        made.then(|| self.holds())
    }

    /// Counts a case; `example` describes the case if it is one of the first broken ones.
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

/// Counts an object of a check in [`Findings`]; if it breaks the promise, it is described as an
/// example, in words like those of `format!`.
macro_rules! look {
    ($findings:expr, $check:ident, $holds:expr, $($words:tt)+) => {
        $findings.look($crate::CheckId::$check, $holds, || format!($($words)+))
    };
}

/// The checks so far, each once.
#[derive(Debug, Clone, Default)]
pub(crate) struct Findings {
    checks: Vec<Check>,
}

/// A value as text in an example; "none" if it is absent.
pub(crate) fn or_none<T: ToString>(value: Option<T>) -> String {
    value.map_or_else(|| "none".to_owned(), |value| value.to_string())
}

impl Findings {
    /// Counts a case of the check with this id.
    pub(crate) fn look(&mut self, id: CheckId, holds: bool, example: impl FnOnce() -> String) {
        self.check_mut(id).look(holds, example);
    }

    /// The check with this id, which is added if the list lacks it.
    pub(crate) fn check_mut(&mut self, id: CheckId) -> &mut Check {
        let at = match self.checks.binary_search_by_key(&id, |check| check.id) {
            Ok(at) => at,
            Err(at) => {
                self.checks.insert(at, Check::new(id));
                at
            }
        };
        &mut self.checks[at]
    }

    /// Adds the results of other checks.
    pub(crate) fn merge(&mut self, checks: impl IntoIterator<Item = Check>) {
        for check in checks {
            self.check_mut(check.id).merge(check);
        }
    }

    /// All checks that are possible with the given inputs, in the order of [`CheckId::ALL`].
    pub(crate) fn into_checks(mut self, given: &[Needs]) -> Vec<Check> {
        for &id in CheckId::ALL.iter().filter(|id| given.contains(&id.needs())) {
            self.check_mut(id);
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

/// A record as JSON, as examples of broken checks show it.
pub(crate) fn as_json(record: &impl serde::Serialize) -> String {
    serde_json::to_string(record).unwrap_or_else(|error| error.to_string())
}

#[cfg(test)]
#[path = "checks_tests.rs"]
mod tests;
