//! The image sensor's power-up, and its shutter and gain ever after.

use core::future::Future;

use embassy_futures::select::{Either3, select3};
use embassy_stm32::i2c;
use embassy_time::{Duration, Instant, TimeoutError, Timer, with_timeout};
use pilot::Exposure;
use sensor::{ImageSensor, Tcm8230};

use crate::board::SensorPort;
use crate::check_in::{self, Member, check_in};
use crate::counters::COUNTERS;
use crate::sensor_power::{EXTCLK_HZ, SensorPower};
use crate::wires::{EXPOSURE, SENSOR_SILENT, SENSOR_STARTED};

/// The longest any dealing with the sensor may take. The set-up's 30 bytes take 4 ms.
const DEALING_TIMEOUT: Duration = Duration::from_millis(50);

/// Failed writes of the exposure in a row after which the sensor is reset.
const FAILURES_TO_RESET: u32 = 3;

/// Pause before a sensor that did not answer is asked again. With the reset it makes 17 ms, and is
/// part of the 200 ms in which a camera that was unplugged gives frames again: 20 ms until its
/// silence is noticed, these, a frame until the outputs come on, and three frames.
const RETRY: Duration = Duration::from_millis(10);

/// Least time between two warnings: an absent sensor fails 60 times a second. Every fault counts.
const WARNING_PERIOD: Duration = Duration::from_secs(1);

/// Keeps the sensor running with the exposure that was wanted last. A write takes 0.4 ms and is
/// latched with the next frame; a failed one holds the last shutter and is repeated. A sensor that
/// is absent or silent is reset and set up again, for ever: the link does not wait for it.
#[embassy_executor::task]
pub async fn exposure(port: SensorPort, initial: Exposure) {
    let mut power = SensorPower::new(port);
    let mut wanted = initial;
    let mut last_warning: Option<Instant> = None;
    loop {
        check_in(Member::Exposure);
        let fault = run(&mut power, &mut wanted).await;
        COUNTERS.sensor_faults.count();
        if last_warning.is_none_or(|last| last.elapsed() >= WARNING_PERIOD) {
            last_warning = Some(Instant::now());
            defmt::warn!("image sensor: {}, starting it again", fault);
        }
        // A sensor that answers loses no time: the pause is for one that does not.
        if !matches!(fault, Fault::Silent) {
            Timer::after(RETRY).await;
        }
    }
}

/// From reset to the fault that makes another reset necessary.
async fn run(power: &mut SensorPower, wanted: &mut Exposure) -> Fault {
    let mut sensor = Tcm8230::new(power.restart().await, EXTCLK_HZ);
    if let Err(fault) = set_up(&mut sensor, *wanted).await {
        return fault;
    }
    SENSOR_SILENT.reset();
    SENSOR_STARTED.signal(sensor.settling_frames());

    let mut failures = 0;
    loop {
        check_in(Member::Exposure);
        let pause = Timer::after(check_in::PERIOD);
        match select3(EXPOSURE.wait(), SENSOR_SILENT.wait(), pause).await {
            Either3::First(newest) => *wanted = newest,
            Either3::Second(()) => return Fault::Silent,
            Either3::Third(()) => continue,
        }
        match in_time(sensor.set_exposure(wanted.shutter_lines, wanted.gain)).await {
            Ok(()) => failures = 0,
            Err(fault) if failures + 1 == FAILURES_TO_RESET => return fault,
            Err(_) => {
                failures += 1;
                COUNTERS.sensor_faults.count();
                repeat(*wanted);
            }
        }
    }
}

async fn set_up<S>(sensor: &mut S, exposure: Exposure) -> Result<(), Fault>
where
    S: ImageSensor<BusError = i2c::Error>,
{
    in_time(sensor.probe()).await?;
    in_time(sensor.init(exposure.shutter_lines, exposure.gain)).await
}

/// Asks for the exposure again, unless a newer one is asked for already.
fn repeat(exposure: Exposure) {
    if !EXPOSURE.signaled() {
        EXPOSURE.signal(exposure);
    }
}

/// A dealing with the sensor, with an end. The HAL's I2C waits for the bus as long as it takes.
async fn in_time(
    dealing: impl Future<Output = Result<(), sensor::Error<i2c::Error>>>,
) -> Result<(), Fault> {
    Ok(with_timeout(DEALING_TIMEOUT, dealing).await??)
}

/// Why the sensor must be reset.
enum Fault {
    /// Somebody else answers.
    Stranger {
        /// Its identity.
        id: u8,
    },
    /// The bus failed.
    Bus {
        /// The register at which the transfer began.
        register: u16,
        /// How.
        error: i2c::Error,
    },
    /// The bus hangs.
    Hangs,
    /// It answers but sends no frames.
    Silent,
}

impl From<TimeoutError> for Fault {
    fn from(_: TimeoutError) -> Self {
        Self::Hangs
    }
}

impl From<sensor::Error<i2c::Error>> for Fault {
    fn from(error: sensor::Error<i2c::Error>) -> Self {
        match error {
            sensor::Error::NotFound { id } => Self::Stranger { id },
            sensor::Error::Bus { register, error } => Self::Bus { register, error },
        }
    }
}

impl defmt::Format for Fault {
    fn format(&self, f: defmt::Formatter<'_>) {
        match self {
            Self::Stranger { id } => defmt::write!(f, "another device answers ({=u8:#x})", id),
            Self::Bus { register, error } => {
                defmt::write!(f, "I2C {} at register {=u16:#x}", error, register)
            }
            Self::Hangs => defmt::write!(f, "I2C hangs"),
            Self::Silent => defmt::write!(f, "no frames"),
        }
    }
}
