//! The reversible part of a law: a monotone curve with a continuous tangent.

use serde::{Deserialize, Serialize};

use super::LawError;

/// `E(e) = offset + Σ a_i I_i(e)`, `a_i >= 0`, with `I_i` the integral from strain 0 of the hat
/// function of knot `i`: the tangent is `a_i` at the knots, linear between them, constant outside.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(try_from = "Parts", into = "Parts")]
pub struct Backbone {
    /// At least one, increasing.
    pieces: Vec<Piece>,
}

/// The curve at a knot, and from there on.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Piece {
    strain: f64,
    at: ElasticResponse,
    /// Derivative of the tangent towards the next knot; 0 at the last.
    bend: f64,
}

/// A backbone as it is written to a file.
#[derive(Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
struct Parts {
    offset: f64,
    knots: Vec<f64>,
    tangents: Vec<f64>,
}

/// A stress with its derivative and its integral.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ElasticResponse {
    /// Stress.
    pub stress: f64,
    /// Derivative of the stress with respect to the strain.
    pub tangent: f64,
    /// Integral of the stress from strain 0.
    pub energy: f64,
}

impl Piece {
    /// The curve at `d` beyond the knot.
    fn ahead(&self, d: f64, bend: f64) -> ElasticResponse {
        let ElasticResponse { stress, tangent, energy } = self.at;
        ElasticResponse {
            stress: stress + d * (tangent + 0.5 * d * bend),
            tangent: tangent + d * bend,
            energy: energy + d * (stress + d * (0.5 * tangent + d * bend / 6.0)),
        }
    }
}

impl Backbone {
    /// A backbone with stress `offset` at strain 0 and the tangents `tangents` at `knots`.
    ///
    /// # Errors
    /// M020 unless there is a knot and a tangent for each, knots increase, tangents are not
    /// negative and all numbers are finite, those of the curve at its knots too.
    pub fn new(offset: f64, knots: &[f64], tangents: &[f64]) -> Result<Self, LawError> {
        if knots.is_empty() || knots.len() != tangents.len() {
            return Err(LawError::Count { knots: knots.len(), tangents: tangents.len() });
        }
        if let Some(&value) = [offset].iter().chain(knots).chain(tangents).find(|v| !v.is_finite()) {
            return Err(LawError::Value { what: "a number of the backbone", value });
        }
        if let Some(&value) = tangents.iter().find(|t| **t < 0.0) {
            return Err(LawError::Value { what: "a tangent", value });
        }
        if let Some(i) = (1..knots.len()).find(|&i| knots[i] <= knots[i - 1]) {
            return Err(LawError::Order { before: knots[i - 1], after: knots[i] });
        }
        let mut pieces: Vec<Piece> = knots
            .iter()
            .zip(tangents)
            .map(|(&strain, &tangent)| Piece {
                strain,
                at: ElasticResponse { tangent, ..ElasticResponse::default() },
                bend: 0.0,
            })
            .collect();
        for i in 1..pieces.len() {
            let width = knots[i] - knots[i - 1];
            pieces[i - 1].bend = (tangents[i] - tangents[i - 1]) / width;
            pieces[i].at.stress = pieces[i - 1].at.stress + 0.5 * width * (tangents[i] + tangents[i - 1]);
        }
        let mut backbone = Self { pieces };
        let lift = offset - backbone.at(0.0).stress;
        backbone.pieces.iter_mut().for_each(|p| p.at.stress += lift);
        for i in 1..backbone.pieces.len() {
            let [last, next] = [i - 1, i].map(|k| backbone.pieces[k]);
            backbone.pieces[i].at.energy = last.ahead(next.strain - last.strain, last.bend).energy;
        }
        let drop = backbone.at(0.0).energy;
        backbone.pieces.iter_mut().for_each(|p| p.at.energy -= drop);
        // Numbers that are each finite may have sums that are not.
        let derived = backbone.pieces.iter().flat_map(|p| [p.bend, p.at.stress, p.at.energy]);
        match derived.into_iter().find(|v| !v.is_finite()) {
            Some(value) => Err(LawError::Value { what: "a stress or energy of the backbone", value }),
            None => Ok(backbone),
        }
    }

    /// A straight line of slope `tangent` through the origin.
    ///
    /// # Errors
    /// M020 if the slope is negative or not finite.
    pub fn line(tangent: f64) -> Result<Self, LawError> {
        Self::new(0.0, &[0.0], &[tangent])
    }

    /// Stress, tangent and energy at a strain.
    pub fn at(&self, strain: f64) -> ElasticResponse {
        // A handful of knots: a scan is faster than a search.
        let mut piece = &self.pieces[0];
        if strain < piece.strain {
            return piece.ahead(strain - piece.strain, 0.0);
        }
        for next in &self.pieces[1..] {
            if next.strain > strain {
                break;
            }
            piece = next;
        }
        piece.ahead(strain - piece.strain, piece.bend)
    }

    /// Stress at strain 0.
    pub fn offset(&self) -> f64 {
        self.at(0.0).stress
    }

    /// Strains of the knots, increasing.
    pub fn knots(&self) -> impl ExactSizeIterator<Item = f64> + '_ {
        self.pieces.iter().map(|p| p.strain)
    }

    /// Tangents at the knots.
    pub fn tangents(&self) -> impl ExactSizeIterator<Item = f64> + '_ {
        self.pieces.iter().map(|p| p.at.tangent)
    }

    /// The mean of the curve and its image in the origin, `(E(e) - E(-e))/2`: cloth of which either face
    /// may be up.
    pub fn symmetric(&self) -> Self {
        let mut knots: Vec<f64> = self.knots().flat_map(|k| [k, -k]).chain([0.0]).collect();
        knots.sort_by(f64::total_cmp);
        knots.dedup();
        let tangent = |k: &f64| 0.5 * (self.at(*k).tangent + self.at(-k).tangent);
        let tangents: Vec<f64> = knots.iter().map(tangent).collect();
        // Means of tangents that are not negative, at knots that increase.
        Self::new(0.0, &knots, &tangents).unwrap_or_else(|_| self.with_offset(0.0))
    }

    /// The same stresses at strains multiplied by a factor.
    ///
    /// # Errors
    /// M020 for a factor that is not above zero and finite.
    pub fn stretched(&self, factor: f64) -> Result<Self, LawError> {
        let knots: Vec<f64> = self.knots().map(|k| k * factor).collect();
        let tangents: Vec<f64> = self.tangents().map(|t| t / factor).collect();
        Self::new(self.offset(), &knots, &tangents)
    }

    /// The same curve with other stress at strain 0: without the set or zero error of a record, say.
    pub fn with_offset(&self, offset: f64) -> Self {
        let change = offset - self.offset();
        let mut shifted = self.clone();
        for piece in &mut shifted.pieces {
            piece.at.stress += change;
            piece.at.energy += change * piece.strain;
        }
        shifted
    }
}

impl TryFrom<Parts> for Backbone {
    type Error = LawError;

    fn try_from(parts: Parts) -> Result<Self, LawError> {
        Self::new(parts.offset, &parts.knots, &parts.tangents)
    }
}

impl From<Backbone> for Parts {
    fn from(backbone: Backbone) -> Self {
        Self {
            offset: backbone.offset(),
            knots: backbone.knots().collect(),
            tangents: backbone.tangents().collect(),
        }
    }
}
