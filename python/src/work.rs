//! Long work: on threads of its own, with the interpreter free meanwhile.
//!
//! The calling thread waits, hands on what happens to a callback of Python, and looks for signals twenty times a
//! second. Ctrl-C, or an exception of the callback, is raised at once; the work is told to end at its next step.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use kesf::results::{Event, Failure, Observer};
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::error::OrRaise;
use crate::messages::Messages;

/// How often signals are looked for.
const INTERVAL: Duration = Duration::from_millis(50);

/// How long work that was told to end is waited for: short, as a person waits too.
const GRACE: Duration = Duration::from_millis(100);

/// Most threads that a caller may ask for.
const MOST_THREADS: usize = 1024;

/// What the caller wants of the work beside its result.
pub struct Follower {
    /// Called with what is done, how many steps are done and how many there are.
    pub progress: Option<Py<PyAny>>,
    /// Threads of the work; all of the machine when `None`.
    pub threads: Option<usize>,
}

enum Message {
    Started(&'static str, usize),
    Step,
    Finished,
    Done,
}

/// Threads that work, and the process that started them.
struct Threads {
    process: u32,
    pool: Arc<ThreadPool>,
}

static THREADS: Mutex<Option<Threads>> = Mutex::new(None);

/// Number of threads where none is asked for.
pub fn threads(asked: Option<usize>) -> usize {
    asked.or_else(|| std::thread::available_parallelism().ok().map(usize::from)).unwrap_or(1).max(1)
}

/// Number of threads of a caller, as the command takes it.
fn bounded(asked: Option<usize>) -> Result<usize, Failure> {
    match asked {
        Some(count) if !(1..=MOST_THREADS).contains(&count) => Err(Failure::new(
            "O050",
            format!("threads = {count}: a number of threads is 1 to {MOST_THREADS}"),
        )),
        asked => Ok(threads(asked)),
    }
}

/// The pool of so many threads. A process that was forked has none of its parent's threads and gets its own.
fn pool(count: usize) -> Result<Arc<ThreadPool>, Failure> {
    let mut kept = THREADS.lock().unwrap_or_else(PoisonError::into_inner);
    let process = std::process::id();
    if let Some(threads) = kept.as_ref()
        && threads.process == process
        && threads.pool.current_num_threads() == count
    {
        return Ok(Arc::clone(&threads.pool));
    }
    let pool = ThreadPoolBuilder::new().num_threads(count).build();
    let pool =
        Arc::new(pool.map_err(|e| Failure::new("O053", format!("the threads cannot be started: {e}")))?);
    let before = kept.replace(Threads { process, pool: Arc::clone(&pool) });
    if let Some(threads) = before.filter(|threads| threads.process != process) {
        // Its threads are not there to be told to end.
        std::mem::forget(threads);
    }
    Ok(pool)
}

/// Does short work with the interpreter free: nobody follows it, and it is not interrupted.
pub fn free<T: Send>(
    py: Python<'_>,
    count: usize,
    work: impl FnOnce() -> Result<T, Failure> + Send,
) -> PyResult<T> {
    py.detach(|| pool(count)?.install(work)).or_raise(py)
}

/// Does long work, followed and interrupted as this module says.
pub fn follow<T: Send + 'static>(
    py: Python<'_>,
    follower: &Follower,
    work: impl FnOnce(&Observer<'_>) -> Result<T, Failure> + Send + 'static,
) -> PyResult<(T, Messages)> {
    let pool = bounded(follower.threads).and_then(pool).or_raise(py)?;
    let cancelled = Arc::new(AtomicBool::new(false));
    let (sender, receiver) = mpsc::channel();
    let worker = {
        let cancelled = Arc::clone(&cancelled);
        std::thread::spawn(move || {
            let done = pool.install(|| observed(&sender, &cancelled, work));
            // Who waited may have left.
            let _ = sender.send(Message::Done);
            done
        })
    };
    let receiver = Mutex::new(receiver);
    let mut progress = Progress { callback: follower.progress.as_ref(), what: "", done: 0, of: 0 };
    loop {
        let message =
            py.detach(|| receiver.lock().unwrap_or_else(PoisonError::into_inner).recv_timeout(INTERVAL));
        let delivered = match message {
            Ok(Message::Done) | Err(RecvTimeoutError::Disconnected) => break,
            Ok(message) => progress.tell(py, message),
            Err(RecvTimeoutError::Timeout) => Ok(()),
        };
        if let Err(error) = delivered.and_then(|()| py.check_signals()) {
            cancelled.store(true, Ordering::Relaxed);
            py.detach(|| wait(&worker));
            return Err(error);
        }
    }
    let (result, messages) =
        py.detach(|| worker.join()).unwrap_or_else(|panic| std::panic::resume_unwind(panic));
    Ok((result.or_raise(py)?, messages))
}

fn wait<T>(worker: &JoinHandle<T>) {
    let start = Instant::now();
    while !worker.is_finished() && start.elapsed() < GRACE {
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// The work with an observer that keeps what is said and sends on what happens.
fn observed<T>(
    sender: &Sender<Message>,
    cancelled: &AtomicBool,
    work: impl FnOnce(&Observer<'_>) -> Result<T, Failure>,
) -> (Result<T, Failure>, Messages) {
    let messages = Mutex::new(Messages::default());
    let send = |message| drop(sender.send(message));
    let event = |event: Event<'_>| {
        let mut messages = messages.lock().unwrap_or_else(PoisonError::into_inner);
        match event {
            Event::Started(what, steps) => send(Message::Started(what, steps)),
            Event::Step => send(Message::Step),
            Event::Finished => send(Message::Finished),
            Event::Failed(failure) => messages.failures.push(failure.clone()),
            Event::Found(found) => {
                messages.findings.push((found.fabric.map(str::to_string), found.finding.clone()));
            }
            Event::Note(text) => messages.notes.push(text.to_string()),
        }
    };
    let result = work(&Observer { event: &event, cancelled: &|| cancelled.load(Ordering::Relaxed) });
    (result, messages.into_inner().unwrap_or_else(PoisonError::into_inner))
}

/// What the callback was told last.
struct Progress<'a> {
    callback: Option<&'a Py<PyAny>>,
    what: &'static str,
    done: usize,
    of: usize,
}

impl Progress<'_> {
    fn tell(&mut self, py: Python<'_>, message: Message) -> PyResult<()> {
        match message {
            Message::Started(what, steps) => (self.what, self.done, self.of) = (what, 0, steps),
            Message::Step => self.done += 1,
            // Steps that turned out not to be needed count as done.
            Message::Finished if self.done == self.of => return Ok(()),
            Message::Finished => self.done = self.of,
            Message::Done => return Ok(()),
        }
        self.of = self.of.max(self.done);
        match self.callback {
            Some(callback) => callback.call1(py, (self.what, self.done, self.of)).map(drop),
            None => Ok(()),
        }
    }
}
