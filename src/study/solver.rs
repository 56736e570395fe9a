//! `[solver]` of a case file.

use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::StudyError;
use super::case::{Analysis, Case, TestFormulation};
use crate::solve::{Method, Options};

/// `[solver]`: how the equations of a linear analysis are solved; what is left out is chosen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SolverTable {
    /// Factorise or iterate; `auto`.
    pub method: Option<SolverChoice>,
    /// Where an iteration ends: the energy norm of its error over that of the solution; 1e-10.
    pub tolerance: Option<f64>,
    /// Iterations after which it is given up; 1000.
    pub max_iterations: Option<usize>,
    /// Size of a factor above which `auto` iterates; `"8 GB"`.
    pub factor_limit: Option<Bytes>,
}

/// Method as written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
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

/// `options` with what the case says.
///
/// # Errors
/// S003 for an iteration where the analysis factorises, or settings of one that cannot end.
pub fn options(case: &Case, options: &Options) -> Result<Options, StudyError> {
    let SolverTable { method, tolerance, max_iterations, factor_limit } = case.solver;
    let nonlinear_test =
        case.virtual_test.as_ref().is_some_and(|t| t.formulation == TestFormulation::Nonlinear);
    let direct_only = nonlinear_test || !matches!(case.analysis, Analysis::Linear {});
    let iterates = [tolerance.is_some(), max_iterations.is_some(), factor_limit.is_some()].contains(&true);
    if direct_only && (iterates || method == Some(SolverChoice::Iterative)) {
        return Err(case.inconsistent(
            "only a linear analysis can iterate: modes, dynamics and large rotations factorise; take method = \"direct\", \
             and remove the other keys of [solver]"
                .into(),
        ));
    }
    if iterates && method == Some(SolverChoice::Direct) {
        return Err(case.inconsistent(
            "[solver] tolerance, max_iterations and factor_limit are of an iteration: remove them beside method = \"direct\""
                .into(),
        ));
    }
    let mut options = *options;
    options.method = method.map_or(options.method, Method::from);
    options.factor_limit = factor_limit.map_or(options.factor_limit, |b| b.0);
    let iteration = &mut options.iteration;
    iteration.tolerance = tolerance.unwrap_or(iteration.tolerance);
    iteration.max_iterations = max_iterations.unwrap_or(iteration.max_iterations);
    if !(1e-14..=1e-4).contains(&iteration.tolerance) || iteration.max_iterations == 0 {
        return Err(case.inconsistent(format!(
            "[solver] tolerance = {:e}, max_iterations = {}: take 1e-14 to 1e-4, and one iteration at least",
            iteration.tolerance, iteration.max_iterations
        )));
    }
    Ok(options)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    fn case(more: &str) -> Result<Case, super::super::CaseError> {
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
        let solver = options(&case(&format!("{LOAD}{table}")).unwrap(), &Options::default()).unwrap();
        assert_eq!((solver.method, solver.factor_limit), (Method::Iterative, 1_500_000_000));
        assert_eq!((solver.iteration.tolerance, solver.iteration.max_iterations), (1e-6, 7));
        assert_eq!(options(&case(LOAD).unwrap(), &Options::default()).unwrap(), Options::default());
    }

    #[test]
    fn what_has_no_meaning_is_refused() {
        for table in ["factor_limit = \"8\"", "factor_limit = \"-1 GB\"", "method = \"fast\"", "rounds = 3"] {
            assert_eq!(case(&format!("{LOAD}[solver]\n{table}")).unwrap_err().code(), "S002", "{table}");
        }
        let refused = |more: &str| options(&case(more).unwrap(), &Options::default()).unwrap_err().code();
        assert_eq!(refused(&format!("{LOAD}[solver]\ntolerance = 0.5")), "S003");
        assert_eq!(refused(&format!("{LOAD}[solver]\nmax_iterations = 0")), "S003");
        assert_eq!(refused("[analysis]\nkind = \"modal\"\n[solver]\nmethod = \"iterative\""), "S003");
        let nonlinear = "[analysis]\nkind = \"nonlinear\"\n[solver]\nfactor_limit = \"1 GB\"";
        assert_eq!(refused(&format!("{LOAD}{nonlinear}")), "S003");
    }
}
