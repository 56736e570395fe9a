//! Headings of result tables: symbols with direction, unit and marks in one cell.

use super::dialect::{Statistic, TableColumn};
use super::fast::{self, FastValue};
use super::raw::Row;
use super::sniff::folded;
use super::words::{Vocabulary, normalised, split_unit};
use super::{Direction, Parameter};

/// A column of a result table.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Column {
    Meta(TableColumn),
    Parameter(ParameterColumn),
    /// Values of one direction (long form).
    Of(Direction),
    /// A FAST value, its direction and its unit.
    Fast(FastValue, Option<Direction>, Option<String>),
}

/// A parameter in a heading: `B_warp_uN_m`, `EMT weft (%)`, `2HB sd`.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ParameterColumn {
    pub parameter: Parameter,
    pub direction: Option<Direction>,
    pub unit: Option<String>,
    pub sd: bool,
    pub inferred: bool,
}

/// Whether a row is the heading of a result table.
pub(super) fn is_heading(row: &Row<'_>, vocabulary: Vocabulary<'_>) -> bool {
    // Header lines carry values; headings never do.
    let value =
        |t: &str| t.starts_with(|c: char| c.is_ascii_digit()) && parameter_column(t, vocabulary).is_none();
    if row.filled().any(|(_, c)| value(&folded(&c.text))) {
        return false;
    }
    let columns: Vec<Column> = row.filled().filter_map(|(_, c)| column(&c.text, vocabulary)).collect();
    let filled = row.filled().count();
    let has = |t| columns.contains(&Column::Meta(t));
    let has_unit = |c: &Column| match c {
        Column::Parameter(p) => Some(p.unit.is_some()),
        Column::Fast(_, _, unit) => Some(unit.is_some()),
        _ => None,
    };
    let parameters: Vec<bool> = columns.iter().filter_map(has_unit).collect();
    let long = has(TableColumn::Parameter)
        && columns.iter().any(|c| matches!(c, Column::Meta(TableColumn::Value) | Column::Of(_)));
    let named = [TableColumn::Id, TableColumn::Fabric, TableColumn::Direction].into_iter().any(has);
    // `sample,B` is a header line of a fabric called B.
    let wide = parameters.len() >= 2
        || (parameters.len() == 1 && named && (filled > 2 || parameters.contains(&true)));
    long || wide
}

/// What a heading names.
pub(super) fn column(cell: &str, vocabulary: Vocabulary<'_>) -> Option<Column> {
    let (name, _) = split_unit(cell);
    if let Some(meta) = vocabulary.table_column(&name) {
        return Some(Column::Meta(meta));
    }
    if let Some(parameter) = parameter_column(cell, vocabulary) {
        return Some(Column::Parameter(parameter));
    }
    if let Some((value, direction, unit)) = fast::heading(cell) {
        return Some(Column::Fast(value, direction, unit));
    }
    let direction = vocabulary.direction(&name).filter(|_| name.chars().count() < 12)?;
    (!sums_up(cell, vocabulary)).then_some(Column::Of(direction))
}

/// Whether a heading is that of deviations or extremes: `warp SD`, `LT CV (%)`.
pub(super) fn sums_up(cell: &str, vocabulary: Vocabulary<'_>) -> bool {
    let statistic = vocabulary.statistic_within(&split_unit(cell).0);
    matches!(statistic, Some(Statistic::Spread | Statistic::Other))
}

/// In a table with FAST columns, `-1` and `-2` behind a symbol are warp and weft.
fn fast_column(cell: &str, vocabulary: Vocabulary<'_>) -> Option<Column> {
    let (name, unit) = split_unit(cell);
    let (symbol, direction) = fast::with_direction(&name);
    let parameter = vocabulary.parameter(symbol).filter(|_| direction.is_some())?;
    Some(Column::Parameter(ParameterColumn { parameter, direction, unit, sd: false, inferred: false }))
}

/// A parameter, alone or with direction, unit and marks: `B`, `B_warp_uN_m`, `2HB sd`.
pub(super) fn parameter_column(cell: &str, vocabulary: Vocabulary<'_>) -> Option<ParameterColumn> {
    let text = folded(cell).into_owned();
    let (name, mut unit) = if text.contains('_') { (text, None) } else { split_unit(&text) };
    let mut found =
        ParameterColumn { parameter: Parameter::B, direction: None, unit: None, sd: false, inferred: false };
    if let Some(parameter) = vocabulary.parameter(&name) {
        found.parameter = parameter;
        found.unit = unit;
        return Some(found);
    }
    let mut symbol: Vec<&str> = Vec::new();
    let mut unit_parts: Vec<&str> = Vec::new();
    let mut parameter = None;
    for part in name.split(['_', ' ', '(', ')', '-', ',']).filter(|p| !p.is_empty()) {
        match normalised(part).as_str() {
            "sd" | "std" | "stdev" => found.sd = true,
            "inferred" => found.inferred = true,
            "mean" | "average" => {}
            _ if parameter.is_some() && vocabulary.direction(part).is_some() => {
                found.direction = vocabulary.direction(part);
            }
            _ if parameter.is_some() => unit_parts.push(part),
            _ => {
                symbol.push(part);
                parameter = vocabulary.parameter(&symbol.join(" "));
            }
        }
    }
    let rest = unit_parts.join(" ");
    // One letter is a unit: `s` in `B_s` is a second.
    if rest.chars().count() > 1 {
        match vocabulary.statistic(&rest) {
            _ if vocabulary.table_column(&rest) == Some(TableColumn::Sd) => found.sd = true,
            Some(Statistic::Mean) => {}
            // `LT CV (%)` is no LT.
            Some(Statistic::Spread | Statistic::Other) => return None,
            None => unit = unit.or_else(|| Some(spelt_out(&unit_parts))),
        }
    } else if !unit_parts.is_empty() {
        unit = unit.or_else(|| Some(spelt_out(&unit_parts)));
    }
    found.parameter = parameter?;
    found.unit = unit;
    Some(found)
}

/// `gf cm2 per cm` as a unit: `gf·cm2/cm`; several divisors go in brackets.
fn spelt_out(parts: &[&str]) -> String {
    let at = parts.iter().position(|p| *p == "per").unwrap_or(parts.len());
    let symbols =
        |p: &[&str]| p.iter().map(|s| if *s == "percent" { "%" } else { s }).collect::<Vec<_>>().join("·");
    let above = if at == 0 { "1".to_string() } else { symbols(&parts[..at]) };
    if at >= parts.len() { above } else { format!("{above}/({})", symbols(&parts[at + 1..])) }
}

/// The meaning of every cell of a heading row.
pub(super) fn columns(heading: &Row<'_>, vocabulary: Vocabulary<'_>) -> Vec<Option<Column>> {
    let of_fast = ["E5", "E20", "E100", "EB5", "C"];
    let is_fast = |text: &str| {
        let name = split_unit(text).0;
        of_fast.contains(&fast::with_direction(&name).0)
    };
    let fast = heading.filled().any(|(_, c)| is_fast(&folded(&c.text)));
    let meaning = |text: &str| {
        let of_fast = if fast { fast_column(text, vocabulary) } else { None };
        of_fast.or_else(|| column(text, vocabulary))
    };
    heading.cells.iter().map(|c| if c.text.trim().is_empty() { None } else { meaning(&c.text) }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parameter(text: &str) -> (Parameter, Option<Direction>, Option<String>, bool, bool) {
        let p = parameter_column(text, Vocabulary::new(&[])).unwrap();
        (p.parameter, p.direction, p.unit, p.sd, p.inferred)
    }

    #[test]
    fn symbols_with_everything_that_print_puts_beside_them() {
        use Direction::{Warp, Weft};
        use Parameter::{B, Emt, G, Hb, Hg5, T0};
        let unit = |u: &str| Some(u.to_string());
        assert_eq!(parameter("B_gf_cm2_per_cm"), (B, None, unit("gf·cm2/(cm)"), false, false));
        assert_eq!(parameter("B_warp_uN_m"), (B, Some(Warp), unit("uN·m"), false, false));
        assert_eq!(parameter("EMT_weft_percent_inferred"), (Emt, Some(Weft), unit("%"), false, true));
        assert_eq!(parameter("G [gf/(cm·deg)]"), (G, None, unit("gf/(cm·deg)"), false, false));
        assert_eq!(parameter("2HB warp (gf·cm/cm)"), (Hb, Some(Warp), unit("gf·cm/cm"), false, false));
        assert_eq!(parameter("2HG5 sd"), (Hg5, None, None, true, false));
        assert_eq!(parameter("T_mm"), (T0, None, unit("mm"), false, false));
        assert_eq!(parameter("G_gf_per_cm_deg").2, unit("gf/(cm·deg)"));
        assert_eq!(parameter("2HB desvio padrão (gf·cm/cm)"), (Hb, None, unit("gf·cm/cm"), true, false));
        assert!(parameter("B standard deviation").3);
        assert_eq!(parameter("B Mittelwert (gf·cm²/cm)").2, unit("gf·cm2/cm"));
        for none in ["drape_nodes", "LT CV (%)", "EMT warp max (%)", "CV of LT (%)"] {
            assert_eq!(parameter_column(none, Vocabulary::new(&[])), None, "{none}");
            assert_eq!(column(none, Vocabulary::new(&[])), None, "{none}");
        }
        assert_eq!(column("warp SD", Vocabulary::new(&[])), None);
    }
}
