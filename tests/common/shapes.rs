//! Files of one repeated piece, for the bench and the test of what reading costs as a file grows.

const HEAD: &str = "sample,poplin\ninstrument,KES-FB2\ndirection,warp\nspecimen,1\n";
const RECORD: &str =
    "curvature (1/cm),moment (gf·cm/cm)\n0,0\n1,0.05\n2.5,0.2\n1,0.0\n0,-0.05\n-2.5,-0.2\n-1,0\n0,0.05\n";
const TABLE: &str = "fabric,B warp (gf·cm²/cm),B weft (gf·cm²/cm)\n";

/// A name, pieces of the smallest file of the bench, its ending, and its text of so many pieces.
pub type Shape = (&'static str, usize, &'static str, fn(usize) -> String);

fn repeated(n: usize, piece: impl Fn(usize) -> String) -> String {
    (0..n).map(piece).collect()
}

/// What files are repeated of.
pub const SHAPES: &[Shape] = &[
    ("words in one line", 20_000, "txt", |n| "lorem ipsum dolor sit ".repeat(n)),
    ("keys in one line", 5_000, "txt", |n| "test: bending = 5 gf/cm, ".repeat(n)),
    ("brackets in one line", 50_000, "txt", |n| "(".repeat(n)),
    ("columns", 2_000, "csv", |n| {
        let line = |of: fn(usize) -> String| repeated(n, of) + "\n";
        line(|i| format!("c{i} (gf/cm),")) + &line(|_| "1,".into()) + &line(|_| "2,".into())
    }),
    ("header lines of one direction", 5_000, "csv", |n| "direction,warp\n".repeat(n) + HEAD + RECORD),
    ("header lines", 5_000, "csv", |n| repeated(n, |i| format!("note {i},value {i}\n")) + HEAD + RECORD),
    // Two cells in each line, of which one is a heading with a unit: nothing follows that could be read.
    ("headings without numbers", 5_000, "csv", |n| "k1;wert (gf/cm)\n".repeat(n)),
    ("headings without numbers, each another", 5_000, "csv", |n| {
        repeated(n, |i| format!("k{i};wert {} (gf/cm)\n", i % 997))
    }),
    ("blank lines", 50_000, "csv", |n| format!("{HEAD}{}{RECORD}", "\n".repeat(n))),
    ("records", 250, "csv", |n| {
        repeated(n, |i| HEAD.replace("specimen,1", &format!("specimen,{}", i + 1)) + RECORD + "\n")
    }),
    ("samples of a record", 20_000, "csv", |n| {
        let sample =
            |i: usize| format!("{:.5},{:.5}\n", 2.5 * i as f64 / n as f64, 0.2 * i as f64 / n as f64);
        format!("{HEAD}curvature (1/cm),moment (gf·cm/cm)\n{}", repeated(n, sample))
    }),
    ("fabrics of a table", 5_000, "csv", |n| {
        TABLE.to_string() + &repeated(n, |i| format!("f{i},0.{},0.05\n", 100 + i % 800))
    }),
    ("rows of a fabric in a table", 5_000, "csv", |n| {
        TABLE.to_string() + &repeated(n, |i| format!("f,0.{},0.05\n", 100 + i % 800))
    }),
    ("tables of a web page", 2_000, "xls", |n| {
        "<table><tr><td>lorem ipsum dolor</td></tr></table>".repeat(n)
    }),
];
