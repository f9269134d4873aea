//! The order in which layers are drawn above each other.

use crate::LayerTable;

/// The largest number of layers of a package.
pub const MAX_LAYERS: usize = 64;

/// The reason why layers cannot be used together.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum LayerStackError {
    #[error("a package has at most {MAX_LAYERS} layers, got {layers}")]
    TooMany { layers: usize },
    #[error("two layers are called {id:?}; rename one of them")]
    DuplicateId { id: String },
    #[error("the `above` entries of layers form a cycle: {}", ids.join(" above "))]
    Cycle { ids: Vec<String> },
}

/// Returns the indices of layers from the lowest to the highest: each after those that it names in
/// `above`, as far as they are there; otherwise in the order of the list.
///
/// # Errors
/// When there are too many layers, two have one id, or their `above` entries form a cycle.
pub fn stacked_layers(layers: &[LayerTable]) -> Result<Vec<usize>, LayerStackError> {
    if layers.len() > MAX_LAYERS {
        return Err(LayerStackError::TooMany { layers: layers.len() });
    }
    for (index, layer) in layers.iter().enumerate() {
        if layers[..index].iter().any(|other| other.id() == layer.id()) {
            return Err(LayerStackError::DuplicateId { id: layer.id().to_owned() });
        }
    }
    let mut stacked: Vec<usize> = Vec::with_capacity(layers.len());
    let below = |index: usize| {
        let above = layers[index].form().above.iter();
        above.filter_map(|id| layers.iter().position(|layer| layer.id() == id))
    };
    while stacked.len() < layers.len() {
        let is_next = |index: &usize| {
            !stacked.contains(index) && below(*index).all(|other| stacked.contains(&other))
        };
        match (0..layers.len()).find(is_next) {
            Some(index) => stacked.push(index),
            None => return Err(cycle(layers, &stacked, below)),
        }
    }
    Ok(stacked)
}

/// Follows layers that are not stacked to those below them, until one occurs again.
fn cycle<I: Iterator<Item = usize>>(
    layers: &[LayerTable],
    stacked: &[usize],
    below: impl Fn(usize) -> I,
) -> LayerStackError {
    let mut walk: Vec<usize> = Vec::new();
    let mut next = (0..layers.len()).find(|index| !stacked.contains(index));
    while let Some(index) = next {
        if let Some(start) = walk.iter().position(|&before| before == index) {
            walk.drain(..start);
            walk.push(index);
            break;
        }
        walk.push(index);
        next = below(index).find(|other| !stacked.contains(other));
    }
    LayerStackError::Cycle { ids: walk.into_iter().map(|at| layers[at].id().to_owned()).collect() }
}

#[cfg(test)]
#[path = "layer_stack_tests.rs"]
mod tests;
