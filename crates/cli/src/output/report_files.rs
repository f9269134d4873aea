//! Files that a command writes beside its answer: a picture and lists.

use std::path::Path;

use super::{Complete, Existing, Output};
use crate::{failure::Failure, names::CHART};

/// The files that are wanted, begun but not written.
pub(crate) struct ReportFiles<const LISTS: usize> {
    /// The one of `--svg`.
    svg: Option<Output>,
    /// The files of the options for lists.
    lists: [Option<Output>; LISTS],
}

impl<const LISTS: usize> ReportFiles<LISTS> {
    /// Looks at all places before any work is done. Lists come with their options; `inputs` are what the command reads.
    pub(crate) fn begin<'a>(
        svg: Option<&'a Path>,
        lists: [(&str, Option<&'a Path>); LISTS],
        inputs: &[&'a Path],
        existing: Existing,
    ) -> Result<Self, Failure> {
        let named = [("--svg", svg)].into_iter().chain(lists);
        for (number, (option, place)) in named.clone().enumerate() {
            let mut before = named.clone().take(number);
            if let Some((other, _)) = before.find(|&(_, other)| place.is_some() && place == other) {
                let reason = format!("{other} and {option} name one file; give each its own");
                return Err(Failure::unusable(reason));
            }
        }
        let lists = lists.map(|(_, list)| list);
        let begin = |path: &'a Path| {
            let targets = svg.into_iter().chain(lists.into_iter().flatten());
            let targets = targets.filter(|&target| target != path);
            let others: Vec<&Path> = inputs.iter().copied().chain(targets).collect();
            Output::create(path, existing, &others)
        };
        let mut files = Self { svg: svg.map(begin).transpose()?, lists: [const { None }; LISTS] };
        for (file, list) in files.lists.iter_mut().zip(lists) {
            *file = list.map(begin).transpose()?;
        }
        // What is no file at all is told first.
        svg.map_or(Ok(()), |path| CHART.refuse_others(path))?;
        Ok(files)
    }

    /// Writes all, and puts them in their places once all are complete: an end before that leaves none. `make_svg` gives the picture; `fill_list`
    /// writes the list of a number.
    pub(crate) fn write(
        self,
        mut fill_list: impl FnMut(usize, Output) -> Result<Complete, Failure>,
        make_svg: impl FnOnce() -> Result<String, Failure>,
    ) -> Result<(), Failure> {
        let mut written = Vec::new();
        for (number, list) in self.lists.into_iter().enumerate() {
            written.extend(list.map(|output| fill_list(number, output)).transpose()?);
        }
        let svg = self.svg.map(|output| output.fill(make_svg()?.as_bytes())).transpose()?;
        written.into_iter().chain(svg).try_for_each(Complete::place)
    }
}
