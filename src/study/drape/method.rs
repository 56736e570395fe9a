//! The sizes with which a fabric's drape was measured, against those of a case.

use std::borrow::Cow;

use crate::case::{Annulus, Case, DrapeProblem, Problem};
use crate::characterise::FabricSheet;
use crate::finding::{Finding, Place, StudyFact};
use crate::kes::DrapeMethod;
use crate::quantity::Length;

use super::measured_drapes;

/// The drape case as it is hung for a fabric: with `sizes = "measured"` the sheet and the disc are those with which
/// the fabric was measured, where its method states them; and what is to be told of them. Of several measurements the one with the
/// sizes of the case counts, else the first. Another case, and a fabric without a measured coefficient, stay as they are.
pub fn as_measured<'c>(case: &'c Case, sheet: &FabricSheet) -> (Cow<'c, Case>, Vec<Finding>) {
    let Problem::Drape(problem) = &case.problem else { return (Cow::Borrowed(case), Vec::new()) };
    let Annulus { inner_diameter, diameter, .. } = problem.ring;
    let stated: Vec<Option<DrapeMethod>> =
        measured_drapes(sheet, "drape_coefficient").map(|(_, words)| DrapeMethod::in_words(words)).collect();
    let methods = || stated.iter().map(|method| method.unwrap_or_default());
    let differs = |method: &DrapeMethod| method.differs(inner_diameter.si(), diameter.si());
    let Some(method) = methods().find(|method| !differs(method)).or_else(|| methods().next()) else {
        return (Cow::Borrowed(case), Vec::new());
    };
    let (fabric, measured) = (sheet.name.clone(), method.text());
    let finding = |fact: StudyFact| Finding::new(fact).at(Place::file(&case.path));
    let mut findings = Vec::new();
    if method.assumed {
        let (fabric, sizes) = (fabric.clone(), measured.clone());
        findings.push(finding(StudyFact::AssumedDrapeSizes { fabric, sizes }));
    }
    if !differs(&method) {
        return (Cow::Borrowed(case), findings);
    }
    if !problem.sizes_as_measured || !stated.contains(&Some(method)) {
        let hung = DrapeMethod::stated(inner_diameter.si(), diameter.si()).text();
        findings.push(finding(StudyFact::OtherDrapeSizes { fabric, measured, hung }));
        return (Cow::Borrowed(case), findings);
    }
    let mut others: Vec<String> =
        methods().map(|other| other.text()).filter(|other| *other != measured).collect();
    others.dedup();
    if !others.is_empty() {
        findings.push(finding(StudyFact::SeveralDrapeSizes { fabric, hung: measured, others }));
    }
    let ring =
        Annulus { inner_diameter: Length(method.disc), diameter: Length(method.sheet), ..problem.ring };
    let problem = DrapeProblem { ring, ..(**problem).clone() };
    (Cow::Owned(Case { problem: Problem::Drape(Box::new(problem)), ..case.clone() }), findings)
}

#[cfg(test)]
mod tests {
    use super::super::measured_drape;
    use super::*;
    use crate::characterise::{Settings, characterise};
    use crate::instrument::{FabricInput, MeasuredResult};

    fn sheet(measured: &[(&str, &str)]) -> FabricSheet {
        let result = |(value, method): &(&str, &str)| MeasuredResult {
            quantity: "drape_coefficient".into(),
            value: (*value).into(),
            method: (*method).into(),
            direction: None,
        };
        let mut input = FabricInput { name: "a".into(), ..FabricInput::default() };
        input.info.results = measured.iter().map(result).collect();
        characterise(&input, &Settings::default())
    }

    /// Diameters (cm) and what is told, of a case of 30 cm on 18 cm.
    fn hung(sizes: &str, measured: &[(&str, &str)]) -> ([f64; 2], Vec<String>) {
        let text = format!(
            "title = \"drape\"\nfabric = \"*\"\n[sheet]\nshape = \"annulus\"\ninner_diameter = \"18 cm\"\ndiameter = \"30 cm\"\ncells = [14, 90]\n\
             [[supports]]\nset = \"inner\"\nkind = \"clamped\"\n[[loads]]\nkind = \"gravity\"\n[analysis]\nkind = \"drape\"\n{sizes}\n"
        );
        let case = Case::parse(std::path::Path::new("drape.toml"), &text).unwrap();
        let (case, findings) = as_measured(&case, &sheet(measured));
        let Problem::Drape(problem) = &case.problem else { panic!("a drape") };
        let sizes =
            [problem.ring.inner_diameter.si(), problem.ring.diameter.si()].map(|d| (1e4 * d).round() / 1e2);
        (sizes, findings.iter().map(|finding| finding.code().to_string()).collect())
    }

    const MEASURED: &str = "sizes = \"measured\"";

    #[test]
    fn a_sheet_is_hung_as_it_was_measured_where_that_is_stated() {
        let own = [18.0, 30.0];
        assert_eq!(hung(MEASURED, &[]), (own, Vec::new()));
        assert_eq!(hung(MEASURED, &[("60 %", "24 cm on 18 cm")]), ([18.0, 24.0], Vec::new()));
        assert_eq!(hung("", &[("60 %", "24 cm on 18 cm")]), (own, vec!["S126".to_string()]));
        assert_eq!(hung(MEASURED, &[("60 %", "as published")]), (own, vec!["S125".to_string()]));
        assert_eq!(hung(MEASURED, &[("60 %", "JIS L 1096")]), ([12.7, 25.4], Vec::new()));
    }

    #[test]
    fn of_several_coefficients_that_of_the_sizes_counts() {
        let three = [("60 %", "24 cm"), ("40 %", "30 cm"), ("20 %", "36 cm")];
        assert_eq!(hung(MEASURED, &three), ([18.0, 30.0], Vec::new()));
        let two = [three[0], three[2]];
        assert_eq!(hung(MEASURED, &two), ([18.0, 24.0], vec!["S165".to_string()]));
        let measured =
            |diameter| measured_drape(&sheet(&three), "drape_coefficient", [0.18, diameter]).map(|(c, _)| c);
        assert_eq!([0.24, 0.30, 0.36, 0.254].map(measured), [Some(0.6), Some(0.4), Some(0.2), None]);
        let cannot_be = sheet(&[("114.95 %", "30 cm"), ("-5 %", "30 cm")]);
        assert_eq!(measured_drape(&cannot_be, "drape_coefficient", [0.18, 0.30]), None);
    }
}
