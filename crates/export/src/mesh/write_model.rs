//! Writes the ground of a level as one model, with its roads as lines or as surfaces.

use std::{fs::File, io::BufWriter, path::Path};

use corniche_tileset::FilePackage;
use corniche_work::{Observer, Stage, workers::one_by_one};

use super::{
    glb::GlbWriter,
    mesh_request::{MeshFormat, MeshRequest, ModelRoads, UpAxis},
    model::{LocalMetres, TileReading},
    obj::ObjWriter,
    ply::PlyWriter,
    writer::MeshWriter,
};
use crate::{
    error::{MeshError, SelectionError},
    places::{FeatureCoordinates, Places},
    read,
    surfaces::{SurfaceKind, SurfaceLines, SurfaceRoads},
};

/// The figures of an export of a model.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MeshSummary {
    /// The level that was exported.
    pub level: u8,
    /// Tiles with ground.
    pub tiles: u64,
    /// Triangles of the ground, including roads as surfaces and slabs of bridges.
    pub triangles: u64,
    /// Triangles of roads.
    pub road_triangles: u64,
    /// Lines of roads.
    pub lines: u64,
    /// The model's origin in the package's CRS.
    pub origin: [f64; 2],
}

/// Writes the ground of a level, with its roads as lines or as surfaces, to a new file at `path`.
/// After an error that file is incomplete.
///
/// Positions are local: true metres east and north of an origin in the middle, and heights of the
/// package.
///
/// # Errors
/// When the package has no such level or no ground there, glTF is requested with another axis than
/// y upwards, the package is corrupt, or something cannot be written.
pub fn export_mesh(
    package: &FilePackage,
    request: &MeshRequest,
    path: &Path,
    observer: &dyn Observer,
) -> Result<MeshSummary, MeshError> {
    if request.format == MeshFormat::Glb && request.up == UpAxis::Z {
        return Err(MeshError::GlbAxis);
    }
    let manifest = package.manifest();
    let level = read::level(package, request.level)?;
    let places = Places::new(manifest, FeatureCoordinates::Package)?;
    let ids = read::tiles(package, level, request.bounds.as_ref())?;
    let nothing = || SelectionError::no_ground(package);
    // Tiles at the border of the data extend beyond it.
    let parts = ids.iter().map(|&id| read::data_part(manifest, id));
    let ground = parts.reduce(|one, other| one.union(&other)).ok_or_else(nothing)?;
    let local = LocalMetres::about(ground, manifest);
    let failed = |source| MeshError::Write { path: path.to_path_buf(), source };
    let mut writer: Box<dyn MeshWriter + '_> = match request.format {
        MeshFormat::Glb => Box::new(GlbWriter::new(path, &request.style).map_err(failed)?),
        MeshFormat::Ply => {
            let style = (request.roads == ModelRoads::Surfaces).then_some(&request.style);
            Box::new(PlyWriter::new(path, request.up, style).map_err(failed)?)
        }
        MeshFormat::Obj => {
            let file = request.material_file.clone();
            Box::new(ObjWriter::new(path, request.up, file).map_err(failed)?)
        }
    };
    let origin = local.origin(manifest);
    let mut summary = MeshSummary { level, origin, ..MeshSummary::default() };
    let look = SurfaceRoads { classes: &request.classes, style: &request.style };
    let lines =
        (request.roads == ModelRoads::Surfaces).then(|| SurfaceLines::new(package, look, level));
    let reading = TileReading { package, request, places: &places, local, lines };
    one_by_one((observer, Stage::ExportTiles), &ids, |&id| {
        if let Some(tile) = reading.read(id)? {
            summary.tiles += 1;
            summary.triangles += tile.triangles.len() as u64;
            let is_road = |kind: &&SurfaceKind| matches!(kind, SurfaceKind::Road(_));
            summary.road_triangles += tile.kinds.iter().filter(is_road).count() as u64;
            summary.lines += tile.roads.len() as u64;
            writer.tile(&tile).map_err(failed)?;
        }
        Ok::<(), MeshError>(())
    })?;
    if summary.tiles == 0 {
        return Err(nothing().into());
    }
    let mut facts = local.described(manifest);
    facts.push(("level", level.to_string()));
    let up = match request.up {
        UpAxis::Y => "x east, y up, z south",
        UpAxis::Z => "x east, y north, z up",
    };
    facts.push(("axes", up.to_owned()));
    let mut file = BufWriter::new(File::create(path).map_err(failed)?);
    writer.finish(&mut file, &facts).map_err(failed)?;
    file.into_inner().map_err(|error| failed(error.into_error()))?.sync_all().map_err(failed)?;
    Ok(summary)
}
