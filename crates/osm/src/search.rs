//! A search in a list of ids for others that mostly ascend.

/// Looks up ids that mostly ascend: the search starts at the last id found and proceeds in doubling
/// steps.
pub(crate) struct IdSearch<'a> {
    ids: &'a [i64],
    at: usize,
}

impl<'a> IdSearch<'a> {
    /// Creates a search in `ids`, which ascend without duplicates.
    pub(crate) fn new(ids: &'a [i64]) -> Self {
        Self { ids, at: 0 }
    }

    /// Returns the index of an id.
    #[inline]
    pub(crate) fn find(&mut self, id: i64) -> Option<usize> {
        // Mostly it is the next id, or one between the two.
        if let [last, next, ..] = self.ids[self.at..]
            && (last..=next).contains(&id)
        {
            self.at += usize::from(id == next);
            return (id == last || id == next).then_some(self.at);
        }
        self.find_farther(id)
    }

    fn find_farther(&mut self, id: i64) -> Option<usize> {
        let rest = &self.ids[self.at..];
        let (mut low, mut step) = (0, 1);
        if rest.first().is_none_or(|&first| id < first) {
            // The id is before the last one found, or after the end: search the whole list.
            let found = self.ids.binary_search(&id);
            self.at = found.unwrap_or_else(|before| before).min(self.ids.len().saturating_sub(1));
            return found.ok();
        }
        while rest.get(low + step).is_some_and(|&next| next <= id) {
            low += step;
            step *= 2;
        }
        let high = (low + step).min(rest.len());
        let found = rest[low..high].binary_search(&id);
        self.at += low + found.unwrap_or_else(|before| before.saturating_sub(1));
        found.ok().map(|_| self.at)
    }
}

#[cfg(test)]
#[path = "search_tests.rs"]
mod tests;
