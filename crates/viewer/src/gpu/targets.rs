//! All textures that the passes of a frame draw into.

use std::sync::OnceLock;

use super::{
    Gpu, GpuError,
    formats::{COLOR, DEPTH, LABEL, OWNER, STENCIL},
    picture::Picture,
    target_texture::TargetTexture,
};

/// Samples on each side of a block. With smaller blocks fewer samples without a road are drawn again; with larger ones there
/// are fewer blocks to look at. On software Vulkan 8, 16 and 32 take equally long, within the noise.
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

/// What is drawn of decks of bridges.
pub(crate) struct DeckTargets {
    /// The depth of the nearest deck, as the ground's; 0 where none is seen.
    pub(crate) depth: TargetTexture,
    pub(crate) labels: LabelTargets,
}

/// The textures that the passes draw into: a picture and, sample by sample, what it is made of.
pub struct Targets {
    pub(crate) ground: TargetTexture,
    pub(crate) depth: TargetTexture,
    pub(crate) owners: TargetTexture,
    pub(crate) roads: LabelTargets,
    /// Made when areas are first drawn.
    stencil: OnceLock<TargetTexture>,
    /// Made when lines beside roads are first drawn.
    lines: OnceLock<LabelTargets>,
    /// Made when decks are first drawn.
    decks: OnceLock<DeckTargets>,
    /// The picture.
    pub picture: Picture,
}

impl Targets {
    /// Targets for a picture of this size, with so many samples on each side of a pixel; 1 takes the pixel's centre
    /// alone. Besides the picture they take 17 bytes for each sample, one more once areas
    /// have been drawn, one more once lines beside roads have been and five more once decks of bridges have been, and one byte for each
    /// block of 16 × 16 samples.
    ///
    /// # Errors
    /// When the size has a 0, when its samples are more than the adapter can draw, or when there are no samples or too many
    /// a pixel.
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
            picture,
        })
    }

    /// The stencil in which volumes of areas are counted. It is a texture of its own, because a pass cannot write the stencil of a texture
    /// whose depth it reads.
    pub(crate) fn stencil(&self, gpu: &Gpu) -> &TargetTexture {
        let sampled_px = self.picture.sampled_px();
        self.stencil.get_or_init(|| TargetTexture::new(gpu, "area counts", STENCIL, sampled_px))
    }

    /// The labels of lines beside the roads. All layers take turns in them: those of roads are still needed after a picture is drawn.
    pub(crate) fn lines(&self, gpu: &Gpu) -> &LabelTargets {
        let sampled_px = self.picture.sampled_px();
        self.lines.get_or_init(|| LabelTargets::new(gpu, "line labels", sampled_px))
    }

    /// What is drawn of decks.
    pub(crate) fn decks(&self, gpu: &Gpu) -> &DeckTargets {
        let sampled_px = self.picture.sampled_px();
        self.decks.get_or_init(|| DeckTargets {
            depth: TargetTexture::new(gpu, "deck depth", DEPTH, sampled_px),
            labels: LabelTargets::new(gpu, "deck labels", sampled_px),
        })
    }

    /// What was drawn of decks; `None` if none were yet.
    pub(crate) fn drawn_decks(&self) -> Option<&DeckTargets> {
        self.decks.get()
    }

    /// How many blocks its samples are divided into. Blocks on the right and at the bottom may reach beyond the samples.
    pub(crate) fn block_count(&self) -> u32 {
        self.picture.sampled_px().map(|side| side.div_ceil(BLOCK_SIDE)).iter().product()
    }
}
