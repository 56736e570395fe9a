//! How loads and supports go in time, as a case writes it.

use std::f64::consts::TAU;

use crate::quantity::{Frequency, Time, counts_angles};
use crate::solve::newmark::LoadHistory;

/// A history as it is written, or why it is none.
pub(super) fn load_history(text: &str) -> Result<LoadHistory, String> {
    let history = if text == "step" {
        Ok(LoadHistory::Step)
    } else if text == "off" {
        Ok(LoadHistory::Off)
    } else if let Some(until) = text.strip_prefix("ramp until ") {
        let end = until.parse::<Time>().map_err(|e| e.to_string());
        end.and_then(|end| above_zero(end.si())).map(LoadHistory::Ramp)
    } else if let Some(frequency) = text.strip_prefix("sine ") {
        // In rad/s it is an angular frequency.
        let turn = if counts_angles(frequency) { TAU } else { 1.0 };
        let hertz = frequency.parse::<Frequency>().map_err(|e| e.to_string());
        hertz.and_then(|f| above_zero(f.si() / turn)).map(LoadHistory::Sine)
    } else {
        Err("no such history".into())
    };
    history.map_err(|reason| {
        format!("load = \"{text}\": {reason}; write \"step\", \"ramp until 0.1 s\", \"sine 5 Hz\" or \"off\"")
    })
}

fn above_zero(value: f64) -> Result<f64, String> {
    if value > 0.0 { Ok(value) } else { Err(format!("{value} is not above 0")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_angular_frequency_is_no_frequency_in_hertz() {
        let sine = |text: &str| match load_history(text) {
            Ok(LoadHistory::Sine(hertz)) => hertz,
            other => panic!("{other:?}"),
        };
        assert_eq!(sine("sine 5 Hz"), 5.0);
        for one in ["sine 6.283185307179586 rad/s", "sine 360 deg/s", "sine 60 1/min"] {
            assert!((sine(one) - 1.0).abs() < 1e-12, "{one}");
        }
        assert!(load_history("sine 0 rad/s").is_err());
    }
}
