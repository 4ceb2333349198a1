//! Options for what a flight is up against; shared by `fly` and `campaign`.

use std::path::Path;

use autopilot::app::Quirks;
use clap::{Args, ValueEnum};
use fake_sensors::motion::ScaleSwing;

use crate::scenario::{
    CameraTrouble, Conditions, Correction, LARGEST_SWING, LIGHTS, LensPage, Quirk,
    STRONGEST_WIND_M_S, SWING_PERIODS_S, Wind, WireFault, flow_scale,
};

/// What the flight is up against.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Conditions")]
pub struct ConditionArguments {
    /// Share of the link's bytes, both ways, that arrive as another byte: 0.01 or 1%
    #[arg(long, value_name = "SHARE", default_value = "0", value_parser = parse_share, hide_default_value = true)]
    corrupt: f64,
    /// The autopilot restarts after so many seconds of flight; the drone falls where it is, and the operator starts
    /// it again
    #[arg(long, value_name = "SECONDS", value_parser = parse_time)]
    restart_autopilot: Option<f64>,
    /// A peculiarity of the published flight app that this one is to have as well; repeatable
    #[arg(long = "quirk", value_name = "NAME", value_enum)]
    quirks: Vec<Quirk>,
    /// The flight app has no peculiarity but those named
    #[arg(long)]
    no_quirks: bool,
    /// How firmly the autopilot's filter believes the camera
    #[arg(long, value_enum, default_value_t)]
    correction: Correction,
    /// Wind, m/s, from a direction that the seed draws; after a comma, turbulence as a share of it
    #[arg(long, value_name = "MEAN[,TURBULENCE]", value_parser = parse_wind)]
    wind: Option<Wind>,
    /// All lamps' strength over that of the world's own, from 0.001 to 1000: the firmware's first exposure suits 1
    #[arg(long, value_name = "FACTOR", default_value = "1", value_parser = parse_light, hide_default_value = true)]
    light: f32,
    /// The flow sensor's scale swings in time by this share, with this period
    #[arg(long, value_name = "AMPLITUDE,SECONDS", value_parser = parse_flow_scale)]
    flow_scale: Option<ScaleSwing>,
    /// On the way out a pilot who sees the drone leads it; else it flies the route as its odometry has it
    #[arg(long)]
    pilot: bool,
    /// Something wrong with the camera's wires, from a second of the flight on; after a comma, for how many seconds
    /// [default: 0.5]; the emulated board has wires. NAME: lost-vsync, stuck-vsync, lost-hsync, short-line, extra-bytes,
    /// stopped-clock or unplugged
    #[arg(long, value_name = "NAME@SECOND[,SECONDS]", value_parser = parse_trouble)]
    camera_fault: Option<CameraTrouble>,
    /// The lens record in the board's flash, as `hil calibrate` writes it [default: none]
    #[arg(long, value_name = "FILE", value_parser = parse_lens)]
    lens: Option<LensPage>,
}

impl ConditionArguments {
    /// The conditions that were asked for.
    pub fn conditions(&self) -> Conditions {
        let mut quirks = if self.no_quirks {
            Quirks::NONE
        } else {
            Quirks::default()
        };
        for quirk in &self.quirks {
            *quirk.of(&mut quirks) = true;
        }
        Conditions {
            corrupted_share: self.corrupt,
            restart_s: self.restart_autopilot,
            quirks,
            correction: self.correction,
            wind: self.wind,
            light: self.light,
            flow_scale: self.flow_scale,
            piloted: self.pilot,
            camera: self.camera_fault,
            lens: self.lens,
        }
    }
}

fn parse_share(text: &str) -> Result<f64, String> {
    let (number, unit) = match text.strip_suffix('%') {
        Some(percent) => (percent, 0.01),
        None => (text, 1.0),
    };
    number
        .parse()
        .ok()
        .map(|number: f64| number * unit)
        .filter(|share| (0.0..=1.0).contains(share))
        .ok_or_else(|| "a share from 0 to 1, or from 0% to 100%".to_owned())
}

fn parse_light(text: &str) -> Result<f32, String> {
    text.parse()
        .ok()
        .filter(|factor| LIGHTS.contains(factor))
        .ok_or_else(|| "a factor from 0.001 to 1000".to_owned())
}

fn parse_time(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|seconds: &f64| seconds.is_finite() && *seconds >= 0.0)
        .ok_or_else(|| "a time in seconds from the start of the flight".to_owned())
}

fn parse_trouble(text: &str) -> Result<CameraTrouble, String> {
    let form = || "NAME@SECOND or NAME@SECOND,SECONDS, as in unplugged@100,2".to_owned();
    let (name, times) = text.split_once('@').ok_or_else(form)?;
    let fault = WireFault::from_str(name, false).map_err(|_| {
        let names = WireFault::value_variants().iter();
        let names =
            names.filter_map(|fault| Some(fault.to_possible_value()?.get_name().to_owned()));
        format!(
            "no fault `{name}`: {}",
            names.collect::<Vec<_>>().join(", ")
        )
    })?;
    let (from, time) = times.split_once(',').unwrap_or((times, ""));
    let in_ms = |text: &str| parse_time(text).map(|seconds| (1_000.0 * seconds) as u64);
    let for_ms = match time {
        "" => CameraTrouble::USUAL_MS,
        time => in_ms(time)?,
    };
    Ok(CameraTrouble {
        fault,
        from_ms: in_ms(from)?,
        for_ms,
    })
}

fn parse_lens(text: &str) -> Result<LensPage, String> {
    LensPage::from_file(Path::new(text)).map_err(|error| error.to_string())
}

fn parse_flow_scale(text: &str) -> Result<ScaleSwing, String> {
    let number = |text: &str| text.parse::<f64>().ok();
    let swing = text
        .split_once(',')
        .and_then(|(amplitude, period)| flow_scale(number(amplitude)?, number(period)?));
    swing.ok_or_else(|| {
        let (least, most) = (SWING_PERIODS_S.start(), SWING_PERIODS_S.end());
        format!("an amplitude from 0 to {LARGEST_SWING} and, after a comma, a period from {least} to {most} s: 0.03,60")
    })
}

fn parse_wind(text: &str) -> Result<Wind, String> {
    let (mean, turbulence) = text.split_once(',').unwrap_or((text, "0"));
    let number = |text: &str| text.parse::<f64>().ok();
    let wind = number(mean)
        .zip(number(turbulence))
        .and_then(|(mean_m_s, turbulence)| Wind::new(mean_m_s, turbulence));
    wind.ok_or_else(|| {
        format!(
            "a speed from 0 to {STRONGEST_WIND_M_S} m/s and, after a comma, a turbulence from 0 to 1: 1.5,0.2"
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_share_is_a_number_or_a_percentage() {
        assert_eq!(parse_share("0.01"), Ok(0.01));
        assert_eq!(parse_share("1%"), Ok(0.01));
        for nonsense in ["", "%", "-1%", "101%", "2", "NaN", "one"] {
            assert!(parse_share(nonsense).is_err(), "{nonsense}");
        }
    }

    #[test]
    fn wind_is_a_speed_with_or_without_turbulence() {
        let wind = |mean_m_s, turbulence| {
            Ok(Wind {
                mean_m_s,
                turbulence,
            })
        };
        assert_eq!(parse_wind("1.5"), wind(1.5, 0.0));
        assert_eq!(parse_wind("1.5,0.2"), wind(1.5, 0.2));
        for nonsense in ["", "-1", "1,", "1,2,3", "1,1.5", "99", "NaN"] {
            assert!(parse_wind(nonsense).is_err(), "{nonsense}");
        }
    }
}
