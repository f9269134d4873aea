//! Resamples pixels to one texel.

use std::ops::Range;

/// Pixels of a rectangle of a photo: red, green, blue, opacity.
pub(crate) struct Pixels {
    /// Column and row of the first pixel in the photo.
    pub(crate) start: [i64; 2],
    pub(crate) columns: usize,
    pub(crate) rows: usize,
    pub(crate) rgba: Vec<[u8; 4]>,
}

/// The contribution of one photo to a texel: colour times opacity, and opacity, all from 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct PremultipliedColour {
    pub(crate) rgb: [f64; 3],
    pub(crate) opacity: f64,
}

/// Weights of the pixels along one axis: a tent as wide as two texels, or two pixels where these
/// are larger. If the photo is coarser, this is bilinear interpolation. If it is finer, this is an
/// average over the texel that fades into its neighbours, so that detail finer than a texel does
/// not alias.
#[derive(Default)]
pub(crate) struct Weights {
    first: i64,
    of_pixels: Vec<f64>,
    /// The sum of the weights of all pixels, those outside the photo included.
    sum: f64,
}

impl Weights {
    /// Sets the weights around a position, in pixels; the centre of pixel k is at k + 0.5.
    fn set(&mut self, position: f64, radius: f64, allowed: &Range<i64>) {
        let first = (position - radius - 0.5).ceil() as i64;
        let last = (position + radius - 0.5).floor() as i64;
        self.first = first.max(allowed.start);
        self.of_pixels.clear();
        self.sum = 0.0;
        for pixel in first..=last {
            let weight = 1.0 - (pixel as f64 + 0.5 - position).abs() / radius;
            self.sum += weight;
            if allowed.contains(&pixel) {
                self.of_pixels.push(weight);
            }
        }
    }
}

/// Resamples pixels to texels; keeps its buffers.
#[derive(Default)]
pub(crate) struct Filter {
    columns: Weights,
    rows: Weights,
}

impl Filter {
    /// Returns the contribution of the pixels around a position. Pixels outside the rectangle are
    /// transparent.
    pub(crate) fn at(
        &mut self,
        pixels: &Pixels,
        position: [f64; 2],
        radius: [f64; 2],
    ) -> PremultipliedColour {
        if !(position[0].is_finite() && position[1].is_finite()) {
            return PremultipliedColour::default();
        }
        let end = [pixels.columns, pixels.rows];
        let allowed = [0, 1].map(|k| pixels.start[k]..pixels.start[k] + end[k] as i64);
        self.columns.set(position[0], radius[0], &allowed[0]);
        self.rows.set(position[1], radius[1], &allowed[1]);
        if self.columns.of_pixels.is_empty() || self.rows.of_pixels.is_empty() {
            return PremultipliedColour::default();
        }
        let mut sums = [0.0; 4];
        for (row, row_weight) in self.rows.of_pixels.iter().enumerate() {
            let line = (self.rows.first - pixels.start[1]) as usize + row;
            let from = line * pixels.columns + (self.columns.first - pixels.start[0]) as usize;
            let line = &pixels.rgba[from..from + self.columns.of_pixels.len()];
            for (pixel, column_weight) in line.iter().zip(&self.columns.of_pixels) {
                let weight = row_weight * column_weight * f64::from(pixel[3]);
                for k in 0..3 {
                    sums[k] += weight * f64::from(pixel[k]);
                }
                sums[3] += weight;
            }
        }
        let all = self.columns.sum * self.rows.sum * 255.0;
        let [r, g, b, opacity] = sums;
        PremultipliedColour {
            rgb: [r, g, b].map(|sum| sum / (all * 255.0)),
            opacity: opacity / all,
        }
    }
}

impl PremultipliedColour {
    /// Blends this colour over the one beneath.
    pub(crate) fn over(self, beneath: Self) -> Self {
        let through = 1.0 - self.opacity;
        Self {
            rgb: [0, 1, 2].map(|k| self.rgb[k] + through * beneath.rgb[k]),
            opacity: self.opacity + through * beneath.opacity,
        }
    }

    /// Returns the colour as a texel: none if less than half of it is covered.
    pub(crate) fn texel(self) -> [u8; 4] {
        if self.opacity < 0.5 {
            return crate::texels::NONE;
        }
        let value =
            |share: f64| (share / self.opacity * 255.0 + 0.5).floor().clamp(0.0, 255.0) as u8;
        let [r, g, b] = self.rgb.map(value);
        [r, g, b, 255]
    }
}
