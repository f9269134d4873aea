//! `corniche export mesh`: writes the terrain of a level as a model.

use std::{fs, path::PathBuf};

use corniche_export::{MeshFormat, MeshRequest, MeshSummary, ModelRoads, export_mesh};
use corniche_tileset::Manifest;

use super::vector_files::tell;
use crate::{
    args::{ExportMeshArgs, MODEL_FORMATS, word_of},
    escaped::in_line,
    failure::{CommandFailure, Result},
    names::{file_name, format_of},
    output::{Output, existing_of, named::NamedOutput},
    packages,
    progress::Progress,
    styles,
    table::{bytes, noted},
};

pub(crate) fn run(args: &ExportMeshArgs) -> Result<()> {
    let format = format_of(args.format, &args.file.output, &MODEL_FORMATS)?;
    let ending = word_of(&MODEL_FORMATS, &format);
    if args.relief == Some(true) && format != MeshFormat::Glb {
        refuse!(
            "--relief on: .{ending} does not support normal maps; write a .glb, or omit the option"
        );
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
        classes: args.filter.of_package(package.manifest())?,
        relief: args.relief != Some(false),
        style,
        material_file: materials.as_deref().map(file_name),
    };
    let name = format!("model.{ending}");
    let existing = existing_of(args.file.overwrite);
    let output =
        NamedOutput::create(&args.file.output, existing, name, &[args.from.package.name()])?;
    let used = [args.from.package.name(), &args.file.output];
    let begin = |path: &PathBuf| Output::create(path, existing, &used);
    let begun = materials.as_ref().map(begin).transpose()?;
    let exported =
        Progress::show_during(|progress| export_mesh(&package, &request, &output.path(), progress));
    let summary =
        exported.map_err(|error| CommandFailure::from(error).about_target(&args.file.output))?;
    let new = materials.filter(|path| path.symlink_metadata().is_err());
    // Materials are moved to their target before the model, which refers to them.
    if let Some(begun) = begun {
        begun.write_whole(request.materials(package.manifest()).as_bytes())?;
    }
    let size = output.place().inspect_err(|_| {
        // Materials without a model are useless, but existing ones belong to another model.
        if let Some(new) = &new {
            let _ = fs::remove_file(new);
        }
    })?;
    tell(&args.file.output, &to_text(args, &summary, package.manifest(), size), package.manifest());
    Ok(())
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
