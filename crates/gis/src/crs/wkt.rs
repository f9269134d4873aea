//! Parses WKT where GDAL offers no function.

use gdal::config;
use gdal::errors::GdalError;
use gdal::spatial_ref::SpatialRef;

/// The first quoted text of a WKT node: its name.
pub(crate) fn quoted(wkt: &str) -> Option<&str> {
    wkt.split('"').nth(1)
}

/// The keyword before the first bracket.
pub(crate) fn keyword(wkt: &str) -> &str {
    wkt.split('[').next().unwrap_or_default().trim()
}

/// Metres per unit of the first unit of length in a WKT node.
///
/// WKT rounds the US survey foot to 15 digits; it is 1200/3937 m by definition.
pub(crate) fn length_unit_m(wkt: &str) -> Option<f64> {
    const SURVEY_FOOT_M: f64 = 1200.0 / 3937.0;
    let start = wkt.find("LENGTHUNIT[").or_else(|| wkt.find("UNIT["))?;
    let fields = &wkt[start..];
    let number = fields.split('"').nth(2)?.trim_start_matches(',');
    let unit_m: f64 = number.split([',', ']']).next()?.trim().parse().ok()?;
    Some(if (unit_m - SURVEY_FOOT_M).abs() < 1e-12 { SURVEY_FOOT_M } else { unit_m })
}

/// The nodes and values directly inside the outermost brackets of a WKT text, without its name.
pub(crate) fn children(wkt: &str) -> Vec<String> {
    let Some(open) = wkt.find('[') else { return Vec::new() };
    let mut parts = vec![String::new()];
    let (mut depth, mut in_quotes) = (0, false);
    for letter in wkt[open + 1..].chars() {
        match letter {
            '"' => in_quotes = !in_quotes,
            '[' if !in_quotes => depth += 1,
            ']' if !in_quotes && depth == 0 => break,
            ']' if !in_quotes => depth -= 1,
            ',' if !in_quotes && depth == 0 => {
                parts.push(String::new());
                continue;
            }
            _ => {}
        }
        if let Some(part) = parts.last_mut() {
            part.push(letter);
        }
    }
    let is_named = parts[0].trim_start().starts_with('"');
    parts.iter().map(|part| part.trim().to_owned()).skip(usize::from(is_named)).collect()
}

/// The child node with one of these keywords.
pub(crate) fn child(wkt: &str, keywords: &[&str]) -> Option<String> {
    children(wkt).into_iter().find(|part| part.contains('[') && keywords.contains(&keyword(part)))
}

/// The system inside a bound one, which `BOUNDCRS` binds to another by a transformation.
pub(crate) fn bound_system(wkt: &str) -> Option<String> {
    children(&child(wkt, &["SOURCECRS"])?).into_iter().next()
}

/// Whether the axis points this way.
pub(crate) fn points_to(axis: &str, ways: &[&str]) -> bool {
    children(axis).first().is_some_and(|way| ways.contains(&way.as_str()))
}

/// The definition as WKT2; the object stays on this thread.
pub(crate) fn wkt2(reference: &SpatialRef) -> Result<String, GdalError> {
    const FORMAT: &str = "OSR_WKT_FORMAT";
    config::set_thread_local_config_option(FORMAT, "WKT2_2018")?;
    let wkt = reference.to_wkt();
    config::clear_thread_local_config_option(FORMAT)?;
    wkt
}

#[cfg(test)]
#[path = "wkt_tests.rs"]
mod tests;
