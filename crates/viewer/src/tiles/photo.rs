//! The photo of a tile in four sizes, ready for the GPU.

use corniche_tileset::Photo;
use serde::{Deserialize, Serialize};

use super::blocks;

/// The photo of a tile, ready to be uploaded: four sizes, each half as large as the previous one.
///
/// More sizes are not needed: a tile whose texels are more than eight times too fine is replaced by
/// a coarser one. Also, in smaller sizes the border of eight texels would no longer surround the
/// tile.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct PhotoImage {
    /// Texels along a side, border included.
    pub(crate) side: u32,
    /// Red, green, blue and alpha of each texel, row by row from the north; the finest size first.
    #[serde(with = "blocks::plain")]
    rgba: Vec<u8>,
}

impl PhotoImage {
    /// Number of sizes.
    pub(crate) const SIZES: usize = 4;

    /// Creates the smaller sizes.
    #[must_use]
    pub fn new(photo: Photo) -> Self {
        let side = photo.side();
        let second = halved(&photo.rgba, side);
        let third = halved(&second, side / 2);
        let fourth = halved(&third, side / 4);
        let mut rgba = photo.rgba;
        for size in [second, third, fourth] {
            rgba.extend(size);
        }
        Self { side: side as u32, rgba }
    }

    /// The texels of each size: their side, and red, green, blue and alpha of each, row by row from
    /// the north; the finest size first.
    pub(crate) fn sizes(&self) -> impl Iterator<Item = (u32, &[u8])> {
        let mut rest = &self.rgba[..];
        (0..Self::SIZES).map(move |level| {
            let side = self.side >> level;
            let (size, smaller) = rest.split_at(4 * side as usize * side as usize);
            rest = smaller;
            (side, size)
        })
    }

    /// Bytes of all sizes.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.rgba.len() as u64
    }
}

/// Returns the photo at half its size: the mean of each square of four texels, alpha likewise.
/// Texels without a photo have colours that continue those of their neighbours, so colours need no
/// weights.
fn halved(rgba: &[u8], side: usize) -> Vec<u8> {
    let half = side / 2;
    let row_bytes = side * 4;
    let mut out = Vec::with_capacity(half * half * 4);
    for row in 0..half {
        let top = &rgba[2 * row * row_bytes..][..row_bytes];
        let bottom = &rgba[(2 * row + 1) * row_bytes..][..row_bytes];
        for (a, b) in top.chunks_exact(8).zip(bottom.chunks_exact(8)) {
            for k in 0..4 {
                let sum = [a[k], a[k + 4], b[k], b[k + 4]].map(u16::from).iter().sum::<u16>();
                out.push(((sum + 2) / 4) as u8);
            }
        }
    }
    out
}

#[cfg(test)]
#[path = "photo_tests.rs"]
mod tests;
