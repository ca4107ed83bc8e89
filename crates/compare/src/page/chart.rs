//! Curves over time as SVG, on logarithmic axes.

use std::ops::RangeInclusive;

use super::figure::{escape, figure};
use super::write_to;

const WIDTH: f64 = 900.0;
const HEIGHT: f64 = 400.0;
const LEFT: f64 = 66.0;
const RIGHT: f64 = 680.0;
const TOP: f64 = 14.0;
const BOTTOM: f64 = 352.0;

/// The least distance between labels.
const LABEL_HEIGHT: f64 = 15.0;

/// The line style of a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    Line,
    Dashes,
}

/// One curve.
pub struct Series {
    pub label: String,
    /// The number of its colour in the style sheet.
    pub color: usize,
    pub shape: Shape,
    /// Seconds and values; those without a logarithm are left out.
    pub points: Vec<(f64, f64)>,
}

/// Curves over seconds.
pub struct Chart<'a> {
    pub title: &'a str,
    /// The quantity of the values.
    pub y: &'a str,
    pub series: Vec<Series>,
    /// The slope of a guide line.
    pub slope: Option<f64>,
    /// A horizontal line: its value and name.
    pub floor: Option<(f64, &'a str)>,
}

/// A logarithmic axis: maps values to positions on the page.
struct Axis {
    logs: RangeInclusive<f64>,
    places: [f64; 2],
}

impl Axis {
    /// Covers all these values, with a margin.
    fn new(values: impl Iterator<Item = f64>, places: [f64; 2]) -> Self {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        values.map(f64::log10).for_each(|log| (low, high) = (low.min(log), high.max(log)));
        let middle = (low + high) / 2.0;
        let half = ((high - low) / 2.0 * 1.06).max(0.25);
        Self { logs: middle - half..=middle + half, places }
    }

    fn place(&self, value: f64) -> f64 {
        let (low, high) = (self.logs.start(), self.logs.end());
        let share = (value.log10() - low) / (high - low);
        self.places[0] + share * (self.places[1] - self.places[0])
    }

    fn holds(&self, value: f64) -> bool {
        self.logs.contains(&value.log10())
    }

    /// Powers of ten, and where these are few, also 2 and 5 times them.
    fn ticks(&self) -> Vec<f64> {
        let steps: &[f64] = if self.logs.end() - self.logs.start() > 2.5 { &[1.0] } else { &[1.0, 2.0, 5.0] };
        let decades = self.logs.start().floor() as i32..=self.logs.end().floor() as i32;
        let ticks = decades.flat_map(|decade| steps.iter().map(move |step| step * 10f64.powi(decade)));
        ticks.filter(|&tick| self.holds(tick)).collect()
    }
}

impl Chart<'_> {
    /// The chart as an SVG element.
    pub fn to_svg(&self) -> String {
        let drawn = |series: &Series| -> Vec<(f64, f64)> {
            let points = series.points.iter().copied();
            points.filter(|&(seconds, value)| seconds > 0.0 && value > 0.0 && value.is_finite()).collect()
        };
        let curves: Vec<(&Series, Vec<(f64, f64)>)> =
            self.series.iter().map(|series| (series, drawn(series))).collect();
        let all = || curves.iter().flat_map(|(_, points)| points);
        if all().next().is_none() {
            return "<p class=\"note\">No data.</p>\n".into();
        }
        let x = Axis::new(all().map(|point| point.0), [LEFT, RIGHT]);
        let y = Axis::new(all().map(|point| point.1), [BOTTOM, TOP]);

        let mut svg = format!(
            "<svg viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" aria-label=\"{}\">\n",
            escape(&format!("{}: {} over seconds, both logarithmic", self.title, self.y))
        );
        self.grid(&mut svg, &x, &y);
        if let Some(slope) = self.slope {
            guide(&mut svg, slope, &x, &y);
        }
        if let Some((floor, name)) = self.floor.filter(|&(floor, _)| floor > 0.0 && y.holds(floor)) {
            let place = y.place(floor);
            write_to(
                &mut svg,
                format_args!(
                    "<path class=\"floor\" d=\"M{LEFT} {place:.1}H{RIGHT}\"/><text x=\"{}\" y=\"{:.1}\">{name}</text>\n",
                    LEFT + 6.0,
                    place - 5.0
                ),
            );
        }
        for (series, points) in &curves {
            curve(&mut svg, series, points, &x, &y);
        }
        labels(&mut svg, &curves, &y);
        svg + "</svg>\n"
    }

    fn grid(&self, svg: &mut String, x: &Axis, y: &Axis) {
        for tick in x.ticks() {
            let place = x.place(tick);
            write_to(
                svg,
                format_args!(
                    "<path class=\"grid\" d=\"M{place:.1} {TOP}V{BOTTOM}\"/><text class=\"middle\" x=\"{place:.1}\" y=\"{}\">{}</text>\n",
                    BOTTOM + 18.0,
                    tick_label(tick)
                ),
            );
        }
        for tick in y.ticks() {
            let place = y.place(tick);
            write_to(
                svg,
                format_args!(
                    "<path class=\"grid\" d=\"M{LEFT} {place:.1}H{RIGHT}\"/><text class=\"end\" x=\"{}\" y=\"{:.1}\">{}</text>\n",
                    LEFT - 8.0,
                    place + 4.0,
                    tick_label(tick)
                ),
            );
        }
        write_to(
            svg,
            format_args!(
                "<text class=\"middle\" x=\"{}\" y=\"{}\">seconds</text><text class=\"middle\" transform=\"translate(14 {}) rotate(-90)\">{}</text>\n",
                (LEFT + RIGHT) / 2.0,
                BOTTOM + 38.0,
                (TOP + BOTTOM) / 2.0,
                escape(self.y)
            ),
        );
    }
}

/// `0.01`, `5`, `10⁻⁶`.
fn tick_label(tick: f64) -> String {
    if (1e-3..1e4).contains(&tick) {
        return format!("{}", (tick * 1e6).round() / 1e6);
    }
    let exponent = tick.log10().floor();
    let step = (tick / 10f64.powf(exponent)).round();
    let exponent = exponent.to_string();
    let digits = exponent.chars().map(|digit| match digit {
        '-' => '⁻',
        digit => ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][digit.to_digit(10).unwrap_or(0) as usize],
    });
    let factor = if step == 1.0 { String::new() } else { format!("{step}·") };
    format!("{factor}10{}", digits.collect::<String>())
}

/// A straight line of this slope through the centre of the chart, clipped to it.
fn guide(svg: &mut String, slope: f64, x: &Axis, y: &Axis) {
    let middle = |axis: &Axis| (axis.logs.start() + axis.logs.end()) / 2.0;
    let (mx, my) = (middle(x), middle(y));
    let half_width = (x.logs.end() - x.logs.start()) / 2.0;
    let half_height = (y.logs.end() - y.logs.start()) / 2.0;
    let reach = half_width.min(half_height / slope.abs().max(1e-6));
    let [from, to] =
        [-reach, reach].map(|d| (x.place(10f64.powf(mx + d)), y.place(10f64.powf(my + slope * d))));
    write_to(
        svg,
        format_args!(
            "<path class=\"guide\" d=\"M{:.1} {:.1}L{:.1} {:.1}\"/><text x=\"{:.1}\" y=\"{:.1}\">slope −{}</text>\n",
            from.0,
            from.1,
            to.0,
            to.1,
            from.0 + 14.0,
            from.1 - 4.0,
            -slope
        ),
    );
}

fn curve(svg: &mut String, series: &Series, points: &[(f64, f64)], x: &Axis, y: &Axis) {
    if points.is_empty() {
        return;
    }
    let dashes = if series.shape == Shape::Dashes { " dashes" } else { "" };
    let path: Vec<String> =
        points.iter().map(|&(s, v)| format!("{:.1} {:.1}", x.place(s), y.place(v))).collect();
    write_to(
        svg,
        format_args!(
            "<g style=\"color:var(--run{})\"><path class=\"curve{dashes}\" d=\"M{}\"/>",
            series.color,
            path.join("L")
        ),
    );
    for &(seconds, value) in points {
        write_to(
            svg,
            format_args!(
                "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"3\"><title>{}: {} after {} s</title></circle>",
                x.place(seconds),
                y.place(value),
                escape(&series.label),
                figure(value),
                figure(seconds)
            ),
        );
    }
    svg.push_str("</g>\n");
}

/// The names of curves beside their ends, moved apart where they would overlap.
fn labels(svg: &mut String, curves: &[(&Series, Vec<(f64, f64)>)], y: &Axis) {
    let ends = curves.iter().filter_map(|(series, points)| Some((y.place(points.last()?.1) + 4.0, *series)));
    let mut ends: Vec<(f64, &Series)> = ends.collect();
    ends.sort_by(|a, b| a.0.total_cmp(&b.0));
    for index in 1..ends.len() {
        ends[index].0 = ends[index].0.max(ends[index - 1].0 + LABEL_HEIGHT);
    }
    let overhang = ends.last().map_or(0.0, |last| (last.0 - BOTTOM).max(0.0));
    for (place, series) in ends {
        write_to(
            svg,
            format_args!(
                "<text class=\"name\" x=\"{}\" y=\"{:.1}\" style=\"fill:var(--run{})\">{}</text>\n",
                RIGHT + 8.0,
                place - overhang,
                series.color,
                escape(&series.label)
            ),
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_few_and_round() {
        let axis = |low: f64, high: f64| Axis::new([low, high].into_iter(), [0.0, 100.0]);
        assert_eq!(axis(0.5, 600.0).ticks(), [1.0, 10.0, 100.0]);
        assert_eq!(axis(1.0, 9.0).ticks(), [1.0, 2.0, 5.0]);
        assert!(axis(3.0, 3.0).ticks().len() >= 2, "an axis of one value has ticks");
        let labels = [0.01, 5.0, 2000.0, 1e-6, 5e-12, 1e5].map(tick_label);
        assert_eq!(labels, ["0.01", "5", "2000", "10⁻⁶", "5·10⁻¹²", "10⁵"]);
    }

    #[test]
    fn curves_are_inside_and_labels_do_not_overlap() {
        let series = |label: &str, value: f64| Series {
            label: label.into(),
            color: 0,
            shape: Shape::Line,
            points: vec![(1.0, value), (10.0, 0.1 * value), (20.0, 0.0)],
        };
        let chart = Chart {
            title: "a & b",
            y: "error",
            series: vec![series("one", 1.0), series("two", 1.01)],
            slope: Some(-1.0),
            floor: Some((0.5, "floor")),
        };
        let svg = chart.to_svg();
        let places = |attribute: &str| -> Vec<f64> {
            svg.split(attribute)
                .skip(1)
                .map(|rest| rest.split('"').next().unwrap().parse().unwrap())
                .collect()
        };
        assert_eq!(places(" cx=\"").len(), 4, "values without a logarithm are left out");
        assert!(places(" cx=\"").iter().all(|x| (LEFT..=RIGHT).contains(x)));
        assert!(places(" cy=\"").iter().all(|y| (TOP..=BOTTOM).contains(y)));
        let names: Vec<f64> = svg
            .lines()
            .filter_map(|line| line.strip_prefix("<text class=\"name\""))
            .map(|rest| rest.split("y=\"").nth(1).unwrap().split('"').next().unwrap().parse().unwrap())
            .collect();
        assert!(names.len() == 2 && names[1] - names[0] >= LABEL_HEIGHT - 0.1, "{names:?}");
        assert!(svg.contains("a &amp; b") && svg.contains("floor") && svg.contains("slope −1"));
        assert!(Chart { series: Vec::new(), ..chart }.to_svg().contains("No data"));
    }
}
