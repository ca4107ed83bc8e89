//! A stable sort of keys with values: radix sort, from the lowest digit to the highest.
//!
//! Each digit takes three kernels: blocks of keys are *reduced* to the counts of their digits, the
//! counts are *scanned* [Hillis 1986], so that each block knows where its keys with a digit begin,
//! and the blocks *scatter* their keys [Merrill 2011]. Between keys of a block with the same digit
//! the order is kept by bits, one for each thread: a key comes after as many as there are bits
//! before its own.
//!
//! Newer sorts scan while they scatter, so that each key is read once for each digit, but a block
//! then waits for those before it, which no graphics interface promises to run.

use std::sync::Arc;

use super::{Plan, Start};
use crate::device::{Buffer, Device, GpuError, Kernel};
use crate::renderer::Kernels;
use crate::shaders;

/// Keys of a block, values of a digit, and digits of a key.
const BLOCK: u32 = 2048;
const DIGITS: u32 = 256;
const STEPS: u32 = 4;

/// Keys and their values, 32 bits each, with what sorts them.
pub struct Sorter {
    kernels: [Arc<Kernel>; 3],
    /// What the kernels are told for each digit.
    plans: Vec<Buffer>,
    blocks: u32,
    /// What is sorted, and what it is scattered to, in turns.
    keys: [Buffer; 2],
    values: [Buffer; 2],
    counts: Buffer,
}

impl Sorter {
    /// For this number of keys, at most 2²⁷.
    ///
    /// # Errors
    /// Those of the device.
    pub fn new(kernels: &Kernels, count: u32) -> Result<Self, GpuError> {
        let device = kernels.device();
        let blocks = count.div_ceil(BLOCK);
        let plan = |step| device.parameters(&Plan { count, step, blocks, ..Plan::default() });
        let words = |name, words: u32| device.zeros(name, 4 * u64::from(words.max(1)));
        let [count_of, sum, scatter] = shaders::sort();
        Ok(Self {
            kernels: [
                kernels.get("count", count_of)?,
                kernels.get("sum", sum)?,
                kernels.get("scatter", scatter)?,
            ],
            plans: (0..STEPS).map(plan).collect::<Result<_, _>>()?,
            blocks,
            keys: [words("keys", count)?, words("keys", count)?],
            values: [words("values of keys", count)?, words("values of keys", count)?],
            counts: words("counts of digits", DIGITS * (blocks + 1))?,
        })
    }

    /// The keys, sorted after [`run`](Self::run).
    pub fn keys(&self) -> &Buffer {
        &self.keys[0]
    }

    /// The value of each key.
    pub fn values(&self) -> &Buffer {
        &self.values[0]
    }

    /// Takes keys and values to the device, of each as many as there are.
    ///
    /// # Errors
    /// Those of the device.
    pub fn load(&self, device: &Device, keys: &[u32], values: &[u32]) -> Result<(), GpuError> {
        device.write(&self.keys[0], keys)?;
        device.write(&self.values[0], values)
    }

    /// Sorts: values of equal keys stay in their order.
    pub fn run(&self, start: &mut Start) {
        if self.blocks == 0 {
            return;
        }
        let [count_of, sum, scatter] = &self.kernels;
        let (mut from, mut to) = (0, 1);
        for plan in &self.plans {
            start(count_of, &[plan, &self.keys[from], &self.counts], self.blocks);
            start(sum, &[plan, &self.counts], DIGITS);
            let [keys, values] = [&self.keys[from], &self.values[from]];
            let sorted = [&self.keys[to], &self.values[to]];
            start(scatter, &[plan, &self.counts, keys, values, sorted[0], sorted[1]], self.blocks);
            (from, to) = (to, from);
        }
    }
}
