//! Windows, readings and thresholds of the evaluation.

use std::path::Path;

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::choices::{CycleChoice, Modulus, Sides, SlopeMethod, Sweeps, in_gf_per_cm, round};
use crate::finding::{Place, TomlError, TomlFile, array, arrays};
use crate::kes::TENSILE;
use crate::kes::Test;
use crate::kes::specimen::{
    BENDING_READINGS, BENDING_SLOPE, COMPRESSION_START, DEGREE, GF_PER_CM, SHEAR_READINGS, SHEAR_SLOPE,
    SURFACE_LENGTH, TENSILE_SLOPE,
};
use crate::quantity::{Angle, Curvature, Length, LineForce, Pressure, Ratio, STANDARD_GRAVITY};

/// Why settings cannot be used.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("{place}: the settings cannot be used: {reason}")]
pub struct SettingsError {
    /// File, and position of the key or value.
    pub place: Place,
    /// What was found, and what is expected.
    pub reason: String,
}

impl From<TomlError> for SettingsError {
    fn from(TomlError { place, message }: TomlError) -> Self {
        Self { place, reason: message }
    }
}

/// Everything in the evaluation that a laboratory may do differently. The defaults are the
/// customary ones (Kawabata's standard conditions); they are printed beside every sheet.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct Settings {
    /// Angles between which G is fitted, on both sides (0.5 to 2.5 deg; the literature also uses 0.5 to 5 deg).
    #[serde(deserialize_with = "array")]
    pub shear_slope: [Angle; 2],
    /// How the slopes of G, B and the tensile tangents are taken over their windows.
    pub slope_method: SlopeMethod,
    /// Sides of the loop that G, B and the loop widths are taken from (the mean of both).
    pub sides: Sides,
    /// Force at which the tensile parameters are read, in the place of the set maximum of the records (500 gf/cm).
    pub tensile_maximum: Option<LineForce>,
    /// Pressure at which Tm and the compression parameters are read, in the place of the set maximum of the records
    /// (50 gf/cm²).
    pub compression_maximum: Option<Pressure>,
    /// Angles at which 2HG and 2HG5 are read (0.5 and 5 deg).
    #[serde(deserialize_with = "array")]
    pub shear_readings: [Angle; 2],
    /// Whether the part of the constant tension, W tan φ, is taken off the shear force (off: published G contain it).
    pub tension_correction: bool,
    /// Curvatures between which B is fitted, on both sides (0.5 to 1.5 1/cm).
    #[serde(deserialize_with = "array")]
    pub bending_slope: [Curvature; 2],
    /// Curvatures at which 2HB and 2HB05 are read (1.0 and 0.5 1/cm).
    #[serde(deserialize_with = "array")]
    pub bending_readings: [Curvature; 2],
    /// Forces between which the modulus `tangent_low` is fitted (5 to 20 gf/cm).
    #[serde(deserialize_with = "array")]
    pub tangent_low: [LineForce; 2],
    /// The moduli that are evaluated.
    pub moduli: Vec<Modulus>,
    /// Maximum tensile force behind a published EMT or LT that comes without conditions (500 gf/cm).
    pub table_maximum: LineForce,
    /// Pressure at which thickness counts as begun: T0 (0.5 gf/cm²).
    pub compression_start: Pressure,
    /// Length, in the middle of each sweep, that MIU, MMD and SMD are means over (2 cm).
    pub surface_length: Length,
    /// Sweeps that MIU, MMD and SMD are taken from (the mean of forth and back).
    pub surface_sweeps: Sweeps,
    /// Which cycle the parameters are taken from.
    pub cycle: CycleChoice,
    /// Force at which a FAB strip counts as under load: its strain zero (1 gf/cm).
    pub strip_onset: LineForce,
    /// Forces between which tangents of FAB strips are taken, beside `tangent_low` (2 to 5, 20 to 100 gf/cm).
    #[serde(deserialize_with = "arrays")]
    pub strip_windows: Vec<[LineForce; 2]>,
    /// Force at which the secant of FAB strips is taken (100 gf/cm).
    pub strip_secant: LineForce,
    /// Force at which G is taken from a FAB bias strip (5 gf/cm, as EB5 of FAST).
    pub strip_shear: LineForce,
    /// Span of the load in a FAB bend test below which it is called low: the load cell's noise of
    /// 0.05 to 0.15 gf over 5 cm is then more than a tenth of it (0.2 gf/cm).
    pub strip_low_load: LineForce,
    /// Whether zero, offset and slack are corrected.
    pub correct_zero: bool,
    /// A drive reversal counts when it is longer than this part of the range of the abscissa; less is jitter.
    pub reversal: Ratio,
    /// A zero or slack correction larger than this part of the maximum is reported.
    pub large_correction: Ratio,
    /// Difference between the fitted and the two-point slope that is reported.
    pub slope_difference: Ratio,
    /// Difference between the observed and the set maximum that is reported.
    pub maximum_difference: Ratio,
    /// Noise, as a part of the range of the ordinate, that is reported.
    pub noise: Ratio,
    /// Difference of G between warp and weft that is reported.
    pub shear_difference: Ratio,
    /// Deviation from the median below which a repeat is never called an outlier by its MAD.
    pub outlier_floor: Ratio,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            shear_slope: SHEAR_SLOPE.map(Angle),
            slope_method: SlopeMethod::Regression,
            sides: Sides::Both,
            tensile_maximum: None,
            compression_maximum: None,
            shear_readings: SHEAR_READINGS.map(Angle),
            tension_correction: false,
            bending_slope: BENDING_SLOPE.map(Curvature),
            bending_readings: BENDING_READINGS.map(Curvature),
            tangent_low: TENSILE_SLOPE.map(LineForce),
            moduli: vec![Modulus::TangentLow, Modulus::Secant, Modulus::Energy],
            table_maximum: LineForce(TENSILE.maximum),
            compression_start: Pressure(COMPRESSION_START),
            surface_length: Length(SURFACE_LENGTH),
            surface_sweeps: Sweeps::Both,
            cycle: CycleChoice::First,
            strip_onset: LineForce(GF_PER_CM),
            strip_windows: [[2.0, 5.0], [20.0, 100.0]].map(|w| w.map(|f| LineForce(f * GF_PER_CM))).to_vec(),
            strip_secant: LineForce(100.0 * GF_PER_CM),
            strip_shear: LineForce(5.0 * GF_PER_CM),
            strip_low_load: LineForce(0.2 * GF_PER_CM),
            correct_zero: true,
            reversal: Ratio(0.05),
            large_correction: Ratio(0.10),
            slope_difference: Ratio(0.05),
            maximum_difference: Ratio(0.02),
            noise: Ratio(0.01),
            shear_difference: Ratio(0.15),
            outlier_floor: Ratio(0.10),
        }
    }
}

impl Settings {
    /// Parses the text of a settings file; `path` names it in messages.
    ///
    /// # Errors
    /// What cannot be used, at its key or value.
    pub fn parse(path: &Path, text: &str) -> Result<Self, SettingsError> {
        let file = TomlFile::parse(path, text)?;
        let settings: Self = file.root().read()?;
        match settings.contradiction() {
            None => Ok(settings),
            Some((key, why)) => Err(SettingsError {
                place: file.root().value_place(key),
                reason: format!("`{key}` cannot be used: {why}"),
            }),
        }
    }

    /// What no evaluation can be made with, if anything: the key of a window that does not rise, or of a threshold that
    /// is not positive, and why.
    fn contradiction(&self) -> Option<(&'static str, &'static str)> {
        let window = |key, [a, b]: [f64; 2]| (key, a >= 0.0 && a < b, "a window has to rise from 0 or more");
        let above = |key, values: &[f64]| (key, values.iter().all(|v| *v > 0.0), "it has to be above 0");
        let part = |key, r: Ratio| (key, (0.0..1.0).contains(&r.si()), "a part is 0 to 100 %");
        let windows = [
            window("shear_slope", self.shear_slope.map(Angle::si)),
            window("bending_slope", self.bending_slope.map(Curvature::si)),
            window("tangent_low", self.tangent_low.map(LineForce::si)),
        ];
        let strips = self.strip_windows.iter().map(|w| window("strip_windows", w.map(LineForce::si)));
        let readings = [
            above("shear_readings", &self.shear_readings.map(Angle::si)),
            above("bending_readings", &self.bending_readings.map(Curvature::si)),
            above("table_maximum", &[self.table_maximum.si()]),
            above("tensile_maximum", &self.tensile_maximum.map_or(vec![], |f| vec![f.si()])),
            above("compression_maximum", &self.compression_maximum.map_or(vec![], |p| vec![p.si()])),
            above("compression_start", &[self.compression_start.si()]),
            above("surface_length", &[self.surface_length.si()]),
            above("strip_onset", &[self.strip_onset.si()]),
            above("strip_secant", &[self.strip_secant.si()]),
            above("strip_shear", &[self.strip_shear.si()]),
            above("strip_low_load", &[self.strip_low_load.si()]),
            above("reversal", &[self.reversal.si()]),
        ];
        let parts = [
            part("reversal", self.reversal),
            part("large_correction", self.large_correction),
            part("slope_difference", self.slope_difference),
            part("maximum_difference", self.maximum_difference),
            part("noise", self.noise),
            part("shear_difference", self.shear_difference),
            part("outlier_floor", self.outlier_floor),
        ];
        let (key, _, why) =
            windows.into_iter().chain(strips).chain(readings).chain(parts).find(|(_, fits, _)| !fits)?;
        Some((key, why))
    }

    /// The maximum of a test that stands in the place of what its records state (SI).
    pub(super) fn maximum(&self, test: Test) -> Option<f64> {
        match test {
            Test::Tensile => self.tensile_maximum.map(LineForce::si),
            Test::Compression => self.compression_maximum.map(Pressure::si),
            _ => None,
        }
    }

    /// The maximum of a test that tables hold values of: that of the instrument, unless it can be set here (SI).
    pub(super) fn maximum_of_tables(&self, test: Test) -> f64 {
        match test {
            Test::Tensile => self.table_maximum.si(),
            _ => test.spec().maximum,
        }
    }

    /// The abscissae (SI) between which the slope of a test is taken: G of shear, B of bending; none of the others.
    pub fn slope_window(&self, test: Test) -> Option<[f64; 2]> {
        match test {
            Test::Shear => Some(self.shear_slope.map(Angle::si)),
            Test::Bending => Some(self.bending_slope.map(Curvature::si)),
            _ => None,
        }
    }

    /// Name and value of each setting that enters a parameter, in KES units, for printing beside a result.
    pub fn describe(&self) -> Vec<(&'static str, String)> {
        let degrees = |a: Angle| format!("{} deg", round(a.si() / DEGREE));
        let per_cm = |k: Curvature| format!("{} 1/cm", round(k.si() / 100.0));
        let range = |a: String, b: String| format!("{a} .. {b}");
        let [g0, g1] = self.shear_slope.map(degrees);
        let [h0, h1] = self.shear_readings.map(degrees);
        let [b0, b1] = self.bending_slope.map(per_cm);
        let [r0, r1] = self.bending_readings.map(per_cm);
        let [t0, t1] = self.tangent_low.map(in_gf_per_cm);
        let per_cm2 = |p: Pressure| format!("{} gf/cm²", round(p.si() / (STANDARD_GRAVITY * 10.0)));
        let stated = || "the set maximum of the record".to_string();
        let sides = match self.sides {
            Sides::Both => "mean of both sides",
            Sides::Positive => "positive side only",
            Sides::Negative => "negative side only",
        };
        let sweeps = match self.surface_sweeps {
            Sweeps::Both => "mean of the sweeps forth and back",
            Sweeps::Forth => "sweep forth only",
            Sweeps::Back => "sweep back only",
        };
        let method = match self.slope_method {
            SlopeMethod::Regression => "regression over the window",
            SlopeMethod::TwoPoint => "the ends of the window",
        };
        vec![
            ("G fitted over", range(g0, g1)),
            ("2HG, 2HG5 read at", format!("{h0}, {h1}")),
            ("W tan(phi) taken off the shear force", yes_no(self.tension_correction)),
            ("B fitted over", range(b0, b1)),
            ("2HB, 2HB05 read at", format!("{r0}, {r1}")),
            ("tangent_low fitted over", range(t0, t1)),
            ("slopes by", method.to_string()),
            ("G, B and loop widths from", sides.to_string()),
            ("tensile parameters read at", self.tensile_maximum.map_or_else(stated, in_gf_per_cm)),
            ("T0 read at", per_cm2(self.compression_start)),
            ("Tm read at", self.compression_maximum.map_or_else(stated, per_cm2)),
            (
                "MIU, MMD, SMD over",
                format!("the middle {} cm of a sweep", round(100.0 * self.surface_length.si())),
            ),
            ("MIU, MMD, SMD from", sweeps.to_string()),
            ("cycle", if self.cycle == CycleChoice::First { "first" } else { "last" }.to_string()),
            ("zero, offset and slack corrected", yes_no(self.correct_zero)),
            (
                "FAB strips: onset of load, G, secant at",
                [self.strip_onset, self.strip_shear, self.strip_secant].map(in_gf_per_cm).join(", "),
            ),
        ]
    }
}

fn yes_no(flag: bool) -> String {
    if flag { "yes" } else { "no" }.to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quantity::QuantityError;

    #[test]
    fn settings_are_read_from_toml_with_units_and_unknown_keys_are_refused() {
        let s: Settings = toml::from_str(
            "shear_slope = [\"0.5 deg\", \"5 deg\"]\ntension_correction = true\ncycle = \"last\"\n\
             moduli = [\"secant\", \"window(20 gf/cm, 100 gf/cm)\"]",
        )
        .unwrap();
        assert!((s.shear_slope[1].si() - 5.0 * DEGREE).abs() < 1e-15);
        assert_eq!(s.cycle, CycleChoice::Last);
        assert_eq!(s.moduli[1].name(), "window(20 gf/cm, 100 gf/cm)");
        assert_eq!(s.bending_slope, Settings::default().bending_slope);
        assert!(toml::from_str::<Settings>("shear_window = 3").is_err());
        assert!(toml::from_str::<Settings>("noise = 0.1").is_err(), "a bare number is refused");
    }

    #[test]
    fn values_that_no_evaluation_can_use_are_refused_by_name() {
        let wrong = |line: &str| Settings::parse(Path::new("s.toml"), line).unwrap_err().to_string();
        for (line, key) in [
            ("reversal = \"-1 %\"", "`reversal`"),
            ("reversal = \"0 %\"", "`reversal`"),
            ("table_maximum = \"0 gf/cm\"", "`table_maximum`"),
            ("shear_slope = [\"1 deg\", \"1 deg\"]", "`shear_slope`"),
            ("tangent_low = [\"20 gf/cm\", \"5 gf/cm\"]", "`tangent_low`"),
            ("compression_start = \"-1 gf/cm²\"", "`compression_start`"),
            ("strip_windows = [[\"5 gf/cm\", \"2 gf/cm\"]]", "`strip_windows`"),
        ] {
            assert!(wrong(line).contains(key), "{line}: {}", wrong(line));
        }
        let place = |text: &str| {
            let error = Settings::parse(Path::new("s.toml"), text).unwrap_err();
            (error.place.line, error.place.column)
        };
        assert_eq!(place("noise = \"1 %\"\nreversal = \"-1 %\""), (2, 12));
        assert_eq!(place("noise = \"1 %\"\nshear_window = 1"), (2, 1));
        assert_eq!(Settings::default().contradiction(), None);
        assert!(matches!("window(100 gf/cm, 20 gf/cm)".parse::<Modulus>(), Err(QuantityError::Order { .. })));
    }

    #[test]
    fn the_defaults_print_in_kes_units() {
        let text: Vec<_> =
            Settings::default().describe().into_iter().map(|(k, v)| format!("{k}: {v}")).collect();
        assert!(text.contains(&"G fitted over: 0.5 deg .. 2.5 deg".to_string()), "{text:?}");
        assert!(text.contains(&"B fitted over: 0.5 1/cm .. 1.5 1/cm".to_string()), "{text:?}");
        assert!(text.contains(&"T0 read at: 0.5 gf/cm²".to_string()), "{text:?}");
    }
}
