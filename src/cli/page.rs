//! `index.html` of a results folder.

use super::diagnostics::Failure;
use super::drape;
use super::solve::status;
use super::summary::{CAPTION, FabricReport, HEADINGS};
use super::task::Task;
use crate::quantity::significant;
use crate::report::html::{Block, Figure, Page, Section};
use crate::study::CaseResult;

/// Above the table of drapes.
const BRACKET: &str = "Drape coefficient (%): state of lowest energy (all states found)";

/// The page of a results folder, with every picture that may have been drawn.
pub fn page(reports: &[FabricReport], benchmarks: &[(&Task, &CaseResult)], failures: &[Failure]) -> Page {
    let mut sections = vec![Section { heading: "Overview".into(), blocks: overview(reports, failures) }];
    sections.extend(reports.iter().map(fabric_section));
    let mut blocks = Vec::new();
    for (task, result) in benchmarks {
        let w = format!(
            "{}: w_max = {} mm, {}",
            task.case.title,
            significant(1e3 * result.w_max),
            status(result.status)
        );
        blocks.push(Block::Text(w));
        blocks.push(Block::Figures(vec![figure(&task.case.title, &format!("{}.png", task.stem()))]));
    }
    if !blocks.is_empty() {
        sections.push(Section { heading: "Cases with constants of their own".into(), blocks });
    }
    Page {
        title: "KES-F results".into(),
        lead: format!("kesf {}; inputs and their hashes are in run.json.", env!("CARGO_PKG_VERSION")),
        sections,
    }
}

fn overview(reports: &[FabricReport], failures: &[Failure]) -> Vec<Block> {
    let names = [
        "fabrics.csv",
        "fabrics.parquet",
        "predictions.csv",
        "predictions.parquet",
        "problems.csv",
        "run.json",
    ];
    let mut blocks = vec![Block::Files(names.map(String::from).to_vec())];
    let row = |r: &FabricReport| {
        let name = std::iter::once(r.name.clone());
        name.chain(r.cells.iter().cloned()).chain([r.status.clone()]).collect()
    };
    blocks.push(Block::Table {
        caption: CAPTION.into(),
        header: HEADINGS.iter().copied().chain(["status"]).map(String::from).collect(),
        rows: reports.iter().map(row).collect(),
    });
    let draped: Vec<_> = reports.iter().flat_map(|r| r.drape_parity.clone()).collect();
    blocks.extend(drape::bracket(&draped).map(|table| table.block(BRACKET)));
    let friction = super::friction::PARITY.iter().map(|(file, title, _)| figure(title, file));
    let mut figures = vec![figure("Simulated against measured stiffness", "parity.png")];
    figures.extend(friction);
    figures.push(figure("Simulated against measured drape", "drape_parity.png"));
    blocks.push(Block::Figures(figures));
    blocks.extend(failures.iter().map(|f| {
        let row = f.row();
        Block::Text(format!("{}: {} {}", row.place, row.code, row.message))
    }));
    blocks
}

fn fabric_section(r: &FabricReport) -> Section {
    let table = Block::Table {
        caption: CAPTION.into(),
        header: HEADINGS[1..].iter().map(ToString::to_string).collect(),
        rows: vec![r.cells.clone()],
    };
    let mut blocks = vec![table];
    let tests = r.drawn.iter().map(|t| figure(t.name(), &format!("{}/{}.png", r.name, t.name())));
    let cases = r.deflections.iter().map(|(case, _)| figure(case, &format!("{}/{case}.png", r.name)));
    let friction = r.friction.iter().map(|f| figure(&f.replace('_', ": "), &format!("{}/{f}.png", r.name)));
    let bent = r.bent.iter().map(|(title, file)| figure(title, file));
    let drapes = r
        .drapes
        .iter()
        .flat_map(|case| ["", "_view"].map(|end| figure(case, &format!("{}/{case}{end}.png", r.name))));
    blocks.push(Block::Figures(tests.chain(friction).chain(cases).chain(bent).chain(drapes).collect()));
    blocks.push(Block::Findings(r.findings.clone()));
    Section { heading: r.name.clone(), blocks }
}

fn figure(caption: &str, file: &str) -> Figure {
    Figure { caption: caption.into(), picture: file.into() }
}
