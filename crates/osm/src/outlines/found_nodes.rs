//! Finds the nodes of layers of points while an extract is read.

use corniche_store::Sorter;

use super::{
    found::OutlineObjects,
    judge::{OfBlock, OutlineJudge},
    number_objects::number_objects,
    records::ObjectRecord,
    wanted::WantedObjects,
};
use crate::{
    ExtractDefect, block::AuditedBlock, extracts::TOO_MUCH_FOUND, failed::Failed,
    looked::check_held, reading::ExtractReading,
};

/// The nodes of all layers of points that were found so far.
pub(crate) struct FoundNodes<'a> {
    layers: Vec<NodesOfLayer<'a>>,
}

/// The nodes of a layer.
struct NodesOfLayer<'a> {
    /// The number of the layer.
    number: usize,
    wanted: WantedObjects<'a>,
    nodes: Sorter<'a, ObjectRecord>,
    count: u64,
    /// The memory of the nodes, bytes, by an estimate that is never too low.
    held_bytes: u64,
}

/// The layers of points for which blocks are scanned.
pub(crate) struct NodeScan<'w>(Vec<WantedObjects<'w>>);

impl NodeScan<'_> {
    /// Returns the nodes of a block for each layer of points.
    pub(crate) fn scan(
        &self,
        block: &AuditedBlock<'_>,
        most_bytes: u64,
    ) -> Result<Vec<OfBlock>, &'static str> {
        let mut found: Vec<OfBlock> = self.0.iter().map(|_| OfBlock::default()).collect();
        if found.is_empty() {
            return Ok(found);
        }
        let texts = block.texts();
        let judges: Vec<OutlineJudge<'_>> =
            self.0.iter().map(|&wanted| OutlineJudge::new(&texts, wanted)).collect();
        let is_wanted = |key| judges.iter().any(|judge| judge.is_key(key));
        block.try_each_tagged(is_wanted, |node, pairs| {
            if pairs.iter().flatten().any(|&text| text >= texts.len()) {
                return Err("a tag of a node refers to a string that is not in the string table");
            }
            for (found, judge) in found.iter_mut().zip(&judges) {
                found.look_at_node(&node, pairs, judge);
            }
            let held_bytes: u64 = found.iter().map(|own| own.held_bytes).sum();
            if held_bytes > most_bytes { Err(TOO_MUCH_FOUND) } else { Ok(()) }
        })?;
        Ok(found)
    }
}

impl<'a> FoundNodes<'a> {
    /// Creates the list for the layers of points among some layers.
    pub(crate) fn new(reading: &ExtractReading<'a>, layers: &[WantedObjects<'a>]) -> Self {
        let layers = layers.iter().enumerate().filter(|(_, wanted)| wanted.has_nodes());
        let of_layer = |(number, &wanted): (usize, &WantedObjects<'a>)| NodesOfLayer {
            number,
            wanted,
            nodes: reading.sorter(reading.shares().objects / 2),
            count: 0,
            held_bytes: 0,
        };
        Self { layers: layers.map(of_layer).collect() }
    }

    /// Returns the layers for which blocks are scanned.
    pub(crate) fn scanned(&self) -> NodeScan<'a> {
        NodeScan(self.layers.iter().map(|layer| layer.wanted).collect())
    }

    /// Adds the nodes of a block of one of the extracts.
    pub(crate) fn take(
        &mut self,
        reading: &ExtractReading<'_>,
        file: u32,
        of_block: Vec<OfBlock>,
    ) -> Result<(), Failed> {
        for (layer, found) in self.layers.iter_mut().zip(of_block) {
            layer.held_bytes += found.held_bytes;
            check_held(reading, layer.held_bytes)?;
            for mut node in found.objects {
                node.origin.place(reading, file, &mut layer.count);
                layer.nodes.push(node)?;
            }
        }
        Ok(())
    }

    /// Gives the nodes that count to the objects of their layers.
    pub(crate) fn number(
        self,
        reading: &ExtractReading<'a>,
        objects: &mut [OutlineObjects<'a>],
    ) -> Result<(), Failed> {
        for NodesOfLayer { number, wanted, nodes, .. } in self.layers {
            let Some(own) = objects.get_mut(number) else { continue };
            let on_defect = &mut |defect: ExtractDefect| own.defects.push(&defect);
            own.nodes = Some(number_objects(reading, (nodes, wanted), on_defect)?);
        }
        Ok(())
    }
}
