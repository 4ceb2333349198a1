//! Writes the golden streams as the fuzzer's first inputs, a file each.
//!
//! ```text
//! cargo run --package link --example fuzz_seeds -- firmware/link/fuzz/corpus
//! ```

use std::error::Error;
use std::path::{Path, PathBuf};
use std::{env, fs};

/// The recorded streams: a line each, with a name and the bytes in hex.
const GOLDEN: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../../tests/golden/data/pprzlink.jsonl"
);

/// The byte in front of each stream: how the fuzz target cuts it. Pieces of 8 and of 113 bytes.
const CUT: u8 = 0x77;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = env::args_os().nth(1).ok_or("usage: fuzz_seeds FOLDER")?;
    let folder = PathBuf::from(folder);
    fs::create_dir_all(&folder)?;
    let golden = fs::read_to_string(GOLDEN).map_err(|error| format!("{GOLDEN}: {error}"))?;
    let mut count = 0;
    for (line, number) in golden.lines().zip(1..) {
        write_seed(&folder, line).ok_or(format!("{GOLDEN}:{number}: no record"))??;
        count += 1;
    }
    println!("{count} seeds in {}", folder.display());
    Ok(())
}

/// Writes the stream of a record; `None` if the line is none.
fn write_seed(folder: &Path, line: &str) -> Option<std::io::Result<()>> {
    let name = field(line, "name")?.replace('/', "-");
    let mut seed = vec![CUT];
    seed.extend(bytes(field(line, "hex")?)?);
    Some(fs::write(folder.join(name), seed))
}

/// A field of a record, as text. Neither names nor hex digits need an escape.
fn field<'a>(line: &'a str, name: &str) -> Option<&'a str> {
    let (_, value) = line.split_once(&format!("\"{name}\": \""))?;
    Some(value.split_once('"')?.0)
}

fn bytes(hex: &str) -> Option<Vec<u8>> {
    let pairs = (0..hex.len()).step_by(2);
    pairs
        .map(|at| u8::from_str_radix(hex.get(at..at + 2)?, 16).ok())
        .collect()
}
