//! Worlds as they stand on the command line.

use std::path::Path;

use fake_sensors::world::World;

/// A name of the library's, or a file.
///
/// # Errors
/// What there is, where it is neither.
pub fn parse(text: &str) -> Result<String, String> {
    if World::names().contains(&text) || Path::new(text).extension().is_some() {
        Ok(text.to_owned())
    } else {
        Err(format!(
            "none of {}, and no file such as room.toml",
            World::names().join(", ")
        ))
    }
}
