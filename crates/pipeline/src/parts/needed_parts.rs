//! Selects by name the parts that a step can read from. Other parts need not be opened, so a large
//! number of parts does not slow down each of them.

use corniche_geom::TileId;
use corniche_ground::heights::near::is_near;
use corniche_osm::Share;

use super::step::PartStep;

/// Whether the part with this name, without its digest, may contain artifacts that the step reads
/// or would create. Always true for a name that [`part_name`] does not create.
pub(crate) fn is_needed(step: PartStep, scope: TileId, share: Share, name: &str) -> bool {
    let Some(part) = PartName::parse(name) else { return true };
    match (step, part.step) {
        (PartStep::Hashes, PartStep::Hashes)
        | (PartStep::Ways | PartStep::Nodes, PartStep::Roads)
        | (PartStep::Roads, PartStep::Roads | PartStep::Ways | PartStep::Nodes)
        | (PartStep::Top, PartStep::Heights | PartStep::Top)
        | (PartStep::Tiles, PartStep::Roads | PartStep::Top) => true,
        (PartStep::Ways, PartStep::Ways) | (PartStep::Nodes, PartStep::Nodes) => {
            part.share == share
        }
        (PartStep::Nodes, PartStep::Ways) => part.share.count() == share.count(),
        // Parts beneath the subtree or around it are needed; artifacts that one subtree has of the
        // other are not computed again.
        (PartStep::Tiles, PartStep::Heights) => is_near(scope, part.subtree),
        (PartStep::Heights, PartStep::Heights) | (PartStep::Tiles, PartStep::Tiles) => {
            meet(scope, part.subtree)
        }
        _ => false,
    }
}

/// Whether a part with this name may contain artifacts that a merge reads.
pub(crate) fn is_merged(name: &str) -> bool {
    PartName::parse(name).is_none_or(|part| !part.step.has_shares())
}

/// Whether a part with this name may contain roads.
pub(crate) fn has_roads(name: &str) -> bool {
    PartName::parse(name).is_none_or(|part| part.step == PartStep::Roads)
}

/// The name of a part.
pub(crate) fn part_name(step: PartStep, scope: TileId, share: Share) -> String {
    let name = step.name();
    if step.has_subtrees() {
        format!("{name}-{}-{}-{}", scope.z(), scope.x(), scope.y())
    } else if step.has_shares() {
        format!("{name}-{}-{}", share.number(), share.count())
    } else {
        name.to_owned()
    }
}

/// Whether one of two tiles is the other or is above it.
fn meet(a: TileId, b: TileId) -> bool {
    let level = a.z().min(b.z());
    a.ancestor(level) == b.ancestor(level)
}

/// The fields of a part's name.
struct PartName {
    step: PartStep,
    subtree: TileId,
    share: Share,
}

impl PartName {
    /// Parses a name; `None` for a name that [`part_name`] does not create.
    fn parse(name: &str) -> Option<Self> {
        let mut words = name.split('-');
        let step = words.next()?;
        let step = PartStep::ALL.into_iter().find(|known| known.name() == step)?;
        let numbers: Vec<u32> = words.map(|word| word.parse().ok()).collect::<Option<_>>()?;
        let (subtree, share) = match *numbers {
            [] if !step.has_subtrees() && !step.has_shares() => (TileId::ROOT, Share::WHOLE),
            [z, x, y] if step.has_subtrees() => {
                (TileId::new(u8::try_from(z).ok()?, x, y).ok()?, Share::WHOLE)
            }
            [number, of] if step.has_shares() => {
                (TileId::ROOT, Share::new(u16::try_from(number).ok()?, u16::try_from(of).ok()?)?)
            }
            _ => return None,
        };
        Some(Self { step, subtree, share })
    }
}

#[cfg(test)]
#[path = "needed_parts_tests.rs"]
mod tests;
