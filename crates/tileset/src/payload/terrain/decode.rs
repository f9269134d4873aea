//! Decodes the terrain section: finds the triangles by the same walk as the encoder.

use corniche_tin::{Tin, TinVertex};

use crate::{
    limits::{MAX_VERTICES, max_walk_steps},
    payload::{
        connectivity::{Edges, GateAnswer, Guesses, Guide, NAMED, NONE, walk},
        corner_guess::GridVertices,
        damage::{Damage, Result},
        envelope::{self, StoredSection},
        number_codes::Cursor,
        range_coder::BitReader,
        section_kind::SectionKind,
        terrain::{
            heights::code_heights,
            normals::{code_normals, guess_normals},
            positions::code_positions,
            record::{Scale, TerrainSectionHead},
            symbols::Symbols,
        },
        tile_payload::TileTerrain,
        work_limit::StepBudget,
    },
};

/// Reads the fixed part of the terrain section among these sections; `None` without ground.
pub(crate) fn record_in(
    sections: &[StoredSection<'_>],
    scale: Scale,
) -> Result<Option<TerrainSectionHead>> {
    let section = envelope::section(sections, SectionKind::Terrain)?;
    section.map(|section| TerrainSectionHead::read(&mut Cursor::new(&section), scale)).transpose()
}

pub(crate) fn decode(bytes: &[u8], scale: Scale) -> Result<TileTerrain> {
    let mut cursor = Cursor::new(bytes);
    let record = TerrainSectionHead::read(&mut cursor, scale)?;
    let mut bits = BitReader::new(cursor.take(cursor.left())?);
    let at = code_positions(&mut bits, || false);
    let work = StepBudget::new(max_walk_steps(at.len(), record.triangles));
    let nodes = GridVertices::new(at.iter().copied(), &work);
    let mut player = Player { symbols: Symbols::new(at.len()), bits: &mut bits, last: 0 };
    let (triangles, order) = walk(&nodes, record.triangles, &mut player)?;
    // The heights are in units of 2^height_shift steps.
    let mut heights = vec![0_i32; at.len()];
    code_heights(&mut bits, &at, &order, &mut heights)?;
    let vertices: Vec<TinVertex> = at
        .iter()
        .zip(&heights)
        .map(|(&[column, row], &height)| TinVertex {
            row,
            column,
            height_q: height << record.height_shift,
        })
        .collect();
    let guesses = guess_normals(&vertices, &triangles, scale, record.normal_shift);
    let mut normals = vec![[0_i8; 2]; at.len()];
    code_normals(&mut bits, &order, &guesses, record.normal_shift, &mut normals);
    bits.finish()?;
    Ok(TileTerrain {
        tin: Tin::new(vertices, &triangles)?,
        normals,
        geometric_error_m: record.geometric_error_m,
        height_range_m: record.height_range_m,
        uncovered_nodes: record.uncovered_nodes,
    })
}

/// Finds triangles by reading symbols.
struct Player<'a, 'b> {
    symbols: Symbols,
    bits: &'a mut BitReader<'b>,
    /// The first vertex of the previous start.
    last: u32,
}

impl Player<'_, '_> {
    fn vertex(&mut self) -> Result<u32> {
        let number = self.symbols.number(self.bits, 0)?;
        Damage::invalid_if(number as usize > MAX_VERTICES, "a named vertex")?;
        Ok(number)
    }
}

impl Guide for Player<'_, '_> {
    fn start(&mut self, found: &Edges<'_>) -> Result<[u32; 3]> {
        let a = self.last + self.vertex()?;
        Damage::invalid_if(a as usize >= found.vertices(), "a triangle's vertex")?;
        self.last = a;
        // Each corner is above the first, which is the smallest; the sum of two limited numbers is
        // in range.
        Ok([a, a + 1 + self.vertex()?, a + 1 + self.vertex()?])
    }

    fn corner(&mut self, guesses: &Guesses<'_, '_>) -> Result<GateAnswer> {
        let Some(first) = guesses.first() else { return Ok(GateAnswer::Nothing) };
        Damage::invalid_if(self.bits.is_past_end(), "the length of the coded bits")?;
        match self.symbols.code(self.bits, guesses, first, NONE) {
            NONE => Ok(GateAnswer::Nothing),
            1 => Ok(GateAnswer::Guessed(first.vertex)),
            NAMED => self.vertex().map(GateAnswer::Named),
            rank => {
                let mut no = vec![first.vertex];
                loop {
                    let next = guesses
                        .best_but(&no)
                        .ok_or(Damage::Invalid("a guess that does not exist"))?;
                    no.push(next.vertex);
                    if no.len() == usize::from(rank) {
                        return Ok(GateAnswer::Guessed(next.vertex));
                    }
                }
            }
        }
    }
}
