//! The protocol, both ends against each other. That nothing here allocates needs no test: the crate is
//! `no_std` and does not link `alloc`.

mod common;
mod properties;
mod sessions;
