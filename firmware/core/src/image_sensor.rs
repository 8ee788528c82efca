//! Image sensors for the gesture engine: set-up of an OV7670 or OV5640 over SCCB, OmniVision's form of I2C.
//!
//! [`ImageSensor`] finds the chip over any [`I2c`], checks its identity, and writes a short list of registers: RGB565 over the
//! parallel port, the high byte of a pixel first, a mirrored picture (a hand moves as in a mirror), automatic exposure, gain and
//! white balance. All other registers keep their values after a reset of the chip. The register values follow public drivers;
//! they have not been checked against the data sheets or tried with a real chip.
//!
//! SCCB differs from I2C: it has no repeated start, so a read takes two transactions.

mod ov5640;
mod ov7670;
mod step;

use core::fmt;

use embedded_hal_async::delay::DelayNs;
use embedded_hal_async::i2c::{Error as _, ErrorKind, I2c};

use step::SetupStep;

/// Number of columns and rows of a camera frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameSize {
    /// 320×240.
    Qvga,
    /// 640×480.
    Vga,
}

impl FrameSize {
    /// Columns and rows.
    pub const fn pixels(self) -> [u16; 2] {
        match self {
            Self::Qvga => [320, 240],
            Self::Vga => [640, 480],
        }
    }
}

/// The type of an image sensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Model {
    /// An OV7670: registers have numbers of 8 bits.
    Ov7670,
    /// An OV5640: registers have numbers of 16 bits.
    Ov5640,
}

impl Model {
    const ALL: [Self; 2] = [Self::Ov7670, Self::Ov5640];

    /// The chip's bus address, without the read/write bit.
    pub const fn address(self) -> u8 {
        match self {
            Self::Ov7670 => 0x21,
            Self::Ov5640 => 0x3c,
        }
    }

    /// The product number in two registers of the chip.
    pub const fn product(self) -> u16 {
        match self {
            Self::Ov7670 => 0x7673,
            Self::Ov5640 => 0x5640,
        }
    }

    /// Whether VSYNC is low between frames, with the registers that [`ImageSensor::start`] writes. HREF is high during a line,
    /// and data are valid at the rising edge of PCLK.
    pub const fn is_vsync_low(self) -> bool {
        matches!(self, Self::Ov5640)
    }

    /// Number of the first of the two consecutive registers that hold the product number.
    const fn product_register(self) -> u16 {
        match self {
            Self::Ov7670 => 0x0a,
            Self::Ov5640 => 0x300a,
        }
    }

    /// The steps of the set-up for a size.
    const fn steps(self, size: FrameSize) -> [&'static [SetupStep]; 3] {
        match (self, size) {
            (Self::Ov7670, FrameSize::Qvga) => [ov7670::RESET, ov7670::COMMON, ov7670::QVGA],
            (Self::Ov7670, FrameSize::Vga) => [ov7670::RESET, ov7670::COMMON, ov7670::VGA],
            (Self::Ov5640, FrameSize::Qvga) => [ov5640::RESET, ov5640::COMMON, ov5640::QVGA],
            (Self::Ov5640, FrameSize::Vga) => [ov5640::RESET, ov5640::COMMON, ov5640::VGA],
        }
    }
}

impl fmt::Display for Model {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            Self::Ov7670 => "OV7670",
            Self::Ov5640 => "OV5640",
        })
    }
}

/// Reason why an image sensor was not set up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Error<E> {
    /// Error of the bus.
    Bus(E),
    /// No chip answers at the addresses of the known chips.
    Absent,
    /// A chip answers, but has another product number.
    Identity {
        /// The chip that is expected at this address.
        model: Model,
        /// The product number of the chip.
        found: u16,
    },
    /// A register does not keep the written value.
    Register {
        /// Number of the register.
        register: u16,
        /// The written value.
        expected: u8,
        /// The value read.
        found: u8,
    },
}

impl<E> From<E> for Error<E> {
    fn from(error: E) -> Self {
        Self::Bus(error)
    }
}

impl<E: fmt::Display> fmt::Display for Error<E> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Bus(error) => error.fmt(f),
            Self::Absent => {
                f.write_str("no image sensor answers: expected")?;
                let mut between = " ";
                for model in Model::ALL {
                    write!(f, "{between}an {model} at {:#04x}", model.address())?;
                    between = " or ";
                }
                f.write_str("; check its supply, its clock XCLK and the wires SCL and SDA")
            }
            Self::Identity { model, found } => write!(
                f,
                "the chip at {:#04x} has the product number {found:#06x}: expected {:#06x} ({model})",
                model.address(),
                model.product()
            ),
            Self::Register {
                register,
                expected,
                found,
            } => write!(
                f,
                "register {register:#06x} is {found:#04x}: expected {expected:#04x} as written"
            ),
        }
    }
}

/// A driver of an image sensor on an I2C bus. The chip responds only while its clock XCLK runs.
///
/// A set-up takes 50 to 80 transactions. On a bus with periodic reads of another sensor ([`PeriodicI2c`](glint_i2c::PeriodicI2c)) each
/// transaction would end the periodic reads, so set up the chip before them or on a separate bus.
pub struct ImageSensor<B> {
    bus: B,
}

impl<B: I2c> ImageSensor<B> {
    /// Makes a driver for a chip on `bus`; [`start`](Self::start) finds the chip.
    pub const fn new(bus: B) -> Self {
        Self { bus }
    }

    /// Finds the chip, then resets it and sets it up for a size.
    ///
    /// # Errors
    /// The chip is absent, unknown, or does not accept its set-up.
    pub async fn start(
        &mut self,
        size: FrameSize,
        delay: &mut impl DelayNs,
    ) -> Result<Model, Error<B::Error>> {
        let model = self.find().await?;
        for &step in model.steps(size).into_iter().flatten() {
            match step {
                SetupStep::Write(register, value) => self.write(model, register, value).await?,
                SetupStep::Check(register, expected) => {
                    self.write(model, register, expected).await?;
                    let found = self.read(model, register).await?;
                    if found != expected {
                        return Err(Error::Register {
                            register,
                            expected,
                            found,
                        });
                    }
                }
                SetupStep::Wait(time) => delay.delay_ms(time).await,
            }
        }
        Ok(model)
    }

    /// Whether the chip's readable registers still contain the settings of [`start`](Self::start). A chip loses its settings when
    /// its supply fails.
    ///
    /// # Errors
    /// The chip does not answer.
    pub async fn keeps(&mut self, model: Model, size: FrameSize) -> Result<bool, Error<B::Error>> {
        for &step in model.steps(size).into_iter().flatten() {
            if let SetupStep::Check(register, expected) = step
                && self.read(model, register).await? != expected
            {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Finds a known chip by its address and product number. An unknown chip at one address does not end the search for a known
    /// chip.
    ///
    /// # Errors
    /// No chip answers, only unknown chips answer, or the bus fails.
    pub async fn find(&mut self) -> Result<Model, Error<B::Error>> {
        let mut reason = Error::Absent;
        for model in Model::ALL {
            match self.product(model).await {
                Ok(found) if found == model.product() => return Ok(model),
                Ok(found) => reason = Error::Identity { model, found },
                Err(error) if matches!(error.kind(), ErrorKind::NoAcknowledge(_)) => {}
                Err(error) => return Err(error.into()),
            }
        }
        Err(reason)
    }

    async fn product(&mut self, model: Model) -> Result<u16, B::Error> {
        let register = model.product_register();
        let high = self.read(model, register).await?;
        let low = self.read(model, register + 1).await?;
        Ok(u16::from_be_bytes([high, low]))
    }

    async fn write(&mut self, model: Model, register: u16, value: u8) -> Result<(), B::Error> {
        let [high, low] = register.to_be_bytes();
        match model {
            Model::Ov7670 => self.bus.write(model.address(), &[low, value]).await,
            Model::Ov5640 => self.bus.write(model.address(), &[high, low, value]).await,
        }
    }

    async fn read(&mut self, model: Model, register: u16) -> Result<u8, B::Error> {
        let [high, low] = register.to_be_bytes();
        match model {
            Model::Ov7670 => self.bus.write(model.address(), &[low]).await?,
            Model::Ov5640 => self.bus.write(model.address(), &[high, low]).await?,
        }
        let mut value = [0];
        self.bus.read(model.address(), &mut value).await?;
        Ok(value[0])
    }
}
