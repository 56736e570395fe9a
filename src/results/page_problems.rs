//! Problems of a batch by their codes, gathered one after the other.

use std::collections::{BTreeMap, BTreeSet};

use crate::finding::explain;
use crate::report::html::{ProblemGroup, ProblemLine, local};
use crate::report::number::counted;
use crate::report::table::ProblemRow;

/// Of a linear solve beyond its meaning: it holds of cloth as such and is said once.
pub(super) const BEYOND_LINEAR: &str = "S101";

/// Of a value that no fabric has: it is nearly always a mistake in a unit.
const IMPLAUSIBLE: &str = "K011";

/// Most lines and names of a code that are kept; all of them are in `problems.csv`.
const KEPT: usize = 1000;

/// Gathers the rows of `problems.csv`, and keeps what the page shows of them.
#[derive(Default)]
pub(crate) struct Problems {
    groups: Vec<OfCode>,
    /// Codes of what makes values doubtful.
    speak_against: BTreeSet<String>,
}

/// The problems of one code.
#[derive(Default)]
struct OfCode {
    code: String,
    count: usize,
    /// Names of the fabrics that it concerns.
    fabrics: BTreeSet<String>,
    /// Where it was found, of linear solves beyond their meaning.
    places: BTreeSet<String>,
    lines: Vec<ProblemLine>,
}

impl Problems {
    /// Adds a row.
    pub fn add(&mut self, row: &ProblemRow) {
        let at = self.groups.iter().position(|group| group.code == row.code).unwrap_or_else(|| {
            self.groups.push(OfCode { code: row.code.clone(), ..OfCode::default() });
            self.groups.len() - 1
        });
        self.groups[at].add(row);
    }

    /// Codes of what makes values doubtful.
    pub fn speak_against<'a>(&mut self, codes: impl Iterator<Item = &'a String>) {
        for code in codes {
            if !self.speak_against.contains(code) {
                self.speak_against.insert(code.clone());
            }
        }
    }

    /// The groups: what failed first, then implausible values and what else makes values doubtful, then in the order of the
    /// rows; linear solves beyond their meaning last.
    /// `fabrics` are the names of all fabrics in the order of their pages, `page` that of the page of each place among them.
    pub fn groups(self, fabrics: &[&str], page: impl Fn(usize) -> String) -> Vec<ProblemGroup> {
        let is_error = |code: &str| explain(code).is_some_and(|e| e.kind == "error");
        let Self { mut groups, speak_against } = self;
        groups.sort_by_key(|group| {
            let code = group.code.as_str();
            (code == BEYOND_LINEAR, !is_error(code), code != IMPLAUSIBLE, !speak_against.contains(code))
        });
        let named: BTreeSet<String> =
            groups.iter().flat_map(|group| &group.lines).filter_map(|line| line.fabric.clone()).collect();
        let place: BTreeMap<&str, usize> = fabrics
            .iter()
            .enumerate()
            .filter(|(_, name)| named.contains(**name))
            .map(|(at, name)| (*name, at))
            .collect();
        for line in groups.iter_mut().flat_map(|group| &mut group.lines) {
            line.page = line.fabric.as_deref().and_then(|name| place.get(name)).map(|at| page(*at));
        }
        groups.into_iter().map(|group| group.made(fabrics.len())).collect()
    }
}

impl OfCode {
    fn add(&mut self, row: &ProblemRow) {
        self.count += 1;
        if let Some(fabric) = row.fabric.as_ref().filter(|_| self.fabrics.len() <= KEPT) {
            self.fabrics.insert(fabric.clone());
        }
        if self.code == BEYOND_LINEAR {
            self.places.insert(row.place.clone());
        } else if self.lines.len() < KEPT {
            self.lines.push(ProblemLine {
                fabric: row.fabric.clone(),
                page: None,
                place: row.place.clone(),
                message: row.whole_message().into_owned(),
            });
        }
    }

    fn made(self, fabrics: usize) -> ProblemGroup {
        let mut count = match self.fabrics.len() {
            0 if self.count == 1 => "once".to_string(),
            0 => format!("{} times", self.count),
            some if some > KEPT => format!("more than {KEPT} of {fabrics} fabrics"),
            some => format!("{some} of {}", counted(fabrics, "fabric")),
        };
        if !self.places.is_empty() {
            let places: Vec<String> = self.places.iter().map(|place| local(place)).collect();
            count += &format!(", in {}", places.join(", "));
        } else if self.count > self.lines.len() {
            count += &format!("; the first {KEPT} of {} here, all in problems.csv", self.count);
        }
        ProblemGroup { code: self.code, count, lines: self.lines }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(code: &str, fabric: Option<&str>) -> ProblemRow {
        ProblemRow {
            code: code.into(),
            place: "cases/plate.toml".into(),
            message: "m".into(),
            fabric: fabric.map(String::from),
            hint: None,
        }
    }

    #[test]
    fn what_failed_is_told_with_what_to_do() {
        let mut problems = Problems::default();
        problems.add(&ProblemRow { hint: Some("write `fabric`".into()), ..row("O055", Some("a")) });
        let groups = problems.groups(&["a"], |_| String::new());
        assert_eq!(groups[0].lines[0].message, "m; write `fabric`");
    }

    #[test]
    fn linear_solves_beyond_their_meaning_are_told_once_and_last_and_errors_first() {
        let mut problems = Problems::default();
        for (code, fabric) in [("S101", Some("a")), ("K011", Some("b")), ("R002", None), ("S101", Some("b"))]
        {
            problems.add(&row(code, fabric));
        }
        [row("S101", Some("b")), row("K011", Some("b"))].iter().for_each(|row| problems.add(row));
        let fabrics = ["a", "c", "b"];
        let groups = problems.groups(&fabrics, |at| format!("fabrics-{at}.html"));
        let pages: Vec<Option<&str>> = groups[1].lines.iter().map(|l| l.page.as_deref()).collect();
        assert_eq!(pages, [Some("fabrics-2.html"); 2]);
        let found: Vec<(&str, &str, usize)> =
            groups.iter().map(|g| (g.code.as_str(), g.count.as_str(), g.lines.len())).collect();
        let beyond = ("S101", "2 of 3 fabrics, in cases/plate.toml", 0);
        assert_eq!(found, [("R002", "once", 1), ("K011", "1 of 3 fabrics", 2), beyond]);
    }

    #[test]
    fn what_makes_values_doubtful_comes_before_what_was_assumed() {
        let mut problems = Problems::default();
        ["K040", "K001", "K002", "K011"].iter().for_each(|code| problems.add(&row(code, Some("a"))));
        problems.speak_against(["K002".to_string(), "K011".to_string()].iter());
        let groups = problems.groups(&["a"], |_| String::new());
        let codes: Vec<&str> = groups.iter().map(|g| g.code.as_str()).collect();
        assert_eq!(codes, ["K011", "K002", "K040", "K001"]);
    }

    #[test]
    fn of_a_code_that_is_everywhere_the_first_lines_are_kept_and_the_rest_is_counted() {
        let mut problems = Problems::default();
        (0..1500).for_each(|i| problems.add(&row("K011", Some(&format!("fabric {i}")))));
        let fabrics: Vec<String> = (0..1500).map(|i| format!("fabric {i}")).collect();
        let fabrics: Vec<&str> = fabrics.iter().map(String::as_str).collect();
        let groups = problems.groups(&fabrics, |_| String::new());
        assert_eq!((groups.len(), groups[0].lines.len()), (1, 1000));
        let count = "more than 1000 of 1500 fabrics; the first 1000 of 1500 here, all in problems.csv";
        assert_eq!(groups[0].count, count);
    }
}
