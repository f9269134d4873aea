//! Reads windows of texels from the pixels of photos, block by block.

use corniche_geom::Bounds;
use corniche_gis::{FileUse, OpenRasters, RasterError};

use crate::filter::{Filter, Pixels, PremultipliedColour};
use crate::photo_file::{PlacedPhoto, overlap};
use crate::positions::{MESH, MeshPositions};
use crate::{PhotoError, PhotoGrid, TexelGrid, TexelWindow, Texels};

/// The most pixels that are read at once, unless a single mesh needs more.
const MOST_PIXELS: i64 = 1 << 21;
/// Meshes along a side of the blocks of texels that are computed at once.
const BLOCK_MESHES: i64 = 8;

/// Reads texels from photos.
pub struct PhotoReader<'a> {
    grid: &'a PhotoGrid,
    open: OpenRasters,
    filter: Filter,
}

/// A rectangle of meshes: the first, and one past the last.
#[derive(Clone, Copy)]
struct MeshRectangle {
    from: [i64; 2],
    to: [i64; 2],
}

impl<'a> PhotoReader<'a> {
    /// Returns a reader of the texels of these photos; each thread needs its own reader.
    #[must_use]
    pub fn new(grid: &'a PhotoGrid) -> Self {
        Self { grid, open: OpenRasters::default(), filter: Filter::default() }
    }

    /// Returns the texels of a window.
    ///
    /// # Errors
    /// When a file cannot be read.
    pub fn window(&mut self, window: TexelWindow) -> Result<Texels, PhotoError> {
        let mut texels = Texels::empty(window.columns, window.rows);
        let end = [window.u + window.columns as i64, window.v + window.rows as i64];
        let last = [end[0] - 1, end[1] - 1].map(|at| at.div_euclid(MESH));
        let first = [window.u, window.v].map(|at| at.div_euclid(MESH));
        let mut lights = Vec::new();
        for block_v in (first[1]..=last[1]).step_by(BLOCK_MESHES as usize) {
            for block_u in (first[0]..=last[0]).step_by(BLOCK_MESHES as usize) {
                let from = [block_u, block_v];
                let to = [0, 1].map(|axis| (from[axis] + BLOCK_MESHES).min(last[axis] + 1));
                self.block(MeshRectangle { from, to }, &mut lights)?;
                put(&lights, MeshRectangle { from, to }, &window, &mut texels);
            }
        }
        Ok(texels)
    }

    /// Returns the contributions of all photos to the texels of a block, row by row.
    fn block(
        &mut self,
        block: MeshRectangle,
        lights: &mut Vec<PremultipliedColour>,
    ) -> Result<(), PhotoError> {
        let size = block.texels();
        lights.clear();
        lights.resize((size[0] * size[1]) as usize, PremultipliedColour::default());
        let bounds = block.bounds(self.grid.texels());
        for (index, photo) in self.grid.photos.iter().enumerate() {
            if overlap(&photo.bounds, &bounds) {
                self.photo(index, photo, block, block, lights)?;
            }
        }
        Ok(())
    }

    /// Blends a photo beneath `lights`, the texels of `all`, for the meshes of `part`.
    fn photo(
        &mut self,
        index: usize,
        photo: &PlacedPhoto,
        part: MeshRectangle,
        all: MeshRectangle,
        lights: &mut [PremultipliedColour],
    ) -> Result<(), PhotoError> {
        let mut meshes = Vec::new();
        for v in part.from[1]..part.to[1] {
            for u in part.from[0]..part.to[0] {
                meshes.extend(MeshPositions::new(self.grid.texels(), &photo.on_grid, [u, v])?);
            }
        }
        let Some([start, end]) = pixels_of(&meshes, photo.file.raster.size()) else {
            return Ok(());
        };
        let size = [end[0] - start[0], end[1] - start[1]];
        if size[0] * size[1] > MOST_PIXELS && !part.is_one() {
            for quarter in part.quarters() {
                self.photo(index, photo, quarter, all, lights)?;
            }
            return Ok(());
        }
        let pixels = self.read(index, photo, start, size)?;
        let columns = all.texels()[0];
        for mesh in &meshes {
            let first = mesh.first();
            for row in 0..MESH {
                let at = first[1] + row - all.from[1] * MESH;
                for column in 0..MESH {
                    let at = (at * columns + first[0] + column - all.from[0] * MESH) as usize;
                    // Opaque texels hide everything beneath them.
                    if lights[at].opacity < 1.0 {
                        let found =
                            self.filter.at(&pixels, mesh.position_at([column, row]), mesh.radius);
                        lights[at] = lights[at].over(found);
                    }
                }
            }
        }
        Ok(())
    }

    fn read(
        &mut self,
        index: usize,
        photo: &PlacedPhoto,
        start: [i64; 2],
        size: [i64; 2],
    ) -> Result<Pixels, RasterError> {
        let path = photo.file.raster.path();
        let dataset = self.open.dataset(index, path, FileUse::Photo)?;
        let [start, size] = [start, size].map(|pair| pair.map(|value| value as usize));
        photo.file.bands.read(path, dataset, start, size)
    }
}

/// Returns the pixels that meshes need: the first, and one past the last. `None` if none of them is
/// in the photo.
fn pixels_of(meshes: &[MeshPositions], size: [usize; 2]) -> Option<[[i64; 2]; 2]> {
    let mut low = [f64::INFINITY; 2];
    let mut high = [f64::NEG_INFINITY; 2];
    for mesh in meshes {
        let [from, to] = mesh.reach();
        low = [0, 1].map(|axis| low[axis].min(from[axis]));
        high = [0, 1].map(|axis| high[axis].max(to[axis]));
    }
    // Conversions to integers saturate.
    let start = [0, 1].map(|axis| (low[axis].floor() as i64).max(0));
    let end = [0, 1].map(|axis| (high[axis].ceil() as i64).min(size[axis] as i64));
    (start[0] < end[0] && start[1] < end[1]).then_some([start, end])
}

/// Copies the texels of a block that are in a window to their place in the window.
fn put(
    lights: &[PremultipliedColour],
    block: MeshRectangle,
    window: &TexelWindow,
    texels: &mut Texels,
) {
    let [columns, rows] = block.texels();
    for row in 0..rows {
        let v = block.from[1] * MESH + row - window.v;
        if !(0..window.rows as i64).contains(&v) {
            continue;
        }
        for column in 0..columns {
            let u = block.from[0] * MESH + column - window.u;
            if (0..window.columns as i64).contains(&u) {
                let light = lights[(row * columns + column) as usize];
                texels.set(u as usize, v as usize, light.texel());
            }
        }
    }
}

impl MeshRectangle {
    /// Texels along both sides.
    fn texels(&self) -> [i64; 2] {
        [0, 1].map(|axis| (self.to[axis] - self.from[axis]) * MESH)
    }

    fn is_one(&self) -> bool {
        self.to[0] - self.from[0] <= 1 && self.to[1] - self.from[1] <= 1
    }

    /// Returns four quarters, some of which may be empty.
    fn quarters(&self) -> impl Iterator<Item = Self> + use<> {
        let Self { from, to } = *self;
        let middle = [0, 1].map(|axis| i64::midpoint(from[axis], to[axis] + 1));
        let halves = move |axis: usize| [[from[axis], middle[axis]], [middle[axis], to[axis]]];
        halves(1).into_iter().flat_map(move |rows| {
            halves(0)
                .into_iter()
                .map(move |columns| Self { from: [columns[0], rows[0]], to: [columns[1], rows[1]] })
        })
    }

    /// Returns the rectangle in working metres.
    fn bounds(&self, grid: &TexelGrid) -> Bounds {
        let at = |mesh: [i64; 2]| grid.position_m(mesh.map(|mesh| (mesh * MESH) as f64));
        let ([min_x, max_y], [max_x, min_y]) = (at(self.from), at(self.to));
        Bounds { min_x, min_y, max_x, max_y }
    }
}
