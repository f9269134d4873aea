//! The tiles on which the tiles of a subtree depend.

use corniche_geom::TileId;

/// Whether a tile is in a subtree or above it, or touches a tile of its own level that is.
#[must_use]
pub fn is_near(scope: TileId, id: TileId) -> bool {
    let near = |at: u32, first: u32, last: u32| {
        (i64::from(first) - 1..=i64::from(last) + 1).contains(&i64::from(at))
    };
    if id.z() <= scope.z() {
        let above = scope.ancestor(id.z());
        return near(id.x(), above.x(), above.x()) && near(id.y(), above.y(), above.y());
    }
    let down = id.z() - scope.z();
    let ends = |at: u32| {
        let end = ((u64::from(at) + 1) << down) - 1;
        (at << down, u32::try_from(end).unwrap_or(u32::MAX))
    };
    let ((west, east), (north, south)) = (ends(scope.x()), ends(scope.y()));
    near(id.x(), west, east) && near(id.y(), north, south)
}

#[cfg(test)]
#[path = "near_tests.rs"]
mod tests;
