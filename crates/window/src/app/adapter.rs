//! What the window knows of the graphics adapter, and how long its passes take.

use corniche_viewer::{RoadMethod, gpu::PassTimes};

use crate::{WindowError, canvas::Canvas};

/// What draws, and how long its passes take.
pub(crate) struct AdapterState {
    adapter: String,
    is_software: bool,
    passes: Vec<(RoadMethod, PassTimes)>,
}

impl AdapterState {
    pub(crate) fn of(canvas: &Canvas) -> Self {
        Self {
            adapter: canvas.gpu().adapter_name().to_owned(),
            is_software: canvas.gpu().is_software(),
            passes: Vec::new(),
        }
    }

    /// Name of the graphics adapter.
    pub(crate) fn adapter(&self) -> &str {
        &self.adapter
    }

    /// Whether the processor draws.
    pub(crate) fn is_software(&self) -> bool {
        self.is_software
    }

    /// Times of the passes of the last frame that the graphics card has finished, picture by picture.
    pub(crate) fn passes(&self) -> &[(RoadMethod, PassTimes)] {
        &self.passes
    }

    /// Takes the times that the graphics card has finished. Returns a message for the person where it has none.
    ///
    /// # Errors
    /// When the device is lost.
    pub(crate) fn take_times(
        &mut self,
        canvas: &mut Canvas,
    ) -> Result<Option<String>, WindowError> {
        match canvas.times() {
            Ok(times) => {
                self.passes = times;
                Ok(None)
            }
            Err(error) if canvas.gpu().is_lost() => Err(error.into()),
            Err(error) => {
                self.passes.clear();
                Ok(Some(format!("no pass was timed: {error}")))
            }
        }
    }
}
