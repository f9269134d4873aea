//! Containers and encodings: a plane is reproduced from any format.

use std::fs;
use std::path::{Path, PathBuf};

use corniche_dem::{Dem, DemError, OpenDemError, OpenOptions};
use gdal::{DriverManager, Metadata};

use crate::fixture::{Raster, Space, UTM, check_heights, check_refused, converted, plane};

const SAMPLES: usize = 60 * 50;

/// The rounding error of 32-bit floats.
const F32_M: f64 = 1e-4;

fn raster<'a>() -> Raster<'a> {
    Raster::new(32632, [60, 50], UTM)
}

fn check(name: &str, file: &Path, tolerance_m: f64) {
    let files = [file.to_path_buf()];
    let given = OpenOptions::default();
    let count = check_heights(name, &files, &given, (Space::Working, tolerance_m), plane);
    assert_eq!(count, SAMPLES, "{name}");
}

#[test]
fn every_encoding_of_geotiff_gives_the_plane() {
    let folder = tempfile::tempdir().unwrap();
    let driver = DriverManager::get_driver_by_name("GTiff").unwrap();
    let known = driver.metadata_item("DMD_CREATIONOPTIONLIST", "").unwrap();
    let mut count = 0;
    for options in [
        &["BIGTIFF=YES"][..],
        &["BIGTIFF=YES", "ENDIANNESS=BIG", "TILED=YES", "BLOCKXSIZE=16", "BLOCKYSIZE=16"],
        &["TILED=YES", "BLOCKXSIZE=32", "BLOCKYSIZE=64"],
        &["BLOCKYSIZE=1"],
        &["BLOCKYSIZE=7"],
        &["ENDIANNESS=BIG"],
        &["SPARSE_OK=TRUE", "TILED=YES"],
        &["GEOTIFF_VERSION=1.1"],
        &["PROFILE=GeoTIFF"],
        &["COMPRESS=PACKBITS"],
        &["COMPRESS=LZW"],
        &["COMPRESS=LZW", "PREDICTOR=3", "TILED=YES"],
        &["COMPRESS=DEFLATE", "PREDICTOR=2"],
        &["COMPRESS=LZMA"],
        &["COMPRESS=ZSTD", "PREDICTOR=3"],
        &["COMPRESS=LERC", "MAX_Z_ERROR=0"],
        &["COMPRESS=LERC_DEFLATE", "MAX_Z_ERROR=0"],
        &["COMPRESS=LERC_ZSTD", "MAX_Z_ERROR=0"],
    ] {
        let compression = options.iter().find_map(|option| option.strip_prefix("COMPRESS="));
        if compression.is_some_and(|name| !known.contains(&format!("<Value>{name}</Value>"))) {
            corniche_testing::skip(&format!("this GDAL does not write {options:?}"));
            continue;
        }
        let name = format!("{}.tif", options.join("_").replace('=', "-"));
        let path = raster().created(options).write(folder.path(), &name, |at| plane(at) as f32);
        check(&name, &path, F32_M);
        count += 1;
    }
    assert!(count >= 9, "{count} encodings");
}

/// Drivers that need no other library: every GDAL has them, unless it was built without them.
const IN_EVERY_GDAL: [&str; 8] = ["GTiff", "COG", "VRT", "AAIGrid", "EHdr", "ENVI", "HFA", "SAGA"];

/// Formats that GDAL writes by copying a raster.
#[test]
fn every_format_gives_the_plane() {
    let folder = tempfile::tempdir().unwrap();
    let source = raster().write(folder.path(), "source.tif", |at| plane(at) as f32);
    let mut seen = vec!["GTiff"];
    check("GTiff source.tif", &source, 2e-4);
    for (driver, name, options) in [
        ("COG", "cog.tif", &["BLOCKSIZE=128", "COMPRESS=DEFLATE"][..]),
        ("VRT", "copy.vrt", &[]),
        ("AAIGrid", "grid.asc", &["FORCE_CELLSIZE=TRUE", "DECIMAL_PRECISION=4"]),
        ("GPKG", "heights.gpkg", &["TILE_FORMAT=TIFF", "RASTER_TABLE=heights"]),
        ("netCDF", "classic.nc", &["FORMAT=NC"]),
        ("netCDF", "bottom-up.nc", &["WRITE_BOTTOMUP=NO"]),
        ("HFA", "erdas.img", &[]),
        ("EHdr", "esri.bil", &[]),
        ("ENVI", "envi.dat", &[]),
        ("SAGA", "saga.sdat", &[]),
        ("GSBG", "surfer.grd", &[]),
        ("Zarr", "heights.zarr", &[]),
    ] {
        let Some(path) = converted(&source, driver, name, options) else { continue };
        check(&format!("{driver} {name}"), &path, 2e-4);
        seen.push(driver);
    }
    for driver in IN_EVERY_GDAL {
        assert!(seen.contains(&driver), "{driver} was not tested; GDAL must have it");
    }
}

/// Corner and centre of the lower left cell, whole and broken cells, named in the header.
#[test]
fn ascii_grids_know_corners_from_centres() {
    let folder = tempfile::tempdir().unwrap();
    let wkt = "EPSG:32632".to_owned();
    let given = OpenOptions { dem_crs: Some(wkt), ..OpenOptions::default() };
    let rows: Vec<String> = (0..50)
        .map(|row| {
            let line = (0..60).map(|column| {
                let at =
                    [500_008.0 + 10.0 * f64::from(column), 5_200_502.0 - 10.0 * f64::from(row)];
                if (column, row) == (7, 9) { "-9999".to_owned() } else { plane(at).to_string() }
            });
            line.collect::<Vec<_>>().join(" ")
        })
        .collect();
    for (name, x, y) in [
        ("corner", "xllcorner 500003", "yllcorner 5200007"),
        ("center", "xllcenter 500008", "yllcenter 5200012"),
    ] {
        let text = format!(
            "ncols 60\nnrows 50\n{x}\n{y}\ncellsize 10\nNODATA_value -9999\n{}\n",
            rows.join("\n")
        );
        let path = folder.path().join(format!("{name}.asc"));
        fs::write(&path, text).unwrap();
        let files = [path];
        let count = check_heights(name, &files, &given, (Space::Working, F32_M), plane);
        assert_eq!(count, SAMPLES - 1, "{name}");
        check_refused(&files, &OpenOptions::default(), &[name, "--dem-crs"]);
    }
}

/// An integer plane over one degree: exact in 16 bits, and linear between samples.
fn degrees([lon, lat]: [f64; 2]) -> f64 {
    1500.0 + (lon - 8.0) * 1200.0 - (47.0 - lat) * 1200.0
}

/// The height of one hundredth of the finer spacing on that plane, and PROJ's rounding.
const DEGREES_M: f64 = 0.02;

fn srtm(folder: &Path, name: &str) -> PathBuf {
    let bytes: Vec<u8> = (0..1201_i16)
        .flat_map(|row| (0..1201_i16).flat_map(move |column| (1500 + column - row).to_be_bytes()))
        .collect();
    let path = folder.join(name);
    fs::write(&path, bytes).unwrap();
    path
}

#[test]
fn srtm_squares_lie_where_their_name_says() {
    let folder = tempfile::tempdir().unwrap();
    let files = [srtm(folder.path(), "N46E008.hgt")];
    let given = OpenOptions::default();
    let count = check_heights("hgt", &files, &given, (Space::Degrees, DEGREES_M), degrees);
    assert_eq!(count, 1201 * 1201, "nodes are samples");
    let bytes = fs::read(&files[0]).unwrap();
    for length in [1, 1201 * 1201, bytes.len() - 2, bytes.len() + 2] {
        let mut other = bytes.clone();
        other.resize(length, 0);
        let path = folder.path().join("N46E009.hgt");
        fs::write(&path, other).unwrap();
        check_refused(
            &[path],
            &given,
            &["N46E009.hgt", &format!("has {length} bytes"), "whole .hgt files"],
        );
    }
    let anonymous = [srtm(folder.path(), "heights.hgt")];
    check_refused(&anonymous, &given, &["heights.hgt", "does not give its position"]);
}

#[test]
fn dted_gives_the_plane() {
    let folder = tempfile::tempdir().unwrap();
    let half = 1.0 / 240.0;
    let corner = [8.0 - half, 1.0 / 120.0, 0.0, 47.0 + half, 0.0, -1.0 / 120.0];
    let source = Raster::new(4326, [121, 121], corner)
        .write(folder.path(), "dted.tif", |at| degrees(at).round() as i16);
    let Some(path) = converted(&source, "DTED", "n46.dt0", &[]) else { return };
    let options = OpenOptions::default();
    let count = check_heights("DTED", &[path], &options, (Space::Degrees, 0.1), degrees);
    assert_eq!(count, 121 * 121);
}

fn vrt(sources: &[(&str, usize)]) -> String {
    let parts = sources.iter().map(|(name, left)| {
        format!(
            "<SimpleSource><SourceFilename relativeToVRT=\"1\">{name}</SourceFilename>\
             <SourceBand>1</SourceBand><SrcRect xOff=\"0\" yOff=\"0\" xSize=\"30\" ySize=\"50\"/>\
             <DstRect xOff=\"{left}\" yOff=\"0\" xSize=\"30\" ySize=\"50\"/></SimpleSource>"
        )
    });
    format!(
        "<VRTDataset rasterXSize=\"60\" rasterYSize=\"50\"><SRS>EPSG:32632</SRS>\
         <GeoTransform>{}</GeoTransform><VRTRasterBand dataType=\"Float32\" band=\"1\">{}\
         </VRTRasterBand></VRTDataset>",
        UTM.map(|value| value.to_string()).join(", "),
        parts.collect::<String>()
    )
}

#[test]
fn a_virtual_mosaic_finds_its_files_beside_it_and_misses_those_gone() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("parts")).unwrap();
    for (name, west) in [("left.tif", 0.0), ("right.tif", 300.0)] {
        let corner = [UTM[0] + west, 10.0, 0.0, UTM[3], 0.0, -10.0];
        Raster::new(32632, [30, 50], corner)
            .write(&folder.path().join("parts"), name, |at| plane(at) as f32);
    }
    let path = folder.path().join("mosaic.vrt");
    fs::write(&path, vrt(&[("parts/left.tif", 0), ("parts/right.tif", 30)])).unwrap();
    check("VRT mosaic", &path, F32_M);
    fs::remove_file(folder.path().join("parts/right.tif")).unwrap();
    check_refused(&[path], &OpenOptions::default(), &["mosaic.vrt", "refers to"]);
}

#[test]
fn of_several_rasters_in_one_file_one_is_to_be_named() {
    let folder = tempfile::tempdir().unwrap();
    let source = raster().bands(2).write(folder.path(), "two.tif", |at| plane(at) as f32);
    let Some(path) = converted(&source, "netCDF", "two.nc", &[]) else { return };
    let given = OpenOptions::default();
    let name = format!("NETCDF:\"{}\":Band1", path.display());
    check_refused(std::slice::from_ref(&path), &given, &["two.nc", "several rasters", &name]);
    check("subdataset", Path::new(&name), F32_M);
}

#[test]
fn netcdf_4_gives_the_plane_and_bare_hdf5_has_no_place() {
    if !corniche_testing::is_full("libhdf5 prints its errors for every attribute that is not there")
    {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let given = OpenOptions::default();
    let source = raster().write(folder.path(), "one.tif", |at| plane(at) as f32);
    let options = ["FORMAT=NC4", "COMPRESS=DEFLATE"];
    let Some(path) = converted(&source, "netCDF", "four.nc", &options) else { return };
    check("netCDF 4", &path, F32_M);
    // HDF5 has no writer in GDAL; netCDF 4 is HDF5, but without netCDF's conventions its
    // georeference is unknown.
    if DriverManager::get_driver_by_name("HDF5").is_ok() {
        let name = PathBuf::from(format!("HDF5:\"{}\"://Band1", path.display()));
        check_refused(&[name], &given, &["four.nc", "georeference"]);
    } else {
        corniche_testing::skip("this GDAL has no driver HDF5");
    }
}

#[test]
fn broken_files_are_refused_with_a_reason() {
    let folder = tempfile::tempdir().unwrap();
    let given = OpenOptions::default();
    let whole =
        raster().created(&["COMPRESS=DEFLATE", "TILED=YES", "BLOCKXSIZE=16", "BLOCKYSIZE=16"]);
    let whole = fs::read(whole.write(folder.path(), "whole.tif", plane)).unwrap();
    for (name, bytes, words) in [
        ("empty.tif", Vec::new(), "0 bytes"),
        ("text.tif", b"ceci n'est pas un MNT\n".repeat(40), "not a raster"),
        ("markup.vrt", b"<VRTDataset rasterXSize=\"60\"".to_vec(), "not a raster"),
        ("header.tif", whole[..8].to_vec(), "not a raster"),
        ("half.tif", whole[..whole.len() / 2].to_vec(), "corrupt"),
    ] {
        let path = folder.path().join(name);
        fs::write(&path, bytes).unwrap();
        check_refused(&[path], &given, &[name, words]);
    }
    check_refused(&[folder.path().to_path_buf()], &given, &["not a file"]);
    check_refused(&[folder.path().join("gone.tif")], &given, &["gone.tif", "cannot open"]);
    assert!(matches!(Dem::open(&[], &given), Err(OpenDemError::NoFiles)));
}

/// A file that is truncated anywhere is rejected or gives the true heights; it never gives others.
#[test]
fn cut_anywhere_a_file_gives_true_heights_or_none() {
    let folder = tempfile::tempdir().unwrap();
    let small = Raster::new(32632, [12, 10], UTM).created(&["COMPRESS=LZW"]);
    let bytes = fs::read(small.write(folder.path(), "whole.tif", plane)).unwrap();
    let path = folder.path().join("cut.tif");
    let (mut read, mut refused) = (0, 0);
    for length in 0..bytes.len() {
        fs::write(&path, &bytes[..length]).unwrap();
        let open = || -> Result<_, DemError> {
            let dem = Dem::open(std::slice::from_ref(&path), &OpenOptions::default())?;
            let plan = crate::fixture::plan(&dem);
            dem.reader(&plan).window(crate::fixture::all(&plan))?;
            Ok((dem, plan))
        };
        match open() {
            Ok((dem, plan)) => {
                crate::fixture::check(&mut dem.reader(&plan), &plan, 1e-4, plane);
                read += 1;
            }
            Err(error) => {
                assert!(error.to_string().contains("cut.tif"), "{error}");
                refused += 1;
            }
        }
    }
    println!("{refused} cuts refused, {read} read");
    assert!(refused > bytes.len() / 2);
}

/// A part of a virtual raster is named by the bytes of its name, UTF-8 or not, so that callers that
/// record the name can report it.
#[cfg(target_os = "linux")]
#[test]
fn parts_keep_the_bytes_of_their_names() {
    use std::os::unix::ffi::OsStrExt;
    let folder = tempfile::tempdir().unwrap();
    let written = raster().write(folder.path(), "part.tif", plane);
    let part = folder.path().join(std::ffi::OsStr::from_bytes(b"part-\xff.tif"));
    fs::rename(written, &part).unwrap();
    let text = vrt(&[("part-@.tif", 0)]);
    let bytes: Vec<u8> = text.bytes().map(|byte| if byte == b'@' { 0xff } else { byte }).collect();
    let path = folder.path().join("named.vrt");
    fs::write(&path, bytes).unwrap();
    let files = corniche_gis::raster_files(&path).unwrap();
    assert!(files.contains(&part), "{files:?}");
}
