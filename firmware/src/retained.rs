//! The pilot's memory outlives a reset by the watchdog.
//!
//! SRAM keeps its contents through any reset short of a power failure, and the start-up code leaves
//! the section in which the pilot lives alone. A mark beside it says that no change was under way:
//! after a watchdog reset a pilot that was marked whole goes on where it was, its route and its
//! mode with it, and the autopilot notices nothing but a second of silence. A pilot that hung
//! itself was not whole, and is replaced by a new one.

use core::cell::UnsafeCell;
use core::mem::MaybeUninit;
use core::sync::atomic::{AtomicU32, Ordering, compiler_fence};

use embassy_stm32::pac;
use embassy_time::Instant;
use pilot::Pilot;

/// The pilot, kept whole.
pub struct Retained {
    pilot: &'static mut Pilot,
    image: u32,
    /// The pilot's clock at this boot, in milliseconds.
    epoch_ms: u32,
}

/// What lies in memory that no start-up code touches.
struct Vault {
    /// The fingerprint of the image whose whole pilot this is; anything else: not whole.
    mark: AtomicU32,
    /// The pilot's clock when the mark was set last.
    clock_ms: AtomicU32,
    pilot: UnsafeCell<MaybeUninit<Pilot>>,
}

// SAFETY: `pilot` is reached through `Retained::open` alone, which can be called once.
unsafe impl Sync for Vault {}

#[unsafe(link_section = ".uninit.pilot")]
static VAULT: MaybeUninit<Vault> = MaybeUninit::uninit();

/// Never a fingerprint.
const NOT_WHOLE: u32 = 0;

impl Retained {
    /// The pilot of the run before, where the watchdog ended it and it was whole; otherwise the one
    /// that `new` makes. To be called once. Also says which of the two it is.
    ///
    /// # Errors
    /// Those of `new`.
    pub fn open<E>(new: impl FnOnce() -> Result<Pilot, E>) -> Result<(Self, bool), E> {
        let image = fingerprint();
        let vault = vault();
        let kept = was_watchdog() && vault.mark.load(Ordering::Acquire) == image;
        vault.mark.store(NOT_WHOLE, Ordering::Relaxed);
        compiler_fence(Ordering::SeqCst);
        // SAFETY: this is the only reference, for the function is called once.
        let memory = unsafe { &mut *vault.pilot.get() };
        let (pilot, epoch_ms) = if kept {
            // SAFETY: this same image wrote a pilot here, finished with it, and set the mark; the
            // memory has had power since.
            (
                unsafe { memory.assume_init_mut() },
                vault.clock_ms.load(Ordering::Relaxed),
            )
        } else {
            (memory.write(new()?), 0)
        };
        let retained = Self {
            pilot,
            image,
            epoch_ms,
        };
        // Whole again at once: a fault of the hardware that lasts may end this run, too, before the
        // first frame or message.
        retained.mark_whole(epoch_ms);
        Ok((retained, kept))
    }

    /// Lets `change` work on the pilot, at its clock's time in milliseconds; should the watchdog
    /// strike meanwhile, the pilot is lost.
    pub fn change<R>(&mut self, at: Instant, change: impl FnOnce(&mut Pilot, u32) -> R) -> R {
        // The pilot's clock wraps after 49 days.
        let now_ms = self.epoch_ms.wrapping_add(at.as_millis() as u32);
        vault().mark.store(NOT_WHOLE, Ordering::Relaxed);
        compiler_fence(Ordering::SeqCst);
        let result = change(self.pilot, now_ms);
        self.mark_whole(now_ms);
        result
    }

    fn mark_whole(&self, now_ms: u32) {
        let vault = vault();
        vault.clock_ms.store(now_ms, Ordering::Relaxed);
        vault.mark.store(self.image, Ordering::Release);
    }

    /// The pilot, to look at.
    pub fn pilot(&self) -> &Pilot {
        self.pilot
    }
}

fn vault() -> &'static Vault {
    // The black box keeps the compiler from knowing that nobody wrote here since the start of the
    // program: somebody did, before it.
    let vault = core::hint::black_box(VAULT.as_ptr());
    // SAFETY: atomics and a `MaybeUninit` are valid with whatever bits the memory holds.
    unsafe { &*vault }
}

/// Whether the independent watchdog, and no failure of power, began this run (RM0090 §7.3.21).
/// Clears the flags for the next.
fn was_watchdog() -> bool {
    let flags = pac::RCC.csr().read();
    pac::RCC.csr().modify(|csr| csr.set_rmvf(true));
    flags.wdgrstf() && !flags.porrstf() && !flags.borrstf()
}

/// Tells this image from others: the sum of its words in flash. A pilot of another image may have
/// another shape.
fn fingerprint() -> u32 {
    unsafe extern "C" {
        static __vector_table: u32;
        static __sidata: u32;
    }
    let start = (&raw const __vector_table).expose_provenance();
    let end = (&raw const __sidata).expose_provenance();
    let mut sum = 0u32;
    for address in (start..end).step_by(size_of::<u32>()) {
        let word = core::ptr::with_exposed_provenance::<u32>(address);
        // SAFETY: the linker's symbols enclose the image's code and constants, word-aligned.
        sum = sum.rotate_left(1).wrapping_add(unsafe { word.read() });
    }
    sum.max(NOT_WHOLE + 1)
}
