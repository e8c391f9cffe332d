//! The program `nephrite`.

fn main() {}
