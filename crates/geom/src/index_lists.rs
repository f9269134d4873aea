//! Many lists of indices in two flat arrays, such as the triangles of each cell of a grid.

/// Lists of indices, one list per place: for example triangles by the cells of a grid, or
/// half-edges by their vertex.
///
/// ```text
///  starts   0   2   2   5 …     one more than there are places
///           │       │   │
///  indices  7 9     1 7 8 …     the list of each place, ascending
/// ```
///
/// The two flat arrays take 4 bytes per place and per entry, and are allocated once, with their
/// final lengths: entries are counted first, then filled in.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct IndexLists {
    /// The list of place p is `indices[starts[p]..starts[p + 1]]`.
    starts: Vec<u32>,
    indices: Vec<u32>,
}

impl IndexLists {
    /// Creates lists for `places` places. Items are numbered from 0; item k is added to the list of
    /// each of `places_of(k)`, which is called twice and must return the same places both times,
    /// all below `places`.
    #[must_use]
    pub fn new<P: Iterator<Item = usize>>(
        places: usize,
        items: usize,
        places_of: impl Fn(usize) -> P,
    ) -> Self {
        let mut starts = vec![0_u32; places + 1];
        for place in (0..items).flat_map(&places_of) {
            starts[place + 1] += 1;
        }
        for place in 0..places {
            starts[place + 1] += starts[place];
        }
        let mut next = starts.clone();
        let mut indices = vec![0; starts[places] as usize];
        for item in 0..items {
            for place in places_of(item) {
                indices[next[place] as usize] = item as u32;
                next[place] += 1;
            }
        }
        Self { starts, indices }
    }

    /// Creates lists from parts that [`IndexLists::parts`] returned; `None` if the parts are
    /// invalid.
    #[must_use]
    pub fn of_parts(starts: Vec<u32>, indices: Vec<u32>) -> Option<Self> {
        let ends = [starts.first()?, starts.last()?].map(|at| *at as usize);
        (ends == [0, indices.len()] && starts.is_sorted()).then_some(Self { starts, indices })
    }

    /// The start of the list of each place, and the end of the last list; and all lists one after
    /// another.
    #[must_use]
    pub fn parts(&self) -> [&[u32]; 2] {
        [&self.starts, &self.indices]
    }

    /// The list of a place, in ascending order.
    #[inline]
    #[must_use]
    pub fn list(&self, place: usize) -> &[u32] {
        &self.indices[self.starts[place] as usize..self.starts[place + 1] as usize]
    }

    /// The number of entries of all lists together.
    #[must_use]
    pub fn len(&self) -> usize {
        self.indices.len()
    }

    /// Whether all lists are empty.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.indices.is_empty()
    }
}

impl Default for IndexLists {
    /// Returns lists for no places.
    fn default() -> Self {
        Self { starts: vec![0], indices: Vec::new() }
    }
}

#[cfg(test)]
#[path = "index_lists_tests.rs"]
mod tests;
