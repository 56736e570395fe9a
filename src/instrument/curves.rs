//! Column pairs to measurements: which test it is, its conditions, and SI.

use super::axis::Axes;
use super::column_values::Samples;
use super::content::FileContent;
use super::context::Context;
use super::dialect::{HeaderKey, Role};
use super::error::{ReadError, ReadProblem};
use super::header_value::{positive, quantity, quantity_by, quantity_of};
use super::inference;
use super::label::SPECIMENS;
use super::layout::{Header, Pair};
use super::means;
use super::raw::Row;
use super::specimen_size::{gauge, length_of, size};
use super::unit_text;
use super::words::folded;
use super::{Conditions, Direction, Measurement, Parameter, ResultValue, Shape, Source, Test};
use crate::finding::{Fact, Finding, Place, ReadFact};
use crate::kes::ValueStatus;
use crate::quantity::{ArealDensity, Curve, Force, LineForce};

/// Reads the curves of a record into `content`.
///
/// # Errors
/// Those of its columns and header lines; R002 where no column has a value.
pub(super) fn add(
    pairs: &[Pair],
    rows: &[&Row<'_>],
    ends_file: bool,
    context: &Context<'_>,
    content: &mut FileContent,
) -> Result<(), ReadError> {
    let before = content.measurements.len();
    for pair in pairs {
        let read = measurement(pair, rows, ends_file, context, &mut content.inference)?;
        if let Some((measurement, findings)) = read {
            content.measurements.push(measurement);
            // What was assumed for one column was assumed for all: that is said once.
            for finding in findings {
                let assumed = matches!(finding.fact, Fact::Reading(ReadFact::AssumedDimension { .. }));
                if !(assumed && content.findings.iter().any(|k| k.fact == finding.fact)) {
                    content.findings.push(finding);
                }
            }
        }
        weight(&pair.header, context, content)?;
    }
    if content.measurements.len() == before {
        let (line, column) = pairs.first().map_or((0, 0), |p| (p.x.line, p.x.column));
        return Err(context.error(line, column, ReadProblem::Empty));
    }
    Ok(())
}

/// An areal density in the header of a curve file is a result value of its own.
fn weight(header: &Header, context: &Context<'_>, content: &mut FileContent) -> Result<(), ReadError> {
    let Some(entry) = header.known.get(&HeaderKey::Weight) else { return Ok(()) };
    let value: ArealDensity = quantity(entry, "weight", "mg/cm²", context)?;
    let known = |(_, v): &(Option<String>, ResultValue)| v.parameter == Parameter::W && v.mean == value.si();
    if !content.results.iter().any(known) {
        let place = Place::at(context.path, entry.line, entry.column);
        let result = ResultValue {
            parameter: Parameter::W,
            direction: None,
            mean: value.si(),
            sd: None,
            n: 1,
            values: Vec::new(),
            lines: Vec::new(),
            status: ValueStatus::Measured,
            place,
        };
        content.results.push((None, result));
    }
    Ok(())
}

/// The measurement of one column pair, with what was noticed on the way; `None` if the pair holds
/// no value at all (an empty column block).
fn measurement(
    pair: &Pair,
    rows: &[&Row<'_>],
    ends_file: bool,
    context: &Context<'_>,
    log: &mut Vec<String>,
) -> Result<Option<(Measurement, Vec<Finding>)>, ReadError> {
    let (test, why) = test_of(pair, context)?;
    log.push(format!("columns {:?} and {:?}: {} test, {why}", pair.x.name, pair.y.name, test.name()));
    let header = &pair.header;
    let mut conditions = conditions(test, header, context, log)?;
    let axes = Axes { test, conditions: &conditions, header, context };
    let (x_axis, y_axis) = (axes.of(&pair.x, true)?, axes.of(&pair.y, false)?);
    let (x, y) = (x_axis.scale, y_axis.scale);
    log.push(format!(
        "{}: {}, {}",
        test.name(),
        inference::scaled(&pair.x, x, test.axes()[0]),
        inference::scaled(&pair.y, y, test.axes()[1])
    ));
    let mut points = points(pair, rows, ends_file, context)?;
    if let Some((bx, by)) = &pair.back {
        let back = Pair { x: bx.clone(), y: by.clone(), back: None, header: header.clone() };
        points.join(self::points(&back, rows, ends_file, context)?);
        log.push(format!("{:?} and {:?} are the branches of one curve", pair.y.name, by.name));
    }
    if points.rows.is_empty() {
        return Ok(None);
    }
    if points.rows.len() < 3 {
        let problem = ReadProblem::TooShort { points: points.rows.len() };
        return Err(context.error(points.rows[0].0, pair.x.column, problem));
    }
    let direction = if test.is_directional() { Some(direction(pair, context)?) } else { None };
    let mut findings = points.findings;
    findings
        .extend([(&pair.x, x_axis), (&pair.y, y_axis)].into_iter().flat_map(|(c, a)| axes.assumptions(c, a)));
    if test == Test::Compression && pair.x.role == Role::Displacement {
        let fact = ReadFact::TravelAsThickness { column: pair.x.name.clone() };
        findings.push(Finding::new(fact).at(Place::at(context.path, pair.x.line, pair.x.column)));
    }
    if direction.is_some() && !header.known.contains_key(&HeaderKey::Direction) {
        let place = Place::at(context.path, pair.x.line, 0);
        findings.push(Finding::new(ReadFact::DirectionFromName {}).at(place));
    }
    if let (Some(stated), Some(named)) = (direction, context.label.direction)
        && stated != named
    {
        let fact = ReadFact::TwoDirections { header: stated, file_name: named };
        findings.push(Finding::new(fact).at(Place::at(context.path, pair.x.line, 0)));
    }
    let mut curve = Curve::from_points(points.rows.iter().map(|&(_, a, b)| (x.apply(a), y.apply(b))));
    if is_opposite(test, &curve) {
        curve.y.iter_mut().for_each(|v| *v = 0.0 - *v);
        let fact = ReadFact::SignTurned { ordinate: pair.y.name.clone(), abscissa: pair.x.name.clone() };
        findings.push(Finding::new(fact).at(Place::at(context.path, pair.y.line, 0)));
    }
    // A width of 1e-300 m or a range of 1e300 V is no slip that any number survives.
    if let Some(i) = curve.points().position(|(x, y)| !(x.is_finite() && y.is_finite())) {
        let found = format!("{} or {} in SI", points.rows[i].1, points.rows[i].2);
        return Err(context.error(points.rows[i].0, pair.x.column, ReadProblem::NotFinite { found }));
    }
    if is_peak(test, header, conditions.maximum, &curve) {
        conditions.maximum = context.conditions.over_standard(test).maximum;
        log.push("the stated maximum is the peak of the record: it is no setting".to_string());
    }
    if bare_force(header).is_some() && (peak(test, &curve) / conditions.maximum - 1.0).abs() > OFF_SETTING {
        conditions.maximum = context.conditions.over_standard(test).maximum;
        log.push(
            "the stated maximum is a force, and not where the record ends: it is that of the load cell"
                .to_string(),
        );
    }
    let specimen = specimen(header, context)?;
    log.push(inference::curve(test, direction, specimen, pair, context, &points.rows));
    let measurement = Measurement {
        test,
        sample: header
            .known
            .get(&HeaderKey::Sample)
            .map(|e| e.text.clone())
            .or_else(|| context.label.sample.clone()),
        direction,
        // 0 stands for "not stated" until the whole file is known.
        specimen: specimen.unwrap_or(0),
        conditions,
        curve,
        lines: points.rows.iter().map(|p| p.0).collect(),
        source: Source::default(),
        metadata: header.other.clone(),
        caption: mean_of_specimens(header, context).or_else(|| header.caption.clone()),
    };
    Ok(Some((measurement, findings)))
}

/// The test that two columns and the header agree on, and what decided it.
fn test_of(pair: &Pair, context: &Context<'_>) -> Result<(Test, &'static str), ReadError> {
    let header = pair.header.known.get(&HeaderKey::Test);
    let stated = header.and_then(|e| context.vocabulary.test(&e.text));
    let elsewhere = context.label.test.or(context.dialect.and_then(|d| d.test));
    let unclear = |found: String| {
        let (line, column) = header.map_or((pair.x.line, pair.x.column), |e| (e.line, e.column));
        context.error(line, column, ReadProblem::TestUnclear { found })
    };
    let columns = match (Test::of_abscissa(pair.x.role), Test::of_ordinate(pair.y.role)) {
        (Some(a), Some(b)) if a != b => {
            let found = format!(
                "columns {:?} and {:?} belong to different tests ({} and {})",
                pair.x.name,
                pair.y.name,
                a.name(),
                b.name()
            );
            return Err(context.error(pair.x.line, pair.x.column, ReadProblem::IncompletePair { found }));
        }
        (a, b) => a.or(b),
    };
    match (columns, stated.or(elsewhere)) {
        // One file of KES-FB4 has both.
        (Some(c), Some(s)) if c != s && [c, s].iter().any(|t| t.shape() != Shape::Sweep) => {
            Err(unclear(format!(
                "the columns {:?} and {:?} are those of a {} test, but {} is stated",
                pair.x.name,
                pair.y.name,
                c.name(),
                s.name()
            )))
        }
        (Some(test), Some(_)) => Ok((test, "as the columns say and the file states")),
        (Some(test), None) => Ok((test, "which the columns belong to")),
        (None, Some(test)) => Ok((test, "as stated: the columns occur in several tests")),
        (None, None) => Err(unclear(format!(
            "columns {:?} and {:?} occur in several tests, and the file does not say which",
            pair.x.name, pair.y.name
        ))),
    }
}

fn direction(pair: &Pair, context: &Context<'_>) -> Result<Direction, ReadError> {
    match pair.header.known.get(&HeaderKey::Direction) {
        Some(entry) => context.vocabulary.direction(&entry.text).ok_or_else(|| {
            let reason = format!("{:?} is not a direction (warp, weft or bias)", entry.text);
            context.error(entry.line, entry.column, ReadProblem::BadValue { key: "direction".into(), reason })
        }),
        None => {
            if let Some([a, b]) = context.label.conflict {
                let reason = format!("the name of the file says {a} and {b}, and the header says nothing");
                let problem = ReadProblem::BadValue { key: "direction".into(), reason };
                return Err(context.error(pair.x.line, pair.x.column, problem));
            }
            if context.label.across {
                let error = across_in_name();
                return Err(context.error(pair.x.line, pair.x.column, error));
            }
            let named = context.label.direction;
            named.ok_or_else(|| context.error(pair.x.line, pair.x.column, ReadProblem::DirectionMissing))
        }
    }
}

/// R013: what is across the warp of an oblique strip is not said, and no direction is guessed from it.
pub(super) fn across_in_name() -> ReadProblem {
    let reason =
        "the name of the file or sheet says that it is across a direction: state the direction in the header";
    ReadProblem::BadValue { key: "direction".into(), reason: reason.to_string() }
}

/// Points from which the sign of a slope is told.
const SLOPE_POINTS: usize = 16;
/// Correlation of ordinate and abscissa from which it is told. Loops of cloth reach 0.9 unless friction is most of them.
const SLOPE: f64 = 0.9;

/// Whether the ordinate is counted the other way round: cloth resists, so that moment and shear force rise with curvature
/// and angle, and tension and pressure are not negative throughout.
fn is_opposite(test: Test, curve: &Curve) -> bool {
    match test.shape() {
        Shape::Loop => {
            let n = curve.len() as f64;
            let (mx, my) = (curve.x.iter().sum::<f64>() / n, curve.y.iter().sum::<f64>() / n);
            let sum = |f: fn(f64, f64) -> f64| curve.points().map(|(x, y)| f(x - mx, y - my)).sum::<f64>();
            let (xy, xx, yy) = (sum(|a, b| a * b), sum(|a, _| a * a), sum(|_, b| b * b));
            // A loop that is all hysteresis has no slope to tell, and neither have a few points.
            curve.len() >= SLOPE_POINTS && xy < -SLOPE * (xx * yy).sqrt()
        }
        // Forth and back, friction is of one sign and the other.
        Shape::Sweep => false,
        Shape::Rise => {
            let low = curve.y.iter().copied().fold(f64::INFINITY, f64::min);
            let high = curve.y.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            low < 0.0 && high < 0.05 * low.abs()
        }
    }
}

fn specimen(header: &Header, context: &Context<'_>) -> Result<Option<usize>, ReadError> {
    let Some(entry) = header.known.get(&HeaderKey::Specimen) else { return Ok(context.label.specimen) };
    if means::names_mean(&entry.text, context.vocabulary) {
        return Ok(None);
    }
    let digits: String =
        entry.text.chars().skip_while(|c| !c.is_ascii_digit()).take_while(char::is_ascii_digit).collect();
    if digits.trim_start_matches('0').is_empty() {
        let reason = format!("{:?} is not a specimen number (1, 2, 3 ...)", entry.text);
        let problem = ReadProblem::BadValue { key: "specimen".into(), reason };
        return Err(context.error(entry.line, entry.column, problem));
    }
    // A longer number is that of an order or a date: specimens are then counted in file order.
    Ok(digits.parse().ok().filter(|n| *n < SPECIMENS))
}

/// `Specimen,Mean`: the record is called after the mean, and is one beside others.
fn mean_of_specimens(header: &Header, context: &Context<'_>) -> Option<String> {
    let text = &header.known.get(&HeaderKey::Specimen)?.text;
    means::names_mean(text, context.vocabulary).then(|| text.clone())
}

/// Conditions: the header, else what was stated elsewhere, else the standard set.
fn conditions(
    test: Test,
    header: &Header,
    context: &Context<'_>,
    log: &mut Vec<String>,
) -> Result<Conditions, ReadError> {
    let mut c = context.conditions.over_standard(test);
    if let Some((width, gauge)) = size(test, header, context) {
        c.width = width;
        c.gauge = gauge.filter(|_| test.spec().gauge != 0.0).unwrap_or(c.gauge);
    }
    if let Some(width) = length_of(header, HeaderKey::Width, "width", context)? {
        c.width = width;
    }
    c.gauge = gauge(test, header, c.width, context)?.unwrap_or(c.gauge);
    if let Some(force) = bare_force(header) {
        // What a load cell can bear says nothing of a test that ends at a curvature or an angle.
        if test == Test::Tensile {
            c.maximum = positive(force / c.width, HeaderKey::Maximum, header, context)?;
        }
    } else if let Some(m) = maximum(test, header, context)? {
        c.maximum = positive(m.abs(), HeaderKey::Maximum, header, context)?;
    }
    if test.spec().pretension > 0.0
        && let Some(w) =
            quantity_of::<LineForce>(header, HeaderKey::Pretension, "pretension", "gf/cm", context)?
    {
        c.pretension = w.si();
    }
    if test.spec().contact > 0.0
        && let Some(load) = quantity_of::<Force>(header, HeaderKey::Contact, "contact load", "gf", context)?
    {
        c.contact = positive(load.si(), HeaderKey::Contact, header, context)?;
    }
    for (what, file, elsewhere) in inference::contradictions(test, &c, &context.conditions) {
        context.take_of_file(format!("the {what}"), &file, &elsewhere);
    }
    log.push(inference::conditions(test, &c, header));
    let unknown: Vec<&str> =
        header.other.keys().map(String::as_str).filter(|k| context.vocabulary.key(k).is_none()).collect();
    if !unknown.is_empty() {
        log.push(format!("header lines that no dialect knows, kept as text: {}", unknown.join(", ")));
    }
    Ok(c)
}

/// The stated maximum as a force (SI), `Maximum load: 10 kgf`, whatever the test.
fn bare_force(header: &Header) -> Option<f64> {
    let entry = header.known.get(&HeaderKey::Maximum)?;
    folded(&entry.text).parse::<Force>().ok().map(Force::si)
}

/// The stated maximum of the driven axis (SI).
fn maximum(test: Test, header: &Header, context: &Context<'_>) -> Result<Option<f64>, ReadError> {
    let Some(entry) = header.known.get(&HeaderKey::Maximum) else { return Ok(None) };
    quantity_by(test.spec().read_maximum, entry, "maximum", test.kes_maximum(), context).map(Some)
}

/// Samples on each side of one without an ordinate that say where it must lie.
const BESIDE: usize = 3;

/// Part of a maximum by which a printed peak may differ from it, and a round number from its value in other units.
const PRINTED: f64 = 1e-3;

/// Part of a maximum stated as a force by which the record may end elsewhere.
const OFF_SETTING: f64 = 0.1;

/// The largest value of the driven axis.
fn peak(test: Test, curve: &Curve) -> f64 {
    let values = if test.shape() == Shape::Rise { &curve.y } else { &curve.x };
    values.iter().fold(0.0f64, |peak, v| peak.max(v.abs()))
}

/// Whether a stated maximum is the peak of this record that a program printed: it is what the record reaches, and no round
/// number as those that are set.
fn is_peak(test: Test, header: &Header, stated: f64, curve: &Curve) -> bool {
    let peak = peak(test, curve);
    let text = header.known.get(&HeaderKey::Maximum).map_or(String::new(), |e| folded(&e.text).into_owned());
    let start = text.trim_start_matches(|c: char| !c.is_ascii_digit());
    let number: String = start.chars().take_while(|c| c.is_ascii_digit() || *c == '.').collect();
    let customary = unit_text::unit(test.kes_maximum()).map_or(f64::NAN, |u| stated / u.factor);
    let is_set = is_round(customary) || number.parse().is_ok_and(is_round);
    header.known.contains_key(&HeaderKey::Maximum) && !is_set && (peak / stated - 1.0).abs() <= PRINTED
}

/// Whether two digits are enough for a number: 500, 50, 2.5, 8.
fn is_round(value: f64) -> bool {
    let unit = 10f64.powf(value.abs().log10().floor() - 1.0);
    ((value / unit).round() * unit / value - 1.0).abs() <= PRINTED
}

struct Points {
    /// Line, abscissa, ordinate, in the units of the file.
    rows: Vec<(usize, f64, f64)>,
    findings: Vec<Finding>,
}

impl Points {
    /// Adds the unloading branch, whichever way round its rows stand: it begins where loading ended.
    fn join(&mut self, mut back: Points) {
        if let (Some(end), Some(first), Some(last)) = (self.rows.last(), back.rows.first(), back.rows.last())
            && (last.1 - end.1).abs() < (first.1 - end.1).abs()
        {
            back.rows.reverse();
        }
        self.rows.append(&mut back.rows);
        self.findings.append(&mut back.findings);
    }
}

/// The numbers of a pair. Rows in which both cells are empty belong to longer neighbours.
fn points(
    pair: &Pair,
    rows: &[&Row<'_>],
    ends_file: bool,
    context: &Context<'_>,
) -> Result<Points, ReadError> {
    let mut out = Points { rows: Vec::with_capacity(rows.len()), findings: Vec::new() };
    let [mut abscissa, mut ordinate] = [&pair.x, &pair.y].map(|column| Samples::new(column, rows, context));
    let (mut samples, mut lacking) = (Vec::with_capacity(rows.len()), Vec::new());
    for (i, row) in rows.iter().enumerate() {
        let cells = [row.get(pair.x.index), row.get(pair.y.index)];
        if cells == [None, None] {
            continue;
        }
        if ends_file && i + 1 == rows.len() && is_cut(cells) {
            out.findings.push(truncated(row, context));
            continue;
        }
        samples.push(*row);
        // A sample without an abscissa is told of once.
        let Some(x) = abscissa.value(row, context)? else { continue };
        match ordinate.value(row, context)? {
            Some(y) => out.rows.push((row.line, x, y)),
            None => lacking.push((out.rows.len(), x)),
        }
    }
    // A number alone below a curve, such as that of the next specimen, is no sample.
    ordinate.gaps_are_real &= lacking.iter().all(|&(at, x)| lies_between(&out.rows, at, x));
    for column in [abscissa, ordinate] {
        out.findings.extend(column.told(&samples, context)?);
    }
    Ok(out)
}

/// Whether an abscissa lies between those of the samples beside it, or next to them where the drive turns.
fn lies_between(samples: &[(usize, f64, f64)], at: usize, x: f64) -> bool {
    let near = &samples[at.saturating_sub(BESIDE)..(at + BESIDE).min(samples.len())];
    let low = near.iter().map(|s| s.1).fold(f64::INFINITY, f64::min);
    let high = near.iter().map(|s| s.1).fold(f64::NEG_INFINITY, f64::max);
    (low - (high - low)..=high + (high - low)).contains(&x)
}

/// Whether a row ends within a sample: before its second number, or behind the sign or the mark of it.
fn is_cut(cells: [Option<&str>; 2]) -> bool {
    match cells {
        [Some(x), Some(y)] => is_bare_sign(y) && !is_bare_sign(x),
        _ => true,
    }
}

fn is_bare_sign(cell: &str) -> bool {
    cell.trim_matches(['+', '-', '.', ',']).is_empty()
}

fn truncated(row: &Row<'_>, context: &Context<'_>) -> Finding {
    Finding::new(ReadFact::RowIncomplete {}).at(Place::at(context.path, row.line, 0))
}
