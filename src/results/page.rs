//! `index.html` of a folder of results, and the pages of its fabrics where they are many.

use super::draped::{self, DrapePoint};
use super::fabric::FabricReport;
use super::page_fabric::{fabric_block, figures_block};
use super::page_index::Pages;
use super::page_predictions::{leading, plates};
use super::page_values::doubtful;
use super::solved::status;
use super::task::Task;
use crate::quantity::significant;
use crate::report::chart::Format;
use crate::report::html::{
    Block, DeflectedShape, FabricValues, Figure, Page, PageData, ProblemGroup, Section, Shapes, Workbooks,
    without_folders,
};
use crate::report::number::counted;
use crate::report::population::Population;
#[cfg(feature = "workbook")]
use crate::report::{
    table::{FabricRow, UnitSystem},
    workbook,
};
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
    /// How many inputs could not be read, and how many results could not be made.
    pub failed: [usize; 2],
    /// Charts.
    pub figures: Vec<Figure>,
    /// Everything that failed or was found.
    pub problems: Vec<ProblemGroup>,
    pub drapes: &'a [DrapePoint],
    /// What fabrics are compared with; none for themselves.
    pub population: Option<&'a Population>,
    /// Files of each chart; none where no charts are drawn.
    pub formats: &'a [Format],
    /// Pages with the fabrics, where there are too many for this one.
    pub pages: Pages,
}

/// The page of a batch; `reports` are the fabrics, unless they have pages of their own.
pub(crate) fn page(reports: &[FabricReport], benchmarks: &[Benchmark], head: Head) -> Page {
    let mut predictions = leading(reports);
    predictions.extend(draped::bracket(head.drapes).map(|table| table.block(BRACKET)));
    predictions.extend(plates(reports));
    predictions.extend(figures_block(head.figures));
    let sections = [
        parameters(reports),
        section("Fabrics", head.pages.blocks()),
        section("Problems and doubtful values", problem_blocks(reports, head.problems)),
        section("Predictions", predictions),
        fabrics(reports),
        side_by_side(reports, head.population),
        section("Cases with constants of their own", benchmarks.iter().flat_map(benchmark_blocks).collect()),
        section("Files", other_formats(head.formats).into_iter().chain([files()]).collect()),
    ];
    let lead = counts(head.fabrics, head.failed);
    made_of(sections, "KES-F results".into(), &lead, reports, head.population)
}

/// A page of some of the `all` fabrics; `number` counts from 1.
pub(crate) fn fabrics_page(
    reports: &[FabricReport],
    number: usize,
    all: usize,
    population: Option<&Population>,
) -> Page {
    let sections = [
        parameters(reports),
        section("Doubtful values", doubtful(reports, "index.html").into_iter().collect()),
        section("Predictions", leading(reports).into_iter().chain(plates(reports)).collect()),
        fabrics(reports),
        side_by_side(reports, population),
        section(
            "All fabrics",
            vec![Block::Pages(vec![("index.html".into(), "all fabrics and problems".into())])],
        ),
    ];
    let unread = reports.iter().map(|r| r.unread.len()).sum();
    let undone = reports.iter().map(|r| r.failures.len()).sum();
    let lead = counts(reports.len(), [unread, undone]);
    let mut page = made_of(sections, format!("KES-F results, page {number}"), &lead, reports, population);
    page.data.fabrics_of_run = Some(all);
    page
}

/// A page of the sections that hold something.
fn made_of(
    sections: impl IntoIterator<Item = Section>,
    title: String,
    counts: &str,
    reports: &[FabricReport],
    population: Option<&Population>,
) -> Page {
    let version = env!("CARGO_PKG_VERSION");
    let data = PageData { population: population.cloned(), ..data(reports) };
    Page {
        title,
        lead: format!(
            "{counts}; kesf {version}; inputs and their hashes are in run.json.{}",
            sheets_left_out(&data.shapes)
        ),
        sections: sections.into_iter().filter(|s| !s.blocks.is_empty()).collect(),
        data,
        workbooks: workbooks(reports),
    }
}

/// How many fabrics there are, and what failed.
fn counts(fabrics: usize, [unread, undone]: [usize; 2]) -> String {
    let mut parts = vec![counted(fabrics, "fabric")];
    parts.extend((unread > 0).then(|| format!("{} failed", counted(unread, "input"))));
    parts.extend((undone > 0).then(|| format!("{} could not be made", counted(undone, "result"))));
    parts.join(", ")
}

/// A sentence on sheets that are not in the page.
fn sheets_left_out(shapes: &Shapes) -> String {
    match shapes.left_out.len() {
        0 => String::new(),
        missing => format!(
            " {missing} of {} deflected sheets do not turn in this page, to keep it small; their files (.glb) are in the folder \
             of results.",
            shapes.count()
        ),
    }
}

/// The table of parameters to be taken away. A table that no sheet can hold is in the CSV files alone.
#[cfg(feature = "workbook")]
fn workbooks(reports: &[FabricReport]) -> Option<Workbooks> {
    let rows = |units: UnitSystem| -> Vec<FabricRow> {
        let rows = reports.iter().flat_map(|r| &r.rows);
        // The same as the table: without what `fabric.toml` states.
        rows.filter(|row| row.mean.is_none() || row.is_of_parameter())
            .map(|row| row.in_units(units))
            .collect()
    };
    let [kes, si] = [UnitSystem::Kes, UnitSystem::Si].map(|units| workbook::parameters(&rows(units)));
    (!reports.is_empty()).then_some(Workbooks { kes: kes.ok()?, si: si.ok()? })
}

#[cfg(not(feature = "workbook"))]
fn workbooks(_: &[FabricReport]) -> Option<Workbooks> {
    None
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

fn problem_blocks(reports: &[FabricReport], problems: Vec<ProblemGroup>) -> Vec<Block> {
    let mut blocks: Vec<Block> = doubtful(reports, "").into_iter().collect();
    if problems.is_empty() {
        blocks.push(Block::Text("Nothing was found that a reader of the results must know.".into()));
    } else {
        blocks.push(Block::Problems(problems));
    }
    blocks
}

fn data(reports: &[FabricReport]) -> PageData {
    let fabrics = reports.iter().map(|r| FabricValues {
        name: r.name.clone(),
        about: without_folders(&r.about),
        origin: r.origin().unwrap_or_default().into(),
        failed: r.unread.len() + r.failures.len(),
        ..FabricValues::default()
    });
    let mut data = PageData::of_rows(fabrics, reports.iter().flat_map(|r| &r.rows));
    for (fabric, report) in reports.iter().enumerate() {
        data.curves.extend(report.curves.iter().cloned().map(|curves| {
            let mut curves = curves;
            curves.fabric = fabric;
            curves
        }));
    }
    let of_fabric = |(fabric, report): (usize, &FabricReport)| -> Vec<DeflectedShape> {
        report.shapes.iter().cloned().map(|shape| DeflectedShape { fabric, ..shape }).collect()
    };
    data.shapes = Shapes::of(reports.iter().enumerate().flat_map(of_fabric));
    let too_large =
        |(fabric, report): (usize, &FabricReport)| std::iter::repeat_n(fabric, report.sheets_too_large);
    data.shapes.left_out.extend(reports.iter().enumerate().flat_map(too_large));
    data
}

/// Where the charts are in other formats than that of the page.
fn other_formats(formats: &[Format]) -> Option<Block> {
    let named: Vec<String> = formats.iter().map(|format| format.ending().to_uppercase()).collect();
    let text = || {
        format!(
            "Every chart is in the folder of results as {}, under the same name with another ending.",
            named.join(" and ")
        )
    };
    (named.len() > 1).then(|| Block::Text(text()))
}

fn files() -> Block {
    let written = FILES.into_iter().filter(|file| cfg!(feature = "parquet") || !file.ends_with(".parquet"));
    Block::Files(written.map(String::from).collect())
}

fn side_by_side(reports: &[FabricReport], population: Option<&Population>) -> Section {
    // A single fabric has nothing to be compared with but a population from elsewhere.
    let least = if population.is_some() { 1 } else { 2 };
    section(
        "Fabrics side by side",
        if reports.len() < least { Vec::new() } else { vec![Block::ControlChart] },
    )
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_failed_is_counted_above() {
        assert_eq!(counts(7, [2, 0]), "7 fabrics, 2 inputs failed");
        assert_eq!(counts(1, [0, 1]), "1 fabric, 1 result could not be made");
    }

    /// Mean and standard deviation of a page of 200 fabrics are none of the run.
    #[test]
    fn a_page_of_some_fabrics_says_of_how_many() {
        let reports = ["a", "b"].map(|name| FabricReport { name: name.into(), ..FabricReport::default() });
        let text = crate::report::html::html(&fabrics_page(&reports, 2, 400, None));
        assert!(text.contains("\"fabrics_of_run\":400"), "the script tells it");
    }
}
