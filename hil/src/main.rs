//! The command `hil`.

use std::process::ExitCode;

fn main() -> ExitCode {
    hil::cli::main()
}
