//! The problems that a case can be.

use nalgebra::Vector3;

use super::analysis::Analysis;
use super::bending_test::{BendingTest, FabBendLoop};
use super::check::{Check, ProbePoint};
use super::loads::SheetLoad;
use super::material::{FabricMaterial, Material, SectionTable};
use super::obstacles::SheetObstacle;
use super::sheet::{Annulus, Layout, Outline, Sheet};
use super::solver::Solver;
use super::supports::{RigidSet, SheetSupport};
use super::virtual_test::VirtualTest;
use crate::element::Formulation;
use crate::finding::Located;

/// What is solved.
#[derive(Clone, Debug)]
pub enum Problem {
    /// A sheet between supports and under loads.
    Sheet(Box<SheetProblem>),
    /// A test of a KES instrument.
    InstrumentTest(InstrumentTest),
    /// A bending test of another instrument.
    BendingTest(BendingTest),
    /// A sheet that hangs over a disc.
    Drape(Box<DrapeProblem>),
}

/// A sheet between supports and under loads.
#[derive(Clone, Debug)]
pub struct SheetProblem {
    /// What the sheet is made of.
    pub material: Material,
    /// The sheet and its mesh.
    pub sheet: Sheet,
    /// How it is held.
    pub mounting: Mounting,
    /// What it cannot pass; nothing but in statics in large rotations.
    pub obstacles: Vec<SheetObstacle>,
    /// What is computed, and under which loads.
    pub analysis: Analysis,
    /// How the equations are solved.
    pub solver: Solver,
    /// Points whose values are reported.
    pub probes: Vec<ProbePoint>,
    /// Values that must come out.
    pub checks: Vec<Check>,
}

/// The elements of a sheet and what holds them.
#[derive(Clone, Debug)]
pub struct Mounting {
    /// The formulation of the elements.
    pub formulation: Formulation,
    /// Whether a mesh with triangles has the membrane along arcs ([`Membrane::AssumedStress`](crate::element::Membrane)): in
    /// large rotations, where the case says nothing of the membrane.
    pub arcs_of_triangles: bool,
    /// Where the sheet is held, one at least.
    pub supports: Vec<SheetSupport>,
    /// What moves as one rigid body.
    pub bodies: Vec<RigidSet>,
}

/// A test of a KES instrument.
#[derive(Clone, Debug)]
pub enum InstrumentTest {
    /// Compression: a closed form with two measured numbers of a fabric.
    Compression(FabricMaterial),
    /// A test of a specimen as a shell.
    Shell(ShellSpecimen),
}

/// A specimen between the clamps of a KES instrument.
#[derive(Clone, Debug)]
pub struct ShellSpecimen {
    /// What it is made of.
    pub material: Material,
    /// The formulation of its elements.
    pub formulation: Formulation,
    /// How the clamps move.
    pub test: VirtualTest,
    /// How the equations are solved.
    pub solver: Solver,
}

/// Cells along the radius that a search for drapes needs at the start.
const CELLS_OF_THE_RADIUS: usize = 6;

/// A round sheet that hangs over a disc, clamped at its edge, under its own weight.
#[derive(Clone, Debug)]
pub struct DrapeProblem {
    /// What the sheet is made of.
    pub material: Material,
    /// The ring between the disc and the rim of the sheet.
    pub ring: Annulus,
    /// Warp and distortion of the sheet.
    pub layout: Layout,
    /// Position of the `[sheet]` in the case file.
    pub table: Located<()>,
    /// The elements, and how the ring is held at the disc.
    pub mounting: Mounting,
    /// Accelerations of the weight (m/s²), all of them straight down; one at least.
    pub gravity: Vec<Vector3<f64>>,
    /// Folds that the sheet is given at the start, one search for each; one at least.
    pub folds: Vec<usize>,
    /// How often the cells are halved for the state of lowest energy.
    pub refinements: usize,
    /// Whether a run hangs it by itself, for a first look: on the widest cells that it can have, and refined once at most.
    pub is_quick: bool,
    /// Whether the sizes of disc and sheet are those with which the fabric's drape was measured, where they are known.
    pub sizes_as_measured: bool,
    /// The largest change of the weight over itself when a sheet with friction is shaken, 0 to 1.
    pub shaking: f64,
    /// How the equations are solved.
    pub solver: Solver,
}

impl DrapeProblem {
    /// Cells of twice the width, along the radius and around, where a search can begin on such.
    pub fn wider(cells: [usize; 2]) -> Option<[usize; 2]> {
        let is_even = cells.iter().all(|n| n % 2 == 0);
        (is_even && cells[0] / 2 >= CELLS_OF_THE_RADIUS).then(|| cells.map(|n| n / 2))
    }

    /// Searches on the widest cells alone, and halves those of the state of lowest energy once; where the cells stay, no more
    /// often than the case says.
    pub(super) fn make_quick(&mut self) {
        let before = self.ring.cells;
        while let Some(wider) = Self::wider(self.ring.cells) {
            self.ring.cells = wider;
        }
        self.refinements = if self.ring.cells == before { self.refinements.min(1) } else { 1 };
        self.is_quick = true;
    }

    /// The ring as a sheet.
    pub fn sheet(&self) -> Sheet {
        Sheet { outline: Outline::Annulus(self.ring), layout: self.layout, table: self.table }
    }

    /// The weight as loads.
    pub fn loads(&self) -> Vec<SheetLoad> {
        self.gravity.iter().map(|g| SheetLoad::Gravity(*g)).collect()
    }
}

impl Problem {
    /// The fabric; none for a problem with constants of its own.
    pub fn fabric(&self) -> Option<&FabricMaterial> {
        match self {
            Self::InstrumentTest(InstrumentTest::Compression(fabric))
            | Self::BendingTest(BendingTest::FabBendLoop(FabBendLoop { fabric, .. })) => Some(fabric),
            other => other.material().and_then(Material::fabric),
        }
    }

    /// The constants, if it has its own.
    pub fn section(&self) -> Option<&Located<SectionTable>> {
        self.material().and_then(Material::section)
    }

    /// What the sheet is made of; none for tests that have a meaning for measured fabrics only.
    fn material(&self) -> Option<&Material> {
        match self {
            Self::Sheet(problem) => Some(&problem.material),
            Self::Drape(problem) => Some(&problem.material),
            Self::InstrumentTest(InstrumentTest::Shell(specimen)) => Some(&specimen.material),
            Self::BendingTest(BendingTest::Strip(test)) => Some(&test.strip.material),
            Self::InstrumentTest(InstrumentTest::Compression(_))
            | Self::BendingTest(BendingTest::FabBendLoop(_)) => None,
        }
    }
}
