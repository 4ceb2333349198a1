//! The verbs of the command, as their users meet them.

mod bench;
mod calibrate;
mod cfclient;
mod command_line;
mod data_verbs;
mod experiments;
mod import_cf;
mod scenarios;
