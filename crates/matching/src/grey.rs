//! A rectangle of brightness, or of slopes.

/// Values at the centres of texels, row by row from the north; NaN where there is none.
#[derive(Debug, Clone)]
pub(crate) struct Grey {
    /// Texel of the first value, eastwards and southwards.
    pub(crate) first: [i64; 2],
    pub(crate) columns: usize,
    pub(crate) values: Vec<f32>,
}

impl Grey {
    /// The value at a place in texels, where the centre of texel (0, 0) is (0.5, 0.5): from the four centres around it. NaN where one of
    /// them has none.
    pub(crate) fn at(&self, [u, v]: [f64; 2]) -> f32 {
        let (x, y) = (u - 0.5 - self.first[0] as f64, v - 0.5 - self.first[1] as f64);
        let (column, row) = (x.floor(), y.floor());
        let rows = self.values.len() / self.columns.max(1);
        let is_inside = column >= 0.0
            && row >= 0.0
            && column + 1.0 < self.columns as f64
            && row + 1.0 < rows as f64;
        if !is_inside {
            return f32::NAN;
        }
        let at = row as usize * self.columns + column as usize;
        let [fx, fy] = [(x - column) as f32, (y - row) as f32];
        let mix = |a: f32, b: f32, share: f32| a + (b - a) * share;
        let north = mix(self.values[at], self.values[at + 1], fx);
        let below = at + self.columns;
        let south = mix(self.values[below], self.values[below + 1], fx);
        mix(north, south, fy)
    }
}

#[cfg(test)]
#[path = "grey_tests.rs"]
mod tests;
