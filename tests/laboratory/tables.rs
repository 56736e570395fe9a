//! Result tables as laboratories lay them out.

use kesf::instrument::{Direction, Parameter};
use rand::RngExt;
use rand_pcg::Pcg64;

use super::grid::{Cell, Grid};
use super::truth::{Fabric, GROUPS, Printed, Printing, Quantity, chance, fabrics, pick};
use super::words::Language;
use super::{Expected, newer};

use Parameter as P;

/// A sheet, what it is called, and what it says.
pub struct Table {
    pub layout: &'static str,
    pub grid: Grid,
    pub expected: Vec<Expected>,
    /// Whether only a workbook can hold it.
    pub workbook: bool,
}

/// How heads are written in one file.
#[derive(Clone, Copy)]
pub struct Style<'l> {
    pub language: &'l Language,
    /// Around a unit: `B (unit)`, `B [unit]`, `B, unit`, `B/unit`; empty: in a row or column of its own.
    pub unit: UnitPlace,
    pub warp: &'l str,
    pub weft: &'l str,
    /// Full names beside or in place of symbols.
    pub names: Names,
    /// EM for EMT, T for T0, TM for Tm.
    pub old: bool,
    /// Line breaks in headings, in place of the blanks before symbols and units.
    pub breaks: bool,
}

#[derive(Clone, Copy, PartialEq)]
pub enum UnitPlace {
    Round,
    Square,
    Comma,
    Own,
}

#[derive(Clone, Copy, PartialEq)]
pub enum Names {
    Symbol,
    Full,
    Both,
}

impl Style<'_> {
    pub fn direction(&self, d: Direction) -> &str {
        if d == Direction::Warp { self.warp } else { self.weft }
    }

    pub fn symbol(&self, p: P) -> &'static str {
        match p {
            P::Emt if self.old => "EM",
            P::T0 if self.old => "T",
            P::Tm => "TM",
            p => p.symbol(),
        }
    }

    pub fn name(&self, p: P) -> String {
        match (self.names, self.language.full_name(p)) {
            (Names::Full, Some(name)) => name.to_string(),
            (Names::Both, Some(name)) => format!("{name}{}{}", self.blank(), self.symbol(p)),
            _ => self.symbol(p).to_string(),
        }
    }

    fn blank(&self) -> char {
        if self.breaks { '\n' } else { ' ' }
    }

    pub fn with_unit(&self, name: String, (unit, _): Printed) -> String {
        match self.unit {
            _ if unit.is_empty() || (unit == "-" && self.unit != UnitPlace::Square) => name,
            UnitPlace::Round => format!("{name}{}({unit})", self.blank()),
            UnitPlace::Square => format!("{name}{}[{unit}]", self.blank()),
            UnitPlace::Comma => format!("{name}, {unit}"),
            UnitPlace::Own => name,
        }
    }

    pub fn head(&self, q: &Quantity) -> String {
        self.with_unit(self.name(q.parameter), q.unit)
    }
}

pub const BOTH: [Direction; 2] = [Direction::Warp, Direction::Weft];

fn number(p: Printing) -> Cell {
    Cell::Number(p)
}

pub fn mean(q: &Quantity) -> Printing {
    Printing::of(q.mean())
}

pub fn expect(fabric: &Fabric, q: &Quantity, value: f64, named: bool) -> Expected {
    Expected::Value {
        fabric: named.then(|| fabric.name.clone()),
        parameter: q.parameter,
        direction: q.direction,
        si: value * q.unit.1,
    }
}

/// What the table says of a fabric if it prints the mean of each quantity.
pub fn printed_means(fabric: &Fabric, named: bool) -> Vec<Expected> {
    fabric.quantities.iter().map(|q| expect(fabric, q, mean(q).value, named)).collect()
}

/// What the table says if it prints the repeats.
fn repeats(fabric: &Fabric, named: bool) -> Vec<Expected> {
    fabric.quantities.iter().map(|q| expect(fabric, q, q.mean(), named)).collect()
}

pub fn title(grid: &mut Grid, rng: &mut Pcg64, l: &Language) {
    if chance(rng, 0.5) {
        grid.texts(&[l.title]);
        if chance(rng, 0.5) {
            grid.texts(&[l.date, "2024-05-17"]);
            grid.texts(&[l.operator, "M. Sato"]);
        }
        if chance(rng, 0.7) {
            grid.blank();
        }
    }
}

/// Rows of the mean, the deviation and so on under repeats; each list is one row.
fn statistics(rng: &mut Pcg64, l: &Language, quantities: &[&Quantity]) -> Vec<(String, Vec<Cell>)> {
    let mut out = Vec::new();
    if chance(rng, 0.85) {
        out.push((pick(rng, l.mean).to_string(), quantities.iter().map(|q| number(mean(q))).collect()));
    }
    if chance(rng, 0.5) {
        let sds = quantities.iter().map(|q| number(Printing::of(q.sd()))).collect();
        out.push((pick(rng, l.sd).to_string(), sds));
    }
    if chance(rng, 0.3) {
        let cvs = quantities.iter().map(|q| number(Printing::of(100.0 * q.sd() / q.mean()))).collect();
        out.push((pick(rng, l.cv).to_string(), cvs));
    }
    if chance(rng, 0.15) {
        let most = |q: &&Quantity| {
            q.repeats.iter().copied().max_by(|a, b| a.value.total_cmp(&b.value)).expect("one")
        };
        out.push((pick(rng, l.max).to_string(), quantities.iter().map(|q| number(most(q))).collect()));
    }
    out
}

/// Any result table.
pub fn any(rng: &mut Pcg64, l: &Language) -> Table {
    let group = pick(rng, GROUPS);
    let si = chance(rng, 0.5);
    let style = Style {
        language: l,
        unit: pick(
            rng,
            &[UnitPlace::Round, UnitPlace::Round, UnitPlace::Square, UnitPlace::Comma, UnitPlace::Own],
        ),
        warp: pick(rng, l.warp),
        weft: pick(rng, l.weft),
        names: pick(rng, &[Names::Symbol, Names::Symbol, Names::Symbol, Names::Both, Names::Full]),
        old: chance(rng, 0.3),
        breaks: chance(rng, 0.12),
    };
    let directional: Vec<P> = group.iter().copied().filter(|p| p.is_directional()).collect();
    let n = rng.random_range(2..6);
    let layout = rng.random_range(0..24);
    // Layouts with a head for each direction hold directional parameters alone, or all.
    let own = if directional.is_empty() { group } else { &directional[..] };
    let parameters = if matches!(layout, 0 | 4 | 5 | 11) { group } else { own };
    let count = if matches!(layout, 4 | 6..=9 | 14 | 16 | 17) { 1 } else { rng.random_range(2..5) };
    let repeats = if matches!(layout, 6..=10 | 14 | 23) { n } else { 1 };
    let all = fabrics(rng, parameters, count, if matches!(layout, 13 | 15) { 3 } else { repeats }, si);
    let one = &all[0];
    match layout {
        0 => wide(rng, &style, &all),
        1 => wide_heads(rng, &style, &all),
        2 => two_rows(rng, &style, &all, true),
        3 => two_rows(rng, &style, &all, false),
        4 => transposed(rng, &style, one),
        5 => fabrics_across(rng, &style, &all),
        6 => sections(rng, &style, one),
        7 => numbered_across(rng, &style, one, true),
        8 => numbered_across(rng, &style, one, false),
        9 => numbered_rows(rng, &style, one),
        10 => tidy(rng, &style, &all),
        11 => long(rng, &style, &all),
        12 => literature(rng, &style, &all),
        13 => plus_minus(rng, &style, &all),
        14 => side_by_side(rng, &style, one),
        15 => newer::units_in_cells(rng, &style, &all),
        16 => newer::lines(rng, &style, one),
        17 if one.quantities[0].direction.is_some() => newer::wrong_units(rng, &style, one),
        17 | 18 => newer::conditions(rng, &style, &all),
        19 | 20 => newer::marked(rng, &style, &all),
        21 => newer::letters(rng, &style, &all),
        22 => newer::strangers(rng, &style, &all),
        _ => newer::merged_down(rng, &style, &all),
    }
}

fn unit_row(grid: &mut Grid, style: &Style<'_>, lead: usize, quantities: &[&Quantity]) {
    if style.unit != UnitPlace::Own {
        return;
    }
    let mut cells = vec![Cell::Empty; lead];
    let bracket = quantities.first().is_some_and(|q| q.unit.0.len() % 2 == 0);
    cells.extend(quantities.iter().map(|q| match q.unit.0 {
        "" | "-" => Cell::text("-"),
        u if bracket => Cell::text(format!("({u})")),
        u => Cell::text(u),
    }));
    grid.row(cells);
}

/// `Sample, Direction, B (unit), 2HB (unit)`: a row for each fabric and direction; the head again on every page.
fn wide(rng: &mut Pcg64, style: &Style<'_>, all: &[Fabric]) -> Table {
    let l = style.language;
    let mut grid = Grid::default();
    title(&mut grid, rng, l);
    let parameters: Vec<P> = all[0].quantities.iter().map(|q| q.parameter).collect();
    let mut parameters: Vec<P> = parameters;
    parameters.dedup();
    let directional = parameters.iter().any(|p| p.is_directional());
    let first: Vec<&Quantity> = parameters.iter().map(|p| all[0].get(*p, Some(Direction::Warp))).collect();
    let lead = if directional { 2 } else { 1 };
    let (sample, direction) = (pick(rng, l.sample), pick(rng, l.direction));
    let head = |grid: &mut Grid| {
        let mut cells = vec![Cell::text(sample)];
        cells.extend(directional.then(|| Cell::text(direction)));
        cells.extend(first.iter().map(|q| Cell::text(style.head(q))));
        grid.row(cells);
        unit_row(grid, style, lead, &first);
    };
    head(&mut grid);
    let paged = chance(rng, 0.2);
    let once = chance(rng, 0.3);
    for (i, fabric) in all.iter().enumerate() {
        if paged && i > 0 && i % 2 == 0 {
            if chance(rng, 0.5) {
                grid.blank();
            }
            head(&mut grid);
        }
        for d in if directional { &BOTH[..] } else { &BOTH[..1] } {
            // Many type the name into the first of its rows only.
            let shown = !(once && *d == Direction::Weft);
            let mut cells = vec![if shown { Cell::text(&fabric.name) } else { Cell::Empty }];
            cells.extend(directional.then(|| Cell::text(style.direction(*d))));
            cells.extend(parameters.iter().map(|p| number(mean(fabric.get(*p, Some(*d))))));
            grid.row(cells);
        }
    }
    let expected = all.iter().flat_map(|f| printed_means(f, true)).collect();
    Table { layout: "wide", grid, expected, workbook: false }
}

/// `Sample, B warp (unit), B weft (unit)`.
fn wide_heads(rng: &mut Pcg64, style: &Style<'_>, all: &[Fabric]) -> Table {
    let l = style.language;
    let mut grid = Grid::default();
    title(&mut grid, rng, l);
    let form = rng.random_range(0..5);
    let name = |q: &Quantity| {
        let (symbol, Some(d)) = (style.name(q.parameter), q.direction) else { return style.head(q) };
        let word = style.direction(d);
        let named = match form {
            0 => format!("{symbol} {word}"),
            1 => format!("{word} {symbol}"),
            2 => format!("{symbol}_{word}"),
            3 => format!("{symbol}-{word}"),
            _ => format!("{symbol} ({word})"),
        };
        style.with_unit(named, q.unit)
    };
    let quantities: Vec<&Quantity> = all[0].quantities.iter().collect();
    let mut head = vec![Cell::text(pick(rng, l.sample))];
    head.extend(quantities.iter().map(|q| Cell::text(name(q))));
    grid.row(head);
    unit_row(&mut grid, style, 1, &quantities);
    for fabric in all {
        let mut cells = vec![Cell::text(&fabric.name)];
        cells.extend(fabric.quantities.iter().map(|q| number(mean(q))));
        grid.row(cells);
    }
    let expected = all.iter().flat_map(|f| printed_means(f, true)).collect();
    Table { layout: "wide, direction in heads", grid, expected, workbook: false }
}

/// Two rows of heads: parameters over directions, or directions over parameters.
fn two_rows(rng: &mut Pcg64, style: &Style<'_>, all: &[Fabric], parameters_first: bool) -> Table {
    let l = style.language;
    let mut grid = Grid::default();
    title(&mut grid, rng, l);
    let mut quantities: Vec<&Quantity> = all[0].quantities.iter().collect();
    if !parameters_first {
        quantities.sort_by_key(|q| q.direction);
    }
    let order: Vec<(P, Option<Direction>)> = quantities.iter().map(|q| (q.parameter, q.direction)).collect();
    let sample = pick(rng, l.sample);
    let top_sample = chance(rng, 0.5);
    let mut top = vec![if top_sample { Cell::text(sample) } else { Cell::Empty }];
    let mut below = vec![if top_sample { Cell::Empty } else { Cell::text(sample) }];
    let at = grid.rows.len();
    let mut last = None;
    for (i, q) in quantities.iter().enumerate() {
        let upper =
            if parameters_first { format!("{:?}", q.parameter) } else { format!("{:?}", q.direction) };
        let new = last.as_ref() != Some(&upper);
        if new {
            let width = quantities[i..]
                .iter()
                .take_while(|k| {
                    if parameters_first { k.parameter == q.parameter } else { k.direction == q.direction }
                })
                .count();
            grid.over(at, 1 + i, width);
        }
        last = Some(upper);
        let word = q.direction.map(|d| style.direction(d).to_string()).unwrap_or_default();
        let (a, b) = if parameters_first { (style.head(q), word) } else { (word, style.head(q)) };
        top.push(if new { Cell::text(a) } else { Cell::Empty });
        below.push(Cell::text(b));
    }
    grid.row(top);
    grid.row(below);
    unit_row(&mut grid, style, 1, &quantities);
    for fabric in all {
        let mut cells = vec![Cell::text(&fabric.name)];
        cells.extend(order.iter().map(|(p, d)| number(mean(fabric.get(*p, *d)))));
        grid.row(cells);
    }
    let expected = all.iter().flat_map(|f| printed_means(f, true)).collect();
    let layout = if parameters_first {
        "two head rows, parameter over direction"
    } else {
        "two head rows, direction over parameter"
    };
    Table { layout, grid, expected, workbook: false }
}

/// `Parameter, Unit, Warp, Weft`: one fabric.
fn transposed(rng: &mut Pcg64, style: &Style<'_>, fabric: &Fabric) -> Table {
    let l = style.language;
    let mut grid = Grid::default();
    title(&mut grid, rng, l);
    let named = chance(rng, 0.6);
    if named {
        grid.texts(&[pick(rng, l.sample), &fabric.name]);
        if chance(rng, 0.5) {
            grid.blank();
        }
    }
    let unit_column = style.unit == UnitPlace::Own || chance(rng, 0.5);
    let mut head = vec![Cell::text(pick(rng, l.parameter))];
    head.extend(unit_column.then(|| Cell::text(pick(rng, l.unit))));
    head.extend(BOTH.map(|d| Cell::text(style.direction(d))));
    let with_mean = chance(rng, 0.3);
    head.extend(with_mean.then(|| Cell::text(l.mean[0])));
    grid.row(head);
    let mut done = Vec::new();
    for q in &fabric.quantities {
        if done.contains(&q.parameter) {
            continue;
        }
        done.push(q.parameter);
        let name = if unit_column { style.name(q.parameter) } else { style.head(q) };
        let mut cells = vec![Cell::text(name)];
        cells.extend(unit_column.then(|| Cell::text(if q.unit.0.is_empty() { "-" } else { q.unit.0 })));
        if q.direction.is_none() {
            // The fabric has one: it stands in the first column.
            cells.push(number(mean(q)));
        } else {
            let both = BOTH.map(|d| mean(fabric.get(q.parameter, Some(d))));
            cells.extend(both.map(number));
            cells.extend(with_mean.then(|| number(Printing::of(0.5 * (both[0].value + both[1].value)))));
        }
        grid.row(cells);
    }
    Table { layout: "transposed", grid, expected: printed_means(fabric, named), workbook: false }
}

/// Parameters down, fabrics across.
fn fabrics_across(rng: &mut Pcg64, style: &Style<'_>, all: &[Fabric]) -> Table {
    let l = style.language;
    let mut grid = Grid::default();
    title(&mut grid, rng, l);
    let mut head = vec![Cell::text(pick(rng, l.parameter)), Cell::text(pick(rng, l.unit))];
    let direction_column = chance(rng, 0.5);
    if direction_column {
        head.insert(1, Cell::text(pick(rng, l.direction)));
    }
    head.extend(all.iter().map(|f| Cell::text(&f.name)));
    grid.row(head);
    for q in &all[0].quantities {
        let word = q.direction.map(|d| style.direction(d)).unwrap_or_default();
        let mut cells = Vec::new();
        let name = style.name(q.parameter);
        if direction_column {
            cells.extend([Cell::text(name), Cell::text(word)]);
        } else {
            cells.push(Cell::text(format!("{name} {word}").trim()));
        }
        cells.push(Cell::text(if q.unit.0.is_empty() { "-" } else { q.unit.0 }));
        cells.extend(all.iter().map(|f| number(mean(f.get(q.parameter, q.direction)))));
        grid.row(cells);
    }
    let expected = all.iter().flat_map(|f| printed_means(f, true)).collect();
    Table { layout: "fabrics across", grid, expected, workbook: false }
}

/// As the KES-FB-AUTO-A system prints: under WARP and WEFT the specimens 1, 2, 3, then AVE and SD.
fn sections(rng: &mut Pcg64, style: &Style<'_>, fabric: &Fabric) -> Table {
    let l = style.language;
    let mut grid = Grid::default();
    title(&mut grid, rng, l);
    let named = chance(rng, 0.7);
    if named {
        grid.texts(&[pick(rng, l.sample), &fabric.name]);
    }
    let number_word = pick(rng, l.number);
    let head_once = chance(rng, 0.4);
    let directions: Vec<Option<Direction>> =
        if fabric.quantities[0].direction.is_some() { BOTH.map(Some).to_vec() } else { vec![None] };
    for (k, d) in directions.iter().enumerate() {
        let quantities: Vec<&Quantity> = fabric.quantities.iter().filter(|q| q.direction == *d).collect();
        let head = |grid: &mut Grid| {
            let mut cells = vec![Cell::text(number_word)];
            cells.extend(quantities.iter().map(|q| Cell::text(style.head(q))));
            grid.row(cells);
            unit_row(grid, style, 1, &quantities);
        };
        if head_once && k == 0 {
            head(&mut grid);
        }
        if let Some(d) = d {
            if !head_once && chance(rng, 0.5) {
                grid.blank();
            }
            let word = style.direction(*d).to_string();
            let decorated = if chance(rng, 0.3) { format!("[{word}]") } else { word };
            grid.texts(&[&decorated]);
        }
        if !head_once {
            head(&mut grid);
        }
        for i in 0..quantities[0].repeats.len() {
            let mut cells = vec![Cell::Number(Printing { value: (i + 1) as f64, decimals: 0 })];
            cells.extend(quantities.iter().map(|q| number(q.repeats[i])));
            grid.row(cells);
        }
        for (label, cells) in statistics(rng, l, &quantities) {
            grid.row([vec![Cell::text(label)], cells].concat());
        }
    }
    Table { layout: "sections", grid, expected: repeats(fabric, named), workbook: false }
}

/// Parameters down, `1 2 3 AVE` across, a block for each direction.
fn numbered_across(rng: &mut Pcg64, style: &Style<'_>, fabric: &Fabric, stacked: bool) -> Table {
    let l = style.language;
    let mut grid = Grid::default();
    title(&mut grid, rng, l);
    let named = chance(rng, 0.5);
    if named {
        grid.texts(&[pick(rng, l.sample), &fabric.name]);
    }
    let n = fabric.quantities[0].repeats.len();
    let statistic = chance(rng, 0.8);
    let (ave, sd) = (pick(rng, l.mean), pick(rng, l.sd));
    let heads = |cells: &mut Vec<Cell>, prefix: &str| {
        for i in 1..=n {
            cells.push(if prefix.is_empty() {
                Cell::Number(Printing { value: i as f64, decimals: 0 })
            } else {
                Cell::text(format!("{prefix}-{i}"))
            });
        }
        if statistic {
            cells.extend([Cell::text(ave), Cell::text(sd)]);
        }
    };
    let values = |cells: &mut Vec<Cell>, q: &Quantity| {
        cells.extend(q.repeats.iter().map(|r| number(*r)));
        if statistic {
            cells.extend([number(mean(q)), number(Printing::of(q.sd()))]);
        }
    };
    let directions: Vec<Option<Direction>> =
        if fabric.quantities[0].direction.is_some() { BOTH.map(Some).to_vec() } else { vec![None] };
    let word = pick(rng, l.parameter);
    let unit_column = style.unit == UnitPlace::Own;
    let lead = |name: String, unit: &str| {
        let mut cells = vec![Cell::text(name)];
        cells.extend(unit_column.then(|| Cell::text(if unit.is_empty() { "-" } else { unit })));
        cells
    };
    if stacked {
        for d in &directions {
            let mut head = lead(word.to_string(), l.unit[0]);
            if let Some(d) = d {
                grid.texts(&[style.direction(*d)]);
            }
            heads(&mut head, "");
            grid.row(head);
            for q in fabric.quantities.iter().filter(|q| q.direction == *d) {
                let mut cells = lead(style.head(q), q.unit.0);
                values(&mut cells, q);
                grid.row(cells);
            }
            if chance(rng, 0.6) {
                grid.blank();
            }
        }
    } else {
        let mut head = lead(word.to_string(), l.unit[0]);
        for d in &directions {
            heads(&mut head, d.map(|d| style.direction(d)).unwrap_or_default());
        }
        // AVE would stand twice without a direction: then a row of directions is above.
        if statistic && directions.len() > 1 {
            let at = grid.rows.len();
            let lead_width = if unit_column { 2 } else { 1 };
            let mut top = vec![Cell::Empty; lead_width];
            for d in directions.iter().flatten() {
                grid.over(at, top.len(), n + 2);
                top.push(Cell::text(style.direction(*d)));
                top.extend(vec![Cell::Empty; n + 1]);
            }
            grid.row(top);
        }
        grid.row(head);
        let mut done = Vec::new();
        for q in &fabric.quantities {
            if done.contains(&q.parameter) {
                continue;
            }
            done.push(q.parameter);
            let mut cells = lead(style.head(q), q.unit.0);
            for d in &directions {
                values(&mut cells, fabric.get(q.parameter, *d));
            }
            grid.row(cells);
        }
    }
    let layout = if stacked { "1 2 3 AVE across, stacked" } else { "Warp-1 ... Weft-3 across" };
    Table { layout, grid, expected: repeats(fabric, named), workbook: false }
}

/// `Warp-1`, `Warp-2` ... `Weft-3` down, with means between.
fn numbered_rows(rng: &mut Pcg64, style: &Style<'_>, fabric: &Fabric) -> Table {
    let l = style.language;
    let mut grid = Grid::default();
    title(&mut grid, rng, l);
    let directions: Vec<Option<Direction>> =
        if fabric.quantities[0].direction.is_some() { BOTH.map(Some).to_vec() } else { vec![None] };
    let heads: Vec<&Quantity> = fabric.quantities.iter().filter(|q| q.direction == directions[0]).collect();
    let mut head = vec![Cell::text(pick(rng, l.number))];
    head.extend(heads.iter().map(|q| Cell::text(style.head(q))));
    grid.row(head);
    unit_row(&mut grid, style, 1, &heads);
    let separator = pick(rng, &["-", " ", "", "_", " #"]);
    for d in &directions {
        let quantities: Vec<&Quantity> = fabric.quantities.iter().filter(|q| q.direction == *d).collect();
        let word = d.map(|d| style.direction(d)).unwrap_or_default();
        for i in 0..quantities[0].repeats.len() {
            let label =
                if word.is_empty() { format!("{}", i + 1) } else { format!("{word}{separator}{}", i + 1) };
            let mut cells = vec![Cell::text(label)];
            cells.extend(quantities.iter().map(|q| number(q.repeats[i])));
            grid.row(cells);
        }
        let with_direction = chance(rng, 0.5);
        for (label, cells) in statistics(rng, l, &quantities) {
            let label = if with_direction && !word.is_empty() { format!("{word} {label}") } else { label };
            grid.row([vec![Cell::text(label)], cells].concat());
        }
    }
    Table { layout: "Warp-1 ... Weft-3 down", grid, expected: repeats(fabric, false), workbook: false }
}

/// `Sample, Direction, B`: every repeat is a row, without a number.
fn tidy(rng: &mut Pcg64, style: &Style<'_>, all: &[Fabric]) -> Table {
    let l = style.language;
    let mut grid = Grid::default();
    title(&mut grid, rng, l);
    let directional = all[0].quantities[0].direction.is_some();
    let directions: Vec<Option<Direction>> = if directional { BOTH.map(Some).to_vec() } else { vec![None] };
    let heads: Vec<&Quantity> = all[0].quantities.iter().filter(|q| q.direction == directions[0]).collect();
    let numbered = chance(rng, 0.5);
    let mut head = vec![Cell::text(pick(rng, l.sample))];
    head.extend(directional.then(|| Cell::text(pick(rng, l.direction))));
    head.extend(numbered.then(|| Cell::text(pick(rng, l.number))));
    head.extend(heads.iter().map(|q| Cell::text(style.head(q))));
    let lead = head.len() - heads.len();
    grid.row(head);
    unit_row(&mut grid, style, lead, &heads);
    for f in all {
        for d in &directions {
            let quantities: Vec<&Quantity> = f.quantities.iter().filter(|q| q.direction == *d).collect();
            for i in 0..quantities[0].repeats.len() {
                let mut cells = vec![Cell::text(&f.name)];
                cells.extend(d.map(|d| Cell::text(style.direction(d))));
                cells.extend(numbered.then(|| Cell::Number(Printing { value: (i + 1) as f64, decimals: 0 })));
                cells.extend(quantities.iter().map(|q| number(q.repeats[i])));
                grid.row(cells);
            }
        }
    }
    // A row that a technician hid: an outlier that was not to count.
    let mut workbook = false;
    if chance(rng, 0.15) {
        let mut cells = vec![Cell::text(&all[0].name)];
        cells.extend(directional.then(|| Cell::text(style.warp)));
        cells.extend(numbered.then_some(Cell::Number(Printing { value: 9.0, decimals: 0 })));
        cells.extend(heads.iter().map(|q| number(Printing::of(3.0 * q.mean()))));
        let at = grid.row(cells);
        grid.hidden.push(at);
        workbook = true;
    }
    let expected = all.iter().flat_map(|f| repeats(f, true)).collect();
    let layout = if workbook { "tidy repeats, a hidden row" } else { "tidy repeats" };
    Table { layout, grid, expected, workbook }
}

/// `Sample, Parameter, Direction, Value, Unit`.
fn long(rng: &mut Pcg64, style: &Style<'_>, all: &[Fabric]) -> Table {
    let l = style.language;
    let mut grid = Grid::default();
    grid.texts(&[
        pick(rng, l.sample),
        pick(rng, l.parameter),
        pick(rng, l.direction),
        pick(rng, l.value),
        pick(rng, l.unit),
    ]);
    for f in all {
        for q in &f.quantities {
            let word = q.direction.map(|d| style.direction(d)).unwrap_or_default();
            grid.row(vec![
                Cell::text(&f.name),
                Cell::text(style.name(q.parameter)),
                Cell::text(if word.is_empty() { "-" } else { word }),
                number(mean(q)),
                Cell::text(if q.unit.0.is_empty() { "-" } else { q.unit.0 }),
            ]);
        }
    }
    let expected = all.iter().flat_map(|f| printed_means(f, true)).collect();
    Table { layout: "long", grid, expected, workbook: false }
}

/// The literature's own notation: `B1`, `B-2`, `LT-1`, `2HG5_2`.
fn literature(rng: &mut Pcg64, style: &Style<'_>, all: &[Fabric]) -> Table {
    let l = style.language;
    let mut grid = Grid::default();
    title(&mut grid, rng, l);
    let separator = pick(rng, &["-", "", "_", " "]);
    let quantities: Vec<&Quantity> = all[0].quantities.iter().collect();
    let name = |q: &Quantity| {
        let symbol = style.symbol(q.parameter);
        // 2HG5 and 2HG51 would be misread by people, too.
        let separator = if symbol.ends_with(|c: char| c.is_ascii_digit()) && separator.is_empty() {
            "-"
        } else {
            separator
        };
        let suffix = match q.direction {
            Some(Direction::Warp) => format!("{separator}1"),
            Some(_) => format!("{separator}2"),
            None => String::new(),
        };
        style.with_unit(format!("{symbol}{suffix}"), q.unit)
    };
    let down = chance(rng, 0.4);
    if down {
        let mut head = vec![Cell::text(pick(rng, l.parameter)), Cell::text(pick(rng, l.unit))];
        head.extend(all.iter().map(|f| Cell::text(&f.name)));
        grid.row(head);
        for q in &quantities {
            let full = name(q);
            let symbol = full.split(['(', '[', ',']).next().unwrap_or_default().trim().to_string();
            let mut cells =
                vec![Cell::text(symbol), Cell::text(if q.unit.0.is_empty() { "-" } else { q.unit.0 })];
            cells.extend(all.iter().map(|f| number(mean(f.get(q.parameter, q.direction)))));
            grid.row(cells);
        }
    } else {
        let mut head = vec![Cell::text(pick(rng, l.sample))];
        head.extend(quantities.iter().map(|q| Cell::text(name(q))));
        grid.row(head);
        unit_row(&mut grid, style, 1, &quantities);
        for f in all {
            let mut cells = vec![Cell::text(&f.name)];
            cells.extend(f.quantities.iter().map(|q| number(mean(q))));
            grid.row(cells);
        }
    }
    let expected = all.iter().flat_map(|f| printed_means(f, true)).collect();
    Table { layout: if down { "literature, down" } else { "literature" }, grid, expected, workbook: false }
}

/// `0.081 ± 0.003` and `0.081 (0.003)` in one cell, or percent cells of a workbook.
fn plus_minus(rng: &mut Pcg64, style: &Style<'_>, all: &[Fabric]) -> Table {
    let l = style.language;
    let mut grid = Grid::default();
    let form = rng.random_range(0..4);
    let directional = all[0].quantities[0].direction.is_some();
    let directions: Vec<Option<Direction>> = if directional { BOTH.map(Some).to_vec() } else { vec![None] };
    let heads: Vec<&Quantity> = all[0].quantities.iter().filter(|q| q.direction == directions[0]).collect();
    let percent = form == 3 && heads.iter().any(|q| q.unit.0 == "%");
    let mut head = vec![Cell::text(pick(rng, l.sample))];
    head.extend(directional.then(|| Cell::text(pick(rng, l.direction))));
    head.extend(heads.iter().map(|q| Cell::text(style.head(q))));
    let lead = head.len() - heads.len();
    grid.row(head);
    unit_row(&mut grid, style, lead, &heads);
    for f in all {
        for d in &directions {
            let mut cells = vec![Cell::text(&f.name)];
            cells.extend(d.map(|d| Cell::text(style.direction(d))));
            for q in f.quantities.iter().filter(|q| q.direction == *d) {
                let m = mean(q);
                let sd = format!("{:.*}", m.decimals, q.sd());
                cells.push(match form {
                    _ if percent && q.unit.0 == "%" => Cell::Percent(m),
                    0 => Cell::text(format!("{} ± {sd}", m.text())),
                    1 => Cell::text(format!("{} ({sd})", m.text())),
                    2 => Cell::text(format!("{}±{sd}", m.text())),
                    _ => number(m),
                });
            }
            grid.row(cells);
        }
    }
    let expected = all.iter().flat_map(|f| printed_means(f, true)).collect();
    let layout = if percent {
        "percent cells"
    } else if form < 3 {
        "mean and deviation in a cell"
    } else {
        "wide"
    };
    Table { layout, grid, expected, workbook: percent }
}

/// `Warp` and `Weft` side by side over specimens 1, 2, 3.
fn side_by_side(rng: &mut Pcg64, style: &Style<'_>, fabric: &Fabric) -> Table {
    let l = style.language;
    let mut grid = Grid::default();
    let named = chance(rng, 0.5);
    if named {
        grid.texts(&[pick(rng, l.sample), &fabric.name]);
    }
    let directions: Vec<Option<Direction>> =
        if fabric.quantities[0].direction.is_some() { BOTH.map(Some).to_vec() } else { vec![None] };
    let quantities_along = |d: &Option<Direction>| -> Vec<&Quantity> {
        fabric.quantities.iter().filter(|q| q.direction == *d).collect()
    };
    let all: Vec<&Quantity> = directions.iter().flat_map(quantities_along).collect();
    if directions.len() > 1 {
        let at = grid.rows.len();
        let mut top = vec![Cell::Empty];
        for d in &directions {
            let width = quantities_along(d).len();
            grid.over(at, top.len(), width);
            top.push(Cell::text(d.map(|d| style.direction(d)).unwrap_or_default()));
            top.extend(vec![Cell::Empty; width - 1]);
        }
        grid.row(top);
    }
    let mut head = vec![Cell::text(pick(rng, l.number))];
    head.extend(all.iter().map(|q| Cell::text(style.head(q))));
    grid.row(head);
    unit_row(&mut grid, style, 1, &all);
    for i in 0..all[0].repeats.len() {
        let mut cells = vec![Cell::Number(Printing { value: (i + 1) as f64, decimals: 0 })];
        cells.extend(all.iter().map(|q| number(q.repeats[i])));
        grid.row(cells);
    }
    for (label, cells) in statistics(rng, l, &all) {
        grid.row([vec![Cell::text(label)], cells].concat());
    }
    Table { layout: "warp and weft side by side", grid, expected: repeats(fabric, named), workbook: false }
}
