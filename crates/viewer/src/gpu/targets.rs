//! The textures into which the passes of a frame draw.

use std::sync::OnceLock;

use super::{
    Gpu, GpuError,
    formats::{COLOR, DEPTH, LABEL, OWNER, STENCIL},
    picture::Picture,
    target_texture::TargetTexture,
};

/// Samples on each side of a block. With smaller blocks, fewer samples without a road are drawn
/// again; with larger ones there are fewer blocks to check. On software Vulkan 8, 16 and 32 take
/// equally long, within the noise.
pub(crate) const BLOCK_SIDE: u32 = 16;

/// The labels of roads, or of lines of one layer, sample by sample.
pub(crate) struct LabelTargets {
    pub(crate) labels: TargetTexture,
    /// The largest label in or near each block of samples; see [`BLOCK_SIDE`].
    pub(crate) blocks: TargetTexture,
}

impl LabelTargets {
    fn new(gpu: &Gpu, label: &'static str, sampled_px: [u32; 2]) -> Self {
        let blocks_px = sampled_px.map(|side| side.div_ceil(BLOCK_SIDE));
        Self {
            labels: TargetTexture::new(gpu, label, LABEL, sampled_px),
            blocks: TargetTexture::new(gpu, "blocks", LABEL, blocks_px),
        }
    }
}

/// The depths and labels of decks of bridges.
pub(crate) struct DeckTargets {
    /// The depth of the nearest deck of roads and lines, encoded like the ground's; 0 without a
    /// deck.
    pub(crate) depth: TargetTexture,
    /// The labels of roads.
    pub(crate) labels: LabelTargets,
}

/// The textures into which the passes draw: a picture and its layers, sample by sample.
pub struct Targets {
    pub(crate) ground: TargetTexture,
    pub(crate) depth: TargetTexture,
    pub(crate) owners: TargetTexture,
    pub(crate) roads: LabelTargets,
    /// Created when areas are first drawn.
    stencil: OnceLock<TargetTexture>,
    /// Created when lines that are not roads are first drawn.
    lines: OnceLock<LabelTargets>,
    /// Created when decks are first drawn.
    decks: OnceLock<DeckTargets>,
    /// Created when decks of lines are first drawn.
    line_decks: OnceLock<LabelTargets>,
    /// The picture.
    pub picture: Picture,
}

impl Targets {
    /// Creates the targets for a picture of this size, with `samples_per_side` samples on each side
    /// of a pixel; with 1, only the pixel's centre is sampled. Besides the picture they take 17
    /// bytes per sample, one more once areas have been drawn, one more once lines that are not
    /// roads have been drawn, five more once decks of bridges have been drawn, one more once decks
    /// of such lines have been drawn, and one byte for each block of 16 × 16 samples.
    ///
    /// # Errors
    /// When the size has a 0, when it has more samples than the adapter can draw, or when there are
    /// no samples or too many per pixel.
    pub fn new(gpu: &Gpu, size_px: [u32; 2], samples_per_side: u32) -> Result<Self, GpuError> {
        let picture = Picture::new(gpu, size_px, samples_per_side)?;
        let sampled_px = picture.sampled_px();
        let texture = |label, format| TargetTexture::new(gpu, label, format, sampled_px);
        Ok(Self {
            ground: texture("ground", COLOR),
            depth: texture("depth", DEPTH),
            owners: texture("owners", OWNER),
            roads: LabelTargets::new(gpu, "road labels", sampled_px),
            stencil: OnceLock::new(),
            lines: OnceLock::new(),
            decks: OnceLock::new(),
            line_decks: OnceLock::new(),
            picture,
        })
    }

    /// The stencil that counts area volumes. It is a separate texture, because a pass cannot write
    /// the stencil of a texture whose depth it reads.
    pub(crate) fn stencil(&self, gpu: &Gpu) -> &TargetTexture {
        let sampled_px = self.picture.sampled_px();
        self.stencil.get_or_init(|| TargetTexture::new(gpu, "area counts", STENCIL, sampled_px))
    }

    /// The labels of lines that are not roads. All layers share them, but not with roads: the
    /// labels of roads are still needed after a picture is drawn.
    pub(crate) fn lines(&self, gpu: &Gpu) -> &LabelTargets {
        let sampled_px = self.picture.sampled_px();
        self.lines.get_or_init(|| LabelTargets::new(gpu, "line labels", sampled_px))
    }

    /// The targets of decks, created at first use.
    pub(crate) fn decks(&self, gpu: &Gpu) -> &DeckTargets {
        let sampled_px = self.picture.sampled_px();
        self.decks.get_or_init(|| DeckTargets {
            depth: TargetTexture::new(gpu, "deck depth", DEPTH, sampled_px),
            labels: LabelTargets::new(gpu, "deck labels", sampled_px),
        })
    }

    /// The labels of decks of lines that are not roads; all layers share them.
    pub(crate) fn line_decks(&self, gpu: &Gpu) -> &LabelTargets {
        let sampled_px = self.picture.sampled_px();
        self.line_decks.get_or_init(|| LabelTargets::new(gpu, "line deck labels", sampled_px))
    }

    /// The targets of decks; `None` if no decks have been drawn yet.
    pub(crate) fn drawn_decks(&self) -> Option<&DeckTargets> {
        self.decks.get()
    }

    /// The number of blocks in the picture. Blocks at the right and at the bottom may extend beyond
    /// the samples.
    pub(crate) fn block_count(&self) -> u32 {
        self.picture.sampled_px().map(|side| side.div_ceil(BLOCK_SIDE)).iter().product()
    }
}
