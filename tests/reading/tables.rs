//! Tables and headers as programs write them: what is read of each, and what is told.
//!
//! Kind: analytical. The numbers are those in the texts, times exact factors of units.

use std::path::Path;

use approx::assert_relative_eq;
use kesf::instrument::{Direction, FileContent, Parameter, ReadError, ReadSettings, parse};

fn attempt(text: &str) -> Result<FileContent, ReadError> {
    parse(Path::new("t.csv"), text.as_bytes(), &ReadSettings { kes_units: true, ..ReadSettings::default() })
}

fn read(text: &str) -> FileContent {
    attempt(text).unwrap_or_else(|e| panic!("{e}: {text}"))
}

/// Fabric, parameter, direction and value in the KES unit, in the order of the file.
fn values(content: &FileContent) -> Vec<(String, Parameter, Option<Direction>, f64)> {
    let value = |(name, v): &(Option<String>, kesf::instrument::ResultValue)| {
        let mean = (v.mean / v.parameter.kes_factor() * 1e9).round() / 1e9;
        (name.clone().unwrap_or_default(), v.parameter, v.direction, mean)
    };
    let mut all: Vec<_> = content.results.iter().map(value).collect();
    all.sort_by(|a, b| (&a.0, a.1, a.2).cmp(&(&b.0, b.1, b.2)));
    all
}

fn told(content: &FileContent, code: &str) -> Vec<String> {
    content.findings.iter().filter(|f| f.code() == code).map(|f| f.message()).collect()
}

const WARP: Option<Direction> = Some(Direction::Warp);
const WEFT: Option<Direction> = Some(Direction::Weft);

/// `B_w` beside `B_f` is warp and fill, which is told; `B_f` beside `B_b` is the face, as it was.
#[test]
fn warp_and_fill_are_letters_beside_each_other() {
    let pair = read("fabric,B_w,B_f,G_w,G_f,LT\nx,0.1,0.05,0.7,0.8,0.6\n");
    let found = values(&pair);
    for (parameter, direction, value) in [
        (Parameter::B, WARP, 0.1),
        (Parameter::B, WEFT, 0.05),
        (Parameter::G, WARP, 0.7),
        (Parameter::G, WEFT, 0.8),
        (Parameter::Lt, None, 0.6),
    ] {
        assert!(found.contains(&("x".into(), parameter, direction, value)), "{found:?}");
    }
    assert_eq!(found.len(), 5, "{found:?}");
    assert!(told(&pair, "R133")[0].contains("B_f"), "{:?}", pair.findings);
    let sides = read("fabric,B_f,B_b\nx,0.1,0.05\n");
    assert!(sides.results.iter().all(|(_, v)| v.direction.is_none()), "{:?}", sides.results);
    assert!(told(&sides, "R133").is_empty());
    // W is the areal density, and no direction of its own.
    let mass = read("fabric,W,B_warp\nx,12,0.05\n");
    assert_eq!(values(&mass).len(), 2, "{:?}", mass.results);
}

/// Directions below a fabric end with it; those over the fabrics hold for all of them.
#[test]
fn a_title_of_a_fabric_ends_the_direction_within_the_one_before() {
    let inner = "Specimen,B,LT\nUno,,\nWarp,,\n1,0.1,0.6\n2,0.1,0.6\nWeft,,\n1,0.2,0.7\n2,0.2,0.7\nDos,,\n1,0.3,0.8\n2,0.3,0.8\n";
    let found = values(&read(inner));
    let of_dos: Vec<_> = found.iter().filter(|v| v.0 == "Dos").map(|v| (v.1, v.2, v.3)).collect();
    assert_eq!(of_dos, [(Parameter::Lt, None, 0.8), (Parameter::B, None, 0.3)]);
    let outer = "Specimen,B,LT\nWarp,,\nUno,,\n1,0.1,0.6\n2,0.1,0.6\nDos,,\n1,0.3,0.8\n2,0.3,0.8\n\
                 Weft,,\nUno,,\n1,0.2,0.7\n2,0.2,0.7\nDos,,\n1,0.4,0.9\n2,0.4,0.9\n";
    let found = values(&read(outer));
    let of_b: Vec<_> =
        found.iter().filter(|v| v.1 == Parameter::B).map(|v| (v.0.as_str(), v.2, v.3)).collect();
    assert_eq!(of_b, [("Dos", WARP, 0.3), ("Dos", WEFT, 0.4), ("Uno", WARP, 0.1), ("Uno", WEFT, 0.2)]);
}

/// `write.table` of R has no heading over the names of rows. Where the last heading may as well be missing, the table is refused.
#[test]
fn names_of_rows_have_no_heading_in_tables_of_r() {
    for text in [
        "\"fabric\",\"B\",\"LT\"\n\"1\",\"Uno\",0.1,0.6\n\"2\",\"Dos\",0.2,0.7\n",
        "fabric,B,LT\n1,Uno,0.1,0.6\n2,Dos,0.2,0.7\n",
        "\"B\",\"LT\"\n\"Uno\",0.1,0.6\n\"Dos\",0.2,0.7\n",
        "\"fabric\" \"B\" \"LT\"\n\"1\" \"Uno\" 0.1 0.6\n\"2\" \"Dos\" 0.2 0.7\n",
        "\"B\" \"LT (-)\"\n\"Uno\" 0.1 0.6\n\"Dos\" 0.2 0.7\n",
    ] {
        let content = read(text);
        let of_b: Vec<_> =
            values(&content).into_iter().filter(|v| v.1 == Parameter::B).map(|v| (v.0, v.3)).collect();
        assert_eq!(of_b, [("Dos".into(), 0.2), ("Uno".into(), 0.1)], "{text}: {:?}", content.results);
        assert_eq!(told(&content, "R143").len(), 1, "{text}: {:?}", content.findings);
    }
    assert!(attempt("fabric,B\nUno,0.1,0.2\nDos,0.2,0.3\n").is_err());
    assert!(attempt("\"fabric\",\"B\"\n\"Uno\",0.1,0.2\n").is_err());
}

/// What a program could not show is missing, and told.
#[test]
fn signs_in_the_place_of_numbers_are_told() {
    let content = read("fabric,B warp,LT warp,EMT warp\nx,***,0.6,5\ny,0.1,####,6\n");
    let found = values(&content);
    assert_eq!(found.len(), 4, "{found:?}");
    let messages = told(&content, "R142");
    assert!(messages.len() == 1 && messages[0].contains("\"***\", \"####\""), "{messages:?}");
}

/// `-1.25D-02` of Fortran is -0.0125.
#[test]
fn exponents_of_fortran() {
    let content = read("fabric,B warp,LT warp\nx,1.000D-01,6.0D-01\n");
    assert_eq!(values(&content).iter().map(|v| v.3).collect::<Vec<_>>(), [0.6, 0.1]);
    let curve = "test: bending\ndirection: warp\n\ncurvature (1/cm),moment (gf·cm/cm)\n0.0D+00,0.0D+00\n1.0D+00,1.0D-01\n2.0D+00,2.0D-01\n";
    assert_relative_eq!(read(curve).measurements[0].curve.y[1], 0.1 * 9.80665e-3, max_relative = 1e-12);
}

/// 10 kgf on 20 cm are 500 gf/cm. A load cell says nothing of a test that ends elsewhere.
#[test]
fn a_maximum_load_is_one_over_the_width() {
    let tensile = |header: &str, last: f64| {
        let text = format!(
            "test: tensile\ndirection: warp\n{header}\n\nstrain (%),load (gf/cm)\n0,0\n1,{}\n2,{last}\n",
            0.3 * last
        );
        read(&text).measurements[0].conditions.maximum / 0.980665
    };
    assert_relative_eq!(tensile("Maximum load: 10 kgf", 500.0), 500.0, max_relative = 1e-12);
    assert_relative_eq!(tensile("width: 10 cm\nMaximum load: 500 gf", 50.0), 50.0, max_relative = 1e-12);
    assert_relative_eq!(tensile("Maximum load: 50 kgf", 500.0), 500.0, max_relative = 1e-12);
    let bending = read(
        "test: bending\ndirection: warp\nMaximum load: 10 kgf\n\ncurvature (1/cm),moment (gf·cm/cm)\n0,0\n1,0.1\n2.5,0.25\n",
    );
    assert_relative_eq!(bending.measurements[0].conditions.maximum, 250.0, max_relative = 1e-12);
}

#[test]
fn a_list_of_records_is_refused_with_what_to_do() {
    let error = attempt("[{\"fabric\":\"x\",\"B\":0.1}]").unwrap_err();
    assert!(error.code() == "R023" && error.to_string().contains("to_csv"), "{error}");
}

/// Signs of a test of significance are no values and no lost ones: behind a number, alone, and in a row of their own.
#[test]
fn signs_of_significance_are_no_missing_values() {
    let behind = read("fabric,B warp,LT warp\nx,0.1**,0.6 n.s.\ny,0.2 ns,0.7 (***)\n");
    assert_eq!(values(&behind).iter().map(|v| v.3).collect::<Vec<_>>(), [0.6, 0.1, 0.7, 0.2]);
    assert!(told(&behind, "R142").is_empty() && told(&behind, "R130").len() == 1, "{:?}", behind.findings);
    for (alone, signs) in [
        ("fabric,B warp,B warp,LT warp,LT warp\nx,0.1,***,0.6,**\n", "\"***\", \"**\""),
        ("fabric,B warp,LT warp\nx,0.1,0.6\nSig.,***,*\n", "\"***\", \"*\""),
        ("fabric,B warp,LT warp\nx,0.1,0.6\nSignificance,***,***\n", "\"***\", \"***\""),
    ] {
        let content = read(alone);
        assert_eq!(values(&content).iter().map(|v| v.3).collect::<Vec<_>>(), [0.6, 0.1], "{alone}");
        assert!(told(&content, "R147")[0].contains(signs), "{alone}: {:?}", content.findings);
        let others = ["R142", "R138"].map(|code| told(&content, code).len());
        assert!(others == [0, 0] && content.failures.is_empty(), "{alone}: {:?}", content.findings);
    }
}

/// A table without units beside a record costs itself, and is told; alone it is refused.
#[test]
fn a_table_that_cannot_be_read_does_not_cost_the_curves() {
    let table = "Parameter,Value\nB,0.08\n2HB,0.05\n";
    let curve = "test,bending\ndirection,warp\n\ncurvature (1/cm),moment (gf·cm/cm)\n0,0\n1,0.1\n2,0.2\n";
    let settings = ReadSettings::default();
    for text in [format!("{curve}\n{table}"), format!("{table}\n{curve}")] {
        let content = parse(Path::new("t.csv"), text.as_bytes(), &settings).unwrap();
        assert_eq!((content.measurements.len(), content.results.len()), (1, 0));
        assert!(told(&content, "R123")[0].contains("no unit"), "{:?}", content.findings);
    }
    assert_eq!(parse(Path::new("t.csv"), table.as_bytes(), &settings).unwrap_err().code(), "R008");
}

/// A mean is never lost to rows below it that have no number and that it does not sum up, whatever they are called.
#[test]
fn statistics_of_unknown_names_below_a_mean_are_not_the_value() {
    let b = |content: &FileContent| values(content).iter().map(|v| (v.2, v.3)).collect::<Vec<_>>();
    for below in ["Std. Error Mean", "err", "± s", "Streuweite", "x̃"] {
        let tidy =
            read(&format!("Fabric,Direction,Statistic,B\nF1,warp,Mean,0.0812\nF1,warp,{below},0.0183\n"));
        assert_eq!(b(&tidy), [(WARP, 0.0812)], "{below}");
        assert_eq!(told(&tidy, "R110").len(), 1, "{below}");
        let rows = read(&format!(",B warp,B weft\nmean,0.0812,0.0533\n{below},0.0183,0.0041\n"));
        assert_eq!(b(&rows), [(WARP, 0.0812), (WEFT, 0.0533)], "{below}");
    }
    // Specimens average to their mean, and stand above it or have numbers.
    let repeats = read("Fabric,Direction,B\nF1,warp,0.08\nF1,warp,0.09\nMean,,0.2\n");
    assert_eq!(b(&repeats), [(WARP, 0.085)]);
    let numbered = read("Fabric,Direction,Specimen,B\nF1,warp,Mean,0.2\nF1,warp,1,0.08\nF1,warp,2,0.09\n");
    assert_eq!(b(&numbered), [(WARP, 0.085)]);
    let below = read("Fabric,Direction,Statistic,B\nF1,warp,Mean,0.085\nF1,warp,,0.08\nF1,warp,,0.09\n");
    assert_eq!(b(&below), [(WARP, 0.085)]);
}

/// `F1 mean` sums up parts, `F1 1` and `F1 2`, where there are several; beside one name that begins so it is a value of its own.
#[test]
fn a_mean_in_a_name_is_not_that_of_one_part() {
    let named = |second: &str| {
        let found = read(&format!("Fabric,Direction,B\nF1 mean,warp,0.0812\n{second}"));
        values(&found).into_iter().map(|(name, .., mean)| (name, mean)).collect::<Vec<_>>()
    };
    assert!(named("F1 streu,warp,0.0162\n").contains(&("F1 mean".into(), 0.0812)));
    let parts = named("F1 1,warp,0.08\nF1 2,warp,0.0824\n");
    assert!(!parts.iter().any(|(name, _)| name.contains("mean")), "{parts:?}");
}

/// A column of states tells averaged rows apart in long tables as in wide ones.
#[test]
fn states_in_a_long_table_are_told() {
    let long = "fabric,treatment,direction,variable,value,unit\ncotton,untreated,warp,B,0.08,gf·cm²/cm\n\
                cotton,washed,warp,B,0.06,gf·cm²/cm\n";
    let found = read(long);
    assert_eq!(values(&found), [("cotton".into(), Parameter::B, WARP, 0.07)]);
    assert!(told(&found, "R126")[0].contains("\"untreated\" and \"washed\""), "{:?}", found.findings);
    // What describes a parameter does not tell its repeats apart.
    let described = "fabric,description,variable,value,unit\na,rigidity,B,0.08,gf·cm²/cm\na,stiffness,G,0.8,gf/(cm·deg)\n";
    assert!(told(&read(described), "R126").is_empty());
}

/// Lines of one text over rows whose names come again are the states of their fabrics, whichever way the table lies; titles of other
/// parameters are none.
#[test]
fn titles_over_rows_that_come_again_are_states() {
    let names = |text: &str| {
        let found = values(&read(text));
        found.into_iter().map(|(name, .., mean)| (name, mean)).collect::<Vec<_>>()
    };
    let states = |one: &str, other: &str| {
        [
            (format!("{one} F1"), 0.08),
            (format!("{one} F2"), 0.12),
            (format!("{other} F1"), 0.06),
            (format!("{other} F2"), 0.1),
        ]
    };
    for [one, other] in [["Before washing", "After 5 washes"], ["65 % RH", "90 % RH"]] {
        let mut known = states(one, other).to_vec();
        known.sort_by(|a, b| a.0.cmp(&b.0));
        let across =
            format!("Fabric,B warp (gf·cm²/cm)\n{one}\nF1,0.08\nF2,0.12\n{other}\nF1,0.06\nF2,0.1\n");
        assert_eq!(names(&across), known, "{across}");
        let down = format!("Parameter,Direction,F1,F2\n{one}\nB,warp,0.08,0.12\n{other}\nB,warp,0.06,0.1\n");
        assert_eq!(names(&down), known, "{down}");
    }
    let tests = read("Parameter,Direction,F1,F2\nBending\nB,warp,0.08,0.12\nShear\nG,warp,0.6,0.1\n");
    assert_eq!(values(&tests).iter().filter(|v| v.0 == "F1").count(), 2, "{:?}", tests.results);
    // One specimen below the other is no fabric.
    let counted =
        read("Parameter,Direction,F1,F2\nSpecimen 1\nB,warp,0.08,0.12\nSpecimen 2\nB,warp,0.06,0.1\n");
    assert!(values(&counted).contains(&("F1".into(), Parameter::B, WARP, 0.07)), "{:?}", counted.results);
}

/// What a title or a sheet calls deviations or correlations is refused, and left out beside values.
#[test]
fn tables_of_no_values_by_their_titles() {
    let table = "Fabric,B warp,B weft\nF1,0.0141,0.0153\n";
    for title in [
        "Table A2: Standard deviations of the KES parameters",
        "Correlation with the hand",
        "Change by washing (%)",
    ] {
        assert_eq!(attempt(&format!("{title}\n{table}")).unwrap_err().code(), "R026", "{title}");
    }
    for title in [
        "Table 2: Means and standard deviations",
        "Results of standard fabrics",
        "Table 1: KES parameters",
        "Changes of B by washing",
    ] {
        assert_eq!(values(&read(&format!("{title}\n{table}"))).len(), 2, "{title}");
    }
    // In brackets stands what the title speaks of.
    assert_eq!(values(&read("Standard deviations\nFabric,B warp (gf·cm²/cm)\nF1,0.08 (0.01)\n")).len(), 1);
    let both = read(
        "Table 1: Means\nFabric,B warp (gf·cm²/cm)\nF1,0.0812\n\nTable 2: Standard deviations\nFabric,B warp (gf·cm²/cm)\nF1,0.0141\n",
    );
    assert_eq!(values(&both), [("F1".into(), Parameter::B, WARP, 0.0812)]);
    assert_eq!(told(&both, "R123").len(), 1, "{:?}", both.findings);
}

/// `1 = weft, 2 = warp` above the table goes before the use of the literature, and needs no remark.
#[test]
fn a_key_says_what_the_numbers_behind_symbols_are() {
    for key in ["1 = weft, 2 = warp", "\"1 = weft; 2 = warp\"", "(1: weft; 2: warp)"] {
        let found = read(&format!("{key}\nFabric,B-1,B-2\nF1,0.0533,0.0812\n"));
        assert_eq!(
            values(&found),
            [("F1".into(), Parameter::B, WARP, 0.0812), ("F1".into(), Parameter::B, WEFT, 0.0533)],
            "{key}"
        );
        assert!(told(&found, "R111").is_empty(), "{key}");
    }
    let bare = read("Fabric,B-1,B-2\nF1,0.0812,0.0533\n");
    assert_eq!(told(&bare, "R111").len(), 1);
}

/// Each fabric whose value lacks a direction is told, as each has a doubtful value.
#[test]
fn every_fabric_without_a_direction_is_told() {
    let found = read("Fabric,B warp,B\nF1,0.08,0.05\nF2,0.12,0.1\n");
    assert_eq!(told(&found, "R136").len(), 2, "{:?}", found.findings);
}

/// Layouts that were refused, each with the values that stand in it.
#[test]
fn layouts_of_reports() {
    let b = |direction, value| ("F1".to_string(), Parameter::B, direction, value);
    let both = [b(WARP, 0.0812), b(WEFT, 0.0533)];
    for text in [
        "Fabric,Direction,B\nF1,0,0.0812\nF1,90,0.0533\n",
        "Fabric,Direction,B\nF1,0°,0.0812\nF1,90°,0.0533\n",
        "Fabric,Warp/Weft,B\nF1,Warp,0.0812\nF1,Weft,0.0533\n",
        "fabric,direction,rep,variable,value\nF1,warp,1,B,0.0812\nF1,weft,1,B,0.0533\n",
        ",,B (gf·cm²/cm),B (gf·cm²/cm)\n,,mean,std\nfabric,direction,,\nF1,warp,0.0812,0.004\n,weft,0.0533,0.003\n",
    ] {
        assert_eq!(values(&read(text)), both, "{text}");
    }
    for text in [
        "Mean values, n = 5\nFabric,B warp (gf·cm²/cm),B weft (gf·cm²/cm)\nF1,0.0812,0.0533\n",
        "Fabric,Direction,B\nF1,warp,0.0812 ± 0.0041 (n = 5)\nF1,weft,0.0533 ± 0.003 (n = 5)\n",
        "Fabric,Direction,B\nF1,warp,\"0.0812 ± 0.0041, n=5\"\nF1,weft,0.0533 (0.003) [n = 5]\n",
    ] {
        let found = read(text);
        assert_eq!(values(&found), both, "{text}");
        assert!(found.results.iter().all(|(_, v)| v.n == 5), "{text}");
    }
    // Units between two rows of heads, once over what their parameter stands over.
    let units =
        read("Fabric,B,,2HB,\n,gf·cm²/cm,,gf·cm/cm,\n,warp,weft,warp,weft\nF1,0.0812,0.0533,0.04,0.03\n");
    assert_eq!(values(&units)[..2], both);
    // Specimens below each direction, beside a column of units.
    let repeats =
        read(",,Warp,,,Weft,,\nParameter,Unit,1,2,3,1,2,3\nB,gf·cm²/cm,0.08,0.081,0.082,0.052,0.053,0.054\n");
    let found: Vec<_> = values(&repeats).into_iter().map(|(.., direction, mean)| (direction, mean)).collect();
    assert_eq!(found, [(WARP, 0.081), (WEFT, 0.053)]);
    assert!(repeats.results.iter().all(|(_, v)| v.n == 3));
    // A mean and another statistic of each fabric.
    let means =
        read(",,F1,,F2,\nParameter,Direction,Mean,CV [%],Mean,CV [%]\nB,warp,0.0812,5.1,0.1234,4.2\n");
    assert_eq!(values(&means), [b(WARP, 0.0812), ("F2".into(), Parameter::B, WARP, 0.1234)]);
    // The title of a group of parameters, and dashes where there is no unit and no direction.
    let groups = "Property,Symbol,Unit,Direction,F1,F2\nBending,B,gf·cm²/cm,Warp,0.0812,0.1234\nSurface,,,,,\n\
                  Linearity,LC,-,-,0.341,0.287\n";
    assert!(values(&read(groups)).contains(&("F2".into(), Parameter::Lc, None, 0.287)), "{groups}");
    // `X2HB` of R.
    let of_r = read("fabric,direction,B,X2HB\nF1,warp,0.0812,0.04\n");
    assert_eq!(values(&of_r).last().map(|v| (v.1, v.3)), Some((Parameter::Hb, 0.04)));
    // `[0.004]` is a deviation.
    assert!(read("Fabric,Direction,B,G\nF1,warp,0.0812 [0.004],0.5\n").results[0].1.sd.is_some());
    // Angles of one kind only are none.
    assert_eq!(attempt("Fabric,Direction,B\nF1,0,0.0812\nF2,0,0.0533\n").unwrap_err().code(), "R018");
}

/// Numbers under words that head nothing are told with what is missing, and a file without numbers as empty.
#[test]
fn numbers_that_nothing_heads_are_no_empty_file() {
    let read = |text: &str| parse(Path::new("t.csv"), text.as_bytes(), &ReadSettings::default());
    let error = read("Fabric,B warp\nF1,0.08\n").unwrap_err();
    assert_eq!((error.code(), error.place().line), ("R006", 1));
    assert!(error.to_string().contains("\"Fabric | B warp\" is over the numbers"), "{error}");
    assert_eq!(read("Fabric,Remark\nF1,none\n").unwrap_err().code(), "R002");
}

/// How many values a column of states makes doubtful (R126).
fn states_of(text: &str) -> usize {
    use kesf::finding::{Fact, ReadFact};
    let of = |finding: &kesf::finding::Finding| match &finding.fact {
        Fact::Reading(ReadFact::ColumnOfStates { keys, .. }) => keys.len(),
        _ => 0,
    };
    read(text).findings.iter().map(of).sum()
}

/// What tells rows apart may be numbers in a column between those of names and values; the sign of a mean has its meaning.
#[test]
fn numbers_may_be_states_and_signs_means() {
    let long = "fabric,washes,direction,variable,value,unit\nF1,0,warp,B,0.0812,gf·cm²/cm\nF1,5,warp,B,0.065,gf·cm²/cm\n";
    assert!(told(&read(long), "R126")[0].contains("\"washes\""), "{long}");
    // Merged cells of a state hold for the rows below; one remark is that of its own row.
    let merged =
        "Fabric,Washing,Direction,B\nCotton,before,warp,0.08\n,,weft,0.05\n,after,warp,0.12\n,,weft,0.09\n";
    assert_eq!(states_of(merged), 2, "{merged}");
    let remark =
        "Fabric,Note,Direction,B\nCotton,outlier,warp,0.08\nCotton,,warp,0.081\nCotton,,warp,0.082\n";
    assert_eq!(states_of(remark), 1, "{remark}");
    let signs = read(",B warp,B weft\nx\u{304},0.0812,0.0533\ns,0.016,0.0107\n");
    let found: Vec<_> = values(&signs).into_iter().map(|(.., direction, mean)| (direction, mean)).collect();
    assert_eq!(found, [(WARP, 0.0812), (WEFT, 0.0533)]);
    let limits = read(
        "Fabric,Direction,Statistic,B\nF1,warp,Mean,0.0812\nF1,warp,lower.CL,0.07\nF1,warp,upper.CL,0.09\n",
    );
    assert_eq!(values(&limits), [("F1".into(), Parameter::B, WARP, 0.0812)]);
}

/// Titles of fabrics over rows of directions, also on two levels and above the second half only; tests are no fabrics.
#[test]
fn titles_of_fabrics_over_directions() {
    let head = "Fabric,B (gf·cm²/cm),2HB (gf·cm/cm)\n";
    let of = |text: &str| -> Vec<(String, Option<Direction>, f64)> {
        let found = values(&read(&format!("{head}{text}")));
        found
            .into_iter()
            .filter(|v| v.1 == Parameter::B)
            .map(|(name, _, direction, mean)| (name, direction, mean))
            .collect()
    };
    let v = |name: &str, direction, mean| (name.to_string(), direction, mean);
    let plain = of("Cotton,,\nWarp,0.08,0.04\nWeft,0.05,0.03\nWool,,\nWarp,0.1,0.06\nWeft,0.07,0.05\n");
    assert_eq!(
        plain,
        [v("Cotton", WARP, 0.08), v("Cotton", WEFT, 0.05), v("Wool", WARP, 0.1), v("Wool", WEFT, 0.07)]
    );
    let two = of(
        "Cotton,,\nBefore,,\nWarp,0.08,0.04\nAfter,,\nWarp,0.1,0.06\nWool,,\nBefore,,\nWarp,0.2,0.1\nAfter,,\nWarp,0.3,0.1\n",
    );
    let names: Vec<&str> = two.iter().map(|v| v.0.as_str()).collect();
    assert_eq!(names, ["Cotton After", "Cotton Before", "Wool After", "Wool Before"]);
    let tests = of("Cotton,,\nBending,,\nWarp,0.08,0.04\nWool,,\nBending,,\nWarp,0.1,0.06\n");
    assert_eq!(tests, [v("Cotton", WARP, 0.08), v("Wool", WARP, 0.1)]);
    let second =
        read("Fabric,B warp (gf·cm²/cm)\nCotton,0.08\nWool,0.1\nAfter washing,\nCotton,0.12\nWool,0.14\n");
    let names: Vec<String> = values(&second).into_iter().map(|v| v.0).collect();
    assert_eq!(names, ["After washing Cotton", "After washing Wool", "Cotton", "Wool"]);
    let deviations = read("Fabric,EMT warp (%)\nCotton,5.2\nWool,4.2\nCV (%),\nCotton,5.5\nWool,4.1\n");
    assert_eq!(values(&deviations).iter().map(|v| v.3).collect::<Vec<_>>(), [5.2, 4.2]);
    assert_eq!(told(&deviations, "R110").len(), 1);
    // A word that is not known among the heads of specimens costs nothing but its column.
    let heads = read(
        "Parameter,Warp,,,,Weft,,,\n,1,2,3,AV,1,2,3,AV\nB (gf·cm²/cm),0.08,0.082,0.087,0.083,0.05,0.051,0.058,0.053\n",
    );
    let found: Vec<_> = values(&heads).into_iter().map(|(.., direction, mean)| (direction, mean)).collect();
    assert_eq!(found, [(WARP, 0.083), (WEFT, 0.053)]);
    assert!(heads.results.iter().all(|(_, v)| v.n == 3));
    for key in ["1 - weft, 2 - warp", "weft = 1, warp = 2", "Direction: 1 = weft; 2 = warp"] {
        let found = values(&read(&format!("\"{key}\"\nFabric,B-1,B-2\nF1,0.0533,0.0812\n")));
        assert_eq!(found[0], ("F1".into(), Parameter::B, WARP, 0.0812), "{key}");
    }
    // The count of its own table goes before that of a line, which holds for the next table only.
    let counted = read(
        "Table 1, n = 3\nFabric,B warp (gf·cm²/cm)\nF1,0.08\n\nTable 2\nFabric,n,G warp (gf/(cm·deg))\nF1,10,0.5\n",
    );
    let n: Vec<usize> = counted.results.iter().map(|(_, v)| v.n).collect();
    assert_eq!(n, [3, 10]);
}

/// A row without a direction is a value of the fabric, also under a column that is called `mean`; a mean beside the values of warp and
/// weft sums them up.
#[test]
fn a_row_without_a_direction_is_no_mean_of_the_others() {
    let own =
        read("parameter,direction,mean,sd,n,unit\nB,warp,0.10,0.01,5,gf·cm²/cm\nB,,0.05,0.005,5,gf·cm²/cm\n");
    let none = String::new;
    assert_eq!(values(&own), [(none(), Parameter::B, None, 0.05), (none(), Parameter::B, WARP, 0.1)]);
    assert_eq!((told(&own, "R110").len(), told(&own, "R136").len()), (0, 1), "{:?}", own.findings);
    let beside = read("parameter,unit,warp,weft,mean\nB,gf·cm²/cm,0.10,0.05,0.075\n");
    assert_eq!(values(&beside), [(none(), Parameter::B, WARP, 0.1), (none(), Parameter::B, WEFT, 0.05)]);
    assert_eq!(told(&beside, "R110").len(), 1, "{:?}", beside.findings);
}
