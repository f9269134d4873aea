//! Which road is seen at a position.

use corniche_geom::{LatticeBounds, LatticePoint};

use super::ribbon::Ribbon;

/// Squares along each side of a tile.
const SQUARES: usize = 128;

/// The parts of ribbons by the squares of a grid over the tile.
pub(crate) struct LabelIndex<'a> {
    /// Each part with the label of its ribbon.
    parts: Vec<(u32, &'a [LatticePoint])>,
    /// Places in `parts`, ascending, by square.
    squares: Vec<Vec<u32>>,
    middle: LatticePoint,
    bounds: LatticeBounds,
}

impl<'a> LabelIndex<'a> {
    pub(crate) fn new(ribbons: &'a [Ribbon], tile: &LatticeBounds, middle: LatticePoint) -> Self {
        let mut index = Self {
            parts: Vec::new(),
            squares: vec![Vec::new(); SQUARES * SQUARES],
            middle,
            bounds: *tile,
        };
        for (label, ribbon) in ribbons.iter().enumerate() {
            for part in &ribbon.parts {
                index.add(label as u32 + 1, part);
            }
        }
        index
    }

    fn add(&mut self, label: u32, part: &'a [LatticePoint]) {
        let Some(own) = LatticeBounds::of(part) else { return };
        if !own.intersects(&self.bounds) {
            return;
        }
        let number = self.parts.len() as u32;
        self.parts.push((label, part));
        let [from, to] =
            [own.min, own.max].map(|p| [self.column(p.u as f64), self.row(p.v as f64)]);
        for row in from[1]..=to[1] {
            for column in from[0]..=to[0] {
                self.squares[row * SQUARES + column].push(number);
            }
        }
    }

    fn column(&self, u: f64) -> usize {
        square(u, self.bounds.min.u, self.bounds.max.u)
    }

    fn row(&self, v: f64) -> usize {
        square(v, self.bounds.min.v, self.bounds.max.v)
    }

    /// The label at a position from the middle of the tile; 0 where there is no road.
    pub(crate) fn at(&self, at: [f64; 2]) -> u32 {
        let [u, v] = [at[0] + self.middle.u as f64, at[1] + self.middle.v as f64];
        let parts = &self.squares[self.row(v) * SQUARES + self.column(u)];
        let parts = parts.iter().map(|part| self.parts[*part as usize]);
        // Parts come in the order of ribbons.
        let mut found = parts.filter(|(_, part)| self.holds(part, at));
        found.next().map_or(0, |(label, _)| label)
    }

    /// Whether a position lies in a polygon, by the even-odd rule.
    fn holds(&self, part: &[LatticePoint], [x, y]: [f64; 2]) -> bool {
        let at = |p: LatticePoint| [(p.u - self.middle.u) as f64, (p.v - self.middle.v) as f64];
        let ends = part.iter().zip(part.iter().cycle().skip(1));
        let crossed = ends.filter(|(from, to)| {
            let ([fx, fy], [tx, ty]) = (at(**from), at(**to));
            (fy > y) != (ty > y) && x < fx + (tx - fx) * (y - fy) / (ty - fy)
        });
        crossed.count() % 2 == 1
    }
}

fn square(at: f64, from: i64, to: i64) -> usize {
    let share = (at - from as f64) / (to - from) as f64;
    ((share * SQUARES as f64).max(0.0) as usize).min(SQUARES - 1)
}
