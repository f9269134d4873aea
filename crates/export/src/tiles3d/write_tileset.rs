//! Writes a package as 3D Tiles into an empty folder.

use std::{
    collections::BTreeMap,
    fs,
    io::{self, BufWriter, Write as _},
    path::Path,
};

use corniche_geom::TileId;
use corniche_tileset::{FilePackage, Manifest};
use corniche_work::{Observer, Stage, workers::side_by_side};

use super::{
    content::{self, LevelOfTiles, TileContentFacts, TileRoads, Tiles3dRequest},
    glb,
    parts::TileContent,
    placed::{TileBox, TilePlacement, step_m},
    tree::{Tree, content_name},
    vector_style,
};
use crate::{
    error::{SelectionError, Tiles3dError},
    globe::{RootFrame, between, dot, geocentric_m},
    places::Places,
    read,
    surfaces::{SurfaceLines, SurfaceRoads},
};

/// The least distance of a chord from the earth's surface, divided by its squared length: one over
/// eight radii, with the largest radius.
const LEAST_BOW: f64 = 1.0 / (8.0 * 6_400_000.0);
/// The length of the chords that measure how far straight lines of the CRS bend.
const BOW_CHORD_M: f64 = 5_000.0;
/// The largest deviation of a triangle edge from the ground that it represents, metres.
const LARGEST_SAG_M: f64 = 0.004;
/// The largest deviation from the package's ground, except on very wide tiles.
const LARGEST_ERROR_M: f64 = 0.009;
/// The folder of roads as vector content: a separate tileset.
const VECTOR_FOLDER: &str = "roads";
/// The longest triangle edge, whatever its sag.
const LONGEST_EDGE_M: f64 = 550.0;
/// On tiles of many kilometres the sag may be larger, so that the earth's curvature alone never
/// divides a side into more parts than this.
const MOST_PARTS_OF_A_SIDE: f64 = 128.0;

/// The figures of an export of 3D Tiles.
#[derive(Debug, Clone, PartialEq)]
pub struct Tiles3dSummary {
    /// Each level, root first.
    pub levels: Vec<Tiles3dLevel>,
    /// The number of documents (tilesets that refer to one another).
    pub documents: u64,
    /// What heights refer to, in words.
    pub heights: String,
}

/// The figures of a level.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Tiles3dLevel {
    /// The level.
    pub level: u8,
    /// Tiles with ground.
    pub tiles: u64,
    /// Triangles of the package's ground.
    pub package_triangles: u64,
    /// Triangles that were written, including roads, without skirts.
    pub triangles: u64,
    /// Triangles of roads among them.
    pub road_triangles: u64,
    /// Bytes of the tiles' files.
    pub bytes: u64,
    /// The time for cutting roads into the ground, for all tiles, seconds.
    pub cut_s: f64,
    /// Largest `geometricError`.
    pub error_m: f64,
    /// The step of positions, metres.
    pub step_m: f64,
}

/// Writes a package as 3D Tiles into an empty folder. After an error the content of the folder is
/// incomplete.
///
/// # Errors
/// When heights above the ellipsoid cannot be computed, the package has no such level or is
/// corrupt, or something cannot be written.
pub fn export_tiles3d(
    package: &FilePackage,
    request: &Tiles3dRequest,
    folder: &Path,
    observer: &dyn Observer,
) -> Result<Tiles3dSummary, Tiles3dError> {
    let manifest = package.manifest();
    let finest = read::level(package, request.finest_level)?;
    let heights = Places::new(manifest, request.coordinates)?.heights;
    let mut ids = package.tile_ids()?;
    ids.retain(|id| id.z() <= finest);
    let root =
        RootFrame::at(manifest.coordinates.wgs84_from_working(manifest.data_bounds.center()));
    // For all tiles, so that a part has the same bytes as the whole.
    let levels = (0..=finest)
        .map(|level| level_of(manifest, level, reach_m(manifest, &root, level, &ids)))
        .collect();
    if let Some(bounds) = &request.bounds {
        ids.retain(|id| read::meets(manifest, *id, bounds));
    }
    make_folders(folder, &ids)?;
    let look = SurfaceRoads { classes: &request.classes, style: &request.style };
    let job = Job {
        package,
        request,
        folder,
        lines: SurfaceLines::new(package, look, finest),
        levels,
        root,
    };
    let mut made: BTreeMap<TileId, WrittenTile> = BTreeMap::new();
    side_by_side(
        (observer, Stage::ExportTiles),
        request.threads,
        &ids,
        || Ok(Places::new(manifest, request.coordinates)?),
        |places, id| job.tile(*id, places),
        |id, written| {
            made.extend(written.map(|written| (*id, written)));
            Ok::<(), Tiles3dError>(())
        },
    )?;
    let mut levels: Vec<Tiles3dLevel> = (0..=finest)
        .map(|level| Tiles3dLevel {
            level,
            step_m: job.levels[usize::from(level)].step_m,
            ..Tiles3dLevel::default()
        })
        .collect();
    let mut tree = Tree::new(manifest, made.iter().map(|(id, tile)| (*id, tile.facts)));
    for (id, WrittenTile { facts, bytes, .. }) in &made {
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
    let mut documents = tree.write(folder, &job.root)?;
    if request.roads == TileRoads::Vector {
        let with_roads = made.iter().filter(|(_, tile)| tile.has_vector);
        tree.with_vectors = Some(with_roads.map(|(id, _)| *id).collect());
        let vector_folder = folder.join(VECTOR_FOLDER);
        fs::create_dir_all(&vector_folder)?;
        documents += tree.write(&vector_folder, &job.root)?;
        vector_style::write(&vector_folder, &request.style)?;
    }
    Ok(Tiles3dSummary { levels, documents, heights })
}

/// Creates the folders of all tiles.
fn make_folders(folder: &Path, ids: &[TileId]) -> io::Result<()> {
    for id in ids {
        fs::create_dir_all(folder.join(id.z().to_string()).join(id.x().to_string()))?;
    }
    Ok(())
}

/// Returns the largest distance of vertices of a level's tiles from the middle of their tile along
/// any axis of the frame, with a margin.
fn reach_m(manifest: &Manifest, root: &RootFrame, level: u8, ids: &[TileId]) -> f64 {
    let data = manifest.data_bounds;
    let of_tile = |id: &TileId| {
        let tile = manifest.frame.tile_bounds(*id);
        let on = read::data_part(manifest, *id);
        // The middle of a tile may be far outside of small data.
        let [x, y] = tile.center();
        let xs = [on.min_x, x.clamp(data.min_x, data.max_x), on.max_x];
        let ys = [on.min_y, y.clamp(data.min_y, data.max_y), on.max_y];
        let mut around = TileBox::along([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
        for [x, y] in xs.into_iter().flat_map(|x| ys.map(|y| [x, y])) {
            let [lon, lat] = manifest.coordinates.wgs84_from_working([x, y]);
            for height_m in manifest.vertical.range_m {
                around.include(root.position_in_root([lon, lat, height_m]));
            }
        }
        around.longest_side_m() / 2.0
    };
    let of_level = ids.iter().filter(|id| id.z() == level).map(of_tile);
    // Sides bend a little between these places.
    of_level.fold(1.0, f64::max) * 1.02
}

/// Returns the largest distance between the middle of a straight line of the CRS and its chord,
/// divided by the squared length: caused by the earth's curvature, and where lines of the CRS bend
/// sideways, like parallels.
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
            let chord = between(one, other);
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
    // The least number of working metres per true metre: no edge is then longer than it seems.
    let scale = least_x.min(least_y);
    let tile = frame.tile_bounds(TileId::ROOT);
    let tiles = f64::from(1_u32 << level);
    let side_m = tile.width().max(tile.height()) / tiles / scale;
    let step_m = step_m(reach_m);
    // Including rounding, the deviation stays below a centimetre if the ground is no steeper than
    // 45 degrees.
    let beside_rounding = (LARGEST_ERROR_M - 2.0 * step_m) * 3.0 / 4.0;
    let bow = bow(manifest);
    let of_curvature = (side_m / MOST_PARTS_OF_A_SIDE).powi(2) * bow;
    let largest_sag_m = LARGEST_SAG_M.min(beside_rounding).max(of_curvature);
    let by_sag = (largest_sag_m / bow).sqrt();
    let longest_edge_m =
        if of_curvature >= largest_sag_m { by_sag } else { by_sag.min(LONGEST_EDGE_M) };
    // Inside a triangle, the sag is four thirds of that at its edges, and each axis is rounded by
    // half a step.
    let sag_m = largest_sag_m * 4.0 / 3.0 + step_m * 3.0_f64.sqrt() / 2.0;
    let above = &manifest.levels[usize::from(level.saturating_sub(1))];
    LevelOfTiles {
        steps_per_metre: scale / frame.lattice_step_m(),
        longest_edge_m,
        step_m,
        sag_m,
        // The largest distance between the ground of this level and that of the next coarser one.
        skirt_m: record.geometric_error_m + above.geometric_error_m + 2.0 * sag_m,
    }
}

/// A written tile.
struct WrittenTile {
    facts: TileContentFacts,
    /// The size of the tile's files.
    bytes: u64,
    /// Whether its roads are a separate file.
    has_vector: bool,
}

/// The inputs for creating all tiles.
struct Job<'a> {
    package: &'a FilePackage,
    request: &'a Tiles3dRequest,
    folder: &'a Path,
    lines: SurfaceLines<'a>,
    levels: Vec<LevelOfTiles>,
    root: RootFrame,
}

impl Job<'_> {
    fn tile(&self, id: TileId, places: &Places<'_>) -> Result<Option<WrittenTile>, Tiles3dError> {
        let level = &self.levels[usize::from(id.z())];
        let placing = TilePlacement { places, root: &self.root, step_m: level.step_m };
        let made = content::make(self.package, id, self.request, &self.lines, &placing, level)?;
        let Some(made) = made else { return Ok(None) };
        let write = |folder: &Path, content: &TileContent| -> io::Result<u64> {
            let mut file = BufWriter::new(fs::File::create(folder.join(content_name(id)))?);
            glb::write(content, self.package.manifest(), self.request, &mut file)?;
            file.flush()?;
            Ok(file.get_ref().metadata()?.len())
        };
        let mut bytes = write(self.folder, &made.content)?;
        if let Some(vector) = &made.vector {
            let folder = self.folder.join(VECTOR_FOLDER);
            make_folders(&folder, &[id])?;
            bytes += write(&folder, vector)?;
        }
        Ok(Some(WrittenTile { facts: made.facts, bytes, has_vector: made.vector.is_some() }))
    }
}
