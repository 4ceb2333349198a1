//! Kernels of compiled code: what the flight image's libraries cost.

use core::hint::black_box;

use microfft::real::rfft_128;

use crate::{Kernel, Scratch, WORDS};

/// Each as the flight image's compiler makes it.
pub const KERNELS: [Kernel; 6] = [
    Kernel {
        name: "microfft rfft_128",
        items: 1,
        run: transform,
    },
    Kernel {
        name: "memcpy in SRAM",
        items: 4 * WORDS as u32,
        run: copy,
    },
    Kernel {
        name: "memset in SRAM",
        items: 4 * WORDS as u32,
        run: clear,
    },
    Kernel {
        name: "libm sinf",
        items: 16,
        run: |scratch| each_sample(scratch, libm::sinf),
    },
    Kernel {
        name: "libm roundf",
        items: 16,
        run: |scratch| each_sample(scratch, libm::roundf),
    },
    Kernel {
        name: "sum of 16 bytes by an index table",
        items: 32,
        run: gather,
    },
];

#[inline(never)]
fn transform(scratch: &mut Scratch) {
    black_box(rfft_128(black_box(&mut scratch.samples)));
}

#[inline(never)]
fn copy(scratch: &mut Scratch) {
    scratch.copy.copy_from_slice(black_box(&scratch.words));
}

#[inline(never)]
fn clear(scratch: &mut Scratch) {
    black_box(&mut scratch.copy).fill(0);
}

/// Sixteen samples through a function.
#[inline(never)]
fn each_sample(scratch: &mut Scratch, function: fn(f32) -> f32) {
    for (step, sample) in (0_u8..16).zip(&mut scratch.samples) {
        *sample = black_box(function(black_box(f32::from(step) * 0.4 - 3.0)));
    }
}

/// The unwrapping of a panorama in small: bytes by their indices.
#[inline(never)]
fn gather(scratch: &mut Scratch) {
    let (indices, pixels) = black_box(&scratch.words).split_at(WORDS / 2);
    for (column, sum) in indices.chunks_exact(16).take(32).zip(&mut scratch.copy) {
        *sum = column
            .iter()
            .map(|index| pixels.get(*index as usize % 256).copied().unwrap_or(0))
            .fold(0, u32::wrapping_add);
    }
}
