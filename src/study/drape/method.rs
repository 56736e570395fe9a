//! The sizes with which a fabric's drape was measured, against those of a case.

use std::borrow::Cow;

use crate::case::{Annulus, Case, DrapeProblem, Problem};
use crate::characterise::FabricSheet;
use crate::finding::{Finding, Place, StudyFact};
use crate::kes::DrapeMethod;
use crate::quantity::Length;

use super::measured_drape;

/// The sizes that the method of a fabric's measured drape coefficient states; none where none was measured.
pub fn drape_method(sheet: &FabricSheet) -> Option<DrapeMethod> {
    measured_drape(sheet).map(|(_, method)| DrapeMethod::read(method))
}

/// The drape case as it is hung for a fabric: with `sizes = "measured"` the sheet and the disc are those with which
/// the fabric was measured; and what is to be told of them. Another case, and a fabric without a measured
/// coefficient, stay as they are.
pub fn as_measured<'c>(case: &'c Case, sheet: &FabricSheet) -> (Cow<'c, Case>, Vec<Finding>) {
    let (Problem::Drape(problem), Some(method)) = (&case.problem, drape_method(sheet)) else {
        return (Cow::Borrowed(case), Vec::new());
    };
    let finding = |fact: StudyFact| Finding::new(fact).at(Place::file(&case.path));
    let mut findings = Vec::new();
    if method.assumed {
        findings
            .push(finding(StudyFact::AssumedDrapeSizes { fabric: sheet.name.clone(), sizes: method.text() }));
    }
    let Annulus { inner_diameter, diameter, .. } = problem.ring;
    if !method.differs(inner_diameter.si(), diameter.si()) {
        return (Cow::Borrowed(case), findings);
    }
    if !problem.sizes_as_measured {
        let hung = DrapeMethod::stated(inner_diameter.si(), diameter.si()).text();
        findings.push(finding(StudyFact::OtherDrapeSizes {
            fabric: sheet.name.clone(),
            measured: method.text(),
            hung,
        }));
        return (Cow::Borrowed(case), findings);
    }
    let ring =
        Annulus { inner_diameter: Length(method.disc), diameter: Length(method.sheet), ..problem.ring };
    let problem = DrapeProblem { ring, ..(**problem).clone() };
    (Cow::Owned(Case { problem: Problem::Drape(Box::new(problem)), ..case.clone() }), findings)
}
