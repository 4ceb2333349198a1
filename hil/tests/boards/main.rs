//! Images on the emulated board: its timing, its camera and what comes over its wires. The images are built first.

mod calibrate_timing;
mod camera_faults;
mod capture_alone;
mod serial_frames;
