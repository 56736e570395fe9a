//! `index.html` of a folder of results.

use super::draped::{self, DrapePoint};
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
    pub task: &'a Task<'w, 'w>,
    pub result: &'a CaseResult,
    pub figures: &'a [Figure],
}

/// Fabrics of a page: more of them have pages of their own.
pub(crate) const FABRICS_OF_PAGE: usize = 200;

/// Failures on a page; all of them are in `problems.csv`.
const FAILURES_OF_PAGE: usize = 1000;

/// What stands above the fabrics of a batch.
pub(crate) struct Head<'a> {
    /// Of all fabrics together.
    pub figures: Vec<Figure>,
    /// Of inputs and tasks.
    pub failures: &'a [Failure],
    /// Of all fabrics.
    pub drapes: &'a [DrapePoint],
    /// Pages with the fabrics, where there are too many for this one.
    pub pages: &'a [String],
}

/// The page of a batch; `reports` are the fabrics, unless they have pages of their own.
pub(crate) fn page(reports: &[FabricReport], benchmarks: &[Benchmark], head: Head) -> Page {
    let mut sections = vec![Section { heading: "Overview".into(), blocks: overview(reports, head) }];
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

/// A page of some of the fabrics; `number` counts from 1.
pub(crate) fn fabrics_page(reports: &[FabricReport], number: usize) -> Page {
    let mut sections = vec![Section {
        heading: "Overview".into(),
        blocks: vec![Block::Files(vec!["index.html".into()]), overview_table(reports)],
    }];
    sections.extend(reports.iter().map(fabric_section));
    Page {
        title: format!("KES-F results, page {number}"),
        lead: format!("kesf {}", env!("CARGO_PKG_VERSION")),
        sections,
    }
}

fn overview_table(reports: &[FabricReport]) -> Block {
    Block::Table {
        caption: CAPTION.into(),
        header: HEADINGS.iter().copied().chain(["status"]).map(String::from).collect(),
        rows: reports.iter().map(overview_row).collect(),
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

fn overview(reports: &[FabricReport], head: Head) -> Vec<Block> {
    let Head { figures, failures, drapes, pages } = head;
    let written = FILES.into_iter().filter(|file| cfg!(feature = "tables") || !file.ends_with(".parquet"));
    let mut blocks = vec![Block::Files(written.map(String::from).collect())];
    if pages.is_empty() {
        blocks.push(overview_table(reports));
    } else {
        blocks.push(Block::Text(format!("The fabrics are on pages of {FABRICS_OF_PAGE}, in name order:")));
        blocks.push(Block::Files(pages.to_vec()));
    }
    blocks.extend(draped::bracket(drapes).map(|table| table.block(BRACKET)));
    blocks.extend(figures_block(figures));
    blocks.extend(failures.iter().take(FAILURES_OF_PAGE).map(|failure| {
        let row = failure.row();
        Block::Text(format!("{}: {} {}", row.place, row.code, row.message))
    }));
    if let Some(more) = failures.len().checked_sub(FAILURES_OF_PAGE).filter(|more| *more > 0) {
        blocks.push(Block::Text(format!("{more} more failures are in problems.csv.")));
    }
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
