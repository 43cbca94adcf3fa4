use super::*;

/// A zone whose ranges are wider than they should be by a share of what one period can do.
struct TooWide(f64);

impl Act for TooWide {
    fn act(&self, zone: &SafeZone<'_>, position: f64, velocity: f64, request: Request) -> Command {
        let mut command = zone.command(position, velocity, request);
        let reachable = zone.planner().reachable(velocity);
        let more = self.0 * reachable.width();
        command.range.max = (command.range.max + more).min(reachable.max);
        command.range.min = (command.range.min - more).max(reachable.min);
        command
    }
}

/// A zone that never says that a state is beyond what it can promise.
struct Liar;

impl Act for Liar {
    fn act(&self, zone: &SafeZone<'_>, position: f64, velocity: f64, request: Request) -> Command {
        let mut command = zone.command(position, velocity, request);
        command.range.status = safezone::RangeStatus::Safe;
        command
    }
}

/// A zone whose ranges lack braking or are empty.
struct WithoutBraking(bool);

impl Act for WithoutBraking {
    fn act(&self, zone: &SafeZone<'_>, position: f64, velocity: f64, request: Request) -> Command {
        let mut command = zone.command(position, velocity, request);
        let range = &mut command.range;
        if range.narrowed && range.max > range.min {
            if self.0 {
                (range.min, range.max) = (range.max, range.min);
            } else {
                // All but the end at which braking lies.
                let middle = 0.5 * (range.min + range.max);
                if range.brake < middle { range.min = middle } else { range.max = middle }
            }
        }
        command
    }
}

const STEPS: u64 = 100_000;

#[test]
fn the_zone_as_it_is_breaks_no_promise() {
    let tally = tally(STEPS, 1, 2, &Zone);
    assert_eq!(tally.steps, STEPS);
    assert_eq!(tally.faults, Faults::default(), "replay case {:?} of seed 1", tally.first_faulty_case);
    assert!(tally.worst.is_within(MOST_EXCESS), "{:?}", tally.worst);
}

#[test]
fn every_kind_of_case_is_there() {
    let tally = tally(STEPS, 1, 1, &Zone);
    let (table, samples) = (tally.zones_with_table, tally.zones_with_samples);
    let counts = [table, samples, tally.zones - table - samples, tally.refused, tally.changes];
    assert!(counts.iter().all(|count| *count > 0), "{tally:?}");
    assert!(tally.narrowed > STEPS / 10 && tally.recovering > STEPS / 1000, "{tally:?}");
    assert!(tally.recovering < STEPS / 2, "{tally:?}");
}

#[test]
fn one_seed_gives_one_result_whatever_the_number_of_threads() {
    // Not a whole number of cases, so that the last one is short.
    let steps = 5 * CASE_STEPS + 17;
    let alone = tally(steps, 7, 1, &Zone);
    assert_eq!(alone.steps, steps);
    assert_eq!(tally(steps, 7, 2, &Zone), alone);
    assert_eq!(tally(steps, 7, 5, &Zone), alone);
    assert_ne!(tally(steps, 8, 2, &Zone), alone);
}

#[test]
fn a_range_that_is_too_wide_is_caught() {
    let tally = tally(STEPS, 1, 2, &TooWide(1e-3));
    assert!(tally.faults.limit > 0 && tally.worst.position > MOST_EXCESS, "{tally:?}");
    assert!(tally.first_faulty_case.is_some());
}

#[test]
fn a_status_that_lies_is_caught() {
    let tally = tally(STEPS, 1, 2, &Liar);
    assert!(tally.faults.status > 0, "{tally:?}");
}

#[test]
fn a_range_without_braking_is_caught_and_so_is_an_empty_one() {
    assert!(tally(STEPS, 1, 2, &WithoutBraking(false)).faults.no_braking > 0);
    assert!(tally(STEPS, 1, 2, &WithoutBraking(true)).faults.empty_range > 0);
}

#[test]
fn a_replayed_case_tells_its_joints() {
    let request = SoakRequest { steps: STEPS, seed: 1, threads: None, json: None, case: Some(3) };
    let words = soak(&request).unwrap();
    assert!(words.starts_with("joint ("), "{words}");
    assert!(words.ends_with("case 3: 8192 steps, 0 violations\n"), "{words}");
    let beyond = SoakRequest { case: Some(13), ..request };
    assert!(soak(&beyond).unwrap_err().to_string().contains("cases 0 to 12"));
}
