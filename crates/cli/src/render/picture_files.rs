//! The files of a picture: a PNG, on request with its place beside it, or a GeoTIFF that has it inside.

use std::path::{Path, PathBuf};

use corniche_export::{PictureFacts, PlaceOfPicture, export_picture};
use flate2::Crc;
use image::RgbaImage;

use crate::{
    args::{PrintScale, RenderArgs},
    failure::Failure,
    names::{MAP, PICTURE},
    output::{Complete, Output, existing_of, named::NamedOutput, png},
};

/// Where the header of a PNG ends: eight bytes of signature, then length, name, thirteen bytes and checksum.
const END_OF_HEADER: usize = 8 + 4 + 4 + 13 + 4;

/// The files that a command was asked for, none of which is begun.
pub(crate) struct PictureFiles {
    target: PathBuf,
    files: Files,
}

enum Files {
    Png {
        picture: Output,
        /// Beside it: a world file and a coordinate system.
        place: Option<Box<[Output; 2]>>,
    },
    Map(NamedOutput),
}

impl PictureFiles {
    /// Claims the files. What cannot be written is told here, before anything is drawn. The command itself uses the files `used`.
    pub(crate) fn create(args: &RenderArgs, used: &[&Path]) -> Result<Self, Failure> {
        let (target, existing) = (args.output.as_path(), existing_of(args.overwrite));
        let from_above = &args.from_above;
        if MAP.is_of(target) {
            refuse_map(target, from_above.ortho, from_above.world_file)?;
            let map = NamedOutput::create(target, existing, "map.tif".to_owned(), used)?;
            return Ok(Self { target: target.to_path_buf(), files: Files::Map(map) });
        }
        let picture = Output::create(target, existing, used)?;
        PICTURE.refuse_others(target)?;
        if !from_above.world_file {
            refuse_other_place(target)?;
        }
        let place = from_above.world_file.then(|| {
            let beside = |ending| Output::create(&target.with_extension(ending), existing, used);
            Ok::<_, Failure>(Box::new([beside("pgw")?, beside("prj")?]))
        });
        let files = Files::Png { picture, place: place.transpose()? };
        Ok(Self { target: target.to_path_buf(), files })
    }

    /// Writes all of them, and puts them into their places when all are complete. Tells whether the coordinate system could be named as it is.
    pub(crate) fn write(
        self,
        picture: &RgbaImage,
        place: Option<&PlaceOfPicture>,
        scale: Option<PrintScale>,
        facts: PictureFacts,
    ) -> Result<bool, Failure> {
        let target = self.target;
        match (self.files, place) {
            (Files::Map(file), Some(place)) => {
                let dots_per_inch = scale.map(|scale| scale.dots_per_inch);
                let facts = PictureFacts { dots_per_inch, ..facts };
                let is_same_crs = export_picture(picture, place, &facts, &file.path())
                    .map_err(|error| Failure::from(error).about_target(&target))?;
                file.place()?;
                Ok(is_same_crs)
            }
            (Files::Map(_), None) => Err(no_place(&target)),
            (Files::Png { picture: file, place: beside }, place) => {
                let mut written = Vec::new();
                if let (Some(beside), Some(place)) = (beside, place) {
                    let [world, prj] = *beside;
                    written.push(world.fill(place.world_file().as_bytes())?);
                    written.push(prj.fill(place.prj().as_bytes())?);
                }
                let bytes = png(picture)?;
                let bytes = match scale {
                    Some(scale) => with_resolution(bytes, scale.dots_per_metre()),
                    None => bytes,
                };
                written.push(file.fill(&bytes)?);
                written.into_iter().try_for_each(Complete::place)?;
                Ok(true)
            }
        }
    }
}

fn refuse_map(target: &Path, is_from_above: bool, has_world_file: bool) -> Result<(), Failure> {
    if !is_from_above {
        return Err(no_place(target));
    }
    if has_world_file {
        return Err(Failure::unusable(format!(
            "{}: a GeoTIFF has its place inside; --world-file goes with a picture that ends in .png",
            target.display()
        )));
    }
    Ok(())
}

/// A world file of an earlier picture would give this one a place that is not its own.
fn refuse_other_place(target: &Path) -> Result<(), Failure> {
    let beside = target.with_extension("pgw");
    if !beside.exists() {
        return Ok(());
    }
    Err(Failure::unusable(format!(
        "{}: it tells where an earlier picture lies, and programs would take that for the place of {}; remove it, choose another name, or give --world-file",
        beside.display(),
        target.display()
    )))
}

fn no_place(target: &Path) -> Failure {
    Failure::unusable(format!(
        "cannot write {}: only in a picture from above has each pixel its place on the map; give --ortho, or a name that ends in .png",
        target.display()
    ))
}

/// A PNG that says how many of its pixels are a metre of paper, in a chunk behind its header (PNG, third edition, 11.3.4.3).
///
/// ```text
///   length 9    "pHYs"    pixels to a unit along x    the same along y    1: the unit is the metre    checksum
///   4           4         4                           4                   1                           4 bytes
/// ```
fn with_resolution(mut png: Vec<u8>, dots_per_metre: u32) -> Vec<u8> {
    let mut body = b"pHYs".to_vec();
    body.extend(dots_per_metre.to_be_bytes());
    body.extend(dots_per_metre.to_be_bytes());
    body.push(1);
    let mut crc = Crc::new();
    crc.update(&body);
    let mut chunk = 9_u32.to_be_bytes().to_vec();
    chunk.extend(body);
    chunk.extend(crc.sum().to_be_bytes());
    if png.len() >= END_OF_HEADER {
        png.splice(END_OF_HEADER..END_OF_HEADER, chunk);
    }
    png
}

#[cfg(test)]
#[path = "picture_files_tests.rs"]
mod tests;
