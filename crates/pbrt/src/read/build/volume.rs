//! Grids of NanoVDB files.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use description::{Diagnostic, Spanned, VoxelsDesc};

use super::Builder;
use assets::Volumes;
use description::closest;

/// The grids that were read, by file and name; `None` for those that the file has not got.
pub(super) type Grids = HashMap<(PathBuf, String), Option<VoxelsDesc>>;

/// The name of a grid, and whether it is an error if the file has not got it.
pub(super) struct GridName {
    pub(super) name: Spanned<String>,
    pub(super) is_needed: bool,
}

impl Builder<'_> {
    /// Grids of a file, which is read once, as far as the file has them. Nothing if an error is
    /// reported.
    pub(super) fn grids<const N: usize>(
        &mut self,
        file: &Spanned<String>,
        names: &[GridName; N],
    ) -> Option<[Option<VoxelsDesc>; N]> {
        let path = self.path(file);
        let found = names.each_ref().map(|grid| {
            let found = self.grids.get(&(path.clone(), grid.name.value.clone()))?;
            (found.is_some() || !grid.is_needed).then(|| found.clone())
        });
        if found.iter().all(Option::is_some) {
            return Some(found.map(Option::flatten));
        }
        match self.read_grids(&path, file, names) {
            Ok(grids) => {
                for (name, grid) in names.iter().zip(&grids) {
                    self.grids.insert((path.clone(), name.name.value.clone()), grid.clone());
                }
                grids.try_into().ok()
            }
            Err(diagnostic) => {
                self.report.push(diagnostic);
                None
            }
        }
    }

    fn read_grids(
        &self,
        path: &Path,
        file: &Spanned<String>,
        names: &[GridName],
    ) -> Result<Vec<Option<VoxelsDesc>>, Diagnostic> {
        let unreadable = |message: String| {
            let message = format!("cannot read the volume `{}`: {message}", path.display());
            Diagnostic::error("unreadable-volume", message, file.span)
        };
        let bytes = self.assets.read(path).map_err(|error| unreadable(error.to_string()))?;
        let volumes = Volumes::open(&bytes).map_err(unreadable)?;
        let read = |GridName { name, is_needed }: &GridName| match volumes.read(&name.value) {
            None if *is_needed => Err(missing_grid(&volumes, file, name)),
            None => Ok(None),
            Some(Ok(grid)) => Ok(Some(grid)),
            Some(Err(message)) => Err(unreadable(format!("grid `{}`: {message}", name.value))),
        };
        names.iter().map(read).collect()
    }
}

fn missing_grid(volumes: &Volumes, file: &Spanned<String>, name: &Spanned<String>) -> Diagnostic {
    /// The most names that are listed.
    const MOST: usize = 24;
    let mut names: Vec<_> = volumes.names().take(MOST).map(|name| format!("`{name}`")).collect();
    if volumes.names().count() > MOST {
        names.push("and others".into());
    }
    let names = if names.is_empty() { "no grids".into() } else { names.join(", ") };
    let message = format!("there is no grid `{}` in `{}`, which has {names}", name.value, file.value);
    let help = closest(&name.value, volumes.names()).map(|near| format!("did you mean `{near}`?"));
    Diagnostic { help, ..Diagnostic::error("unknown-grid", message, name.span) }
}
