//! Files that a command writes beside its answer: a picture and a list.

use std::path::Path;

use super::{Complete, Existing, Output};
use crate::{failure::Failure, names::Format};

/// The files that are wanted, begun but not written.
pub(crate) struct ReportFiles {
    /// The one of `--svg`.
    svg: Option<Output>,
    /// The one of the option for a list.
    list: Option<Output>,
}

impl ReportFiles {
    /// Looks at both places before any work is done. `list` comes with its option; `inputs` are what the command reads.
    pub(crate) fn begin<'a>(
        svg: Option<&'a Path>,
        (option, list): (&str, Option<&'a Path>),
        inputs: &[&'a Path],
        existing: Existing,
    ) -> Result<Self, Failure> {
        if svg.is_some() && svg == list {
            let reason = format!("--svg and {option} name one file; give each its own");
            return Err(Failure::unusable(reason));
        }
        let begin = |path: &'a Path| {
            let targets = svg.into_iter().chain(list).filter(|&target| target != path);
            let others: Vec<&Path> = inputs.iter().copied().chain(targets).collect();
            Output::create(path, existing, &others)
        };
        let files = Self { svg: svg.map(begin).transpose()?, list: list.map(begin).transpose()? };
        // What is no file at all is told first.
        svg.map_or(Ok(()), |path| Format::Chart.refuse_others(path))?;
        Ok(files)
    }

    /// Writes both, and puts them in their places once both are complete: an end before that leaves neither. `make_svg` gives the picture; `fill_list`
    /// writes the list.
    pub(crate) fn write(
        self,
        fill_list: impl FnOnce(Output) -> Result<Complete, Failure>,
        make_svg: impl FnOnce() -> Result<String, Failure>,
    ) -> Result<(), Failure> {
        let list = self.list.map(fill_list).transpose()?;
        let svg = self.svg.map(|output| output.fill(make_svg()?.as_bytes())).transpose()?;
        list.into_iter().chain(svg).try_for_each(Complete::place)
    }
}
