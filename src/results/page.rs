//! `index.html` of a folder of results.

use super::draped;
use super::fabric::FabricReport;
use super::failure::Failure;
use super::overview::{CAPTION, HEADINGS};
use super::solved::status;
use super::task::Task;
use crate::quantity::significant;
use crate::report::html::{Block, Figure, Page, Section};
use crate::study::CaseResult;

/// Above the table of drapes.
const BRACKET: &str = "Drape coefficient (%): state of lowest energy (all states found)";

/// Beside the page.
const FILES: [&str; 6] =
    ["fabrics.csv", "fabrics.parquet", "predictions.csv", "predictions.parquet", "problems.csv", "run.json"];

/// A case with constants of its own, solved, with its charts.
pub(crate) struct Benchmark<'a, 'w> {
    pub task: &'a Task<'w>,
    pub result: &'a CaseResult,
    pub figures: &'a [Figure],
}

/// The page of a batch; `figures` are those of all fabrics together.
pub(crate) fn page(
    reports: &[FabricReport],
    benchmarks: &[Benchmark],
    figures: Vec<Figure>,
    failures: &[Failure],
) -> Page {
    let mut sections =
        vec![Section { heading: "Overview".into(), blocks: overview(reports, figures, failures) }];
    sections.extend(reports.iter().map(fabric_section));
    let blocks: Vec<Block> = benchmarks.iter().flat_map(benchmark_blocks).collect();
    if !blocks.is_empty() {
        sections.push(Section { heading: "Cases with constants of their own".into(), blocks });
    }
    Page {
        title: "KES-F results".into(),
        lead: format!("kesf {}; inputs and their hashes are in run.json.", env!("CARGO_PKG_VERSION")),
        sections,
    }
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

fn overview(reports: &[FabricReport], figures: Vec<Figure>, failures: &[Failure]) -> Vec<Block> {
    let written = FILES.into_iter().filter(|file| cfg!(feature = "tables") || !file.ends_with(".parquet"));
    let mut blocks = vec![Block::Files(written.map(String::from).collect())];
    blocks.push(Block::Table {
        caption: CAPTION.into(),
        header: HEADINGS.iter().copied().chain(["status"]).map(String::from).collect(),
        rows: reports.iter().map(overview_row).collect(),
    });
    let draped: Vec<_> = reports.iter().flat_map(|r| r.drapes.clone()).collect();
    blocks.extend(draped::bracket(&draped).map(|table| table.block(BRACKET)));
    blocks.extend(figures_block(figures));
    blocks.extend(failures.iter().map(|failure| {
        let row = failure.row();
        Block::Text(format!("{}: {} {}", row.place, row.code, row.message))
    }));
    blocks
}

fn overview_row(report: &FabricReport) -> Vec<String> {
    let mut row = vec![report.name.clone()];
    row.extend(report.cells.iter().cloned());
    row.push(report.status.clone());
    row
}

fn fabric_section(report: &FabricReport) -> Section {
    let mut blocks = vec![Block::Table {
        caption: CAPTION.into(),
        header: HEADINGS[1..].iter().map(ToString::to_string).collect(),
        rows: vec![report.cells.clone()],
    }];
    blocks.extend(figures_block(report.figures.clone()));
    blocks.push(Block::Findings(report.findings.clone()));
    Section { heading: report.name.clone(), blocks }
}
