//! (room under construction)
#![no_std]
