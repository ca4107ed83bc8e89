//! Pixel reconstruction filters: the weight of radiance around a pixel's centre in the pixel.
//!
//! A pixel's value is ∫ f(p) L(p) dp / ∫ f(p) dp, p being the position relative to its centre in
//! pixels and f zero beyond the filter's radius. It is estimated by filter importance sampling
//! [Ernst 2006]: the offset of a sample from the pixel's centre is drawn in proportion to |f|, the
//! sample has weight f/pdf, and the pixel is Σ weight·L / Σ weight. A sample thus belongs to one
//! pixel only, and neighbours are independent.
//!
//! Filters that can be sampled exactly are ([`box_filter`], [`triangle`]); the others are tabulated
//! ([`sampler`]).

pub mod box_filter;
pub mod gaussian;
pub mod mitchell;
pub mod sampler;
pub mod sinc;
pub mod triangle;

use description::FilterDesc;
use lanes::Real;
use math::Vec2;

use box_filter::BoxFilter;
use gaussian::GaussianFilter;
use mitchell::MitchellFilter;
use sampler::FilterSampler;
use sinc::LanczosSincFilter;
use triangle::TriangleFilter;

/// The largest radius in pixels: beyond it a filter no longer makes sense, and its table grows
/// without bound.
pub const MAX_RADIUS: f32 = 64.0;

/// A sample of a filter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilterSample<R = f32> {
    /// From the pixel's centre, in pixels.
    pub offset: Vec2<R>,
    /// f / pdf; negative where the filter is.
    pub weight: R,
}

/// A pixel filter.
#[derive(Clone, Debug)]
pub enum Filter {
    /// Constant.
    Box(BoxFilter),
    /// Linear to zero at the edge.
    Triangle(TriangleFilter),
    /// A Gaussian, moved down to zero at the edge.
    Gaussian(GaussianFilter, FilterSampler),
    /// Piecewise cubics.
    Mitchell(MitchellFilter, FilterSampler),
    /// A windowed sinc.
    LanczosSinc(LanczosSincFilter, FilterSampler),
}

impl Filter {
    /// The filter of a description. The error is the format's name of a parameter and what is wrong
    /// with it: radii are in (0, [`MAX_RADIUS`]].
    pub fn new(desc: &FilterDesc) -> Result<Self, (&'static str, String)> {
        let radius = |radius: &[f32; 2]| {
            for (name, radius) in ["xradius", "yradius"].into_iter().zip(*radius) {
                if !(radius > 0.0 && radius <= MAX_RADIUS) {
                    return Err((
                        name,
                        format!(
                            "a filter's radius must be above 0 and at most {MAX_RADIUS} pixels, not {radius}"
                        ),
                    ));
                }
            }
            Ok(Vec2::from_array(*radius))
        };
        let positive = |name, value: f32| {
            let allowed = value > 0.0 && value.is_finite();
            allowed
                .then_some(value)
                .ok_or_else(|| (name, format!("`{name}` is a number above 0, not {value}")))
        };
        let finite = |name, value: f32| {
            value
                .is_finite()
                .then_some(value)
                .ok_or_else(|| (name, format!("`{name}` is a finite number, not {value}")))
        };
        Ok(match desc {
            FilterDesc::Box { radius: r } => Self::Box(BoxFilter { radius: radius(r)? }),
            FilterDesc::Triangle { radius: r } => Self::Triangle(TriangleFilter { radius: radius(r)? }),
            FilterDesc::Gaussian { radius: r, sigma } => {
                let filter = GaussianFilter { radius: radius(r)?, sigma: positive("sigma", *sigma)? };
                Self::Gaussian(filter, FilterSampler::new(filter.radius, |p| filter.evaluate(p)))
            }
            FilterDesc::Mitchell { radius: r, b, c } => {
                let filter = MitchellFilter { radius: radius(r)?, b: finite("B", *b)?, c: finite("C", *c)? };
                Self::Mitchell(filter, FilterSampler::new(filter.radius, |p| filter.evaluate(p)))
            }
            FilterDesc::LanczosSinc { radius: r, tau } => {
                let filter = LanczosSincFilter { radius: radius(r)?, tau: positive("tau", *tau)? };
                Self::LanczosSinc(filter, FilterSampler::new(filter.radius, |p| filter.evaluate(p)))
            }
        })
    }

    /// Its kind and parameters as film files have them: both radii, then those that its kind has,
    /// then zeros.
    pub(crate) fn to_numbers(&self) -> (u8, [f32; 4]) {
        let Vec2 { x, y } = self.radius();
        match self {
            Self::Box(_) => (0, [x, y, 0.0, 0.0]),
            Self::Triangle(_) => (1, [x, y, 0.0, 0.0]),
            Self::Gaussian(filter, _) => (2, [x, y, filter.sigma, 0.0]),
            Self::Mitchell(filter, _) => (3, [x, y, filter.b, filter.c]),
            Self::LanczosSinc(filter, _) => (4, [x, y, filter.tau, 0.0]),
        }
    }

    /// The filter of this kind and these parameters, if there is one.
    pub(crate) fn from_numbers(kind: u8, [x, y, first, second]: [f32; 4]) -> Option<Self> {
        let radius = [x, y];
        let desc = match kind {
            0 => FilterDesc::Box { radius },
            1 => FilterDesc::Triangle { radius },
            2 => FilterDesc::Gaussian { radius, sigma: first },
            3 => FilterDesc::Mitchell { radius, b: first, c: second },
            4 => FilterDesc::LanczosSinc { radius, tau: first },
            _ => return None,
        };
        Self::new(&desc).ok()
    }

    /// Half width and half height in pixels.
    pub fn radius(&self) -> Vec2 {
        match self {
            Self::Box(filter) => filter.radius,
            Self::Triangle(filter) => filter.radius,
            Self::Gaussian(filter, _) => filter.radius,
            Self::Mitchell(filter, _) => filter.radius,
            Self::LanczosSinc(filter, _) => filter.radius,
        }
    }

    /// f at an offset from the pixel's centre.
    pub fn evaluate(&self, p: Vec2) -> f32 {
        match self {
            Self::Box(filter) => filter.evaluate(p),
            Self::Triangle(filter) => filter.evaluate(p),
            Self::Gaussian(filter, _) => filter.evaluate(p),
            Self::Mitchell(filter, _) => filter.evaluate(p),
            Self::LanczosSinc(filter, _) => filter.evaluate(p),
        }
    }

    /// An offset chosen about in proportion to |f|, from `u` in [0, 1)².
    #[inline(always)]
    pub fn sample<R: Real>(&self, u: Vec2<R>) -> FilterSample<R> {
        match self {
            Self::Box(filter) => filter.sample(u),
            Self::Triangle(filter) => filter.sample(u),
            Self::Gaussian(_, sampler) | Self::Mitchell(_, sampler) | Self::LanczosSinc(_, sampler) => {
                sampler.sample(u)
            }
        }
    }

    /// ∫ f(p) dp.
    pub fn integral(&self) -> f32 {
        match self {
            Self::Box(filter) => filter.integral(),
            Self::Triangle(filter) => filter.integral(),
            Self::Mitchell(filter, _) => filter.integral(),
            Self::Gaussian(filter, _) => separable_integral(filter.radius, |p| filter.evaluate(p)),
            Self::LanczosSinc(filter, _) => separable_integral(filter.radius, |p| filter.evaluate(p)),
        }
    }
}

/// ∫ f over the filter's support for f(x, y) = g(x) h(y), which is ∫ f(x, 0) dx · ∫ f(0, y) dy /
/// f(0, 0), by the midpoint rule.
fn separable_integral(radius: Vec2, f: impl Fn(Vec2) -> f32) -> f32 {
    const STEPS: i32 = 4096;
    let along = |axis: Vec2| -> f64 {
        let width = 2.0 * f64::from(axis.dot(radius));
        let at = |i| f64::from(f(axis * radius * ((2 * i + 1) as f32 / STEPS as f32 - 1.0)));
        (0..STEPS).map(at).sum::<f64>() * width / f64::from(STEPS)
    };
    (along(Vec2::X) * along(Vec2::Y) / f64::from(f(Vec2::ZERO))) as f32
}
