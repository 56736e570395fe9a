//! The index of a run of many fabrics, which have pages of their own: a line a fabric, and links to the pages.

use std::sync::Arc;

use super::fabric::FabricReport;
use super::overview::{CAPTION, HEADINGS};
use super::page::FABRICS_OF_PAGE;
use crate::report::html::{Block, IndexLine};

/// Fabrics that the index lists: a longer table takes a browser seconds. All of them are in `fabrics.csv`.
const LISTED: usize = 5000;

/// Pages of fabrics that are written.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pages {
    /// File and what it holds.
    pages: Vec<(String, String)>,
    /// A line a fabric, up to [`LISTED`].
    lines: Vec<IndexLine>,
    fabrics: usize,
}

/// The name of a page of fabrics; pages count from 1.
pub(crate) fn name_of_page(number: usize) -> String {
    format!("fabrics-{number}.html")
}

impl Pages {
    /// The name and number of the next page.
    pub fn next(&self) -> (String, usize) {
        let number = self.pages.len() + 1;
        (name_of_page(number), number)
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.pages.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.pages.is_empty()
    }

    /// Adds a page that is written, with its fabrics.
    pub fn add(&mut self, page: String, reports: &[FabricReport]) {
        let name = |report: Option<&FabricReport>| report.map_or("", |r| &r.name).to_string();
        let text = format!("{}… to {}…", name(reports.first()), name(reports.last()));
        let shared: Arc<str> = page.as_str().into();
        for report in reports.iter().take(LISTED.saturating_sub(self.lines.len())) {
            let cells: Vec<&str> =
                report.cells.iter().chain([&report.status]).map(|cell| cell.as_str()).collect();
            self.lines.push(IndexLine {
                page: Arc::clone(&shared),
                name: report.name.as_str().into(),
                cells: cells.join(IndexLine::BETWEEN).into(),
            });
        }
        self.fabrics += reports.len();
        self.pages.push((page, text));
    }

    /// Links and the table; nothing without pages.
    pub fn blocks(self) -> Vec<Block> {
        if self.is_empty() {
            return Vec::new();
        }
        let text = format!(
            "Parameters, curves and charts are on pages of up to {FABRICS_OF_PAGE} fabrics, in name order:"
        );
        let rest = match self.fabrics - self.lines.len() {
            0 => String::new(),
            more => format!(" The first {LISTED} fabrics; {more} more are on the pages and in fabrics.csv."),
        };
        let table = Block::Index {
            caption: format!("{CAPTION}.{rest}"),
            header: HEADINGS.into_iter().chain(["status"]).map(String::from).collect(),
            lines: self.lines,
        };
        vec![Block::Text(text), Block::Pages(self.pages), table]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_fabric_has_a_line_that_leads_to_its_page() {
        let report = |name: &str| FabricReport {
            name: name.into(),
            cells: vec!["0.1 ?".into(); HEADINGS.len() - 1],
            status: "ok".into(),
            ..FabricReport::default()
        };
        let mut pages = Pages::default();
        assert!(pages.clone().blocks().is_empty());
        for names in [["a", "f"], ["g", "m"]] {
            let (page, _) = pages.next();
            pages.add(page, &names.map(report));
        }
        let blocks = pages.blocks();
        let [Block::Text(_), Block::Pages(links), Block::Index { header, lines, .. }] = &blocks[..] else {
            panic!("{blocks:?}")
        };
        assert_eq!(links[1], ("fabrics-2.html".to_string(), "g… to m…".to_string()));
        let last = lines[3].row();
        assert_eq!((lines.len(), last.len()), (4, header.len()));
        assert_eq!(last[0].leads_to, Some(("fabrics-2.html".into(), "m".into())));
    }

    #[test]
    fn a_library_of_any_size_has_a_table_that_opens() {
        let reports: Vec<FabricReport> = (0..LISTED + 3)
            .map(|k| FabricReport { name: k.to_string(), ..FabricReport::default() })
            .collect();
        let mut pages = Pages::default();
        pages.add("fabrics-1.html".into(), &reports);
        let blocks = pages.blocks();
        let [.., Block::Index { caption, lines, .. }] = &blocks[..] else { panic!("{blocks:?}") };
        assert_eq!(lines.len(), LISTED);
        assert!(caption.ends_with("3 more are on the pages and in fabrics.csv."), "{caption}");
    }
}
