//! Facts of the task as it was given.

use super::parts::Renaming;

super::facts! {
    /// What a reader of the results must know of the task.
    UsageFact {
        /// A case or a fabric has another name than it was given.
        "O056" Renamed {
            /// The name that was given.
            name: String,
            /// The name in the results.
            renamed: String,
            /// Why.
            because: Renaming,
        } = "{}", renamed_because(name, renamed, *because);
        /// The fabric of a case is there twice.
        "O060" FabricTwice {
            /// The name of the fabric.
            fabric: String,
            /// The one that is taken.
            taken: String,
            /// The other one.
            other: String,
        } = "`{fabric}` is here and beside the case; this one is taken: {taken}, not {other}";
        /// Results of this program among the inputs.
        "O061" OwnResults {
            /// How many files.
            files: usize,
        } = "{}", own_results(*files);
        /// Several inputs name the same files.
        "O075" ReadOnce {
            /// How many files.
            files: usize,
        } = "{}", read_once(*files);
        /// Files that hold numbers and were not read, as they do not end as measurements do.
        "O080" PassedBy {
            /// How many files.
            files: usize,
            /// Their endings; `none` of those without.
            endings: Vec<String>,
            /// Names of the first.
            first: Vec<String>,
        } = "{}", passed_by(*files, endings, first);
        /// A folder that looks like that of a fabric has no measurement.
        "O081" NoMeasurement {
            /// How many other files it has.
            files: usize,
            /// Their endings; `none` of those without.
            endings: Vec<String>,
            /// How many files are hidden.
            hidden: usize,
        } = "no measurement file is in this folder, and it gives no fabric ({}): add the measurements, or take it out of the inputs",
            what_else(*files, endings, *hidden);
    }
}

fn own_results(files: usize) -> String {
    let what = match files {
        1 => "a file here is a result of this program and was not read as a measurement".into(),
        _ => format!("{files} files here are results of this program and were not read as measurements"),
    };
    format!("{what}: write results elsewhere with -o")
}

fn passed_by(files: usize, endings: &[String], first: &[String]) -> String {
    let named: Vec<String> = first.iter().map(|name| format!("{name:?}")).collect();
    let more = files.saturating_sub(first.len());
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    let (what, do_not) = match files {
        1 => ("a file that holds numbers was not read".to_string(), "it does not end"),
        _ => (format!("{files} files that hold numbers were not read"), "they do not end"),
    };
    format!(
        "{what}, as {do_not} as measurements do ({}): {}{more}; rename what is a measurement to .csv or .txt, or name it one by one",
        endings.join(", "),
        named.join(", ")
    )
}

fn what_else(files: usize, endings: &[String], hidden: usize) -> String {
    let others = match files {
        1 => format!("a file of another kind: {}", endings.join(", ")),
        _ => format!("{files} files of other kinds: {}", endings.join(", ")),
    };
    let hidden_ones =
        if hidden == 1 { "a hidden file".to_string() } else { format!("{hidden} hidden files") };
    match (files, hidden) {
        (0, 0) => "it is empty".into(),
        (0, _) => hidden_ones,
        (_, 0) => others,
        _ => format!("{others}; {hidden_ones}"),
    }
}

fn read_once(files: usize) -> String {
    let what = if files == 1 { "a file here is".into() } else { format!("{files} files here are") };
    format!("{what} named by another input too: what is named twice is read once")
}

fn renamed_because(name: &str, renamed: &str, because: Renaming) -> String {
    match because {
        Renaming::CaseFile => format!("{name:?} cannot be the name of a file; this case is called {renamed}"),
        Renaming::CaseReserved => {
            format!("a file of every fabric is named {name} too; this case is called {renamed}")
        }
        Renaming::CaseTwice => format!("another case is named {name} too; this case is called {renamed}"),
        Renaming::FabricFolder => {
            format!("{name:?} cannot be the name of a folder; this fabric is called {renamed}")
        }
        Renaming::FabricTwice => format!("another fabric is named {name} too; this one is called {renamed}"),
    }
}
