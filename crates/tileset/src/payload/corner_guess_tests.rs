//! The bounded search for a corner finds the same vertex as a search through all vertices.

use proptest::prelude::*;

use super::*;

proptest! {
    /// The bounded search finds the same vertex as a search through all allowed vertices, also in
    /// the first and the last rows and columns.
    #[test]
    fn agrees_with_trying_all(
        set in prop::collection::btree_set((0..30_u16, 0..30_u16), 3..60), a in any::<prop::sample::Index>(),
        b in any::<prop::sample::Index>(), first in prop::sample::select(vec![0, TILE_NODES as u16 - 30]), divisor in 1..5_usize,
    ) {
        let at: Vec<[u16; 2]> = set.iter().map(|&(row, column)| [first + column, first + row]).collect();
        // All vertices are allowed if the divisor is 1.
        let allowed = |c: usize| c.is_multiple_of(divisor);
        let work = StepBudget::new(u64::MAX);
        let nodes = GridVertices::new(at.iter().copied(), &work);
        let (a, b) = (a.index(at.len()), b.index(at.len()));
        prop_assume!(a != b);
        let xy = |k: usize| [f64::from(at[k][0]), -f64::from(at[k][1])];
        let angle = |c: usize| {
            let ([ax, ay], [bx, by], [cx, cy]) = (xy(a), xy(b), xy(c));
            let cross = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
            let dot = (ax - cx) * (bx - cx) + (ay - cy) * (by - cy);
            (cross > 0.0 && allowed(c)).then(|| dot / cross)
        };
        let expected = (0..at.len())
            .filter_map(|c| angle(c).map(|cot| (cot, c as u32)))
            .min_by(|p, q| p.partial_cmp(q).unwrap());
        let tied = expected.is_some_and(|(best, _)| {
            (0..at.len()).filter(|&c| angle(c).is_some_and(|cot| (cot - best).abs() < 1e-12)).count() > 1
        });
        let found = nodes.best_corner([a as u32, b as u32], |c| allowed(c as usize));
        prop_assert_eq!(found.map(|corner| corner.vertex), expected.map(|(_, c)| c));
        prop_assert_eq!(found.is_some_and(|corner| corner.is_tied), tied);
    }
}
