//! Prints the bytes of packages by kind of section, and then the parts of photos.
//!
//! ```sh
//! cargo run --release -p corniche-tileset --features write --example section_bytes -- A.pmtiles B.pmtiles
//! ```
#![expect(clippy::print_stdout, reason = "an example prints its result")]

use std::{env, error::Error, path::Path};

use corniche_tileset::{FilePackage, PayloadSizes, payload_sizes, photo_section};

const PHOTO_PARTS: [&str; 3] = ["coverage", "heads and tables", "coded blocks"];

/// Bytes of a package.
#[derive(Default)]
struct Sums {
    sections: [u64; 9],
    photo: [u64; PHOTO_PARTS.len()],
}

fn main() -> Result<(), Box<dyn Error>> {
    for file in env::args().skip(1) {
        let package = FilePackage::open(Path::new(&file))?;
        let mut sums = Sums::default();
        for id in package.tile_ids()? {
            let Some(payload) = package.tile(id)? else { continue };
            add(&mut sums.sections, stored(&payload_sizes(&payload, id)?));
            if let Some(photo) = photo_section(&payload, id)? {
                add(&mut sums.photo, photo_parts(photo.bytes()).map(|bytes| bytes as u64));
            }
        }
        let whole = std::fs::metadata(&file)?.len();
        println!("\n{file}: {whole} bytes\n");
        let names = [
            "terrain",
            "GEO",
            "SV",
            "attributes",
            "road tags",
            "relief",
            "photo",
            "spans",
            "layers",
        ];
        table("sections", &names, &sums.sections, whole);
        table("photo", &PHOTO_PARTS, &sums.photo, whole);
    }
    Ok(())
}

fn stored(sizes: &PayloadSizes) -> [u64; 9] {
    let layers = sizes.layers.iter().map(|size| size.stored).sum();
    let [terrain, geo, sv, attributes, tags, relief, photo, spans] = [
        sizes.terrain,
        sizes.roads_geo,
        sizes.roads_sv,
        sizes.attributes,
        sizes.road_tags,
        sizes.relief,
        sizes.photo,
        sizes.spans,
    ]
    .map(|size| size.stored);
    [terrain, geo, sv, attributes, tags, relief, photo, spans, layers]
}

/// Counts the bytes before the JPEG image, of its markers with their content, and of its scans.
fn photo_parts(section: &[u8]) -> [usize; 3] {
    let begin = section.windows(2).position(|two| two == [0xff, 0xd8]).unwrap_or(section.len());
    let (mut at, mut heads) = (begin, 0);
    let jpeg_end = section.len();
    while at + 4 <= jpeg_end {
        let marker = section[at + 1];
        // A restart marker or an escaped 255 belongs to a scan.
        let is_marker = section[at] == 0xff && !matches!(marker, 0 | 0xd0..=0xd7 | 0xff);
        let has_length = !matches!(marker, 0xd8 | 0xd9);
        let length = match (is_marker, has_length) {
            (false, _) => 0,
            (true, false) => 2,
            (true, true) => 2 + usize::from(section[at + 2]) * 256 + usize::from(section[at + 3]),
        };
        heads += length;
        at += length.max(1);
    }
    [begin, heads, jpeg_end - begin - heads]
}

fn add<const N: usize>(sums: &mut [u64; N], bytes: [u64; N]) {
    for (sum, bytes) in sums.iter_mut().zip(bytes) {
        *sum += bytes;
    }
}

/// Prints the parts that have bytes.
fn table(title: &str, names: &[&str], bytes: &[u64], whole: u64) {
    let all: u64 = bytes.iter().sum();
    if all == 0 {
        return;
    }
    println!("| {title} | bytes | of these | of the package |");
    println!("|---|--:|--:|--:|");
    let share = |bytes: u64, of: u64| 100.0 * bytes as f64 / of as f64;
    for (name, &bytes) in names.iter().zip(bytes).filter(|(_, bytes)| **bytes > 0) {
        println!(
            "| {name} | {bytes} | {:.1} % | {:.1} % |",
            share(bytes, all),
            share(bytes, whole)
        );
    }
    println!("| all | {all} | | {:.1} % |\n", share(all, whole));
}
