//! Cases on several threads, and how far they are.

use std::io::IsTerminal;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use super::tally::Tally;
use super::witness::Nobody;
use super::{Act, CASE_STEPS, case};

/// Time between two looks at the progress.
const LOOK: Duration = Duration::from_millis(200);

/// Threads that the machine runs at once.
pub(super) fn available() -> usize {
    thread::available_parallelism().map_or(1, usize::from)
}

/// Steps of case `index` in a run of `steps`.
pub(super) fn steps_of(index: u64, steps: u64) -> u64 {
    CASE_STEPS.min(steps - index * CASE_STEPS)
}

/// Runs every case and gives the counts of all of them, and the seconds that it took.
///
/// Whichever thread is free takes the next case, and cases are put together by sums and maxima: the counts are the same
/// for any number of threads.
pub(super) fn timed(steps: u64, seed: u64, threads: usize, act: &impl Act) -> (Tally, f64) {
    let (next, done) = (AtomicU64::new(0), AtomicU64::new(0));
    let cases = steps.div_ceil(CASE_STEPS);
    let work = || {
        let mut tally = Tally::default();
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            if index >= cases {
                return tally;
            }
            let length = steps_of(index, steps);
            tally = tally.and(case::run(seed, index, length, act, &mut Nobody));
            done.fetch_add(length, Ordering::Relaxed);
        }
    };
    let started = now();
    let tally = thread::scope(|scope| {
        let workers: Vec<_> = (0..threads.max(1)).map(|_| scope.spawn(work)).collect();
        if std::io::stderr().is_terminal() {
            while !workers.iter().all(thread::ScopedJoinHandle::is_finished) {
                thread::sleep(LOOK);
                show(done.load(Ordering::Relaxed), steps, started.elapsed().as_secs_f64());
            }
            eprintln!();
        }
        let tallies = workers.into_iter().map(|worker| match worker.join() {
            Ok(tally) => tally,
            Err(panic) => std::panic::resume_unwind(panic),
        });
        tallies.fold(Tally::default(), Tally::and)
    });
    (tally, started.elapsed().as_secs_f64())
}

/// One line on standard error, written over the last one.
fn show(done: u64, steps: u64, seconds: f64) {
    let rate = done as f64 / seconds.max(1e-9);
    let left = (steps - done) as f64 / rate.max(1.0);
    let share = 100.0 * done as f64 / steps as f64;
    eprint!("\r{done:.3e} of {steps:.3e} steps ({share:.1} %), {rate:.2e} steps/s, {left:.0} s left   ");
}

#[expect(clippy::disallowed_methods, reason = "speed and remaining time are for a person to see")]
fn now() -> Instant {
    Instant::now()
}
