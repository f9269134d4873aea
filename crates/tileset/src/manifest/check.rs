//! The limits that every manifest must stay within, so that code that reads it can calculate
//! without further checks.
//!
//! The numbers in a package can be anything: a count of 2^64 − 1 would overflow the first sum, a
//! coordinate of 1e308 the first product, and comparisons with NaN would give wrong results.

use corniche_geom::{Bounds, Cell, MAX_COORDINATE_M, MAX_LATTICE_STEPS, NodeIndex, TileId};
use corniche_layers::{LayerTable, stacked_layers};
use corniche_roads::FrcTable;
use corniche_settings::{MAX_MEASURE_M, MAX_NODATA};

use crate::{
    limits::MAX_PHOTO_LEVELS,
    manifest::{
        contents::{Manifest, SpansRecord},
        counts::{GrowthRow, ManifestCounts},
        credits::MOST_CREDITS_BYTES,
        layers::LayerRecord,
        levels::{Distribution, LevelRecord, SampleErrorRecord, SectionLevelRecord},
        sv_tails::{LEAST_TAIL_BYTES, MOST_TAILS, SvTail},
    },
    tile_order::pmtiles_order,
};

/// The largest margin around a tile that its roads reach: a number of cells of the level, plus a
/// number of metres. Writers take eight cells, or 40 true metres at a scale of at most 1000 where
/// that is more, rounded up to whole finest cells.
const MARGIN: (f64, f64) = (9.0, 4e4);
/// Longitudes in the table continue for a limited number of turns: writers move each longitude to
/// less than half a turn from its neighbour's, over at most 128 of them.
const MOST_DEG: f64 = 65.0 * 360.0;
/// Heights are 32-bit steps of the quantum, so they stay below 2^(31 + 27) metres and within
/// [`MAX_MEASURE_M`].
const QUANTUM_EXPONENTS: std::ops::RangeInclusive<i32> = -64..=27;
/// The largest single count, and the largest sum of a list of counts: the number of nodes of a grid
/// of 2^22 tiles per side, with their borders counted twice. Seven of these numbers can be added in
/// 64 bits.
const MAX_COUNT: u64 = 1 << 61;
/// Length in the working CRS divided by true length: Mercator reaches 57 one degree from the pole.
const POINT_SCALES: std::ops::RangeInclusive<f64> = 1e-3..=1e3;
/// Working metres per unit of the CRS, without the sign: a millimetre is the smallest known unit, a
/// radian the largest, and the limits are far beyond both.
const FACTORS: std::ops::RangeInclusive<f64> = 1e-6..=1e9;
/// Classes 0 to 8.
const CLASSES: usize = corniche_roads::FunctionalRoadClass::COUNT;

/// Whether heights can be whole steps of this quantum: a power of two of usable size.
pub(crate) fn is_height_quantum(quantum_m: f64) -> bool {
    QUANTUM_EXPONENTS
        .into_iter()
        .any(|exponent| quantum_m.to_bits() == 2_f64.powi(exponent).to_bits())
}

impl Manifest {
    /// Checks the manifest, and describes the first invalid value.
    pub(crate) fn check(&self) -> Result<(), String> {
        let frame = &self.frame;
        let is_near = frame.origin_m().iter().all(|value| value.abs() <= MAX_COORDINATE_M);
        that(is_near, "frame.origin_m", frame.origin_m())?;
        bounds("data_bounds", &self.data_bounds, [MAX_COORDINATE_M; 2])?;
        self.check_data_in_root()?;
        // Longitudes continue past 180° where the data crosses the antimeridian, and half a pixel
        // may be beyond a pole.
        bounds("wgs84_bounds", &self.wgs84_bounds, [720.0, 91.0])?;
        if let Some(clip) = &self.clip {
            bounds("clip.whole_data_bounds", &clip.whole_data_bounds, [MAX_COORDINATE_M; 2])?;
            bounds("clip.whole_wgs84_bounds", &clip.whole_wgs84_bounds, [720.0, 91.0])?;
            let [most_i, most_j] =
                frame.node_steps(frame.max_level()).map(|steps| MAX_LATTICE_STEPS / steps);
            let is_node = |node: &NodeIndex| {
                node.i.unsigned_abs() <= most_i as u64 && node.j.unsigned_abs() <= most_j as u64
            };
            let [low, high] = clip.nodes;
            let are_corners = clip.nodes.iter().all(is_node) && low.i < high.i && low.j < high.j;
            that(are_corners, "clip.nodes", clip.nodes)?;
        }
        let corners = self.outline.iter().flatten().flatten().flatten();
        let farthest = corners.flatten().map(|part| part.unsigned_abs()).max().unwrap_or_default();
        that(farthest <= MAX_LATTICE_STEPS as u64, "outline", farthest)?;
        bounds("coordinates.bounds", &self.coordinates.bounds(), [MAX_COORDINATE_M; 2])?;
        let samples_deg = self.coordinates.samples_deg().as_flattened();
        let farthest_deg = samples_deg.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        that(farthest_deg <= MOST_DEG, "coordinates.samples_deg", farthest_deg)?;
        that(POINT_SCALES.contains(&self.point_scale), "point_scale", self.point_scale)?;
        let scale = &self.scale;
        for (name, values) in [
            ("scale.center", scale.center),
            ("scale.least", scale.least),
            ("scale.largest", scale.largest),
        ] {
            that(values.iter().all(|value| POINT_SCALES.contains(value)), name, values)?;
        }
        // The factor from degrees to metres is about 1e5; the factors of the units of projections
        // are much smaller.
        let are_factors = self.metres_per_unit.iter().all(|factor| FACTORS.contains(&factor.abs()));
        that(are_factors, "metres_per_unit", self.metres_per_unit)?;
        let quantum_m = self.vertical.quantum_m;
        that(is_height_quantum(quantum_m), "vertical.quantum_m", quantum_m)?;
        let [low_m, high_m] = self.vertical.range_m;
        // Heights as they were read may be implausible, but they are within the range of an f32.
        let is_range =
            low_m <= high_m && low_m >= f64::from(f32::MIN) && high_m <= f64::from(f32::MAX);
        that(is_range, "vertical.range_m", self.vertical.range_m)?;
        self.check_settings()?;
        let levels = usize::from(frame.max_level()) + 1;
        that(self.levels.len() == levels, "the number of levels", self.levels.len())?;
        for (level, record) in self.levels.iter().enumerate() {
            check_level(level, record)?;
            let most_m = MARGIN.0 * frame.level_cell(record.level).shorter_m() + MARGIN.1;
            that(record.width_margin_m <= most_m, "levels.width_margin_m", record.width_margin_m)?;
        }
        check_sum("levels", self.levels.iter().flat_map(level_counts))?;
        check_counts(&self.counts)?;
        that(
            self.growth.len() <= levels * CLASSES,
            "the number of growth rows",
            self.growth.len(),
        )?;
        for row in &self.growth {
            that(usize::from(row.level) < levels, "growth.level", row.level)?;
            that(usize::from(row.class) < CLASSES, "growth.class", row.class)?;
        }
        check_sum("growth", self.growth.iter().flat_map(GrowthRow::counts))?;
        self.check_photos()?;
        self.check_layers()?;
        self.check_spans()?;
        self.check_sv_tails()?;
        if self.crs_wkt.contains('\0') {
            return Err("crs_wkt contains a NUL character, which is invalid".to_owned());
        }
        // Two more bytes for each text: the separator between texts.
        let credits: usize = self.attribution.iter().map(|credit| credit.len() + 2).sum();
        that(credits <= MOST_CREDITS_BYTES, "the number of bytes of attribution", credits)?;
        let accuracies_m = self.datum_operations.iter().filter_map(|found| found.accuracy_m);
        all_measures("datum_operations.accuracy_m", accuracies_m)?;
        check_sum("inputs", self.inputs.iter().map(|input| input.bytes))
    }

    /// The rectangle of the data is a rectangle of nodes of the root tile; their positions are
    /// rounded.
    fn check_data_in_root(&self) -> Result<(), String> {
        let root = self.frame.tile_bounds(TileId::ROOT);
        let Cell { east_m, north_m } = self.frame.cell();
        let [min_x, min_y, max_x, max_y] = self.data_bounds.to_array();
        let is_inside = min_x >= root.min_x - east_m
            && max_x <= root.max_x + east_m
            && min_y >= root.min_y - north_m
            && max_y <= root.max_y + north_m;
        that(is_inside, "data_bounds", self.data_bounds.to_array())
    }

    fn check_photos(&self) -> Result<(), String> {
        if let Some(photo) = self.settings.photo {
            that(photo.levels <= MAX_PHOTO_LEVELS, "settings.photo.levels", photo.levels)?;
            that((1..=100).contains(&photo.quality), "settings.photo.quality", photo.quality)?;
        }
        check_ascending("photos.level", self.photos.iter().map(|photos| photos.level), |level| {
            level <= self.frame.max_level()
        })?;
        check_sum("photos", self.photos.iter().flat_map(|photos| [photos.tiles, photos.bytes]))
    }

    fn check_layers(&self) -> Result<(), String> {
        let mut tables = Vec::with_capacity(self.layers.len());
        for LayerRecord { table, counts, levels } in &self.layers {
            let name = format!("layer {:?}", table.id);
            tables
                .push(LayerTable::new(table.clone()).map_err(|error| format!("{name}: {error}"))?);
            let areas_km2 = counts.kept.iter().map(|kept| kept.area_km2);
            all_measures(&format!("{name}: counts.kept.area_km2"), areas_km2)?;
            let lengths_um = counts.kept.iter().map(|kept| kept.length_um);
            check_sum(&format!("{name}: counts.kept.length_um"), lengths_um)?;
            let unread = counts.unread_values.iter().map(|&(_, values)| values);
            check_sum(&format!("{name}: counts.unread_values"), unread)?;
            let levels = levels.iter().map(SectionLevelRecord::figures);
            let kept = counts.kept.iter().map(|kept| (kept.class, kept.objects));
            let is_class = |class| usize::from(class) < table.classes.len();
            self.check_layer(&name, levels, kept, is_class, &counts.lost)?;
        }
        let order = stacked_layers(&tables).map_err(|error| error.to_string())?;
        that(order.is_sorted(), "the order of layers", order)
    }

    fn check_spans(&self) -> Result<(), String> {
        let Some(SpansRecord { counts, levels, outer_grounds }) = &self.spans else {
            return Ok(());
        };
        for pair in outer_grounds.windows(2) {
            that(pair[0].at < pair[1].at, "spans.outer_grounds (their order)", pair)?;
        }
        for ground in outer_grounds {
            that(ground.height_m.is_finite(), "spans.outer_grounds", ground)?;
        }
        let levels = levels.iter().map(SectionLevelRecord::figures);
        check_sum("spans.counts", [counts.bridges_um, counts.tunnels_um])?;
        let spans =
            [counts.bridges, counts.tunnels, counts.railway_bridges, counts.railway_tunnels];
        let crossings = counts.crossings.iter().map(|(.., count)| *count);
        check_sum("spans.counts.crossings", crossings.clone())?;
        let pairs = || counts.crossings.iter().map(|(upper, lower, _)| [upper, lower]);
        let is_kind = |kind: &String| ["railways", "roads"].contains(&kind.as_str());
        let are_known =
            pairs().flatten().all(is_kind) && pairs().is_sorted_by(|one, next| one < next);
        that(are_known, "spans.counts.crossings", &counts.crossings)?;
        let kept = (0..).zip(spans.into_iter().chain([counts.crossings()]));
        self.check_layer("spans", levels, kept, |_| true, &counts.reasons)
    }

    fn check_sv_tails(&self) -> Result<(), String> {
        that(self.sv_tails.len() <= MOST_TAILS, "the number of sv_tails", self.sv_tails.len())?;
        for pair in self.sv_tails.windows(2) {
            let [place, next] = [&pair[0], &pair[1]].map(|tail| pmtiles_order(tail.tile));
            that(place < next, "sv_tails (their order)", pair)?;
        }
        for SvTail { tile, bytes } in &self.sv_tails {
            that(tile.z() <= self.frame.max_level(), "sv_tails.z", tile.z())?;
            that(*bytes >= LEAST_TAIL_BYTES, "sv_tails.bytes", *bytes)?;
        }
        Ok(())
    }

    /// Checks the numbers of each level, and the numbers of objects by class and by reason.
    fn check_layer(
        &self,
        name: &str,
        levels: impl Iterator<Item = (u8, [u64; 4])> + Clone,
        kept: impl Iterator<Item = (u8, u64)> + Clone,
        is_class: impl Fn(u8) -> bool,
        lost: &[(String, u64)],
    ) -> Result<(), String> {
        let is_level = |level| level <= self.frame.max_level();
        let numbers = levels.clone().map(|(level, _)| level);
        check_ascending(&format!("{name}.levels.level"), numbers, is_level)?;
        check_sum(&format!("{name}.levels"), levels.flat_map(|(_, counts)| counts))?;
        let classes = kept.clone().map(|(class, _)| class);
        check_ascending(&format!("{name}.counts.kept.class"), classes, is_class)?;
        let objects = kept.map(|(_, objects)| objects);
        check_sum(&format!("{name}.counts"), objects.chain(lost.iter().map(|lost| lost.1)))
    }

    fn check_settings(&self) -> Result<(), String> {
        let settings = &self.settings;
        if let Some((key, wrong)) = settings.wrong_number() {
            return that(false, &format!("settings.{key}"), wrong);
        }
        if let Some(labels) = &settings.class_labels {
            let is_label = |label: &String| {
                (1..=FrcTable::LONGEST_LABEL).contains(&label.chars().count())
                    && !label.chars().any(char::is_control)
            };
            let is_right = labels.len() == CLASSES && labels.iter().all(is_label);
            that(is_right, "settings.class_labels", labels.join("; "))?;
        }
        for (name, count, most) in [
            ("settings.nodata", settings.nodata.len(), MAX_NODATA),
            ("settings.class_max_cell_m", settings.class_max_cell_m.len(), CLASSES),
        ] {
            that(count <= most, &format!("the number of {name}"), count)?;
        }
        let [low_m, high_m] = settings.height_range_m.unwrap_or_default();
        that(low_m <= high_m, "settings.height_range_m", [low_m, high_m])
    }
}

/// Checks numbers of levels or classes: each of them once, ascending, known.
fn check_ascending(
    name: &str,
    numbers: impl Iterator<Item = u8>,
    is_known: impl Fn(u8) -> bool,
) -> Result<(), String> {
    let numbers: Vec<u8> = numbers.collect();
    let is_right = numbers.iter().all(|number| is_known(*number));
    that(is_right && numbers.is_sorted_by(|one, next| one < next), name, numbers)
}

fn check_level(level: usize, record: &LevelRecord) -> Result<(), String> {
    that(usize::from(record.level) == level, "levels.level", record.level)?;
    all_positive("levels.cell_m", record.cell_m.to_array())?;
    measure("levels.max_error_m", record.max_error_m)?;
    measure("levels.geometric_error_m", record.geometric_error_m)?;
    for distribution in [record.errors_m, record.tightness].into_iter().flatten() {
        check_distribution(&distribution)?;
    }
    let SampleErrorRecord { max_m, rms_m, p99_m, .. } = record.sample_error;
    measure("levels.sample_error.max_m", max_m)?;
    that(rms_m >= 0.0 && rms_m <= max_m, "levels.sample_error.rms_m", rms_m)?;
    that(p99_m >= 0.0 && p99_m <= max_m, "levels.sample_error.p99_m", p99_m)?;
    measure("levels.simplify_tolerance_m", record.simplify_tolerance_m)?;
    measure("levels.width_margin_m", record.width_margin_m)?;
    let class = record.least_class.unwrap_or(0);
    that(usize::from(class) < CLASSES, "levels.least_class", class)
}

fn check_distribution(distribution: &Distribution) -> Result<(), String> {
    let Distribution { count, min, median, p95, max } = *distribution;
    check_sum("levels", [count])?;
    measure("the smallest value of a distribution", min)?;
    measure("the largest value of a distribution", max)?;
    let is_sorted = min <= median && median <= p95 && p95 <= max;
    that(is_sorted, "a distribution", distribution)
}

fn level_counts(record: &LevelRecord) -> [u64; 8] {
    [
        record.tiles,
        record.triangles,
        record.vertices,
        record.terrain_bytes,
        record.relief_bytes,
        record.uncovered_nodes,
        record.sample_error.on_tin,
        record.sample_error.off_tin,
    ]
}

fn check_counts(counts: &ManifestCounts) -> Result<(), String> {
    let samples = &counts.samples;
    for count in [samples.nodes, samples.with_data, samples.filled, samples.void] {
        check_sum("counts.samples", [count])?;
    }
    check_sum("counts", [counts.roads_in, counts.roads_kept, counts.highways_in])?;
    check_sum("counts", [counts.roads_in_um])?;
    check_sum("counts", [counts.roads_kept_um])?;
    let lost = counts.roads_lost.iter().map(|loss| (loss.roads, loss.length_um));
    check_sums("counts.roads_lost", lost)?;
    let left_out = counts.left_out.iter().map(|left_out| (left_out.ways, left_out.length_um));
    check_sums("counts.left_out", left_out)?;
    let names = [
        &counts.defects,
        &counts.unknown_highways,
        &counts.tags_taken_otherwise,
        &counts.highways_left_out,
    ];
    for list in names {
        check_sum("counts", list.iter().map(|&(_, count)| count))?;
    }
    that(counts.classes.len() <= CLASSES, "the number of counts.classes", counts.classes.len())?;
    check_sums("counts.classes", counts.classes.iter().copied())
}

/// Checks the sum of the counts, and the sum of the lengths.
fn check_sums(name: &str, pairs: impl Iterator<Item = (u64, u64)> + Clone) -> Result<(), String> {
    check_sum(name, pairs.clone().map(|(count, _)| count))?;
    check_sum(name, pairs.map(|(_, length_um)| length_um))
}

fn that(holds: bool, name: &str, value: impl std::fmt::Debug) -> Result<(), String> {
    if holds { Ok(()) } else { Err(format!("{name} is {value:?}, which is invalid")) }
}

/// Checks a length: not negative, and within the limit.
fn measure(name: &str, value_m: f64) -> Result<(), String> {
    that((0.0..=MAX_MEASURE_M).contains(&value_m), name, value_m)
}

/// Checks lengths that are used as divisors.
fn all_positive(name: &str, values_m: [f64; 2]) -> Result<(), String> {
    values_m.iter().try_for_each(|&value_m| {
        that(value_m > 0.0, name, value_m)?;
        measure(name, value_m)
    })
}

/// Checks coordinates or differences of coordinates.
fn all_measures(name: &str, mut values: impl Iterator<Item = f64>) -> Result<(), String> {
    values.try_for_each(|value| that(value.abs() <= MAX_MEASURE_M, name, value))
}

fn bounds(name: &str, bounds: &Bounds, limits: [f64; 2]) -> Result<(), String> {
    let [min_x, min_y, max_x, max_y] = bounds.to_array();
    let sound = [[min_x, max_x], [min_y, max_y]]
        .iter()
        .zip(limits)
        .all(|([min, max], limit)| min <= max && min.abs() <= limit && max.abs() <= limit);
    that(sound, name, bounds.to_array())
}

fn check_sum(name: &str, counts: impl IntoIterator<Item = u64>) -> Result<(), String> {
    let sum = counts.into_iter().try_fold(0_u64, u64::checked_add);
    if sum.is_some_and(|sum| sum <= MAX_COUNT) {
        Ok(())
    } else {
        Err(format!("the counts of {name} add up to more than {MAX_COUNT}, which is impossible"))
    }
}

#[cfg(test)]
#[path = "check_tests.rs"]
mod tests;
