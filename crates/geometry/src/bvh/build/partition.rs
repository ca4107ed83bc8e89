//! Partitioning references in place, in parallel where there are many.

use super::reference::{PARALLEL_SET, Reference};
use rayon::prelude::*;

/// Moves references for which `is_left` holds to the front; returns their number.
pub(super) fn partition(
    references: &mut [Reference],
    is_left: impl Fn(&Reference) -> bool + Sync + Send,
) -> usize {
    if references.len() < PARALLEL_SET {
        return serial(references, is_left);
    }
    let part = PARALLEL_SET / 4;
    let lefts: Vec<usize> = references.par_chunks_mut(part).map(|p| serial(p, &is_left)).collect();
    let middle: usize = lefts.iter().sum();
    // Runs of references in the wrong half: both halves have the same total length of them.
    let (mut wrong_right, mut wrong_left) = (Vec::new(), Vec::new());
    let mut at = 0;
    for (p, left) in references.chunks_mut(part).zip(lefts) {
        let border = middle.clamp(at, at + p.len()) - at;
        at += p.len();
        let (before, after) = p.split_at_mut(border);
        if left < border {
            wrong_right.push(&mut before[left..]);
        } else {
            wrong_left.push(&mut after[..left - border]);
        }
    }
    pairs(wrong_right, wrong_left).into_par_iter().for_each(|(a, b)| a.swap_with_slice(b));
    middle
}

fn serial(references: &mut [Reference], is_left: impl Fn(&Reference) -> bool) -> usize {
    let mut middle = 0;
    for i in 0..references.len() {
        let left = is_left(&references[i]);
        // Branchless: a branch would be mispredicted half of the time.
        references.swap(i, middle);
        middle += left as usize;
    }
    middle
}

/// Cuts two lists of runs of the same total length into pairs of runs of the same length.
fn pairs<'a, T>(a: Vec<&'a mut [T]>, b: Vec<&'a mut [T]>) -> Vec<(&'a mut [T], &'a mut [T])> {
    let mut pairs = Vec::with_capacity(a.len() + b.len());
    let (mut a, mut b) = (a.into_iter(), b.into_iter());
    let (mut x, mut y): (&mut [T], &mut [T]) = (&mut [], &mut []);
    loop {
        if x.is_empty() {
            let Some(next) = a.next() else { return pairs };
            x = next;
        } else if y.is_empty() {
            let Some(next) = b.next() else { return pairs };
            y = next;
        } else {
            let n = x.len().min(y.len());
            let (x_now, x_later) = x.split_at_mut(n);
            let (y_now, y_later) = y.split_at_mut(n);
            pairs.push((x_now, y_now));
            (x, y) = (x_later, y_later);
        }
    }
}
