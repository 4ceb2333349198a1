//! The lens, from the record in flash to the horizon.

mod derotation;
mod lens_record;
mod second_sensor;
