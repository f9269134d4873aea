//! `corniche tile`: one decoded tile, for other tools to check packages with.

use std::io::{self, BufWriter, Write as _};

use corniche_geom::Bounds;
use corniche_tileset::{FilePackage, Sections, TilePayload};
use corniche_tin::{Placement, Surface};
use serde_json::{Value, json};

use crate::{
    args::{Coordinates, TileArgs},
    exit::ExitCode,
    failure::Failure,
    table::{Digits, Table},
};

pub(crate) fn run(args: &TileArgs) -> Result<ExitCode, Failure> {
    let package = FilePackage::open(&args.package)?;
    let unusable = |error| Failure::new(ExitCode::Unusable, error);
    let Some(payload) = package.payload(args.id, Sections::ALL).map_err(unusable)? else {
        return Err(Failure::unusable(format!(
            "{} has no tile {}; corniche info --json lists its tiles",
            args.package.display(),
            args.id
        )));
    };
    let mut out = BufWriter::new(io::stdout().lock());
    if args.json {
        writeln!(out, "{}", to_json(&package, &payload, args.coordinates)?)?;
    } else {
        out.write_all(to_text(&payload, Digits::on(&io::stdout())).as_bytes())?;
    }
    out.flush()?;
    Ok(ExitCode::Done)
}

fn to_text(payload: &TilePayload, digits: Digits) -> String {
    let mut table = Table::new(["tile", &payload.id.to_string()]);
    if let Some(terrain) = &payload.terrain {
        table.row(["vertices".into(), digits.count(terrain.tin.vertices().len() as u64)]);
        table.row(["triangles".into(), digits.count(terrain.tin.triangles().len() as u64)]);
        table.row(["geometric error".into(), format!("{:.3} m", terrain.geometric_error_m)]);
        let [low, high] = terrain.height_range_m;
        table.row(["heights".into(), format!("{low:.1} to {high:.1} m")]);
    }
    table.row(["GEO lines".into(), digits.count(payload.roads_geo.len() as u64)]);
    let vertices = payload.roads_geo.iter().map(|road| road.line.vertices.len() as u64).sum();
    table.row(["GEO vertices".into(), digits.count(vertices)]);
    table.row(["SV lines".into(), digits.count(payload.roads_sv.len() as u64)]);
    table.row(["ways".into(), digits.count(payload.attributes.len() as u64)]);
    table.to_text()
}

/// Programs rely on this schema: keys may be added, but not changed.
fn to_json(
    package: &FilePackage,
    payload: &TilePayload,
    coordinates: Coordinates,
) -> Result<Value, Failure> {
    let manifest = package.manifest();
    let frame = &manifest.frame;
    let id = payload.id;
    // What working metres are divided by.
    let [unit_x, unit_y] = match coordinates {
        Coordinates::Working => [1.0; 2],
        Coordinates::Crs => manifest.metres_per_unit,
    };
    let place = |[x, y]: [f64; 2]| [x / unit_x, y / unit_y];
    let Bounds { min_x, min_y, max_x, max_y } = frame.tile_bounds(id);
    // Where an axis counts back, its smallest coordinate is that of the other end.
    let mut bounds = Bounds::EMPTY;
    bounds.include(place([min_x, min_y]));
    bounds.include(place([max_x, max_y]));
    let level = manifest.levels.get(usize::from(id.z()));
    let mut value = json!({
        "id": id.to_string(),
        "crs": manifest.crs,
        "coordinates": match coordinates {
            Coordinates::Working => "working",
            Coordinates::Crs => "crs",
        },
        "metres_per_unit": manifest.metres_per_unit,
        "bounds": bounds.to_array(),
        "cell_m": frame.level_cell(id.z()).to_array(),
        "max_error_m": level.map(|level| level.max_error_m),
        "geometric_error_m": null,
        "height_range_m": null,
        "tin": { "vertices": [], "triangles": [] },
        "roads_geo": [],
        "roads_sv": payload.roads_sv.iter().map(|road| json!({
            "way_id": road.way_id, "part": road.part, "frc": road.class.number(),
            "line": road.line.points.iter().map(|&point| place(frame.position_m(point))).collect::<Vec<_>>(),
            "ground_range_m": road.line.ground_range_m,
        })).collect::<Vec<_>>(),
    });
    let Some(terrain) = &payload.terrain else { return Ok(value) };
    let corner = frame.tile_corner(id);
    let stride = frame.stride(id.z());
    let vertices: Vec<[f64; 3]> = terrain
        .tin
        .vertices()
        .iter()
        .map(|vertex| {
            let [x, y] = place([
                frame.x_m(corner.i + i64::from(vertex.column) * stride),
                frame.y_m(corner.j - i64::from(vertex.row) * stride),
            ]);
            [x, y, f64::from(vertex.height_q) * manifest.vertical.quantum_m]
        })
        .collect();
    let placement = Placement::of_tile(frame, id, manifest.vertical.quantum_m);
    let surface = Surface::new(&terrain.tin, placement);
    let mut roads = Vec::new();
    for road in &payload.roads_geo {
        let line = corniche_drape::positions(&road.line, &surface)
            .map_err(|error| Failure::new(ExitCode::Unusable, error))?
            .into_iter()
            .map(|[u, v, z]| {
                let [x, y] = place(frame.position_of_fraction_m([u, v]));
                [x, y, z]
            })
            .collect::<Vec<_>>();
        roads.push(json!({ "way_id": road.way_id, "part": road.part, "frc": road.class.number(), "line": line }));
    }
    value["geometric_error_m"] = json!(terrain.geometric_error_m);
    value["height_range_m"] = json!(terrain.height_range_m);
    value["tin"] = json!({ "vertices": vertices, "triangles": terrain.tin.triangles() });
    value["roads_geo"] = Value::Array(roads);
    Ok(value)
}
