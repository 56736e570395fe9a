//! How far a value of the sheet can be relied on, as its findings tell.

use std::path::Path;

use super::FabricSheet;
use crate::finding::{EvaluationFact, Fact, Finding, Place, ReadFact};
use crate::instrument::Test;
use crate::kes::{Direction, Key, Parameter, RecordName, ValueStatus};

/// What a finding speaks of.
enum Scope<'a> {
    /// One value.
    Value(Key),
    /// Several values.
    Values(&'a [Key]),
    /// Every value of a record's test and direction.
    Record(&'a RecordName),
    /// Every value of the tests and directions of several records.
    Records(&'a [RecordName]),
    /// One parameter of a record.
    OfRecord(&'a RecordName, Parameter),
    /// A slope of a record by the name of its fit.
    Slope(&'a RecordName, &'a str),
    /// Every value of a test.
    Test(Test),
    /// Every value that a file gave.
    File(&'a Path),
    /// What the records of compression of a file, from a line on, give that depends on the zero of the travel.
    Travel(&'a Place),
    /// Every value of a direction.
    Direction(Direction),
    /// The tensile moduli.
    Moduli,
}

/// Part of a loop width that noise may leave uncertain.
const SCATTER: f64 = 0.05;

/// What depends on the zero of a travel that is read as a thickness.
const OF_TRAVEL: [Parameter; 3] = [Parameter::T0, Parameter::Tm, Parameter::Emc];

/// What a finding says of a value, and its code.
type Remark = (ValueStatus, &'static str);

/// The status that prevails.
fn prevailing(remarks: &[Remark]) -> ValueStatus {
    remarks.iter().map(|(status, _)| *status).max().unwrap_or_default()
}

/// Codes of what gave the status that prevails, each once.
fn codes(remarks: &[Remark]) -> Vec<&'static str> {
    let status = prevailing(remarks);
    let mut codes: Vec<&str> =
        remarks.iter().filter(|(of, _)| *of == status).map(|(_, code)| *code).collect();
    codes.sort_unstable();
    codes.dedup();
    codes
}

/// Says of each value how it was had. The findings must be complete, and the specimens still there.
pub(super) fn assign(sheet: &mut FabricSheet) {
    let of_values = |key: &Key| (*key, sheet.status_of_value(*key));
    let statuses = sheet.values.keys().map(of_values).collect();
    let of_moduli = |key: &(String, Direction)| (key.clone(), sheet.status_of_modulus(&key.0, key.1));
    let modulus_statuses = sheet.moduli.keys().map(of_moduli).collect();
    (sheet.statuses, sheet.modulus_statuses) = (statuses, modulus_statuses);
}

impl FabricSheet {
    /// How the value of a parameter was had.
    pub fn status(&self, key: Key) -> ValueStatus {
        self.statuses.get(&key).copied().unwrap_or_default()
    }

    /// How a tensile modulus was had.
    pub fn modulus_status(&self, name: &str, direction: Direction) -> ValueStatus {
        self.modulus_statuses.get(&(name.to_string(), direction)).copied().unwrap_or_default()
    }

    /// Codes of the findings that gave the value of a parameter its status.
    pub fn causes(&self, key: Key) -> Vec<&'static str> {
        codes(&self.remarks_on_value(key))
    }

    /// Codes of the findings that gave a tensile modulus its status.
    pub fn modulus_causes(&self, name: &str, direction: Direction) -> Vec<&'static str> {
        codes(&self.remarks_on_modulus(name, direction))
    }

    fn status_of_value(&self, key: Key) -> ValueStatus {
        prevailing(&self.remarks_on_value(key))
    }

    fn status_of_modulus(&self, name: &str, direction: Direction) -> ValueStatus {
        prevailing(&self.remarks_on_modulus(name, direction))
    }

    fn remarks_on_value(&self, key: Key) -> Vec<Remark> {
        self.remarks_on(|scope| match scope {
            Scope::Value(of) => *of == key,
            Scope::Values(of) => of.contains(&key),
            Scope::Record(record) => is_of_record(key, record),
            Scope::Records(records) => records.iter().any(|record| is_of_record(key, record)),
            Scope::OfRecord(record, parameter) => key.parameter == *parameter && is_of_record(key, record),
            Scope::Slope(record, name) => is_of_record(key, record) && is_slope(key.parameter, name),
            Scope::Test(test) => key.parameter.test() == Some(*test),
            Scope::File(path) => {
                self.is_of_file(key.parameter.test(), key.direction, path) || self.is_of_table(key, path)
            }
            Scope::Travel(headings) => OF_TRAVEL.contains(&key.parameter) && self.is_of_travel(key, headings),
            Scope::Direction(direction) => key.direction == Some(*direction),
            Scope::Moduli => false,
        })
    }

    fn remarks_on_modulus(&self, name: &str, direction: Direction) -> Vec<Remark> {
        let is_tensile = |record: &RecordName| {
            record.test == Test::Tensile && record.direction.is_none_or(|of| of == direction)
        };
        self.remarks_on(|scope| match scope {
            // Secant and energy modulus follow from them.
            Scope::Value(of) => self.gives_modulus(*of, direction),
            Scope::Values(of) => of.iter().any(|of| self.gives_modulus(*of, direction)),
            Scope::Record(record) => is_tensile(record),
            Scope::Records(records) => records.iter().any(is_tensile),
            Scope::OfRecord(..) => false,
            Scope::Slope(record, slope) => is_tensile(record) && *slope == name,
            Scope::Test(test) => *test == Test::Tensile,
            Scope::File(path) => self.is_of_file(Some(Test::Tensile), Some(direction), path),
            Scope::Travel(_) => false,
            Scope::Direction(of) => *of == direction,
            Scope::Moduli => true,
        })
    }

    /// Whether a value of a table is one that the moduli follow from.
    fn gives_modulus(&self, of: Key, direction: Direction) -> bool {
        matches!(of.parameter, Parameter::Emt | Parameter::Lt | Parameter::Wt)
            && of.direction.is_none_or(|of| of == direction)
            && !self.specimens.iter().any(|s| s.measurement.test == Test::Tensile)
    }

    fn remarks_on(&self, concerns: impl Fn(&Scope<'_>) -> bool) -> Vec<Remark> {
        let remark = |finding: &Finding| {
            let (scope, status) = scope_and_status(finding)?;
            concerns(&scope).then(|| (status, finding.code()))
        };
        self.findings.iter().filter_map(remark).collect()
    }

    fn is_of_table(&self, key: Key, path: &Path) -> bool {
        self.table_files.get(&key).is_some_and(|files| files.contains(path))
    }

    /// Whether the record below these headings gave the value: what another record or a table gave is not of it.
    fn is_of_travel(&self, key: Key, headings: &Place) -> bool {
        let of_file = self.specimens.iter().filter(|s| {
            let m = &s.measurement;
            m.test == Test::Compression
                && is_within(&headings.path, &m.source.path)
                && m.place().line > headings.line
        });
        let first = of_file.clone().map(|s| s.measurement.place().line).min();
        of_file
            .filter(|s| Some(s.measurement.place().line) == first)
            .any(|s| s.values.contains_key(&key.parameter))
    }

    fn is_of_file(&self, test: Option<Test>, direction: Option<Direction>, path: &Path) -> bool {
        self.specimens.iter().map(|s| &s.measurement).any(|m| {
            is_within(path, &m.source.path)
                && Some(m.test) == test
                && (direction.is_none() || m.direction.is_none() || m.direction == direction)
        })
    }
}

/// Whether a place is in a file: the sheets of a workbook and the files of an archive are, `book.xlsx[warp]`.
fn is_within(place: &Path, file: &Path) -> bool {
    let (place, file) = (place.to_string_lossy(), file.to_string_lossy());
    place.strip_prefix(&*file).is_some_and(|rest| rest.is_empty() || rest.starts_with('['))
}

fn is_of_record(key: Key, record: &RecordName) -> bool {
    let same = |of| key.direction.is_none_or(|direction| direction == of);
    key.parameter.test() == Some(record.test) && record.direction.is_none_or(same)
}

/// Whether a parameter is the slope of a name, or the mean of slopes.
fn is_slope(parameter: Parameter, name: &str) -> bool {
    match parameter {
        Parameter::B => matches!(name, "Bf" | "Bb"),
        Parameter::G => matches!(name, "G+" | "G-"),
        other => other.symbol() == name,
    }
}

/// What a finding says of values; nothing where it concerns none.
fn scope_and_status(finding: &Finding) -> Option<(Scope<'_>, ValueStatus)> {
    match &finding.fact {
        Fact::Evaluation(fact) => of_evaluation(fact),
        Fact::Reading(fact) => of_reading(fact, finding.place.as_ref()),
        _ => None,
    }
}

fn of_evaluation(fact: &EvaluationFact) -> Option<(Scope<'_>, ValueStatus)> {
    use EvaluationFact as F;
    use ValueStatus::{Assumed, Doubtful, Inferred};
    let value = |parameter, direction| Scope::Value(Key { parameter, direction });
    Some(match fact {
        F::SlopesDiffer { record, slope, .. } | F::FewSamples { record, slope, .. } => {
            (Scope::Slope(record, slope), Doubtful)
        }
        F::NarrowedWindow { record, slope, .. } => (Scope::Slope(record, slope), Inferred),
        F::Drift { record, .. } => (Scope::Record(record), Doubtful),
        F::NoisyWidth { record, parameter, left, .. } if *left > SCATTER => {
            (Scope::OfRecord(record, *parameter), Doubtful)
        }
        F::ForceLeft { record, .. } => (Scope::OfRecord(record, Parameter::Rt), Doubtful),
        F::OneSide { record, parameter } => (Scope::OfRecord(record, *parameter), Doubtful),
        F::ShortOfMaximum { record, .. }
        | F::BeyondMaximum { record, .. }
        | F::LargeCorrection { record, .. }
        | F::BeginsUnderLoad { record, .. }
        | F::PressureBelowZero { record, .. }
        | F::Noise { record, .. }
        | F::SeveralCycles { record, .. }
        | F::Clipped { record, .. }
        | F::Jump { record, .. } => (Scope::Record(record), Doubtful),
        F::ConditionsDiffer { test, .. } => (Scope::Test(*test), Doubtful),
        F::SameRecord { record, .. } => (Scope::Test(record.test), Doubtful),
        F::StandsApart { key, .. }
        | F::NoRepeats { key, .. }
        | F::Implausible { key, .. }
        | F::StatedDiffers { key, .. }
        | F::TableDiffers { key, .. } => (Scope::Value(*key), Doubtful),
        F::NotTogether { keys, .. } => (Scope::Values(keys), Doubtful),
        F::OtherDirection { parameter, own, .. } => (value(*parameter, Some(*own)), Doubtful),
        F::ShearDiffers { .. } => (Scope::Test(Test::Shear), Doubtful),
        F::OtherThickness { .. } => (value(Parameter::T0, None), Doubtful),
        F::StatedStatus { key, status } => (Scope::Value(*key), *status),
        F::BuckledStrips { direction, .. } => (value(Parameter::B, Some(*direction)), Inferred),
        F::BendLoopLaw { keys, .. } => (Scope::Values(keys), Inferred),
        F::LowLoad { direction, .. } => (value(Parameter::B, Some(*direction)), Doubtful),
        F::BiasStrip { .. } => (value(Parameter::G, None), Inferred),
        F::FabThickness { .. } => (value(Parameter::T0, None), Inferred),
        F::ModuliOfTable { .. } | F::StatedStiffness { .. } => (Scope::Moduli, Inferred),
        F::StatedThickness {} => (value(Parameter::T0, None), Assumed),
        F::NoisyWidth { .. }
        | F::NotEvaluated { .. }
        | F::Missing { .. }
        | F::NoDirection { .. }
        | F::NoArealDensity {}
        | F::NumberTwice { .. }
        | F::NotNumbers { .. }
        | F::ModuliOfStrips { .. }
        | F::AssumedSpectrum { .. }
        | F::NoLaw { .. }
        | F::NoLoopOfValues { .. }
        | F::Dropout { .. }
        | F::Copy { .. } => return None,
    })
}

fn of_reading<'a>(fact: &'a ReadFact, place: Option<&'a Place>) -> Option<(Scope<'a>, ValueStatus)> {
    let file = || place.map(|place| Scope::File(&place.path));
    match fact {
        ReadFact::AssumedDimension { .. } | ReadFact::AssumedUnits { .. } => {
            Some((file()?, ValueStatus::Assumed))
        }
        ReadFact::SeveralSamples { records, .. } => Some((Scope::Records(records), ValueStatus::Doubtful)),
        ReadFact::ColumnsAsSpecimens { .. }
        | ReadFact::TwoDirections { .. }
        | ReadFact::StatedTwice { .. }
        | ReadFact::StatedFactor { .. } => Some((file()?, ValueStatus::Doubtful)),
        ReadFact::MoreThanDirection { direction, .. } => {
            Some((Scope::Direction(*direction), ValueStatus::Doubtful))
        }
        ReadFact::RecordsOfStates { record, .. } => Some((Scope::Record(record), ValueStatus::Doubtful)),
        ReadFact::BranchesJoined { record, .. } => Some((Scope::Record(record), ValueStatus::Inferred)),
        ReadFact::TravelAsThickness { .. } => Some((Scope::Travel(place?), ValueStatus::Assumed)),
        ReadFact::SeveralTables { keys, .. }
        | ReadFact::NumbersAsSpecimens { keys }
        | ReadFact::WithoutDirection { keys }
        | ReadFact::ColumnOfStates { keys, .. } => Some((Scope::Values(keys), ValueStatus::Doubtful)),
        _ => None,
    }
}
