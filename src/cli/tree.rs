//! The results tree: where each file of a fabric or case goes, and what is in it.

use std::path::Path;

use serde_json::json;

use super::bending;
use super::diagnostics::Failure;
use super::entry::{comparison, solution};
use super::inputs::is_stdin;
use super::sampled;
use super::task::{Task, TaskArgs, Tested};
use crate::characterise::FabricSheet;
use crate::constitutive::Constitutive;
use crate::fields::{Resultants, warp_directions};
use crate::instrument::{Origin, Parameter, Test};
use crate::law::Mode;
use crate::quantity::Curve;
use crate::report::OutputFolder;
use crate::report::chart::{self, ChartError, FieldPlot, SimulatedCurve};
use crate::report::json::{assumptions, section_document, sheet_document, text};
use crate::report::table::{csv, history_rows};
use crate::report::vtu::{MeshField, vtu};
use crate::study::bending::BendingResult;
use crate::study::{CaseResult, StudyError};

/// A folder of results that several threads may write to.
pub struct Tree {
    folder: OutputFolder,
    charts: bool,
}

impl Tree {
    /// Opens the folder before the long work.
    pub fn open(root: &Path, options: &TaskArgs) -> Result<Self, Failure> {
        if is_stdin(root) {
            return Err(Failure::new("O050", "several files do not go to standard output")
                .hint("name a folder, such as `-o out`; `--json` prints one document"));
        }
        Ok(Self { folder: OutputFolder::open(root, options.force)?, charts: !options.no_charts })
    }

    /// Writes one file.
    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<(), Failure> {
        Ok(self.folder.write(name, bytes)?)
    }

    /// Whether a file was written.
    pub fn wrote(&self, name: &str) -> bool {
        self.folder.wrote(name)
    }

    /// Whether charts are wanted.
    pub fn charts(&self) -> bool {
        self.charts
    }

    /// Notes which files are ours.
    ///
    /// Returns the files of earlier runs that are still there.
    pub fn finish(self) -> Result<Vec<String>, Failure> {
        Ok(self.folder.finish()?)
    }

    /// `<fabric>/sheet.json`.
    pub fn sheet(&self, sheet: &FabricSheet) -> Result<(), Failure> {
        self.write(&format!("{}/sheet.json", sheet.name), text(&sheet_document([sheet], None))?.as_bytes())
    }

    /// `<fabric>/section.json`.
    pub fn section(&self, sheet: &FabricSheet, c: &Constitutive) -> Result<(), Failure> {
        let document = section_document([(sheet, &c.section, &c.inputs[..], assumptions(&c.used))]);
        self.write(&format!("{}/section.json", sheet.name), text(&document)?.as_bytes())
    }

    /// `<fabric>/<case>.json`, `.vtu` and `.png` of a solved case, and `.csv` of what it has of a history.
    pub fn solved(&self, task: &Task, result: &CaseResult) -> Result<(), Failure> {
        let stem = task.stem();
        let document = json!({"schema": "kesf.solution/1", "solutions": [solution(task, result, false)]});
        self.write(&format!("{stem}.json"), text(&document)?.as_bytes())?;
        let history = history_rows(result);
        if !history.is_empty() {
            self.write(&format!("{stem}.csv"), &csv(&history)?)?;
        }
        let mesh = Mesh::of(result);
        self.write(&format!("{stem}.vtu"), &mesh.vtu(result)?)?;
        if self.charts {
            self.chart(&format!("{stem}.png"), chart::field(&mesh.plot(task, result)))?;
        }
        Ok(())
    }

    /// `<fabric>/<case>.json` and `.png` of a simulated test.
    pub fn tested(&self, task: &Task, tested: &[Tested]) -> Result<(), Failure> {
        let stem = task.stem();
        let entries: Vec<_> = tested.iter().map(|t| comparison(task, t)).collect();
        let document = json!({"schema": "kesf.comparison/1", "comparisons": entries});
        self.write(&format!("{stem}.json"), text(&document)?.as_bytes())?;
        let (Some(sheet), Some(first), true) = (task.fabric, tested.first(), self.charts) else {
            return Ok(());
        };
        let test = first.simulated.test;
        self.chart(&format!("{stem}.png"), draw(sheet, test, &curves(Some(task), tested.iter(), test)))?;
        Ok(())
    }

    /// `<fabric>/<case>.json` and `.png` of a bending test; a FAB test has one chart a direction,
    /// `<fabric>/<case>_<direction>.png`. The names of the charts that there are.
    pub fn bent(&self, task: &Task, result: &BendingResult) -> Result<Vec<String>, Failure> {
        let stem = task.stem();
        let document = json!({"schema": "kesf.comparison/1", "comparisons": bending::entries(task, result)});
        self.write(&format!("{stem}.json"), text(&document)?.as_bytes())?;
        let mut drawn = Vec::new();
        if self.charts {
            for (suffix, picture) in bending::charts(task, result) {
                let name = format!("{stem}{suffix}.png");
                if self.chart(&name, picture)? {
                    drawn.push(name);
                }
            }
        }
        Ok(drawn)
    }

    /// `<fabric>/tensile.png` ..., with the simulated curves of its cases on top; the tests that have one.
    pub fn fabric_charts(&self, sheet: &FabricSheet, tested: &[Tested]) -> Result<Vec<Test>, Failure> {
        let mut drawn = Vec::new();
        for test in Test::ALL {
            // Cycles with friction have charts of their own.
            let lines = tested.iter().filter(|t| t.simulated.cycle.is_none());
            let picture = draw(sheet, test, &curves(None, lines, test));
            if self.chart(&format!("{}/{}.png", sheet.name, test.name()), picture)? {
                drawn.push(test);
            }
        }
        Ok(drawn)
    }

    /// `<fabric>/friction_bending.png` ...: laws beside the loops behind them; the names of those drawn.
    pub fn friction_charts(&self, sheet: &FabricSheet) -> Result<Vec<String>, Failure> {
        let mut drawn = Vec::new();
        for test in Test::ALL.map(Some).into_iter().chain([None]) {
            let name = format!("friction_{}", test.map_or("strips", Test::name));
            if self.chart(&format!("{}/{name}.png", sheet.name), chart::friction(sheet, test))? {
                drawn.push(name);
            }
        }
        Ok(drawn)
    }

    /// Writes a chart and says whether there is one; without data it is simply not there.
    pub fn chart(&self, name: &str, picture: Result<Vec<u8>, ChartError>) -> Result<bool, Failure> {
        match picture {
            Err(ChartError::NothingToDraw { .. }) => Ok(false),
            other => self.write(name, &other?).map(|()| true),
        }
    }
}

fn draw(sheet: &FabricSheet, test: Test, simulated: &[SimulatedCurve]) -> Result<Vec<u8>, ChartError> {
    match test {
        Test::Tensile => chart::tensile(sheet, simulated),
        Test::Shear => chart::shear(sheet, simulated),
        Test::Bending => chart::bending(sheet, simulated),
        Test::Compression => chart::compression(sheet, simulated),
    }
}

/// With the bands of the parameters of a cycle, where its task is named.
fn curves<'a>(
    task: Option<&Task>,
    tested: impl Iterator<Item = &'a Tested>,
    test: Test,
) -> Vec<SimulatedCurve> {
    tested
        .filter(|t| t.simulated.test == test && !t.curve.is_empty())
        .map(|t| SimulatedCurve {
            label: match t.simulated.cycle.as_ref().map(|c| c.mode) {
                None => "simulated",
                Some(Mode::Virgin) => "first loading with friction",
                Some(_) => "with friction",
            }
            .into(),
            direction: t.simulated.direction,
            curve: t.curve.clone(),
            rmse: t.comparison.as_ref().map(|c| c.rmse),
            nrmse: t.comparison.as_ref().map(|c| c.nrmse),
            r2: t.comparison.as_ref().map(|c| c.r2).filter(|r| r.is_finite()),
            band: band(t),
            bands: task.map_or_else(Vec::new, |task| sampled_values(task, t)),
            repeats: t.simulated.repeats(),
        })
        .collect()
}

/// The bands of the parameters of a cycle for the mean fabric, in KES units.
fn sampled_values(task: &Task, t: &Tested) -> Vec<(String, String)> {
    let Some((cycle, sampling)) = t.simulated.cycle.as_ref().zip(task.sampling()) else { return Vec::new() };
    let of = |p: &Parameter| {
        let band = sampling.of(&format!("{p} {}", cycle.direction))?.mean_fabric;
        band.map(|_| (p.to_string(), sampled::interval(band, p.kes_factor())))
    };
    cycle.values.keys().filter_map(of).collect()
}

/// Both edges of the band of a simulated curve, where it has one at every point.
fn band(t: &Tested) -> Option<[Curve; 2]> {
    let edge = |sign: f64| {
        let at = |(x, y): (f64, f64)| Some((x, y + sign * t.simulated.band(x)?.half_width));
        Some(Curve::from_points(t.curve.points().map(at).collect::<Option<Vec<_>>>()?))
    };
    Some([edge(-1.0)?, edge(1.0)?])
}

/// Name, components and values of a field.
type Field<'a> = (&'a str, usize, Vec<f64>);

/// Resultants as fields of nodes or cells, in material axes.
fn resultants(all: &[Resultants]) -> [Field<'static>; 3] {
    [
        ("membrane_force", 3, all.iter().flat_map(|n| n.membrane).collect()),
        ("moment", 3, all.iter().flat_map(|n| n.moment).collect()),
        ("shear_force", 2, all.iter().flat_map(|n| n.shear).collect()),
    ]
}

fn mesh_fields<'a>(fields: &'a [Field<'a>]) -> Vec<MeshField<'a>> {
    fields
        .iter()
        .map(|(name, components, values)| MeshField { name, components: *components, values })
        .collect()
}

/// The mesh and the deflection of a result, as the files want them.
struct Mesh {
    nodes: Vec<[f64; 3]>,
    quads: Vec<[u32; 4]>,
    w: Vec<f64>,
}

impl Mesh {
    fn of(result: &CaseResult) -> Self {
        let mesh = &result.model.mesh;
        Self {
            nodes: mesh.nodes.iter().map(|p| [p.x, p.y, p.z]).collect(),
            quads: mesh.quads.clone(),
            w: result.solution.displacement.iter().skip(2).step_by(6).copied().collect(),
        }
    }

    fn vtu(&self, result: &CaseResult) -> Result<Vec<u8>, Failure> {
        let six = |values: &[f64], from: usize| -> Vec<f64> {
            values.chunks_exact(6).flat_map(|v| [v[from], v[from + 1], v[from + 2]]).collect()
        };
        let u = &result.solution.displacement;
        let reaction = &result.solution.reaction;
        let modes: Vec<(String, Vec<f64>)> =
            result.modes.iter().enumerate().map(|(k, m)| (format!("mode_{}", k + 1), six(m, 0))).collect();
        let nodal = result.nodal().map_err(StudyError::from)?;
        let mut fields = vec![("displacement", 3, six(u, 0)), ("rotation", 3, six(u, 3))];
        if result.has_reactions() {
            fields
                .extend([("reaction_force", 3, six(reaction, 0)), ("reaction_moment", 3, six(reaction, 3))]);
        }
        fields.extend(resultants(nodal));
        fields.extend(modes.iter().map(|(name, shape)| (name.as_str(), 3, shape.clone())));
        let warp = warp_directions(&result.model).iter().flat_map(|d| [d.x, d.y, d.z]).collect();
        let mut cells = vec![("warp_direction", 3, warp)];
        cells.extend(resultants(&result.element_means().map_err(StudyError::from)?));
        Ok(vtu(&self.nodes, &self.quads, &mesh_fields(&fields), &mesh_fields(&cells))?)
    }

    fn plot(&self, task: &Task, result: &CaseResult) -> FieldPlot<'_> {
        let fabric = task.fabric_name().unwrap_or("section of the case");
        let cells = match result.model.formulation.bending_cells() {
            1 => "one bending cell".into(),
            many => format!("{many} smoothing cells"),
        };
        let origin = task.fabric.map_or("", |f| match f.info.origin {
            Origin::Measured => "measured data",
            Origin::Published => "published data",
            Origin::Synthetic => "synthetic data",
        });
        FieldPlot {
            title: task.case.title.clone(),
            subtitle: format!("{fabric}; {} elements, {cells} each", self.quads.len()),
            origin: origin.into(),
            quantity: "Deflection w".into(),
            unit: "m".into(),
            nodes: &self.nodes,
            quads: &self.quads,
            values: &self.w,
            profile_along: "x, middle line of the mesh".into(),
            profile: result.profile.clone(),
            notes: (sampled::values(task, "w_max", "mm", 1e-3).into_iter())
                .map(|(band, value)| format!("{band}: largest |w| {value}"))
                .chain(result.findings.iter().map(|f| f.message()))
                .collect(),
            ..FieldPlot::default()
        }
    }
}
