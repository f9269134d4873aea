//! A rectangle of texels, some of which may have no photo.

/// A rectangle of texels, row by row from the north.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Texels {
    columns: usize,
    rows: usize,
    /// Red, green, blue, and 255 where there is a photo; all four are 0 where there is none.
    rgba: Vec<u8>,
}

/// A texel without a photo.
pub(crate) const NONE: [u8; 4] = [0; 4];

impl Texels {
    /// Texels without a photo.
    #[must_use]
    pub fn empty(columns: usize, rows: usize) -> Self {
        Self { columns, rows, rgba: vec![0; columns * rows * 4] }
    }

    /// Returns texels from red, green, blue and alpha; alpha is 255 for texels with a photo, and 0
    /// for others, which have no colour. `None` if there are not four bytes for each texel, or if
    /// they have other values.
    #[must_use]
    pub fn new(columns: usize, rows: usize, rgba: Vec<u8>) -> Option<Self> {
        let is_texel = |texel: &[u8]| texel[3] == 255 || *texel == NONE;
        let fits = rgba.len() == columns.checked_mul(rows)?.checked_mul(4)?;
        (fits && rgba.chunks_exact(4).all(is_texel)).then_some(Self { columns, rows, rgba })
    }

    /// Texels along a row.
    #[must_use]
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// All texels: red, green, blue, alpha.
    #[must_use]
    pub fn rgba(&self) -> &[u8] {
        &self.rgba
    }

    /// All texels: red, green, blue, alpha, without a copy.
    #[must_use]
    pub fn into_rgba(self) -> Vec<u8> {
        self.rgba
    }

    /// One texel.
    ///
    /// # Panics
    /// When the texel is outside the rectangle.
    #[must_use]
    pub fn at(&self, column: usize, row: usize) -> [u8; 4] {
        let at = (row * self.columns + column) * 4;
        [0, 1, 2, 3].map(|channel| self.rgba[at + channel])
    }

    /// Whether no texel has a photo.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rgba.chunks_exact(4).all(|texel| texel[3] == 0)
    }

    pub(crate) fn set(&mut self, column: usize, row: usize, texel: [u8; 4]) {
        let at = (row * self.columns + column) * 4;
        self.rgba[at..at + 4].copy_from_slice(&texel);
    }

    /// Copies the rectangle of `from` that begins at `[column, row]` there and has `size` columns
    /// and rows, to `to` in this one.
    ///
    /// # Panics
    /// When one of the two rectangles is not inside its texels.
    pub fn copy(
        &mut self,
        from: &Self,
        [column, row]: [usize; 2],
        size: [usize; 2],
        to: [usize; 2],
    ) {
        let [columns, rows] = size;
        for r in 0..rows {
            let source = ((row + r) * from.columns + column) * 4;
            let target = ((to[1] + r) * self.columns + to[0]) * 4;
            self.rgba[target..target + columns * 4]
                .copy_from_slice(&from.rgba[source..source + columns * 4]);
        }
    }

    /// Returns a part of the rectangle.
    ///
    /// # Panics
    /// When the part is not inside the rectangle.
    #[must_use]
    pub fn part(&self, start: [usize; 2], size: [usize; 2]) -> Self {
        let mut part = Self::empty(size[0], size[1]);
        part.copy(self, start, size, [0, 0]);
        part
    }

    /// Returns texels twice as large: each is the mean of those of its four texels that have a
    /// photo, halves rounded up. A texel has a photo if at least two of its four have one.
    ///
    /// Means are computed from the stored values, as in GDAL and tools for map tiles, rather than
    /// from linear light: a photo that is averaged here equals one that was averaged before. The
    /// calculation uses integers, so the result is the same on every processor.
    ///
    /// # Panics
    /// When there is an odd number of columns or rows.
    #[must_use]
    pub fn halved(&self) -> Self {
        assert!(self.columns.is_multiple_of(2) && self.rows.is_multiple_of(2), "four texels");
        let mut half = Self::empty(self.columns / 2, self.rows / 2);
        for row in 0..half.rows {
            for column in 0..half.columns {
                let four = [(0, 0), (1, 0), (0, 1), (1, 1)]
                    .map(|(c, r)| self.at(2 * column + c, 2 * row + r));
                half.set(column, row, mean(four));
            }
        }
        half
    }
}

/// The mean of the texels that have a photo.
fn mean(four: [[u8; 4]; 4]) -> [u8; 4] {
    let count = four.iter().filter(|texel| texel[3] != 0).count() as u16;
    if count < 2 {
        return NONE;
    }
    let channel = |k: usize| {
        let sum: u16 =
            four.iter().filter(|texel| texel[3] != 0).map(|texel| u16::from(texel[k])).sum();
        ((sum + count / 2) / count) as u8
    };
    [channel(0), channel(1), channel(2), 255]
}

#[cfg(test)]
#[path = "texels_tests.rs"]
mod tests;
