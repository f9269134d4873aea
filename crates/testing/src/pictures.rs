//! Compares rendered images with golden images, which were inspected and found correct.

use std::path::PathBuf;

use image::{Rgba, RgbaImage};

/// The number of steps (of 255) by which a channel may differ, because of rounding in another
/// version of the driver.
const TOLERANCE: u8 = 2;
/// The fraction of the pixels that may differ by more, because their centres are on an edge.
const SHARE: f64 = 1e-4;

/// The difference between two images.
#[derive(Debug)]
pub struct Mismatch {
    /// The number of pixels that differ by more than the tolerance, and of all pixels.
    pixels: (usize, usize),
    /// The largest difference of a channel, in steps of 255.
    worst: u8,
    /// Differing pixels in red, the others pale.
    picture: RgbaImage,
}

impl Mismatch {
    fn between(expected: &RgbaImage, found: &RgbaImage) -> Self {
        let mut picture = expected.clone();
        let (mut count, mut worst) = (0, 0);
        for (pixel, other) in picture.pixels_mut().zip(found.pixels()) {
            let steps = [0, 1, 2, 3].map(|k| pixel.0[k].abs_diff(other.0[k]));
            let most = steps.into_iter().max().unwrap();
            worst = worst.max(most);
            count += usize::from(most > TOLERANCE);
            let pale = pixel.0.map(|channel| 191 + channel / 4);
            *pixel = if most > TOLERANCE { Rgba([255, 0, 0, 255]) } else { Rgba(pale) };
        }
        Self { pixels: (count, expected.pixels().len()), worst, picture }
    }

    /// Whether the images count as equal.
    #[must_use]
    pub fn is_match(&self) -> bool {
        self.pixels.0 as f64 <= SHARE * self.pixels.1 as f64
    }
}

impl std::fmt::Display for Mismatch {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { pixels: (count, all), worst, .. } = self;
        write!(f, "{count} of {all} pixels differ, by {worst} of 255 at most")
    }
}

/// Whether the rendered images replace the golden ones.
#[must_use]
pub fn is_blessing() -> bool {
    std::env::var_os("CORNICHE_BLESS").is_some_and(|value| value == "1")
}

/// The golden images of a crate.
#[derive(Debug)]
pub struct Golden {
    folder: PathBuf,
    differences: PathBuf,
}

impl Golden {
    /// Returns the images in `tests/golden` of the crate with this `CARGO_MANIFEST_DIR`. Differing
    /// images are written to the folder `differences`: `CARGO_TARGET_TMPDIR`, which Cargo only sets
    /// for integration tests, or else a folder for temporary files.
    #[must_use]
    pub fn of_crate(manifest_dir: &str, differences: Option<&str>) -> Self {
        let folder = PathBuf::from(manifest_dir).join("tests/golden");
        let differences = differences.map_or_else(std::env::temp_dir, PathBuf::from);
        Self { folder, differences }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.join(format!("{name}.png"))
    }

    /// Compares an image with the golden one of this name.
    ///
    /// # Errors
    /// When there is no image of this name or its size differs.
    pub fn mismatch(&self, name: &str, found: &RgbaImage) -> Result<Mismatch, String> {
        let path = self.path(name);
        let expected =
            image::open(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        let expected = expected.to_rgba8();
        if expected.dimensions() != found.dimensions() {
            return Err(format!(
                "{:?} pixels instead of {:?}",
                found.dimensions(),
                expected.dimensions()
            ));
        }
        Ok(Mismatch::between(&expected, found))
    }

    /// Fails unless an image equals the golden one of this name. The rendered image and its
    /// differences are then written to the folder for differences.
    ///
    /// # Panics
    /// When they differ.
    pub fn check(&self, name: &str, found: &RgbaImage) {
        if is_blessing() {
            found.save(self.path(name)).unwrap();
            return;
        }
        let compared = self.mismatch(name, found);
        if compared.as_ref().is_ok_and(Mismatch::is_match) {
            return;
        }
        let folder = &self.differences;
        found.save(folder.join(format!("{name}.png"))).unwrap();
        let what = match compared {
            Ok(mismatch) => {
                mismatch.picture.save(folder.join(format!("{name}-differs.png"))).unwrap();
                mismatch.to_string()
            }
            Err(what) => what,
        };
        panic!(
            "{name}: {what}; inspect {name}.png and {name}-differs.png in {}, and if the new image is correct, run again \
             with CORNICHE_BLESS=1",
            folder.display()
        );
    }
}
