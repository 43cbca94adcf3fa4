//! One case: a joint, and spells of adversaries between which limits change and motions start anew.

use safezone::{SafeZone, Samples};

use super::adversary::Adversary;
use super::judge::{self, Fault, Trust};
use super::random::Random;
use super::tally::Tally;
use super::witness::{Moment, Witness};
use super::{Act, MOST_EXCESS, setting};

/// Longest spell of one adversary, in steps.
const LONGEST_SPELL: u64 = 512;

/// Runs case `index` of `seed` for `steps` steps. Its first steps are the same for any number of steps.
pub(super) fn run(seed: u64, index: u64, steps: u64, act: &impl Act, witness: &mut impl Witness) -> Tally {
    let mut random = Random::of_case(seed, index);
    let mut tally = Tally::default();
    // Memory for the zones that sample; once it is used up the others solve.
    let mut samples: [Samples; 16] = Default::default();
    let mut store = samples.iter_mut();
    let zone = setting::zone(&mut random, &mut tally, &mut store);
    witness.zone(&zone);
    let state = setting::start(&zone, &mut random);
    let mut joint = Joint { zone, state, trust: Trust::New };
    while tally.steps < steps {
        let mut adversary = Adversary::draw(&mut random);
        let spell = (1 + random.below(LONGEST_SPELL)).min(steps - tally.steps);
        for _ in 0..spell {
            if let Err(fault) = joint.step(&mut adversary, &mut random, &mut tally, act, witness) {
                tally.fault(&fault);
                joint.state = setting::start(&joint.zone, &mut random);
                joint.trust = Trust::New;
            }
        }
        match random.below(16) {
            0..4 => {
                if let Some(zone) = setting::changed(&joint.zone, &mut random, &mut tally, &mut store) {
                    witness.zone(&zone);
                    tally.changes += 1;
                    joint.zone = zone;
                    joint.trust = Trust::New;
                }
            }
            4..7 => {
                joint.state = setting::start(&joint.zone, &mut random);
                joint.trust = Trust::New;
            }
            _ => {}
        }
    }
    tally.of_case(index)
}

/// A joint in motion.
struct Joint<'a> {
    zone: SafeZone<'a>,
    /// Position [rad or m] and velocity [rad/s or m/s].
    state: (f64, f64),
    trust: Trust,
}

impl Joint<'_> {
    /// One step of the adversary's choice, judged.
    #[inline]
    fn step(
        &mut self,
        adversary: &mut Adversary,
        random: &mut Random,
        tally: &mut Tally,
        act: &impl Act,
        witness: &mut impl Witness,
    ) -> Result<(), Fault> {
        tally.steps += 1;
        let (zone, (position, velocity)) = (&self.zone, self.state);
        let command = act.act(zone, position, velocity, adversary.request(random));
        let next = adversary.velocity(velocity, &command, random);
        let range = &command.range;
        tally.narrowed += u64::from(range.narrowed);
        let number = tally.steps;
        let moment = |fault| Moment { number, state: (position, velocity), command, next, fault };
        let mut judged = || -> Result<_, Fault> {
            judge::check_range(zone, velocity, range, command.velocity)?;
            let trust = self.trust.after(zone, (position, velocity), range)?;
            tally.recovering += u64::from(matches!(trust, Trust::Recovering(_)));
            let step = zone.planner().ramp(position, velocity, next).map_err(Fault::Refused)?;
            let extrema = step.extrema();
            let excess = judge::excess(zone, &extrema, &trust);
            tally.excess(&excess);
            if !excess.is_within(MOST_EXCESS) {
                return Err(Fault::Limit(excess));
            }
            Ok((step.end(), trust))
        };
        match judged() {
            Ok((end, trust)) => {
                witness.step(self.state, &command, next);
                self.state = (end.position, end.velocity);
                self.trust = trust;
                Ok(())
            }
            Err(fault) => {
                witness.fault(&self.zone, &moment(fault));
                Err(fault)
            }
        }
    }
}
