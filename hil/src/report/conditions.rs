//! What a flight was up against, in a line.

use super::number;
use crate::scenario::{Conditions, Correction};

/// All that differs from an undisturbed flight; none where nothing does.
pub fn in_words(conditions: &Conditions) -> Option<String> {
    let usual = Conditions::default();
    let mut words = Vec::new();
    if conditions.corrupted_share > 0.0 {
        let percent = number::trimmed(100.0 * conditions.corrupted_share, 3);
        words.push(format!("{percent} % of the link's bytes corrupted"));
    }
    if let Some(at) = conditions.restart_s {
        words.push(format!(
            "autopilot restarts at {} s",
            number::trimmed(at, 1)
        ));
    }
    if conditions.quirks != usual.quirks {
        words.push(quirks(conditions));
    }
    if conditions.correction == Correction::Soft {
        words.push("soft corrections".into());
    }
    if let Some(wind) = conditions.wind {
        words.push(format!(
            "wind {} m/s, turbulence {} %",
            number::trimmed(wind.mean_m_s, 2),
            number::trimmed(100.0 * wind.turbulence, 1)
        ));
    }
    if conditions.light != usual.light {
        let factor = number::trimmed(conditions.light.into(), 3);
        words.push(format!("light {factor} times the world's own"));
    }
    if let Some(swing) = conditions.flow_scale {
        words.push(format!(
            "scale of the flow sensor swings by {} % in {} s",
            number::trimmed(100.0 * swing.amplitude, 1),
            number::trimmed(swing.period_s, 1)
        ));
    }
    if conditions.piloted {
        words.push("led by a pilot on the way out".into());
    }
    if let Some(trouble) = conditions.camera {
        words.push(format!(
            "camera {} at {} s for {} s",
            trouble.fault,
            number::trimmed(trouble.from_ms as f64 / 1_000.0, 3),
            number::trimmed(trouble.for_ms as f64 / 1_000.0, 3)
        ));
    }
    if conditions.lens.is_some() {
        words.push("a lens record in the flash".into());
    }
    (!words.is_empty()).then(|| words.join(" · "))
}

/// The quirks by their names in the summary.
fn quirks(conditions: &Conditions) -> String {
    let summary = serde_json::to_value(conditions).unwrap_or_default();
    let names = summary["quirks"].as_array().into_iter().flatten();
    let names: Vec<&str> = names.filter_map(|name| name.as_str()).collect();
    if names.is_empty() {
        "a flight app without the published one's quirks".into()
    } else {
        format!("quirks of the flight app: {}", names.join(", "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::{CameraTrouble, LensPage, Wind, WireFault, flow_scale};

    #[test]
    fn an_undisturbed_flight_has_no_conditions() {
        assert_eq!(in_words(&Conditions::default()), None);
    }

    #[test]
    fn each_disturbance_is_named() {
        let conditions = Conditions {
            corrupted_share: 0.01,
            restart_s: Some(40.0),
            correction: Correction::Soft,
            wind: Some(Wind {
                mean_m_s: 1.5,
                turbulence: 0.2,
            }),
            light: 0.05,
            flow_scale: flow_scale(0.03, 60.0),
            piloted: true,
            camera: Some(CameraTrouble {
                fault: WireFault::StuckVsync,
                from_ms: 12_500,
                for_ms: CameraTrouble::USUAL_MS,
            }),
            lens: Some(LensPage::of(&nav::LensCalibration::DEFAULT)),
            ..Conditions::default()
        };
        let words = in_words(&conditions).expect("conditions");
        for part in [
            "1 % of the link's bytes corrupted",
            "autopilot restarts at 40 s",
            "soft corrections",
            "wind 1.5 m/s, turbulence 20 %",
            "light 0.05 times the world's own",
            "scale of the flow sensor swings by 3 % in 60 s",
            "led by a pilot on the way out",
            "a lens record in the flash",
            "camera stuck-vsync at 12.5 s for 0.5 s",
        ] {
            assert!(words.contains(part), "{part}: {words}");
        }
    }

    #[test]
    fn quirks_are_named_where_they_are_not_the_usual_ones() {
        let mut conditions = Conditions::default();
        conditions.quirks.self_acknowledge = !conditions.quirks.self_acknowledge;
        let words = in_words(&conditions).expect("conditions");
        assert!(words.starts_with("quirks of the flight app: "), "{words}");
    }
}
