//! A fabric on the page.

use super::fabric::FabricReport;
use super::failure::Failure;
use super::page_predictions::others;
use super::page_section::PageSection;
use super::page_values::tests;
use crate::finding::{Fact, Finding, StudyFact};
use crate::instrument::Parameter;
use crate::quantity::repeats_text;
use crate::report::html::{Block, Figure, POINTS};
use crate::report::number::{mean_and_spread, unit_text};
use crate::report::table::{FabricRow, UnitSystem};

/// Above the parameters of a fabric.
const PARAMETERS: &str =
    "Parameters: mean ± SD over n repeats. Where a table does not state the number of repeats, n is 1.";

/// The part of the page about a fabric: what is known of it, its values, tests, curves, pictures and findings.
pub(super) fn fabric_block(place: usize, report: &FabricReport) -> Block {
    let mut blocks: Vec<Block> = failures(report).into_iter().collect();
    blocks.extend(facts(report));
    blocks.extend(values(report));
    blocks.extend(tests(report));
    blocks.extend(others(report));
    blocks.extend(report.section.as_ref().map(PageSection::block));
    let (drawn, pictures): (Vec<Figure>, Vec<Figure>) =
        report.figures.iter().cloned().partition(|figure| is_drawn(report, figure));
    if !report.curves.is_empty() {
        blocks.push(Block::Curves(place));
        blocks.push(Block::Text(format!(
            "Curves: corrected records, at most {POINTS} points a branch (Ramer-Douglas-Peucker), five digits; \
             parameters and pictures rest on all samples, which `kesf read` writes."
        )));
    }
    if !report.shapes.is_empty() || report.sheets_too_large > 0 {
        blocks.push(Block::Shapes(place));
    }
    if !drawn.is_empty() {
        blocks.push(Block::Text("The same as pictures for print:".into()));
        blocks.push(Block::Files(drawn.into_iter().map(|figure| figure.picture).collect()));
    }
    // What a laboratory measures leads, plates come last.
    let (first, last): (Vec<Figure>, Vec<Figure>) = pictures.into_iter().partition(|figure| {
        let is_linear = |(case, _): &(String, f64)| is_named(figure, case);
        !report.relative_deflections.iter().any(is_linear)
    });
    blocks.extend(figures_block(first.into_iter().chain(last).collect()));
    let findings: Vec<_> = report.findings.iter().filter(|f| !is_beyond_linear(f)).cloned().collect();
    if !findings.is_empty() {
        blocks.push(Block::Findings(findings));
    }
    Block::Fabric { name: report.name.clone(), about: report.about.clone(), blocks }
}

/// A linear solve beyond its meaning: it holds of cloth as such, and is said once in the batch.
fn is_beyond_linear(finding: &Finding) -> bool {
    matches!(finding.fact, Fact::Study(StudyFact::BeyondLinear { .. }))
}

/// Pictures beside each other; nothing where there are none.
pub(super) fn figures_block(figures: Vec<Figure>) -> Option<Block> {
    (!figures.is_empty()).then_some(Block::Figures(figures))
}

/// Whether the script draws the same from records: charts of tests, and of simulated tests on them.
fn is_drawn(report: &FabricReport, figure: &Figure) -> bool {
    report.curves.iter().filter(|curves| !curves.specimens.is_empty()).any(|curves| {
        is_named(figure, &curves.test) || curves.simulated.iter().any(|line| is_named(figure, &line.case))
    })
}

/// Whether the picture is the chart `<fabric>/<stem>`.
fn is_named(figure: &Figure, stem: &str) -> bool {
    figure
        .picture
        .rsplit('/')
        .next()
        .and_then(|file| file.rsplit_once('.'))
        .is_some_and(|(name, _)| name == stem)
}

/// What could not be read of the fabric, and what could not be made of it.
fn failures(report: &FabricReport) -> Option<Block> {
    let rows: Vec<_> = report.unread.iter().chain(&report.failures).map(Failure::row).collect();
    (!rows.is_empty()).then_some(Block::Failures(rows))
}

/// What `fabric.toml` says of it.
fn facts(report: &FabricReport) -> Option<Block> {
    let info = report.info.as_ref()?;
    let stated = [
        ("Weave", info.weave.clone()),
        ("Composition", info.composition.clone()),
        ("Climate of the tests", info.climate.clone()),
        ("Source", info.source.clone()),
    ];
    let origin = ("Origin".to_string(), format!("{} data", info.origin.name()));
    let stated = stated.into_iter().filter_map(|(name, text)| Some((name.to_string(), text?)));
    let results = info.results.iter().map(|r| (format!("Measured {}", r.name()), r.text()));
    let notes = info.notes.iter().map(|note| ("Note".to_string(), note.clone()));
    Some(Block::Facts(std::iter::once(origin).chain(stated).chain(results).chain(notes).collect()))
}

/// Its parameters, one a line.
fn values(report: &FabricReport) -> Option<Block> {
    let rows: Vec<_> = report.rows.iter().filter_map(value_row).collect();
    let header = ["parameter", "mean ± SD", "n", "unit", "status"].map(String::from).to_vec();
    (!rows.is_empty()).then(|| Block::Units { caption: PARAMETERS.into(), header, rows })
}

fn value_row(row: &FabricRow) -> Option<Vec<[String; 2]>> {
    let mean = row.mean.filter(|_| row.is_of_parameter())?;
    let parameter = Parameter::from_symbol(&row.parameter);
    let units = [UnitSystem::Kes, UnitSystem::Si]
        .map(|system| parameter.map_or(system.of_modulus(), |parameter| system.of(parameter)));
    let same = |text: String| [text.clone(), text];
    let direction = row.direction.as_deref().map_or(String::new(), |direction| format!(" {direction}"));
    Some(vec![
        same(format!("{}{direction}", row.parameter)),
        units.map(|(_, factor)| mean_and_spread(mean / factor, row.sd.map(|sd| sd / factor))),
        same(repeats_text(row.n, row.sd)),
        units.map(|(unit, _)| unit_text(unit)),
        same(row.status.clone()),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::instrument::{FabricInfo, MeasuredResult, Origin};

    #[test]
    fn pictures_that_the_script_draws_are_links() {
        let sheet = crate::characterise::FabricSheet { name: "a".into(), ..Default::default() };
        let curves = crate::results::page_curves::curves(&sheet, &[]);
        assert!(curves.is_empty(), "nothing was recorded");
        let figures = vec![Figure { picture: "a/bending.png".into(), ..Figure::default() }];
        let report = FabricReport { name: "a".into(), figures, ..FabricReport::default() };
        let Block::Fabric { blocks, .. } = fabric_block(0, &report) else { panic!("a fabric") };
        assert!(matches!(blocks.as_slice(), [Block::Figures(_)]), "{blocks:?}");
    }

    #[test]
    fn what_is_known_of_a_fabric_stands_first() {
        let info = FabricInfo {
            climate: Some("20 °C, 65 % RH".into()),
            origin: Origin::Published,
            notes: vec!["no spread".into()],
            results: vec![MeasuredResult {
                quantity: "drape_coefficient".into(),
                value: "82.9 %".into(),
                method: "Cusick drape".into(),
                direction: None,
            }],
            ..FabricInfo::default()
        };
        let row = FabricRow { parameter: "T0".into(), mean: Some(2.5e-4), n: 1, ..FabricRow::default() };
        let report = FabricReport {
            info: Some(info),
            rows: vec![row],
            unread: vec![Failure::new("R009", "unknown unit")],
            ..FabricReport::default()
        };
        let Block::Fabric { blocks, .. } = fabric_block(0, &report) else { panic!("a fabric") };
        let [Block::Failures(failed), Block::Facts(facts), Block::Units { rows, .. }] = &blocks[..] else {
            panic!("{blocks:?}")
        };
        assert_eq!(failed[0].code, "R009");
        let named: Vec<&str> = facts.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(named, ["Origin", "Climate of the tests", "Measured drape coefficient", "Note"]);
        assert_eq!(facts[2].1, "82.9 % (Cusick drape)");
        assert_eq!(rows[0][1], ["0.25", "2.5 × 10⁻⁴"]);
    }
}
