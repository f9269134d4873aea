//! Which parts a step can read from, by their names: others need not be opened, and so many parts do not make each of them slow.

use corniche_geom::TileId;
use corniche_ground::heights::near::is_near;
use corniche_osm::Share;

use super::step::Step;

/// Whether the part with this name, without its digest, can hold what the step reads, or what it would make. If the name is none that
/// [`part_name`] makes, it can.
pub(crate) fn is_needed(step: Step, scope: TileId, share: Share, name: &str) -> bool {
    let Some(part) = PartName::parse(name) else { return true };
    match (step, part.step) {
        (Step::Hashes, Step::Hashes)
        | (Step::Ways | Step::Nodes, Step::Roads)
        | (Step::Roads, Step::Roads | Step::Ways | Step::Nodes)
        | (Step::Top, Step::Heights | Step::Top)
        | (Step::Tiles, Step::Roads | Step::Top) => true,
        (Step::Ways, Step::Ways) | (Step::Nodes, Step::Nodes) => part.share == share,
        (Step::Nodes, Step::Ways) => part.share.of() == share.of(),
        // What lies beneath the subtree or around it; what one subtree has of the other is not made again.
        (Step::Tiles, Step::Heights) => is_near(scope, part.subtree),
        (Step::Heights, Step::Heights) | (Step::Tiles, Step::Tiles) => meet(scope, part.subtree),
        _ => false,
    }
}

/// Whether the name can be of a part that a merge reads from.
pub(crate) fn is_merged(name: &str) -> bool {
    PartName::parse(name).is_none_or(|part| !part.step.has_shares())
}

/// Whether the name can be of a part with roads.
pub(crate) fn has_roads(name: &str) -> bool {
    PartName::parse(name).is_none_or(|part| part.step == Step::Roads)
}

/// The name of a part.
pub(crate) fn part_name(step: Step, scope: TileId, share: Share) -> String {
    let name = step.name();
    if step.has_subtrees() {
        format!("{name}-{}-{}-{}", scope.z(), scope.x(), scope.y())
    } else if step.has_shares() {
        format!("{name}-{}-{}", share.number(), share.of())
    } else {
        name.to_owned()
    }
}

/// Whether one of two tiles is the other or lies above it.
fn meet(a: TileId, b: TileId) -> bool {
    let level = a.z().min(b.z());
    a.ancestor(level) == b.ancestor(level)
}

/// What a part's name says.
struct PartName {
    step: Step,
    subtree: TileId,
    share: Share,
}

impl PartName {
    /// `None` for a name that [`part_name`] does not make.
    fn parse(name: &str) -> Option<Self> {
        let mut words = name.split('-');
        let step = words.next()?;
        let step = Step::ALL.into_iter().find(|known| known.name() == step)?;
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
