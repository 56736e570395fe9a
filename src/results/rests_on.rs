//! What a simulated value rests on that is not to be relied on: a constant of the section that nobody measured, or a
//! measured value that a finding speaks against.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use super::sheet_text;
use super::task::Task;
use crate::characterise::ValueStatus;
use crate::constitutive::{InputSource, MeasuredInput, SectionDerivative, law_inputs};
use crate::finding::{Fact, SectionFact};
use crate::instrument::{Parameter, Test};
use crate::quantity::Estimate;
use crate::study::Prediction;

/// Status of a value that a finding speaks against.
pub(super) const DOUBTFUL: &str = "doubtful";

/// What a strip under its own weight rests on, before the direction.
pub(super) const OF_STRIP: &str = "strip";

/// The same of cloth that rubs while it bends.
pub(super) const OF_STRIP_WITH_FRICTION: &str = "strip_friction";

/// An input shows in a result that changes by more than this part of itself when the input changes by its own size.
const SHOWS: f64 = 0.05;

/// Something that a value rests on and that is not to be relied on.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Ground {
    /// `measured` of what was measured, but of warp and weft together, or along one of them alone.
    pub(super) status: ValueStatus,
    /// `an assumed E`.
    pub(super) text: Cow<'static, str>,
}

impl Ground {
    fn new(input: &MeasuredInput) -> Option<Self> {
        let name = match input.source {
            // One value for warp and weft.
            InputSource::Tensile => "E",
            _ => &input.name,
        };
        let article = if name.starts_with(['E', 'a']) { "an" } else { "a" };
        let text = match input.status {
            ValueStatus::Doubtful => format!("a doubtful {name}"),
            ValueStatus::Assumed if input.estimate.n == 0 => format!("an assumed {name}"),
            ValueStatus::Assumed => format!("{article} {name} that rests on an assumption"),
            ValueStatus::Inferred => format!("an inferred {name}"),
            ValueStatus::Measured if name == "B" => "one B for warp and weft".into(),
            ValueStatus::Measured => return None,
        };
        Some(Self { status: input.status, text: text.into() })
    }
}

/// What the fabric of a task was made of: the inputs of its section, and what its laws with friction have beside them.
pub(super) fn known(task: &Task) -> Vec<MeasuredInput> {
    let made = task.section().ok().and_then(|(_, made)| made);
    let mut facts = made.iter().flat_map(|made| &made.findings).map(|finding| &finding.fact);
    let has_assumed_width = facts.any(|fact| matches!(fact, Fact::Section(SectionFact::NoHysteresis { .. })));
    let mut inputs = made.map_or_else(Vec::new, |made| made.inputs);
    if has_assumed_width {
        inputs.push(MeasuredInput {
            name: Parameter::Hb.symbol().into(),
            estimate: Estimate::stand_in(f64::NAN),
            status: ValueStatus::Assumed,
            source: InputSource::Document,
            derivative: SectionDerivative::default(),
        });
    }
    // A section that nobody's measurements are known of has no others beside it.
    let Some(sheet) = task.fabric.filter(|_| !inputs.is_empty() || !task.case.needs_section()) else {
        return inputs;
    };
    for parameter in [Parameter::Hb, Parameter::Hg, Parameter::Wt, Parameter::W] {
        for law in law_inputs(sheet, parameter) {
            let is_known = inputs.iter().any(|input| input.name == law.name || is_of(input, &law.name));
            if !is_known {
                inputs.push(law);
            }
        }
    }
    inputs
}

/// `an assumed E`, `a doubtful B warp`; nothing for a value of `quantity` that rests on measured values alone.
pub(super) fn grounds(inputs: &[MeasuredInput], quantity: &str) -> Vec<Ground> {
    let (_, direction) = quantity.split_once(' ').unwrap_or_default();
    let symbols = symbols(quantity);
    let mut grounds = of_inputs(symbols.iter().flat_map(|symbol| along(inputs, symbol, direction)));
    if symbols.contains(&"G") {
        grounds.extend(shear_of_the_other(inputs, direction));
    }
    grounds
}

/// `G of the warp alone`, for what is said of the weft: the plate has one shear modulus, be it measured along one direction.
fn shear_of_the_other(inputs: &[MeasuredInput], direction: &str) -> Option<Ground> {
    let mut measured = inputs.iter().filter_map(|input| input.name.strip_prefix("G "));
    let only = measured.next().filter(|along| !direction.is_empty() && *along != direction)?;
    measured
        .next()
        .is_none()
        .then(|| Ground { status: ValueStatus::Measured, text: format!("G of the {only} alone").into() })
}

/// The same of results that rest on these constants, in every direction: `E`, `G`, `B` and `W`.
pub(super) fn of_symbols(inputs: &[MeasuredInput], symbols: &[&str]) -> Vec<Ground> {
    of_inputs(symbols.iter().flat_map(|symbol| along(inputs, symbol, "")))
}

/// The same of a linear result, by what it changes with.
pub(super) fn of_prediction(inputs: &[MeasuredInput], prediction: &Prediction) -> Vec<Ground> {
    let least = SHOWS * prediction.value.abs();
    let shown = inputs.iter().zip(&prediction.derivatives).filter(|(_, derivative)| derivative.abs() > least);
    let with_others = shown.flat_map(|(input, _)| match input.name.split_once(' ') {
        // What stands for a direction was measured along the other one.
        Some((symbol, direction)) if input.estimate.n == 0 => along(inputs, symbol, direction),
        _ => vec![input],
    });
    of_inputs(with_others)
}

fn of_inputs<'i>(inputs: impl Iterator<Item = &'i MeasuredInput>) -> Vec<Ground> {
    each_once(inputs.filter_map(Ground::new))
}

/// Grounds of several quantities.
pub(super) fn each_once(all: impl IntoIterator<Item = Ground>) -> Vec<Ground> {
    let mut grounds: Vec<Ground> = Vec::new();
    for ground in all {
        if !grounds.contains(&ground) {
            grounds.push(ground);
        }
    }
    grounds
}

/// `rests on an assumed E and a doubtful B warp`; nothing without grounds.
pub(super) fn remark(grounds: &[Ground]) -> Option<String> {
    (!grounds.is_empty()).then(|| format!("rests on {}", joined(grounds)))
}

/// `Rests on an assumed E.`, for charts; nothing where all was measured, be it of warp and weft together.
pub(super) fn warning(grounds: &[Ground]) -> Option<String> {
    let weak: Vec<&Ground> = grounds.iter().filter(|g| g.status != ValueStatus::Measured).collect();
    (!weak.is_empty()).then(|| format!("Rests on {}.", joined(weak)))
}

/// What stands behind a value of a table that rests on them; nothing where all was measured.
pub(super) fn mark(grounds: &[Ground]) -> String {
    sheet_text::mark(status(grounds))
}

/// What `mark` means.
pub(super) const LEGEND: &str = "? rests on what is doubtful, * on an assumption, ~ on what was inferred";

/// `an assumed E and a doubtful B warp`.
pub(super) fn joined<'g>(grounds: impl IntoIterator<Item = &'g Ground>) -> String {
    let texts: Vec<&str> = grounds.into_iter().map(|ground| &*ground.text).collect();
    match &texts[..] {
        [first @ .., before, last] => [first, &[&format!("{before} and {last}")]].concat().join(", "),
        _ => texts.concat(),
    }
}

/// The status that prevails among them.
pub(super) fn status(grounds: &[Ground]) -> ValueStatus {
    grounds.iter().map(|ground| ground.status).max().unwrap_or_default()
}

/// The inputs of a symbol in a direction (any, if it is empty) or of the fabric as a whole. One that stands for another was measured
/// there.
fn along<'i>(inputs: &'i [MeasuredInput], symbol: &str, direction: &str) -> Vec<&'i MeasuredInput> {
    let of_symbol: Vec<_> = inputs.iter().filter(|input| is_of(input, symbol)).collect();
    let is_along = |input: &&MeasuredInput| {
        let along = input.name.split_once(' ').map_or("", |(_, along)| along);
        // Both tests of shear measure one constant, the mean of which is used.
        ["G", "W"].contains(&symbol) || along.is_empty() || direction.is_empty() || along == direction
    };
    let stands_in = of_symbol.iter().filter(|input| is_along(input)).any(|input| input.estimate.n == 0);
    of_symbol.into_iter().filter(|input| stands_in || is_along(input)).collect()
}

fn is_of(input: &MeasuredInput, symbol: &str) -> bool {
    match symbol {
        "W" => ["areal density", "W"].contains(&input.name.as_str()),
        _ => input.name.split(' ').next() == Some(symbol),
    }
}

/// Symbols of the inputs that a predicted quantity shows most of.
fn symbols(quantity: &str) -> Vec<&'static str> {
    let name = quantity.split(' ').next().unwrap_or_default();
    let parameter = Parameter::from_symbol(name);
    let test = if name == "E" { Some(Test::Tensile) } else { parameter.and_then(Parameter::test) };
    let of_test = test.and_then(|test| test.spec().stiffness.as_ref()).map(|shown| shown.symbol);
    match (of_test, parameter) {
        // The width of a loop with friction, and the work of tension, are inputs beside the stiffness.
        (Some(stiffness), Some(Parameter::Hb | Parameter::Hb05)) => vec![stiffness, "2HB"],
        (Some(stiffness), Some(Parameter::Hg | Parameter::Hg5)) => vec![stiffness, "2HG"],
        (Some(stiffness), Some(Parameter::Wt | Parameter::Rt | Parameter::Lt | Parameter::Emt)) => {
            vec![stiffness, "WT"]
        }
        (Some(stiffness), _) => vec![stiffness],
        (None, _) if test.is_some() => Vec::new(),
        (None, _) if name == OF_STRIP => vec!["B", "W"],
        (None, _) if name == OF_STRIP_WITH_FRICTION => vec!["B", "2HB", "W"],
        // Loops of strips that find a rigidity of their own, against the weight of the strip.
        (None, _) if name.starts_with("fab_") => vec!["W"],
        (None, _) => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::characterise::Key;
    use crate::instrument::Direction;

    fn input(name: &str, status: ValueStatus, estimate: Estimate) -> MeasuredInput {
        let key = Key { parameter: Parameter::B, direction: Some(Direction::Warp) };
        MeasuredInput {
            name: name.into(),
            estimate,
            status,
            source: InputSource::Value(key),
            derivative: SectionDerivative::default(),
        }
    }

    fn measured(name: &str, status: ValueStatus) -> MeasuredInput {
        input(name, status, Estimate::single(1.0))
    }

    fn stand_in(name: &str) -> MeasuredInput {
        input(name, ValueStatus::Assumed, Estimate::stand_in(1.0))
    }

    fn inputs() -> Vec<MeasuredInput> {
        let e = |name| MeasuredInput { source: InputSource::Tensile, ..stand_in(name) };
        vec![
            e("E warp"),
            e("E weft"),
            measured("B warp", ValueStatus::Doubtful),
            measured("B weft", ValueStatus::Measured),
            measured("areal density", ValueStatus::Measured),
            measured("2HB weft", ValueStatus::Inferred),
        ]
    }

    fn said(inputs: &[MeasuredInput], quantity: &str) -> String {
        let remark = remark(&grounds(inputs, quantity)).unwrap_or_default();
        remark.trim_start_matches("rests on ").to_string()
    }

    #[test]
    fn what_is_doubtful_or_assumed_goes_on_to_what_is_predicted() {
        let inputs = inputs();
        let remark = |quantity: &str| said(&inputs, quantity);
        let status = |quantity: &str| super::status(&grounds(&inputs, quantity));
        assert_eq!((status("B warp"), status("B weft")), (ValueStatus::Doubtful, ValueStatus::Measured));
        let drape = of_symbols(&inputs, &["E", "G", "B", "W"]);
        assert_eq!((status("E warp"), super::status(&drape)), (ValueStatus::Assumed, ValueStatus::Doubtful));
        assert_eq!(remark("strip warp"), "a doubtful B warp");
        assert_eq!(remark("strip weft"), "");
        assert_eq!(remark("E warp"), "an assumed E");
        assert_eq!(remark("2HB weft"), "an inferred 2HB weft");
        assert_eq!(joined(&drape), "an assumed E and a doubtful B warp");
        assert_eq!(remark("strip_friction weft"), "an inferred 2HB weft");
        assert_eq!((remark("G warp"), remark("T0")), (String::new(), String::new()));
        assert_eq!(super::remark(&of_symbols(&inputs, &["B"])).unwrap(), "rests on a doubtful B warp");
    }

    #[test]
    fn a_weight_that_nobody_weighed_is_told_of_what_it_moves() {
        let inputs = [measured("B warp", ValueStatus::Measured), stand_in("areal density")];
        assert_eq!(said(&inputs, "strip warp"), "an assumed areal density");
        let prediction = |derivatives: [f64; 2]| Prediction {
            quantity: "w_max".into(),
            unit: "m",
            value: -2.0,
            derivatives: derivatives.to_vec(),
            bands: None,
            without_spread: Vec::new(),
            repeats: None,
        };
        assert_eq!(joined(&of_prediction(&inputs, &prediction([2.0, -2.0]))), "an assumed areal density");
        assert!(of_prediction(&inputs, &prediction([2.0, 1e-3])).is_empty());
    }

    #[test]
    fn a_result_on_a_stand_in_rests_on_what_was_measured_along_the_other_direction_too() {
        let inputs = [measured("B warp", ValueStatus::Doubtful), stand_in("B weft")];
        let along_weft = Prediction {
            quantity: "w_max".into(),
            unit: "m",
            value: 1.0,
            derivatives: vec![0.0, -1.0],
            bands: None,
            without_spread: Vec::new(),
            repeats: None,
        };
        let said = joined(&of_prediction(&inputs, &along_weft));
        assert_eq!(said, "a doubtful B warp and an assumed B weft");
    }

    #[test]
    fn widths_of_loops_rest_on_the_width_that_was_measured() {
        let inputs = [measured("B warp", ValueStatus::Measured), measured("2HB warp", ValueStatus::Doubtful)];
        for quantity in ["2HB warp", "2HB05 warp"] {
            assert_eq!(said(&inputs, quantity), "a doubtful 2HB warp", "{quantity}");
        }
        assert_eq!(said(&inputs, "B warp"), "");
        let three = [stand_in("G"), stand_in("B warp"), stand_in("areal density")];
        assert_eq!(
            joined(&of_symbols(&three, &["G", "B", "W"])),
            "an assumed G, an assumed B warp and an assumed areal density"
        );
    }

    #[test]
    fn shear_of_one_direction_is_told_where_the_other_is_predicted() {
        let warp = measured("G warp", ValueStatus::Measured);
        let remark = |inputs: &[MeasuredInput], quantity: &str| said(inputs, quantity);
        let one = [warp.clone()];
        assert_eq!(remark(&one, "G weft"), "G of the warp alone");
        assert_eq!(status(&grounds(&one, "G weft")), ValueStatus::Measured);
        assert_eq!((remark(&one, "G warp"), remark(&one, "B weft")), (String::new(), String::new()));
        let both = [warp, measured("G weft", ValueStatus::Measured)];
        assert_eq!(remark(&both, "G weft"), "");
    }

    /// A sheet with tests of the warp alone: what is said of the weft rests on them.
    #[test]
    fn one_direction_that_stands_for_both_is_no_measurement_of_the_other() {
        let inputs = [
            measured("E warp", ValueStatus::Measured),
            stand_in("E weft"),
            measured("B warp", ValueStatus::Doubtful),
            stand_in("B weft"),
        ];
        let remark = |quantity: &str| said(&inputs, quantity);
        assert_eq!((remark("E warp"), remark("E weft")), (String::new(), "an assumed E weft".into()));
        assert_eq!(remark("strip warp"), "a doubtful B warp");
        assert_eq!(remark("strip weft"), "a doubtful B warp and an assumed B weft");
        assert_eq!(said(&[measured("B", ValueStatus::Measured)], "strip warp"), "one B for warp and weft");
    }
}
