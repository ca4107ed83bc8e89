//! Completeness of tables of tests.

use std::collections::BTreeSet;

/// Fails if the table of a contract lacks a member of a closed set, given their names.
#[track_caller]
pub fn assert_complete<'a>(set: &[&str], table: impl IntoIterator<Item = &'a str>) {
    let table: BTreeSet<_> = table.into_iter().collect();
    let missing: Vec<_> = set.iter().filter(|&&name| !table.contains(name)).collect();
    assert!(missing.is_empty(), "the table lacks {missing:?}");
}
