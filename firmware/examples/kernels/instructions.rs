//! Kernels of known instructions, for what each kind of them costs.

use core::arch::naked_asm;

use embassy_stm32::pac;

use crate::{Kernel, Scratch};

/// A kernel of machine code that works in the registers which the calling convention leaves to it
/// (AAPCS §6.1.1), and in the memory that it is given the address of, in r0.
macro_rules! kernel {
    ($name:literal, $items:literal, [$($code:literal),* $(,)?]) => {
        kernel!($name, $items, |_scratch| core::ptr::null::<u32>(), [$($code),*])
    };
    ($name:literal, $items:literal, |$scratch:ident| $address:expr, [$($code:literal),* $(,)?]) => {{
        #[unsafe(naked)]
        unsafe extern "C" fn run(address: *const u32) {
            naked_asm!(
                "push {{r4, lr}}",
                "mov r1, #1",
                "mov r2, #3",
                "mov r3, #0x6000000",
                "mov r12, #100",
                "vmov.f32 s0, #1.0",
                "vmov.f32 s1, #1.5",
                "vmov.f32 s2, #1.0",
                "vmov.f32 s3, #1.0",
                "vmov.f32 s4, #1.0",
                $($code),*,
                "pop {{r4, pc}}",
            )
        }
        Kernel {
            name: $name,
            items: $items,
            // SAFETY: the code reads and writes the 4 KiB at the address at most, or the one
            // register there.
            run: |$scratch: &mut Scratch| unsafe { run($address.cast()) },
        }
    }};
}

/// In the order of the manual's table of instructions (ARM DDI0439 §3.3), flash last.
pub const KERNELS: [Kernel; 35] = [
    kernel!("nothing", 1, [""]),
    kernel!("adds", 512, [".rept 512", "adds r1, r1, r2", ".endr"]),
    kernel!(
        "adds wide",
        256,
        [".rept 256", "adds.w r1, r1, r2", ".endr"]
    ),
    kernel!("mul", 256, [".rept 256", "mul r1, r1, r2", ".endr"]),
    kernel!("mla", 256, [".rept 256", "mla r1, r1, r2, r1", ".endr"]),
    kernel!("smlad", 256, [".rept 256", "smlad r1, r1, r2, r1", ".endr"]),
    kernel!("umull", 256, [".rept 256", "umull r1, r2, r1, r2", ".endr"]),
    kernel!(
        "udiv, quotient of 25 bits",
        100,
        [".rept 100", "udiv r1, r3, r2", ".endr"]
    ),
    kernel!(
        "sdiv, quotient of 1 bit",
        100,
        [".rept 100", "sdiv r1, r2, r2", ".endr"]
    ),
    kernel!(
        "loop of subs and bne",
        100,
        [".balign 16", "2: subs r12, #1", "bne 2b"]
    ),
    kernel!(
        "loop that begins with a wide instruction across words",
        100,
        [".balign 16", "nop", "2: subs.w r12, r12, #1", "bne 2b",]
    ),
    kernel!(
        "branch not taken",
        256,
        ["cmp r2, r2", ".rept 256", "bne 2f", ".endr", "2:"]
    ),
    kernel!(
        "call and return",
        100,
        [
            "b 3f",
            ".balign 16",
            "2: bx lr",
            "3:",
            ".rept 100",
            "bl 2b",
            ".endr",
        ]
    ),
    kernel!(
        "it and one conditional",
        128,
        [".rept 128", "it eq", "addeq r1, r2", ".endr"]
    ),
    kernel!(
        "ldr, in a row",
        256,
        |scratch| scratch.words.as_ptr(),
        [
            ".rept 64",
            "ldr r1, [r0]",
            "ldr r2, [r0, #4]",
            "ldr r3, [r0, #8]",
            "ldr r1, [r0, #12]",
            ".endr",
        ]
    ),
    kernel!(
        "ldr and its use",
        128,
        |scratch| scratch.words.as_ptr(),
        [".rept 128", "ldr r1, [r0]", "adds r2, r2, r1", ".endr",]
    ),
    kernel!(
        "ldrb of an index of an index",
        128,
        |scratch| scratch.words.as_ptr(),
        [
            ".rept 128",
            "ldrh r1, [r0, #2]",
            "ldrb r2, [r0, r1]",
            "adds r3, r3, r2",
            ".endr",
        ]
    ),
    kernel!(
        "ldr across words",
        128,
        |scratch| scratch.words.as_ptr(),
        [".rept 128", "ldr r1, [r0, #1]", ".endr"]
    ),
    kernel!(
        "str, in a row",
        256,
        |scratch| scratch.copy.as_mut_ptr(),
        [".rept 256", "str r1, [r0]", ".endr"]
    ),
    kernel!(
        "ldm of four",
        64,
        |scratch| scratch.words.as_ptr(),
        [".rept 64", "ldm r0, {{r1, r2, r3, r12}}", ".endr"]
    ),
    kernel!(
        "push and pop of two",
        64,
        [".rept 64", "push {{r1, r2}}", "pop {{r1, r2}}", ".endr"]
    ),
    kernel!(
        "ldr of constants in the code",
        128,
        [
            ".rept 128",
            "ldr r1, 2f",
            ".endr",
            "b 3f",
            ".balign 4",
            "2: .word 1",
            "3:"
        ]
    ),
    kernel!(
        "vadd, each on the last",
        128,
        [".rept 128", "vadd.f32 s0, s0, s1", ".endr"]
    ),
    kernel!(
        "vadd, independent",
        128,
        [
            ".rept 32",
            "vadd.f32 s0, s0, s1",
            "vadd.f32 s2, s2, s1",
            "vadd.f32 s3, s3, s1",
            "vadd.f32 s4, s4, s1",
            ".endr",
        ]
    ),
    kernel!(
        "vmul and vadd, each on the last",
        128,
        [
            ".rept 64",
            "vmul.f32 s2, s0, s1",
            "vadd.f32 s0, s0, s2",
            ".endr"
        ]
    ),
    kernel!(
        "vmul and vadd, interleaved",
        128,
        [
            ".rept 32",
            "vmul.f32 s2, s0, s1",
            "vmul.f32 s3, s4, s1",
            "vadd.f32 s0, s0, s2",
            "vadd.f32 s4, s4, s3",
            ".endr",
        ]
    ),
    kernel!(
        "vmla, each on the last",
        128,
        [".rept 128", "vmla.f32 s0, s1, s2", ".endr"]
    ),
    kernel!(
        "vdiv, each on the last",
        64,
        [".rept 64", "vdiv.f32 s0, s0, s1", ".endr"]
    ),
    kernel!(
        "vdiv beside 12 adds",
        64,
        [
            ".rept 64",
            "vdiv.f32 s0, s2, s1",
            ".rept 12",
            "adds r1, r1, r2",
            ".endr",
            ".endr"
        ]
    ),
    kernel!(
        "vldr and vmul",
        128,
        |scratch| scratch.samples.as_ptr(),
        [".rept 128", "vldr s0, [r0]", "vmul.f32 s2, s0, s1", ".endr"]
    ),
    kernel!(
        "vcvt of an integer from a register",
        128,
        [".rept 128", "vmov s0, r1", "vcvt.f32.u32 s0, s0", ".endr"]
    ),
    kernel!(
        "vcmp and branch on it",
        64,
        [
            ".rept 64",
            "vcmp.f32 s0, s1",
            "vmrs APSR_nzcv, fpscr",
            "bgt 2f",
            ".endr",
            "2:"
        ]
    ),
    kernel!(
        "read of a register on AHB1",
        128,
        |_scratch| pac::GPIOA.idr().as_ptr(),
        [".rept 128", "ldr r1, [r0]", ".endr"]
    ),
    kernel!(
        "read of a register on APB1",
        128,
        |_scratch| pac::PWR.cr1().as_ptr(),
        [".rept 128", "ldr r1, [r0]", ".endr"]
    ),
    kernel!(
        "read of a register on APB2",
        128,
        |_scratch| pac::EXTI.imr(0).as_ptr(),
        [".rept 128", "ldr r1, [r0]", ".endr"]
    ),
];

/// What the flash makes of code: more of it than the instruction cache's 1 KiB holds.
pub const FLASH_KERNELS: [Kernel; 4] = [
    kernel!(
        "flash, 2048 narrow in a row",
        2048,
        [".rept 2048", "adds r1, r1, r2", ".endr"]
    ),
    kernel!(
        "flash, 1024 wide in a row",
        1024,
        [".rept 1024", "adds.w r1, r1, r2", ".endr"]
    ),
    kernel!(
        "flash, jumps to every second line",
        128,
        [
            ".balign 16",
            ".rept 128",
            "b.w 2f",
            ".space 28",
            "2:",
            ".endr",
        ]
    ),
    kernel!(
        "flash, ldr of every second line",
        128,
        |_scratch| 0x0800_0000_usize as *const u32,
        [".rept 128", "ldr r1, [r0], #32", ".endr",]
    ),
];
