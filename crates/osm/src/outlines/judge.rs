//! Finds the objects and the outline ways of a block.

use corniche_layers::OsmObject;
use corniche_roads::{Structure, structure_and_layer};
use corniche_store::record_bytes;
use osmpbf::{PrimitiveBlock, RelMemberType, Relation};

use super::{
    records::{Member, ObjectRecord},
    wanted::WantedObjects,
};
use crate::{
    block::{BlockNode, BlockWay},
    location::{Location, location_from_nano},
    records::{Origin, WayRecord},
    search::IdSearch,
    text::Text,
    way_bytes::node_bytes,
};

/// The criteria for the ways and relations of a block.
pub(crate) struct OutlineJudge<'a> {
    wanted: WantedObjects<'a>,
    /// Keys and values of the block's tags.
    texts: &'a [&'a [u8]],
    /// Whether each of the texts is a key of such an object.
    is_key: Vec<bool>,
}

/// The objects of one kind in a block, in the block's order.
#[derive(Default)]
pub(crate) struct OfBlock {
    pub(crate) objects: Vec<ObjectRecord>,
    /// The ids of ways with area tags that are not closed.
    pub(crate) open_ways: Vec<i64>,
    /// The ways of outlines.
    pub(crate) ways: Vec<WayRecord>,
    /// The positions of nodes, in files whose ways contain them (`LocationsOnWays`).
    pub(crate) located: Vec<(i64, Location)>,
    /// The memory of all this, bytes, by an estimate that is never too low.
    pub(crate) held_bytes: u64,
    /// The node ids of the current way.
    node_ids: Vec<i64>,
}

/// The memory counted for each object, besides its texts and lists, bytes.
const OBJECT_BYTES: usize = 200;
/// The memory counted for each way, besides its nodes, bytes.
const WAY_BYTES: usize = 160;

/// The minimum number of node references in a ring: three different points, and the first again.
const LEAST_REFS: usize = 4;

impl<'a> OutlineJudge<'a> {
    pub(crate) fn new(texts: &'a [&'a [u8]], wanted: WantedObjects<'a>) -> Self {
        let is_key = texts.iter().map(|text| wanted.is_key(text)).collect();
        Self { wanted, texts, is_key }
    }

    /// Whether the text with this number is a key of such an object.
    pub(crate) fn is_key(&self, text: usize) -> bool {
        self.is_key.get(text) == Some(&true)
    }

    /// Whether one of the keys belongs to such an object. Most ways and relations have no such key,
    /// and their tags need no decoding.
    fn is_any_key(&self, mut keys: impl Iterator<Item = usize>) -> bool {
        keys.any(|key| self.is_key(key))
    }

    /// Returns the structure that carries a way; the ground if the layer does not need it.
    fn structure_of(&self, way: &BlockWay<'_, '_>) -> Structure {
        if !self.wanted.has_spans() {
            return Structure::Ground;
        }
        structure_and_layer(&self.tags(way.pairs()).plain()).0
    }

    /// Returns the text with this number. The block was checked: every tag is in its table.
    fn text(&self, index: usize) -> Text<'a> {
        Text::new(self.texts.get(index).copied().unwrap_or_default())
    }

    /// Returns the tags of an object, which are given by the numbers of their texts.
    fn tags(&self, pairs: impl Iterator<Item = [usize; 2]>) -> Tags<'a> {
        Tags(pairs.map(|pair| pair.map(|index| self.text(index))).collect())
    }
}

impl OfBlock {
    /// Checks whether a way is an object by its own tags.
    pub(crate) fn look_at_object(
        &mut self,
        way: &BlockWay<'_, '_>,
        judge: &OutlineJudge<'_>,
    ) -> bool {
        if !judge.wanted.has_ways() || !judge.is_any_key(way.keys()) {
            return false;
        }
        let tags = judge.tags(way.pairs());
        let wanted = judge.wanted;
        // Closed ways may be lines, such as hedges around a field, but the tags of the table are
        // tags of areas.
        let mut class = wanted
            .classify(&tags.plain())
            .filter(|_| wanted.has_open_ways() || !tags.is("area", "no"));
        let is_open = || way.refs().count() < LEAST_REFS || way.refs().next() != way.refs().last();
        if class.is_some() && !wanted.has_open_ways() && is_open() {
            self.open_ways.push(way.id);
            self.held_bytes += 16;
            class = None;
        }
        let is_coastline = wanted.has_sea() && tags.is("natural", "coastline");
        if class.is_none() && !is_coastline {
            return false;
        }
        let member = Member { way_id: way.id, is_inner: false };
        let what = (OsmObject::Way(way.id), way.info.version);
        self.push(what, (class, is_coastline), (&tags, judge.wanted), Box::new([member]));
        true
    }

    /// Stores a way of an outline.
    pub(crate) fn keep(&mut self, way: &BlockWay<'_, '_>, judge: &OutlineJudge<'_>) {
        way.take_nodes(&mut self.node_ids, &mut self.located);
        // Ids and positions are each sorted twice.
        self.held_bytes += (WAY_BYTES + 48 * self.node_ids.len()) as u64;
        self.ways.push(WayRecord {
            way_id: way.id,
            origin: Origin::of_version(way.info.version),
            bytes: node_bytes(&self.node_ids, judge.structure_of(way)),
            facts: Box::default(),
        });
    }

    /// Checks the relations of a block.
    pub(crate) fn look_at_relations(&mut self, block: &PrimitiveBlock, judge: &OutlineJudge<'_>) {
        for relation in block.groups().flat_map(|group| group.relations()) {
            self.look_at_relation(&relation, judge);
        }
    }

    fn look_at_relation(&mut self, relation: &Relation<'_>, judge: &OutlineJudge<'_>) {
        if !judge.wanted.has_ways() {
            return;
        }
        let pairs = relation.raw_tags().map(|(key, value)| [key as usize, value as usize]);
        if !judge.is_any_key(pairs.clone().map(|[key, _]| key)) {
            return;
        }
        let tags = judge.tags(pairs);
        let kind = tags.value("type").unwrap_or_default();
        let class = judge.wanted.classify(&tags.plain());
        let Some(class) = class.filter(|_| judge.wanted.is_relation_type(kind)) else {
            return;
        };
        let role = |role: i32| {
            let role = usize::try_from(role).ok().and_then(|role| judge.texts.get(role));
            role.copied().unwrap_or_default()
        };
        let ways = relation.members().filter(|member| member.member_type == RelMemberType::Way);
        let mut ways: Vec<Member> = ways
            .map(|way| (way.member_id, role(way.role_sid)))
            .filter(|(_, role)| judge.wanted.is_role(role))
            .map(|(way_id, role)| Member { way_id, is_inner: role == b"inner" })
            .collect();
        // A way that is referenced twice counts once, as in libosmium.
        ways.sort_unstable();
        ways.dedup_by_key(|way| way.way_id);
        let version = relation.info().version().unwrap_or_default();
        let what = (OsmObject::Relation(relation.id()), version);
        self.push(what, (Some(class), false), (&tags, judge.wanted), ways.into());
    }

    /// Checks a node with these tags, given by the numbers of their texts.
    pub(crate) fn look_at_node(
        &mut self,
        node: &BlockNode,
        pairs: &[[usize; 2]],
        judge: &OutlineJudge<'_>,
    ) {
        let tags = judge.tags(pairs.iter().copied());
        let class = judge.wanted.classify(&tags.plain());
        if class.is_none() {
            return;
        }
        let what = (OsmObject::Node(node.id), node.version);
        self.push(what, (class, false), (&tags, judge.wanted), Box::default());
        if let Some(object) = self.objects.last_mut() {
            object.at = Some(location_from_nano(node.lon_nano_deg, node.lat_nano_deg));
        }
    }

    fn push(
        &mut self,
        (object, version): (OsmObject, i32),
        (class, is_coastline): (Option<u8>, bool),
        (tags, wanted): (&Tags<'_>, WantedObjects<'_>),
        ways: Box<[Member]>,
    ) {
        let (values, unread) = wanted.values(&tags.plain());
        let values: Box<[u8]> = record_bytes(values).into();
        // Each way is sorted twice more.
        let own_bytes = values.len() + unread.len() + 80 * ways.len();
        self.held_bytes += (OBJECT_BYTES + own_bytes) as u64;
        self.objects.push(ObjectRecord {
            object,
            origin: Origin::of_version(version),
            class,
            is_coastline,
            values,
            unread: unread.into(),
            ways,
            at: None,
        });
    }
}

/// The treatment of ways that are objects by their own tags.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum OwnTags {
    /// The ways are ignored, because all objects were found before.
    Ignored,
    /// Objects are found, and their ways are stored.
    Kept,
    /// Objects were found and their ways stored before, so they are not stored again.
    KeptBefore,
}

/// The ways of a block to look for: by their own tags, or by their ids.
pub(crate) struct WantedWays<'a> {
    pub(crate) own_tags: OwnTags,
    pub(crate) ids: IdSearch<'a>,
}

impl WantedWays<'_> {
    /// Checks a way.
    pub(crate) fn look_at(
        &mut self,
        way: &BlockWay<'_, '_>,
        judge: &OutlineJudge<'_>,
        found: &mut OfBlock,
    ) {
        let is_kept = match self.own_tags {
            OwnTags::Ignored => self.ids.find(way.id).is_some(),
            OwnTags::Kept => found.look_at_object(way, judge) || self.ids.find(way.id).is_some(),
            OwnTags::KeptBefore => {
                self.ids.find(way.id).is_some() && !OfBlock::default().look_at_object(way, judge)
            }
        };
        if is_kept {
            found.keep(way, judge);
        }
    }
}

/// The tags of an object that has one of the keys.
struct Tags<'a>(Vec<[Text<'a>; 2]>);

impl Tags<'_> {
    fn plain(&self) -> Vec<(&str, &str)> {
        self.0.iter().map(|[key, value]| (&*key.text, &*value.text)).collect()
    }

    fn value(&self, key: &str) -> Option<&str> {
        self.0.iter().find(|[own, _]| own.text == key).map(|[_, value]| &*value.text)
    }

    fn is(&self, key: &str, value: &str) -> bool {
        self.value(key) == Some(value)
    }
}
