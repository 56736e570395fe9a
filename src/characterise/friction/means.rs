//! The law of the mean fabric: that of one specimen, brought to the means over all of them.
//!
//! Loops of different specimens are not averaged: where their friction gives way differs, and a mean of it would give
//! way everywhere a little. Their stiffness and width are: `σ = a E(e) + s Σ w_j t_j` has the slope and the width of
//! the fabric for one pair of a and s, as both are linear in the weights. A test that is driven by force is stretched
//! instead, so that it takes the work of the fabric up to the same force.

use super::record::extract_backbone;
use super::{Basis, FrictionLaw};
use crate::characterise::{FabricSheet, Settings};
use crate::instrument::{Conditions, Direction, Parameter, Shape, Test};
use crate::kes::TestSpec;
use crate::law::Channel;

impl FrictionLaw {
    /// The law with B and 2HB, or G and 2HG, of the given sizes (SI); of tension and compression with the work
    /// `stiffness`, WT or WC, up to the same force. What is not given, or what the law has no value of, stays.
    pub fn with_values(&self, stiffness: Option<f64>, width: Option<f64>) -> Channel {
        let own = |p: Parameter| self.values.get(&p).copied().filter(|v| *v > 0.0);
        let ratio = |wanted: Option<f64>, own: Option<f64>| {
            let part = wanted? / own?;
            (part.is_finite() && part > 0.0).then_some(part)
        };
        let TestSpec { leading: leads, loop_width: widens, .. } = *self.test.spec();
        let stiffer = ratio(stiffness, own(leads));
        let made = match self.test.shape() {
            Shape::Sweep => None,
            Shape::Rise => stiffer.map(|part| self.channel.stretched(part)),
            Shape::Loop => {
                let sliders = ratio(width, widens.and_then(own)).unwrap_or(1.0);
                let backbone = self.backbone_stiffness.zip(own(leads)).and_then(|(elastic, all)| {
                    let wanted = stiffness.unwrap_or(all);
                    let part = (wanted - sliders * (all - elastic)) / elastic;
                    (part.is_finite() && part > 0.0).then_some(part)
                });
                // Friction that stiffens more than all: then the whole law goes with the stiffness.
                let [backbone, sliders] = match backbone {
                    Some(part) => [part, sliders],
                    None => [stiffer.unwrap_or(1.0); 2],
                };
                Some(self.channel.scaled(backbone, sliders))
            }
        };
        // Positive factors make no law wrong.
        made.and_then(Result::ok).unwrap_or_else(|| self.channel.clone())
    }

    /// What the backbone gives of B or G (SI): the rest is that of sliders that still give way, or widen.
    pub(super) fn elastic(&self, conditions: &Conditions, settings: &Settings) -> Option<f64> {
        let TestSpec { leading: leads, loop_width: widens, .. } = *self.test.spec();
        widens?;
        let mut tangents = self.channel.backbone().tangents();
        let first = tangents.next()?;
        if tangents.all(|t| t == first) {
            return Some(first);
        }
        extract_backbone(self, conditions, settings).get(&leads).copied()
    }
}

impl FabricSheet {
    /// The law of the specimen in the middle by B, G, WT or WC, or that from summary values; that of the fabric where
    /// the direction has none.
    pub fn law(&self, test: Test, direction: Option<Direction>) -> Option<&FrictionLaw> {
        self.middle_law(test, direction).or_else(|| self.middle_law(test, None))
    }

    fn middle_law(&self, test: Test, direction: Option<Direction>) -> Option<&FrictionLaw> {
        let mut found: Vec<&FrictionLaw> = (self.laws.iter())
            .filter(|l| l.test == test && l.direction == direction && l.basis != Basis::Strip)
            .collect();
        let value = |l: &FrictionLaw| l.values.get(&test.spec().leading).copied().unwrap_or(0.0);
        found.sort_by(|a, b| value(a).total_cmp(&value(b)));
        found.get(found.len().saturating_sub(1) / 2).copied()
    }

    /// The law to calculate with: [`law`](Self::law) with the means that the sheet has of its values.
    pub fn mean_law(&self, test: Test, direction: Option<Direction>) -> Option<Channel> {
        let law = self.law(test, direction)?;
        // A law of the fabric as a whole has the values of the whole.
        let mean = |p: Parameter| self.get(p, law.direction).map(|e| e.mean);
        let TestSpec { leading: leads, loop_width: widens, .. } = *test.spec();
        // Works up to different forces have no mean.
        let by_force = test.shape() == Shape::Rise;
        if by_force && self.run_to.get(&(test, law.direction)).is_some_and(|r| !r.alike) {
            return Some(law.channel.clone());
        }
        Some(law.with_values(mean(leads), widens.and_then(mean)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::characterise::Key;
    use crate::characterise::friction::{bending_law, extract};
    use crate::instrument::standard_conditions;
    use crate::law::{Backbone, Family, Slider, Widening};
    use crate::quantity::Estimate;
    use approx::assert_relative_eq;

    fn law(test: Test, specimen: usize, channel: Channel) -> FrictionLaw {
        let mut law = FrictionLaw {
            test,
            direction: Some(Direction::Warp),
            specimen,
            basis: Basis::Loop,
            thickness: None,
            channel,
            strip: None,
            memory: None,
            fit: None,
            closed_form: None,
            values: Default::default(),
            backbone_stiffness: None,
        };
        law.evaluate(&standard_conditions(test), &Settings::default());
        law
    }

    fn values(of: &FrictionLaw, channel: &Channel) -> [f64; 2] {
        let law = FrictionLaw { channel: channel.clone(), ..of.clone() };
        let conditions: Conditions = standard_conditions(law.test);
        let found = extract(&law, &conditions, &Settings::default());
        let TestSpec { leading: leads, loop_width: widens, .. } = *law.test.spec();
        [found[&leads], widens.map_or(f64::NAN, |p| found[&p])]
    }

    /// Two specimens with very different loops: what is calculated with has the means of the sheet, not the
    /// values of either.
    #[test]
    fn the_law_of_a_fabric_has_its_means() {
        let mut sheet = FabricSheet::default();
        sheet.laws.push(law(Test::Bending, 1, bending_law(5e-6, 2e-4).unwrap()));
        sheet.laws.push(law(Test::Bending, 2, bending_law(15e-6, 8e-4).unwrap()));
        let key = |parameter| Key { parameter, direction: Some(Direction::Warp) };
        sheet.values.insert(key(Parameter::B), Estimate::of(&[5e-6, 15e-6]).unwrap());
        sheet.values.insert(key(Parameter::Hb), Estimate::of(&[2e-4, 8e-4]).unwrap());
        let channel = sheet.mean_law(Test::Bending, Some(Direction::Warp)).unwrap();
        let [b, width] = values(&sheet.laws[0], &channel);
        assert_relative_eq!(b, 10e-6, max_relative = 1e-9);
        assert_relative_eq!(width, 5e-4, max_relative = 1e-9);
    }

    /// Values of the fabric as a whole move the law of the fabric, whichever direction is asked for.
    #[test]
    fn a_law_without_a_direction_follows_values_without_one() {
        let mut sheet = FabricSheet::default();
        let whole =
            FrictionLaw { direction: None, ..law(Test::Bending, 0, bending_law(5e-6, 2e-4).unwrap()) };
        sheet.laws.push(whole);
        let key = |parameter| Key { parameter, direction: None };
        sheet.values.insert(key(Parameter::B), Estimate::single(5e-6));
        sheet.values.insert(key(Parameter::Hb), Estimate::single(3e-4));
        let channel = sheet.mean_law(Test::Bending, Some(Direction::Weft)).unwrap();
        let [b, width] = values(&sheet.laws[0], &channel);
        assert_relative_eq!(b, 5e-6, max_relative = 1e-9);
        assert_relative_eq!(width, 3e-4, max_relative = 1e-9);
    }

    /// Friction that widens with the angle is part of G: the backbone makes up for what more of it adds.
    #[test]
    fn stiffness_and_width_are_independent_of_each_other() {
        let family = Family {
            widening: Widening::Quadratic { alpha: 4.0, e_max: 0.14 },
            sliders: vec![Slider { stiffness: 300.0, slip: 0.004 }],
        };
        let channel = Channel::new(Backbone::line(30.0).unwrap(), vec![family], false).unwrap();
        let law = law(Test::Shear, 1, channel);
        assert!(law.backbone_stiffness.unwrap() < 0.95 * law.values[&Parameter::G]);
        let made = law.with_values(Some(50.0), Some(3.0));
        let [g, width] = values(&law, &made);
        assert_relative_eq!(g, 50.0, max_relative = 1e-9);
        assert_relative_eq!(width, 3.0, max_relative = 1e-9);
    }

    /// More work up to the same force is more strain, not more force.
    #[test]
    fn a_tensile_law_takes_the_mean_work() {
        let backbone = Backbone::new(0.0, &[0.0, 0.05, 0.1], &[100.0, 2000.0, 20000.0]).unwrap();
        let law = law(Test::Tensile, 1, Channel::new(backbone, Vec::new(), true).unwrap());
        let made = law.with_values(Some(1.3 * law.values[&Parameter::Wt]), None);
        let [work, _] = values(&law, &made);
        assert_relative_eq!(work, 1.3 * law.values[&Parameter::Wt], max_relative = 1e-6);
    }
}
