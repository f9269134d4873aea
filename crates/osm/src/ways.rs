//! Finds the roads among the ways of a block, their properties, and the nodes that they need.

use std::{borrow::Cow, cell::OnceCell, collections::BTreeMap};

use corniche_roads::{
    Classified, FrcTable, NotARoad, Railway, attributes, is_area, structure_and_layer, tag,
    tags_taken_otherwise,
};

use crate::{
    ExtractDefect, ExtractSummary, HighwayCount, LeftOutReason,
    block::BlockWay,
    location::Location,
    records::{Origin, WayRecord},
    text::Text,
    way_bytes::{LeftOutWay, Track, left_out_bytes, railway_bytes, way_bytes},
    way_facts::WayFacts,
};

/// The destination of the counts and defects of ways.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Counted {
    /// Counts go to the counts of the block: each way counts.
    ByBlock,
    /// Counts go to each way's record, because a way may also be in another extract.
    ByWay,
}

/// The road ways of a block, with facts about its other ways.
#[derive(Debug, Default)]
pub(crate) struct BlockWays {
    /// Roads and skipped ways, in the order of the block.
    pub(crate) roads: Vec<WayRecord>,
    /// The positions of nodes, in files whose ways contain them (`LocationsOnWays`).
    pub(crate) located: Vec<(i64, Location)>,
    pub(crate) defects: Vec<ExtractDefect>,
    pub(crate) summary: ExtractSummary,
    /// The size of all this, in memory or in scratch space, bytes, by an estimate that is never too
    /// low.
    pub(crate) held_bytes: u64,
    /// The number of nodes that the ways reference.
    pub(crate) nodes_named: u64,
    /// The node ids of the current way.
    node_ids: Vec<i64>,
}

/// The criteria for the ways of a block.
pub(crate) struct WayJudge<'a> {
    /// Keys and values of the block's tags.
    texts: &'a [&'a [u8]],
    /// The same as text, decoded at the first use: many ways share texts, and roads use only a few
    /// of them.
    read: Vec<OnceCell<Text<'a>>>,
    /// The numbers of the texts that are the key `highway`; usually one.
    highway: Vec<usize>,
    /// The numbers of the texts that are the key `railway`; none if railways are not requested.
    railway: Vec<usize>,
    table: &'a FrcTable,
}

impl<'a> WayJudge<'a> {
    /// Creates the criteria from `texts`, the keys and values of the block's tags.
    pub(crate) fn new(
        texts: &'a [&'a [u8]],
        table: &'a FrcTable,
        are_railways_wanted: bool,
    ) -> Self {
        let numbers =
            |key: &[u8]| (0..texts.len()).filter(|&text| texts[text] == key).collect::<Vec<_>>();
        let highway = numbers(b"highway");
        let railway = if are_railways_wanted { numbers(b"railway") } else { Vec::new() };
        Self { texts, read: vec![OnceCell::new(); texts.len()], highway, railway, table }
    }

    /// Returns the text with this number. The block was checked, so every tag is in its table.
    fn text(&self, index: usize) -> Option<&Text<'a>> {
        let text = self.texts.get(index)?;
        Some(self.read.get(index)?.get_or_init(|| Text::new(text)))
    }

    /// Returns the tags of a way.
    fn texts_of(&self, way: &BlockWay<'_, '_>) -> impl Iterator<Item = [&Text<'a>; 2]> {
        way.pairs().filter_map(|[key, value]| Some([self.text(key)?, self.text(value)?]))
    }
}

/// The memory counted for each way, besides its nodes and texts, bytes.
const WAY_BYTES: usize = 240;

impl BlockWays {
    /// Checks whether a way is a road.
    pub(crate) fn look_at(
        &mut self,
        way: &BlockWay<'_, '_>,
        judge: &WayJudge<'_>,
        counted: Counted,
    ) {
        self.summary.ways_seen += 1;
        match counted {
            Counted::ByBlock => self.look_at_tags(way, judge),
            Counted::ByWay => self.look_at_alone(way, judge),
        }
    }

    /// Checks a way like `look_at`, but puts counts and defects into the way's record, because
    /// another extract may also contain the way.
    fn look_at_alone(&mut self, way: &BlockWay<'_, '_>, judge: &WayJudge<'_>) {
        let mut own = Self { node_ids: std::mem::take(&mut self.node_ids), ..Self::default() };
        own.look_at_tags(way, judge);
        let Self { roads, located, defects, summary, held_bytes, nodes_named, node_ids } = own;
        self.node_ids = node_ids;
        self.nodes_named += nodes_named;
        self.located.extend(located);
        self.held_bytes += held_bytes;
        for mut road in roads {
            road.facts = WayFacts { counts: summary.clone(), defects: defects.clone() }.to_bytes();
            self.held_bytes += road.facts.len() as u64;
            self.roads.push(road);
        }
    }

    fn look_at_tags(&mut self, way: &BlockWay<'_, '_>, judge: &WayJudge<'_>) {
        // Most ways are buildings and land cover; their tags need no decoding.
        if !way.keys().any(|key| judge.highway.contains(&key)) {
            if way.keys().any(|key| judge.railway.contains(&key)) {
                self.look_at_railway(way, judge);
            }
            return;
        }
        // Space for the tags of nearly every way.
        let mut tags: Vec<(&str, &str)> = Vec::with_capacity(16);
        let (mut is_damaged, mut is_cut) = (false, false);
        for [key, value] in judge.texts_of(way) {
            for text in [key, value] {
                is_damaged |= matches!(text.text, Cow::Owned(_));
                is_cut |= text.is_cut;
            }
            tags.push((&*key.text, &*value.text));
        }
        let way_id = way.id;
        if is_damaged {
            self.push_defect(ExtractDefect::DamagedText { way_id });
        }
        if is_cut {
            self.push_defect(ExtractDefect::LongText { way_id });
        }
        self.judge(way, &tags, judge.table);
    }

    /// Stores a way that is a railway without a `highway` tag. It is not counted, and has no
    /// defects but those of layers with railways.
    fn look_at_railway(&mut self, way: &BlockWay<'_, '_>, judge: &WayJudge<'_>) {
        let texts = judge.texts_of(way);
        let tags: Vec<(&str, &str)> =
            texts.map(|[key, value]| (&*key.text, &*value.text)).collect();
        if let Some(kind) = Railway::from_tags(&tags) {
            let (structure, layer) = structure_and_layer(&tags);
            self.keep(way, 0, |ids| railway_bytes(ids, Track { kind, structure, layer }));
        }
    }

    fn push_defect(&mut self, defect: ExtractDefect) {
        // Values are also in the summary.
        let text_bytes = 2 * defect.detail().map_or(0, str::len);
        self.held_bytes += (2 * size_of::<ExtractDefect>() + text_bytes) as u64;
        self.defects.push(defect);
    }

    fn judge(&mut self, way: &BlockWay<'_, '_>, tags: &[(&str, &str)], table: &FrcTable) {
        let way_id = way.id;
        let highway = tag(tags, "highway").unwrap_or_default();
        self.summary.highway_ways += 1;
        let left_out = &mut self.summary.left_out;
        let classified = table.classify(tags);
        match classified {
            Classified::Road(class) => {
                let attributes = attributes(tags);
                let text_bytes = attributes.text_bytes();
                self.keep(way, text_bytes, |ids| way_bytes(ids, class, &attributes));
                for (key, value) in tags_taken_otherwise(tags) {
                    let tag = format!("{key}={value}");
                    *self.summary.tags_taken_otherwise.entry(tag.clone()).or_default() += 1;
                    self.push_defect(ExtractDefect::TagTakenOtherwise { way_id, tag });
                }
            }
            Classified::NotShown(_) => {
                left_out.class_off += 1;
                self.leave_out(way, (LeftOutReason::ClassOff, highway), (tags, true));
            }
            Classified::NotARoad(NotARoad::Area) => {
                left_out.area += 1;
                self.leave_out(way, (LeftOutReason::Area, highway), (tags, false));
                self.push_defect(ExtractDefect::Area { way_id });
            }
            Classified::NotARoad(NotARoad::Listed | NotARoad::NoHighway) => {
                left_out.listed += 1;
                self.leave_out(way, (LeftOutReason::Listed, highway), (tags, false));
            }
            Classified::Unknown(value) => {
                left_out.unknown += 1;
                self.leave_out(way, (LeftOutReason::Unknown, value), (tags, true));
                *self.summary.unknown_highways.entry(value.to_owned()).or_default() += 1;
                self.push_defect(ExtractDefect::UnknownHighway { way_id, value: value.to_owned() });
                return;
            }
        }
        // An outline of a surface would have a class by its value alone.
        let by_value = match classified {
            Classified::NotARoad(NotARoad::Area) => table.classify(&[("highway", highway)]),
            _ => classified,
        };
        let class = match by_value {
            Classified::Road(class) | Classified::NotShown(class) => Some(class),
            Classified::NotARoad(_) | Classified::Unknown(_) => None,
        };
        // Only a new value requires a copy of its text.
        match self.summary.highways.get_mut(highway) {
            Some(count) => count.ways += 1,
            None => drop(
                self.summary.highways.insert(highway.to_owned(), HighwayCount { class, ways: 1 }),
            ),
        }
    }

    /// Stores a way that is not a road here: for its length, and, if it is a road of another class
    /// or a railway, for what it carries.
    fn leave_out(
        &mut self,
        way: &BlockWay<'_, '_>,
        (reason, highway): (LeftOutReason, &str),
        (tags, is_road): (&[(&str, &str)], bool),
    ) {
        let railway = if is_road { None } else { Railway::from_tags(tags) };
        let carries = (is_road && !is_area(tags)) || railway.is_some();
        let carrier = carries.then(|| structure_and_layer(tags));
        let left_out = LeftOutWay { reason, highway, carrier, railway };
        self.keep(way, highway.len(), |ids| left_out_bytes(ids, left_out));
    }

    fn keep(
        &mut self,
        way: &BlockWay<'_, '_>,
        text_bytes: usize,
        to_bytes: impl FnOnce(&[i64]) -> Box<[u8]>,
    ) {
        let before = self.located.len();
        way.take_nodes(&mut self.node_ids, &mut self.located);
        self.nodes_named += self.node_ids.len() as u64;
        let has_locations = self.located.len() > before;
        let location_bytes = if has_locations { size_of::<(i64, Location)>() } else { 0 };
        let node_bytes = size_of::<i64>() + location_bytes;
        // Lists grow by doubling; each node is sorted twice.
        self.held_bytes += (text_bytes + WAY_BYTES + 2 * self.node_ids.len() * node_bytes) as u64;
        self.roads.push(WayRecord {
            way_id: way.id,
            origin: Origin::of_version(way.info.version),
            bytes: to_bytes(&self.node_ids),
            facts: Box::default(),
        });
    }
}

/// Adds the counts of a later block.
pub(crate) fn add_summary(own: &mut ExtractSummary, later: ExtractSummary) {
    own.nodes_seen += later.nodes_seen;
    own.ways_seen += later.ways_seen;
    own.highway_ways += later.highway_ways;
    own.left_out.listed += later.left_out.listed;
    own.left_out.class_off += later.left_out.class_off;
    own.left_out.unknown += later.left_out.unknown;
    own.left_out.area += later.left_out.area;
    add_counts(&mut own.unknown_highways, later.unknown_highways);
    add_counts(&mut own.tags_taken_otherwise, later.tags_taken_otherwise);
    for (value, count) in later.highways {
        own.highways.entry(value).and_modify(|own| own.ways += count.ways).or_insert(count);
    }
}

fn add_counts(own: &mut BTreeMap<String, u64>, other: BTreeMap<String, u64>) {
    for (value, count) in other {
        *own.entry(value).or_default() += count;
    }
}
