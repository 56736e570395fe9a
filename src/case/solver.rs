//! `[solver]`: how the equations are solved.

use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::CaseError;
use super::error::refused;
use crate::finding::Node;
use crate::solve::{Method, Options};

/// `[solver]`: how the equations of a linear analysis are solved; what is left out is chosen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub(super) struct SolverTable {
    /// Factorise or iterate; `auto`.
    #[cfg_attr(test, schemars(extend("default" = "auto")))]
    method: Option<SolverChoice>,
    /// Where an iteration ends: the energy norm of its error over that of the solution, 1e-14 to 1e-4.
    #[cfg_attr(test, schemars(extend("default" = 1e-10)))]
    tolerance: Option<f64>,
    /// Iterations after which it is given up.
    #[cfg_attr(test, schemars(extend("default" = 1000)))]
    max_iterations: Option<usize>,
    /// Size of a factor above which `auto` iterates.
    #[cfg_attr(test, schemars(extend("default" = "8 GB")))]
    factor_limit: Option<Bytes>,
}

/// Method as written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum SolverChoice {
    /// Direct, unless the factor would be too large.
    Auto,
    /// Factorisation.
    Direct,
    /// Preconditioned conjugate gradients.
    Iterative,
}

impl From<SolverChoice> for Method {
    fn from(choice: SolverChoice) -> Self {
        match choice {
            SolverChoice::Auto => Self::Auto,
            SolverChoice::Direct => Self::Direct,
            SolverChoice::Iterative => Self::Iterative,
        }
    }
}

/// A size of memory, such as `"8 GB"` (10⁹ bytes each).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(try_from = "String")]
pub struct Bytes(pub u64);

#[cfg(test)]
impl schemars::JsonSchema for Bytes {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Bytes".into()
    }

    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        schemars::json_schema!({
            "type": "string", "pattern": r"^\s*[0-9.]+\s+(GB|MB)\s*$", "x-unit": "GB", "examples": ["8 GB"],
        })
    }
}

impl FromStr for Bytes {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("`{text}` is not a size of memory: write it as \"8 GB\" or \"500 MB\"");
        let (number, unit) = text.trim().split_once(char::is_whitespace).ok_or_else(wrong)?;
        let factor = match unit.trim() {
            "GB" => 1e9,
            "MB" => 1e6,
            _ => return Err(wrong()),
        };
        let bytes = number.parse::<f64>().map_err(|_| wrong())? * factor;
        // Saturates far beyond any machine.
        if bytes >= 0.0 { Ok(Self(bytes as u64)) } else { Err(wrong()) }
    }
}

impl TryFrom<String> for Bytes {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

/// How the equations are solved, as far as a case or the user says so.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Solver {
    /// Factorise or iterate.
    pub method: Option<SolverChoice>,
    /// Where an iteration ends, 1e-14 to 1e-4.
    pub tolerance: Option<f64>,
    /// Iterations after which it is given up, one at least.
    pub max_iterations: Option<usize>,
    /// Size of a factor above which `auto` iterates.
    pub factor_limit: Option<Bytes>,
}

impl SolverTable {
    /// The solver of the `[solver]` of a case; `can_iterate` tells whether its analysis is linear.
    pub fn checked(self, case: &Node<'_>, can_iterate: bool) -> Result<Solver, CaseError> {
        let Self { method, tolerance, max_iterations, factor_limit } = self;
        let Some(at) = case.get("solver") else { return Ok(Solver::default()) };
        let keys = ["tolerance", "max_iterations", "factor_limit"];
        let of_iteration = keys.into_iter().find(|key| at.has(key));
        let iterates = (method == Some(SolverChoice::Iterative)).then(|| at.value_place("method"));
        if let Some(place) = iterates.or_else(|| of_iteration.map(|key| at.key_place(key)))
            && !can_iterate
        {
            return refused(place, ONLY_LINEAR);
        }
        if let Some(key) = of_iteration.filter(|_| method == Some(SolverChoice::Direct)) {
            return refused(
                at.key_place(key),
                "[solver] tolerance, max_iterations and factor_limit are of an iteration: remove them beside method = \"direct\"",
            );
        }
        if tolerance.is_some_and(|t| !(1e-14..=1e-4).contains(&t)) {
            let message =
                format!("[solver] tolerance = {:e}: take 1e-14 to 1e-4", tolerance.unwrap_or_default());
            return refused(at.value_place("tolerance"), message);
        }
        if max_iterations == Some(0) {
            let message = "[solver] max_iterations = 0: take one iteration at least";
            return refused(at.value_place("max_iterations"), message);
        }
        Ok(Solver { method, tolerance, max_iterations, factor_limit })
    }
}

/// Why an analysis does not iterate.
pub(super) const ONLY_LINEAR: &str = "only a linear analysis can iterate: modes, dynamics and large rotations factorise; \
                                      take method = \"direct\", and remove the other keys of [solver]";

impl Solver {
    /// The same with a method that was chosen elsewhere; what belongs to an iteration goes where it factorises.
    pub fn with_method(self, choice: SolverChoice) -> Self {
        match choice {
            SolverChoice::Direct => Self { method: Some(choice), ..Self::default() },
            SolverChoice::Auto | SolverChoice::Iterative => Self { method: Some(choice), ..self },
        }
    }

    /// `options` with what is said here.
    pub fn options(&self, options: &Options) -> Options {
        let mut options = *options;
        options.method = self.method.map_or(options.method, Method::from);
        options.factor_limit = self.factor_limit.map_or(options.factor_limit, |b| b.0);
        let iteration = &mut options.iteration;
        iteration.tolerance = self.tolerance.unwrap_or(iteration.tolerance);
        iteration.max_iterations = self.max_iterations.unwrap_or(iteration.max_iterations);
        options
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::super::Case;
    use super::*;

    fn case(more: &str) -> Result<Case, CaseError> {
        let text = r#"
title = "t"
fabric = "*"
[sheet]
shape = "rectangle"
width = "20 cm"
height = "20 cm"
cells = [4, 4]
[[supports]]
set = "boundary"
kind = "clamped"
"#;
        Case::parse(Path::new("c.toml"), &format!("{text}{more}"))
    }

    const LOAD: &str = "[[loads]]\nkind = \"pressure\"\nvalue = \"1 Pa\"\n";

    #[test]
    fn what_is_written_replaces_what_is_chosen() {
        let table = "[solver]\nmethod = \"iterative\"\ntolerance = 1e-6\nmax_iterations = 7\nfactor_limit = \"1.5 GB\"";
        let options = |case: &Case| case.options(&Options::default()).unwrap();
        let mut written = case(&format!("{LOAD}{table}")).unwrap();
        let solver = options(&written);
        assert_eq!((solver.method, solver.factor_limit), (Method::Iterative, 1_500_000_000));
        assert_eq!((solver.iteration.tolerance, solver.iteration.max_iterations), (1e-6, 7));
        assert_eq!(options(&case(LOAD).unwrap()), Options::default());
        written.use_solver(SolverChoice::Direct);
        let direct = Options { method: Method::Direct, ..Options::default() };
        assert_eq!(options(&written), direct);
    }

    #[test]
    fn what_has_no_meaning_is_refused_where_it_stands() {
        for table in ["factor_limit = \"8\"", "factor_limit = \"-1 GB\"", "method = \"fast\"", "rounds = 3"] {
            assert_eq!(case(&format!("{LOAD}[solver]\n{table}")).unwrap_err().code(), "S002", "{table}");
        }
        let refused = |more: &str| {
            let error = case(more).unwrap_err();
            (error.code(), error.place().line, error.place().column)
        };
        assert_eq!(refused(&format!("{LOAD}[solver]\ntolerance = 0.5")), ("S003", 16, 13));
        assert_eq!(refused(&format!("{LOAD}[solver]\nmax_iterations = 0")), ("S003", 16, 18));
        let modal = "[analysis]\nkind = \"modal\"\n[solver]\n";
        assert_eq!(refused(&format!("{modal}method = \"iterative\"")), ("S003", 15, 10));
        let nonlinear = "[analysis]\nkind = \"nonlinear\"\n[solver]\nfactor_limit = \"1 GB\"";
        assert_eq!(refused(&format!("{LOAD}{nonlinear}")), ("S003", 18, 1));
        // Asked for by the user, and not by the case.
        let mut modes = case(modal).unwrap();
        modes.use_solver(SolverChoice::Iterative);
        assert_eq!(modes.options(&Options::default()).unwrap_err().code(), "S003");
    }
}
