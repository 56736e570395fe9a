//! Layouts with more in a cell or a heading than its number or name: units in cells, marks on values, conditions, letters of
//! directions, columns of something else, cells merged downwards.

use kesf::instrument::{Direction, Parameter};
use rand::RngExt;
use rand_pcg::Pcg64;

use super::Expected;
use super::grid::{Cell, Grid};
use super::tables::{BOTH, Style, Table, UnitPlace, expect, mean, printed_means, title};
use super::truth::{Fabric, Printing, Quantity, chance, pick};

use Parameter as P;

/// A number with a unit or a mark around it.
fn with(before: &str, number: Printing, behind: &str) -> Cell {
    Cell::With(before.to_string(), number, behind.to_string())
}

/// A value with its unit in the cell, as people type it.
fn united(rng: &mut Pcg64, q: &Quantity) -> Cell {
    let (m, unit) = (mean(q), q.unit.0);
    if matches!(unit, "" | "-") {
        return Cell::Number(m);
    }
    let sd = Printing { value: q.sd(), decimals: m.decimals };
    match rng.random_range(0..6) {
        0 if unit == "%" => with("%", m, ""),
        0 | 1 => with("", m, unit),
        2 if q.repeats.len() > 2 => Cell::Deviation(m, sd, format!(" {unit}")),
        _ => with("", m, &format!(" {unit}")),
    }
}

/// The unit of a parameter's heading beside cells that have their own.
fn head(rng: &mut Pcg64, style: &Style<'_>, q: &Quantity) -> String {
    if chance(rng, 0.3) { style.head(q) } else { style.name(q.parameter) }
}

/// `B | 0.081 gf·cm²/cm | 0.052 gf·cm²/cm`: parameters down with directions across, or across with a row for each direction.
pub fn units_in_cells(rng: &mut Pcg64, style: &Style<'_>, all: &[Fabric]) -> Table {
    let l = style.language;
    let mut grid = Grid::default();
    title(&mut grid, rng, l);
    if chance(rng, 0.5) {
        let fabric = &all[0];
        grid.row(
            std::iter::once(Cell::text(pick(rng, l.parameter)))
                .chain(BOTH.map(|d| Cell::text(style.direction(d))))
                .collect(),
        );
        let mut parameters: Vec<P> = fabric.quantities.iter().map(|q| q.parameter).collect();
        parameters.dedup();
        for p in parameters {
            let mut cells = vec![Cell::text(head(rng, style, fabric.get(p, Some(Direction::Warp))))];
            for d in if p.is_directional() { &BOTH[..] } else { &BOTH[..1] } {
                cells.push(united(rng, fabric.get(p, Some(*d))));
            }
            grid.row(cells);
        }
        return Table {
            layout: "units in cells, down",
            grid,
            expected: printed_means(fabric, false),
            workbook: false,
        };
    }
    across(rng, style, all, &mut grid, united, head);
    let expected = all.iter().flat_map(|f| printed_means(f, true)).collect();
    Table { layout: "units in cells, across", grid, expected, workbook: false }
}

/// `Sample, Direction, parameters`, with cells and heads made by functions.
fn across(
    rng: &mut Pcg64,
    style: &Style<'_>,
    all: &[Fabric],
    grid: &mut Grid,
    mut cell: impl FnMut(&mut Pcg64, &Quantity) -> Cell,
    mut name: impl FnMut(&mut Pcg64, &Style<'_>, &Quantity) -> String,
) {
    let l = style.language;
    let directional = all[0].quantities[0].direction.is_some();
    let directions: Vec<Option<Direction>> = if directional { BOTH.map(Some).to_vec() } else { vec![None] };
    let heads: Vec<&Quantity> = all[0].quantities.iter().filter(|q| q.direction == directions[0]).collect();
    let mut top = vec![Cell::text(pick(rng, l.sample))];
    top.extend(directional.then(|| Cell::text(pick(rng, l.direction))));
    top.extend(heads.iter().map(|q| Cell::text(name(rng, style, q))));
    grid.row(top);
    for f in all {
        for d in &directions {
            let mut cells = vec![Cell::text(&f.name)];
            cells.extend(d.map(|d| Cell::text(style.direction(d))));
            let of_row = f.quantities.iter().filter(|q| q.direction == *d);
            cells.extend(of_row.map(|q| cell(rng, q)));
            grid.row(cells);
        }
    }
}

/// `B = 0.081 gf·cm²/cm`, a line for each value under the name of its direction.
pub fn lines(rng: &mut Pcg64, style: &Style<'_>, fabric: &Fabric) -> Table {
    let mut grid = Grid::default();
    let mark = pick(rng, &[" = ", ": ", "=", " : "]);
    let directions: Vec<Option<Direction>> =
        if fabric.quantities[0].direction.is_some() { BOTH.map(Some).to_vec() } else { vec![None] };
    for d in directions {
        if let Some(d) = d {
            grid.texts(&[style.direction(d)]);
        }
        for q in fabric.quantities.iter().filter(|q| q.direction == d) {
            let unit = if q.unit.0 == "-" { "" } else { q.unit.0 };
            let behind = if unit.is_empty() { String::new() } else { format!(" {unit}") };
            grid.row(vec![with(&format!("{}{mark}", style.symbol(q.parameter)), mean(q), &behind)]);
        }
    }
    Table { layout: "lines of one value", grid, expected: printed_means(fabric, false), workbook: false }
}

/// Units that contradict the heading, or that nobody knows: the value may not be read.
pub fn wrong_units(rng: &mut Pcg64, style: &Style<'_>, fabric: &Fabric) -> Table {
    let mut grid = Grid::default();
    let q = &fabric.quantities[0];
    let contradicts = chance(rng, 0.5);
    let own = if contradicts {
        pick(rng, &["kPa", "oz/yd2", "N", "mm"])
    } else {
        pick(rng, &["foo/cm", "gg·cm²/cm", "xN/m²"])
    };
    let named = Style { unit: UnitPlace::Round, ..*style };
    let heading = if contradicts { named.head(q) } else { style.name(q.parameter) };
    grid.row(vec![
        Cell::text(pick(rng, style.language.sample)),
        Cell::text(pick(rng, style.language.direction)),
        Cell::text(heading),
    ]);
    for d in BOTH {
        let value = mean(fabric.get(q.parameter, Some(d)));
        // A dimensionless value has no unit that a cell could contradict, but none of these is one either.
        grid.row(vec![
            Cell::text(&fabric.name),
            Cell::text(style.direction(d)),
            with("", value, &format!(" {own}")),
        ]);
    }
    Table {
        layout: "contradicting or unknown units",
        grid,
        expected: vec![Expected::Refusal],
        workbook: false,
    }
}

/// The condition of a parameter as people write it behind its symbol.
fn condition(p: P) -> Option<(&'static str, &'static [&'static str])> {
    Some(match p {
        P::Hg => ("2HG", &[" at 0.5 deg", " (0.5°)", " @0.5 deg", " at 0.5 degrees"]),
        P::Hg5 => ("2HG", &[" at 5 deg", " (5°)", " @5 deg", "5 at 5 degrees"]),
        P::Emt => ("EMT", &[" at 500 gf/cm", " (500 gf/cm)", " @500 gf/cm", " at 490.3325 N/m"]),
        P::Hb => ("2HB", &[" at 1 1/cm", " at K = 1 1/cm"]),
        P::T0 => ("T", &[" at 0.5 gf/cm2", " (0.5 gf/cm²)"]),
        P::Tm => ("T", &[" at 50 gf/cm2", " (50 gf/cm²)"]),
        _ => return None,
    })
}

/// Conditions in headings, and beside them the same parameters under other conditions, which are none of the values.
pub fn conditions(rng: &mut Pcg64, style: &Style<'_>, all: &[Fabric]) -> Table {
    const OTHERS: [(P, &str, f64); 4] = [
        (P::Hg, "2HG at 3 deg (gf/cm)", 1.9),
        (P::Emt, "EMT at 50 gf/cm (%)", 0.31),
        (P::Hb, "2HB at 2 1/cm (gf·cm/cm)", 1.4),
        (P::T0, "T at 2 gf/cm2 (mm)", 0.93),
    ];
    let mut grid = Grid::default();
    let style = &Style {
        unit: if style.unit == UnitPlace::Square { UnitPlace::Square } else { UnitPlace::Round },
        ..*style
    };
    let directional = all[0].quantities[0].direction.is_some();
    let directions: Vec<Option<Direction>> = if directional { BOTH.map(Some).to_vec() } else { vec![None] };
    let heads: Vec<&Quantity> = all[0].quantities.iter().filter(|q| q.direction == directions[0]).collect();
    let others: Vec<&(P, &str, f64)> =
        OTHERS.iter().filter(|(p, ..)| heads.iter().any(|q| q.parameter == *p) && chance(rng, 0.5)).collect();
    let mut top = vec![Cell::text(pick(rng, style.language.sample))];
    top.extend(directional.then(|| Cell::text(pick(rng, style.language.direction))));
    for q in &heads {
        let name = match condition(q.parameter) {
            Some((symbol, all)) => format!("{symbol}{}", pick(rng, all)),
            None => style.name(q.parameter),
        };
        top.push(Cell::text(style.with_unit(name, q.unit)));
    }
    top.extend(others.iter().map(|(_, name, _)| Cell::text(*name)));
    grid.row(top);
    for f in all {
        for d in &directions {
            let mut cells = vec![Cell::text(&f.name)];
            cells.extend(d.map(|d| Cell::text(style.direction(d))));
            let of_row = f.quantities.iter().filter(|q| q.direction == *d);
            cells.extend(of_row.map(|q| Cell::Number(mean(q))));
            let other =
                |(p, _, part): &&(P, &str, f64)| Cell::Number(Printing::of(part * f.get(*p, *d).mean()));
            cells.extend(others.iter().map(other));
            grid.row(cells);
        }
    }
    let expected = all.iter().flat_map(|f| printed_means(f, true)).collect();
    Table { layout: "conditions in headings", grid, expected, workbook: false }
}

/// Footnotes, letters of significance, bounds, gaps and powers of ten in the cells of values.
pub fn marked(rng: &mut Pcg64, style: &Style<'_>, all: &[Fabric]) -> Table {
    let mut grid = Grid::default();
    let mut left_out: Vec<(String, P, Option<Direction>)> = Vec::new();
    let mut at = 0;
    // In the order of the cells.
    let directional = all[0].quantities[0].direction.is_some();
    let directions: Vec<Option<Direction>> = if directional { BOTH.map(Some).to_vec() } else { vec![None] };
    let mut order = Vec::new();
    for f in all {
        for d in &directions {
            order.extend(
                f.quantities.iter().filter(|q| q.direction == *d).map(|q| (f.name.clone(), q.parameter, *d)),
            );
        }
    }
    let cell = |rng: &mut Pcg64, q: &Quantity| {
        let m = mean(q);
        let this = order[at].clone();
        at += 1;
        match rng.random_range(0..14) {
            0 | 1 => with("", m, pick(rng, &["*", "**", "†", " *"])),
            2 if m.decimals > 0 => with("", m, pick(rng, &["a", "b", "ab", " a"])),
            3 => {
                left_out.push(this);
                with(pick(rng, &["<", "> ", "≤", "~"]), m, "")
            }
            4 => {
                left_out.push(this);
                Cell::text(pick(rng, &["n.d.", "n/a", "N/A", "-", "–", "n.a.", "nd"]))
            }
            5 => {
                let tenfold = Printing { value: m.value * 100.0, decimals: m.decimals.max(2) - 2 };
                let exact = (format!("{:.*}", tenfold.decimals, tenfold.value).parse::<f64>().unwrap_or(0.0)
                    - tenfold.value)
                    .abs()
                    < 1e-9 * tenfold.value;
                if exact {
                    with("", tenfold, pick(rng, &["×10⁻²", " x 10^-2", "e-2", "E-02", "·10-2"]))
                } else {
                    Cell::Number(m)
                }
            }
            _ => Cell::Number(m),
        }
    };
    let style =
        &Style { unit: if style.unit == UnitPlace::Own { UnitPlace::Round } else { style.unit }, ..*style };
    across(rng, style, all, &mut grid, cell, |_, style, q| style.head(q));
    let mut expected = Vec::new();
    for f in all {
        for q in &f.quantities {
            if !left_out.contains(&(f.name.clone(), q.parameter, q.direction)) {
                expected.push(expect(f, q, mean(q).value, true));
            }
        }
    }
    Table { layout: "marks on values", grid, expected, workbook: false }
}

/// Letters of directions in heads: `B_K`, `B (S)`, or under `Direction`.
pub fn letters(rng: &mut Pcg64, style: &Style<'_>, all: &[Fabric]) -> Table {
    let pairs: &[[&str; 2]] = match style.language.name {
        "de" => &[["K", "S"], ["MD", "CD"]],
        "tr" => &[["Ç", "A"]],
        "pt" | "es" => &[["U", "T"]],
        "it" => &[["O", "T"]],
        _ => &[["L", "T"], ["MD", "CD"]],
    };
    let [warp, weft] = pick(rng, pairs);
    let letter = |d: Direction| if d == Direction::Warp { warp } else { weft };
    let mut grid = Grid::default();
    if chance(rng, 0.4) {
        let lettered = Style { warp, weft, unit: UnitPlace::Round, ..*style };
        across(rng, &lettered, all, &mut grid, |_, q| Cell::Number(mean(q)), |_, style, q| style.head(q));
        let expected = all.iter().flat_map(|f| printed_means(f, true)).collect();
        return Table { layout: "letters of directions, in a column", grid, expected, workbook: false };
    }
    let form = rng.random_range(0..3);
    let name = |q: &Quantity| {
        let symbol = style.symbol(q.parameter);
        let named = match (form, q.direction.map(letter)) {
            (_, None) => symbol.to_string(),
            (0, Some(d)) => format!("{symbol}_{d}"),
            (1, Some(d)) => format!("{symbol}-{d}"),
            (_, Some(d)) => format!("{symbol} ({d})"),
        };
        Style { unit: UnitPlace::Round, ..*style }.with_unit(named, q.unit)
    };
    let mut top = vec![Cell::text(pick(rng, style.language.sample))];
    top.extend(all[0].quantities.iter().map(|q| Cell::text(name(q))));
    grid.row(top);
    for f in all {
        let mut cells = vec![Cell::text(&f.name)];
        cells.extend(f.quantities.iter().map(|q| Cell::Number(mean(q))));
        grid.row(cells);
    }
    let expected = all.iter().flat_map(|f| printed_means(f, true)).collect();
    Table { layout: "letters of directions, in heads", grid, expected, workbook: false }
}

/// Columns of numbers that are no values: settings, counters of a machine, keys to photographs.
pub fn strangers(rng: &mut Pcg64, style: &Style<'_>, all: &[Fabric]) -> Table {
    let l = style.language;
    let mut grid = Grid::default();
    let heads: &[&str] = pick(
        rng,
        &[&["Setting"][..], &["a1", "a2"], &["F1", "F2"], &["Machine"], &["", "Setting"], &["Photo"]],
    );
    let whole =
        |rng: &mut Pcg64| Cell::Number(Printing { value: rng.random_range(1..9) as f64, decimals: 0 });
    let odd = |rng: &mut Pcg64| Cell::Number(Printing::of(1.0 + 9.0 * rng.random::<f64>()));
    let integers = chance(rng, 0.5);
    let other = |rng: &mut Pcg64| if integers { whole(rng) } else { odd(rng) };
    let fabric = &all[0];
    if chance(rng, 0.5) {
        let mut top = vec![Cell::text(pick(rng, l.parameter)), Cell::text(pick(rng, l.unit))];
        let inside = chance(rng, 0.5) && heads.len() == 1;
        top.push(Cell::text(style.warp));
        top.extend(inside.then(|| Cell::text(heads[0])));
        top.push(Cell::text(style.weft));
        if !inside {
            top.extend(heads.iter().map(|h| Cell::text(*h)));
        }
        grid.row(top);
        let mut parameters: Vec<P> = fabric.quantities.iter().map(|q| q.parameter).collect();
        parameters.dedup();
        for p in parameters {
            let q = fabric.get(p, Some(Direction::Warp));
            let mut cells =
                vec![Cell::text(style.name(p)), Cell::text(if q.unit.0.is_empty() { "-" } else { q.unit.0 })];
            cells.push(Cell::Number(mean(q)));
            cells.extend(inside.then(|| other(rng)));
            cells.push(if p.is_directional() {
                Cell::Number(mean(fabric.get(p, Some(Direction::Weft))))
            } else {
                Cell::Empty
            });
            if !inside {
                cells.extend(heads.iter().map(|_| other(rng)));
            }
            grid.row(cells);
        }
        let expected = printed_means(fabric, false);
        return Table { layout: "numbers under unknown heads, down", grid, expected, workbook: false };
    }
    let directional = fabric.quantities[0].direction.is_some();
    let directions: Vec<Option<Direction>> = if directional { BOTH.map(Some).to_vec() } else { vec![None] };
    let of_heads: Vec<&Quantity> =
        fabric.quantities.iter().filter(|q| q.direction == directions[0]).collect();
    let named = Style { unit: UnitPlace::Round, ..*style };
    let mut top = vec![Cell::text(pick(rng, l.sample))];
    top.extend(directional.then(|| Cell::text(pick(rng, l.direction))));
    let heads: Vec<&&str> = heads.iter().filter(|h| !h.is_empty()).collect();
    top.extend(heads.iter().map(|h| Cell::text(**h)));
    top.extend(of_heads.iter().map(|q| Cell::text(named.head(q))));
    grid.row(top);
    for f in all {
        for d in &directions {
            let mut cells = vec![Cell::text(&f.name)];
            cells.extend(d.map(|d| Cell::text(style.direction(d))));
            cells.extend(heads.iter().map(|_| other(rng)));
            cells.extend(f.quantities.iter().filter(|q| q.direction == *d).map(|q| Cell::Number(mean(q))));
            grid.row(cells);
        }
    }
    let expected = all.iter().flat_map(|f| printed_means(f, true)).collect();
    Table { layout: "numbers under unknown heads, across", grid, expected, workbook: false }
}

/// Repeats under a sample and a direction that are merged downwards.
pub fn merged_down(rng: &mut Pcg64, style: &Style<'_>, all: &[Fabric]) -> Table {
    let l = style.language;
    let mut grid = Grid::default();
    title(&mut grid, rng, l);
    let directional = all[0].quantities[0].direction.is_some();
    let directions: Vec<Option<Direction>> = if directional { BOTH.map(Some).to_vec() } else { vec![None] };
    let heads: Vec<&Quantity> = all[0].quantities.iter().filter(|q| q.direction == directions[0]).collect();
    let named = Style { unit: UnitPlace::Round, ..*style };
    let mut top = vec![Cell::text(pick(rng, l.sample))];
    top.extend(directional.then(|| Cell::text(pick(rng, l.direction))));
    top.push(Cell::text(pick(rng, l.number)));
    top.extend(heads.iter().map(|q| Cell::text(named.head(q))));
    grid.row(top);
    let n = heads[0].repeats.len();
    for f in all {
        let first = grid.rows.len();
        grid.merged_down.push((first, 0, n * directions.len()));
        for d in &directions {
            let at = grid.rows.len();
            if directional {
                grid.merged_down.push((at, 1, n));
            }
            let of_row: Vec<&Quantity> = f.quantities.iter().filter(|q| q.direction == *d).collect();
            for i in 0..n {
                let mut cells =
                    vec![if grid.rows.len() == first { Cell::text(&f.name) } else { Cell::Empty }];
                cells.extend(d.map(|d| if i == 0 { Cell::text(style.direction(d)) } else { Cell::Empty }));
                cells.push(Cell::Number(Printing { value: (i + 1) as f64, decimals: 0 }));
                cells.extend(of_row.iter().map(|q| Cell::Number(q.repeats[i])));
                grid.row(cells);
            }
        }
    }
    let expected =
        all.iter().flat_map(|f| f.quantities.iter().map(|q| expect(f, q, q.mean(), true))).collect();
    Table { layout: "merged downwards", grid, expected, workbook: false }
}
