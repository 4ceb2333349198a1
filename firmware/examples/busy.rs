//! A core that never rests: what an emulator is measured with.
//!
//! Whole numbers, bytes and floating point in turn, for ever, from the flash of the flight image and
//! with its wait states.
#![no_std]
#![no_main]

#[path = "common/flight_flash.rs"]
mod flight_flash;

use core::hint::black_box;

use defmt_rtt as _;
use panic_probe as _;

/// Rows and columns of the matrices: the Kalman filter's.
const ORDER: usize = 9;
/// Bytes of the pictures that are compared: the unrolled horizon.
const PICTURE: usize = 2048;

type Matrix = [[f32; ORDER]; ORDER];

#[cortex_m_rt::entry]
fn main() -> ! {
    flight_flash::set_up();
    let mut hash = 0xcbf2_9ce4_8422_2325;
    let mut covariance: Matrix =
        core::array::from_fn(|row| core::array::from_fn(|column| f32::from(row == column)));
    let mut pictures = [[0; PICTURE]; 2];
    loop {
        for (index, byte) in pictures.as_flattened_mut().iter_mut().enumerate() {
            *byte = hash_on(&mut hash, index as u8);
        }
        let difference = difference(black_box(&pictures[0]), black_box(&pictures[1]));
        hash_on(&mut hash, difference as u8);
        covariance = mean(&covariance, &product(black_box(&covariance), &covariance));
    }
}

/// A step of the 64-bit hash of Fowler, Noll and Vo; its upper byte.
fn hash_on(hash: &mut u64, byte: u8) -> u8 {
    *hash = (*hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
    (*hash >> 56) as u8
}

/// Sum of absolute differences.
#[inline(never)]
fn difference(a: &[u8; PICTURE], b: &[u8; PICTURE]) -> u32 {
    a.iter()
        .zip(b)
        .map(|(a, b)| u32::from(a.abs_diff(*b)))
        .sum()
}

#[inline(never)]
fn product(a: &Matrix, b: &Matrix) -> Matrix {
    core::array::from_fn(|row| {
        core::array::from_fn(|column| (0..ORDER).map(|k| a[row][k] * b[k][column]).sum())
    })
}

#[inline(never)]
fn mean(a: &Matrix, b: &Matrix) -> Matrix {
    core::array::from_fn(|row| {
        core::array::from_fn(|column| 0.5 * (a[row][column] + b[row][column]))
    })
}
