//! From the bytes on the deck's UART to the messages that the app handles, with all that gets lost on
//! the way.
//!
//! ```text
//! bytes -> buffer (uart) -> receiver -> ten calls a cycle (receive_loop) -> handlers
//!    |        | full          | broken         | tenth message
//!    '-> ledger <-------------+----------------'  -> Dropped
//! ```

mod dropped;
mod ledger;
pub mod published_receiver;
mod receive_loop;
mod receiver;
mod uart;

pub use dropped::{DropReason, Dropped};
pub use receive_loop::{Delivery, ReceiveLoop};
