//! Records when chosen functions were entered and left.

use super::Cycle;

/// One call of a traced function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Call {
    /// The function's first instruction.
    pub address: u32,
    /// Before that instruction.
    pub entered: Cycle,
    /// Before the first instruction after the call.
    pub returned: Cycle,
}
