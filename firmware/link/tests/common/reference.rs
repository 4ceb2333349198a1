//! A receiver written the plain way: the specification of the parser, without regard to time or
//! memory.

use link::MIN_FRAME_LEN;

/// The whole frames in a stream that is known from end to end, and the offset from which on it
/// could not be decided.
pub fn frames_in(stream: &[u8]) -> (Vec<Vec<u8>>, usize) {
    let mut frames = Vec::new();
    let mut at = 0;
    while at < stream.len() {
        match frame_len(&stream[at..]) {
            Some(0) => at += 1,
            Some(len) => {
                frames.push(stream[at..at + len].to_vec());
                at += len;
            }
            None => break,
        }
    }
    (frames, at)
}

/// The whole frames in a stream after which nothing comes.
pub fn frames_in_ended(stream: &[u8]) -> Vec<Vec<u8>> {
    let (mut frames, decided) = frames_in(stream);
    if decided < stream.len() {
        frames.extend(frames_in_ended(&stream[decided + 1..]));
    }
    frames
}

/// Length of the frame that begins here; 0 if none does, `None` if the stream ends too early. A
/// header counts as too early until the shortest frame would be complete, an array's length that
/// comes behind that until the whole frame is.
fn frame_len(bytes: &[u8]) -> Option<usize> {
    if *bytes.first()? != 0x99 {
        return Some(0);
    }
    let header = bytes.get(..MIN_FRAME_LEN)?;
    let len = usize::from(header[1]);
    if len < MIN_FRAME_LEN || header[4] & 0x0f != 5 {
        return Some(0);
    }
    // Bytes of a frame without its array, offset of the array's length.
    let (shortest, array_at) = match header[5] {
        5 | 15 => (9, Some(6)),
        6 => (10, Some(7)),
        9 => (29, None),
        10 => (28, None),
        11 => (29, Some(26)),
        12 => (34, None),
        _ => return Some(0),
    };
    let possible = match array_at {
        None => len == shortest,
        Some(at) if at < MIN_FRAME_LEN => len == shortest + usize::from(header[at]),
        Some(_) => len >= shortest,
    };
    if !possible {
        return Some(0);
    }
    let frame = bytes.get(..len)?;
    if array_at.is_some_and(|at| len != shortest + usize::from(frame[at])) {
        return Some(0);
    }
    let (mut a, mut b) = (0u32, 0u32);
    for byte in &frame[1..len - 2] {
        a = (a + u32::from(*byte)) % 256;
        b = (b + a) % 256;
    }
    let sums = [u32::from(frame[len - 2]), u32::from(frame[len - 1])];
    Some(if sums == [a, b] { len } else { 0 })
}
