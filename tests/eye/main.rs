//! The lens, from the record in flash to the horizon.

mod lens_record;
