//! The format of events as lines for people.

use std::fmt::{self, Debug, Write as _};

use tracing::{
    Event, Level, Subscriber,
    field::{Field, Visit},
};
use tracing_subscriber::{
    fmt::{FmtContext, FormatEvent, FormatFields, FormattedFields, format::Writer},
    registry::{LookupSpan, Scope},
};

use crate::escaped::in_line;

/// Errors and warnings begin with the program's name; notes are printed unchanged. Events that only
/// `-v` shows have their level, spans and fields.
pub(crate) struct Lines;

impl<S, N> FormatEvent<S, N> for Lines
where
    S: Subscriber + for<'a> LookupSpan<'a>,
    N: for<'a> FormatFields<'a> + 'static,
{
    fn format_event(
        &self,
        context: &FmtContext<'_, S, N>,
        mut writer: Writer<'_>,
        event: &Event<'_>,
    ) -> fmt::Result {
        let mut content = Content::default();
        event.record(&mut content);
        let Content { message, fields } = content;
        match *event.metadata().level() {
            Level::ERROR => writeln!(writer, "corniche: {message}"),
            Level::WARN => writeln!(writer, "corniche: warning: {message}"),
            Level::INFO => writeln!(writer, "{message}"),
            level => {
                let level = if level == Level::DEBUG { "debug" } else { "trace" };
                write!(writer, "{level}: ")?;
                for span in context.event_scope().into_iter().flat_map(Scope::from_root) {
                    write!(writer, "{}", span.name())?;
                    let extensions = span.extensions();
                    let fields = extensions.get::<FormattedFields<N>>();
                    if let Some(fields) = fields.filter(|fields| !fields.is_empty()) {
                        write!(writer, "({fields})")?;
                    }
                    writer.write_str(": ")?;
                }
                // A library may quote a server's response.
                writeln!(writer, "{}{fields}", in_line(&message))
            }
        }
    }
}

/// The contents of an event.
#[derive(Debug, Default)]
struct Content {
    message: String,
    /// All fields, each as ` name=value`.
    fields: String,
}

impl Visit for Content {
    fn record_debug(&mut self, field: &Field, value: &dyn Debug) {
        // Writing to a String cannot fail.
        let _ = match field.name() {
            "message" => write!(self.message, "{value:?}"),
            // The bridge from `log` adds these: the location within a library.
            name if name.starts_with("log.") => Ok(()),
            name => write!(self.fields, " {name}={value:?}"),
        };
    }
}
