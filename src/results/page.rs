//! `index.html` of a folder of results, and the pages of its fabrics where they are many.

use super::draped::{self, DrapePoint};
use super::fabric::FabricReport;
use super::page_problems::BEYOND_LINEAR;
use super::page_values::{doubtful, leading, plates, tests};
use super::solved::status;
use super::task::Task;
use crate::quantity::significant;
use crate::report::html::{Block, Figure, POINTS, Page, PageData, ProblemGroup, Section, without_folders};
use crate::study::CaseResult;

/// Above the table of drapes.
const BRACKET: &str = "Drape coefficient (%): state of lowest energy (all states found)";

/// Beside the page.
const FILES: [&str; 6] =
    ["fabrics.csv", "fabrics.parquet", "predictions.csv", "predictions.parquet", "problems.csv", "run.json"];

/// Fabrics of a page: more of them have pages of their own.
pub(crate) const FABRICS_OF_PAGE: usize = 200;

/// A case with constants of its own, solved, with its charts.
pub(crate) struct Benchmark<'a, 'w> {
    pub task: &'a Task<'w, 'w>,
    pub result: &'a CaseResult,
    pub figures: &'a [Figure],
}

/// What the page says of all fabrics together.
pub(crate) struct Head<'a> {
    /// How many there are.
    pub fabrics: usize,
    /// Charts.
    pub figures: Vec<Figure>,
    /// Everything that failed or was found.
    pub problems: Vec<ProblemGroup>,
    pub drapes: &'a [DrapePoint],
    /// Pages with the fabrics, where there are too many for this one.
    pub pages: &'a [String],
}

/// The page of a batch; `reports` are the fabrics, unless they have pages of their own.
pub(crate) fn page(reports: &[FabricReport], benchmarks: &[Benchmark], head: Head) -> Page {
    let mut predictions: Vec<Block> = leading(reports).into_iter().collect();
    predictions.extend(draped::bracket(head.drapes).map(|table| table.block(BRACKET)));
    predictions.extend(plates(reports));
    predictions.extend(figures_block(head.figures));
    let sections = [
        parameters(reports),
        section("Fabrics", links(head.pages)),
        section("Problems and doubtful values", problem_blocks(reports, head.problems)),
        section("Predictions", predictions),
        fabrics(reports),
        side_by_side(reports),
        section("Cases with constants of their own", benchmarks.iter().flat_map(benchmark_blocks).collect()),
        section("Files", vec![files()]),
    ];
    made_of(sections, "KES-F results".into(), head.fabrics, reports)
}

/// A page of some of the fabrics; `number` counts from 1.
pub(crate) fn fabrics_page(reports: &[FabricReport], number: usize) -> Page {
    let sections = [
        parameters(reports),
        section("Doubtful values", doubtful(reports).into_iter().collect()),
        section("Predictions", leading(reports).into_iter().chain(plates(reports)).collect()),
        fabrics(reports),
        side_by_side(reports),
        section("All fabrics", vec![Block::Files(vec!["index.html".into()])]),
    ];
    made_of(sections, format!("KES-F results, page {number}"), reports.len(), reports)
}

/// A page of the sections that hold something.
fn made_of(
    sections: impl IntoIterator<Item = Section>,
    title: String,
    fabrics: usize,
    reports: &[FabricReport],
) -> Page {
    let version = env!("CARGO_PKG_VERSION");
    Page {
        title,
        lead: format!("{fabrics} fabrics; kesf {version}; inputs and their hashes are in run.json."),
        sections: sections.into_iter().filter(|s| !s.blocks.is_empty()).collect(),
        data: data(reports),
    }
}

fn section(heading: &str, blocks: Vec<Block>) -> Section {
    Section { heading: heading.into(), blocks }
}

fn parameters(reports: &[FabricReport]) -> Section {
    section("Parameters", if reports.is_empty() { Vec::new() } else { vec![Block::Parameters] })
}

fn fabrics(reports: &[FabricReport]) -> Section {
    section("Fabrics", reports.iter().enumerate().map(|(i, r)| fabric_block(i, r)).collect())
}

fn links(pages: &[String]) -> Vec<Block> {
    if pages.is_empty() {
        return Vec::new();
    }
    let text =
        format!("Parameters, curves and charts are on pages of {FABRICS_OF_PAGE} fabrics, in name order:");
    vec![Block::Text(text), Block::Files(pages.to_vec())]
}

fn problem_blocks(reports: &[FabricReport], problems: Vec<ProblemGroup>) -> Vec<Block> {
    let mut blocks: Vec<Block> = doubtful(reports).into_iter().collect();
    if problems.is_empty() {
        blocks.push(Block::Text("Nothing was found that a reader of the results must know.".into()));
    } else {
        blocks.push(Block::Problems(problems));
    }
    blocks
}

fn data(reports: &[FabricReport]) -> PageData {
    let fabrics = reports.iter().map(|r| (r.name.as_str(), without_folders(&r.about)));
    let mut data = PageData::of_rows(fabrics, reports.iter().flat_map(|r| &r.rows));
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

fn side_by_side(reports: &[FabricReport]) -> Section {
    section("Fabrics side by side", if reports.len() < 2 { Vec::new() } else { vec![Block::ControlChart] })
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
        is_named(figure, &curves.test) || curves.simulated.iter().any(|line| is_named(figure, &line.case))
    })
}

/// Whether the picture is `<fabric>/<stem>.png`.
fn is_named(figure: &Figure, stem: &str) -> bool {
    figure.picture.rsplit('/').next().and_then(|file| file.strip_suffix(".png")) == Some(stem)
}

#[cfg(test)]
mod tests {
    use super::*;

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
