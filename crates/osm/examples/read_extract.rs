//! Reads the roads of an extract within a memory limit, and prints the time and memory used.
//!
//! ```sh
//! cargo run -p corniche-osm --example read_extract -- FILE.osm.pbf MEMORY_MIB [THREADS [digest|time [TABLE]]]
//! ```
//!
//! With `time`, roads are only counted, so that the time is the time of reading. `TABLE` is a file
//! with a class table.
//!
//! Scratch space is an unnamed file in the system's folder for temporary files (`TMPDIR`). The
//! digest covers all roads, defects and counts: an extract has the same digest with any memory
//! limit and any number of threads.
#![expect(clippy::print_stdout, reason = "an example prints its result")]

use std::{
    env,
    error::Error,
    fs::{self, File},
    hash::{DefaultHasher, Hash, Hasher},
    io::{self, Read, Seek, SeekFrom, Write},
    sync::{Mutex, PoisonError},
    time::Instant,
};

use corniche_geom::LatticePoint;
use corniche_osm::ReadRequest;
use corniche_presets::parse_frc_table;
use corniche_store::{ScratchRange, ScratchSpace};
use roads::read_roads;

#[path = "../tests/it/common/roads.rs"]
mod roads;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [file, memory_mib, threads @ ..] = arguments.as_slice() else {
        return Err("usage: read_extract FILE MEMORY_MIB [THREADS [digest|time [TABLE]]]".into());
    };
    let has_digest = threads.get(1).is_none_or(|text| text == "digest");
    let own_table = threads.get(2).map(fs::read_to_string).transpose()?;
    let threads: usize = threads.first().map_or(Ok(2), |text| text.parse())?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
    let preset = corniche_presets::frc_preset("default").ok_or("a preset is missing")?;
    let table = parse_frc_table(own_table.as_deref().unwrap_or(preset))?;
    let scratch = FileScratch::new()?;
    let request = ReadRequest {
        path: file.as_ref(),
        others: &[],
        table: &table,
        place: &to_lattice,
        ring_area_m2: &corniche_geom::wgs84::area_m2,
        seam: None,
        square_steps: i64::MAX,
        node_ids: false,
        pool: &pool,
        memory_bytes: memory_mib.parse::<u64>()? << 20,
        scratch: &scratch,
        on_progress: None,
    };
    let (mut roads, mut points, mut digest) = (0, 0, [(); 2].map(|()| DefaultHasher::new()));
    let [of_roads, of_defects] = &mut digest;
    let begin = Instant::now();
    let summary = read_roads(
        &request,
        &mut |road| {
            roads += 1;
            points += road.line.points().len();
            if has_digest {
                format!("{road:?}").hash(of_roads);
            }
        },
        &mut |defect| {
            if has_digest {
                format!("{defect:?}").hash(of_defects);
            }
        },
        &|| false,
    )?;
    let read_s = begin.elapsed().as_secs_f64();
    format!("{summary:?}").hash(of_defects);
    let digest = digest.map(|digest| format!("{:016x}", digest.finish())).concat();
    let scratch_mib = scratch.0.into_inner().unwrap_or_else(PoisonError::into_inner).1 >> 20;
    println!(
        "{} nodes of roads, {roads} roads, {points} points, digest {digest}; {scratch_mib} MiB of scratch space, peak {}; {read_s:.3} s",
        summary.nodes_needed,
        peak().unwrap_or_else(|| "not reported by this system".to_owned()),
    );
    Ok(())
}

/// Converts positions to a lattice of 1e-7 degrees.
fn to_lattice(positions_deg: &[[f64; 2]]) -> Vec<Option<LatticePoint>> {
    let round = |deg: f64| (deg * 1e7).round() as i64;
    let place = |&[lon, lat]: &[f64; 2]| Some(LatticePoint::new(round(lon), round(lat)));
    positions_deg.iter().map(place).collect()
}

/// Returns the peak memory of the process, as the kernel reports it.
fn peak() -> Option<String> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(line.trim().to_owned())
}

/// A file and its length, bytes.
struct FileScratch(Mutex<(File, u64)>);

impl FileScratch {
    fn new() -> io::Result<Self> {
        Ok(Self(Mutex::new((tempfile::tempfile()?, 0))))
    }
}

impl ScratchSpace for FileScratch {
    fn append(&self, bytes: &[u8]) -> io::Result<ScratchRange> {
        let mut own = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let (file, end) = &mut *own;
        file.seek(SeekFrom::Start(*end))?;
        file.write_all(bytes)?;
        let span = ScratchRange { offset: *end, length: bytes.len() as u64 };
        *end += span.length;
        Ok(span)
    }

    fn read(&self, span: ScratchRange) -> io::Result<Vec<u8>> {
        let mut own = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        own.0.seek(SeekFrom::Start(span.offset))?;
        let mut bytes = vec![0; span.length as usize];
        own.0.read_exact(&mut bytes)?;
        Ok(bytes)
    }
}
