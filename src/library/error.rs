//! What is wrong with a library, or with what it is asked.

use std::path::PathBuf;

use crate::finding::{Place, errors, path_as_text};
use crate::report::number::counted;

errors! {
    /// Why there is no library, or no answer.
    #[derive(Clone, Debug, PartialEq)]
    pub enum LibraryError {
        /// O069: not what a library is made of.
        "O069" Results {
            /// The folder or file.
            #[serde(serialize_with = "path_as_text")]
            path: PathBuf,
            /// What is wrong.
            problem: String,
        } at Place::file(path), = "these are no results that a library can be made of: {problem}"
            => "name a folder of `kesf run` or of its shards, a part, or a table of `kesf merge`";
        /// O069: no fabric in them.
        "O069" Empty = "there is no fabric with KES values in the results"
            => "name folders of results, as in `kesf library build library.parquet results`";
        /// O050: a library is Parquet, whatever its name.
        "O050" Ending {
            /// The file that was asked for.
            #[serde(serialize_with = "path_as_text")]
            path: PathBuf,
        } at Place::file(path), = "a library is a Parquet file, and this name says something else"
            => "end its name in .parquet; `kesf library find ... -o table.csv` writes CSV";
        /// O068: in two of the results.
        "O068" Twice {
            /// The second of them.
            #[serde(serialize_with = "path_as_text")]
            path: PathBuf,
            /// Name of the fabric.
            fabric: String,
            /// The first of them.
            other: String,
        } at Place::file(path), = "{fabric} is in {other} too" => "give each fabric a name of its own";
        /// O070: not as this program writes it.
        "O070" File {
            /// The file.
            #[serde(serialize_with = "path_as_text")]
            path: PathBuf,
            /// What is wrong.
            problem: String,
        } at Place::file(path), = "the library cannot be read: {problem}"
            => "make it with `kesf library build`";
        /// O070: of another version of this program.
        "O070" Layout {
            /// The file.
            #[serde(serialize_with = "path_as_text")]
            path: PathBuf,
        } at Place::file(path), = "another version of kesf made this library, and it does not say the status of its values as this one needs it"
            => "build it again with `kesf library build`";
        /// O071: bounds that are not understood.
        "O071" Bounds {
            /// What was found.
            problem: String,
            /// Column of the text, from 1; 0 where it is not known.
            column: usize,
            /// What could stand there.
            cure: String,
        } = "the bounds cannot be used: {problem}{}; {cure}", at_column(*column);
        /// O072: no such fabric.
        "O072" Unknown {
            /// The name.
            fabric: String,
        } = "there is no fabric `{fabric}` in the library, and no file of that name"
            => "give the name of a fabric of the library, or the path of one";
        /// O072: too little in common.
        "O072" Apart {
            /// How many parameters the fabric and the library share.
            shared: usize,
            /// In how many of these the fabrics of the library differ: others say nothing of likeness.
            differing: usize,
            /// How many are needed.
            needed: usize,
        } = "the fabric and the library share {}, and the fabrics of the library differ in {differing} of these; they must differ in at least {needed}",
            counted(*shared, "parameter")
            => "measure more of it, or give bounds with --where instead";
    }
}

fn at_column(column: usize) -> String {
    if column > 0 { format!(" (at character {column})") } else { String::new() }
}
