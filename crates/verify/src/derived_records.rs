//! Checks of the manifest alone: levels follow from the settings, the grid follows from the data's
//! rectangle, some texts are fixed, and (P6) the sums add up, so that nothing is dropped without
//! being counted.

use corniche_geom::{GridFrame, LatticeBounds, TILE_CELLS, TileId};
use corniche_spec::{Loss, levels::Levels, manifest_texts, settings_record};
use corniche_tileset::{InputKind, Manifest};

use super::checks::{CheckId, Findings, or_none};

pub(crate) fn verify(manifest: &Manifest, findings: &mut Findings) {
    let hash = settings_record::sha256(&manifest.settings);
    findings.look(CheckId::SettingsHash, hash == manifest.settings_sha256, || {
        "the settings do not match their hash".to_owned()
    });
    levels(manifest, findings);
    texts(manifest, findings);
}

/// Checks that tolerances follow from the settings. Otherwise a larger recorded tolerance would
/// weaken every check that uses the tolerance.
fn levels(manifest: &Manifest, findings: &mut Findings) {
    let Some(levels) = Levels::recorded(manifest) else {
        findings.look(CheckId::LevelRecords, false, || {
            let cells = manifest.settings.class_max_cell_m.iter().map(|&cell_m| or_none(cell_m));
            format!(
                "no class can be shown with cells of {} m and a lowest class of {}",
                cells.collect::<Vec<_>>().join(", "),
                or_none(manifest.levels.last().and_then(|level| level.least_class))
            )
        });
        return;
    };
    let quantum_m = manifest.vertical.quantum_m;
    look!(
        findings,
        LevelRecords,
        quantum_m.to_bits() == levels.quantum_m().to_bits(),
        "the height quantum is {quantum_m} m, not {} m",
        levels.quantum_m()
    );
    for record in &manifest.levels {
        let level = record.level;
        let lengths = [record.max_error_m, record.simplify_tolerance_m, record.width_margin_m];
        let said = (record.cell_m.to_array(), lengths);
        let lengths =
            [levels.max_error_m(level), levels.simplify_tolerance_m(level), levels.margin_m(level)];
        let wanted = (manifest.frame.level_cell(level).to_array(), lengths);
        let bits = |(cell, lengths): ([f64; 2], [f64; 3])| {
            (cell.map(f64::to_bits), lengths.map(f64::to_bits))
        };
        // The build computes them in the same way, so they are equal to the last bit.
        look!(
            findings,
            LevelRecords,
            bits(said) == bits(wanted),
            "level {level} has cell, tolerances and margin {said:?}, not {wanted:?}"
        );
        let least = levels.least_class(level).map(corniche_roads::FunctionalRoadClass::number);
        look!(
            findings,
            LevelRecords,
            record.least_class == least,
            "level {level} shows classes up to {}, not {}",
            or_none(record.least_class),
            or_none(least)
        );
    }
}

fn texts(manifest: &Manifest, findings: &mut Findings) {
    let mut look =
        |holds: bool, what: &dyn Fn() -> String| findings.look(CheckId::Texts, holds, what);
    look(manifest.tiling == manifest_texts::TILING, &|| format!("tiling is {:?}", manifest.tiling));
    look(manifest.vertical.unit == manifest_texts::HEIGHT_UNIT, &|| {
        format!("unit is {:?}", manifest.vertical.unit)
    });
    for input in &manifest.inputs {
        look(InputKind::RECORDED.iter().any(|kind| kind.is_of(input)), &|| {
            format!("{:?} is an input of kind {:?}", input.name, input.kind)
        });
    }
    let has_roads = manifest.has_extract();
    let credits = manifest.attribution.iter().any(|text| text == corniche_osm::ATTRIBUTION);
    look(credits || !has_roads, &|| {
        format!("no attribution of the extract: {}", manifest.attribution.join("; "))
    });
    let reasons = Loss::ALL.map(Loss::reason);
    for loss in &manifest.counts.roads_lost {
        look(reasons.contains(&loss.reason.as_str()), &|| {
            format!("roads lost as {:?}", loss.reason)
        });
    }
}

/// The relative tolerance of lengths that are measured again over the edges of TINs: every crossing
/// moves a point by less than a millimetre.
pub(crate) const LENGTH_SHARE: f64 = 1e-5;

/// The additional tolerance of each line, in metres: both of its ends may be cuts, which are
/// rounded to a lattice of a millimetre.
pub(crate) const CUT_M: f64 = 0.002;

pub(crate) fn verify_sums(manifest: &Manifest, findings: &mut Findings) {
    let counts = &manifest.counts;
    let samples = &counts.samples;
    look!(
        findings,
        SampleSums,
        samples.nodes == samples.with_data + samples.filled + samples.void,
        "{} nodes, but counts of {samples:?}",
        samples.nodes
    );
    let lost: u64 = counts.roads_lost.iter().map(|loss| loss.roads).sum();
    look!(
        findings,
        RoadSums,
        counts.roads_in == counts.roads_kept + lost,
        "{} roads read, {} kept, {lost} lost",
        counts.roads_in,
        counts.roads_kept
    );
    let lost_um: u64 = counts.roads_lost.iter().map(|loss| loss.length_um).sum();
    look!(
        findings,
        RoadSums,
        counts.roads_in_um == counts.roads_kept_um + lost_um,
        "{} µm read, {} µm kept, {lost_um} µm lost",
        counts.roads_in_um,
        counts.roads_kept_um
    );
    let by_class: u64 = counts.classes.iter().map(|&(count, _)| count).sum();
    let by_class_um: u64 = counts.classes.iter().map(|&(_, length_um)| length_um).sum();
    look!(
        findings,
        RoadSums,
        by_class == counts.roads_in && by_class_um == counts.roads_in_um,
        "{by_class} roads of {by_class_um} µm by class, {} of {} µm in all",
        counts.roads_in,
        counts.roads_in_um
    );
}

pub(crate) fn verify_grid(manifest: &Manifest, findings: &mut Findings) {
    let frame = &manifest.frame;
    let [south_west, north_east] = manifest.data_nodes();
    let bounds = manifest.data_bounds.to_array();
    let corners = [
        frame.x_m(south_west.i),
        frame.y_m(south_west.j),
        frame.x_m(north_east.i),
        frame.y_m(north_east.j),
    ];
    look!(
        findings,
        Grid,
        corners.map(f64::to_bits) == bounds.map(f64::to_bits),
        "the data's rectangle is {bounds:?}, but the nodes nearest to its corners are at {corners:?}"
    );
    let wanted = GridFrame::covering(frame.origin_m(), frame.cell(), south_west, north_east);
    look!(
        findings,
        Grid,
        wanted.as_ref() == Ok(frame),
        "the grid is {frame:?}, the smallest one that covers the data is {wanted:?}"
    );
    let counted = |low: i64, high: i64| u64::try_from(high - low + 1).unwrap_or_default();
    let nodes =
        counted(south_west.i, north_east.i).saturating_mul(counted(south_west.j, north_east.j));
    let said = manifest.counts.samples.nodes;
    look!(
        findings,
        SampleSums,
        said == nodes,
        "{said} nodes are recorded, the data's rectangle has {nodes}"
    );
}

/// The bounds that the build was given.
pub(crate) fn clip_of(manifest: &Manifest) -> Option<LatticeBounds> {
    Some(manifest.frame.lattice_bounds(manifest.clip.as_ref()?.nodes))
}

/// The first and the last of the finest tiles over the data's rectangle: the north-western and the
/// south-eastern one.
pub(crate) fn data_tiles(manifest: &Manifest) -> Option<[TileId; 2]> {
    let frame = &manifest.frame;
    let [south_west, north_east] = manifest.data_nodes();
    let corner = frame.root_corner();
    let tile = |i: i64, j: i64| {
        let column = u32::try_from((i - corner.i).div_euclid(TILE_CELLS)).ok()?;
        let row = u32::try_from((corner.j - j).div_euclid(TILE_CELLS)).ok()?;
        TileId::new(frame.max_level(), column, row).ok()
    };
    Some([tile(south_west.i, north_east.j)?, tile(north_east.i, south_west.j)?])
}
