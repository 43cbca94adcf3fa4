//! The controllers of all joints of a machine.

use crate::{Command, HoldError, JointController, Measurement, Reference};

/// One controller per joint, stepped together. Each is a subsystem of its own: nothing is shared.
#[derive(Clone, Debug, PartialEq)]
pub struct Joints<C, const N: usize>([C; N]);

impl<C: JointController, const N: usize> Joints<C, N> {
    /// In the order in which references and measurements will come.
    pub fn new(controllers: [C; N]) -> Self {
        Self(controllers)
    }

    /// One tick of every joint.
    pub fn step(&mut self, references: &[Reference; N], measurements: &[Measurement; N]) -> [Command; N] {
        core::array::from_fn(|n| self.0[n].step(references[n], measurements[n]))
    }

    /// Resets every joint.
    pub fn reset(&mut self) {
        self.0.iter_mut().for_each(JointController::reset);
    }

    /// Takes over every joint from what holds it: [`JointController::start_holding`].
    ///
    /// # Errors
    /// [`JointHoldError`] names the first joint that cannot be held; those before it have changed.
    pub fn start_holding(
        &mut self,
        measurements: &[Measurement; N],
        efforts: &[f64; N],
    ) -> Result<[Reference; N], JointHoldError> {
        let mut references = [Reference::default(); N];
        for joint in 0..N {
            references[joint] = self.0[joint]
                .start_holding(measurements[joint], efforts[joint])
                .map_err(|error| JointHoldError { joint, error })?;
        }
        Ok(references)
    }

    /// The controllers, in order.
    pub fn as_slice(&self) -> &[C] {
        &self.0
    }

    /// The controllers, in order, to change one of them.
    pub fn as_mut_slice(&mut self) -> &mut [C] {
        &mut self.0
    }
}

/// One joint of several cannot be taken over as asked.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("joint {joint}: {error}")]
pub struct JointHoldError {
    /// Its place in the order of the controllers, from 0.
    pub joint: usize,
    /// What is wrong.
    pub error: HoldError,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        AnyController, Bounds, EffortLimits, InverseInertia, JointSpec, PdController, PdGains, PdGainsSpec,
        PidController, PidGains, PidGainsSpec,
    };

    fn joints() -> Joints<AnyController, 2> {
        let joint = JointSpec {
            period: 0.001,
            inverse_inertia: InverseInertia::try_from(Bounds { lower: 1.0, upper: 1.0 }).unwrap(),
            effort_limits: EffortLimits::symmetric(10.0).unwrap(),
        };
        let pd = PdGains::try_from(PdGainsSpec { proportional: 40.0, derivative: 8.0 }).unwrap();
        let pid = PidGainsSpec { proportional: 20.0, integral: 10.0, derivative: 6.0 };
        let pid = PidGains::try_from(pid).unwrap();
        Joints::new([
            PdController::new(pd, joint).unwrap().into(),
            PidController::new(pid, joint).unwrap().into(),
        ])
    }

    #[test]
    fn each_joint_has_its_own_law() {
        let at = |position| Measurement { position, velocity: 0.0 };
        let commands = joints().step(&[Reference::default(); 2], &[at(0.1), at(0.2)]);
        assert!((commands[0].effort + 4.0).abs() < 1e-12 && (commands[1].effort + 4.0).abs() < 1e-12);
    }

    #[test]
    fn holding_starts_every_joint_at_its_effort() {
        let (mut joints, measured) = (joints(), [Measurement { position: 0.3, velocity: 0.1 }; 2]);
        let references = joints.start_holding(&measured, &[5.0, -6.0]).unwrap();
        let commands = joints.step(&references, &measured);
        assert!((commands[0].effort - 5.0).abs() < 1e-12 && (commands[1].effort + 6.0).abs() < 1e-12);
        assert_eq!(joints.start_holding(&measured, &[5.0, -16.0]).unwrap_err().joint, 1);
        joints.reset();
        assert_eq!(joints, self::joints());
    }
}
