//! Codes the symbols of the walk as bits, in contexts in which "guess 1" takes almost no space.

use crate::payload::{
    connectivity::{GUESSES, Guesses, NAMED, NONE},
    corner_guess::{GateCorner, GridVertices},
    damage::{Damage, Result},
    magnitudes::{Magnitudes, half_octave},
    range_coder::{Bits, Model},
};

/// The number of shapes of the quadrangle of a gate, its corner and guess 1; see [`shape`].
const SHAPES: usize = 5;
/// The number of half-octaves of a gate's length.
const LENGTHS: usize = 6;
/// The number of histories at the gate's two ends; see [`Symbols::code`].
const HISTORIES: usize = 16;

/// The state of a coder of the symbols, and of named vertices.
#[derive(Default)]
pub(crate) struct Symbols {
    is_first: [[[Model; LENGTHS]; 2]; SHAPES],
    is_first_here: [[[Model; HISTORIES]; 2]; SHAPES],
    is_none: [[Model; HISTORIES]; SHAPES],
    is_next: [[Model; GUESSES as usize]; 2],
    /// The events at each vertex: 1, there was a gate without a triangle; 2, there was a guess
    /// other than the first.
    met: Vec<u8>,
    numbers: Magnitudes<1, 1>,
}

/// Returns the shape of the gate, the corner behind it, and guess 1: 0 or 1 if a circle through
/// three of them leaves the fourth outside (1: by little), 2 if all are on one circle, 3 or 4 if
/// the fourth is inside, so that the gate is not an edge of a Delaunay triangulation.
fn shape(nodes: &GridVertices<'_>, gate: [u32; 3], first: GateCorner) -> usize {
    let [dot, cross] = nodes.behind(gate);
    // The sum of both cotangents, multiplied by both cross products.
    let sum = dot * first.cross + first.dot * cross;
    let unit = cross * first.cross;
    match sum {
        0 => 2,
        1.. if 4 * sum < unit => 1,
        1.. => 0,
        _ if 2 * sum > -unit => 3,
        _ => 4,
    }
}

impl Symbols {
    pub(crate) fn new(vertices: usize) -> Self {
        Self { met: vec![0; vertices], ..Self::default() }
    }

    /// Codes the symbol at a gate for which there is a guess 1.
    pub(crate) fn code<B: Bits>(
        &mut self,
        bits: &mut B,
        &Guesses { gate, nodes, .. }: &Guesses<'_, '_>,
        first: GateCorner,
        symbol: u8,
    ) -> u8 {
        let [a, b, _] = gate;
        let shape = shape(nodes, gate, first);
        let tied = usize::from(first.is_tied);
        let length = half_octave(nodes.length_squared([a, b]).unsigned_abs()).min(LENGTHS) - 1;
        let history = usize::from(self.met[a as usize]) | usize::from(self.met[b as usize]) << 2;
        let models = [
            &mut self.is_first[shape][tied][length],
            &mut self.is_first_here[shape][tied][history],
        ];
        if bits.mixed(models, u32::from(symbol != 1)) == 0 {
            return 1;
        }
        let is_none = bits.bit(&mut self.is_none[shape][history], u32::from(symbol == NONE)) == 1;
        for end in [a, b] {
            self.met[end as usize] |= if is_none { 1 } else { 2 };
        }
        if is_none {
            return NONE;
        }
        let mut rank = 2;
        while rank < NAMED {
            let model = &mut self.is_next[tied][usize::from(rank) - 2];
            if bits.bit(model, u32::from(symbol > rank)) == 0 {
                break;
            }
            rank += 1;
        }
        rank
    }

    /// Codes a number of the kind that names vertices; fails for numbers that no vertex can have.
    pub(crate) fn number<B: Bits>(&mut self, bits: &mut B, number: u32) -> Result<u32> {
        let number = self.numbers.code(bits, [0, 0], i64::from(number));
        u32::try_from(number).map_err(|_| Damage::Invalid("a named vertex"))
    }
}
