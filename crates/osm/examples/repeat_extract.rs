//! Writes copies of an extract next to each other into one sorted extract: large inputs for
//! measurements, with real ways.
//!
//! ```sh
//! cargo run -p corniche-osm --example repeat_extract -- IN.osm.pbf OUT.osm.pbf COPIES [all|roads] [EAST NORTH]
//! ```
//!
//! Nodes and ways are renumbered, relations are skipped. The copies form a square, EAST and NORTH
//! degrees apart; by default, these are the width and the height of the extract. `roads` keeps only
//! ways with a `highway` tag and their nodes. The same arguments give the same bytes.
#![expect(clippy::print_stdout, reason = "an example prints its result")]

use std::{
    collections::{BTreeMap, BTreeSet},
    env,
    error::Error,
    fs::File,
    io::{BufWriter, Write},
};

use corniche_testing::pbf::{BlockBuilder, deltas, field, header, number, packed_blob, varint};
use osmpbf::{Element, ElementReader};

/// The number of objects that writers usually put into a block.
const PER_BLOCK: usize = 8000;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [input, output, copies, rest @ ..] = arguments.as_slice() else {
        return Err("usage: repeat_extract IN OUT COPIES [all|roads] [EAST NORTH]".into());
    };
    let copies: i64 = copies.parse()?;
    let (is_all, step) = match rest {
        [] => (true, None),
        [what] => (what != "roads", None),
        [what, east, north] => (what != "roads", Some([east.parse::<f64>()?, north.parse()?])),
        _ => return Err("EAST and NORTH must be given together".into()),
    };
    let original = Original::read(input, is_all)?;
    let step = step.map_or_else(|| original.extent(), |step| step.map(to_steps));
    let mut file = BufWriter::new(File::create(output)?);
    file.write_all(&header(&["OsmSchema-V0.6", "DenseNodes"]))?;
    let side = (copies as f64).sqrt().ceil().max(1.0) as i64;
    for copy in 0..copies {
        original.write_nodes(&mut file, copy, [copy % side * step[0], copy / side * step[1]])?;
    }
    for copy in 0..copies {
        original.write_ways(&mut file, copy)?;
    }
    file.flush()?;
    let [nodes, ways] = [original.nodes.len(), original.ways.len()].map(|count| count as i64);
    println!("{} nodes, {} ways", nodes * copies, ways * copies);
    Ok(())
}

/// Converts degrees to units of 1e-7 degrees.
fn to_steps(deg: f64) -> i64 {
    (deg * 1e7).round() as i64
}

/// The extract to repeat, with its nodes and ways in order of their ids.
struct Original {
    /// Longitudes and latitudes, in units of 1e-7 degrees.
    nodes: Vec<[i64; 2]>,
    ways: Vec<Way>,
    /// All keys and values.
    texts: BlockBuilder,
}

struct Way {
    /// The fields of the way's message with keys and values.
    tags: Vec<u8>,
    /// The indices of the way's nodes.
    nodes: Vec<i64>,
}

impl Original {
    fn read(path: &str, is_all: bool) -> Result<Self, Box<dyn Error>> {
        let (mut places, mut ways) = (BTreeMap::new(), BTreeMap::new());
        let mut texts: BTreeMap<String, u64> = BTreeMap::new();
        ElementReader::from_path(path)?.for_each(|element| match element {
            Element::Node(node) => drop(places.insert(node.id(), [node.lon(), node.lat()])),
            Element::DenseNode(node) => drop(places.insert(node.id(), [node.lon(), node.lat()])),
            Element::Way(way) if is_all || way.tags().any(|(key, _)| key == "highway") => {
                let tags: Vec<_> =
                    way.tags().map(|(key, value)| [key, value].map(str::to_owned)).collect();
                for text in tags.iter().flatten() {
                    texts.insert(text.clone(), 0);
                }
                ways.insert(way.id(), (tags, way.refs().collect::<Vec<i64>>()));
            }
            Element::Way(_) | Element::Relation(_) => {}
        })?;
        let mut table = BlockBuilder::new();
        for (number, (text, index)) in (1..).zip(&mut texts) {
            table.texts.push(text.clone().into_bytes());
            *index = number;
        }
        let needed: BTreeSet<i64> = ways.values().flat_map(|(_, nodes)| nodes).copied().collect();
        places.retain(|id, _| is_all || needed.contains(id));
        // Nodes that the extract lacks are numbered after its own nodes, in the same way in every
        // copy.
        let missing = needed.iter().filter(|id| !places.contains_key(id));
        let index: BTreeMap<i64, i64> = places.keys().chain(missing).copied().zip(0..).collect();
        let ways = ways.values().map(|(tags, nodes)| {
            let column =
                |at: usize| tags.iter().flat_map(|tag| varint(texts[&tag[at]])).collect::<Vec<_>>();
            let tags = [field(2, &column(0)), field(3, &column(1))].concat();
            Way { tags, nodes: nodes.iter().map(|id| index[id]).collect() }
        });
        let ways = ways.collect();
        Ok(Self {
            nodes: places.values().map(|deg| deg.map(to_steps)).collect(),
            ways,
            texts: table,
        })
    }

    /// Returns the width and the height of the extract, and a little more.
    fn extent(&self) -> [i64; 2] {
        [0, 1].map(|axis| {
            let along = || self.nodes.iter().map(|node| node[axis]);
            along().max().zip(along().min()).map_or(0, |(most, least)| most - least + 1000)
        })
    }

    /// Returns the id of a copy's first node, including the missing nodes of the copies before it.
    fn first_node(&self, copy: i64) -> i64 {
        let missing = self.ways.iter().flat_map(|way| &way.nodes).max().map_or(0, |&most| most + 1);
        1 + copy * missing.max(self.nodes.len() as i64)
    }

    fn write_nodes(
        &self,
        file: &mut impl Write,
        copy: i64,
        [east, north]: [i64; 2],
    ) -> Result<(), Box<dyn Error>> {
        let first = self.first_node(copy);
        for (some, id) in self.nodes.chunks(PER_BLOCK).zip((first..).step_by(PER_BLOCK)) {
            let shifted = (id..).zip(some).map(|(id, [lon, lat])| (id, lat + north, lon + east));
            let nodes: Vec<_> = shifted.collect();
            if nodes
                .iter()
                .any(|(_, lat, lon)| lat.abs() > 900_000_000 || lon.abs() > 1_800_000_000)
            {
                return Err(format!(
                    "copy {copy} is outside the Earth's coordinates; set EAST and NORTH"
                )
                .into());
            }
            let mut block = BlockBuilder::new();
            block.dense(&nodes);
            file.write_all(&packed_blob(b"OSMData", &block.bytes()))?;
        }
        Ok(())
    }

    fn write_ways(&self, file: &mut impl Write, copy: i64) -> Result<(), Box<dyn Error>> {
        let first_node = self.first_node(copy);
        let first_way = 1 + copy * self.ways.len() as i64;
        for (some, first) in self.ways.chunks(PER_BLOCK).zip((first_way..).step_by(PER_BLOCK)) {
            let ways = (first..).zip(some).flat_map(|(id, way)| {
                let nodes: Vec<i64> = way.nodes.iter().map(|node| first_node + node).collect();
                field(3, &[&*number(1, id), &way.tags, &field(8, &deltas(&nodes))].concat())
            });
            let block = BlockBuilder { groups: vec![ways.collect()], ..self.texts.clone() };
            file.write_all(&packed_blob(b"OSMData", &block.bytes()))?;
        }
        Ok(())
    }
}
