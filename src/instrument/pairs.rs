//! Columns to pairs: the two columns of each curve, what the header says of each, and which are no specimens.

use std::collections::BTreeMap;

use super::Direction;
use super::dialect::{BranchColumn, HeaderKey, Role, Statistic};
use super::error::{ReadError, ReadProblem};
use super::label::Label;
use super::layout::{Column, Entry, Pair, Scanner};
use super::raw::Row;
use super::statistic::{self, Kinds};
use super::vocabulary::Vocabulary;

/// Abscissa and ordinate, as far as they were met.
type Halves = (Option<Column>, Option<Column>);

impl Pair {
    /// How the curve sums up others, and the text that says so: its heading, or the label in place of its number.
    fn statistic(&self, vocabulary: Vocabulary<'_>) -> Option<(Statistic, &str)> {
        let name = self.y.name.as_str();
        let label = || self.header.known.get(&HeaderKey::Specimen).map(|e| e.text.as_str());
        let of_name = vocabulary.statistic_within(name).map(|s| (s, name));
        of_name.or_else(|| label().and_then(|l| Some((of_label(l, vocabulary)?, l))))
    }
}

/// How a label over a curve sums up others: `Mean`, `経 平均`; with a number it is a specimen's.
pub(super) fn of_label(label: &str, vocabulary: Vocabulary<'_>) -> Option<Statistic> {
    if label.contains(|c: char| c.is_ascii_digit()) { None } else { vocabulary.statistic_within(label) }
}

/// Columns beside the position of a sweep, where nothing of another test is among them.
pub(super) fn along_sweep(mut columns: Vec<Column>) -> Vec<Column> {
    let alone =
        |c: &Column| c.role.in_sweep().is_of_sweep() || matches!(c.role, Role::Position | Role::Ignored);
    if columns.iter().any(|c| c.role == Role::Position) && columns.iter().all(alone) {
        columns.iter_mut().for_each(|c| c.role = c.role.in_sweep());
    }
    columns
}

/// Pairs of a loading and an unloading branch are one curve, whichever stands first.
fn joined(pairs: Vec<Pair>) -> Vec<Pair> {
    let mut out: Vec<Pair> = Vec::with_capacity(pairs.len());
    for pair in pairs {
        match out.iter().position(|before| are_branches(before, &pair)) {
            Some(at) if unloads(&pair) => out[at].back = Some((pair.x, pair.y)),
            Some(at) => {
                let before = std::mem::replace(&mut out[at], pair);
                out[at].back = Some((before.x, before.y));
            }
            None => out.push(pair),
        }
    }
    out
}

fn unloads(pair: &Pair) -> bool {
    pair.y.says.branch == Some(BranchColumn::Unloading)
}

/// Whether one of two columns of a specimen is the unloading branch and the other is not: `load` is the force itself.
fn are_branches(before: &Pair, pair: &Pair) -> bool {
    before.back.is_none()
        && pair.back.is_none()
        && unloads(before) != unloads(pair)
        && (before.x.role, before.y.role) == (pair.x.role, pair.y.role)
        && (before.y.says.direction, before.y.says.specimen) == (pair.y.says.direction, pair.y.says.specimen)
}

/// The label over the columns of a curve, or to the left of them.
fn above<'l>(pair: &Pair, labels: &'l [(usize, Label, Entry)]) -> Option<&'l (usize, Label, Entry)> {
    let left = pair.x.index.min(pair.y.index);
    labels.iter().rfind(|(index, ..)| *index <= left.max(pair.y.index.min(left + 1)))
}

/// Gives every curve the branch whose word stands over its columns.
fn branches_above(pairs: &mut [Pair], rows: &[Vec<(usize, Label, Entry)>], vocabulary: Vocabulary<'_>) {
    for pair in pairs {
        let words = rows.iter().filter_map(|labels| above(pair, labels));
        let branch = words.filter_map(|(_, _, entry)| vocabulary.branch(&entry.text)).next();
        pair.y.says.branch = pair.y.says.branch.or(branch);
    }
}

/// Gives every curve the label that stands over its columns, or to the left of them where heads are merged.
fn label(pairs: &mut [Pair], labels: &[(usize, Label, Entry)], vocabulary: Vocabulary<'_>) {
    let each = labels.len() == pairs.len();
    // A mean is left out, whatever its direction.
    let any = labels.iter().find_map(|(_, l, _)| l.direction);
    for (i, pair) in pairs.iter_mut().enumerate() {
        let above = if each { labels.get(i) } else { above(pair, labels) };
        let Some((_, l, entry)) = above else { continue };
        let with = |text: String| Entry { text, ..entry.clone() };
        let is_mean = of_label(&entry.text, vocabulary).is_some();
        let number = l.specimen.map(|n| n.to_string()).or_else(|| is_mean.then(|| entry.text.clone()));
        pair.header.known.extend(number.map(|t| (HeaderKey::Specimen, with(t))));
        let direction = l.direction.or(any.filter(|_| is_mean)).map(|d| d.to_string());
        pair.header.known.extend(direction.map(|t| (HeaderKey::Direction, with(t))));
    }
}

/// Direction and specimen that the names of the columns state.
fn named_in_heads(pair: &mut Pair) {
    let (x, y) = (&pair.x.says, &pair.y.says);
    let entry = |text: String| Entry { text, line: pair.y.line, column: pair.y.column };
    let direction = y.direction.or(x.direction).map(|d| entry(d.to_string()));
    let specimen = y.specimen.or(x.specimen).map(|n| entry(n.to_string()));
    pair.header.known.extend(direction.map(|e| (HeaderKey::Direction, e)));
    pair.header.known.extend(specimen.map(|e| (HeaderKey::Specimen, e)));
}

impl Scanner<'_, '_> {
    /// Abscissa and ordinate of each curve: a new pair begins where a kind of column comes again.
    /// A single abscissa serves all ordinates that are repeats.
    pub(super) fn pairs(&mut self, columns: Vec<Column>, rows: &[&Row<'_>]) -> Result<Vec<Pair>, ReadError> {
        let mut halves: Vec<Halves> = vec![(None, None)];
        let used = columns.into_iter().filter(|c| c.role != Role::Ignored).collect();
        let columns = self.one_abscissa_each(used, rows);
        let shared = columns.iter().filter(|c| c.role.is_abscissa()).count() == 1;
        for column in columns {
            let abscissa = column.role.is_abscissa();
            let full = halves.last().is_none_or(|(x, y)| if abscissa { x.is_some() } else { y.is_some() });
            if full {
                halves.push((None, None));
            }
            if let Some((x, y)) = halves.last_mut() {
                *if abscissa { x } else { y } = Some(column);
            }
        }
        let first = halves.iter().find_map(|(x, _)| x.clone()).filter(|_| shared);
        if first.is_none() {
            self.leave_out_halves(&mut halves);
        }
        let pair = |(x, y): Halves| match (x.or(first.clone()), y) {
            (Some(x), Some(y)) => Ok(Pair { x, y, back: None, header: self.header.clone() }),
            (Some(c), None) => {
                Err(self.lacks(&c, "an ordinate (force, moment, pressure, friction or height)"))
            }
            (None, Some(c)) => {
                Err(self.lacks(&c, "an abscissa (strain, angle, curvature, thickness or position)"))
            }
            (None, None) => Err(self.context.error(0, 0, ReadProblem::Empty)),
        };
        let mut pairs: Vec<Pair> = halves.into_iter().map(pair).collect::<Result<_, _>>()?;
        if first.is_some() {
            self.leave_out_companions(&mut pairs, rows);
        }
        branches_above(&mut pairs, &self.labels, self.context.vocabulary);
        Ok(joined(pairs))
    }

    /// Leaves out a mean beside whole pairs that has no abscissa, or no ordinate, of its own.
    fn leave_out_halves(&mut self, halves: &mut Vec<Halves>) {
        let whole = halves.iter().any(|(x, y)| x.is_some() && y.is_some());
        let vocabulary = self.context.vocabulary;
        let alone = |half: &Halves| match half {
            (Some(c), None) | (None, Some(c)) if whole => {
                vocabulary.statistic_within(&c.name).map(|_| (c.line, c.name.clone()))
            }
            _ => None,
        };
        let left_out: Vec<(usize, String)> = halves.iter().filter_map(alone).collect();
        self.findings.extend(statistic::finding("columns", &left_out, self.context.path));
        halves.retain(|half| alone(half).is_none());
    }

    fn lacks(&self, column: &Column, other: &str) -> ReadError {
        let found = format!("column {:?} has no partner: {other} is missing", column.name);
        self.context.error(column.line, column.column, ReadProblem::IncompletePair { found })
    }

    /// Gives every pair its own of the header values that were listed for all of them.
    pub(super) fn distribute(&mut self, pairs: &mut [Pair]) -> Result<(), ReadError> {
        for (key, entries) in std::mem::take(&mut self.lists) {
            if let ([pair], HeaderKey::Sample, Some(first)) = (&mut *pairs, key, entries.first()) {
                // `sample,Poplin, white`: a name with commas in it.
                let texts: Vec<&str> = entries.iter().map(|entry| entry.text.as_str()).collect();
                let name = Entry { text: texts.join(", "), ..first.clone() };
                pair.header.known.insert(key, name);
                continue;
            }
            if entries.len() != pairs.len() {
                let (n, m) = (entries.len(), pairs.len());
                let reason = format!("{n} values stand over {m} curves");
                let (line, column) = entries.first().map_or((0, 0), |e| (e.line, e.column));
                let key = format!("{key:?}").to_lowercase();
                return Err(self.context.error(line, column, ReadProblem::BadValue { key, reason }));
            }
            for (pair, entry) in pairs.iter_mut().zip(entries) {
                pair.header.known.insert(key, entry);
            }
        }
        for labels in std::mem::take(&mut self.labels) {
            label(pairs, &labels, self.context.vocabulary);
        }
        self.note_direction_in_heads(pairs);
        pairs.iter_mut().for_each(named_in_heads);
        Ok(())
    }

    /// Leaves out curves that sum up others: `moment 1, moment 2, mean moment` are two.
    pub(super) fn leave_out_statistics(&mut self, pairs: &mut Vec<Pair>) {
        // One curve is all that there is, whatever it is called; most files are of one.
        if pairs.len() < 2 {
            return;
        }
        let vocabulary = self.context.vocabulary;
        let mut kinds: BTreeMap<Role, Kinds> = BTreeMap::new();
        for pair in pairs.iter() {
            kinds.entry(pair.y.role).or_default().add(pair.statistic(vocabulary).map(|(s, _)| s));
        }
        let word = |p: &Pair| {
            let (statistic, word) = p.statistic(vocabulary)?;
            kinds
                .get(&p.y.role)
                .filter(|k| k.leave_out(Some(statistic)))
                .map(|_| (p.y.line, word.to_string()))
        };
        let left_out: Vec<(usize, String)> = pairs.iter().filter_map(word).collect();
        self.findings.extend(statistic::finding("curves", &left_out, self.context.path));
        pairs.retain(|p| word(p).is_none());
    }
}
/// Words that may be dimensions are directions where both stand side by side: `length K`, `length M`, `width K`, `width M`.
pub(super) fn directions_of_dimensions(columns: &mut [Column]) {
    let named = |direction| columns.iter().any(|c| c.says.dimension == Some(direction));
    if named(Direction::Warp) && named(Direction::Weft) {
        columns.iter_mut().for_each(|c| c.says.direction = c.says.direction.or(c.says.dimension));
    }
}
