//! How far the work is: a bar on a terminal, a line now and then elsewhere.

use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

/// Between two lines where standard error is no terminal.
const PAUSE: Duration = Duration::from_secs(10);

/// How far a part of the work is.
#[derive(Debug)]
pub enum Progress {
    /// On a terminal.
    Bar(ProgressBar),
    /// In a file or a pipe.
    Lines(Lines),
}

/// Lines for a file or a pipe.
#[derive(Debug)]
pub struct Lines {
    what: &'static str,
    done: usize,
    steps: usize,
    start: Instant,
    last: Instant,
}

impl Progress {
    /// Of a part with so many steps.
    pub fn new(what: &'static str, steps: usize, is_terminal: bool) -> Self {
        if is_terminal {
            let style = ProgressStyle::with_template("{msg} [{bar:40}] {pos}/{len} {eta}")
                .unwrap_or(ProgressStyle::default_bar());
            return Self::Bar(ProgressBar::new(steps as u64).with_style(style).with_message(what));
        }
        let now = Instant::now();
        Self::Lines(Lines { what, done: 0, steps, start: now, last: now })
    }

    /// A step is done; the line to write, if one is due.
    pub fn step(&mut self) -> Option<String> {
        match self {
            Self::Bar(bar) => {
                bar.inc(1);
                None
            }
            Self::Lines(lines) => lines.step(Instant::now()),
        }
    }

    /// The part is done.
    pub fn finish(self) {
        if let Self::Bar(bar) = self {
            bar.finish_and_clear();
        }
    }

    /// Writes a line, above the bar if there is one.
    pub fn suspend(&self, write: impl FnOnce()) {
        match self {
            Self::Bar(bar) => bar.suspend(write),
            Self::Lines(_) => write(),
        }
    }
}

impl Lines {
    fn step(&mut self, now: Instant) -> Option<String> {
        self.done += 1;
        if now.duration_since(self.last) < PAUSE {
            return None;
        }
        self.last = now;
        let seconds = now.duration_since(self.start).as_secs();
        Some(format!("{}: {} of {} after {seconds} s", self.what, self.done, self.steps))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_due_now_and_then() {
        let start = Instant::now();
        let mut lines = Lines { what: "fabrics", done: 0, steps: 50, start, last: start };
        let at = |seconds| start + Duration::from_secs(seconds);
        assert_eq!(lines.step(at(3)), None);
        assert_eq!(lines.step(at(11)).as_deref(), Some("fabrics: 2 of 50 after 11 s"));
        assert_eq!(lines.step(at(15)), None);
        assert_eq!(lines.step(at(22)).as_deref(), Some("fabrics: 4 of 50 after 22 s"));
    }
}
