//! `corniche export mesh`: the ground of a level as a model.

use std::{
    fs,
    path::{Path, PathBuf},
};

use corniche_export::{
    FileFormat as _, MeshFormat, MeshRequest, MeshSummary, ModelRoads, export_mesh,
};
use corniche_tileset::Manifest;

use super::vector_files::{self, tell};
use crate::{
    args::ExportMeshArgs,
    escaped::in_line,
    exit::ExitCode,
    failure::Failure,
    output::{Existing, Output, existing_of, named::NamedOutput},
    packages,
    progress::Progress,
    styles,
    table::{bytes, noted},
};

pub(crate) fn run(args: &ExportMeshArgs) -> Result<ExitCode, Failure> {
    let format = vector_files::format(args.format, &args.file.output)?;
    if args.relief == Some(true) && format != MeshFormat::Glb {
        return Err(Failure::unusable(format!(
            "--relief on: a model in .{} has no normal maps; write a .glb, or leave the option out",
            format.ending()
        )));
    }
    let style = styles::style(&args.style)?;
    let package = packages::open(&args.from.package)?;
    let has_materials = format == MeshFormat::Obj && args.roads == ModelRoads::Surfaces;
    let materials = has_materials.then(|| args.file.output.with_extension("mtl"));
    let request = MeshRequest {
        format,
        up: args.up.unwrap_or(format.usual_up()),
        level: args.at.level,
        bounds: args.within.bounds,
        roads: args.roads,
        classes: args.filter.classes.classes(),
        relief: args.relief != Some(false),
        style,
        material_file: materials.as_deref().map(file_name),
    };
    let name = format!("model.{}", format.ending());
    let existing = existing_of(args.file.overwrite);
    let output =
        NamedOutput::create(&args.file.output, existing, name, &[args.from.package.name()])?;
    let materials = materials.map(|path| Materials::begin(path, existing, args)).transpose()?;
    let exported =
        Progress::of(|progress| export_mesh(&package, &request, &output.path(), progress));
    let summary = exported.map_err(|error| Failure::from(error).about_target(&args.file.output))?;
    let placed = materials
        .map(|materials| materials.place(&request.materials(package.manifest())))
        .transpose()?;
    let size = output.place().inspect_err(|_| {
        // Materials without a model are of no use, but those that were there before belong to another one.
        if let Some(Some(new)) = &placed {
            let _ = fs::remove_file(new);
        }
    })?;
    tell(&args.file.output, &to_text(args, &summary, package.manifest(), size), package.manifest());
    Ok(ExitCode::Done)
}

/// The file of materials beside an OBJ.
struct Materials {
    path: PathBuf,
    output: Output,
}

impl Materials {
    /// An unusable place is reported here, before any work is done.
    fn begin(path: PathBuf, existing: Existing, args: &ExportMeshArgs) -> Result<Self, Failure> {
        let output =
            Output::create(&path, existing, &[args.from.package.name(), &args.file.output])?;
        Ok(Self { path, output })
    }

    /// Writes it and puts it in its place: before the model, which names it. Gives the place if nothing was there before.
    fn place(self, content: &str) -> Result<Option<PathBuf>, Failure> {
        let Self { path, output } = self;
        let is_new = path.symlink_metadata().is_err();
        output.write_whole(content.as_bytes())?;
        Ok(is_new.then_some(path))
    }
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

fn to_text(args: &ExportMeshArgs, summary: &MeshSummary, manifest: &Manifest, size: u64) -> String {
    let [x, y] = summary.origin;
    let roads = match args.roads {
        ModelRoads::Surfaces => format!("{} of them of roads", noted(summary.road_triangles)),
        ModelRoads::Lines | ModelRoads::None => format!("{} lines of roads", noted(summary.lines)),
    };
    format!(
        "level {}, {} tiles, {} triangles, {roads}, {}\norigin: {x}, {y} in {}\nheights: as in the package, metres (datum: {})",
        summary.level,
        noted(summary.tiles),
        noted(summary.triangles),
        bytes(size),
        in_line(&manifest.crs),
        in_line(&manifest.vertical.datum),
    )
}
