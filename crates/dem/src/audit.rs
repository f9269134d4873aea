//! Finds samples that cannot be heights, by reading every sample once.
//!
//! A file that writes −9999 for "no data" without declaring it would have holes of −9999 m. Such a
//! value can be recognised: programs usually write it, or it occurs many times; and it lies far
//! beyond all true heights.
//!
//! ```text
//!   how often │                                                ▄▄▄
//!             │ █                                           ▄▄█████▄
//!             │ █                                         ▄███████████▄
//!             └─┴───────────── 1000 m or more ────────────┴────────────► height
//!             −9999
//! ```

mod spikes;

use corniche_gis::{CrsError, RasterError, first_names};
use gdal::Dataset;
use serde::{Deserialize, Serialize};

use crate::audit::spikes::{Spike, Spikes};
use crate::files::source::Source;
use crate::mosaics::mosaic::SampleRect;
use crate::mosaics::open_files::OpenFiles;
use crate::plan::clip::{needed_samples, parts_of_file};
use crate::{AuditError, Dem, GridPlan};

/// The range of the earth's surface: Challenger Deep lies some 10 935 m below the sea, Everest 8
/// 849 m above it.
pub const SURFACE_RANGE_M: [f64; 2] = [-12_000.0, 9_000.0];

/// A repeated value that lies this far beyond all others is not a height.
const FAR_M: f64 = 1000.0;
/// Values that programs write for "no data", as stored. One of them that lies this far beyond all
/// others is rejected even if a single sample has it.
const USUAL_NO_DATA: [f64; 13] = [
    -999.0,
    -9999.0,
    -99_999.0,
    -999_999.0,
    -9_999_999.0,
    -32_767.0,
    -32_768.0,
    9999.0,
    32_767.0,
    32_768.0,
    65_535.0,
    99_999.0,
    999_999.0,
];
/// Any other value is repeated if more than one sample in this many has it.
const ONE_IN: u64 = 10_000;
/// The number of lowest and of highest values that are kept. Only these are examined.
const KEPT: usize = 16;
/// Sea levels are within this distance of 0, in any vertical datum.
const SEA_LEVEL_M: f64 = 12.0;
/// No dry land is lower: a file with a single, lower value has no heights. (The Dead Sea is at −430
/// m.)
const LOWEST_LAND_M: f64 = -500.0;
/// Side of the blocks that are read. From a file stored in rows, the same number of samples is read
/// in whole rows.
const BLOCK_SAMPLES: usize = 512;

/// A rectangle of samples in one file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AuditBlock {
    file: usize,
    start: [usize; 2],
    size: [usize; 2],
}

/// One of the lowest or highest heights, and the number of samples that have it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct ExtremeHeight {
    height_m: f64,
    /// The value as stored in the file.
    stored: f64,
    count: u64,
}

/// The outermost different heights at one end, the outermost first, at most [`KEPT`]; their counts
/// are exact.
///
/// An entry is removed only when [`KEPT`] others lie farther out, and these are never removed for
/// one farther in: so a removed entry cannot return. Neither the order of samples nor the order of
/// merges matters.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
struct End {
    entries: Vec<ExtremeHeight>,
}

/// The audit of some samples of one file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AuditPart {
    file: usize,
    found: FileAudit,
}

/// The audit of a DEM's samples, in bounded memory; parts of it can be merged in any order.
#[derive(Debug, Clone, PartialEq)]
pub struct Audit {
    range_m: [f64; 2],
    files: Vec<FileAudit>,
}

#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
struct FileAudit {
    /// The number of samples that have a height.
    samples: u64,
    /// Whether some samples are stored as numbers with fractions.
    has_fractions: bool,
    lowest: End,
    highest: End,
    outside: u64,
    spikes: Spikes,
}

/// Examines blocks of samples. It keeps files open, so each thread has its own auditor.
pub struct Auditor<'a> {
    dem: &'a Dem,
    range_m: [f64; 2],
    files: OpenFiles,
    stored: Vec<f64>,
    heights_m: Vec<f64>,
}

impl Dem {
    /// All samples of all files on which the plan's nodes can depend, and no others, each in one
    /// block, in a fixed order: the result depends only on the requested part of the data, and
    /// neither on how files are stored nor on how work is split.
    ///
    /// # Errors
    /// When PROJ fails.
    pub fn audit_blocks(&self, plan: &GridPlan) -> Result<Vec<AuditBlock>, CrsError> {
        let mut needed: Vec<Vec<SampleRect>> = vec![Vec::new(); self.sources.len()];
        for (mosaic, role) in self.mosaics.iter().zip(&plan.roles.0) {
            let rect = needed_samples(plan, mosaic, role)?;
            for file in &mosaic.files {
                needed[file.index] = without_overlap(parts_of_file(mosaic, file, &rect));
            }
        }
        let mut blocks = Vec::new();
        for (file, (source, parts)) in self.sources.iter().zip(&needed).enumerate() {
            if parts.is_empty() {
                continue;
            }
            let size = [source.columns as usize, source.rows as usize];
            // With blocks narrower than a row, each row would be decompressed many times.
            let most = if source.is_striped {
                [size[0], (BLOCK_SAMPLES * BLOCK_SAMPLES / size[0].max(1)).max(1)]
            } else {
                [BLOCK_SAMPLES; 2]
            };
            for row in (0..size[1]).step_by(most[1]) {
                for column in (0..size[0]).step_by(most[0].max(1)) {
                    let start = [column, row];
                    let side = |axis: usize| most[axis].min(size[axis] - start[axis]);
                    let size = [side(0), side(1)];
                    let min = start.map(|at| at as i64);
                    let own =
                        SampleRect { min, max: [0, 1].map(|axis| min[axis] + size[axis] as i64) };
                    let wanted = parts.iter().map(|part| part.intersection(&own));
                    blocks.extend(wanted.filter(|part| !part.is_empty()).map(|part| AuditBlock {
                        file,
                        start: part.min.map(|at| at as usize),
                        size: [part.columns(), part.rows()],
                    }));
                }
            }
        }
        Ok(blocks)
    }

    /// The middle of a block in working metres; not finite outside the working CRS.
    ///
    /// # Errors
    /// When PROJ fails.
    pub fn audit_block_middle_m(
        &self,
        block: &AuditBlock,
        plan: &GridPlan,
    ) -> Result<[f64; 2], CrsError> {
        for (mosaic, role) in self.mosaics.iter().zip(&plan.roles.0) {
            let Some(file) = mosaic.files.iter().find(|file| file.index == block.file) else {
                continue;
            };
            let middle = [0, 1].map(|axis| {
                let samples = block.start[axis] + block.size[axis] / 2;
                (file.rect.min[axis] + samples as i64) as f64
            });
            let mut at = [mosaic.crs_from_sample.crs_from_pixel(middle)];
            role.working_from_crs.apply(&mut at)?;
            return Ok(at[0]);
        }
        Ok([f64::NAN; 2])
    }

    /// Creates an auditor; `range_m` is the lowest and the highest allowed height, in metres.
    #[must_use]
    pub fn auditor(&self, range_m: [f64; 2]) -> Auditor<'_> {
        Auditor {
            dem: self,
            range_m,
            files: OpenFiles::default(),
            stored: Vec::new(),
            heights_m: Vec::new(),
        }
    }
}

impl Auditor<'_> {
    /// Examines every sample of a block, in metres as given by the file: after scale and unit, but
    /// before the conversion to another vertical CRS and before the shift. Memory is bounded by the
    /// block.
    ///
    /// # Errors
    /// When the file cannot be read.
    pub fn look(&mut self, block: &AuditBlock) -> Result<AuditPart, RasterError> {
        let source = &self.dem.sources[block.file];
        let dataset: &Dataset = self.files.dataset(block.file, source)?;
        source.read_stored(dataset, block.start, block.size, &mut self.stored)?;
        self.heights_m.clone_from(&self.stored);
        source.values.convert(&mut self.heights_m);
        let mut found = FileAudit::default();
        for (&stored, &height_m) in self.stored.iter().zip(&self.heights_m) {
            found.add(stored, height_m, self.range_m);
        }
        let columns = block.size[0];
        let limit_m = spikes::limit_m(source.spacing_m());
        for [column, row] in spikes::candidates(&self.heights_m, columns, limit_m) {
            let index = row * columns + column;
            let (height_m, stored) = (self.heights_m[index], self.stored[index]);
            // Inside the block's rim all neighbours are known, and nothing is read again.
            let is_known = !spikes::is_on_rim(block.size, [column, row]);
            let [column, row] = [block.start[0] + column, block.start[1] + row];
            if is_known || self.is_spike(block.file, [column, row])? {
                found.spikes.add(Spike { row, column, height_m, stored });
            }
        }
        Ok(AuditPart { file: block.file, found })
    }

    /// Whether a sample is a spike among its neighbours in the file, including those in other
    /// blocks.
    fn is_spike(&mut self, file: usize, [column, row]: [usize; 2]) -> Result<bool, RasterError> {
        let source = &self.dem.sources[file];
        let start = [column.saturating_sub(1), row.saturating_sub(1)];
        let end = [(column + 2).min(source.columns as usize), (row + 2).min(source.rows as usize)];
        let size = [end[0] - start[0], end[1] - start[1]];
        let dataset = self.files.dataset(file, source)?;
        let mut around_m = Vec::new();
        source.read_stored(dataset, start, size, &mut around_m)?;
        source.values.convert(&mut around_m);
        let limit_m = spikes::limit_m(source.spacing_m());
        Ok(spikes::is_spike(&around_m, size[0], [column - start[0], row - start[1]], limit_m))
    }
}

impl AuditPart {
    /// Merges the audit of samples of the same file. Returns an audit of another file.
    pub fn merge(&mut self, other: Self) -> Option<Self> {
        if self.file != other.file {
            return Some(other);
        }
        self.found.merge(&other.found);
        None
    }
}

impl FileAudit {
    fn add(&mut self, stored: f64, height_m: f64, range_m: [f64; 2]) {
        if height_m.is_nan() {
            return;
        }
        self.samples += 1;
        self.has_fractions |= stored.fract() != 0.0;
        self.outside += u64::from(!(range_m[0]..=range_m[1]).contains(&height_m));
        let entry = ExtremeHeight { height_m, stored, count: 1 };
        self.lowest.add(entry, 1.0);
        self.highest.add(entry, -1.0);
    }

    fn merge(&mut self, other: &Self) {
        self.samples += other.samples;
        self.has_fractions |= other.has_fractions;
        self.outside += other.outside;
        self.spikes.merge(&other.spikes);
        other.lowest.entries.iter().for_each(|&entry| self.lowest.add(entry, 1.0));
        other.highest.entries.iter().for_each(|&entry| self.highest.add(entry, -1.0));
    }

    /// The value that must mean "no data", and its distance from the next value.
    ///
    /// At the high end it must be farther from sea level than the next value. Otherwise the next
    /// value is the odd one, for example a single −9999 in a plateau.
    fn sentinel(&self) -> Option<(ExtremeHeight, f64)> {
        let low = self.lowest.sentinel(self.samples, |_| true);
        let high = self
            .highest
            .sentinel(self.samples, |[outer, inner]| outer.height_m.abs() > inner.height_m.abs());
        match (low, high) {
            // If there are only two values, far apart, the one nearer to sea level is the ground.
            (Some(low), Some(high)) if self.lowest.entries.len() == 2 => {
                let is_low = low.0.height_m.abs() >= high.0.height_m.abs();
                Some(if is_low { low } else { high })
            }
            (low, high) => low.or(high),
        }
    }

    /// The number of samples that have one of the lowest or highest values.
    fn count_of(&self, height_m: f64) -> u64 {
        let mut entries = self.lowest.entries.iter().chain(&self.highest.entries);
        entries.find(|entry| entry.height_m - height_m == 0.0).map_or(0, |entry| entry.count)
    }

    /// The lowest and the highest sample.
    fn range_m(&self) -> Option<[f64; 2]> {
        let [low, high] = [&self.lowest, &self.highest].map(|end| end.entries.first());
        Some([low?.height_m, high?.height_m])
    }
}

impl End {
    /// `towards` is 1 at the low end and −1 at the high one.
    fn add(&mut self, entry: ExtremeHeight, towards: f64) {
        let inwards = |other: &ExtremeHeight| (other.height_m - entry.height_m) * towards;
        if self.entries.len() == KEPT && self.entries.last().is_some_and(|last| inwards(last) < 0.0)
        {
            return;
        }
        let at = self.entries.iter().position(|other| inwards(other) >= 0.0);
        match at {
            Some(at) if inwards(&self.entries[at]) == 0.0 => {
                let found = &mut self.entries[at];
                found.count += entry.count;
                // Several stored values can mean the same height; the smallest is reported.
                found.stored = found.stored.min(entry.stored);
            }
            Some(at) => self.entries.insert(at, entry),
            None => self.entries.push(entry),
        }
        self.entries.truncate(KEPT);
    }

    /// The outermost value that is usual for "no data" or repeated, and far from the next value.
    /// `may_be` can reject a pair of neighbouring values.
    fn sentinel(
        &self,
        samples: u64,
        may_be: impl Fn([ExtremeHeight; 2]) -> bool,
    ) -> Option<(ExtremeHeight, f64)> {
        let gap_m = |[outer, inner]: [ExtremeHeight; 2]| (inner.height_m - outer.height_m).abs();
        self.entries
            .windows(2)
            .map(|pair| [pair[0], pair[1]])
            .find(|&pair| {
                let ExtremeHeight { count, stored, .. } = pair[0];
                let is_repeated = count > 1 && count > samples / ONE_IN;
                let is_usual = USUAL_NO_DATA.iter().any(|usual| stored - usual == 0.0);
                (is_repeated || is_usual) && gap_m(pair) >= FAR_M && may_be(pair)
            })
            .map(|pair| (pair[0], gap_m(pair)))
    }
}

impl Audit {
    fn new(files: usize, range_m: [f64; 2]) -> Self {
        Self { range_m, files: vec![FileAudit::default(); files] }
    }

    /// The audit of a DEM before any block was examined.
    #[must_use]
    pub fn none_of(dem: &Dem, range_m: [f64; 2]) -> Self {
        Self::new(dem.sources.len(), range_m)
    }

    /// Merges the audit of a block of the same DEM.
    pub fn merge(&mut self, part: &AuditPart) {
        if let Some(file) = self.files.get_mut(part.file) {
            file.merge(&part.found);
        }
    }

    /// Rejects values that are not heights: of each file, then of all files together.
    ///
    /// - A value that programs usually write for "no data", or that more than 0.01 % of the samples
    ///   have, and that lies 1000 m or more beyond all others means "no data"; of several such
    ///   values, the outermost is named. With `is_range_given` this test is skipped: a user who
    ///   gives the range knows the values.
    /// - A value that all samples share is rejected below −500 m.
    /// - No value may lie outside the range.
    ///
    /// # Errors
    /// [`AuditError::Sentinel`] or [`AuditError::OutOfRange`].
    pub fn check(&self, dem: &Dem, is_range_given: bool) -> Result<(), AuditError> {
        let nothing = || self.sentinel_error(dem).or_else(|| self.nothing_error(dem));
        if !is_range_given && let Some(error) = nothing() {
            return Err(error);
        }
        let outside = dem.sources.iter().zip(&self.files).find(|(_, file)| file.outside > 0);
        let Some((source, file)) = outside else { return Ok(()) };
        let [low_m, high_m] = self.range_m;
        let ends = [&file.lowest, &file.highest].map(|end| end.entries.first());
        let worst = match ends {
            [Some(low), Some(high)] if low_m - low.height_m >= high.height_m - high_m => low,
            [_, Some(high)] => high,
            _ => return Ok(()),
        };
        Err(out_of_range(source, worst, [file.outside, file.samples], self.range_m))
    }

    /// The audit of all files together.
    fn of_all_files(&self) -> FileAudit {
        let mut all = FileAudit::default();
        self.files.iter().for_each(|file| all.merge(file));
        all
    }

    /// The step between heights that the files can distinguish, in metres: if all samples are
    /// stored as whole numbers, the step of these, which is a metre for most files from satellites.
    /// The smallest step of all files that have heights; 0 if a file has fractions.
    #[must_use]
    pub fn height_step_m(&self, dem: &Dem) -> f64 {
        let files = dem.sources.iter().zip(&self.files).filter(|(_, file)| file.samples > 0);
        let step_m = |(source, file): (&Source, &FileAudit)| {
            if file.has_fractions { 0.0 } else { source.values.m_per_whole() }
        };
        files.map(step_m).reduce(f64::min).unwrap_or_default()
    }

    /// Warnings about single samples far above or below all of their neighbours: one text for each
    /// file that has some.
    #[must_use]
    pub fn spikes(&self, dem: &Dem) -> Vec<String> {
        let text = |(source, file): (&Source, &FileAudit)| {
            let Spikes { count, first } = &file.spikes;
            let place = |spike: &Spike| {
                let pixel = [spike.column as f64 + 0.5, spike.row as f64 + 0.5];
                let [x, y] = source.crs_from_pixel.crs_from_pixel(pixel);
                format!(
                    "{} m (stored as {}) at {x}, {y} in {}, column {}, row {}",
                    spike.height_m,
                    source.values.stored_text(spike.stored),
                    source.crs.label,
                    spike.column,
                    spike.row
                )
            };
            let places = first.iter().map(place).collect::<Vec<_>>().join("; ");
            let more = match count - first.len() as u64 {
                0 => String::new(),
                more => format!("; and {more} more"),
            };
            let limit_m = spikes::limit_m(source.spacing_m()).floor();
            let option = first.first().map(|spike| source.values.stored_text(spike.stored));
            format!(
                "{:?}: isolated samples, more than {limit_m} m above or below all samples around them: {places}{more}; if the stored value means \"no data\", \
                 declare it with --nodata {}; if all are heights, allow them with --height-range LOW,HIGH",
                source.path,
                option.unwrap_or_default()
            )
        };
        let with_spikes = |(_, file): &(&Source, &FileAudit)| file.spikes.count > 0;
        dem.sources.iter().zip(&self.files).filter(with_spikes).map(text).collect()
    }

    /// The error if all samples of all files have the same value, which is lower than any dry land.
    fn nothing_error(&self, dem: &Dem) -> Option<AuditError> {
        let all = self.of_all_files();
        let [only] = all.lowest.entries.as_slice() else { return None };
        let source = dem.sources.first()?;
        let range_m = [LOWEST_LAND_M, self.range_m[1]];
        (only.height_m < LOWEST_LAND_M)
            .then(|| out_of_range(source, only, [only.count, all.samples], range_m))
    }

    fn sentinel_error(&self, dem: &Dem) -> Option<AuditError> {
        let files = || dem.sources.iter().zip(&self.files);
        let all = self.of_all_files();
        // First searches a value that is isolated within its own file; then one that is isolated
        // only among the values of all files.
        let own = self.files.iter().find_map(FileAudit::sentinel);
        // A file that contains only sea, next to files of high land, is not a file of only "no
        // data".
        let across = || all.sentinel().filter(|(entry, _)| entry.height_m.abs() > SEA_LEVEL_M);
        let (entry, gap_m) = own.or_else(across)?;
        let count_in = |file: &FileAudit| match file.sentinel() {
            _ if own.is_none() => file.count_of(entry.height_m),
            Some((same, _)) if same.height_m - entry.height_m == 0.0 => same.count,
            _ => 0,
        };
        let holders: Vec<_> = files().filter(|(_, file)| count_in(file) > 0).collect();
        let (first, _) = holders.first()?;
        let samples = match own {
            Some(_) => holders.iter().map(|(_, file)| file.samples).sum(),
            None => all.samples,
        };
        let [low_m, high_m] = all.range_m()?;
        let names = holders.iter().map(|(source, _)| format!("{:?}", source.path));
        Some(AuditError::Sentinel {
            files: first_names(names),
            stored: first.values.stored_text(entry.stored),
            count: holders.iter().map(|(_, file)| count_in(file)).sum(),
            samples,
            height_m: entry.height_m,
            gap_m,
            is_below: entry.height_m <= low_m.midpoint(high_m),
            low_m: low_m.floor(),
            high_m: high_m.ceil(),
        })
    }
}

fn out_of_range(
    source: &Source,
    one: &ExtremeHeight,
    [count, samples]: [u64; 2],
    [low_m, high_m]: [f64; 2],
) -> AuditError {
    AuditError::OutOfRange {
        path: source.path.clone(),
        count,
        samples,
        height_m: one.height_m,
        stored: source.values.stored_text(one.stored),
        low_m,
        high_m,
    }
}

/// The parts of one file, in the same rows, as parts without common samples: if a grid covers the
/// whole earth, its file can occur more than once.
fn without_overlap(mut parts: Vec<SampleRect>) -> Vec<SampleRect> {
    parts.sort_by_key(|part| part.min[0]);
    let mut apart: Vec<SampleRect> = Vec::new();
    for part in parts {
        match apart.last_mut().filter(|last| part.min[0] <= last.max[0]) {
            Some(last) => *last = last.union(&part),
            None => apart.push(part),
        }
    }
    apart
}

#[cfg(test)]
#[path = "audit_tests.rs"]
mod tests;
