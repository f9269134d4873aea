use corniche_geom::TILE_NODES;
use corniche_tin::{Tin, TinVertex};

use crate::limits::{MAX_TRIANGLES, MAX_VERTICES, max_walk_steps};
use crate::payload::connectivity::{Edges, GUESSES, Guide, NAMED, NONE, walk};
use crate::payload::corner_guess::Nodes;
use crate::payload::damage::Damage;
use crate::payload::number_codes::{Cursor, unzigzag};
use crate::payload::terrain::guess::{guess_height, guess_normals};
use crate::payload::terrain::record::{RECORD_BYTES, Record, Scale, check_measures};
use crate::payload::tile_payload::Terrain;
use crate::payload::work_limit::Work;

pub(crate) fn decode(bytes: &[u8], scale: Scale) -> Result<Terrain, Damage> {
    let mut cursor = Cursor::new(bytes);
    let config = bincode::config::legacy().with_limit::<RECORD_BYTES>();
    let (record, _): (Record, usize) =
        bincode::serde::decode_from_slice(cursor.take(RECORD_BYTES)?, config)
            .map_err(|_| Damage::Invalid { what: "the record of the section" })?;
    check_measures(record.geometric_error_m, record.height_range_m, record.uncovered_nodes, scale)
        .map_err(|what| Damage::Invalid { what })?;
    let count = at_most(record.vertices, MAX_VERTICES, "number of vertices")?;
    let triangle_count = at_most(record.triangles, MAX_TRIANGLES, "number of triangles")?;
    let at = decode_nodes(&mut cursor, count)?;
    let work = Work::new(max_walk_steps(count, triangle_count));
    let nodes = Nodes::new(at.iter().copied(), &work);
    let mut player = Player {
        symbols: Cursor::new(cursor.take(record.symbols as usize)?),
        named: Cursor::new(cursor.take(record.named as usize)?),
        last: 0,
    };
    let (triangles, order) = walk(&nodes, triangle_count, &mut player)?;
    player.symbols.finish()?;
    player.named.finish()?;
    let residuals = cursor.planes(count)?;
    if record.height_shift >= 32 {
        return Err(Damage::Invalid { what: "the common factor of the heights" });
    }
    // In units of 2^height_shift steps.
    let mut heights = vec![0_i32; count];
    let mut previous = 0;
    for (reached, residual) in order.iter().zip(residuals.iter()) {
        let guess = guess_height(reached, &heights, previous);
        previous = guess.wrapping_add(unzigzag(residual) as i32);
        heights[reached.vertex as usize] = previous;
    }
    let vertices: Vec<TinVertex> = at
        .iter()
        .zip(&heights)
        .map(|(&[column, row], &height)| TinVertex {
            row,
            column,
            height_q: height << record.height_shift,
        })
        .collect();
    let normals = guess_normals(&vertices, &triangles, scale);
    let tin = Tin::new(vertices, &triangles)?;
    let (east, north) = (cursor.take(count)?, cursor.take(count)?);
    cursor.finish()?;
    let normals = normals
        .iter()
        .zip(east.iter().zip(north))
        .map(|(guess, (&e, &n))| [guess[0].wrapping_add(e as i8), guess[1].wrapping_add(n as i8)])
        .collect();
    Ok(Terrain {
        tin,
        normals,
        geometric_error_m: record.geometric_error_m,
        height_range_m: record.height_range_m,
        uncovered_nodes: record.uncovered_nodes,
    })
}

fn at_most(count: u32, limit: usize, what: &'static str) -> Result<usize, Damage> {
    let count = count as usize;
    if count > limit {
        return Err(Damage::TooLarge { what, length: count as u64, limit: limit as u64 });
    }
    Ok(count)
}

/// Columns and rows: how many vertices each row has, then the gaps between their columns.
fn decode_nodes(cursor: &mut Cursor<'_>, count: usize) -> Result<Vec<[u16; 2]>, Damage> {
    let what = "positions of the vertices";
    let mut per_row = [0; TILE_NODES];
    for row in &mut per_row {
        *row = cursor.bounded(TILE_NODES, what)?;
    }
    if per_row.iter().sum::<usize>() != count {
        return Err(Damage::Invalid { what });
    }
    let mut at = Vec::with_capacity(count);
    for (row, &in_row) in per_row.iter().enumerate() {
        let mut next = 0;
        for _ in 0..in_row {
            let column = next + cursor.bounded(TILE_NODES, what)?;
            if column >= TILE_NODES {
                return Err(Damage::Invalid { what });
            }
            at.push([column as u16, row as u16]);
            next = column + 1;
        }
    }
    Ok(at)
}

/// Finds triangles by reading symbols.
struct Player<'a> {
    symbols: Cursor<'a>,
    named: Cursor<'a>,
    /// First vertex of the last start.
    last: u32,
}

impl Player<'_> {
    fn vertex(&mut self) -> Result<u32, Damage> {
        self.named.bounded(MAX_VERTICES, "a named vertex").map(|vertex| vertex as u32)
    }
}

impl Guide for Player<'_> {
    fn start(&mut self, _: &Edges<'_>) -> Result<[u32; 3], Damage> {
        let a = self.last + self.vertex()?;
        self.last = a;
        // Each corner is above the first, which is the smallest; the sum of two bounded numbers is in range.
        Ok([a, a + 1 + self.vertex()?, a + 1 + self.vertex()?])
    }

    fn corner(
        &mut self,
        _: [u32; 2],
        guess: &dyn Fn(&[u32]) -> Option<u32>,
    ) -> Result<Option<u32>, Damage> {
        let Some(first) = guess(&[]) else { return Ok(None) };
        match self.symbols.byte()? {
            NONE => Ok(None),
            1 => Ok(Some(first)),
            rank @ 2..=GUESSES => {
                let mut no = vec![first];
                loop {
                    let next = guess(&no)
                        .ok_or(Damage::Invalid { what: "a guess that does not exist" })?;
                    no.push(next);
                    if no.len() == usize::from(rank) {
                        return Ok(Some(next));
                    }
                }
            }
            NAMED => self.vertex().map(Some),
            _ => Err(Damage::Invalid { what: "a symbol of the walk" }),
        }
    }
}
