//! A board on the desk, without a board: the emulated one on pseudo-terminals, a tool that plays
//! probe-rs, and cables that break.

#![cfg(unix)]

#[path = "rig/bench.rs"]
mod bench;
#[path = "rig/cable.rs"]
mod cable;
#[path = "rig/check.rs"]
mod check;
#[path = "rig/files.rs"]
mod files;
#[path = "rig/flights.rs"]
mod flights;
#[path = "rig/plugs.rs"]
mod plugs;
#[path = "rig/probe_rs.rs"]
mod probe_rs;
#[path = "rig/transcript.rs"]
mod transcript;
