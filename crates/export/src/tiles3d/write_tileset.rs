//! A package is written as 3D Tiles into an empty folder.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    io::{self, BufWriter, Write as _},
    path::Path,
};

use corniche_geom::TileId;
use corniche_tileset::{FilePackage, Manifest};
use corniche_work::{Observer, Stage, workers::make_all};

use super::{
    content::{self, LevelOfTiles, TileFacts, TileRoads, Tiles3dRequest},
    glb,
    parts::TileContent,
    placed::{Placing, TileBox, step_m},
    tree::{Contents, Tree, content_name},
    vector_style,
};
use crate::{
    error::{SelectionError, Tiles3dError},
    globe::{RootFrame, dot, geocentric_m},
    places::Places,
    surfaces::{RoadLook, TileLines},
};

/// A chord is so far from the earth's surface at least: its square by eight radii, of which the largest is taken.
const LEAST_BOW: f64 = 1.0 / (8.0 * 6_400_000.0);
/// Length of the chords that tell how far straight lines of the CRS bend.
const BOW_CHORD_M: f64 = 5_000.0;
/// What an edge may be from the ground that it stands for, metres.
const LARGEST_SAG_M: f64 = 0.004;
/// What the ground may be from the package's, but on tiles that are very wide.
const LARGEST_ERROR_M: f64 = 0.009;
/// The folder of roads as vector content: a tileset of its own.
const VECTOR_FOLDER: &str = "roads";
/// No edge is longer, whatever the sag.
const LONGEST_EDGE_M: f64 = 550.0;
/// On tiles of many kilometres the sag may be larger, so that the earth's curvature alone never divides a side into more parts.
const MOST_PARTS_OF_A_SIDE: f64 = 128.0;

/// What was exported.
#[derive(Debug, Clone, PartialEq)]
pub struct Tiles3dSummary {
    /// Each level, root first.
    pub levels: Vec<Tiles3dLevel>,
    /// How many tilesets there are: documents that refer to one another.
    pub documents: u64,
    /// What heights are, in words.
    pub heights: String,
}

/// What was exported of a level.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Tiles3dLevel {
    /// The level.
    pub level: u8,
    /// Tiles with ground.
    pub tiles: u64,
    /// Triangles of the package's ground.
    pub package_triangles: u64,
    /// Triangles that were written, roads included, walls not.
    pub triangles: u64,
    /// Triangles of roads among them.
    pub road_triangles: u64,
    /// Bytes of the tiles' files.
    pub bytes: u64,
    /// Time for cutting roads in, of all tiles, seconds.
    pub cut_s: f64,
    /// Largest `geometricError`.
    pub error_m: f64,
    /// Step of positions, metres.
    pub step_m: f64,
}

/// Writes a package as 3D Tiles into an empty folder. After an error what is in it is of no use.
///
/// # Errors
/// When heights cannot be told above the ellipsoid, the package has no such level or is damaged, or something cannot be written.
pub fn export_tiles3d(
    package: &FilePackage,
    request: &Tiles3dRequest,
    folder: &Path,
    observer: &dyn Observer,
) -> Result<Tiles3dSummary, Tiles3dError> {
    let manifest = package.manifest();
    let finest = crate::read::level(package, request.finest_level)?;
    let heights = Places::new(manifest, request.coordinates)?.heights;
    let mut ids = package.tile_ids()?;
    ids.retain(|id| id.z() <= finest);
    let failed = |source| Tiles3dError::Write { source };
    let root =
        RootFrame::at(manifest.coordinates.wgs84_from_working(manifest.data_bounds.center()));
    // Of all tiles, so that a part has the same bytes as the whole.
    let levels = (0..=finest)
        .map(|level| level_of(manifest, level, reach_m(manifest, &root, level, &ids)))
        .collect();
    if let Some(bounds) = &request.bounds {
        ids.retain(|id| crate::read::meets(manifest, *id, bounds));
    }
    let vector_folder = folder.join(VECTOR_FOLDER);
    make_folders(folder, &ids).map_err(failed)?;
    let look = RoadLook { classes: &request.classes, style: &request.style };
    let job = Job {
        package,
        request,
        folder,
        lines: TileLines::new(package, look, finest),
        levels,
        root,
    };
    let made = job.run(&ids, observer)?;
    let mut levels: Vec<Tiles3dLevel> = (0..=finest)
        .map(|level| Tiles3dLevel {
            level,
            step_m: job.levels[usize::from(level)].step_m,
            ..Tiles3dLevel::default()
        })
        .collect();
    let tree = Tree::new(manifest, made.iter().map(|(id, tile)| (*id, tile.tile_box, tile.facts)));
    for (id, Written { facts, bytes, .. }) in &made {
        let level = &mut levels[usize::from(id.z())];
        level.tiles += 1;
        level.package_triangles += facts.package_triangles;
        level.triangles += facts.triangles;
        level.road_triangles += facts.road_triangles;
        level.bytes += bytes;
        level.cut_s += facts.cut_s;
        level.error_m = level.error_m.max(facts.error_m);
    }
    if made.is_empty() {
        return Err(SelectionError::no_ground(package).into());
    }
    let mut documents = tree.write(folder, &job.root, &Contents::All).map_err(failed)?;
    if request.roads == TileRoads::Vector {
        let with_roads: BTreeSet<TileId> =
            made.iter().filter(|(_, tile)| tile.has_vector).map(|(id, _)| *id).collect();
        let contents = Contents::Vector(with_roads);
        fs::create_dir_all(&vector_folder).map_err(failed)?;
        documents += tree.write(&vector_folder, &job.root, &contents).map_err(failed)?;
        vector_style::write(&vector_folder, &request.style).map_err(failed)?;
    }
    Ok(Tiles3dSummary { levels, documents, heights })
}

/// Folders for all tiles.
fn make_folders(folder: &Path, ids: &[TileId]) -> io::Result<()> {
    for id in ids {
        fs::create_dir_all(folder.join(id.z().to_string()).join(id.x().to_string()))?;
    }
    Ok(())
}

/// How far vertices of a level's tiles are from the middle of their tile along any axis of the frame, with some to spare.
fn reach_m(manifest: &Manifest, root: &RootFrame, level: u8, ids: &[TileId]) -> f64 {
    let data = manifest.data_bounds;
    let of_tile = |id: &TileId| {
        let tile = manifest.frame.tile_bounds(*id);
        let on = crate::read::data_part(manifest, *id);
        // The middle of a tile may lie far beyond few data.
        let middle = |at: f64, [low, high]: [f64; 2]| at.clamp(low, high);
        let [x, y] = tile.center();
        let xs = [on.min_x, middle(x, [data.min_x, data.max_x]), on.max_x];
        let ys = [on.min_y, middle(y, [data.min_y, data.max_y]), on.max_y];
        let mut around = TileBox::along([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
        for [x, y] in xs.into_iter().flat_map(|x| ys.map(|y| [x, y])) {
            let [lon, lat] = manifest.coordinates.wgs84_from_working([x, y]);
            for height_m in manifest.vertical.range_m {
                around.include(root.of([lon, lat, height_m]));
            }
        }
        around.longest_side_m() / 2.0
    };
    let of_level = ids.iter().filter(|id| id.z() == level).map(of_tile);
    // Sides bend a little between these places.
    of_level.fold(1.0, f64::max) * 1.02
}

/// How far the middle of a straight line of the CRS is from its chord, over the square of its length, at most: by the earth's curvature, and where lines
/// of the CRS bend sideways, as parallels do.
fn bow(manifest: &Manifest) -> f64 {
    let data = manifest.data_bounds;
    let at = |[x, y]: [f64; 2]| {
        let [lon, lat] = manifest.coordinates.wgs84_from_working([x, y]);
        geocentric_m([lon, lat, 0.0])
    };
    let mut largest = LEAST_BOW;
    for place in [[data.min_x, data.min_y], data.center(), [data.max_x, data.max_y]] {
        for [dx, dy] in [[1.0, 0.0], [0.0, 1.0], [0.7, 0.7], [0.7, -0.7]] {
            let ends = [-0.5, 0.5]
                .map(|way| [place[0] + way * dx * BOW_CHORD_M, place[1] + way * dy * BOW_CHORD_M]);
            let ([one, other], middle) = (ends.map(at), at(place));
            let chord = [0, 1, 2].map(|k| other[k] - one[k]);
            let off = [0, 1, 2].map(|k| middle[k] - f64::midpoint(one[k], other[k]));
            let share = dot(off, off).sqrt() / dot(chord, chord);
            if share.is_finite() {
                largest = largest.max(share);
            }
        }
    }
    largest
}

fn level_of(manifest: &Manifest, level: u8, reach_m: f64) -> LevelOfTiles {
    let frame = &manifest.frame;
    let record = &manifest.levels[usize::from(level)];
    let [least_x, least_y] = manifest.scale.least;
    // So many working metres are a true one at least: then no edge is longer than it seems.
    let scale = least_x.min(least_y);
    let tile = frame.tile_bounds(TileId::ROOT);
    let tiles = f64::from(1_u32 << level);
    let side_m = tile.width().max(tile.height()) / tiles / scale;
    let step_m = step_m(reach_m);
    // Together with rounding, a centimetre is not exceeded where ground is no steeper than 45 degrees.
    let beside_rounding = (LARGEST_ERROR_M - 2.0 * step_m) * 3.0 / 4.0;
    let bow = bow(manifest);
    let of_curvature = (side_m / MOST_PARTS_OF_A_SIDE).powi(2) * bow;
    let largest_sag_m = LARGEST_SAG_M.min(beside_rounding).max(of_curvature);
    let by_sag = (largest_sag_m / bow).sqrt();
    let longest_edge_m =
        if of_curvature >= largest_sag_m { by_sag } else { by_sag.min(LONGEST_EDGE_M) };
    // Inside a triangle it is four thirds of that at its edges, and each axis is rounded by half a step.
    let sag_m = largest_sag_m * 4.0 / 3.0 + step_m * 3.0_f64.sqrt() / 2.0;
    let above = &manifest.levels[usize::from(level.saturating_sub(1))];
    LevelOfTiles {
        steps_per_metre: scale / frame.lattice_step_m(),
        longest_edge_m,
        step_m,
        sag_m,
        // Ground of this level and of the next coarser one are so far apart at most.
        skirt_m: record.geometric_error_m + above.geometric_error_m + 2.0 * sag_m,
    }
}

/// A tile that was written.
struct Written {
    tile_box: TileBox,
    facts: TileFacts,
    /// The size of the tile's files.
    bytes: u64,
    /// Whether its roads are a file of their own.
    has_vector: bool,
}

/// What all tiles are made with.
struct Job<'a> {
    package: &'a FilePackage,
    request: &'a Tiles3dRequest,
    folder: &'a Path,
    lines: TileLines<'a>,
    levels: Vec<LevelOfTiles>,
    root: RootFrame,
}

impl Job<'_> {
    fn run(
        &self,
        ids: &[TileId],
        observer: &dyn Observer,
    ) -> Result<BTreeMap<TileId, Written>, Tiles3dError> {
        observer.begin(Stage::ExportTiles, Some(ids.len() as u64));
        let made = make_all(
            (observer, Stage::ExportTiles),
            self.request.threads,
            ids,
            || Ok(Places::new(self.package.manifest(), self.request.coordinates)?),
            |places, id| self.tile(*id, places),
        )?;
        observer.end(Stage::ExportTiles);
        let written = ids.iter().zip(made);
        Ok(written.filter_map(|(id, written)| Some((*id, written?))).collect())
    }

    fn tile(&self, id: TileId, places: &Places<'_>) -> Result<Option<Written>, Tiles3dError> {
        let level = &self.levels[usize::from(id.z())];
        let placing = Placing { places, root: &self.root, step_m: level.step_m };
        let made = content::make(self.package, id, self.request, &self.lines, &placing, level)?;
        let Some(made) = made else { return Ok(None) };
        let write = |folder: &Path, content: &TileContent| {
            write_content(&folder.join(content_name(id)), content, self.request.compress)
                .map_err(|source| Tiles3dError::Write { source })
        };
        let mut bytes = write(self.folder, &made.content)?;
        if let Some(vector) = &made.vector {
            let folder = self.folder.join(VECTOR_FOLDER);
            make_folders(&folder, &[id]).map_err(|source| Tiles3dError::Write { source })?;
            bytes += write(&folder, vector)?;
        }
        Ok(Some(Written {
            tile_box: made.tile_box,
            facts: made.facts,
            bytes,
            has_vector: made.vector.is_some(),
        }))
    }
}

fn write_content(path: &Path, content: &TileContent, is_compressed: bool) -> io::Result<u64> {
    let mut file = BufWriter::new(fs::File::create(path)?);
    glb::write(content, is_compressed, &mut file)?;
    file.flush()?;
    Ok(file.get_ref().metadata()?.len())
}
