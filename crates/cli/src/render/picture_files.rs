//! The output files of an image: a PNG, optionally with its georeference in other files, or a
//! GeoTIFF, which contains it.

use std::path::{Path, PathBuf};

use corniche_export::{PictureFacts, PlaceOfPicture, export_picture};
use flate2::Crc;
use image::RgbaImage;

use crate::{
    args::{PrintScale, RenderArgs},
    failure::{CommandFailure, Result},
    names::{MAP, PICTURE},
    output::{Complete, Output, existing_of, named::NamedOutput, png},
};

/// End of the header of a PNG: eight bytes of signature, then length, name, thirteen bytes and
/// checksum.
const END_OF_HEADER: usize = 8 + 4 + 4 + 13 + 4;

/// The requested files, none of which is begun.
pub(crate) struct PictureFiles {
    target: PathBuf,
    files: Files,
}

enum Files {
    Png {
        picture: Output,
        /// The georeference next to the image: a world file and a coordinate system.
        place: Option<Box<[Output; 2]>>,
    },
    Map(NamedOutput),
}

impl PictureFiles {
    /// Claims the files. Unwritable targets are reported here, before anything is drawn. The
    /// command itself uses the files `used`.
    pub(crate) fn create(args: &RenderArgs, used: &[&Path]) -> Result<Self> {
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
            Ok::<_, CommandFailure>(Box::new([beside("pgw")?, beside("prj")?]))
        });
        let files = Files::Png { picture, place: place.transpose()? };
        Ok(Self { target: target.to_path_buf(), files })
    }

    /// Writes all files, and moves them to their targets when all are complete. Returns whether the
    /// coordinate system was recorded completely.
    pub(crate) fn write(
        self,
        picture: &RgbaImage,
        place: Option<&PlaceOfPicture>,
        scale: Option<PrintScale>,
        facts: PictureFacts,
    ) -> Result<bool> {
        let target = self.target;
        match (self.files, place) {
            (Files::Map(file), Some(place)) => {
                let dots_per_inch = scale.map(|scale| scale.dots_per_inch);
                let facts = PictureFacts { dots_per_inch, ..facts };
                let is_same_crs = export_picture(picture, place, &facts, &file.path())
                    .map_err(|error| CommandFailure::from(error).about_target(&target))?;
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

fn refuse_map(target: &Path, is_from_above: bool, has_world_file: bool) -> Result<()> {
    if !is_from_above {
        return Err(no_place(target));
    }
    if has_world_file {
        refuse!(
            "{target:?}: a GeoTIFF contains its georeference, and --world-file applies only to .png images; omit --world-file"
        );
    }
    Ok(())
}

/// Rejects a leftover world file of an earlier image, which would give this image a wrong
/// georeference.
fn refuse_other_place(target: &Path) -> Result<()> {
    let beside = target.with_extension("pgw");
    if !beside.exists() {
        return Ok(());
    }
    Err(unusable!(
        "{beside:?} is the world file of an earlier image, and programs would apply it to {target:?}; remove it, choose another name, or pass --world-file"
    ))
}

fn no_place(target: &Path) -> CommandFailure {
    unusable!(
        "cannot write {target:?}: only a view from above can be georeferenced; pass --ortho, or a name with the extension .png"
    )
}

/// Adds the number of pixels per metre of paper to a PNG, in a chunk after its header (PNG, third
/// edition, 11.3.4.3).
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
