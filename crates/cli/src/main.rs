//! The command line of alhazen.

fn main() {}
