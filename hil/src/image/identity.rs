//! What an image says it is, out of its file.

use frames::Identity;
use object::{Object, ObjectSection, ObjectSymbol};

/// The symbol of the identification.
const SYMBOL: &str = "IDENTITY";

/// The image does not say what it is.
#[derive(Debug, thiserror::Error)]
pub enum IdentityError {
    /// It is no ELF file.
    #[error("not an ELF image: {0}")]
    Elf(#[from] object::read::Error),
    /// There is no identification in it.
    #[error("the image has no symbol `{SYMBOL}`: is it this project's firmware?")]
    Missing,
    /// The identification is none.
    #[error(
        "the image's identification cannot be read: its bytes at {address:#010x} are {bytes:02x?}"
    )]
    Unreadable {
        /// Where it is.
        address: u64,
        /// What is there.
        bytes: Vec<u8>,
    },
}

/// Reads the identification of an image, an ELF file.
///
/// # Errors
/// [`IdentityError`], where it has none.
pub fn identity(elf: &[u8]) -> Result<Identity, IdentityError> {
    let file = object::File::parse(elf)?;
    let symbol = file.symbols().find(|symbol| symbol.name() == Ok(SYMBOL));
    let symbol = symbol.ok_or(IdentityError::Missing)?;
    let section = symbol.section_index().ok_or(IdentityError::Missing)?;
    let address = symbol.address();
    let bytes = file
        .section_by_index(section)?
        .data_range(address, Identity::BYTES as u64)?
        .unwrap_or_default();
    let identity = bytes.try_into().ok().and_then(Identity::decode);
    identity.ok_or_else(|| IdentityError::Unreadable {
        address,
        bytes: bytes.to_vec(),
    })
}
