//! Fly mode: the eye moves along its own axes while keys are held.

use std::collections::BTreeSet;

use glam::DVec3;

use super::{input::CameraKey, view::CameraView};

/// The Shift key multiplies the speed by this.
const FAST: f64 = 4.0;
/// A notch of the wheel changes the speed by this factor.
const SPEED_PER_NOTCH: f64 = 1.25;
/// Range of the speed factor: from a walk to a jet, whatever the height.
const SPEED_RANGE: [f64; 2] = [1.0 / 64.0, 64.0];

/// The state of fly mode.
#[derive(Debug, Clone, Default)]
pub(crate) struct Flying {
    pub(crate) held: BTreeSet<CameraKey>,
    pub(crate) is_fast: bool,
    /// The sum of the wheel's notches.
    notches: f64,
}

impl Flying {
    pub(crate) fn let_go(&mut self) {
        self.held.clear();
        self.is_fast = false;
    }

    pub(crate) fn turn_wheel(&mut self, notches: f64) {
        let most = libm::log(SPEED_RANGE[1]) / libm::log(SPEED_PER_NOTCH);
        self.notches = (self.notches + notches).clamp(-most, most);
    }

    /// The speed along an axis. It grows with the height above the ground, which the view's focus
    /// approximates.
    pub(crate) fn speed_m_per_s(&self, view: &CameraView) -> f64 {
        let wheel = libm::pow(SPEED_PER_NOTCH, self.notches).clamp(SPEED_RANGE[0], SPEED_RANGE[1]);
        let fast = if self.is_fast { FAST } else { 1.0 };
        view.focus_m.max(10.0) * 0.5 * wheel * fast
    }

    /// The position of the eye after the keys that are held now were held for `dt_s`.
    pub(crate) fn moved(&self, view: &CameraView, dt_s: f64) -> DVec3 {
        let axes = view.world_from_view();
        let direction: DVec3 = self
            .held
            .iter()
            .map(|key| match key {
                CameraKey::Ahead => -axes.z_axis,
                CameraKey::Back => axes.z_axis,
                CameraKey::StrafeLeft => -axes.x_axis,
                CameraKey::StrafeRight => axes.x_axis,
                CameraKey::Rise => DVec3::Z,
                CameraKey::Sink => DVec3::NEG_Z,
                _ => DVec3::ZERO,
            })
            .sum();
        view.eye_in_world + direction.normalize_or_zero() * self.speed_m_per_s(view) * dt_s
    }
}
