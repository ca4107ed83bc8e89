//! A comparison as one self-contained HTML page, with style sheet, script, charts and pictures.
//! Everything but the slider works without the script.

mod chart;
mod figure;
mod map;

use std::fmt::Write;

use alhazen::image::ImageError;

use self::chart::{Chart, Series, Shape};
use self::figure::{count, escape, figure, percent};
use self::map::Maps;
use super::{Bias, Comparison, Parts, Run, settings};

/// Number of colours for runs in the style sheet; further runs repeat them.
const COLORS: usize = 8;

impl Comparison {
    /// The page; refused where there is no memory for its pictures.
    pub fn to_html(&self) -> Result<String, ImageError> {
        let title = escape(&format!("{}: {}", self.setup.title, self.names().join(", ")));
        let maps = Maps::new(self)?;
        Ok([
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n",
            "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n",
            "<meta name=\"color-scheme\" content=\"light dark\">\n",
            &format!("<title>{title}</title>\n"),
            &format!("<style>\n{}</style>\n</head>\n<body>\n<main>\n", include_str!("style.css")),
            &self.heading(),
            &self.table(),
            VIEWER,
            &self.charts(),
            &self.gallery(&maps),
            &self.settings(),
            &format!("</main>\n<script>\n{}</script>\n</body>\n</html>\n", include_str!("script.js")),
        ]
        .concat())
    }

    fn names(&self) -> Vec<&str> {
        self.runs.iter().map(|run| run.name.as_str()).collect()
    }

    fn heading(&self) -> String {
        let setup = &self.setup;
        let [x0, x1, y0, y1] = setup.pixel_bounds;
        let mut text = format!(
            "<header>\n<h1>{}</h1>\n<p>{} × {} pixels, {} for each picture, {} thread{}. Reference: {}.</p>\n",
            escape(&setup.title),
            x1 - x0,
            y1 - y0,
            setup.budget,
            setup.threads,
            if setup.threads == 1 { "" } else { "s" },
            escape(&self.reference.source),
        );
        if self.interrupted() {
            text += "<p class=\"warning\">Interrupted: figures are of the passes done until then";
            if !self.missing.is_empty() {
                text += &format!("; not started: {}", escape(&self.missing.join(", ")));
            }
            text += ".</p>\n";
        }
        for warning in &self.warnings {
            text += &format!("<p class=\"warning\">Warning: {}.</p>\n", escape(warning));
        }
        if let Some(doubt) = self.doubt() {
            text += &format!("<p class=\"warning\">{}</p>\n", escape(&doubt));
        }
        let below: Vec<_> = self.runs.iter().filter(|run| self.is_below_reference_noise(run)).collect();
        if !below.is_empty() {
            let names: Vec<_> = below.iter().map(|run| run.name.as_str()).collect();
            text += &format!(
                "<p class=\"warning\">The reference's own variance is more than a tenth of the error of {}: \
                 use a reference with more samples.</p>\n",
                escape(&names.join(", "))
            );
        }
        text + "</header>\n"
    }

    fn table(&self) -> String {
        let best =
            self.runs.iter().map(Run::efficiency).filter(|value| value.is_finite()).fold(0.0, f64::max);
        let mut text =
            String::from("<section>\n<h2>Figures</h2>\n<div class=\"scroll\"><table>\n<thead><tr>");
        let common = format!("s to relMSE {}", figure(self.common_error()));
        for head in [
            "",
            "passes",
            "seconds",
            "relMSE",
            "FLIP",
            "noise",
            "bias",
            "mean error",
            "efficiency",
            &common,
            "slope",
            "rays",
            "rays/s",
        ] {
            text += &format!("<th scope=\"col\">{head}</th>");
        }
        text += "</tr></thead>\n<tbody>\n";
        for (index, run) in self.runs.iter().enumerate() {
            let last = run.last();
            let (parts, efficiency) = (last.measure.relative, run.efficiency());
            let surprising = last.measure.mean_error.abs() > 3.0 * last.measure.mean_error_deviation;
            let cells = [
                ("", last.passes.to_string()),
                ("", figure(last.seconds)),
                ("", figure(parts.error)),
                ("", run.flip.map_or("–".into(), figure)),
                ("", percent(parts.variance.sqrt())),
                (if parts.is_biased() { "strong" } else { "" }, bias(&parts)),
                (
                    if surprising { "strong" } else { "" },
                    self.relative_mean_error(run).map_or("–".into(), |[error, deviation]| {
                        format!("{:.2} ± {:.2} %", 100.0 * error, 100.0 * deviation)
                    }),
                ),
                (if efficiency == best { "bar strong" } else { "bar" }, figure(efficiency)),
                ("", self.seconds_to_common_error(run).map_or("–".into(), figure)),
                ("", self.slope(run).map_or("–".into(), |slope| format!("{slope:.2}"))),
                ("", count(last.rays)),
                ("", count(run.rays_per_second())),
            ];
            write_to(
                &mut text,
                format_args!("<tr><th scope=\"row\">{}{}</th>", swatch(index), escape(&run.name)),
            );
            for (class, cell) in cells {
                let share = if best > 0.0 { 100.0 * (efficiency / best).min(1.0) } else { 0.0 };
                let style = if class.starts_with("bar") {
                    format!(" style=\"--share:{share:.1}%\"")
                } else {
                    "".into()
                };
                write_to(
                    &mut text,
                    format_args!("<td class=\"{class}\"{style}>{}</td>", cell.replace('-', "−")),
                );
            }
            text += "</tr>\n";
        }
        text + "</tbody>\n</table></div>\n" + MEANING + "</section>\n"
    }

    fn charts(&self) -> String {
        let curve = |run: &Run, value: &dyn Fn(&Parts) -> Option<f64>| -> Vec<(f64, f64)> {
            let points = run.checkpoints.iter();
            points.filter_map(|point| Some((point.seconds, value(&point.measure.relative)?))).collect()
        };
        let series =
            |shape, value: &dyn Fn(&Parts) -> Option<f64>, label: &dyn Fn(&Run) -> String| -> Vec<Series> {
                let runs = self.runs.iter().enumerate();
                runs.map(|(color, run)| Series {
                    label: label(run),
                    color: color % COLORS,
                    shape,
                    points: curve(run, value),
                })
                .collect()
            };
        let with_slope = |run: &Run| match self.slope(run) {
            Some(slope) => format!("{}  {}", run.name, format!("{slope:.2}").replace('-', "−")),
            None => run.name.clone(),
        };
        let error = Chart {
            title: "Error against time",
            y: "relMSE",
            series: series(Shape::Line, &|parts| Some(parts.error), &with_slope),
            slope: Some(-1.0),
            floor: self.reference.noise.map(|noise| (noise.relative, "variance of the reference")),
        };
        let name = |run: &Run| run.name.clone();
        let biased = |parts: &Parts| parts.is_biased().then_some(parts.bias_squared);
        let mut apart = series(Shape::Line, &|parts| Some(parts.variance), &name);
        apart.extend(series(Shape::Dashes, &biased, &|run| format!("{} bias²", run.name)));
        let apart =
            Chart { title: "Noise and bias", y: "variance, bias²", series: apart, slope: None, floor: None };
        format!(
            "<section>\n<h2>{}</h2>\n<p>relMSE over rendering time. The number beside a name is the slope of its curve; \
             that of independent samples is −1.</p>\n{}</section>\n\
             <section>\n<h2>{}</h2>\n<p>The parts of the error: variance as solid lines, and squared bias as dashed lines where it is \
             significant.</p>\n{}</section>\n",
            error.title,
            error.to_svg(),
            apart.title,
            apart.to_svg()
        )
    }

    fn gallery(&self, maps: &Maps) -> String {
        let mut text = String::from("<section>\n<h2>Pictures</h2>\n<div class=\"row\">\n");
        let shown = |id: &str, name: &str, source: &str, caption: &str| {
            let name = escape(name);
            format!(
                "<figure><img id=\"{id}\" alt=\"{name}\" src=\"{source}\"><figcaption>{name}{caption}</figcaption></figure>\n"
            )
        };
        text += &shown("reference", "reference", &maps.reference, "");
        text += "</div>\n";
        let [scale, block_scale] = [maps.scale, maps.block_scale]
            .map(|scale| format!("{} %", (f64::from(scale) * 1e8).round() / 1e6));
        for (index, (run, map)) in self.runs.iter().zip(&maps.runs).enumerate() {
            let figure_of = |kind: &str, title: String, source: &str, caption: &str| {
                shown(&format!("{kind}{index}"), &title, source, caption)
            };
            write_to(
                &mut text,
                format_args!("<h3>{}{}</h3>\n<div class=\"row\">\n", swatch(index), escape(&run.name)),
            );
            text += &figure_of("picture", run.name.clone(), &map.picture, "");
            text += &figure_of("error", format!("error of {}", run.name), &map.error, &legend(&scale));
            text += &figure_of(
                "blocks",
                format!("error of {} over blocks", run.name),
                &map.blocks,
                &legend(&block_scale),
            );
            text += "</div>\n";
        }
        text + "<p class=\"note\">Error maps show (x − r) / √(r² + 0.01) at each pixel, all on one scale: blue where a picture is \
                too dark, orange where it is too bright. Over blocks of 8 × 8 pixels of both pictures noise averages out, and \
                bias remains.</p>\n</section>\n"
    }

    fn settings(&self) -> String {
        let setup = &self.setup;
        let [x0, x1, y0, y1] = setup.pixel_bounds;
        let [width, height] = setup.resolution;
        let noise = self.reference.noise.map_or("unknown".into(), |noise| {
            format!(
                "relative variance {}, standard deviation of the mean {}",
                figure(noise.relative),
                figure(noise.of_mean.sqrt())
            )
        });
        let changes = if setup.changes.is_empty() { "none".into() } else { setup.changes.join(", ") };
        let mut rows = vec![
            ("scene".into(), setup.title.clone()),
            (
                "image".into(),
                format!("{width} × {height} pixels, rendered x {x0} to {}, y {y0} to {}", x1 - 1, y1 - 1),
            ),
            ("each picture".into(), setup.budget.to_string()),
            ("seeds".into(), format!("{} and {}", setup.seed, setup.seed.wrapping_add(1))),
            ("threads".into(), setup.threads.to_string()),
            ("filter".into(), settings::text(&setup.filter)),
            ("overrides for all".into(), changes),
            ("reference".into(), self.reference.source.clone()),
            ("noise of the reference".into(), noise),
        ];
        for run in &self.runs {
            rows.push((
                run.name.clone(),
                format!("{}; sampler {}", settings::text(&run.settings), settings::text(&run.sampler)),
            ));
            rows.extend(run.notes.iter().map(|(name, note)| (format!("{}: {name}", run.name), note.clone())));
        }
        rows.push(("program".into(), concat!("alhazen ", env!("CARGO_PKG_VERSION")).into()));
        let mut text = String::from("<section>\n<h2>Settings</h2>\n<dl>\n");
        for (name, value) in rows {
            write_to(&mut text, format_args!("<dt>{}</dt><dd>{}</dd>\n", escape(&name), escape(&value)));
        }
        text + "</dl>\n</section>\n"
    }
}

/// Appends text.
fn write_to(text: &mut String, what: std::fmt::Arguments) {
    text.write_fmt(what).expect("invariant: a string can be written to");
}

/// A patch of a run's colour.
fn swatch(index: usize) -> String {
    format!("<span class=\"swatch\" style=\"background:var(--run{})\"></span>", index % COLORS)
}

/// The relative bias, or an upper bound of it.
fn bias(parts: &Parts) -> String {
    match parts.bias() {
        Bias::Significant(bias) => percent(bias),
        Bias::Below(most) => format!("&lt; {}", percent(most)),
        Bias::Hidden => "hidden by noise".into(),
    }
}

/// The colour scale of an error map.
fn legend(scale: &str) -> String {
    format!("<span class=\"legend\">−{scale}<i></i>+{scale}</span>")
}

/// The slider that compares two pictures; the script fills it and makes it visible.
const VIEWER: &str = r#"<section id="viewer" hidden>
<h2>Side by side</h2>
<div class="controls">
<label>left <select id="left"></select></label>
<label>right <select id="right"></select></label>
<label>zoom <select id="zoom"><option value="0">fit</option><option>1</option><option>2</option><option>4</option><option>8</option></select></label>
</div>
<div class="scroll"><div id="frame"><div id="stack"><img id="under" alt="the picture on the right"><img id="over" alt="the picture on the left"><div id="edge"></div></div>
<input id="slider" type="range" min="0" max="1000" value="500" aria-label="right edge of the left picture"></div></div>
</section>
"#;

const MEANING: &str = "<details>\n<summary>What the figures mean</summary>\n<dl>\n\
    <dt>seconds</dt><dd>rendering time of one picture, preparation included. Two are rendered, from different seeds; figures are means over both.</dd>\n\
    <dt>relMSE</dt><dd>mean of (x − r)² / (r² + 0.01) over pixels and channels, x being the picture and r the reference.</dd>\n\
    <dt>FLIP</dt><dd>perceived difference of the first picture, from 0 to 1.</dd>\n\
    <dt>noise</dt><dd>relative standard deviation of a picture, from the difference of the two pictures.</dd>\n\
    <dt>bias</dt><dd>root mean square of the relative error that both pictures have in common, the reference's variance subtracted; where it is not significant, an upper bound; hidden by noise where that is as large as the picture.</dd>\n\
    <dt>mean error</dt><dd>mean of x − r relative to the mean of r, with one standard deviation; positive if the picture is too bright.</dd>\n\
    <dt>efficiency</dt><dd>1 / (relMSE · seconds): without bias, the ratio of two is the ratio of times to equal relMSE.</dd>\n\
    <dt>s to relMSE</dt><dd>seconds to reach the largest final error.</dd>\n\
    <dt>slope</dt><dd>k in relMSE ∝ time^k, fitted over the last five doublings of time, the reference's variance subtracted; −1 for independent samples.</dd>\n\
    </dl>\n</details>\n";
