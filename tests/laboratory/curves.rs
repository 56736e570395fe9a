//! Records of tests as instrument programs and spreadsheets lay them out.

use kesf::instrument::{Direction, Test};
use rand::RngExt;
use rand_pcg::Pcg64;

use super::Expected;
use super::grid::{Cell, Grid};
use super::truth::{Printed, Printing, chance, pick};
use super::words::Language;

/// A sheet of records, the stem of its file name, and what it says.
pub struct Records {
    pub layout: &'static str,
    pub grid: Grid,
    pub stem: String,
    pub expected: Vec<Expected>,
}

const TESTS: [Test; 6] =
    [Test::Bending, Test::Shear, Test::Tensile, Test::Compression, Test::Friction, Test::Roughness];

const GF: f64 = 9.80665e-3;
const DEG: f64 = std::f64::consts::PI / 180.0;

/// Units of the two columns of a test.
fn units(test: Test) -> [&'static [Printed]; 2] {
    match test {
        Test::Bending => [
            &[("1/cm", 100.0), ("cm-1", 100.0), ("cm^-1", 100.0), ("cm⁻¹", 100.0)],
            &[
                ("gf·cm/cm", GF),
                ("gf.cm/cm", GF),
                ("gf cm/cm", GF),
                ("gf*cm/cm", GF),
                ("gfcm/cm", GF),
                ("mN", 1e-3),
            ],
        ],
        Test::Shear => [
            &[("deg", DEG), ("°", DEG), ("degree", DEG), ("degrees", DEG)],
            &[("gf/cm", GF / 1e-2), ("N/m", 1.0), ("cN/cm", 1.0)],
        ],
        Test::Tensile => [&[("%", 0.01)], &[("gf/cm", GF / 1e-2), ("N/m", 1.0), ("cN/cm", 1.0)]],
        Test::Compression => [
            &[("mm", 1e-3), ("µm", 1e-6)],
            &[("gf/cm²", GF / 1e-4), ("gf/cm2", GF / 1e-4), ("kPa", 1e3), ("Pa", 1.0)],
        ],
        Test::Friction => [&[("cm", 1e-2), ("mm", 1e-3)], &[("-", 1.0), ("1", 1.0)]],
        Test::Roughness => {
            [&[("cm", 1e-2), ("mm", 1e-3)], &[("µm", 1e-6), ("um", 1e-6), ("mm", 1e-3), ("micron", 1e-6)]]
        }
    }
}

/// A record in the printed units.
struct Record {
    direction: Option<Direction>,
    points: Vec<(Printing, Printing)>,
}

fn printing(value: f64, decimals: usize) -> Printing {
    let text = format!("{value:.decimals$}");
    Printing { value: text.parse().unwrap_or(value), decimals }
}

/// One cycle of a test, in customary units turned into the printed ones.
fn record(rng: &mut Pcg64, test: Test, direction: Option<Direction>, [x, y]: [Printed; 2]) -> Record {
    let n = rng.random_range(12..30);
    let stiff = 0.7 + 0.6 * rng.random::<f64>();
    let ramp = |a: f64, b: f64| (1..=n).map(move |i| a + (b - a) * i as f64 / n as f64);
    let cycle: Vec<(f64, f64)> = match test {
        Test::Bending | Test::Shear => {
            let (top, k, h) = if test == Test::Bending { (2.5, 0.08, 0.03) } else { (8.0, 0.7, 0.5) };
            let branch = |a: f64, b: f64| {
                let s = (b - a).signum();
                ramp(a, b).map(move |v| (v, stiff * (k * v + s * h))).collect::<Vec<_>>()
            };
            [vec![(0.0, 0.0)], branch(0.0, top), branch(top, -top), branch(-top, 0.0)].concat()
        }
        Test::Tensile => {
            let top = 6.0 * stiff;
            let up = ramp(0.0, top).map(|e| (e, 500.0 * (e / top).powf(1.6)));
            let down =
                ramp(top, 0.3 * top).map(|e| (e, 500.0 * ((e - 0.3 * top) / (0.7 * top)).max(0.0).powf(2.2)));
            std::iter::once((0.0, 0.0)).chain(up).chain(down).collect()
        }
        Test::Compression => {
            let thick = 0.7 * stiff;
            let up = ramp(0.0, 1.0).map(|u| (thick - 0.25 * u, 50.0 * u.powi(3)));
            let down = ramp(1.0, 0.1).map(|u| (thick - 0.25 * u, 50.0 * u.powi(4)));
            std::iter::once((thick, 0.0)).chain(up).chain(down).collect()
        }
        Test::Friction | Test::Roughness => {
            let (mean, wave) = if test == Test::Friction { (0.2, 0.03) } else { (12.0, 5.0) };
            let profile = |x: f64| (x, stiff * (mean + wave * (7.0 * x).sin()));
            ramp(-0.1, 3.0).chain(ramp(3.0, 0.0)).map(profile).collect()
        }
    };
    let customary = units(test);
    let decimals =
        |unit: Printed, span: f64| (4 - (span / unit.1).log10().floor() as i32).clamp(0, 7) as usize;
    let span = |f: fn(&(f64, f64)) -> f64| cycle.iter().map(f).fold(0.0f64, |m, v| m.max(v.abs()));
    let (sx, sy) = (span(|p| p.0) * customary[0][0].1, span(|p| p.1) * customary[1][0].1);
    let (dx, dy) = (decimals(x, sx), decimals(y, sy));
    let points = cycle
        .iter()
        .map(|(a, b)| (printing(a * customary[0][0].1 / x.1, dx), printing(b * customary[1][0].1 / y.1, dy)))
        .collect();
    Record { direction, points }
}

fn expected(test: Test, r: &Record, [x, y]: [f64; 2]) -> Expected {
    Expected::Curve {
        test,
        direction: r.direction,
        points: r.points.iter().map(|(a, b)| (a.value * x, b.value * y)).collect(),
    }
}

/// How the heads of one file are written.
struct Heads<'l> {
    language: &'l Language,
    test: Test,
    units: [Printed; 2],
    square: bool,
    own_row: bool,
    names: [&'l str; 2],
}

impl<'l> Heads<'l> {
    fn any(rng: &mut Pcg64, language: &'l Language, test: Test) -> Self {
        let [x, y] = units(test);
        let index = TESTS.iter().position(|t| *t == test).expect("a test");
        let mut names = language.axes[index];
        if language.name == "en" && test == Test::Bending && chance(rng, 0.4) {
            names = ["K", "M"];
        }
        Self {
            language,
            test,
            units: [pick(rng, x), pick(rng, y)],
            square: chance(rng, 0.3),
            own_row: chance(rng, 0.15),
            names,
        }
    }

    fn head(&self, i: usize, name: &str) -> Cell {
        let unit = self.units[i].0;
        Cell::text(match (self.own_row, self.square) {
            (true, _) => name.to_string(),
            (_, true) => format!("{name} [{unit}]"),
            _ => format!("{name} ({unit})"),
        })
    }

    fn pair(&self) -> [Cell; 2] {
        [self.head(0, self.names[0]), self.head(1, self.names[1])]
    }

    fn unit_row(&self, pairs: usize) -> Option<Vec<Cell>> {
        let pair = self.units.map(|u| Cell::text(format!("({})", u.0)));
        self.own_row.then(|| pair.iter().cloned().cycle().take(2 * pairs).collect())
    }

    fn test_word(&self) -> &'l str {
        self.language.tests[TESTS.iter().position(|t| *t == self.test).expect("a test")]
    }

    fn factors(&self) -> [f64; 2] {
        self.units.map(|u| u.1)
    }
}

fn directions(rng: &mut Pcg64, test: Test, n: usize) -> Vec<Option<Direction>> {
    match test {
        Test::Compression => vec![None; n],
        _ => {
            let one = pick(rng, &[Direction::Warp, Direction::Weft]);
            vec![Some(one); n]
        }
    }
}

fn word(l: &Language, d: Direction) -> &str {
    if d == Direction::Warp { l.warp[0] } else { l.weft[0] }
}

fn lines(grid: &mut Grid, rng: &mut Pcg64, heads: &Heads<'_>, direction: Option<Direction>) {
    let l = heads.language;
    if chance(rng, 0.4) {
        grid.texts(&[l.title]);
    }
    grid.texts(&[pick(rng, l.sample), "S1"]);
    if chance(rng, 0.7) {
        grid.texts(&[l.date, "2024-05-17"]);
        grid.texts(&[l.operator, "M. Sato"]);
    }
    if chance(rng, 0.5) {
        grid.texts(&["Test", &format!("KES-FB {}", heads.test_word())]);
    }
    if let Some(d) = direction {
        grid.texts(&[l.direction[0], word(l, d)]);
    }
    if chance(rng, 0.7) {
        grid.blank();
    }
}

fn body(grid: &mut Grid, records: &[&Record]) {
    let longest = records.iter().map(|r| r.points.len()).max().unwrap_or(0);
    for i in 0..longest {
        let mut cells = Vec::new();
        for r in records {
            match r.points.get(i) {
                Some((a, b)) => cells.extend([Cell::Number(*a), Cell::Number(*b)]),
                None => cells.extend([Cell::Empty, Cell::Empty]),
            }
        }
        grid.row(cells);
    }
}

/// Any sheet of records.
pub fn any(rng: &mut Pcg64, l: &Language) -> Records {
    let test = pick(rng, &TESTS);
    let heads = Heads::any(rng, l, test);
    match rng.random_range(0..11) {
        0 => single(rng, &heads),
        1 => side_by_side(rng, &heads),
        2 => by_direction(rng, &heads),
        3 => in_heads(rng, &heads),
        4 => stacked(rng, &heads),
        5 => two_branches(rng, l),
        6 => pages(rng, &heads),
        7 => raw_geometry(rng, l),
        8 => file_name(rng, &heads),
        9 => both_of_surface(rng, l),
        _ => opposite_sign(rng, l),
    }
}

fn single(rng: &mut Pcg64, heads: &Heads<'_>) -> Records {
    let d = directions(rng, heads.test, 1)[0];
    let r = record(rng, heads.test, d, heads.units);
    let mut grid = Grid::default();
    lines(&mut grid, rng, heads, d);
    // A counter or the time in front, as loggers write.
    let counter = chance(rng, 0.25);
    let lead = |cell: Cell, mut rest: Vec<Cell>| {
        if counter {
            rest.insert(0, cell);
        }
        rest
    };
    grid.row(lead(Cell::text(heads.language.number[0]), heads.pair().to_vec()));
    if let Some(units) = heads.unit_row(1) {
        grid.row(lead(Cell::Empty, units));
    }
    for (i, (a, b)) in r.points.iter().enumerate() {
        let count = Cell::Number(Printing { value: (i + 1) as f64, decimals: 0 });
        grid.row(lead(count, vec![Cell::Number(*a), Cell::Number(*b)]));
    }
    let expected = vec![expected(heads.test, &r, heads.factors())];
    Records { layout: "one record", grid, stem: "S1".into(), expected }
}

fn side_by_side(rng: &mut Pcg64, heads: &Heads<'_>) -> Records {
    let n = rng.random_range(2..5);
    let ds = directions(rng, heads.test, n);
    let all: Vec<Record> = ds.iter().map(|d| record(rng, heads.test, *d, heads.units)).collect();
    let mut grid = Grid::default();
    lines(&mut grid, rng, heads, ds[0]);
    let form = rng.random_range(0..3);
    let at = grid.rows.len();
    let mut top = Vec::new();
    for i in 1..=n {
        grid.over(at, top.len(), 2);
        top.push(match form {
            0 => Cell::Number(Printing { value: i as f64, decimals: 0 }),
            1 => Cell::text(format!("No.{i}")),
            _ => Cell::text(format!("{} {i}", heads.language.number[0])),
        });
        top.push(Cell::Empty);
    }
    if form == 0 {
        grid.merged.clear();
    }
    grid.row(top);
    grid.row(heads.pair().iter().cloned().cycle().take(2 * n).collect());
    grid.rows.extend(heads.unit_row(n));
    body(&mut grid, &all.iter().collect::<Vec<_>>());
    let expected = all.iter().map(|r| expected(heads.test, r, heads.factors())).collect();
    Records { layout: "records side by side", grid, stem: "S1".into(), expected }
}

/// `Warp,,Weft,` over the pairs, alone or with numbers.
fn by_direction(rng: &mut Pcg64, heads: &Heads<'_>) -> Records {
    if heads.test == Test::Compression {
        return single(rng, heads);
    }
    let each = rng.random_range(1..3);
    let ds: Vec<Direction> =
        [Direction::Warp, Direction::Weft].into_iter().flat_map(|d| vec![d; each]).collect();
    let all: Vec<Record> = ds.iter().map(|d| record(rng, heads.test, Some(*d), heads.units)).collect();
    let mut grid = Grid::default();
    lines(&mut grid, rng, heads, None);
    let merged = each > 1 && chance(rng, 0.5);
    let at = grid.rows.len();
    let mut top = Vec::new();
    for (i, d) in ds.iter().enumerate() {
        let text = word(heads.language, *d);
        let first = i % each == 0;
        if merged {
            if first {
                grid.over(at, top.len(), 2 * each);
            }
            top.push(if first { Cell::text(text) } else { Cell::Empty });
        } else {
            grid.over(at, top.len(), 2);
            top.push(if each > 1 {
                Cell::text(format!("{text}-{}", i % each + 1))
            } else {
                Cell::text(text)
            });
        }
        top.push(Cell::Empty);
    }
    grid.row(top);
    grid.row(heads.pair().iter().cloned().cycle().take(2 * ds.len()).collect());
    grid.rows.extend(heads.unit_row(ds.len()));
    body(&mut grid, &all.iter().collect::<Vec<_>>());
    let expected = all.iter().map(|r| expected(heads.test, r, heads.factors())).collect();
    Records { layout: "warp and weft side by side", grid, stem: "S1".into(), expected }
}

/// `Warp-1 K (1/cm)`, `K_warp (1/cm)`.
fn in_heads(rng: &mut Pcg64, heads: &Heads<'_>) -> Records {
    if heads.test == Test::Compression {
        return side_by_side(rng, heads);
    }
    let form = rng.random_range(0..3);
    let each = if form == 1 { 1 } else { rng.random_range(1..3) };
    let ds: Vec<Direction> =
        [Direction::Warp, Direction::Weft].into_iter().flat_map(|d| vec![d; each]).collect();
    let all: Vec<Record> = ds.iter().map(|d| record(rng, heads.test, Some(*d), heads.units)).collect();
    let mut grid = Grid::default();
    lines(&mut grid, rng, heads, None);
    let mut row = Vec::new();
    for (i, d) in ds.iter().enumerate() {
        let w = word(heads.language, *d);
        for (j, name) in heads.names.iter().enumerate() {
            let text = match form {
                0 => format!("{w}-{} {name}", i % each + 1),
                1 => format!("{name}_{w}"),
                _ if each == 1 => format!("{name} {w}"),
                _ => format!("{name} {w} {}", i % each + 1),
            };
            row.push(heads.head(j, &text));
        }
    }
    grid.row(row);
    grid.rows.extend(heads.unit_row(ds.len()));
    body(&mut grid, &all.iter().collect::<Vec<_>>());
    let expected = all.iter().map(|r| expected(heads.test, r, heads.factors())).collect();
    Records { layout: "direction in the heads", grid, stem: "S1".into(), expected }
}

/// One record under the other, each with its lines.
fn stacked(rng: &mut Pcg64, heads: &Heads<'_>) -> Records {
    let n = rng.random_range(2..4);
    let ds: Vec<Option<Direction>> = match heads.test {
        Test::Compression => vec![None; n],
        _ => (0..n).map(|i| Some(if i % 2 == 0 { Direction::Warp } else { Direction::Weft })).collect(),
    };
    let all: Vec<Record> = ds.iter().map(|d| record(rng, heads.test, *d, heads.units)).collect();
    let mut grid = Grid::default();
    for r in &all {
        lines(&mut grid, rng, heads, r.direction);
        grid.row(heads.pair().to_vec());
        grid.rows.extend(heads.unit_row(1));
        body(&mut grid, &[r]);
        grid.blank();
    }
    let expected = all.iter().map(|r| expected(heads.test, r, heads.factors())).collect();
    Records { layout: "stacked records", grid, stem: "S1".into(), expected }
}

/// One strain column, a loading and an unloading force column: one specimen.
fn two_branches(rng: &mut Pcg64, l: &Language) -> Records {
    let heads = Heads { own_row: false, ..Heads::any(rng, l, Test::Tensile) };
    let d = pick(rng, &[Direction::Warp, Direction::Weft]);
    let n = rng.random_range(8..25);
    let top = 6.0;
    let mut grid = Grid::default();
    lines(&mut grid, rng, &heads, Some(d));
    let words: [&str; 2] = match l.name {
        "ja" => ["往路", "復路"],
        "zh-Hans" => ["加载", "卸载"],
        "zh-Hant" => ["加載", "卸載"],
        "ko" => ["하중 가", "하중 제거"],
        "de" => ["Belastung", "Entlastung"],
        "fr" => ["charge", "décharge"],
        "es" => ["carga", "descarga"],
        "it" => ["carico", "scarico"],
        "pt" => ["carga", "descarga"],
        "pl" => ["obciążanie", "odciążanie"],
        "cs" => ["zatěžování", "odlehčování"],
        "nl" => ["belasten", "ontlasten"],
        "tr" => ["yükleme", "boşaltma"],
        _ => {
            pick(rng, &[["loading", "unloading"], ["load", "unload"], ["going", "returning"], ["up", "down"]])
        }
    };
    let name = heads.names[1];
    let heads_row = vec![
        heads.head(0, heads.names[0]),
        heads.head(1, &format!("{name} {}", words[0])),
        heads.head(1, &format!("{name} {}", words[1])),
    ];
    grid.row(heads_row);
    let [x, y] = heads.factors();
    let (mut out, mut back) = (Vec::new(), Vec::new());
    for i in 0..=n {
        let e = top * f64::from(i) / f64::from(n);
        let per = 500.0 * 0.980_665 / heads.units[1].1;
        let (u, v) = ((e / top).powf(1.6) * per, (e / top).powf(2.3) * per);
        let (e, u, v) = (printing(e, 3), printing(u, 2), printing(v, 2));
        grid.row(vec![Cell::Number(e), Cell::Number(u), Cell::Number(v)]);
        out.push((e.value * x, u.value * y));
        back.push((e.value * x, v.value * y));
    }
    back.reverse();
    let points = [out, back].concat();
    let expected = vec![Expected::Curve { test: Test::Tensile, direction: Some(d), points }];
    Records { layout: "loading and unloading columns", grid, stem: "S1".into(), expected }
}

/// The heads again on every page.
fn pages(rng: &mut Pcg64, heads: &Heads<'_>) -> Records {
    let d = directions(rng, heads.test, 1)[0];
    let r = record(rng, heads.test, d, heads.units);
    let mut grid = Grid::default();
    lines(&mut grid, rng, heads, d);
    let blank = chance(rng, 0.5);
    for (i, page) in r.points.chunks(20).enumerate() {
        if i > 0 && blank {
            grid.blank();
        }
        grid.row(heads.pair().to_vec());
        grid.rows.extend(heads.unit_row(1));
        for (a, b) in page {
            grid.row(vec![Cell::Number(*a), Cell::Number(*b)]);
        }
    }
    let expected = vec![expected(heads.test, &r, heads.factors())];
    Records { layout: "heads on every page", grid, stem: "S1".into(), expected }
}

/// Raw force and travel with the size of the specimen in words of the laboratory's own.
fn raw_geometry(rng: &mut Pcg64, l: &Language) -> Records {
    let width = pick(rng, &[5.0, 10.0, 20.0, 2.5]);
    let gauge = pick(rng, &[2.0, 5.0, 10.0]);
    let d = pick(rng, &[Direction::Warp, Direction::Weft]);
    let heads =
        Heads { units: [("mm", 1e-3), ("gf", GF)], own_row: false, ..Heads::any(rng, l, Test::Tensile) };
    let mut grid = Grid::default();
    lines(&mut grid, rng, &heads, Some(d));
    let size = l.name == "en" && chance(rng, 0.3);
    if size {
        let at = grid.rows.len().saturating_sub(1);
        let at = if grid.rows.last().is_some_and(Vec::is_empty) { at } else { grid.rows.len() };
        grid.rows.insert(at, vec![Cell::text("Specimen size"), Cell::text(format!("{width} x {gauge} cm"))]);
    } else {
        let at =
            if grid.rows.last().is_some_and(Vec::is_empty) { grid.rows.len() - 1 } else { grid.rows.len() };
        let form = rng.random_range(0..3);
        let line = |name: &str, v: f64| match form {
            0 => vec![Cell::text(name), Cell::text(format!("{v} cm"))],
            1 => vec![Cell::text(name), Cell::Number(printing(v, 1)), Cell::text("cm")],
            _ => vec![Cell::text(format!("{name} (cm)")), Cell::Number(printing(v, 1))],
        };
        grid.rows.insert(at, line(pick(rng, l.width), width));
        grid.rows.insert(at, line(pick(rng, l.gauge), gauge));
    }
    let extension = match l.name {
        "en" => "Extension",
        _ => heads.names[0],
    };
    let name = heads.names[1];
    grid.row(vec![heads.head(0, extension), heads.head(1, name)]);
    let mut points = Vec::new();
    let n = rng.random_range(10..25);
    for i in 0..=2 * n {
        let u = f64::from(if i <= n { i } else { 2 * n - i }) / f64::from(n);
        let power = if i <= n { 1.6 } else { 2.3 };
        let (a, b) = (printing(2.5 * u, 3), printing(4000.0 * u.powf(power), 1));
        grid.row(vec![Cell::Number(a), Cell::Number(b)]);
        points.push((a.value * 1e-3 / (gauge * 1e-2), b.value * GF / (width * 1e-2)));
    }
    let expected = vec![Expected::Curve { test: Test::Tensile, direction: Some(d), points }];
    let layout = if size { "raw force, size in one line" } else { "raw force, width and gauge" };
    Records { layout, grid, stem: "S1".into(), expected }
}

/// Only the file name says the direction; sample codes have numbers and words of their own.
fn file_name(rng: &mut Pcg64, heads: &Heads<'_>) -> Records {
    if heads.test == Test::Compression {
        return single(rng, heads);
    }
    use Direction::{Bias, Warp, Weft};
    let names: &[(&str, Option<Direction>)] = &[
        ("45_warp_{}_1", Some(Warp)),
        ("Ne40-45_weft_{}", Some(Weft)),
        ("sample45_warp_{}_2", Some(Warp)),
        ("T 45 weft {}", Some(Weft)),
        ("poplin_45deg_{}_1", Some(Bias)),
        ("poplin bias45 {}", Some(Bias)),
        ("F01_warp_{}_3", Some(Warp)),
        ("2024-05-17 weft {} 1", Some(Weft)),
        // Nobody can tell: these must not be read as anything.
        ("sample 45 {}", None),
        ("Ne40-45_{}", None),
        ("warp_weft_{}", None),
        ("T 45 {}", None),
        ("course_warp_{}", None),
    ];
    let (pattern, d) = pick(rng, names);
    let module = match heads.test {
        Test::Bending => "FB2",
        Test::Shear => "shear",
        Test::Friction => "friction",
        Test::Roughness => "FB4",
        _ => "tensile",
    };
    let r = Record { direction: d, ..record(rng, heads.test, d, heads.units) };
    let mut grid = Grid::default();
    if chance(rng, 0.5) {
        grid.texts(&[heads.language.date, "2024-05-17"]);
    }
    grid.row(heads.pair().to_vec());
    grid.rows.extend(heads.unit_row(1));
    body(&mut grid, &[&r]);
    let expected = match d {
        Some(_) => vec![expected(heads.test, &r, heads.factors())],
        None => vec![Expected::Refusal],
    };
    Records { layout: "direction in the file name", grid, stem: pattern.replace("{}", module), expected }
}

/// Friction and height over one position, as KES-FB4 records them; the friction as a force in some.
fn both_of_surface(rng: &mut Pcg64, l: &Language) -> Records {
    let heads = Heads { own_row: false, ..Heads::any(rng, l, Test::Friction) };
    let heights = Heads { own_row: false, square: heads.square, ..Heads::any(rng, l, Test::Roughness) };
    let d = directions(rng, Test::Friction, 1)[0];
    let a = record(rng, Test::Friction, d, heads.units);
    let b = record(rng, Test::Roughness, d, [heads.units[0], heights.units[1]]);
    let force = l.name == "en" && chance(rng, 0.5);
    let load = pick(rng, &[50.0, 25.0, 100.0]);
    let mut grid = Grid::default();
    grid.texts(&[l.sample[0], "S1"]);
    grid.texts(&["Test", "KES-FB4"]);
    grid.texts(&[l.direction[0], word(l, d.expect("a direction"))]);
    let mut second = heads.head(1, heads.names[1]);
    if force {
        grid.texts(&[pick(rng, &["Contact load", "Normal load"]), &format!("{load} gf")]);
        second = Cell::text(if heads.square { "Friction force [gf]" } else { "Friction force (gf)" });
    }
    grid.row(vec![heads.head(0, heads.names[0]), second, heights.head(1, heights.names[1])]);
    let [x, y] = heads.factors();
    let (mut friction, mut height) = (Vec::new(), Vec::new());
    for (p, q) in a.points.iter().zip(&b.points) {
        let shown = if force { printing(p.1.value * load, 3) } else { p.1 };
        grid.row(vec![Cell::Number(p.0), Cell::Number(shown), Cell::Number(q.1)]);
        let mu = if force { shown.value / load } else { shown.value * y };
        friction.push((p.0.value * x, mu));
        height.push((p.0.value * x, q.1.value * heights.units[1].1));
    }
    let curve = |test, points| Expected::Curve { test, direction: d, points };
    let expected = vec![curve(Test::Friction, friction), curve(Test::Roughness, height)];
    let layout = if force { "friction force and height" } else { "friction and height" };
    Records { layout, grid, stem: "S1".into(), expected }
}

/// The moment counted the other way round.
fn opposite_sign(rng: &mut Pcg64, l: &Language) -> Records {
    let heads = Heads::any(rng, l, Test::Bending);
    let d = directions(rng, Test::Bending, 1)[0];
    let r = record(rng, Test::Bending, d, heads.units);
    let mut grid = Grid::default();
    lines(&mut grid, rng, &heads, d);
    grid.row(heads.pair().to_vec());
    grid.rows.extend(heads.unit_row(1));
    for (a, b) in &r.points {
        let opposite = Printing { value: 0.0 - b.value, ..*b };
        grid.row(vec![Cell::Number(*a), Cell::Number(opposite)]);
    }
    let expected = vec![expected(Test::Bending, &r, heads.factors())];
    Records { layout: "moment of opposite sign", grid, stem: "S1".into(), expected }
}
