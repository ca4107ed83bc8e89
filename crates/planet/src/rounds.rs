//! Rounds in which the contacts of all moving spheres change their vectors.
//!
//! A lane is a sphere: the first contacts of as many spheres as there are lanes are a [`Row`], the
//! second ones another, and so on. Each lane sums the changes of its contacts in their order, so
//! that results do not depend on the number of lanes.

use lanes::{InstructionSet, Int, Kernel, MAX_LANES, Mask, Real};
use math::Vec3;
use rayon::prelude::*;

use crate::contacts::{Change, Contact, Row};

/// As many bodies are done by a thread at once; a multiple of the lanes.
pub const CHUNK: usize = 128;

/// Indices of the vectors of lanes, each four numbers.
const VECTORS: [u32; MAX_LANES] = [0, 4, 8, 12, 16, 20, 24, 28, 32, 36, 40, 44, 48, 52, 56, 60];

/// The contacts of at most [`CHUNK`] bodies that follow each other.
#[derive(Debug)]
pub struct Contacts {
    rows: Vec<Row>,
    /// Where the rows of as many bodies as there are lanes end.
    ends: Vec<usize>,
    /// The number of contacts of each body.
    pub counts: Vec<u32>,
}

impl Contacts {
    /// The contacts of bodies, one after another, of which each has as many as `counts` says.
    pub fn new(contacts: &[Contact], counts: Vec<u32>) -> Self {
        let (mut rows, mut ends, mut remaining) = (Vec::new(), Vec::new(), contacts);
        for counts in counts.chunks(MAX_LANES) {
            let first = rows.len();
            let most = counts.iter().copied().max().unwrap_or(0);
            rows.resize(first + most as usize, Row::NONE);
            for (lane, &count) in counts.iter().enumerate() {
                let (own, others) = remaining.split_at(count as usize);
                own.iter().zip(&mut rows[first..]).for_each(|(contact, row)| row.set(lane, contact));
                remaining = others;
            }
            ends.push(rows.len());
        }
        Self { rows, ends, counts }
    }
}

/// The place of the first vector that stays as it is, after those of as many bodies.
pub fn first_constant(bodies: usize) -> usize {
    bodies.next_multiple_of(CHUNK)
}

/// A vector of each body in rows of four numbers, of which the last is the number of contacts that
/// change it; padded to whole chunks, after which vectors follow that stay as they are.
#[derive(Clone, Debug)]
pub struct Vectors(Vec<f32>);

impl Vectors {
    /// Those of bodies, and constant ones.
    pub fn new(
        vectors: impl ExactSizeIterator<Item = Vec3>,
        constants: impl ExactSizeIterator<Item = Vec3>,
    ) -> Self {
        let first = 4 * first_constant(vectors.len());
        let mut rows = Vec::with_capacity(first + 4 * constants.len());
        vectors.for_each(|vector| rows.extend([vector.x, vector.y, vector.z, 0.0]));
        rows.resize(first, 0.0);
        constants.for_each(|vector| rows.extend([vector.x, vector.y, vector.z, 0.0]));
        Self(rows)
    }

    /// Those of the bodies, and more.
    pub fn iter(&self) -> impl Iterator<Item = Vec3> {
        self.0.as_chunks::<4>().0.iter().map(|&[x, y, z, _]| Vec3::new(x, y, z))
    }

    /// Changes each by all contacts of its body at once, in some rounds. A contact counts by one
    /// over the larger number of contacts that change something, of the two bodies.
    pub fn relax(&mut self, set: InstructionSet, rounds: usize, contacts: &[Contacts], change: impl Change) {
        let mut counted = self.clone();
        for _ in 0..rounds {
            pass::<_, false>(set, contacts, change, self, &mut counted);
            pass::<_, true>(set, contacts, change, &counted, self);
        }
    }
}

/// Counts the contacts that change each vector, or sums their changes.
fn pass<C: Change, const SUMS: bool>(
    set: InstructionSet,
    contacts: &[Contacts],
    change: C,
    from: &Vectors,
    to: &mut Vectors,
) {
    let chunks = to.0.par_chunks_mut(4 * CHUNK).zip(contacts).enumerate();
    chunks.for_each(|(chunk, (to, contacts))| {
        set.dispatch(Pass::<C, SUMS> { contacts, change, first: CHUNK * chunk, from: &from.0, to });
    });
}

/// A pass over the bodies of a chunk, which begins at a body.
struct Pass<'a, C, const SUMS: bool> {
    contacts: &'a Contacts,
    change: C,
    first: usize,
    from: &'a [f32],
    to: &'a mut [f32],
}

impl<C: Change, const SUMS: bool> Kernel for Pass<'_, C, SUMS> {
    type Output = ();

    #[inline(always)]
    fn run<R: Real>(self) {
        let mut begin = 0;
        for (group, &end) in self.contacts.ends.iter().enumerate() {
            let rows = &self.contacts.rows[begin..end];
            begin = end;
            for lane in (0..MAX_LANES).step_by(R::LANES) {
                let body = MAX_LANES * group + lane;
                let index = R::Int::splat(4 * (self.first + body) as u32);
                let index = index.wrapping_add(R::Int::load(&VECTORS));
                let [x, y, z, count] = R::gather_rows::<4>(self.from, index);
                let own = Vec3::new(x, y, z);
                let (mut sum, mut number) = (own, R::zero());
                // Most contacts of a step change nothing.
                let rows = if SUMS && !count.gt(R::zero()).any() { &[] } else { rows };
                for row in rows {
                    let partner = R::Int::load(&row.partner[lane..]);
                    let is_fixed = partner.eq(R::Int::splat(Contact::FIXED));
                    let index = R::Int::select(is_fixed, R::Int::splat(0), partner.shl(2));
                    let [x, y, z, others] = R::gather_rows::<4>(self.from, index);
                    let fixed = self.change.fixed::<R>(row, lane);
                    let other = Vec3::select(is_fixed, fixed, Vec3::new(x, y, z));
                    let (acts, change) = self.change.of::<R>(row, lane, own, other);
                    if SUMS {
                        let most = R::select(is_fixed, count, count.max(others));
                        sum = Vec3::select(acts, sum + change / most, sum);
                    } else {
                        number += R::select(acts, R::one(), R::zero());
                    }
                }
                let all = R::Mask::splat(true);
                R::compress_four([sum.x, sum.y, sum.z, number], all, &mut self.to[4 * body..]);
            }
        }
    }
}
