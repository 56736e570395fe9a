//! The fabrics of a batch, known by name and by a hash of what was read, without their data: a run goes through
//! thousands of them with one in memory at a time.

use std::collections::BTreeSet;
use std::ops::Range;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

use super::failure::Failure;
use super::inputs::{Fabric, Input, Reading, without_memory};
use super::names::{Named, distinguish, key_of_name};
use super::observer::Observer;
use super::record::digest_of;
use super::shard::{Share, name_of};
use crate::characterise::{Modulus, Settings, characterise};
use crate::finding::{Finding, Place};
use crate::instrument::{FabricInput, Library, ReadError, ReadSettings};
use crate::platform;

/// Files up to which a library is kept in memory as it was read the first time: a few fabrics are not read twice.
const KEPT: usize = 256;

/// The fabrics of a batch, in name order.
pub(crate) struct Catalogue {
    library: Library,
    memory: Vec<Input>,
    reading: ReadSettings,
    evaluation: Settings,
    entries: Vec<Entry>,
    names: Vec<Named>,
    /// Whether there are fabrics that other shards have.
    pub left_out: bool,
    /// What could not be read, each with the fabric that it is of. The observer has it already.
    pub failures: Vec<Failure>,
    /// What belongs to no fabric. The observer has it already.
    pub findings: Vec<Finding>,
}

/// A fabric of the catalogue.
struct Entry {
    origin: Origin,
    /// Its folder or file; none where it is that of its group, which the library knows.
    path: Option<Box<Path>>,
    /// Hash of all that was read of it.
    inputs: [u8; 32],
    kept: Mutex<Option<Box<FabricInput>>>,
}

/// Where a fabric is read.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Origin {
    /// The folder or file of the library.
    Group(usize),
    /// The input in memory.
    Memory(usize),
}

/// Of what fabric something was not read.
enum Whose {
    /// Of the one at this place.
    Fabric(usize),
    /// Of one of which nothing was read.
    Lost(String),
    /// Nobody's in particular.
    Unknown,
}

impl Catalogue {
    /// Reads every fabric below the inputs, or those of a share of a job with these inputs of its own, for its name and
    /// its hash. `moduli` are evaluated beside those of the settings.
    ///
    /// # Errors
    /// Those of [`Reading::read_settings`] and [`Reading::evaluation`], and O054 if the work was cancelled.
    pub fn find(
        reading: &Reading,
        inputs: &[Input],
        moduli: &[Modulus],
        share: Option<(Share, &[Input])>,
        observer: &Observer,
    ) -> Result<Self, Failure> {
        let settings = reading.read_settings()?;
        let evaluation = reading.evaluation_with(moduli)?;
        let mut library = Library::find(&without_memory(inputs), &settings);
        let found = library.groups();
        let mut taken = BTreeSet::new();
        if let Some((share, own)) = share {
            // A number behind a name must not make it that of a fabric of another shard.
            taken.extend(library.names_of_folders().map(key_of_name));
            library.keep(|path, name| share.wants(own, path, name), !share.speaks_of_inputs());
        }
        let findings = library.findings().to_vec();
        findings.iter().for_each(|finding| observer.found(None, finding));
        let keep = library.files() <= KEPT;
        let groups = observer.part("reading", library.files(), || {
            platform::map_several((0..library.groups()).collect(), |group| {
                observer.go_on().ok()?;
                let (fabrics, errors) = library.read(group, &|_: &Path| observer.step());
                let of_group = library.path(group);
                let entry = |fabric: FabricInput| Entry::new(Origin::Group(group), of_group, fabric, keep);
                let entries = fabrics.into_iter().map(entry).collect::<Result<Vec<_>, _>>();
                // What is collected in the place of inputs keeps their room.
                let entries = entries.map(|mut entries| {
                    entries.shrink_to_fit();
                    entries
                });
                Some((entries, errors))
            })
        })?;
        let share = share.map(|(share, _)| share);
        let mut catalogue = Self {
            memory: inputs.iter().filter(|input| is_wanted_in_memory(input, share)).cloned().collect(),
            left_out: found > library.groups(),
            reading: settings,
            evaluation,
            entries: Vec::new(),
            names: Vec::new(),
            failures: Vec::new(),
            findings,
            library,
        };
        let mut errors: Vec<(ReadError, Whose)> =
            catalogue.library.failures().iter().map(|error| (error.clone(), Whose::Unknown)).collect();
        for (group, (entries, unread)) in
            groups.into_iter().enumerate().filter_map(|(at, of)| Some((at, of?)))
        {
            let entries = entries?;
            errors.extend(unread.into_iter().map(|error| (error, catalogue.whose(group, entries.len()))));
            catalogue.add(entries);
        }
        for (at, input) in catalogue.memory.clone().iter().enumerate() {
            match input.in_memory(&catalogue.reading) {
                Some(Ok((fabrics, left_out))) => {
                    for fabric in fabrics {
                        catalogue.add(vec![Entry::new(Origin::Memory(at), None, fabric, true)?]);
                    }
                    errors.extend(left_out.into_iter().map(|error| (error, Whose::Unknown)));
                }
                Some(Err(error)) => errors.push((error, Whose::Unknown)),
                None => {}
            }
        }
        let mut names = std::mem::take(&mut catalogue.names);
        distinguish(&mut names, |at| catalogue.path(at), &taken);
        catalogue.names = names;
        catalogue.names.shrink_to_fit();
        catalogue.entries.shrink_to_fit();
        catalogue.failures =
            errors.into_iter().map(|(error, whose)| catalogue.failure(error, whose)).collect();
        catalogue.failures.iter().for_each(|failure| observer.failed(failure));
        Ok(catalogue)
    }

    /// Of what fabric something is that could not be read of a group, which gives so many and is the next to be added.
    fn whose(&self, group: usize, fabrics: usize) -> Whose {
        match fabrics {
            0 => self.library.name(group).map_or(Whose::Unknown, |name| Whose::Lost(name.into_owned())),
            1 => Whose::Fabric(self.entries.len()),
            // A file of a folder of several fabrics.
            _ => Whose::Unknown,
        }
    }

    /// With the fabric that it is of: that which it names, or that of its folder, or what the file alone would give one.
    fn failure(&self, error: ReadError, whose: Whose) -> Failure {
        let failure = Failure::from(error);
        if failure.fabric.is_some() {
            return failure;
        }
        let fabric = match whose {
            Whose::Fabric(at) => Some(self.name(at).to_string()),
            Whose::Lost(name) => Some(name),
            Whose::Unknown => failure.place.as_ref().map(|place| name_of(&place.path)),
        };
        Failure { fabric: fabric.map(Into::into), ..failure }
    }

    fn add(&mut self, entries: Vec<(Entry, Named)>) {
        let (entries, names): (Vec<_>, Vec<_>) = entries.into_iter().unzip();
        self.entries.extend(entries);
        self.names.extend(names);
    }

    /// Number of fabrics.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// The name of a fabric, which no other has.
    pub fn name(&self, at: usize) -> &str {
        &self.names[at].name
    }

    /// The folder or file of a fabric.
    pub fn path(&self, at: usize) -> &Path {
        let Entry { origin, path, .. } = &self.entries[at];
        let of_group = || match origin {
            Origin::Group(group) => self.library.path(*group),
            Origin::Memory(_) => None,
        };
        path.as_deref().or_else(of_group).unwrap_or(Path::new(""))
    }

    /// Hash of all that was read of a fabric.
    pub fn inputs(&self, at: usize) -> &[u8] {
        &self.entries[at].inputs
    }

    /// The fabrics that are read together, in order.
    pub fn units(&self) -> Vec<Range<usize>> {
        let mut units: Vec<Range<usize>> = Vec::new();
        for (at, entry) in self.entries.iter().enumerate() {
            match units.last_mut() {
                Some(unit) if self.entries[unit.start].origin == entry.origin => unit.end = at + 1,
                _ => units.push(at..at + 1),
            }
        }
        units
    }

    /// The fabrics of one of the [`units`](Self::units) with their sheets, or why one has none.
    pub fn fabrics(&self, unit: Range<usize>) -> Vec<Result<Fabric, Failure>> {
        let kept = unit.clone().map(|at| self.entries[at].take()).collect::<Option<Vec<_>>>();
        let inputs = kept.unwrap_or_else(|| self.read_again(self.entries[unit.start].origin));
        let mut inputs = inputs.into_iter();
        unit.map(|at| self.fabric(at, inputs.next())).collect()
    }

    fn read_again(&self, origin: Origin) -> Vec<FabricInput> {
        match origin {
            Origin::Group(group) => self.library.read(group, &|_: &Path| ()).0,
            Origin::Memory(at) => {
                let read = self.memory[at].in_memory(&self.reading).and_then(Result::ok);
                read.map(|(fabrics, _)| fabrics).unwrap_or_default()
            }
        }
    }

    fn fabric(&self, at: usize, input: Option<FabricInput>) -> Result<Fabric, Failure> {
        let changed = || {
            Failure::new("O063", format!("{} changed while the run was going on", self.name(at)))
                .at(Place::file(self.path(at)))
                .hint("run again when nothing writes there")
        };
        let input = input.ok_or_else(changed)?;
        if digest_of(&input)? != self.entries[at].inputs {
            return Err(changed());
        }
        let mut sheet = characterise(&input, &self.evaluation);
        let Named { name, findings } = self.names[at].clone();
        sheet.name = name;
        sheet.findings.extend(findings);
        Ok(Fabric::of_sheet(input.path, sheet))
    }
}

fn is_wanted_in_memory(input: &Input, share: Option<Share>) -> bool {
    !matches!(input, Input::Path(_))
        && share.is_none_or(|share| !share.of_whole || share.shard.has(input.path()))
}

impl Entry {
    /// `of_group` is the folder or file of its group.
    fn new(
        origin: Origin,
        of_group: Option<&Path>,
        fabric: FabricInput,
        keep: bool,
    ) -> Result<(Self, Named), Failure> {
        let named = Named::new(fabric.name.as_str());
        let path = (of_group != Some(&fabric.path)).then(|| fabric.path.as_path().into());
        let inputs = digest_of(&fabric)?;
        let kept = Mutex::new(keep.then(|| Box::new(fabric)));
        Ok((Self { origin, path, inputs, kept }, named))
    }

    /// What was kept of the first reading; once.
    fn take(&self) -> Option<FabricInput> {
        self.kept.lock().unwrap_or_else(PoisonError::into_inner).take().map(|kept| *kept)
    }
}
