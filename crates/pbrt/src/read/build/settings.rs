//! Options, film, filter, sampler, integrator and accelerator: what the schema of settings
//! describes, and the few rules of the format that concern several settings.

use description::{
    AcceleratorDesc, FilmDesc, FilmKind, FilterDesc, IntegratorDesc, OptionsDesc, SamplerDesc, Span, Spanned,
    Stated,
};

use super::Builder;
use super::reader::Reader;
use crate::read::statement::{Statement, Statements};

impl Builder<'_> {
    /// All `Option` statements, read as the parameters of one.
    pub(super) fn options(&mut self, statements: &mut Statements) -> Stated<OptionsDesc> {
        let parameters = std::mem::take(&mut statements.options);
        let span = parameters.first().map_or(Span::NONE, |first| first.span);
        let kind = Spanned::new("Option".to_owned(), span);
        let statement = Statement {
            span,
            kind,
            parameters,
            defaults: Default::default(),
            color_space: Default::default(),
        };
        self.read_or_default(statement, |reader| {
            let mut options = OptionsDesc::default();
            reader.settings(&mut options);
            Some(options)
        })
    }

    pub(super) fn film(&mut self, statement: Statement) -> Stated<FilmDesc> {
        self.read_or_default(statement, film)
    }

    pub(super) fn filter(&mut self, statement: Statement) -> Stated<FilterDesc> {
        self.read_or_default(statement, |reader| reader.member("filter", "pixel filter"))
    }

    pub(super) fn sampler(&mut self, statement: Statement) -> Stated<SamplerDesc> {
        self.read_or_default(statement, |reader| reader.member("sampler", "sampler"))
    }

    pub(super) fn integrator(&mut self, statement: Statement) -> Stated<IntegratorDesc> {
        self.read_or_default(statement, |reader| reader.member("integrator", "integrator"))
    }

    pub(super) fn accelerator(&mut self, statement: Statement) -> Stated<AcceleratorDesc> {
        self.read_or_default(statement, |reader| reader.member("accelerator", "accelerator"))
    }
}

fn film(reader: &mut Reader) -> Option<FilmDesc> {
    let mut film: FilmDesc = reader.member("film", "film")?;
    film.color_space = reader.color_space;
    film.layers = reader.strings("layers").unwrap_or_default();
    if let FilmKind::Spectral { lambda_min, lambda_max, .. } = film.kind
        && lambda_min >= lambda_max
    {
        reader.refuse("lambdamax", "`lambdamax` must be above `lambdamin`");
    }
    if let Some([x0, x1, y0, y1]) = &mut film.crop_window {
        [*x0, *x1] = [x0.min(*x1), x0.max(*x1)];
        [*y0, *y1] = [y0.min(*y1), y0.max(*y1)];
    }
    if film.pixel_bounds.is_some() && film.crop_window.is_some() {
        reader.ignored("pixelbounds", "`pixelbounds` has no effect beside `cropwindow`");
    }
    let [width, height] = film.resolution;
    if let Some([x0, x1, y0, y1]) = film.pixel_bounds
        && (x0.max(0) >= x1.min(width) || y0.max(0) >= y1.min(height))
    {
        reader.refuse("pixelbounds", "`pixelbounds` (x0, x1, y0, y1) contains no pixel of the image");
    }
    if let Some([x0, x1, y0, y1]) = film.crop_window
        && (x0.max(0.0) >= x1.min(1.0) || y0.max(0.0) >= y1.min(1.0))
    {
        reader.refuse("cropwindow", "`cropwindow` (x0, x1, y0, y1) contains no part of the image");
    }
    Some(film)
}
