//! Workbooks as spreadsheet programs and accidents leave them.
//!
//! Kind: own. The small workbooks are put together here or were made for these tests (synthetic);
//! `twill.xls` holds the same cells as `twill.xlsx`, and two sheets without measurements.

use std::io::{Cursor, Read, Write};
use std::path::Path;
use std::time::{Duration, Instant};

use kesf::instrument::{FileContent, Parameter, ReadError, ReadSettings, parse};
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

const XLSX: &[u8] = include_bytes!("../workbooks/twill.xlsx");
const XLS: &[u8] = include_bytes!("../workbooks/twill.xls");

fn read(bytes: &[u8]) -> Result<FileContent, ReadError> {
    parse(Path::new("lab_warp_1.xlsx"), bytes, &ReadSettings::default())
}

fn error(bytes: &[u8]) -> String {
    read(bytes).map(|c| format!("{} curves", c.measurements.len())).unwrap_err().to_string()
}

/// A workbook of these sheets, each the XML of its rows; `strings` is the XML of the shared ones.
fn xlsx(sheets: &[&str], strings: &str) -> Vec<u8> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    let mut add = |name: &str, text: &str| {
        zip.start_file(name, SimpleFileOptions::default()).unwrap();
        zip.write_all(text.as_bytes()).unwrap();
    };
    let ids = || 1..=sheets.len();
    let office = "http://schemas.openxmlformats.org";
    add(
        "_rels/.rels",
        &format!(
            "<Relationships xmlns=\"{office}/package/2006/relationships\"><Relationship Id=\"rId1\" \
         Type=\"{office}/officeDocument/2006/relationships/officeDocument\" Target=\"xl/workbook.xml\"/></Relationships>"
        ),
    );
    let names: String =
        ids().map(|i| format!("<sheet name=\"s{i}\" sheetId=\"{i}\" r:id=\"rId{i}\"/>")).collect();
    add(
        "xl/workbook.xml",
        &format!(
            "<workbook xmlns=\"{office}/spreadsheetml/2006/main\" \
         xmlns:r=\"{office}/officeDocument/2006/relationships\"><sheets>{names}</sheets></workbook>"
        ),
    );
    let targets: String = ids()
        .map(|i| {
            format!(
                "<Relationship Id=\"rId{i}\" Target=\"worksheets/s{i}.xml\" \
                 Type=\"{office}/officeDocument/2006/relationships/worksheet\"/>"
            )
        })
        .collect();
    add(
        "xl/_rels/workbook.xml.rels",
        &format!("<Relationships xmlns=\"{office}/package/2006/relationships\">{targets}</Relationships>"),
    );
    // Style 1 is a date.
    add(
        "xl/styles.xml",
        &format!(
            "<styleSheet xmlns=\"{office}/spreadsheetml/2006/main\"><cellXfs><xf numFmtId=\"0\"/><xf numFmtId=\"14\"/></cellXfs></styleSheet>"
        ),
    );
    add("xl/sharedStrings.xml", &format!("<sst xmlns=\"{office}/spreadsheetml/2006/main\">{strings}</sst>"));
    for (i, rows) in ids().zip(sheets) {
        add(
            &format!("xl/worksheets/s{i}.xml"),
            &format!(
                "<worksheet xmlns=\"{office}/spreadsheetml/2006/main\"><dimension ref=\"A1:XFD1048576\"/><sheetData>{rows}</sheetData></worksheet>"
            ),
        );
    }
    zip.finish().unwrap().into_inner()
}

/// A row of cells from column A: texts begin with a letter, `=` is a formula with its last value.
fn row(number: usize, cells: &[&str]) -> String {
    let cell = |(i, text): (usize, &&str)| {
        let at = format!("{}{number}", (b'A' + i as u8) as char);
        match text.split_at_checked(1) {
            Some(("=", value)) => format!(
                "<c r=\"{at}\"><f>A1*2</f>{}</c>",
                if value.is_empty() { String::new() } else { format!("<v>{value}</v>") }
            ),
            Some(("#", _)) => format!("<c r=\"{at}\" t=\"e\"><v>{text}</v></c>"),
            Some(("@", value)) => format!("<c r=\"{at}\" s=\"1\"><v>{value}</v></c>"),
            Some((first, _)) if first.chars().all(char::is_alphabetic) => {
                format!("<c r=\"{at}\" t=\"inlineStr\"><is><t>{text}</t></is></c>")
            }
            _ => format!("<c r=\"{at}\"><v>{text}</v></c>"),
        }
    };
    format!("<row r=\"{number}\">{}</row>", cells.iter().enumerate().map(cell).collect::<String>())
}

/// A bending curve whose fifth row is given.
fn with_row(cells: &[&str]) -> Vec<u8> {
    let head = row(1, &["curvature (1/cm)", "moment (gf·cm/cm)"]);
    let rows = [head, row(2, &["0", "0"]), row(3, &["0.5", "0.05"]), row(4, &["1", "0.1"]), row(5, cells)];
    xlsx(&[&rows.concat()], "")
}

#[test]
fn both_formats_give_the_same_curves_and_values() {
    let [new, old] = [XLSX, XLS].map(|b| read(b).unwrap());
    let curves = |c: &FileContent| c.measurements.iter().map(|m| m.curve.clone()).collect::<Vec<_>>();
    assert_eq!(curves(&new), curves(&old));
    assert_eq!(new.measurements[1].lines, old.measurements[1].lines);
    assert_eq!(new.results, old.results);
    assert_eq!(old.results.len(), 5);
}

#[test]
fn formulas_give_their_last_value() {
    let content = read(&with_row(&["=2", "=0.2"])).unwrap();
    let curve = &content.measurements[0].curve;
    assert_eq!(curve.x.len(), 4);
    assert!((curve.y[3] - 0.2 * 9.80665e-3).abs() < 1e-17);
}

/// Nothing is taken for a number that the spreadsheet does not hold as one, and the place is told.
#[test]
fn what_is_no_number_is_refused_at_its_cell() {
    for (cells, expected) in [
        // A formula that was never calculated has no value.
        (["1.5", "="], "lab_warp_1.xlsx:5:2: R016 the row has no value of \"moment\""),
        (["1.5", "#DIV/0!"], "lab_warp_1.xlsx:5:2: R017 \"#DIV/0!\" is not a finite number"),
        // 22.5 typed in a date-happy locale.
        (["1.5", "@45434"], "lab_warp_1.xlsx:5:2: R004 \"date 45434\" is not a number (decimal mark is '.')"),
    ] {
        assert_eq!(error(&with_row(&cells)), expected);
    }
}

#[test]
fn empty_sheets_are_passed_over_and_an_empty_workbook_is_told() {
    let table = [row(1, &["direction", "B (gf·cm²/cm)", "G (N/m)"]), row(2, &["warp", "0.1", "30"])].concat();
    assert_eq!(read(&xlsx(&["", &table, ""], "")).unwrap().results.len(), 2);
    assert_eq!(error(&xlsx(&["", ""], "")), "lab_warp_1.xlsx: R002 the file holds no measured values");
}

/// Declared dimensions are not believed, and cells far away cost nothing or are refused.
#[test]
fn huge_sheets_are_refused_in_no_time() {
    let start = Instant::now();
    // `A1:XFD1048576` is declared by every sheet made here.
    assert!(read(&with_row(&["1.5", "0.15"])).is_ok());
    let text = error(&xlsx(&["<row r=\"9\"><c r=\"XFD9\"><v>1</v></c></row>"], ""));
    assert_eq!(
        text,
        "lab_warp_1.xlsx: R021 the workbook cannot be read: a cell stands in column 16384; 1024 are read at most"
    );
    let comb: String =
        (1..=5000).map(|r| format!("<row r=\"{r}\"><c r=\"AMJ{r}\"><v>1</v></c></row>")).collect();
    assert!(error(&xlsx(&[&comb], "")).contains("span more than 4000000 places"));
    // 200 MB of blanks in a text.
    let bomb = xlsx(&[""], &format!("<si><t>{}</t></si>", " ".repeat(200 << 20)));
    assert!(bomb.len() < 1 << 20);
    assert!(error(&bomb).contains("unpacks to more than 128 MB"));
    println!("{:?}", start.elapsed());
    assert!(start.elapsed() < Duration::from_secs(20));
}

/// Replaces the bytes behind the first place where `pattern` stands.
fn patched(bytes: &[u8], pattern: &[u8], with: &[u8]) -> Vec<u8> {
    let at = bytes.windows(pattern.len()).position(|w| w == pattern).expect("the pattern") + pattern.len();
    let mut bytes = bytes.to_vec();
    bytes[at..at + with.len()].copy_from_slice(with);
    bytes
}

/// A reader that believes such a record reserves memory until the program is ended.
#[test]
fn an_old_workbook_with_impossible_records_is_refused() {
    let dimensions = [0x00, 0x02, 0x0e, 0x00];
    let huge = patched(XLS, &dimensions, &[0, 0, 0, 0, 0xff, 0xff, 0xff, 0xff]);
    assert!(error(&huge).contains("R021 the workbook cannot be read: a sheet declares more rows or columns"));
    // The last row before the first.
    let turned = patched(XLS, &dimensions, &[9, 0, 0, 0, 5, 0, 0, 0]);
    assert!(error(&turned).contains("a sheet declares more rows or columns"));
    // NUMBER, 14 bytes: row and column.
    let number = [0x03, 0x02, 0x0e, 0x00];
    assert!(error(&patched(XLS, &number, &[0, 0, 0, 2])).contains("a column that the format does not have"));
    assert!(error(&patched(XLS, &number, &[0xff, 0xff, 0xff, 0])).contains("span more than"));
}

#[test]
fn damaged_workbooks_are_refused_with_a_code() {
    for bytes in [XLSX, XLS] {
        for cut in [8, 100, 600, bytes.len() / 2, bytes.len() - 30] {
            let text = error(&bytes[..cut]);
            assert!(text.starts_with("lab_warp_1.xlsx: R021 the workbook cannot be read: "), "{cut}: {text}");
        }
    }
}

/// The reader of old workbooks panics over a record that lacks its data: that is an error of the file.
#[test]
fn a_record_without_its_data_costs_its_file_only() {
    let mut file = cfb::CompoundFile::open(Cursor::new(XLS.to_vec())).unwrap();
    let mut book = Vec::new();
    file.open_stream("/Workbook").unwrap().read_to_end(&mut book).unwrap();
    // A code page (0x0042) of no bytes behind the record that begins the workbook.
    let first = 4 + usize::from(u16::from_le_bytes([book[2], book[3]]));
    book.splice(first..first, [0x42, 0, 0, 0]);
    file.create_stream("/Workbook").unwrap().write_all(&book).unwrap();
    file.flush().unwrap();
    let said = error(&file.into_inner().into_inner());
    assert!(said.contains("R021") && said.contains("damaged"), "{said}");
}

/// What is struck out was not to count; a formula that no program has calculated has no value. Both are told.
#[test]
fn cells_that_are_struck_out_or_were_never_calculated() {
    let b = |content: &FileContent| -> Vec<f64> {
        let of_b = content.results.iter().filter(|(_, r)| r.parameter == Parameter::B);
        of_b.map(|(_, r)| (r.mean / 9.80665e-5 * 1e4).round() / 1e4).collect()
    };
    let message = |content: &FileContent, code: &str| {
        content.findings.iter().find(|f| f.code() == code).unwrap().message()
    };
    let struck_out = read(include_bytes!("../workbooks/struck-out.xlsx")).unwrap();
    assert_eq!(b(&struck_out), [0.1, 0.06]);
    assert!(message(&struck_out, "R113").contains("cells A3, B3, C3, D3, E3, struck out"));
    let formula = read(include_bytes!("../malformed/r129-formula.xlsx")).unwrap();
    assert_eq!(b(&formula), [0.06]);
    assert!(message(&formula, "R129").contains("cell C2 of sheet"));
}

/// A summary without units beside sheets of curves costs itself, and is told.
#[test]
fn a_summary_without_units_does_not_cost_the_curves() {
    let curve = [
        row(1, &["curvature (1/cm)", "moment (gf·cm/cm)"]),
        row(2, &["0", "0"]),
        row(3, &["1", "0.1"]),
        row(4, &["2", "0.2"]),
    ];
    let summary = [row(1, &["Parameter", "Value"]), row(2, &["B", "0.08"]), row(3, &["G", "0.7"])].concat();
    for sheets in [[curve.concat(), summary.clone()], [summary.clone(), curve.concat()]] {
        let content = read(&xlsx(&[&sheets[0], &sheets[1]], "")).unwrap();
        assert_eq!((content.measurements.len(), content.results.len()), (1, 0));
        let told: Vec<_> = content.findings.iter().filter(|f| f.code() == "R123").collect();
        assert!(told.len() == 1 && told[0].message().contains("\"B\" has no unit"), "{:?}", content.findings);
    }
    assert!(error(&xlsx(&[&summary], "")).contains("R008"));
}
