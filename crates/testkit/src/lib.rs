//! Statistical tests on plain numbers: chi-squared, t and z
