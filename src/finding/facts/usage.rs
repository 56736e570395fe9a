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
        /// A link among the inputs leads nowhere.
        "O062" DanglingLink {} = "this link leads nowhere, and nothing was read: restore what it leads to, or remove it";
    }
}

fn own_results(files: usize) -> String {
    let what = match files {
        1 => "a file here is a result of this program and was not read as a measurement".into(),
        _ => format!("{files} files here are results of this program and were not read as measurements"),
    };
    format!("{what}: write results elsewhere with -o")
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
