//! What can go wrong between the driver and the sensor.

use core::fmt;

/// Why a sensor did not do what it was told. `E` is the bus's own error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Error<E> {
    /// Somebody answers at the sensor's address, but it is not this sensor.
    NotFound {
        /// What its identity register holds.
        id: u8,
    },
    /// The bus failed, after the retries that make sense for its error.
    Bus {
        /// The register at which the transfer began: how far the driver had come.
        register: u16,
        /// What the bus says.
        error: E,
    },
}

impl<E: fmt::Debug> fmt::Display for Error<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFound { id } => write!(f, "another device answers: its identity is {id:#04x}"),
            Self::Bus { register, error } => {
                write!(f, "I2C, at register {register:#04x}: {error:?}")
            }
        }
    }
}

impl<E: fmt::Debug> core::error::Error for Error<E> {}
