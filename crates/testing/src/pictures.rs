//! Pictures that were looked at and found right, against pictures drawn now.

use std::path::PathBuf;

use image::{Rgba, RgbaImage};

/// Steps of 255 by which a channel may differ: rounding of another version of the driver.
const TOLERANCE: u8 = 2;
/// Share of the pixels that may differ by more: centres that lie on an edge.
const SHARE: f64 = 1e-4;

/// How two pictures differ.
#[derive(Debug)]
pub struct Mismatch {
    /// Pixels that differ by more than the tolerance, and all.
    pixels: (usize, usize),
    /// Steps of 255 by which a channel differs at most.
    worst: u8,
    /// Pixels that differ in red, the others pale.
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

    /// Whether the pictures count as equal.
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

/// Whether the pictures drawn now become the golden ones.
#[must_use]
pub fn is_blessing() -> bool {
    std::env::var_os("CORNICHE_BLESS").is_some_and(|value| value == "1")
}

/// The golden pictures of a crate.
#[derive(Debug)]
pub struct Golden {
    folder: PathBuf,
    differences: PathBuf,
}

impl Golden {
    /// The pictures in `tests/golden` of the crate with this `CARGO_MANIFEST_DIR`. What differs is left in the folder
    /// `differences`: `CARGO_TARGET_TMPDIR`, which Cargo sets for integration tests only, or else one for temporary files.
    #[must_use]
    pub fn of_crate(manifest_dir: &str, differences: Option<&str>) -> Self {
        let folder = PathBuf::from(manifest_dir).join("tests/golden");
        let differences = differences.map_or_else(std::env::temp_dir, PathBuf::from);
        Self { folder, differences }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.join(format!("{name}.png"))
    }

    /// Compares a picture with the golden one of this name.
    ///
    /// # Errors
    /// When there is no such picture or its size differs.
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

    /// Fails unless a picture is as the golden one of this name. What was drawn, and where it differs, is then left in
    /// the folder for differences.
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
            "{name}: {what}; look at {name}.png and {name}-differs.png in {}, and if that is how it should be, run again \
             with CORNICHE_BLESS=1",
            folder.display()
        );
    }
}
