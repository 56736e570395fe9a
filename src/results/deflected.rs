//! Deflected sheets: their glTF files, and what the page shows of them.

use super::failure::Failure;
use super::folder::Folder;
use super::task::Task;
use crate::fields::{Resultants, largest_principal};
use crate::model::Model;
use crate::report::gltf::{DeflectedSheet, glb};
use crate::report::html::{DeflectedShape, ShapeField};

/// A sheet before and after, of an outcome.
pub(super) struct Deflected {
    name: String,
    about: String,
    file: String,
    rest: Vec<[f64; 3]>,
    displacement: Vec<[f64; 3]>,
    quads: Vec<[u32; 4]>,
    outline: Vec<[u32; 2]>,
}

/// A sheet as the page has it.
pub(super) enum PageSheet {
    /// It turns.
    Shown(Box<DeflectedShape>),
    /// It is in its file alone.
    TooLarge,
}

impl Deflected {
    /// Of a task, the nodes of whose model have moved.
    pub fn new(task: &Task, model: &Model, displacement: Vec<[f64; 3]>) -> Self {
        let mesh = &model.mesh;
        let said = [task.fabric_name().unwrap_or_default().to_string(), task.simulated_from()];
        Self {
            name: task.case.title.clone(),
            about: said.into_iter().filter(|text| !text.is_empty()).collect::<Vec<_>>().join("; "),
            file: format!("{}.glb", task.stem()),
            rest: mesh.nodes.iter().map(|p| [p.x, p.y, p.z]).collect(),
            displacement,
            quads: mesh.quads.clone(),
            outline: mesh.boundary_edges(),
        }
    }

    /// The same under another name than that of its case.
    pub fn named(self, name: String) -> Self {
        Self { name, ..self }
    }

    fn sheet(&self) -> DeflectedSheet<'_> {
        DeflectedSheet {
            name: self.name.clone(),
            about: self.about.clone(),
            rest: &self.rest,
            displacement: &self.displacement,
            quads: &self.quads,
            outline: &self.outline,
        }
    }

    /// Writes `<stem>.glb`.
    pub fn write(&self, folder: &Folder) -> Result<(), Failure> {
        folder.write(&self.file, &glb(&self.sheet())?)
    }

    /// What the page shows; the resultants and the curvatures are those of its elements.
    pub fn shape(
        &self,
        is_drape: bool,
        resultants: &[Resultants],
        curvatures: &[[f64; 3]],
    ) -> Result<PageSheet, Failure> {
        let Some(shape) = DeflectedShape::of(&self.sheet(), self.file.clone())? else {
            return Ok(PageSheet::TooLarge);
        };
        let curvatures: Vec<f64> =
            curvatures.iter().map(|[x, y, xy]| largest_principal([*x, *y, 0.5 * xy])).collect();
        let moments: Vec<f64> = resultants.iter().map(|all| largest_principal(all.moment)).collect();
        let fields = vec![
            ShapeField::new("largest principal curvature", "1/m", &curvatures),
            ShapeField::new("largest principal moment", "N", &moments),
        ];
        Ok(PageSheet::Shown(Box::new(DeflectedShape { is_drape, fields, ..shape })))
    }
}
