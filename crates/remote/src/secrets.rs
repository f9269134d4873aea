//! Texts in which addresses stand, whoever wrote them, without user names, passwords and signatures.

use std::borrow::Cow;

/// What stands in place of a secret.
const HIDDEN: char = '…';

/// A text without what stands before the `@` of an address, or behind its question mark: what a server redirects to, what a library says, what
/// a person has typed and mistyped (`http:/…`).
#[must_use]
pub fn without_secrets(text: &str) -> Cow<'_, str> {
    let mut clean = String::new();
    let mut rest = text;
    while let Some(begin) = address_in(rest) {
        let (before, address) = rest.split_at(begin);
        hide_without_scheme(before, &mut clean);
        let is_end = |c: char| c.is_whitespace() || matches!(c, '"' | '\'' | '<' | '>' | '`');
        let address_end = address.find(is_end).unwrap_or(address.len());
        // In JSON a backslash before a quotation mark belongs to that.
        let address_end = address[..address_end].trim_end_matches('\\').len();
        let (address, after) = address.split_at(address_end);
        hide(address, &mut clean);
        rest = after;
    }
    hide_without_scheme(rest, &mut clean);
    if clean == text { Cow::Borrowed(text) } else { Cow::Owned(clean) }
}

/// Adds a text in which `name:password@host` may stand without a scheme, as libraries tell of connections.
fn hide_without_scheme(text: &str, clean: &mut String) {
    let is_outside = |c: char| {
        c.is_whitespace()
            || matches!(c, '"' | '\'' | '<' | '>' | '`' | '(' | ')' | '[' | ']' | ',' | '/' | '\\')
    };
    let mut rest = text;
    while let Some(at) = rest.find('@') {
        let begin = rest[..at].char_indices().rfind(|&(_, c)| is_outside(c));
        let begin = begin.map_or(0, |(at, c)| at + c.len_utf8());
        let has_password = rest[begin..at].trim_matches(':').contains(':');
        let is_host = rest[at + 1..].starts_with(|c: char| c.is_ascii_alphanumeric() || c == '[');
        if has_password && is_host {
            clean.push_str(&rest[..begin]);
            clean.push(HIDDEN);
        } else {
            clean.push_str(&rest[..at]);
        }
        clean.push('@');
        rest = &rest[at + 1..];
    }
    clean.push_str(rest);
}

/// Where in a text an address goes on behind its scheme and slashes.
fn address_in(text: &str) -> Option<usize> {
    let is_slash = |c: char| matches!(c, '/' | '\\');
    let mut from = 0;
    loop {
        let at = from + text[from..].find([':', '/', '\\'])?;
        let run = &text[at..];
        let length = run.find(|c| c != ':' && !is_slash(c)).unwrap_or(run.len());
        let scheme = text[..at].rsplit(|c: char| !c.is_ascii_alphanumeric()).next();
        let scheme = scheme.unwrap_or_default();
        let is_web = scheme.eq_ignore_ascii_case("http") || scheme.eq_ignore_ascii_case("https");
        // A drive of Windows is one letter.
        let is_address =
            scheme.len() > 1 && run.starts_with(':') && run[..length].contains(is_slash);
        if is_web || is_address {
            return Some(at + length);
        }
        from = at + length;
    }
}

/// Adds an address, from its user name or host on, without secrets.
fn hide(address: &str, clean: &mut String) {
    let end = address.find(['/', '\\', '?', '#']).unwrap_or(address.len());
    let host = &address[..end];
    let is_port = |text: &str| text.bytes().all(|c| c.is_ascii_digit());
    // A password with a slash in it would have to be written otherwise, but may have been typed so.
    let is_cut = host
        .rsplit_once(':')
        .is_some_and(|(_, port)| !host.contains('@') && !port.starts_with(']') && !is_port(port));
    let shown = match if is_cut { address } else { host }.rfind('@') {
        Some(at) => {
            clean.push(HIDDEN);
            &address[at..]
        }
        None => address,
    };
    match shown.split_once('?') {
        // That may be a signature. A sentence can end in a question mark, too.
        Some((path, question)) if !question.is_empty() => {
            clean.push_str(path);
            clean.push('?');
            clean.push(HIDDEN);
        }
        _ => clean.push_str(shown),
    }
}

#[cfg(test)]
#[path = "secrets_tests.rs"]
mod tests;
