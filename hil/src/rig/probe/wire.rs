//! What an emulated board and its probe say to each other on TCP: a line that asks, with the bytes it
//! announces, and a line that answers, with its own.
//!
//! ```text
//! info                      ok LENGTH  + a line about the board
//! flash LENGTH  + ELF       ok 0, or: refused WHY
//! reset                     ok 0
//! read ADDRESS LENGTH       ok LENGTH  + bytes; ADDRESS in hexadecimal
//! log                       ok 0       + what the firmware writes to its RTT channel, as it comes
//! ```

/// Longest line, bytes.
pub const LINE_BYTES: usize = 256;
/// Largest image, bytes: an ELF file with all its debug information.
pub const IMAGE_BYTES: usize = 64 << 20;
/// Most bytes of one `read`.
pub const READ_BYTES: usize = 1 << 20;

/// What the probe asks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Request {
    /// Who is there?
    Info,
    /// Take this ELF file, and start it.
    Flash(Vec<u8>),
    /// Start again.
    Reset,
    /// What is in the memory?
    Read {
        /// From here.
        address: u32,
        /// So many bytes.
        length: usize,
    },
    /// Everything that is logged from now on.
    Log,
}

/// What is wrong with a line.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` is no request")]
pub struct NoRequest(String);

impl Request {
    /// The bytes that ask it.
    pub fn encode(&self) -> Vec<u8> {
        match self {
            Self::Info => b"info\n".to_vec(),
            Self::Flash(elf) => {
                let mut bytes = format!("flash {}\n", elf.len()).into_bytes();
                bytes.extend_from_slice(elf);
                bytes
            }
            Self::Reset => b"reset\n".to_vec(),
            Self::Read { address, length } => format!("read {address:08x} {length}\n").into_bytes(),
            Self::Log => b"log\n".to_vec(),
        }
    }

    /// Takes a request from the start of `bytes`; none while it is not all there.
    ///
    /// # Errors
    /// [`NoRequest`] where it cannot become one.
    pub fn take(bytes: &mut Vec<u8>) -> Result<Option<Self>, NoRequest> {
        let Some(end) = bytes
            .iter()
            .take(LINE_BYTES)
            .position(|byte| *byte == b'\n')
        else {
            return match bytes.len() {
                0..LINE_BYTES => Ok(None),
                _ => Err(NoRequest("a long line".to_owned())),
            };
        };
        let line = String::from_utf8_lossy(&bytes[..end]).into_owned();
        let words: Vec<_> = line.split(' ').collect();
        let request = match words.as_slice() {
            ["info"] => Self::Info,
            ["reset"] => Self::Reset,
            ["log"] => Self::Log,
            ["read", address, length] => {
                let address = u32::from_str_radix(address, 16).ok();
                let length = length.parse().ok().filter(|length| *length <= READ_BYTES);
                match address.zip(length) {
                    Some((address, length)) => Self::Read { address, length },
                    None => return Err(NoRequest(line)),
                }
            }
            ["flash", length] => match length.parse::<usize>() {
                Ok(length) if length <= IMAGE_BYTES => {
                    let whole = end + 1 + length;
                    if bytes.len() < whole {
                        return Ok(None);
                    }
                    let rest = bytes.split_off(whole);
                    let elf = std::mem::replace(bytes, rest).split_off(end + 1);
                    return Ok(Some(Self::Flash(elf)));
                }
                _ => return Err(NoRequest(line)),
            },
            _ => return Err(NoRequest(line)),
        };
        bytes.drain(..=end);
        Ok(Some(request))
    }
}

/// The answer `ok`, with bytes.
pub fn granted(bytes: &[u8]) -> Vec<u8> {
    let mut answer = format!("ok {}\n", bytes.len()).into_bytes();
    answer.extend_from_slice(bytes);
    answer
}

/// The answer that it cannot be done; `why` in one line.
pub fn refused(why: &str) -> Vec<u8> {
    format!("refused {}\n", why.replace('\n', "; ")).into_bytes()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn requests_are_read_as_they_were_written_however_they_come() {
        let requests = [
            Request::Info,
            Request::Flash(b"\x7fELF\n\n".to_vec()),
            Request::Read {
                address: 0x0800_0200,
                length: 64,
            },
            Request::Reset,
            Request::Log,
        ];
        let (mut held, mut read) = (Vec::new(), Vec::new());
        for byte in requests.iter().flat_map(Request::encode) {
            held.push(byte);
            read.extend(Request::take(&mut held).expect("a request"));
        }
        assert_eq!(read, requests);
        assert!(held.is_empty());
    }

    #[test]
    fn what_is_no_request_is_refused_at_once() {
        for line in [
            "fly\n",
            "read 08 many\n",
            "read 0 99999999\n",
            "flash -1\n",
            "\n",
        ] {
            assert!(Request::take(&mut line.into()).is_err(), "{line}");
        }
        assert!(Request::take(&mut vec![b'x'; LINE_BYTES]).is_err());
    }
}
