//! One joint, driven by each generator in the same way.
//!
//! The same picture for each: a state of the joint goes in, a target velocity is planned for, and the state comes out at
//! any time of the period. Units are SI: m, m/s, m/s², m/s³, s.
//!
//! ```
//! use jbtg::Timing;
//! use peers::{TELESCOPE, zone};
//!
//! let ours = zone(TELESCOPE, Timing::Stretched, 0.05);
//! let range = ours.range(0.495, 0.1);
//! assert!(range.max < 0.1, "near its limit the joint has to brake");
//! ```
//!
//! Only benches and the program `peers` use this; nothing depends on it, and it is no default member of the workspace
//! since Ruckig needs a C++20 compiler.
#![forbid(unsafe_code)]

use jbtg::{Interval, Limits, Planner, PlannerSpec, Shape, SymmetricLimits, Timing};
use rsruckig::prelude as rs;
use safezone::SafeZone;

/// Limits of the joint of every comparison: symmetric, since Ruckig's jerk limit is.
#[derive(Clone, Copy, Debug)]
pub struct Joint {
    /// Position [m].
    pub position: Interval,
    /// Largest speed [m/s].
    pub velocity: f64,
    /// Largest acceleration [m/s²].
    pub acceleration: f64,
    /// Largest jerk [m/s³].
    pub jerk: f64,
}

/// The telescope of the crane.
pub const TELESCOPE: Joint =
    Joint { position: Interval::new(0.14, 0.50), velocity: 0.15, acceleration: 1.0, jerk: 100.0 };

/// Our zone of `joint` at `period` \[s\].
///
/// # Panics
/// The limits and the period are refused.
#[must_use]
pub fn zone(joint: Joint, timing: Timing, period: f64) -> SafeZone<'static> {
    let Joint { position, velocity, acceleration, jerk } = joint;
    let limits = Limits::try_from(SymmetricLimits { position, velocity, acceleration, jerk })
        .expect("the joints here are sound");
    let planner = Planner::try_from(PlannerSpec { limits, shape: Shape::Smoothstep, timing, period })
        .expect("the periods here are long enough");
    SafeZone::closed_form(planner).expect("there is room to move")
}

/// A state of a joint: position, velocity, acceleration.
pub type State = [f64; 3];

/// rsruckig's velocity interface, one joint.
pub struct RsRuckig {
    otg: rs::Ruckig<1, rs::IgnoreErrorHandler>,
    /// What it is asked.
    pub input: rs::InputParameter<1>,
    trajectory: rs::Trajectory<1>,
}

impl RsRuckig {
    /// A generator for `joint`, with its position limits, at `period` \[s\].
    #[must_use]
    pub fn new(joint: Joint, period: f64) -> Self {
        let mut input = rs::InputParameter::new(None);
        input.control_interface = rs::ControlInterface::Velocity;
        input.max_velocity[0] = joint.velocity;
        input.max_acceleration[0] = joint.acceleration;
        input.max_jerk[0] = joint.jerk;
        input.min_position = Some(rs::DataArrayOrVec::Stack([joint.position.min]));
        input.max_position = Some(rs::DataArrayOrVec::Stack([joint.position.max]));
        Self { otg: rs::Ruckig::new(None, period), input, trajectory: rs::Trajectory::new(None) }
    }

    /// Plans from `state` to a velocity [m/s]. False if it reports an error; beyond a position limit the plan is then
    /// the best braking, and it is there to be followed.
    pub fn plan(&mut self, [position, velocity, acceleration]: State, target: f64) -> bool {
        self.input.current_position[0] = position;
        self.input.current_velocity[0] = velocity;
        self.input.current_acceleration[0] = acceleration;
        self.input.target_velocity[0] = target;
        let result = self.otg.calculate(&self.input, &mut self.trajectory);
        matches!(result, Ok(rs::RuckigResult::Working | rs::RuckigResult::Finished))
    }

    /// State `time` \[s\] after the start of the plan.
    #[must_use]
    pub fn at(&self, time: f64) -> State {
        let (mut p, mut v, mut a) = (
            rs::DataArrayOrVec::Stack([0.0]),
            rs::DataArrayOrVec::Stack([0.0]),
            rs::DataArrayOrVec::Stack([0.0]),
        );
        self.trajectory.at_time(
            time,
            &mut Some(&mut p),
            &mut Some(&mut v),
            &mut Some(&mut a),
            &mut None,
            &mut None,
        );
        [p[0], v[0], a[0]]
    }
}

/// Ruckig Community's velocity interface, one joint.
pub struct Ruckig {
    otg: ruckig::Ruckig,
    /// What it is asked.
    pub input: ruckig::InputParameter,
    trajectory: ruckig::Trajectory,
}

impl Ruckig {
    /// A generator for `joint`; its position limits are handed over too, the community version does not heed them.
    #[must_use]
    pub fn new(joint: Joint, period: f64) -> Self {
        let mut input = ruckig::InputParameter::new(1);
        input.control_interface = ruckig::ControlInterface::Velocity;
        input.max_velocity = vec![joint.velocity];
        input.max_acceleration = vec![joint.acceleration];
        input.max_jerk = vec![joint.jerk];
        input.min_position = vec![joint.position.min];
        input.max_position = vec![joint.position.max];
        Self {
            otg: ruckig::Ruckig::new_direct(1, period),
            input,
            trajectory: ruckig::Trajectory::new_direct(1),
        }
    }

    /// Plans from `state` to a velocity [m/s]. False if it reports an error.
    pub fn plan(&mut self, [position, velocity, acceleration]: State, target: f64) -> bool {
        self.input.current_position[0] = position;
        self.input.current_velocity[0] = velocity;
        self.input.current_acceleration[0] = acceleration;
        self.input.target_velocity[0] = target;
        let result = self.otg.calculate(&mut self.input, &mut self.trajectory);
        matches!(result, ruckig::Result::Working | ruckig::Result::Finished)
    }

    /// Duration of the plan \[s\].
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.trajectory.get_duration()
    }

    /// State `time` \[s\] after the start of the plan.
    #[must_use]
    pub fn at(&self, time: f64) -> State {
        let (p, v, a) = self.trajectory.at_time(time);
        [p[0], v[0], a[0]]
    }
}
