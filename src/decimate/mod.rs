//! Decimators: each turns a mesh into the history of its simplification.

pub mod fusion;
pub mod jade;
pub mod progressive;
