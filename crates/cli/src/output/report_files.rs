//! Files that a command writes in addition to its result: a chart and tables.

use std::path::Path;

use super::{Complete, Existing, Output};
use crate::{
    failure::{CommandFailure, Result},
    names::CHART,
};

/// The requested files, begun but not written.
pub(crate) struct ReportFiles<const LISTS: usize> {
    /// The file of `--svg`.
    svg: Option<Output>,
    /// The files of the options for tables.
    lists: [Option<Output>; LISTS],
}

impl<const LISTS: usize> ReportFiles<LISTS> {
    /// Checks all targets before any work is done. Tables come with their options; `inputs` are the
    /// files that the command reads.
    pub(crate) fn begin<'a>(
        svg: Option<&'a Path>,
        lists: [(&str, Option<&'a Path>); LISTS],
        inputs: &[&'a Path],
        existing: Existing,
    ) -> Result<Self> {
        let named = [("--svg", svg)].into_iter().chain(lists);
        for (number, (option, place)) in named.clone().enumerate() {
            let mut before = named.clone().take(number);
            if let Some((other, _)) = before.find(|&(_, other)| place.is_some() && place == other) {
                let reason = format!("{other} and {option} name the same file; use two files");
                return Err(CommandFailure::unusable(reason));
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
        // Names that are not files are reported first.
        svg.map_or(Ok(()), |path| CHART.refuse_others(path))?;
        Ok(files)
    }

    /// Writes all files, and moves them to their targets when all are complete: after an early end
    /// there are none. `make_svg` draws the chart; `fill_list` writes the table with an index.
    pub(crate) fn write(
        self,
        mut fill_list: impl FnMut(usize, Output) -> Result<Complete>,
        make_svg: impl FnOnce() -> Result<String>,
    ) -> Result<()> {
        let mut written = Vec::new();
        for (number, list) in self.lists.into_iter().enumerate() {
            written.extend(list.map(|output| fill_list(number, output)).transpose()?);
        }
        let svg = self.svg.map(|output| output.fill(make_svg()?.as_bytes())).transpose()?;
        written.into_iter().chain(svg).try_for_each(Complete::place)
    }
}
