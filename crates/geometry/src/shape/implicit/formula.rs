//! Formulas, compiled for evaluation on numbers, intervals, jets and Taylor models.

use super::interval::Interval;
use super::jet::Jet;
use super::parser::{self, FormulaError};
use super::program::Program;
use super::roots::{Root, Roots};
use math::{Bounds3, DVec3};
use std::sync::Arc;

/// A formula F(x, y, z): numbers, x, y, z, pi, e, + − * / ^, parentheses, and the functions sqrt,
/// abs, sin, cos, tan, exp, log, min, max and pow.
#[derive(Clone, Debug)]
pub struct Formula {
    program: Arc<Program>,
    order: Order,
}

/// The number of coefficients of the Taylor models of a formula.
#[derive(Clone, Copy, Debug)]
enum Order {
    Four,
    Eight,
    Sixteen,
}

impl Formula {
    /// The largest coordinate of a box within which a surface can be used: rays are in single
    /// precision, where squares of larger coordinates overflow.
    pub const MAX_COORDINATE: f32 = 1e18;

    /// Parses a formula of x, y and z, such as `x^2 + y^2 + z^2 - 1`.
    ///
    /// ```
    /// use alhazen_geometry::Formula;
    ///
    /// let sphere = Formula::parse("x^2 + y^2 + z^2 - 1").expect("a formula");
    /// assert_eq!(sphere.value([1.0, 2.0, 2.0]), 8.0);
    /// let error = Formula::parse("x^2 + siin(y)").expect_err("no formula");
    /// assert_eq!(error.place, 6..10);
    /// ```
    pub fn parse(text: &str) -> Result<Self, FormulaError> {
        let program = parser::parse(text)?;
        let order = match program.degree() {
            Some(..=3) => Order::Four,
            None | Some(..=7) => Order::Eight,
            Some(_) => Order::Sixteen,
        };
        Ok(Self { program: Arc::new(program), order })
    }

    /// F at a point; NaN where it is undefined.
    pub fn value(&self, p: [f64; 3]) -> f64 {
        self.program.evaluate(p, &mut Vec::new())
    }

    /// Whether interval arithmetic proves that F has no zero in a box.
    pub fn has_no_zero(&self, bounds: &Bounds3) -> bool {
        let axis = |i: usize| Interval::new(bounds.min[i].into(), bounds.max[i].into());
        !self.program.evaluate([axis(0), axis(1), axis(2)], &mut Vec::new()).contains(0.0)
    }

    /// Value, gradient and second derivatives at a point.
    pub(super) fn jet(&self, p: DVec3) -> Jet {
        self.program.evaluate([0, 1, 2].map(|axis| Jet::coordinate(p, axis)), &mut Vec::new())
    }

    /// The first root along o + d·t for which `wanted` holds, with `t` in a range.
    pub(super) fn first_root(
        &self,
        o: DVec3,
        d: DVec3,
        range: [f64; 2],
        wanted: impl FnMut(&Root) -> bool,
    ) -> Option<Root> {
        // t is relative to the start of the range, so that coordinates are small.
        let start = range[0];
        let o = o + d * start;
        let range = [0.0, range[1] - start];
        let moved = |root: Root| Root { t: root.t + start, ..root };
        let program = &self.program;
        match self.order {
            Order::Four => Roots::<4>::new(program, o, d, range).map(moved).find(wanted),
            Order::Eight => Roots::<8>::new(program, o, d, range).map(moved).find(wanted),
            Order::Sixteen => Roots::<16>::new(program, o, d, range).map(moved).find(wanted),
        }
    }
}
