//! What the walk says at a gate, as bits in contexts under which "guess 1" is nearly free.

use crate::payload::connectivity::{GUESSES, Guesses, NAMED, NONE};
use crate::payload::corner_guess::{Corner, Nodes};
use crate::payload::damage::Damage;
use crate::payload::magnitudes::{Magnitudes, half_octave};
use crate::payload::range_coder::{Bits, Model};

/// How the quadrangle of a gate, its corner and guess 1 looks; see [`shape`].
const SHAPES: usize = 5;
/// Half-octaves of a gate's length.
const LENGTHS: usize = 6;
/// What the walk met at the gate's two ends before; see [`Symbols::code`].
const HISTORIES: usize = 16;

/// What a coder knows of the symbols, and of the vertices that are named.
pub(crate) struct Symbols {
    is_first: [[[Model; LENGTHS]; 2]; SHAPES],
    is_first_here: [[[Model; HISTORIES]; 2]; SHAPES],
    is_none: [[Model; HISTORIES]; SHAPES],
    is_next: [[Model; GUESSES as usize]; 2],
    /// What was met at each vertex: 1, there was a gate without triangle; 2, there was another guess than the first.
    met: Vec<u8>,
    numbers: Magnitudes<1, 1>,
}

/// Gate, corner behind it, and guess 1: 0 or 1 where a circle through three of them leaves the fourth outside (1, by little),
/// 2 where all lie on one circle, 3 or 4 where the fourth lies inside, so that the gate is no edge of a Delaunay triangulation.
fn shape(nodes: &Nodes<'_>, gate: [u32; 3], first: Corner) -> usize {
    let [dot, cross] = nodes.behind(gate);
    // The sum of both cotangents, times both crosses.
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
        Self {
            is_first: [[[Model::NEW; LENGTHS]; 2]; SHAPES],
            is_first_here: [[[Model::NEW; HISTORIES]; 2]; SHAPES],
            is_none: [[Model::NEW; HISTORIES]; SHAPES],
            is_next: [[Model::NEW; GUESSES as usize]; 2],
            met: vec![0; vertices],
            numbers: Magnitudes::new(),
        }
    }

    /// Codes the symbol at a gate for which there is a guess 1.
    pub(crate) fn code<B: Bits>(
        &mut self,
        bits: &mut B,
        &Guesses { gate, nodes, .. }: &Guesses<'_, '_>,
        first: Corner,
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

    /// Codes a number of the kind that names vertices; what no vertex can have is refused.
    pub(crate) fn number<B: Bits>(&mut self, bits: &mut B, number: u32) -> Result<u32, Damage> {
        let number = self.numbers.code(bits, [0, 0], i64::from(number));
        u32::try_from(number).map_err(|_| Damage::Invalid("a named vertex"))
    }
}
