//! One run of a target: what it counts, how long a file may take, and what is left of a file that does not hold.

use std::fs;
use std::io::Write;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use crate::{Damage, Target, corpus};

/// What a file may take, whatever its size, and what each byte of it adds: a hundred times what a slow reader needs
/// here. What grows with the square of the size is beyond that at the sizes that damage makes.
const BASE: Duration = Duration::from_secs(1);
const EACH_BYTE: Duration = Duration::from_micros(100);
/// A reader that takes so long will not end.
const HANG: u64 = 300;

/// How long each target runs: `KESF_FUZZ_SECONDS`, or a minute.
pub fn seconds() -> Duration {
    let set = std::env::var("KESF_FUZZ_SECONDS").ok().and_then(|s| s.parse().ok());
    Duration::from_secs_f64(set.unwrap_or(60.0))
}

/// How many files each target reads, the same ones every time, in the place of a time: `KESF_FUZZ_FILES`.
pub fn files() -> Option<u64> {
    std::env::var("KESF_FUZZ_FILES").ok().and_then(|s| s.parse().ok())
}

/// Whether nothing but a hang is too slow (`KESF_FUZZ_UNTIMED`): for machines of which nobody knows how fast they are.
fn untimed() -> bool {
    std::env::var_os("KESF_FUZZ_UNTIMED").is_some()
}

/// Time of a processor that this thread has had, where the system tells (Linux): others use the machine too.
fn busy() -> Option<Duration> {
    let text = fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    Some(Duration::from_nanos(text.split(' ').next()?.parse().ok()?))
}

/// A target while it runs.
pub struct Run {
    name: &'static str,
    target: Target,
    /// The file that is being read, for whoever finds the process dead.
    current: PathBuf,
    files: AtomicUsize,
    accepted: AtomicUsize,
    slowest: AtomicU64,
    /// Seconds since `start` at which the present file began; 0 for none.
    began: Arc<AtomicU64>,
    start: Instant,
}

impl Run {
    /// Begins: the valid files, and those that once did not hold, are read as they are.
    ///
    /// # Panics
    /// Where one of them does not hold, or no valid file is accepted.
    pub fn new(name: &'static str, target: Target) -> Self {
        let folder = corpus::package().join("../target/fuzz");
        fs::create_dir_all(&folder).expect("a folder for files that do not hold");
        let began = Arc::new(AtomicU64::new(0));
        let start = Instant::now();
        let watched = began.clone();
        std::thread::spawn(move || {
            loop {
                std::thread::sleep(Duration::from_secs(1));
                let began = watched.load(Ordering::Relaxed);
                if began > 0 && start.elapsed().as_secs() > began + HANG {
                    let _ = writeln!(
                        std::io::stderr(),
                        "{name}: a file took more than {HANG} s: target/fuzz/{name}"
                    );
                    std::process::abort();
                }
            }
        });
        let run = Self {
            name,
            target,
            current: folder.join(name),
            files: AtomicUsize::new(0),
            accepted: AtomicUsize::new(0),
            slowest: AtomicU64::new(0),
            began,
            start,
        };
        let valid = run.target.seeds.iter().filter(|seed| run.read(seed)).count();
        assert!(2 * valid > run.target.seeds.len(), "{valid} of {} files are valid", run.target.seeds.len());
        for once in corpus::folder(&format!("{name}/once")) {
            run.read(&once);
        }
        run
    }

    /// Damages a file and reads it.
    ///
    /// # Panics
    /// Where it does not hold; the file is left in `target/fuzz`.
    pub fn read_damaged(&self, damage: &Damage) {
        let bytes = (self.target.damaged)(damage, &self.target.seeds);
        self.files.fetch_add(1, Ordering::Relaxed);
        if self.read(&bytes) {
            self.accepted.fetch_add(1, Ordering::Relaxed);
        }
    }

    fn read(&self, bytes: &[u8]) -> bool {
        fs::write(&self.current, bytes).expect("the file that is read");
        self.began.store(self.start.elapsed().as_secs().max(1), Ordering::Relaxed);
        let size = (self.target.size)(bytes);
        let limit = if untimed() {
            Duration::from_secs(HANG)
        } else {
            BASE + EACH_BYTE * u32::try_from(size).unwrap_or(u32::MAX)
        };
        let mut least = Duration::MAX;
        let mut accepted = false;
        // What is slow by itself is so every time.
        for _ in 0..3 {
            let start = busy().unwrap_or_else(|| self.start.elapsed());
            match catch_unwind(AssertUnwindSafe(|| (self.target.holds)(bytes))) {
                Ok(found) => accepted = found,
                Err(panic) => {
                    self.keep(bytes);
                    resume_unwind(panic);
                }
            }
            least = least.min(busy().unwrap_or_else(|| self.start.elapsed()) - start);
            if least < limit {
                break;
            }
        }
        self.began.store(0, Ordering::Relaxed);
        self.slowest.fetch_max(least.as_micros() as u64, Ordering::Relaxed);
        if least >= limit {
            self.keep(bytes);
            panic!("{size} bytes took {least:?} where {limit:?} is the limit");
        }
        accepted
    }

    /// Keeps a file that does not hold: put it into `corpus/<target>/once` when the reader is mended.
    fn keep(&self, bytes: &[u8]) {
        self.began.store(0, Ordering::Relaxed);
        let sum = bytes
            .iter()
            .fold(0xcbf2_9ce4_8422_2325_u64, |h, b| (h ^ u64::from(*b)).wrapping_mul(0x0100_0000_01b3));
        let path = self.current.with_file_name(format!("{}-{sum:016x}", self.name));
        fs::write(&path, bytes).expect("the file that does not hold");
        println!("{} does not hold", path.display());
    }

    /// Ends: how many files were read and accepted, and the longest time of one.
    pub fn end(self) {
        let _ = fs::remove_file(&self.current);
        println!(
            "{}: {} files, {} accepted, the slowest took {:.1} ms",
            self.name,
            self.files.into_inner(),
            self.accepted.into_inner(),
            1e-3 * self.slowest.into_inner() as f64
        );
    }
}
