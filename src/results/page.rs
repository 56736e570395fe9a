//! `index.html` of a folder of results.

use std::collections::BTreeSet;

use super::draped;
use super::fabric::FabricReport;
use super::page_values::{doubtful, leading, plates, tests};
use super::solved::status;
use super::task::Task;
use crate::finding::explain;
use crate::quantity::significant;
use crate::report::html::{
    Block, Figure, POINTS, Page, PageData, Problem, ProblemGroup, Section, local, without_folders,
};
use crate::report::table::{FabricRow, ProblemRow};
use crate::study::CaseResult;

/// Above the table of drapes.
const BRACKET: &str = "Drape coefficient (%): state of lowest energy (all states found)";

/// Beside the page.
const FILES: [&str; 6] =
    ["fabrics.csv", "fabrics.parquet", "predictions.csv", "predictions.parquet", "problems.csv", "run.json"];

/// Of a linear solve beyond its meaning: it holds of cloth as such and is said once.
const BEYOND_LINEAR: &str = "S101";

/// A case with constants of its own, solved, with its charts.
pub(crate) struct Benchmark<'a, 'w> {
    pub task: &'a Task<'w>,
    pub result: &'a CaseResult,
    pub figures: &'a [Figure],
}

/// The page of a batch; `figures` are those of all fabrics together, `rows` and `problems` those of `fabrics.csv` (SI)
/// and `problems.csv`.
pub(crate) fn page(
    reports: &[FabricReport],
    benchmarks: &[Benchmark],
    figures: Vec<Figure>,
    rows: &[FabricRow],
    problems: &[ProblemRow],
) -> Page {
    let section = |heading: &str, blocks: Vec<Block>| Section { heading: heading.into(), blocks };
    let own: Vec<Block> = benchmarks.iter().flat_map(benchmark_blocks).collect();
    let sections = [
        section("Parameters", if reports.is_empty() { Vec::new() } else { vec![Block::Parameters] }),
        section("Problems and doubtful values", problem_blocks(reports, rows, problems)),
        section("Predictions", prediction_blocks(reports, figures)),
        section("Fabrics", reports.iter().enumerate().map(|(i, r)| fabric_block(i, r)).collect()),
        section("Fabrics side by side", side_by_side(reports)),
        section("Cases with constants of their own", own),
        section("Files", vec![files()]),
    ];
    Page {
        title: "KES-F results".into(),
        lead: format!(
            "{} fabrics; kesf {}; inputs and their hashes are in run.json.",
            reports.len(),
            env!("CARGO_PKG_VERSION")
        ),
        sections: sections.into_iter().filter(|s| !s.blocks.is_empty()).collect(),
        data: data(reports, rows),
    }
}

fn data(reports: &[FabricReport], rows: &[FabricRow]) -> PageData {
    let fabrics = reports.iter().map(|r| (r.name.as_str(), without_folders(&r.about)));
    let mut data = PageData::of_rows(fabrics, rows.iter());
    for (fabric, report) in reports.iter().enumerate() {
        data.curves.extend(report.curves.iter().cloned().map(|curves| {
            let mut curves = curves;
            curves.fabric = fabric;
            curves
        }));
    }
    data
}

fn files() -> Block {
    let written = FILES.into_iter().filter(|file| cfg!(feature = "tables") || !file.ends_with(".parquet"));
    Block::Files(written.map(String::from).collect())
}

fn side_by_side(reports: &[FabricReport]) -> Vec<Block> {
    if reports.len() < 2 { Vec::new() } else { vec![Block::ControlChart] }
}

fn benchmark_blocks(benchmark: &Benchmark) -> Vec<Block> {
    let text = format!(
        "{}: w_max = {} mm, {}",
        benchmark.task.case.title,
        significant(1e3 * benchmark.result.w_max),
        status(benchmark.result.status)
    );
    let mut blocks = vec![Block::Text(text)];
    blocks.extend(figures_block(benchmark.figures.to_vec()));
    blocks
}

fn figures_block(figures: Vec<Figure>) -> Option<Block> {
    (!figures.is_empty()).then_some(Block::Figures(figures))
}

/// Problems by code: what failed first, then in the order of the rows; linear solves beyond their meaning last.
fn problem_blocks(reports: &[FabricReport], rows: &[FabricRow], problems: &[ProblemRow]) -> Vec<Block> {
    let mut groups: Vec<(&str, Vec<&ProblemRow>)> = Vec::new();
    for row in problems {
        match groups.iter_mut().find(|(code, _)| *code == row.code) {
            Some((_, rows)) => rows.push(row),
            None => groups.push((&row.code, vec![row])),
        }
    }
    let is_error = |code: &str| explain(code).is_some_and(|e| e.kind == "error");
    groups.sort_by_key(|(code, _)| (*code == BEYOND_LINEAR, !is_error(code)));
    let mut blocks: Vec<Block> = doubtful(rows).into_iter().collect();
    if groups.is_empty() {
        return vec![Block::Text("Nothing was found that a reader of the results must know.".into())];
    }
    let groups = groups.iter().map(|(code, rows)| group(code, rows, reports.len()));
    blocks.push(Block::Problems(groups.collect()));
    blocks
}

fn group(code: &str, rows: &[&ProblemRow], fabrics: usize) -> ProblemGroup {
    let concerned: BTreeSet<&str> = rows.iter().filter_map(|row| row.fabric.as_deref()).collect();
    let times = if rows.len() == 1 { "once".to_string() } else { format!("{} times", rows.len()) };
    let mut count = match concerned.len() {
        0 => times,
        some => format!("{some} of {fabrics} fabrics"),
    };
    if code == BEYOND_LINEAR {
        let cases: BTreeSet<&str> = rows.iter().map(|row| row.place.as_str()).collect();
        count += &format!(", in {}", cases.into_iter().map(local).collect::<Vec<_>>().join(", "));
    }
    let lines = rows.iter().filter(|_| code != BEYOND_LINEAR).map(|row| Problem {
        fabric: row.fabric.clone(),
        place: row.place.clone(),
        message: row.message.clone(),
    });
    ProblemGroup { code: code.into(), count, lines: lines.collect() }
}

fn prediction_blocks(reports: &[FabricReport], figures: Vec<Figure>) -> Vec<Block> {
    let draped: Vec<_> = reports.iter().flat_map(|r| r.drapes.clone()).collect();
    let mut blocks: Vec<Block> = leading(reports).into_iter().collect();
    blocks.extend(draped::bracket(&draped).map(|table| table.block(BRACKET)));
    blocks.extend(plates(reports));
    blocks.extend(figures_block(figures));
    blocks
}

fn fabric_block(place: usize, report: &FabricReport) -> Block {
    let mut blocks: Vec<Block> = tests(report).into_iter().collect();
    let (drawn, pictures): (Vec<Figure>, Vec<Figure>) =
        report.figures.iter().cloned().partition(|figure| is_drawn(report, figure));
    if !report.curves.is_empty() {
        blocks.push(Block::Curves(place));
        blocks.push(Block::Text(format!(
            "Curves: corrected records, at most {POINTS} points a branch (Ramer-Douglas-Peucker), five digits; \
             parameters and pictures rest on all samples, which `kesf read` writes."
        )));
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
    let findings: Vec<_> = report.findings.iter().filter(|f| f.code() != BEYOND_LINEAR).cloned().collect();
    if !findings.is_empty() {
        blocks.push(Block::Findings(findings));
    }
    Block::Fabric { name: report.name.clone(), about: report.about.clone(), blocks }
}

/// Whether the script draws the same from records: charts of tests, and of simulated tests on them.
fn is_drawn(report: &FabricReport, figure: &Figure) -> bool {
    report.curves.iter().filter(|curves| !curves.specimens.is_empty()).any(|curves| {
        is_named(figure, curves.test) || curves.simulated.iter().any(|line| is_named(figure, &line.case))
    })
}

/// Whether the picture is `<fabric>/<stem>.png`.
fn is_named(figure: &Figure, stem: &str) -> bool {
    figure.picture.rsplit('/').next().and_then(|file| file.strip_suffix(".png")) == Some(stem)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn problem(code: &str, fabric: Option<&str>) -> ProblemRow {
        ProblemRow {
            code: code.into(),
            place: "cases/plate.toml".into(),
            message: "m".into(),
            fabric: fabric.map(String::from),
        }
    }

    #[test]
    fn linear_solves_beyond_their_meaning_are_told_once_and_last_and_errors_first() {
        let names = ["a", "b", "c"];
        let reports: Vec<FabricReport> = names
            .iter()
            .map(|name| FabricReport { name: (*name).into(), ..FabricReport::default() })
            .collect();
        let mut rows = vec![problem("S101", Some("a")), problem("K011", Some("b")), problem("R002", None)];
        rows.extend([problem("S101", Some("b")), problem("S101", Some("b")), problem("K011", Some("b"))]);
        let blocks = problem_blocks(&reports, &[], &rows);
        let [Block::Problems(groups)] = blocks.as_slice() else { panic!("{blocks:?}") };
        let told: Vec<(&str, &str, usize)> =
            groups.iter().map(|g| (g.code.as_str(), g.count.as_str(), g.lines.len())).collect();
        let beyond = ("S101", "2 of 3 fabrics, in cases/plate.toml", 0);
        assert_eq!(told, [("R002", "once", 1), ("K011", "1 of 3 fabrics", 2), beyond]);
    }

    #[test]
    fn pictures_that_the_script_draws_are_links() {
        let sheet = crate::characterise::FabricSheet { name: "a".into(), ..Default::default() };
        let curves = super::super::page_curves::curves(&sheet, &[]);
        assert!(curves.is_empty(), "nothing was recorded");
        let figures = vec![Figure { caption: "bending".into(), picture: "a/bending.png".into() }];
        let report = FabricReport { name: "a".into(), figures, ..FabricReport::default() };
        let Block::Fabric { blocks, .. } = fabric_block(0, &report) else { panic!("a fabric") };
        assert!(matches!(blocks.as_slice(), [Block::Figures(_)]), "{blocks:?}");
    }
}
